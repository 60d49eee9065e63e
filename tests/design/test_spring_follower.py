"""The stretch of a spring that holds a given energy: the equation itself, kinks, and what lifts off."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.design import spring_follower
from kinetostatics.errors import ParameterError
from kinetostatics.numbers.panels import Panels

TURN = 2 * np.pi
ANGLES = np.linspace(0.0, TURN, 1001)


def energy(slope):
    panels = Panels.of(slope, TURN)
    return panels.plus(-panels.mean).integral


def residual(slope, level, mass, stiffness):
    """Mu x'^2 / 2 + k x^2 / 2 + E - C, and the force mu x'' + k x."""
    e = energy(slope)
    x, first, second = spring_follower.stretched(e, level, mass, stiffness).at(ANGLES, 2)
    return mass * first**2 / 2 + stiffness * x**2 / 2 + e(ANGLES) - level, mass * second + stiffness * x


@pytest.mark.parametrize("mass", [1e-6, 0.1, 1.0])
@pytest.mark.parametrize("slope", [np.sin, lambda x: np.sin(x) + 0.8 * np.cos(2 * x), lambda x: np.abs(np.sin(x - 1))])
def test_energy_is_held_and_the_cam_presses(slope, mass):
    missing, force = residual(slope, 8.0, mass, 2.0)
    assert np.max(np.abs(missing)) < 3.0 * spring_follower.RESOLVED * 8.0
    assert np.min(force) > 0.0


def test_without_mass_the_stretch_is_the_root_of_the_energy():
    e = energy(np.sin)
    x = spring_follower.stretched(e, 8.0, 1e-13, 2.0)
    assert_allclose(x(ANGLES), np.sqrt(8.0 - e(ANGLES)), rtol=1e-11)


def test_a_follower_runs_through_a_jump_of_the_torque_with_steady_velocity_and_acceleration():
    def slope(x):
        return np.sin(x) + 0.3 * (np.sin(x) > 0) * (np.mod(x, TURN) > 2.0)

    kinked = energy(slope)
    x = spring_follower.stretched(kinked, 8.0, 0.1, 2.0)
    before, after = (np.array(x.at(2.0 + side, 1)) for side in (-1e-9, 1e-9))
    assert_allclose(before, after, atol=1e-7)


def test_reserve_is_the_force_over_twice_the_root_of_mass_times_bend():
    e = energy(np.sin)  # 0 - cos + 1, least at 0 with E'' = 1
    assert_allclose(spring_follower.reserve(e, 0.0, 8.0, 4.0, 2.0), np.sqrt(2 * 2.0 * 8.0) / (2 * 2.0), rtol=1e-9)


def test_contact_is_lost_where_the_spring_pulls_less_than_it_must():
    e = energy(np.sin)
    bound = 2.0 * np.sqrt(2.0)  # (k x)^2 = 4 mu E'' at x^2 = C
    spring_follower.stretched(e, 8.0, 0.98 * bound**2, 2.0)
    with pytest.raises(ParameterError, match="lift off near crank angle"):
        spring_follower.stretched(e, 8.0, 1.1 * bound**2, 2.0)
