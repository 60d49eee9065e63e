"""What a load is: its value, whether it is given, its period and its sense, asked of any load alike."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import load

TURN = 2 * np.pi
TABLE = ks.Table(np.linspace(0.0, 2 * TURN, 9)[:-1], np.array([0.0, 1, 2, 3, 4, 3, 2, 1]), period=2 * TURN)
LOADS = {
    "number": (ks.ProcessForce(-3.0), -3.0, True, TURN),
    "table": (ks.Torque(TABLE, on="crank"), TABLE, False, 2 * TURN),
    "weight": (ks.Gravity(), None, True, TURN),
    "spring": (ks.Spring(1e3, 0.5), None, True, TURN),
}


@pytest.mark.parametrize("name", LOADS)
def test_value_and_period_are_those_of_what_was_given(name):
    item, value, given, period = LOADS[name]
    assert load.value_of(item) is value or load.value_of(item) == value
    assert (load.is_given(item), item.period) == (given, period)


def test_a_function_is_a_value_that_is_not_given():
    item = ks.ProcessForce(lambda motion: motion.crank_angle)
    assert not load.is_given(item)
    assert callable(load.value_of(item))


def test_the_sense_is_that_of_the_value_and_of_the_largest_where_it_is_zero():
    mechanism = ks.crank_slider(0.1, 0.4)
    force = ks.ProcessForce(np.array([2.0, 0.0, -5.0]))
    motion = ks.solve(mechanism, np.array([0.0, 1.0, 2.0]), crank_speed=1.0, loads=force).dynamics
    assert motion.loads[0].sense(motion).tolist() in ([1.0, 1.0, -1.0], [1.0, -1.0, -1.0])
    assert ks.ProcessForce(-3.0).sense(motion) == -1.0
    assert ks.ProcessForce(lambda motion: 0.0).sense(motion) == 1.0
