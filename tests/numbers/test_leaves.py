"""Parameter trees: a structure that equals that of its like, and numbers that make it whole again."""

import numpy as np

import kinetostatics as ks
from kinetostatics.numbers.leaves import Leaves, mapped, put_together, taken_apart, wider


def parts(item):
    leaves = Leaves()
    return taken_apart(item, leaves), leaves


def saw(mass=600.0, length=2.0, inertia=0.0):
    return ks.crank_slider(0.3, length, slider=ks.Link(mass, inertia=inertia))


def test_other_numbers_have_the_same_structure_and_a_zero_has_another():
    (one, first), (other, second) = parts(saw()), parts(saw(700.0, 1.9))
    assert one == other
    assert hash(one) == hash(other)
    assert first.numbers != second.numbers
    assert parts(saw(0.0))[0] != one
    assert parts(saw(inertia=1.0))[0] != one


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
