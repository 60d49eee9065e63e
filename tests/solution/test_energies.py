"""Inertia and energies of a solution: those of a slider and of a weight, and the torque that is their change."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0), guide_angle=np.pi / 2)


def solved(**options):
    return ks.solve(YOKE, TURN, **{"crank_speed": 7.0, "crank_acceleration": 4.0, "loads": ks.Gravity()} | options)


def test_the_energies_are_those_of_the_slider():
    s = solved()
    assert s.kinetic_energy == pytest.approx(1.5 * s.slider_velocity**2, abs=1e-13)
    assert s.reduced_inertia == pytest.approx(2.0 * s.kinetic_energy / 49.0, abs=1e-15)
    assert s.potential_energy == pytest.approx(3.0 * 9.81 * s.slider_position, abs=1e-13)


def test_the_torque_is_inertia_slope_and_load_together():
    s = solved()
    torque = s.reduced_inertia * 4.0 + 0.5 * s.reduced_inertia_slope * 49.0 + s.load_torque
    assert s.balancing_torque == pytest.approx(torque, abs=1e-12)
    assert np.array_equal(s.load_torque, solved(crank_speed=1.0, crank_acceleration=0.0).load_torque)


def test_what_has_a_potential_takes_nothing_in_a_turn_and_a_damper_does():
    steady = {"crank_acceleration": 0.0}
    assert solved(**steady).energy_per_turn == pytest.approx(0.0, abs=1e-11)
    damper = ks.ProcessForce(lambda motion: -5.0 * motion.travel_velocity("slider"))
    assert solved(loads=damper, **steady).energy_per_turn == pytest.approx(5.0 * 0.01 * 7.0 * np.pi, rel=1e-9)
