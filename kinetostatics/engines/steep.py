"""Tables over travel as programs read them: beforehand, and where they are steep by a travel of more digits.

One rounding of the travel makes as many of the largest value as the table is steep there. At such crank angles, mostly
few, what was recorded of the travel is run on numbers of more digits, and the value found with it. What the program
adds to that is zero, with the derivatives that it has. Numbers of more digits are NumPy's `longdouble` where that has
64 digits, else a double and what rounding took off it; bounds are always by these, which bound themselves.
"""

from functools import reduce
from operator import add
from typing import Any

import numpy as np

from ..machine.loads import table_errors
from ..numbers.elementary import UNIT, squared, summed
from ..numbers.lazy import cached_property
from ..numbers.planar import number
from ..numbers.twofold import FARTHEST, Twofold, sine_and_cosine
from .operations import ARRAYS, BY_DESIGN, PLAIN, made
from .recent import kept_for_same_angles
from .trace import needed, parted
from .writing import buffered_line, line

LONG = np.finfo(np.longdouble).nmant >= 63
"""Whether long numbers have more digits than a double."""
SPLIT = np.longdouble(2.0**32 + 1.0)
"""Factor by which a number of 64 digits is split into two of half as many."""
SMALL = 2.0**-30
"""Share of a travel up to which two ways to it differ by rounding."""
MORE = 1.0 + 1e-9
"""What a bound is enlarged by for products of roundings."""
FAR = FARTHEST / 32.0
"""Crank angle, rad, up to which multiples of it are known in two parts."""
BLOCK, FEW = 4096, 512
"""Values of several designs that are found together, in double precision and with more digits."""
UNKNOWN = ("table", "atan")
"""Operations that are not run on numbers of more digits."""


class SteepTable:
    """A table over travel that is one of the loads of a recording.

    Parameters
    ----------
    inputs : mapping of Node to function
        Of numbers that are not exact.
    """

    def __init__(self, inputs):
        self._inputs = inputs
        self._outputs: tuple[Any, ...] = ()
        self._rounded: set[int] = set()

    def follow(self, travel, rate):
        """Be read by what was recorded of a slider's travel and rate, unless that cannot be run beforehand."""
        nodes = needed((travel, rate))
        if not any(node.operation in UNKNOWN for node in nodes):
            rounded = (node for node in nodes if node.operation == "parameter" and node in self._inputs)
            self._outputs, self._rounded = (travel, rate), {node.arguments[0] for node in rounded}

    def pieces(self, table, motion, leaves):
        """Start, value and slope of the piece at each crank angle; 1 where the value is that at the travel, else 0."""
        slider = self._slider(motion, leaves)
        start, value, slope = table.pieces(motion, slider=slider)
        known, _, rise = self._known(table, motion, leaves, slider, start, slope)
        if known is None:
            return start, value, slope, 0.0
        value = np.array(np.broadcast_to(value, known.shape))
        value[known] += rise
        return start, value, slope, known.astype(float)

    def errors(self, table, motion, leaves):
        """What bounds need to know of kinks, see `table_errors`, and bounds on the errors of such values, in `UNIT`."""
        slider = self._slider(motion, leaves)
        kinks = table_errors.kinks_within(table, motion, slider)
        start, value, slope = table.pieces(motion, slider=slider)
        known, travel, rise = self._known(table, motion, leaves, slider, start, slope)
        if known is None:
            return *kinks, 0.0
        with np.errstate(all="ignore"):
            exact = self._in_two_parts(known, motion, leaves, bounded=True)
        off = apart(travel, exact)
        found = np.zeros(known.shape)
        rounded = 8.0 * np.abs(rise) + np.abs(_at(known, value) + rise) + table_errors.TINY / UNIT
        found[known] = MORE * (np.abs(_at(known, slope)) * (off / UNIT) + rounded)
        return *kinks, found

    def _slider(self, motion, leaves):
        """Where the slider is, and its rate, in double precision; None where the kernels are to be asked."""
        if not self._outputs:
            return None
        angle, shape = motion.crank_angle, motion.shape or (1,)
        given, found = (angle, *_turn(angle)), np.empty((2, *shape))
        (plain, by_design), varying, count = self._double
        step = max(1, BLOCK // shape[-1]) if len(shape) == 2 else shape[0]
        buffers = np.empty((count, min(step, shape[0]), *shape[1:]))
        with np.errstate(all="ignore"):
            try:
                numbers = (plain if leaves.are_plain else by_design)(0.0, 0.0, 1.0, leaves.numbers, ())
            except ZeroDivisionError:  # plain numbers raise it, those of NumPy answer with infinity or NaN
                numbers = by_design(0.0, 0.0, 1.0, list(map(np.float64, leaves.numbers)), ())
            for start in range(0, shape[0], step):
                part = slice(start, start + step)
                own = found[:, part]
                few = _rows_of(part, shape, given), _rows_of(part, shape, numbers)
                varying(*few[0], few[1], (), buffers[:, : own.shape[1]], own)
        return found

    def _known(self, table, motion, leaves, slider, start, slope):
        """Where a table is steep, the travel there in two parts, and by how much the value rises from the start."""
        if slider is None:
            return None, None, None
        known = table.is_steep(slider[0], slope) & (np.abs(motion.crank_angle) < FAR)
        if not known.any():
            return None, None, None
        with np.errstate(all="ignore"):
            value, rest = self._in_long(known, motion, leaves) if LONG else self._in_two(known, motion, leaves)
            place = _at(known, slider[0])
            rise = _at(known, slope) * ((value - _at(known, start)) + rest)
            right = np.abs((value - place) + rest) < SMALL * np.abs(place)
        known[known] = right
        return known, (value[right], rest[right]), rise[right]

    def _in_long(self, known, motion, leaves):
        angle = _at(known, motion.crank_angle).astype(np.longdouble)
        fixed, varying = self._long
        numbers = [_of(known, part) for part in fixed(0.0, 0.0, 1.0, list(map(np.longdouble, leaves.numbers)), ())]
        value, rest = np.empty((2, angle.size))
        for start in range(0, angle.size, FEW):
            part = slice(start, start + FEW)
            own = angle[part]
            few = [item[part] if isinstance(item, np.ndarray) else item for item in numbers]
            (travel,) = varying(own, np.sin(own), np.cos(own), few, ())
            value[part] = travel
            rest[part] = travel - value[part]
        return value, rest

    def _in_two(self, known, motion, leaves):
        found = self._in_two_parts(known, motion, leaves, bounded=False)
        return found.value, number(found.rest)

    def _in_two_parts(self, known, motion, leaves, bounded):
        none = 0.0 if bounded else None
        angle = Twofold(_at(known, motion.crank_angle), None, none)
        numbers = [Twofold(_of(known, leaf), None, none) for leaf in leaves.numbers]
        if bounded:
            for place in self._rounded:
                numbers[place].error = UNIT * abs(numbers[place].value)
        return self._twofold(angle, *sine_and_cosine(angle), numbers, ())[0]

    @cached_property
    def _double(self):
        fixed, outputs = parted(self._outputs)
        source, count = buffered_line(outputs)
        return [made(line(fixed), scope) for scope in (PLAIN, BY_DESIGN)], made(source, ARRAYS | BY_DESIGN), count

    @cached_property
    def _long(self):
        operations = BY_DESIGN | {"total": _long_total, "rest": _long_rest}
        return [made(line(outputs), operations) for outputs in parted(self._outputs[:1])]

    @cached_property
    def _twofold(self):
        return made(line(self._outputs[:1]), _TWOFOLD)


def apart(travel, exact):
    """Bound on how far a travel in two parts is from the exact one, which is known by a `Twofold`.

    Their first parts are so near that the difference is exact. That of the others is rounded, and may cancel with it.
    """
    rest = travel[1] - number(exact.rest)
    return abs((travel[0] - exact.value) + rest) + UNIT * abs(rest) + exact.error


@kept_for_same_angles
def _turn(angle):
    return np.sin(angle), np.cos(angle)


def _at(known, part):
    """What of numbers, or rows, is there."""
    return part[known] if np.shape(part) == known.shape else np.broadcast_to(part, known.shape)[known]


def _rows_of(part, shape, given):
    """Of arrays with a row for each design, those of some."""
    if part.start == 0 and part.stop >= shape[0]:
        return given
    return [_row(item, part, shape) for item in given]


def _row(item, part, shape):
    return item[part] if isinstance(item, np.ndarray) and item.ndim == 2 and len(item) == shape[0] else item


def _of(known, leaf):
    """A number of the design, or those of the designs there."""
    return _at(known, leaf) if isinstance(leaf, np.ndarray) else leaf


def _long_total(*terms):
    """As `elementary.total`, by half of its steps: terms have more digits here than it is to keep."""
    *lost, whole = summed(terms)
    return whole + sum(lost)


def _long_rest(length, x, y):
    """What rounding took off a length in long numbers, as `elementary.rest` has it."""
    (one, first), (two, second), (three, third) = (squared(part, SPLIT) for part in (x, y, length))
    return _long_total(one, two, -three, first, second, -third) / (2.0 * length)


_TWOFOLD = {
    "sin": lambda angle: sine_and_cosine(angle)[0],
    "cos": lambda angle: sine_and_cosine(angle)[1],
    "sqrt": Twofold.sqrt,
    "root": lambda square, unit: square.sqrt(),
    "divisor": Twofold.kept_off_zero,
    "abs": abs,
    "copysign": lambda one, part: part.sign(),
    "total": lambda *terms: reduce(add, terms),
    "rest": lambda length, x, y: 0.0,
}
"""Operations on numbers in two parts; a length has no rest that is not among its own."""
