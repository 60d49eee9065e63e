"""Rows looked through in vectors: the same bits and sums as NumPy's, for any number of values."""

import math

import numpy as np
import pytest

from kinetostatics.engines import scanning
from support import by_arrays

ROWS = (12, 63, 64, 65, 66, 67, 127, 128, 130, 360, 1441)
SCANS = ("rising", "falling", "negative")


def values_of(size):
    """Waves with plateaus, zeros of both signs, and numbers that are none."""
    found = np.round(5.0 * np.sin(np.arange(size) * 0.7)) * np.random.default_rng(size).choice([1.0, -1.0], size)
    found[7::29] = math.nan
    found[5::31] = -0.0
    return found


def jitted(intrinsic, arguments):
    from numba import njit

    names = ", ".join("abcd"[:arguments])
    scope = {"intrinsic": intrinsic}
    exec(f"def call({names}):\n    return intrinsic({names})", scope)
    return njit(scope["call"])


@pytest.mark.slow_start
def test_bits_are_set_exactly_where_conditions_hold(numba):
    conditions = [getattr(scanning, name) for name in SCANS]
    own, expected = jitted(scanning.bits_of_steps(*conditions), 4), by_arrays.bits_of_steps(*conditions)
    for size in ROWS:
        results = np.zeros((2, 3, size))
        results[1, 2] = values_of(size)
        words, wanted = np.full((2, 3, size // 64 + 1), 2**64 - 1, np.uint64)
        own(results, 1, 2, words)
        expected(results, 1, 2, wanted)
        filled = (size + 63) // 64
        assert wanted[:, :filled].any(axis=1).all()
        assert np.array_equal(words[:, :filled], wanted[:, :filled]), size


def test_what_holds_is_what_reductions_mean():
    values = np.array([0.0, 1.0, 1.0, 0.0, math.nan, -1.0, -0.0, 0.0])
    after = np.roll(values, -1)
    places = {name: np.flatnonzero(getattr(scanning, name)(by_arrays.WRITER, values, after)).tolist() for name in SCANS}
    assert places == {"rising": [0, 3, 4, 5], "falling": [2, 3, 4], "negative": [5]}


@pytest.mark.slow_start
def test_columns_of_a_table_become_a_function_of_them(numba):
    """Up to the next multiple of so many, and not beyond."""

    def function(parts, chosen, sqrt):
        one, other, *_ = parts
        return chosen("<", one, other, 2.0 * one, 3.0), sqrt(abs(one - other))

    own, expected = jitted(scanning.over_columns(function, 3), 2), by_arrays.over_columns(function, 3)
    for count in (1, scanning.COLUMNS, scanning.COLUMNS + 1):
        table = np.random.default_rng(count).normal(size=(3, 4 * scanning.COLUMNS))
        found, wanted = table.copy(), table.copy()
        own(found, count)
        expected(wanted, count)
        assert np.array_equal(found[:, :count], wanted[:, :count])
        beyond = -(-count // scanning.COLUMNS) * scanning.COLUMNS
        assert np.array_equal(found[:, beyond:], table[:, beyond:])
        assert np.array_equal(found[2], table[2])


@pytest.mark.slow_start
def test_sums_of_every_other_value_lose_little(numba):
    terms = {"plain": lambda value: value, "sizes": abs, "squares": lambda value: value * value}
    for name, term in terms.items():
        own = jitted(scanning.summing(term), 3)
        for size in ROWS:
            values = np.random.default_rng(size).normal(size=size)
            wanted = [math.fsum(term(values[first::2]).tolist()) for first in (0, 1)]
            scale = np.abs(term(values)).sum()
            assert np.abs(np.subtract(own(np.array([[0.0 * values, values]]), 0, 1), wanted)).max() < 2e-16 * scale, (
                name,
                size,
            )


@pytest.mark.slow_start
def test_the_lowest_bit_is_found_at_either_end(numba):
    own = jitted(scanning.lowest_bit(), 1)
    for bit in (0, 1, 31, 32, 63):
        assert own(np.uint64(2**63 | 2**bit)) == bit == by_arrays.lowest_bit()(2**63 | 2**bit)
