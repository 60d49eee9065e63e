"""Tables over travel read where they are steep: by a travel in two parts, so that its own rounding does not count.

One rounding of the travel makes as many of the largest value as the table is steep there. At such crank angles, mostly
few, what was recorded of the travel is run on `Twofold` numbers, and the value found beforehand. What the loop adds to
it is zero, with the derivatives that it has.
"""

import numpy as np

from ..numbers.elementary import UNIT
from ..numbers.twofold import Twofold, sine_and_cosine
from .trace import needed

SMALL = 2.0**-30
"""Share of a travel up to which its second part is rounding."""
MORE = 1.0 + 1e-9
"""What a bound is enlarged by for products of roundings."""


class SteepTable:
    """A table over travel that is one of the loads of a recording.

    Parameters
    ----------
    inputs : mapping of Node to function
        Of numbers that are not exact.
    """

    def __init__(self, inputs):
        self._inputs, self._nodes = inputs, []

    def follow(self, travel):
        """Read by a recorded travel, if it comes of operations that two parts go through."""
        nodes = needed([travel])
        self._nodes = nodes if all(node.operation in _RULES for node in nodes) else []

    def pieces(self, table, motion):
        """Start, value and slope of the piece at each crank angle; 1 where the value is that at the travel, else 0."""
        start, value, slope = table.pieces(motion)
        known, rise, _ = self._known(table, motion, start, slope)
        if known is None:
            return start, value, slope, 0.0
        value = np.array(np.broadcast_to(value, known.shape))
        value[known] += rise
        return start, value, slope, known.astype(float)

    def errors(self, table, motion):
        """Bounds on the errors of those values, in `UNIT`."""
        start, value, slope = table.pieces(motion)
        known, rise, error = self._known(table, motion, start, slope, bounded=True)
        if known is None:
            return 0.0
        found, steepness = np.zeros(known.shape), np.abs(_at(known, slope))
        whole = np.abs(_at(known, value) + rise)
        found[known] = MORE * (steepness * error / UNIT + 8.0 * np.abs(rise) + whole)
        return found

    def _known(self, table, motion, start, slope, bounded=False):
        """Where a table is steep, by how much it rises there from the start of a piece, and the error of the travel."""
        if not self._nodes:
            return None, None, None
        known = np.asarray(table.is_steep(table.place(motion), slope))
        if not known.any():
            return None, None, None
        with np.errstate(all="ignore"):
            travel = self._at(known, motion, bounded)
            rise = _at(known, slope) * ((travel.value - _at(known, start)) + travel.rest)
            right = np.isfinite(rise) & (np.abs(travel.rest) < SMALL * np.abs(travel.value))
        known = known.copy()
        known[known] = right
        return known, rise[right], np.broadcast_to(travel.error, right.shape)[right] if bounded else None

    def _at(self, known, motion, bounded):
        """The travel in two parts."""
        _, leaves = motion.apart
        none = 0.0 if bounded else None
        found, turns = {}, {}
        for node in self._nodes:
            kind, arguments = node.operation, node.arguments
            if kind == "angle":
                made = Twofold(_at(known, motion.crank_angle), None, none)
            elif kind == "parameter":
                value = leaves.numbers[arguments[0]]
                value = value if type(value) is float else _at(known, value)
                made = Twofold(value, None, UNIT * abs(value) if bounded and node in self._inputs else none)
            else:
                parts = [found[part] if part in found else Twofold(part, None, none) for part in arguments]
                if kind in ("sin", "cos"):
                    if arguments[0] not in turns:
                        turns[arguments[0]] = sine_and_cosine(parts[0])
                    made = turns[arguments[0]][kind == "cos"]
                else:
                    made = _RULES[kind](*parts)
            found[node] = made
        return made


def _at(known, part):
    """What of numbers, or rows, is there."""
    return np.broadcast_to(part, known.shape)[known]


def _difference(one, *others):
    return one - others[0] if others else -one


def _total(first, *others):
    for part in others:
        first = first + part
    return first


def _no_rest(length, x, y):
    """In exact arithmetic there is none."""
    return Twofold(0.0, None, None if length.error is None else 0.0)


_RULES = {
    **dict.fromkeys(("angle", "parameter", "sin", "cos")),
    "+": Twofold.__add__,
    "-": _difference,
    "*": Twofold.__mul__,
    "/": Twofold.__truediv__,
    "sqrt": Twofold.sqrt,
    "root": Twofold.forgiving_root,
    "divisor": Twofold.kept_off_zero,
    "abs": Twofold.__abs__,
    "sign": Twofold.sign,
    "held": Twofold.held,
    "total": _total,
    "rest": _no_rest,
}
"""What is run on numbers in two parts."""
