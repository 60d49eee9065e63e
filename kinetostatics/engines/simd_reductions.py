"""Vector (SIMD) instructions for numba: bit masks of comparisons, functions of table columns, and sums of rows."""

import inspect
import sys
from functools import cache
from hashlib import sha256
from typing import Any

from ..version import __version__

AT_ONCE = 64
"""Numbers that are compared or added by one instruction."""
COLUMNS = 8
"""Columns of a table that are computed by one instruction."""


@cache
def edition(*others) -> str:
    """Hash of the source of this module and others, for programs compiled with it.

    Numba looks for changes in the program that it compiles only, not in the modules that emit its instructions.
    """
    modules = sys.modules[__name__], *others
    try:
        text = "".join(map(inspect.getsource, modules))
    except OSError:
        text = __version__
    return sha256(text.encode()).hexdigest()[:8]


def rising(writer, here, after):
    """Whether the second of two numbers is higher, or one of them is NaN."""
    return writer.builder.not_(writer.holds("<=", after, here))


def falling(writer, here, after):
    """Whether the second of two numbers is lower, or one of them is NaN."""
    return writer.builder.not_(writer.holds(">=", after, here))


def negative(writer, here, after):
    """Whether the first of two numbers is negative."""
    return writer.holds("<", here, 0.0)


def bits_of_steps(*conditions):
    """For numba: ``bits(results, design, row, words)`` sets bit k of `words` where a condition holds for step k.

    Step k goes from value k in a row of results (designs, rows, N) to the next, from the last to the first. `words` has
    a row of uint64 for each condition; bits beyond N are 0.
    """
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def bits(typing, results, design, row, words):
        kinds = results, design, row, words

        def written(context, builder, signature, given):
            first, size = _row(context, builder, kinds[:3], given[:3])
            into = context.make_array(words)(context, builder, given[3])
            length = cgutils.unpack_tuple(builder, into.shape)[1]
            word = size.type
            last, whole = builder.sub(size, word(1)), word(AT_ONCE)

            def found(lanes, *places):
                writer = Writer(builder, lanes)
                step = [writer.loaded(builder.gep(first, [place])) for place in places]
                return [condition(writer, *step) for condition in conditions]

            def found_from(start):
                both = found(AT_ONCE, start, builder.add(start, word(1)))
                return [builder.bitcast(bit, word) for bit in both]

            def put(masks, place, add=False):
                for number, mask in enumerate(masks):
                    at = builder.gep(into.data, [builder.add(builder.mul(length, word(number)), place)])
                    builder.store(builder.or_(builder.load(at), mask) if add else mask, at)

            def put_bit(place, *step):
                shift = builder.srem(place, whole)
                masks = [builder.shl(builder.zext(bit, word), shift) for bit in found(1, *step)]
                put(masks, builder.sdiv(place, whole), add=True)

            full, rest = builder.sdiv(last, whole), builder.srem(last, whole)
            put([word(0)] * len(conditions), full)
            with builder.if_else(builder.icmp_signed("<", last, whole)) as (few, many):
                with few, cgutils.for_range(builder, last) as each:
                    put_bit(each.index, each.index, builder.add(each.index, word(1)))
                with many:
                    with cgutils.for_range(builder, full) as each:
                        put(found_from(builder.mul(each.index, whole)), each.index)
                    with builder.if_then(builder.icmp_signed(">", rest, word(0))):
                        beyond = builder.sub(whole, rest)
                        put([builder.lshr(mask, beyond) for mask in found_from(builder.sub(last, whole))], full)
            put_bit(last, last, word(0))
            return context.get_dummy_value()

        return types.void(*kinds), written

    return bits


def _row(context, builder, kinds, given):
    """Address of a row of results (designs, rows, N), and N."""
    from numba import types
    from numba.core import cgutils

    array = context.make_array(kinds[0])(context, builder, given[0])
    _, rows, size = cgutils.unpack_tuple(builder, array.shape)
    design, row = (
        context.cast(builder, part, kind, types.intp) for part, kind in zip(given[1:], kinds[1:], strict=True)
    )
    return builder.gep(array.data, [builder.mul(builder.add(builder.mul(design, rows), row), size)]), size


def over_columns(function, rows):
    """For numba: ``over(table, count)`` replaces the first rows of a table by a function of all, in `count` columns.

    ``function(parts, chosen, sqrt)`` returns fewer rows than the table has. The number of columns is rounded up to a
    multiple of `COLUMNS`, which the table must have.
    """
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def over(typing, table, count):
        def written(context, builder, signature, given):
            array = context.make_array(table)(context, builder, given[0])
            size = cgutils.unpack_tuple(builder, array.shape)[1]
            word = size.type
            writer = Writer(builder, COLUMNS)
            wanted = context.cast(builder, given[1], count, types.intp)
            times = builder.sdiv(builder.add(wanted, word(COLUMNS - 1)), word(COLUMNS))
            with cgutils.for_range(builder, times) as each:
                start = builder.mul(each.index, word(COLUMNS))
                places = [
                    builder.gep(array.data, [builder.add(builder.mul(size, word(row)), start)]) for row in range(rows)
                ]
                found = function([writer.loaded(place) for place in places], writer.chosen, writer.sqrt)
                for part, place in zip(found, places, strict=False):
                    writer.store(part, place)
            return context.get_dummy_value()

        return types.void(table, count), written

    return over


def summing(term):
    """For numba: ``sums(results, design, row)``: sums of a term over the values at even and at odd places of a row.

    Results have the shape (designs, rows, N). The order of additions is the same on every processor.
    """
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def sums(typing, results, design, row):
        kinds = results, design, row

        def written(context, builder, signature, given):
            values, size = _row(context, builder, kinds, given)
            word = size.type
            vectors, numbers = Writer(builder, AT_ONCE), Writer(builder, 1)
            sides = cgutils.alloca_once_value(builder, vectors.held(0.0))
            blocks = builder.sdiv(size, word(AT_ONCE))
            with cgutils.for_range(builder, blocks) as each:
                start = builder.mul(each.index, word(AT_ONCE))
                more = term(vectors.loaded(builder.gep(values, [start]))).value
                builder.store(builder.fadd(builder.load(sides), more), sides)
            whole, lanes = builder.load(sides), AT_ONCE
            while lanes > 2:
                lanes //= 2
                low, high = (
                    ir.Constant(ir.VectorType(ir.IntType(32), lanes), [*range(k, k + lanes)]) for k in (0, lanes)
                )
                whole = builder.fadd(*(builder.shuffle_vector(whole, whole, half) for half in (low, high)))
            pair = [
                cgutils.alloca_once_value(builder, builder.extract_element(whole, ir.IntType(32)(k))) for k in (0, 1)
            ]
            for parity, side in enumerate(pair):
                first = builder.add(builder.mul(blocks, word(AT_ONCE)), word(parity))
                with cgutils.for_range_slice(builder, first, size, word(2)) as (place, _):
                    more = term(numbers.loaded(builder.gep(values, [place]))).value
                    builder.store(builder.fadd(builder.load(side), more), side)
            return context.make_tuple(builder, signature.return_type, [builder.load(side) for side in pair])

        return types.UniTuple(results.dtype, 2)(*kinds), written

    return sums


def lowest_bit():
    """For numba: ``place(word)``, the number of the lowest bit set in a uint64, as int64."""
    from numba import types
    from numba.extending import intrinsic

    @intrinsic
    def place(typing, word):
        def written(context, builder, signature, given):
            return builder.cttz(given[0], context.get_constant(types.boolean, True))

        return types.int64(types.uint64), written

    return place


class Writer:
    """Emits LLVM instructions on vectors of `count` doubles."""

    def __init__(self, builder, count):
        from llvmlite import ir

        self.builder, self._one = builder, ir.DoubleType()
        self._kind = self._one if count == 1 else ir.VectorType(self._one, count)
        self._count = count

    def loaded(self, place):
        return _Lanes(self, self.builder.load(self._in_memory(place), align=8))

    def store(self, part, place):
        self.builder.store(self.held(part), self._in_memory(place), align=8)

    def held(self, part):
        """Value of an operand, or a plain number."""
        if isinstance(part, _Lanes):
            return part.value
        return self._kind(float(part)) if self._count == 1 else self._kind([float(part)] * self._count)

    def written(self, operation, *parts):
        return _Lanes(self, getattr(self.builder, operation)(*map(self.held, parts)))

    def called(self, name, part):
        """Intrinsic function of LLVM, of all lanes."""
        from llvmlite import ir
        from numba.core import cgutils

        lanes = "" if self._count == 1 else f"v{self._count}"
        kind = ir.FunctionType(self._kind, [self._kind])
        function = cgutils.get_or_insert_function(self.builder.module, kind, f"llvm.{name}.{lanes}f64")
        return _Lanes(self, self.builder.call(function, [self.held(part)]))

    def sqrt(self, part):
        return self.called("sqrt", part)

    def holds(self, sign, one, other):
        """A bit for each lane: whether the comparison holds; it does not if an operand is NaN."""
        return self.builder.fcmp_ordered(sign, self.held(one), self.held(other))

    def chosen(self, sign, one, other, here, there):
        """`here` where the comparison of two operands holds, else `there`."""
        holds = self.holds(sign, one, other)
        return _Lanes(self, self.builder.select(holds, self.held(here), self.held(there)))

    def _in_memory(self, place):
        return place if self._count == 1 else self.builder.bitcast(place, self._kind.as_pointer())


def _operators(instruction) -> tuple[Any, Any]:
    """Methods of an operator with the operand on its left, and on its right."""
    return (
        lambda self, other: self._writer.written(instruction, self, other),
        lambda self, other: self._writer.written(instruction, other, self),
    )


class _Lanes:
    """An operand: a vector of doubles or one double; its operators emit instructions."""

    __slots__ = ("_writer", "value")

    def __init__(self, writer, value):
        self._writer, self.value = writer, value

    def __neg__(self):
        return self._writer.written("fneg", self)

    def __abs__(self):
        return self._writer.called("fabs", self)

    __add__, __radd__ = _operators("fadd")
    __sub__, __rsub__ = _operators("fsub")
    __mul__, __rmul__ = _operators("fmul")
    __truediv__, __rtruediv__ = _operators("fdiv")
