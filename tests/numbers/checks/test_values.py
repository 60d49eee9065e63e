"""What a value is: a plain number, an array of them, or what to hand in instead."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from kinetostatics.numbers.checks.values import UnfitError, number


@pytest.mark.parametrize("value", [2, 2.0, np.float32(2), np.int8(2), Fraction(2), Decimal(2), np.array(2)])
def test_any_plain_number_is_the_float(value):
    found = number(value, table=False)
    assert (found, type(found)) == (2.0, float)


def test_designs_stand_in_a_column_and_a_table_in_a_row():
    column = np.ones((3, 1))
    assert number(column, table=False).tolist() == column.tolist()
    assert number(np.ones(3), table=True).tolist() == [1.0] * 3


@pytest.mark.parametrize("value", [True, "2", 2j, None, object(), {2.0}, np.array(["2"])])
def test_what_is_none_is_unfit(value):
    with pytest.raises(UnfitError):
        number(value, table=False)
