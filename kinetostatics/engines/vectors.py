"""Arithmetic at crank angles as machine code of vectors: a line of it is run once, on operands that write it down.

What is computed at one crank angle mostly waits, one result for the other, as roots and quotients take long. Processors
with the largest vectors look so far ahead that they begin the next ones meanwhile; of shorter vectors two go together,
unless there are many operations. So no compiler has to guess whether that is worth while.
"""

import inspect
import sys
from functools import cache
from hashlib import sha256
from types import FunctionType

from ..numbers.elementary import ROUNDING, sum_and_rest, summed
from ..version import __version__

VECTORS = {"+avx512f": (8, 1), "+avx": (4, 2)}
"""By feature of a processor, best first: how many numbers its vectors hold, and how many vectors go together."""
LEAST = (2, 2)
"""The same without these features."""
MANY = 450
"""Values at each crank angle of which there are enough to compute while others wait: one vector then goes alone."""
CALLED = {"sin": "llvm.sin.{}", "cos": "llvm.cos.{}", "atan": "atan"}
"""Functions that are called for each number by itself, and what numba calls them."""


@cache
def edition(*others) -> str:
    """What tells machine code written by this version of the module, and of others that it is made by, from another's.

    Numba knows the text that it compiles, not the modules that it is written by.
    """
    modules = sys.modules[__name__], sys.modules[sum_and_rest.__module__], *others
    try:
        text = "".join(map(inspect.getsource, modules))
    except OSError:
        text = __version__
    return sha256(text.encode()).hexdigest()[:8]


def over_angles(line):
    """For numba: ``at_angles(angle, sine, cosine, tables, results, first, table, design, numbers)``.

    It fills the results of a design by ``line(angle, sine, cosine, tables, numbers)``, which gives a tuple of outputs
    and decides nothing by values. Angles with their sines and cosines are (1 or designs, N), of which it takes the row
    `first`; tables (T, 1 or designs, N), of which it takes `table`; results (designs, outputs, N).
    """
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def at_angles(typing, angle, sine, cosine, tables, results, first, table, design, numbers):
        kinds = angle, sine, cosine, tables, results, first, table, design, numbers

        def written(context, builder, signature, given):
            pairs = list(zip(kinds, given, strict=True))
            arrays = [context.make_array(kind)(context, builder, part) for kind, part in pairs[:5]]
            places = [context.cast(builder, part, kind, types.intp) for kind, part in pairs[5:8]]
            fixed = cgutils.unpack_tuple(builder, given[8], len(numbers))
            rows = _Rows(builder, arrays, *places)
            kind, lanes = context.get_data_type(results.dtype), lanes_of(line)

            def from_angle(start, count):
                writer = Writer(builder, kind, count)
                turn = (writer.loaded(rows.of_turn(place, start)) for place in range(3))
                found = FunctionType(line.__code__, writer.scope)(
                    *turn, _Tables(writer, rows, start), [writer.spread(part) for part in fixed]
                )
                for place, output in enumerate(found):
                    writer.store(output, rows.of_results(place, start))

            with builder.if_else(builder.icmp_signed("<", rows.count, rows.word(lanes))) as (few, many):
                with few, cgutils.for_range(builder, rows.count) as each:
                    from_angle(each.index, 1)
                with many:  # the last go together with some that are computed twice
                    last = builder.sub(rows.count, rows.word(lanes))
                    times = builder.sdiv(builder.add(rows.count, rows.word(lanes - 1)), rows.word(lanes))
                    with cgutils.for_range(builder, times) as each:
                        start = builder.mul(each.index, rows.word(lanes))
                        start = builder.select(builder.icmp_signed("<", start, last), start, last)
                        from_angle(start, lanes)
            return context.get_dummy_value()

        return types.void(*kinds), written

    return at_angles


def lanes_of(line) -> int:
    """How many crank angles go together in machine code for this processor, or for that which numba is told."""
    from llvmlite import binding
    from numba import config

    told = vars(config)["CPU_FEATURES"]
    features = binding.get_host_cpu_features().flatten() if told is None else told
    size, together = next((found for name, found in VECTORS.items() if name in features.split(",")), LEAST)
    return size if line.__code__.co_nlocals > MANY else size * together


class _Rows:
    """Where numbers stand in memory: rows of N, one for each crank angle."""

    def __init__(self, builder, arrays, first, table, design):
        from numba.core import cgutils

        self._builder, self._data = builder, [array.data for array in arrays]
        self._first, self._table, self._design = first, table, design
        self._sizes = [cgutils.unpack_tuple(builder, array.shape) for array in arrays]
        self.count = self._sizes[0][-1]

    def word(self, number):
        """A whole number as machine code has it."""
        return self.count.type(number)

    def of_turn(self, place, start):
        return self._at(place, self._first, start)

    def of_table(self, row, start):
        return self._at(3, self._inner(3, self.word(row), self._table), start)

    def of_results(self, row, start):
        return self._at(4, self._inner(4, self._design, self.word(row)), start)

    def _inner(self, array, outer, inner):
        return self._builder.add(self._builder.mul(outer, self._sizes[array][1]), inner)

    def _at(self, array, row, start):
        return self._builder.gep(self._data[array], [self._builder.add(self._builder.mul(row, self.count), start)])


class _Tables:
    """Rows of tables as a line asks for them."""

    def __init__(self, writer, rows, start):
        self._writer, self._rows, self._start = writer, rows, start

    def __getitem__(self, row):
        return self._writer.loaded(self._rows.of_table(row, self._start))


class Writer:
    """Writes operations of numbers of a kind, as many at once as told.

    Attributes
    ----------
    scope : dict
        What functions are called in a line.
    """

    def __init__(self, builder, kind, count):
        from llvmlite import ir

        self.builder, self._one, self._count = builder, kind, count
        self._kind = kind if count == 1 else ir.VectorType(kind, count)
        self.scope = {name: getattr(self, name) for name in ("root", "divisor", "copysign", "fma", "total")}
        self.scope |= {"sqrt": self.built_in("sqrt"), "nan": float("nan"), "inf": float("inf"), "abs": abs}
        self.scope |= {name: self._called(name) for name in CALLED}

    def loaded(self, place):
        return _Lanes(self, self.builder.load(self._in_memory(place), align=self._size))

    def store(self, part, place):
        self.builder.store(self.held(part), self._in_memory(place), align=self._size)

    def spread(self, number):
        """A number of the design in every lane."""
        return _Lanes(self, self._of_lanes([number] * self._count))

    def held(self, part):
        """Value of an operand, or a plain number."""
        if isinstance(part, _Lanes):
            return part.value
        return self._kind(float(part)) if self._count == 1 else self._kind([float(part)] * self._count)

    def written(self, operation, *parts):
        return _Lanes(self, getattr(self.builder, operation)(*map(self.held, parts)))

    def root(self, square, unit):
        above = self.chosen(">", square, 0.0, square, 0.0)
        return self.chosen(">", square, -ROUNDING * unit, self.scope["sqrt"](above), float("nan"))

    def divisor(self, root, unit):
        return self.chosen("<", root, unit, unit, root)

    def copysign(self, one, other):
        return self.built_in("copysign")(one, other)

    def fma(self, one, other, more):
        """In one operation where the processor has it; in single precision never, as NumPy has it."""
        return self.built_in("fmuladd")(one, other, more) if self._is_double else one * other + more

    def total(self, *terms):
        """See `elementary.total`."""
        *lost, whole = summed(summed(terms))
        return whole + sum(lost[1:], lost[0])

    def holds(self, sign, one, other):
        """Whether operands compare so, a bit for each lane; not if one is no number."""
        return self.builder.fcmp_ordered(sign, self.held(one), self.held(other))

    def chosen(self, sign, one, other, here, there):
        """The one operand where two others compare so, else the other."""
        holds = self.holds(sign, one, other)
        return _Lanes(self, self.builder.select(holds, self.held(here), self.held(there)))

    @property
    def _is_double(self):
        return self._one.intrinsic_name == "f64"

    @property
    def _size(self):
        return 8 if self._is_double else 4

    def _in_memory(self, place):
        return place if self._count == 1 else self.builder.bitcast(place, self._kind.as_pointer())

    def _of_lanes(self, values):
        if self._count == 1:
            return values[0]
        from llvmlite import ir

        whole = ir.Constant(self._kind, ir.Undefined)
        for lane, value in enumerate(values):
            whole = self.builder.insert_element(whole, value, ir.IntType(32)(lane))
        return whole

    def _function(self, name, kind, count):
        from llvmlite import ir
        from numba.core import cgutils

        return cgutils.get_or_insert_function(self.builder.module, ir.FunctionType(kind, [kind] * count), name)

    def built_in(self, name):
        """Function of LLVM's own of all lanes together."""
        lanes = "" if self._count == 1 else f"v{self._count}"

        def of_lanes(*parts):
            function = self._function(f"llvm.{name}.{lanes}{self._one.intrinsic_name}", self._kind, len(parts))
            return _Lanes(self, self.builder.call(function, [self.held(part) for part in parts]))

        return of_lanes

    def _called(self, name):
        """Function of the C library, called for each lane."""

        def of_each(part):
            function = self._function(CALLED[name].format(self._one.intrinsic_name), self._one, 1)
            value = self.held(part)
            if self._count == 1:
                return _Lanes(self, self.builder.call(function, [value]))
            from llvmlite import ir

            places = map(ir.IntType(32), range(self._count))
            each = [self.builder.call(function, [self.builder.extract_element(value, place)]) for place in places]
            return _Lanes(self, self._of_lanes(each))

        return of_each


class _Lanes:
    """An operand: what is done to it is written down."""

    __slots__ = ("_writer", "value")

    def __init__(self, writer, value):
        self._writer, self.value = writer, value

    def __add__(self, other):
        return self._writer.written("fadd", self, other)

    def __radd__(self, other):
        return self._writer.written("fadd", other, self)

    def __sub__(self, other):
        return self._writer.written("fsub", self, other)

    def __rsub__(self, other):
        return self._writer.written("fsub", other, self)

    def __mul__(self, other):
        return self._writer.written("fmul", self, other)

    def __rmul__(self, other):
        return self._writer.written("fmul", other, self)

    def __truediv__(self, other):
        return self._writer.written("fdiv", self, other)

    def __rtruediv__(self, other):
        return self._writer.written("fdiv", other, self)

    def __neg__(self):
        return self._writer.written("fneg", self)

    def __abs__(self):
        return self._writer.built_in("fabs")(self)
