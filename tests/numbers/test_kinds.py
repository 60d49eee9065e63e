"""What all items of one structure have in common is found once, kept by structure, and never grows without bound."""

import pickle

import kinetostatics as ks
from kinetostatics.numbers import kinds


def scene(mass=1.0, length=0.2):
    return ks.Scene(ks.crank_slider(0.05, length, slider=ks.Link(mass)), crank_speed=10.0).solve(8)


def test_scenes_that_differ_in_numbers_are_of_one_kind_and_others_are_not():
    assert scene(1.0).kind is scene(2.0, 0.3).kind
    assert scene(1.0).kind is not scene(0.0).kind


def test_each_number_has_its_place_among_the_leaves():
    s = scene()
    mechanism, speed, *_ = s.kind.numbered
    _, leaves = s.apart
    assert leaves.numbers[mechanism.crank.length] == 0.05
    assert leaves.numbers[mechanism.groups[0].coupler_length] == 0.2
    assert leaves.numbers[speed] == 10.0


def test_a_question_is_asked_once():
    asked = []
    kind = kinds.Kind((tuple,))
    assert [kind.answer(asked.append), kind.answer(asked.append)] == [None, None]
    assert asked == [kind]


def test_only_so_many_kinds_are_kept_and_the_longest_unused_goes_first():
    kinds.forget()
    first = kinds.of(("first",))
    for place in range(kinds.MOST - 1):
        kinds.of((place,))
    assert kinds.of(("first",)) is first
    kinds.of(("one more",))
    assert kinds.of(("first",)) is first
    assert len(kinds._kinds) == kinds.MOST
    kinds.forget()


def test_a_solution_that_has_computed_can_be_pickled():
    s = scene()
    torque = s.balancing_torque
    assert (pickle.loads(pickle.dumps(s)).balancing_torque == torque).all()
