"""Rows of numbers looked through in vectors, for numba: where something holds, a bit for each place, and sums."""

from .vectors import Writer

AT_ONCE = 64
"""Numbers that are compared, or added to as many sums, at once."""


def rising(writer, before, here, after):
    """Whether the middle of three numbers is higher than the one before and not lower than the one behind, or none."""
    return _peaking(writer, ">", before, here, after)


def falling(writer, before, here, after):
    """The same of a number that is lower."""
    return _peaking(writer, "<", before, here, after)


def _peaking(writer, sign, before, here, after):
    write = writer.builder
    goes_on = write.or_(writer.holds(sign, after, here), write.not_(writer.holds(sign, here, before)))
    return write.or_(write.not_(goes_on), write.not_(writer.holds("==", here, here)))


def changing(writer, here, after):
    """Whether only one of two numbers is negative."""
    return writer.builder.xor(writer.holds("<", here, 0.0), writer.holds("<", after, 0.0))


def bits_where(holds, reach):
    """For numba: ``bits(values, words)``, which sets bit k of a row of uint64 where `holds` of values[k:k + reach].

    There are as many bits as there are such places; those of the last word beyond them are 0.
    """
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def bits(typing, values, words):
        def written(context, builder, signature, given):
            row, into = (
                context.make_array(kind)(context, builder, part)
                for kind, part in zip((values, words), given, strict=True)
            )
            (size,) = cgutils.unpack_tuple(builder, row.shape)
            word = size.type
            count, whole = builder.sub(size, word(reach - 1)), word(AT_ONCE)

            def at(start, lanes):
                writer = Writer(builder, context.get_data_type(values.dtype), lanes)
                places = (builder.gep(row.data, [builder.add(start, word(k))]) for k in range(reach))
                return holds(writer, *map(writer.loaded, places))

            def vector(start):
                return builder.bitcast(at(start, AT_ONCE), word)

            with builder.if_else(builder.icmp_signed("<", count, whole)) as (few, many):
                with few:
                    total = cgutils.alloca_once_value(builder, word(0))
                    with cgutils.for_range(builder, count) as each:
                        bit = builder.shl(builder.zext(at(each.index, 1), word), each.index)
                        builder.store(builder.or_(builder.load(total), bit), total)
                    builder.store(builder.load(total), into.data)
                with many:
                    full, rest = builder.sdiv(count, whole), builder.srem(count, whole)
                    with cgutils.for_range(builder, full) as each:
                        builder.store(vector(builder.mul(each.index, whole)), builder.gep(into.data, [each.index]))
                    with builder.if_then(builder.icmp_signed(">", rest, word(0))):
                        last = builder.lshr(vector(builder.sub(count, whole)), builder.sub(whole, rest))
                        builder.store(last, builder.gep(into.data, [full]))
            return context.get_dummy_value()

        return types.void(values, words), written

    return bits


def summing(term):
    """For numba: ``sums(values)``: the sum of a term of every other value from the first on, and of those between.

    Many sums go side by side, in an order of its own, whatever the processor.
    """
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic

    @intrinsic
    def sums(typing, values):
        def written(context, builder, signature, given):
            row = context.make_array(values)(context, builder, given[0])
            (size,) = cgutils.unpack_tuple(builder, row.shape)
            word, one = size.type, context.get_data_type(values.dtype)
            vectors, numbers = Writer(builder, one, AT_ONCE), Writer(builder, one, 1)
            sides = cgutils.alloca_once_value(builder, vectors.held(0.0))
            blocks = builder.sdiv(size, word(AT_ONCE))
            with cgutils.for_range(builder, blocks) as each:
                start = builder.mul(each.index, word(AT_ONCE))
                more = term(vectors.loaded(builder.gep(row.data, [start]))).value
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
                    more = term(numbers.loaded(builder.gep(row.data, [place]))).value
                    builder.store(builder.fadd(builder.load(side), more), side)
            return context.make_tuple(builder, signature.return_type, [builder.load(side) for side in pair])

        return types.UniTuple(values.dtype, 2)(values), written

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
