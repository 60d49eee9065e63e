"""Periods of loads: whole turns of the crank."""

import math

from ...numbers import checks

TURN = 2 * math.pi
MOST_TURNS = 100
"""Turns after which loads must repeat, all together."""


class WholeTurns:
    """Rule of a period: 2 pi or a whole multiple of it, but for rounding, which is taken away."""

    def quick(self, value):
        return value if value is TURN else checks.UNSURE

    def taken(self, value, field=""):
        try:
            value = checks.plain(value, "rad")
        except checks.DimensionError as fault:
            return value, f"{field} {fault}"
        number = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300
        turns = value / TURN if number else 0.0
        if round(turns) >= 1 and abs(turns - round(turns)) < 1e-9 * turns:
            many = f"{field} must be at most {MOST_TURNS} turns, got {round(turns):.6g}"
            return round(turns) * TURN, many if round(turns) > MOST_TURNS else None
        return value, f"{field} must be 2 pi or a whole multiple of it, got {checks.shown(value)}"


def period_of(loads, turns=1):
    """Crank angle after which all loads repeat, rad: the turns that their periods have in common, or so many."""
    return TURN * math.lcm(turns, *(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))
