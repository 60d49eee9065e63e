"""Functions of loads are called twice at the same crank angles, the first time that they are met and never again."""

import itertools

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

MACHINE = ks.crank_slider(0.1, 0.4, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0))
ANGLES = np.linspace(0.0, 6.0, 40)


def solved(load):
    return ks.solve(MACHINE, ANGLES, crank_speed=5.0, loads=load, engine="numpy")


def test_counting_functions_are_refused():
    calls = []

    def push(motion):
        calls.append(np.shape(motion.crank_angle))
        return -3.0 * motion.slider_velocity

    solved(ks.ProcessForce(push))
    assert calls == [(2,), (2,)]
    solved(ks.ProcessForce(push))
    assert len(calls) == 2


def test_methods_and_own_loads_are_remembered():
    class Own:
        on, calls = "slider", []

        def push(self, motion):
            """Count, but give the same."""
            self.calls.append(1)
            return -3.0 * motion.slider_velocity

    for _ in range(3):
        solved(Own())
        solved(ks.ProcessForce(Own().push))
    assert len(Own.calls) == 2


@every("give", [lambda q: 1 / 0, lambda q: "text", lambda q: q.balancing_torque])
def test_failing_function_is_left_to_its_user(give):
    s = solved(ks.ProcessForce(give))
    with pytest.raises((ZeroDivisionError, ks.ParameterError)):
        s.balancing_torque  # noqa: B018


def test_what_has_no_hash_is_asked_each_time():
    class Push:
        __hash__ = None

        def __init__(self):
            self.count = itertools.count(1)

        def __call__(self, motion):
            """Give the same, and count."""
            next(self.count)
            return -3.0 * motion.slider_velocity

    push = Push()
    solved(ks.ProcessForce(push))
    solved(ks.ProcessForce(push))


# What a user's function of the motion gives


PUMP = ks.crank_slider(0.1, 0.4)
TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)


def guide_force(function):
    return ks.solve(PUMP, TURN, crank_speed=2.0, loads=ks.ProcessForce(function)).balancing_torque


def test_function_returns_one_number_or_one_an_angle():
    found = guide_force(lambda motion: -50.0 * motion.travel_velocity("slider"))
    speeds = ks.solve(PUMP, TURN, crank_speed=2.0).slider_velocity
    assert found == pytest.approx(50.0 * speeds**2 / 2.0, abs=1e-12)
    assert np.array_equal(guide_force(lambda motion: 3), guide_force(lambda motion: np.full(12, 3.0)))
