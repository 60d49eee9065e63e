"""Scenes taken apart: the structure equals that of its like."""

import numpy as np
import pytest

from kinetostatics.numbers.leaves import NUMBER, Axis, Kept
from support.taken_apart import parts, saw


def test_other_numbers_have_the_same_structure_and_a_zero_has_another():
    (one, first), (other, second) = parts(saw()), parts(saw(700.0, 1.9))
    assert one == other
    assert hash(one) == hash(other)
    assert first.numbers != second.numbers
    assert parts(saw(0.0))[0] != one
    assert parts(saw(inertia=1.0))[0] != one


def test_a_zero_that_is_kept_and_an_array_of_designs_are_numbers_and_an_axis_is_none():
    structure, leaves = parts((0.0, Kept(0.0), np.array([[1.0], [2.0]]), Axis.of((1.0, 0.0)), 3))
    assert structure == (tuple, 0.0, NUMBER, NUMBER, Axis((1.0, 0.0)), NUMBER)
    assert [np.shape(number) for number in leaves.numbers] == [(), (2, 1), ()]
    assert leaves.lasting


@pytest.mark.parametrize("table", [np.arange(3.0), np.ones((2, 4))])
def test_values_for_each_crank_angle_are_tables(table):
    _, leaves = parts(table)
    assert not leaves.numbers
    assert leaves.tables == [table] if table.ndim == 1 else leaves.tables[0] is table


def test_what_may_change_unseen_is_taken_apart_each_time():
    class Own:
        pass

    own = Own()
    (one, leaves), (other, _) = parts((own,)), parts((Own(),))
    assert not leaves.lasting
    assert one != other
    assert one == parts((own,))[0]
