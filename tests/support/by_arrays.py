"""The loops of `engines.simd_reductions`, done by NumPy: for programs run without numba."""

import operator

import numpy as np

COMPARED = {"<": operator.lt, "<=": operator.le, "==": operator.eq, ">=": operator.ge}


def bits_of_steps(*conditions):
    def bits(results, design, row, words):
        values = results[design, row].tolist()
        steps = list(zip(values, [*values[1:], values[0]], strict=True))
        found = [[condition(*step) for step in steps] for condition in conditions]
        packed = np.packbits(found, axis=-1, bitorder="little")
        words = words[: len(conditions)].view(np.uint8)
        words[:] = 0
        words[:, : packed.shape[1]] = packed

    return bits


def over_columns(function, rows):
    def over(table, count):
        found = function([*table[:rows, :count]], chosen, np.sqrt)
        for place, part in enumerate(found):
            table[place, :count] = part

    def chosen(sign, one, other, here, there):
        return np.where(COMPARED[sign](one, other), here, there)

    return over


def summing(term):
    def sums(results, design, row):
        values = term(results[design, row])
        return values[::2].sum(), values[1::2].sum()

    return sums


def lowest_bit():
    return lambda word: (int(word) & -int(word)).bit_length() - 1


def stand_in(patch):
    """Put these in place of what is written for numba."""
    from kinetostatics.engines import simd_reductions

    for own in (bits_of_steps, over_columns, summing, lowest_bit):
        patch.setattr(simd_reductions, own.__name__, own)
