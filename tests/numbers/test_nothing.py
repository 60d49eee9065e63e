"""The zero that absorbs and is left out: as arithmetic with 0, but without an operation."""

import numpy as np
import pytest

from kinetostatics.numbers.nothing import NOTHING, absent


@pytest.mark.parametrize("value", [3.5, np.array([1.0, -2.0])])
def test_sums_leave_it_out_and_products_become_it(value):
    assert (NOTHING + value) is value
    assert (value + NOTHING) is value
    assert (value - NOTHING) is value
    assert np.array_equal(NOTHING - value, -value)
    assert all(
        found is NOTHING for found in (NOTHING * value, value * NOTHING, NOTHING / value, -NOTHING, abs(NOTHING))
    )
    assert float(NOTHING) == 0.0


def test_zero_is_absent_and_nothing_else_is():
    assert [absent(value) for value in (NOTHING, 0, 0.0, -0.0)] == [None] * 4
    zeros = np.zeros(3)
    assert absent(zeros) is zeros
    assert absent(1e-300) == 1e-300
