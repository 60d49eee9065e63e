"""Tables over travel as programs read them: beforehand, and where they are steep by a travel of more digits.

One rounding of the travel makes as many of the largest value as the table is steep there. At such crank angles, mostly
few, what was recorded of the travel is run on numbers of more digits, and the value found with it. What the program
adds to that is zero, with the derivatives that it has. Numbers of more digits are NumPy's `longdouble` where that has
64 digits, else a double and what rounding took off it; the bound on their errors is one of both.
"""

from functools import reduce
from operator import add
from typing import Any

import numpy as np

from ..machine.loads import table_errors
from ..numbers.elementary import UNIT, squared, summed
from ..numbers.lazy import cached_property
from ..numbers.planar import number, plus
from ..numbers.twofold import FARTHEST, Twofold, sine_and_cosine
from .arithmetic import BoundsOfLonger
from .bounds import Error
from .codegen import ARRAYS, BY_DESIGN, PLAIN, buffered_source, compile_line, line_source
from .graph import needed, parted
from .numba_backend import keep_for_same_angles

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

    def follow(self, travel, rate):
        """Be read by what was recorded of a slider's travel and rate, unless that cannot be run beforehand."""
        if not any(node.operation in UNKNOWN for node in needed((travel, rate))):
            self._outputs = travel, rate

    def pieces(self, table, motion, leaves):
        """Start, value and slope of the piece at each crank angle; 1 where the value is that at the travel, else 0."""
        return self._found(table, motion, leaves)[0]

    def pieces_and_errors(self, table, motion, leaves):
        """The same, what bounds need to know of kinks (see `table_errors`), and of errors of such values, in `UNIT`."""
        pieces, slider, rise = self._found(table, motion, leaves)
        kinks = table_errors.kinks_within(table, motion, slider)
        if rise is None:
            return *pieces, *kinks, 0.0
        _, value, slope, known = pieces
        there, found = known > 0.0, np.zeros(known.shape)
        rounded = 8.0 * np.abs(rise) + np.abs(value[there]) + table_errors.TINY / UNIT
        off = self._off(there, motion, leaves)
        found[there] = MORE * (np.abs(_at(there, slope)) * (off / UNIT) + rounded)
        return *pieces, *kinks, found

    def _found(self, table, motion, leaves):
        """The pieces, where the slider is, and by how much values that are known rise from the start; None if none."""
        slider = self._slider(motion, leaves)
        start, value, slope = table.pieces(motion, slider=slider)
        known, rise = self._known(table, motion, leaves, slider, start, slope)
        if known is None:
            return (start, value, slope, 0.0), slider, None
        value = np.array(np.broadcast_to(value, known.shape))
        value[known] += rise
        return (start, value, slope, known.astype(float)), slider, rise

    def _slider(self, motion, leaves):
        """Where the slider is, and its rate, in double precision; None where the kernels are to be asked."""
        if not self._outputs:
            return None
        angle, shape = motion.crank_angle, motion.shape or (1,)
        given, found = (angle, *_turn(angle)), np.empty((2, *shape))
        fixed, varying, count = self._double
        step = max(1, BLOCK // shape[-1]) if len(shape) == 2 else shape[0]
        buffers = np.empty((count, min(step, shape[0]), *shape[1:]))
        with np.errstate(all="ignore"):
            numbers = _of_design(fixed, leaves)
            for start in range(0, shape[0], step):
                part = slice(start, start + step)
                own = found[:, part]
                few = _rows_of(part, shape, given), _rows_of(part, shape, numbers)
                varying(*few[0], few[1], (), buffers[:, : own.shape[1]], own)
        return found

    def _known(self, table, motion, leaves, slider, start, slope):
        """Where a table is steep, and by how much the value rises from the start there, by a travel in two parts."""
        if slider is None:
            return None, None
        known = table.is_steep(slider[0], slope) & (np.abs(motion.crank_angle) < FAR)
        if not known.any():
            return None, None
        with np.errstate(all="ignore"):
            value, rest = self._in_long(known, motion, leaves) if LONG else self._in_two(known, motion, leaves)
            place = _at(known, slider[0])
            rise = _at(known, slope) * ((value - _at(known, start)) + rest)
            right = np.abs((value - place) + rest) < SMALL * np.abs(place)
        known[known] = right
        return known, rise[right]

    def _in_long(self, known, motion, leaves):
        fixed, varying = self._long
        numbers = fixed(0.0, 0.0, 1.0, list(map(np.longdouble, leaves.numbers)), ())
        travel = _there(varying, known, _at(known, motion.crank_angle).astype(np.longdouble), numbers)
        value = travel.astype(float)
        return value, (travel - value).astype(float)

    def _in_two(self, known, motion, leaves):
        angle = Twofold(_at(known, motion.crank_angle))
        numbers = [Twofold(_of(known, leaf)) for leaf in leaves.numbers]
        found = self._twofold(angle, *sine_and_cosine(angle), numbers, ())[0]
        return found.value, number(found.rest)

    def _off(self, known, motion, leaves):
        """Bound on how far such a travel is from the exact one, m."""
        fixed, varying = self._longer
        with np.errstate(all="ignore"):
            return _there(varying, known, _at(known, motion.crank_angle), _of_design(fixed, leaves))

    @cached_property
    def _double(self):
        fixed, outputs = parted(self._outputs)
        source, count = buffered_source(outputs)
        return _by_design(fixed), compile_line(source, ARRAYS | BY_DESIGN), count

    @cached_property
    def _longer(self):
        travel = self._outputs[0]
        fixed, outputs = parted(BoundsOfLonger(travel.graph, self._inputs).of([travel]))
        return _by_design(fixed), compile_line(line_source(outputs), BY_DESIGN)

    @cached_property
    def _long(self):
        operations = BY_DESIGN | {"total": _long_total, "rest": _long_rest}
        return [compile_line(line_source(outputs), operations) for outputs in parted(self._outputs[:1])]

    @cached_property
    def _twofold(self):
        return compile_line(line_source(self._outputs[:1]), _TWOFOLD)


def _by_design(fixed):
    """Lines of what a design fixes, for plain numbers and others."""
    return [compile_line(line_source(fixed), scope) for scope in (PLAIN, BY_DESIGN)]


def _of_design(fixed, leaves):
    plain, by_design = fixed
    try:
        return (plain if leaves.are_plain else by_design)(0.0, 0.0, 1.0, leaves.numbers, ())
    except ZeroDivisionError:  # plain numbers raise it, those of NumPy answer with infinity or NaN
        return by_design(0.0, 0.0, 1.0, list(map(np.float64, leaves.numbers)), ())


def _there(varying, known, angle, numbers):
    """What a line gives for angles where that is known, few at a time, and numbers of a design or those there."""
    numbers, found = [_of(known, part) for part in numbers], np.empty_like(angle)
    for start in range(0, angle.size, FEW):
        part = slice(start, start + FEW)
        own = angle[part]
        few = [item[part] if isinstance(item, np.ndarray) else item for item in numbers]
        (found[part],) = varying(own, np.sin(own), np.cos(own), few, ())
    return found


def of_pieces(pieces, within, travel, rate):
    """Errors of the pieces of a table over travel: the exact travel may lie in another, or on the other stroke."""
    _, value, slope, _ = pieces
    change, jump, near, distance, lost = within

    def of_value(bounds):
        bounds.of((travel, rate))
        jumps = plus(jump / UNIT, 0.0 / bounds.above(near, bounds.total(rate)))
        total = bounds.total(travel)
        if total is None:  # the law of a follower gives it: the piece is the right one
            return Error(0.0, jumps + lost)
        off = 2.0 * total  # of the computed one by which a piece is chosen too
        jumps = plus(jumps, 0.0 / bounds.above(near, off))
        return Error(0.0, bounds.fused(change, bounds.above(off, None, distance / UNIT), jumps) + lost)

    return {value: of_value, slope: lambda bounds: Error(3.0, None)}


def not_known(beyond, known):
    """Error of how far a travel is beyond the start of a piece, where the value there is not known beforehand."""

    def error(bounds):
        total = bounds.total(beyond)
        return Error(0.0, None if total is None else (1.0 - known) * total)

    return error


@keep_for_same_angles
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
