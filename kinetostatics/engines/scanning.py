"""Rows of numbers looked through in vectors, for numba: where something holds, a bit for each place, and sums."""

import inspect
import sys
from functools import cache
from hashlib import sha256

from ..version import __version__

AT_ONCE = 64
"""Numbers that are compared, or added to as many sums, at once."""
COLUMNS = 8
"""Columns of a table that are computed at once."""


@cache
def edition(*others) -> str:
    """What tells machine code written by this version of the module, and of others that it is made by, from another's.

    Numba knows the text that it compiles, not the modules that it is written by.
    """
    modules = sys.modules[__name__], *others
    try:
        text = "".join(map(inspect.getsource, modules))
    except OSError:
        text = __version__
    return sha256(text.encode()).hexdigest()[:8]


def rising(writer, here, after):
    """Whether the second of two numbers is higher, or one of them is none."""
    return writer.builder.not_(writer.holds("<=", after, here))


def falling(writer, here, after):
    """Whether the second of two numbers is lower, or one of them is none."""
    return writer.builder.not_(writer.holds(">=", after, here))


def negative(writer, here, after):
    """Whether the first of two numbers is negative."""
    return writer.holds("<", here, 0.0)


def bits_of_steps(*conditions):
    """For numba: ``bits(results, design, row, words)``: sets bit k of words where a condition holds of step k.

    That is the step from value k in a row of results (designs, rows, N) to the next, or from the last to the first.
    There is a row of uint64 for each condition, with N bits; those of the last word beyond them are 0.
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
    """Where a row of results (designs, rows, N) begins in memory, and N."""
    from numba import types
    from numba.core import cgutils

    array = context.make_array(kinds[0])(context, builder, given[0])
    _, rows, size = cgutils.unpack_tuple(builder, array.shape)
    design, row = (
        context.cast(builder, part, kind, types.intp) for part, kind in zip(given[1:], kinds[1:], strict=True)
    )
    return builder.gep(array.data, [builder.mul(builder.add(builder.mul(design, rows), row), size)]), size


def over_columns(function, rows):
    """For numba: ``over(table, count)``: the first rows of a table become a function of all, in so many columns.

    ``function(parts, chosen, sqrt)`` gives fewer parts than there are rows. It is computed in a multiple of `COLUMNS`,
    which the table must have.
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
    """For numba: ``sums(results, design, row)``: the sum of a term of every other value, and of those between.

    These are a row of results (designs, rows, N). Many sums go side by side, in an order of its own, whatever the
    processor.
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
    """For numba: ``place(word)`` of the lowest bit that is set in a uint64, as int64."""
    from numba import types
    from numba.extending import intrinsic

    @intrinsic
    def place(typing, word):
        def written(context, builder, signature, given):
            return builder.cttz(given[0], context.get_constant(types.boolean, True))

        return types.int64(types.uint64), written

    return place


class Writer:
    """LLVM instructions on doubles, as many at once as told."""

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
        """Function of LLVM's own of all lanes together."""
        from llvmlite import ir
        from numba.core import cgutils

        lanes = "" if self._count == 1 else f"v{self._count}"
        kind = ir.FunctionType(self._kind, [self._kind])
        function = cgutils.get_or_insert_function(self.builder.module, kind, f"llvm.{name}.{lanes}f64")
        return _Lanes(self, self.builder.call(function, [self.held(part)]))

    def sqrt(self, part):
        return self.called("sqrt", part)

    def holds(self, sign, one, other):
        """Whether operands compare so, a bit for each lane; not if one is no number."""
        return self.builder.fcmp_ordered(sign, self.held(one), self.held(other))

    def chosen(self, sign, one, other, here, there):
        """The one operand where two others compare so, else the other."""
        holds = self.holds(sign, one, other)
        return _Lanes(self, self.builder.select(holds, self.held(here), self.held(there)))

    def _in_memory(self, place):
        return place if self._count == 1 else self.builder.bitcast(place, self._kind.as_pointer())


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
        return self._writer.called("fabs", self)
