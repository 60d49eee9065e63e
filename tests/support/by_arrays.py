"""What numba is given by `engines.vectors` and `engines.scanning`, done by NumPy: for programs run without numba."""

import operator
from types import FunctionType, SimpleNamespace

import numpy as np

from kinetostatics.engines.operations import BY_DESIGN

COMPARED = {">": operator.gt, "<": operator.lt, "==": operator.eq}
WRITER = SimpleNamespace(
    holds=lambda sign, one, other: COMPARED[sign](one, other),
    builder=SimpleNamespace(or_=operator.or_, xor=operator.xor, not_=operator.invert),
)


def over_angles(line):
    computed = FunctionType(line.__code__, BY_DESIGN)

    def at_angles(angle, sine, cosine, tables, results, first, table, design, numbers):
        with np.errstate(all="ignore"):
            found = computed(angle[first], sine[first], cosine[first], tables[:, table], numbers)
        for place, output in enumerate(found):
            results[design, place] = output

    return at_angles


def bits_where(holds, reach):
    def bits(values, words):
        found = holds(WRITER, *np.lib.stride_tricks.sliding_window_view(values, reach).T)
        packed = np.packbits(found, bitorder="little")
        words.view(np.uint8)[:] = 0
        words.view(np.uint8)[: packed.size] = packed

    return bits


def summing(term):
    return lambda values: (term(values[::2]).sum(), term(values[1::2]).sum())


def lowest_bit():
    return lambda word: (int(word) & -int(word)).bit_length() - 1


def stand_in(patch):
    """Put these in place of what is written for numba."""
    from kinetostatics.engines import scanning, vectors

    patch.setattr(vectors, "over_angles", over_angles)
    for own in (bits_where, summing, lowest_bit):
        patch.setattr(scanning, own.__name__, own)
