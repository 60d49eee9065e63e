"""Rows looked through in vectors: the same bits and sums as NumPy's, for any number of values."""

import math

import numpy as np
import pytest

from kinetostatics.engines import scanning
from support import by_arrays

SIZES = (12, 63, 64, 65, 66, 67, 127, 128, 130, 360, 1441)
SCANS = {"rising": 3, "falling": 3, "changing": 2}


def values_of(size):
    """Waves with plateaus, zeros of both signs, and numbers that are none."""
    found = np.round(5.0 * np.sin(np.arange(size) * 0.7)) * np.random.default_rng(size).choice([1.0, -1.0], size)
    found[7::29] = math.nan
    found[5::31] = -0.0
    return found


def jitted(intrinsic, arguments):
    from numba import njit

    names = ", ".join("abc"[:arguments])
    scope = {"intrinsic": intrinsic}
    exec(f"def call({names}):\n    return intrinsic({names})", scope)
    return njit(scope["call"])


@pytest.mark.slow_start
@pytest.mark.parametrize("name", SCANS)
def test_bits_are_set_where_it_holds_and_nowhere_else(numba, name):
    holds, reach = getattr(scanning, name), SCANS[name]
    own, expected = jitted(scanning.bits_where(holds, reach), 2), by_arrays.bits_where(holds, reach)
    for size in SIZES:
        values = values_of(size)
        words, wanted = np.full((2, size // 64 + 1), 2**64 - 1, np.uint64)
        own(values, words)
        expected(values, wanted)
        filled = (size - reach) // 64 + 1
        assert wanted[:filled].any()
        assert np.array_equal(words[:filled], wanted[:filled]), size


def test_what_holds_is_what_reductions_mean():
    rows = np.array([[0.0, 1.0, 1.0, 0.0, math.nan, -1.0, -0.0, 0.0]])
    places = {name: by_arrays_places(name, rows[0]) for name in SCANS}
    assert places == {"rising": [1, 4, 6], "falling": [3, 4], "changing": [4, 5]}


def by_arrays_places(name, values):
    """Places in the middle of three, or the first of two."""
    words, reach = np.zeros(1, np.uint64), SCANS[name]
    by_arrays.bits_where(getattr(scanning, name), reach)(values, words)
    return [k + reach - 2 for k in range(64) if int(words[0]) >> k & 1]


@pytest.mark.slow_start
def test_sums_of_every_other_value_lose_little(numba):
    terms = {"plain": lambda value: value, "sizes": abs, "squares": lambda value: value * value}
    for name, term in terms.items():
        own = jitted(scanning.summing(term), 1)
        for size in SIZES:
            values = np.random.default_rng(size).normal(size=size)
            wanted = [math.fsum(term(values[first::2]).tolist()) for first in (0, 1)]
            scale = np.abs(term(values)).sum()
            assert np.abs(np.subtract(own(values), wanted)).max() < 2e-16 * scale, (name, size)


@pytest.mark.slow_start
def test_the_lowest_bit_is_found_at_either_end(numba):
    own = jitted(scanning.lowest_bit(), 1)
    for bit in (0, 1, 31, 32, 63):
        assert own(np.uint64(2**63 | 2**bit)) == bit == by_arrays.lowest_bit()(2**63 | 2**bit)
