"""Compiled loops called by other machine code, which so has their results while they are in its nearest memory."""


def address_of(loop) -> int:
    """Where the machine code of a compiled loop begins; it is there as long as the loop is."""
    (made,) = loop.overloads.values()
    return made.library.get_pointer_to_function(made.fndesc.llvm_func_name)


def calling():
    """For numba: ``call(address, angle, sine, cosine, parameters, tables, results)`` of a loop; see `writing.loop`."""
    from numba import types
    from numba.core.errors import TypingError
    from numba.extending import intrinsic

    taken = [types.Array(types.float64, axes, "C", readonly=True) for axes in (2, 2, 2, 2, 3)]
    taken.append(types.Array(types.float64, 3, "C"))

    @intrinsic
    def call(typing, address, angle, sine, cosine, parameters, tables, results):
        given = angle, sine, cosine, parameters, tables, results
        if any(
            (one.ndim, one.dtype, one.layout) != (two.ndim, two.dtype, "C")
            for one, two in zip(given, taken, strict=True)
        ):
            raise TypingError(f"a loop takes other arrays than {given}")

        def written(context, builder, signature, values):
            kind = context.call_conv.get_function_type(types.none, taken)
            loop = builder.inttoptr(values[0], kind.as_pointer())
            arrays = [context.cast(builder, *part) for part in zip(values[1:], given, taken, strict=True)]
            context.call_conv.call_function(builder, loop, types.none, taken, arrays)
            return context.get_dummy_value()

        return types.void(types.int64, *given), written

    return call
