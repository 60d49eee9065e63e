"""Loads between points: where the points meet, what is refused, and how they are named."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.machines import largest

CRANK, COUPLER = 0.1, 0.4
PUMP = ks.crank_slider(CRANK, COUPLER)
"""Its slider pin passes 0.4 m on its way and stops at 0.5 and 0.3 m."""


def pushed(item, angles, speed=9.0):
    """Force of a load on the slider along its guide, by the torque that it takes: exact but at the dead centres."""
    s = ks.solve(PUMP, angles, crank_speed=speed, loads=item)
    return -s.reaction("B")[0]


def test_damper_at_meeting_points_takes_its_limit():
    """The pin passes the fixed point at a right angle of the crank but for the lag of the coupler."""
    damper = ks.PointDamper(20.0, between=("B", (0.4, 0.0)))
    meet = np.arccos(0.1 / (2 * 0.4))
    angles = meet + np.array([-1e-3, -1e-9, -1e-15, 0.0, 1e-15, 1e-9, 1e-3])
    s = ks.solve(PUMP, angles, crank_speed=9.0)
    assert largest(pushed(damper, angles) + 20.0 * s.slider_velocity) < 1e-12 * largest(20.0 * s.slider_velocity)


@every("angle", np.linspace(0.2, 6.0, 7))
def test_nearly_meeting_points_are_refused(angle):
    """Near O coordinates are small, and what rounding leaves between the points is not."""
    ram = ks.SliderGroup(0.3, ks.Guide.at(np.pi), on="B", pin="C", label="2")
    mechanism = ks.Mechanism("chain", ks.Crank(CRANK), (ks.SliderGroup(COUPLER), ram))
    x = float(mechanism.place(np.array([angle])).joints["C"].position[0][0])
    for off in (0.0, 3e-16, -5e-16):
        with pytest.raises(ks.ParameterError, match="the points meet"):
            ks.solve(mechanism, angle, crank_speed=1.0, loads=ks.PointForce(1.0, between=("C", (x + off, 0.0))))


@every("ulps", [(0, 0), (1, -1), (-3, 2), (0, 4)])
def test_damper_at_nearly_meeting_points_is_right(ulps):
    """The line between them is rounding then, and must not be taken for a direction."""
    angles = np.linspace(0.1, 6.2, 23)
    for angle in angles:
        place = CRANK * np.array([np.cos(angle), np.sin(angle)])
        item = ks.PointDamper(20.0, between=("A", tuple(place + ulps * np.spacing(place))))
        torque = ks.solve(PUMP, angle, crank_speed=9.0, loads=item).balancing_torque
        assert abs(torque - 20.0 * 9.0 * CRANK**2) < 1e-8


@every("end", [0.5, 0.3])
def test_damper_at_a_standing_dead_centre_gives_0(end):
    angle = 0.0 if end == 0.5 else np.pi
    found = pushed(ks.PointDamper(20.0, between=("B", (end, 0.0))), np.array([angle, angle + 1e-6]))
    assert abs(found[0]) < 1e-13
    assert 0 < abs(found[1]) < 1e-3


def test_a_damper_of_a_crank_at_rest_gives_nothing():
    assert largest(pushed(ks.PointDamper(20.0, between=("B", (0.1, 0.3))), [0.3, 2.0], 0.0)) == 0


def test_spring_without_free_length_is_exact():
    spring = ks.PointSpring(300.0, between=("B", (0.5, 0.0)))
    assert pushed(spring, np.array([0.0]))[0] == 0.0
    s = ks.solve(PUMP, np.array([0.01, 1.0]), crank_speed=9.0, loads=spring)
    assert largest(s.reaction("B")[0] - 300.0 * (s.slider_position - 0.5)) < 1e-13


@every("item", [ks.PointSpring(300.0, 0.1, between=("B", (0.5, 0.0))), ks.PointForce(3.0, between=((0.5, 0.0), "B"))])
def test_meeting_points_are_refused_with_the_angle(item):
    with pytest.raises(ks.ParameterError, match=r"between .*'B'.*: the points meet at 1 crank angles, 0 deg"):
        ks.solve(PUMP, [0.0, 1.0], crank_speed=9.0, loads=item)
    assert np.isfinite(ks.solve(PUMP, [1.0], crank_speed=9.0, loads=item).balancing_torque).all()
    with pytest.raises(ks.ParameterError, match="the points meet"):
        ks.extremes(ks.solve(PUMP, [1.0], crank_speed=9.0, loads=item), "B")
    designs = ks.crank_slider(0.1, 0.4, slider=ks.Link(np.array([[1.0], [2.0]])))
    met = ks.PointForce(3.0, between=("A", (0.1, 0.0)))
    with pytest.raises(ks.ParameterError, match="the points meet at 1 crank angles, 0 deg"):
        ks.solve(designs, [0.0, 1.0], crank_speed=9.0, loads=met)


def test_sweeps_name_designs_with_meeting_points():
    import pandas as pd

    scene = ks.Scene(PUMP, 9.0, 0.0, ks.PointForce(3.0, between=("B", (0.9, 0.0))))
    designs = pd.DataFrame({"point_force.between.2.x": [0.9, 0.5, 0.8]})
    swept = ks.sweep(scene, designs, ["largest O"], angles=36, progress=False)
    assert swept["largest O [N]"].notna().tolist() == [True, False, True]
    assert "the points meet" in swept["failed"][1]


# Places at which loads act


def test_coupler_curve_is_the_position_of_a_place():
    s = ks.solve(PUMP, [0.3, 2.0], crank_speed=9.0)
    for order in ("position", "velocity", "acceleration"):
        ask = getattr(s, order)
        assert largest(ask(("coupler", COUPLER)) - ask("B")) < 1e-13 * max(1.0, largest(ask("B")))
        assert np.array_equal(ask(("crank", CRANK, 0.0)), ask("A"))
    assert s.position((0.2, -0.1)).tolist() == [[0.2, 0.2], [-0.1, -0.1]]
    assert not s.velocity((0.2, -0.1)).any()
    with pytest.raises(ks.ParameterError, match="point must be a joint"):
        s.position((1.0, 2.0, 3.0))
    with pytest.raises(ks.QuantityError, match="'couplr', allowed: 'crank', 'coupler'"):
        s.position(("couplr", 0.1))


def test_pivot_names_its_link_and_point_the_frame():
    bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    on_rocker, on_frame = (
        ks.solve(bar, [0.7], crank_speed=1.0, loads=ks.Force(5.0, at=at)) for at in ("O2", (0.35, 0.1))
    )
    assert on_rocker.reaction("O2")[:, 0].tolist() == [-5.0, 0.0]
    assert not on_frame.reaction("O2").any()
