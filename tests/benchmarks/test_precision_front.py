"""Time against error: at every accuracy better than 1e-6 nothing takes less time than the library itself.

Run by ``python -m pytest tests/benchmarks --benchmark-only``. Every method computes one turn of 360 crank angles; those
that come near the library's time are timed again in rounds in which they take turns, and medians are compared. How near
each method comes to the certified reference is no matter of time, and ``tests/studies/test_precision.py`` tests it.
"""

from dataclasses import dataclass
from statistics import median
from timeit import Timer
from typing import Any

import pytest

import kinetostatics as ks
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from kinetostatics.studies.precision import METHODS

ANGLES = 360
FRONT_ACCURACY = 1e-6
"""Error below which no method may be both faster and more accurate than the library's own."""
NOISE = 1.15
"""How much longer than a rival ours may seem to take."""
NEAR = 3.0
"""Rivals that take longer than this many times ours, by a first timing, are not timed again."""
SLOW = 0.05
"""Time from which on one timing tells that a method is not near, s."""
ROUNDS, SPENT = 31, 5e-3
"""How often each rival has its turn, and for about how many seconds each time."""
SCENES = [
    ("sawframe_2r63", "plain"),
    ("sawframe_2r63", "cam-circle"),
    ("sawframe_2r63", "cam-cosine"),
    ("mower_drive", "unbalanced"),
    ("chain_unit", "rho-0.5"),
]


@dataclass
class Rival:
    """A method at one setting, how near it comes and its median time, s."""

    name: str
    ours: bool
    run: Any
    error: float
    time: float = 0.0


def rivals(solution, quantity):
    """All methods that give the quantity, at all their settings."""
    reference = enclosure(solution, quantity)
    for method in METHODS:
        if method.precision == "single":
            continue
        for setting in method.settings:
            try:
                run = method.prepare(solution, quantity, setting)
                error = float(relative_errors(run(), reference).max())
            except (ks.errors.NotGivenError, ks.errors.MissingLibraryError):
                continue
            yield Rival(method.name if setting is None else f"{method.name} {setting:g}", method.ours, run, error)


def take_time(field):
    """Median time of each over rounds in which they take turns."""
    timers = [Timer(rival.run) for rival in field]
    counts = [max(1, round(SPENT / min(timer.repeat(3, 1)))) for timer in timers]
    rounds = [[timer.timeit(count) / count for timer, count in zip(timers, counts, strict=True)] for _ in range(ROUNDS)]
    for rival, times in zip(field, zip(*rounds, strict=True), strict=True):
        rival.time = median(times)


@pytest.mark.parametrize("quantity", ["balancing_torque", "O"])
@pytest.mark.parametrize(("name", "variant"), SCENES)
def test_nothing_better_than_1e_6_is_faster_than_ours(benchmark, capsys, name, variant, quantity):
    field = list(rivals(ks.load_case(name).solve(variant, ANGLES), quantity))
    for rival in field:
        rival.time = Timer(rival.run).timeit(1)
        if rival.time < SLOW:
            rival.time = min(rival.time, *Timer(rival.run).repeat(3, 1))
    best = min((rival for rival in field if rival.ours), key=lambda rival: rival.time)
    near = [rival for rival in field if rival.ours or rival.time < NEAR * best.time]
    take_time(near)
    benchmark.pedantic(best.run, rounds=20, iterations=20, warmup_rounds=2)

    ours = [rival for rival in field if rival.ours]
    others = [rival for rival in field if not rival.ours]
    best = min(ours, key=lambda rival: rival.time)
    fast = min((rival for rival in others if rival.error < FRONT_ACCURACY), key=lambda rival: rival.time)
    coarse = [f"{rival.name} ({rival.error:.0e})" for rival in others if rival.time < best.time]
    benchmark.extra_info["times faster than the fastest other better than 1e-6"] = fast.time / best.time
    with capsys.disabled():
        print(
            f"\n{name} {variant}, {quantity}: {best.name} {1e9 * best.time / ANGLES:.1f} ns an angle, {best.error:.0e};"
            f" next {fast.name}, {fast.error:.0e}, {fast.time / best.time:.2f} times as long;"
            f" faster: {', '.join(coarse) or 'none'}"
        )

    def beaten(rival):
        """By one of ours that is as near, but for rounding, and as fast, but for noise."""
        allowed = max(4 * rival.error, rival.error + 1e-15)
        return any(mine.error <= allowed and mine.time <= NOISE * rival.time for mine in ours)

    assert [rival.name for rival in others if rival.error < FRONT_ACCURACY and not beaten(rival)] == []
