"""What friction of a pair is: sizes, directions and kinks of what it watches."""

import numpy as np
import pytest

from kinetostatics.mechanics.friction_laws import Law, bends, direction_of, larger, size_of, smaller

PARTS = [(3.0, -4.0), (-3.0, None), (None, 2.0), (-1.0, 0.5), (2.0, 2.5)]
SIZES = {"length": np.hypot, "larger": lambda a, b: max(abs(a), abs(b))}


@pytest.mark.parametrize("parts", PARTS)
@pytest.mark.parametrize("kind", SIZES)
def test_factor_times_direction_times_parts_is_factor_times_size(kind, parts):
    law = Law("B", 0.3, None, kind, ())
    size = SIZES[kind](*(0.0 if part is None else part for part in parts))
    assert size_of(kind, parts) == pytest.approx(size, rel=1e-15)
    along = zip(direction_of(law, parts), parts, strict=True)
    assert sum(one * other for one, other in along if other is not None) == pytest.approx(0.3 * size, rel=1e-15)


def test_a_number_has_its_size_or_is_itself():
    assert size_of("size", (-2.0,)) == 2.0
    assert size_of("itself", (-2.0,)) == -2.0
    assert direction_of(Law("B", 0.3, None, "itself", ()), (-2.0,)) == (0.3,)
    assert direction_of(Law("B", 0.3, None, "size", ()), (-2.0,)) == (-0.3,)
    assert size_of("length", (None, None)) is None


def test_kinks_lie_where_a_size_turns_and_where_the_larger_changes():
    assert bends("size", (-2.0,)) == [-2.0]
    assert bends("length", (3.0, 4.0)) == []
    assert bends("larger", (3.0, -4.0)) == [3.0, -4.0, -1.0]


def test_larger_and_smaller_are_those_of_two():
    assert (larger(2.0, -3.0), smaller(2.0, -3.0)) == (2.0, -3.0)
