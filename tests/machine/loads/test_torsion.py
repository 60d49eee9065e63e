"""Loads on sliders, torsion springs and dampers."""

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.machines import largest
from support.scenes import six_bar

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_a_process_force_may_follow_the_motion():
    def cut(motion):
        return np.where(motion.slider_velocity < 0, 1000.0, 0.0)

    with_cut = solved(loads=[ks.Gravity(), ks.ProcessForce(cut)])
    difference = with_cut.balancing_torque - solved().balancing_torque
    expected = np.where(with_cut.slider_velocity < 0, -1000.0 * with_cut.slider_velocity / 33.5, 0.0)
    np.testing.assert_allclose(difference, expected, atol=1e-9)


def test_spring_acts_on_the_slider_it_names():
    spring = ks.Spring.balancing(10.0, 3.0, 0.5, on="slider2")
    assert (spring.stiffness, spring.free_position, spring.on) == (90.0, 0.5, "slider2")


# Weight


TWELVE = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
ARM = ks.Mechanism("arm", ks.Crank(0.5, ks.Link(3.0, (0.2, 0.1), 0.0)), ())


@every("direction", [-np.pi / 2, 0.0, 2.0])
def test_torque_at_rest_holds_the_weight(direction):
    s = ks.solve(ARM, TWELVE, crank_speed=0.0, loads=ks.Gravity(9.81, direction))
    x, y = s.position("crank")
    expected = -3.0 * 9.81 * (x * np.sin(direction) - y * np.cos(direction))
    assert s.balancing_torque == pytest.approx(expected, abs=1e-13)


def test_the_torque_is_the_slope_of_the_potential():
    def energy(angle):
        s = ks.solve(ARM, angle, crank_speed=0.0, loads=ks.Gravity())
        return ks.Gravity().potential(s.dynamics)

    slope = (energy(TWELVE + 1e-6) - energy(TWELVE - 1e-6)) / 2e-6
    found = ks.solve(ARM, TWELVE, crank_speed=0.0, loads=ks.Gravity()).balancing_torque
    assert found == pytest.approx(slope, abs=1e-7)


# Torsion springs

BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))


@every(
    "item, words",
    [
        (ks.TorsionSpring(4.0, 0.1, on="crank"), r"passes half a turn .* 185.8 deg, .* it makes full turns"),
        (ks.TorsionSpring(4.0, 0.1, on="rocker", against="crank"), "it makes full turns"),
        (ks.TorsionSpring(4.0, -1.1, on="rocker"), "give a free angle nearer to it"),
    ],
)
def test_spring_beyond_half_a_turn_is_refused(item, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.solve(BAR, 0.7, crank_speed=1.0, loads=item)


@every(
    "lengths, on",
    [
        ((0.1, 0.2, 0.2, 0.1), "rocker"),  # turns once in two turns of the crank
        ((0.2, 0.2, 0.1, 0.1), "coupler"),  # passes half a turn at crank angle 0
    ],
)
def test_link_turning_round_takes_no_spring(lengths, on):
    *bars, ground = lengths
    passing = ks.four_bar(*bars, rocker_pivot=(ground, 0.0), assembly="open")
    for free in (0.0, 1.5, -1.5, 3.0):
        with pytest.raises(ks.ParameterError, match="it makes full turns"):
            ks.solve(passing, 0.7, crank_speed=1.0, loads=ks.TorsionSpring(4.0, free, on=on))


def test_fixed_link_takes_a_constant_couple():
    pump, spring = ks.crank_slider(0.1, 0.3, guide_angle=0.4), ks.TorsionSpring(4.0, 0.1, on="slider")
    assert ks.solve(pump, [0.7, 2.0], crank_speed=1.0, loads=spring).guide_moment == pytest.approx([1.2, 1.2])


def test_coupler_turning_with_crank_takes_no_spring():
    double_crank = ks.four_bar(0.4, 0.35, 0.45, rocker_pivot=(0.1, 0.0))
    with pytest.raises(ks.ParameterError, match=r"TorsionSpring on 'rocker'.*it makes full turns"):
        ks.solve(double_crank, 0.7, crank_speed=1.0, loads=ks.TorsionSpring(4.0, on="rocker"))
    together = ks.TorsionSpring(4.0, on="rocker", against="crank")
    assert ks.solve(double_crank, 0.7, crank_speed=1.0, loads=together).power_residual < 1e-13


@every("free", [-0.6, 0.9, 1.5, 4.4, 1.5 - 4 * np.pi])
def test_the_angle_is_the_principal_one_to_rounding(free):
    """Against angles of positions with 40 digits; free angles may be wound up by whole turns."""
    s = ks.solve(BAR, np.linspace(0, 6, 7), crank_speed=1.0, loads=ks.TorsionSpring(7.0, free, on="rocker", moment=2.0))
    spring = s.loads[0]
    with mp.workdps(40):
        axes = [mp.mpc(*map(float, part)) for part in zip(*s.placement.links["rocker"].direction, strict=True)]
        angles = np.array([float(mp.arg(axis * mp.expj(-mp.mpf(free)))) for axis in axes])
    assert largest(spring.couple(s) - (2.0 - 7.0 * angles)) < 2e-14


def test_sweep_names_the_design_that_turns_round():
    import pandas as pd

    scene = ks.Scene(BAR, 1.0, 0.0, ks.TorsionSpring(4.0, 1.5, on="rocker"))
    designs = pd.DataFrame({"torsion_spring.free_angle": [1.5, -1.1, 1.2]})
    swept = ks.sweep(scene, designs, ["largest O2"], angles=360, progress=False)
    assert swept["largest O2 [N]"].notna().tolist() == [True, False, True]
    assert "half a turn" in swept["failed"][1]


def test_program_refuses_values_that_turn_round():
    program = ks.compile(ks.Scene(BAR, 1.0, 0.0, ks.TorsionSpring(4.0, 1.5, on="rocker")), "O2", engine="numpy")
    assert np.isfinite(program(0.3, {"torsion_spring.free_angle": 1.2})["O2"]).all()
    with pytest.raises(ks.ParameterError, match="half a turn"):
        program(0.3, {"torsion_spring.free_angle": -1.1})


def test_a_torque_on_a_slider_is_taken_by_its_guide():
    pump = ks.crank_slider(0.1, 0.4)
    s = ks.solve(pump, [0.3, 2.0], crank_speed=1.0, loads=ks.Torque(6.0, on="slider"))
    assert s.guide_moment.tolist() == [-6.0, -6.0]
    assert not s.balancing_torque.any()


def test_torsion_damper_takes_relative_rate_squared():
    damper = ks.TorsionDamper(0.4, on="coupler", against="coupler2")
    s, still = (ks.solve(six_bar(), [0.3, 2.0], crank_speed=3.0, loads=loads) for loads in (damper, ()))
    power = 3.0 * (s.balancing_torque - still.balancing_torque)
    expected = 0.4 * (s.rate("coupler") - s.rate("coupler2")) ** 2
    assert largest(power - expected) < 1e-12 * largest(expected)
