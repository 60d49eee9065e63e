"""Parameter trees: what numbers make whole again, and copies with other numbers."""

import numpy as np

from kinetostatics.numbers.leaves import mapped, put_together, wider
from support.taken_apart import parts, saw


def test_a_tree_put_together_again_has_the_numbers_given():
    structure, leaves = parts(saw())
    numbers = iter([2.0 * number for number in leaves.numbers])
    made = put_together(structure, lambda: next(numbers), None, None)
    assert (made.crank.length, made.groups[0].coupler_length, made.links["slider"].mass) == (0.6, 4.0, 1200.0)


def test_every_number_can_be_mapped_and_the_rest_stays():
    made = mapped(saw(), lambda number: -number)
    assert (made.crank.length, made.links["slider"].mass) == (-0.3, -600.0)
    assert made.name == saw().name


def test_shapes_widen_as_numpy_broadcasts():
    assert wider((5,), np.ones((3, 1)), 2.0) == (3, 5)
