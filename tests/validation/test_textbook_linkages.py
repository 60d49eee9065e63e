"""Four-bar, slotted lever and a force at a coupler point of textbooks."""

from math import asin, degrees, pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

import kinetostatics as ks

B, C, D = 1.52 + 0.0j, 4.23 + 3.029j, 4.572 + 0.0j
EXACT = 1e-14
ROWS = {
    0: {"coupler": (-0.537707806825430, -0.0981933666211512), "rocker": (-0.537707806825430, 0.778081940185145)},
    90: {"coupler": (-0.102232102356830, 0.231680861727353), "rocker": (0.506736383917586, 0.192595295526762)},
}


def solution(degrees, assembly=1):
    mechanism = ks.four_bar(abs(B), abs(C - B), abs(C - D), rocker_pivot=(D.real, D.imag), assembly=assembly)
    return ks.solve(mechanism, np.radians(degrees), crank_speed=10.31 * 2 * np.pi / 60)


def test_drawn_position_has_the_pin_on_the_left():
    assert solution(0).position("B") == pytest.approx([C.real, C.imag], rel=EXACT)
    assert abs(complex(*solution(0, assembly=-1).position("B")) - C) > 1


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("link", ["coupler", "rocker"])
def test_rates_equal_the_reference_set(row, link):
    s = solution(row)
    found = float(s.rate(link)), float(s.angular_acceleration(link))
    assert found == pytest.approx(ROWS[row][link], rel=EXACT)


# Quick returns of textbooks


def shaper(crank, centres, lever):
    """Pivot below O; the free end C of the lever drives a ram on a level guide by a long link."""
    parts = (ks.LeverGroup((0.0, -centres)), ks.Pin(on="lever", at=(lever, 0.0)))
    return ks.Mechanism("crank shaper", ks.Crank(crank), parts)


def whitworth(crank, centres, lever, rod):
    """Pivot above O, inside the crank circle; the other end of the lever drives the ram along a line through it."""
    parts = (
        ks.LeverGroup((0.0, centres)),
        ks.Pin(on="lever", at=(-lever, 0.0)),
        ks.SliderGroup(rod, ks.Guide.at(0.0, centres), on="C", pin="D"),
    )
    return ks.Mechanism("Whitworth", ks.Crank(crank), parts)


def zeros(made, read):
    """Crank angles over a turn at which a motion reverses, rad."""

    def value(angle):
        return float(read(ks.solve(made, float(angle), crank_speed=1.0)))

    grid = np.linspace(0.0, 2 * pi, 41) + 0.01
    values = [value(angle) for angle in grid]
    pairs = zip(grid, grid[1:], values, values[1:], strict=False)
    return [brentq(value, low, high, xtol=1e-14) for low, high, before, behind in pairs if before * behind < 0.0]


def ratio(angles):
    """Of the longer part of the turn between two angles to the shorter."""
    part = angles[1] - angles[0]
    return max(part, 2 * pi - part) / min(part, 2 * pi - part)


@pytest.mark.parametrize(
    ("crank", "centres", "printed"), [(0.120, 0.240, 2.0), (0.075, 0.200, 1.647), (0.150, 0.370, 1.72397)]
)
def test_shaper_has_the_printed_time_ratio(crank, centres, printed):
    made = shaper(crank, centres, 0.45)
    swing = asin(crank / centres)
    found = ratio(zeros(made, lambda s: s.rate("lever")))
    assert found == pytest.approx((pi + 2 * swing) / (pi - 2 * swing), rel=1e-12)
    assert found == pytest.approx(printed, abs=2e-3)


def test_shaper_has_the_printed_stroke():
    """The lever leans by 30 degrees, its free end at 450 mm runs over 450 mm between the extremes."""
    made = shaper(0.120, 0.240, 0.45)
    first, second = (ks.solve(made, angle, crank_speed=1.0) for angle in zeros(made, lambda s: s.rate("lever")))
    ends = [s.position("C") for s in (first, second)]
    assert abs(ends[0][0] - ends[1][0]) == pytest.approx(0.45, rel=1e-12)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=1e-12)
    for s in (first, second):
        x, y = s.placement.links["lever"].direction
        assert degrees(np.arctan2(abs(x), y)) == pytest.approx(30.0, abs=1e-10)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_shaper_stroke_is_by_the_sine_of_its_swing(share):
    made = shaper(share * 0.3, 0.3, 0.5)
    ends = [ks.solve(made, angle, crank_speed=1.0).position("C")[0] for angle in zeros(made, lambda s: s.rate("lever"))]
    assert abs(ends[0] - ends[1]) == pytest.approx(2 * 0.5 * share, rel=1e-12)


def test_whitworth_has_the_printed_time_ratio():
    """Centres 50 mm apart, crank 75 mm: 2.735; the ram turns back where the lever is level."""
    made = whitworth(0.075, 0.050, 0.100, 0.135)
    found = zeros(made, lambda s: s.travel_velocity("slider"))
    assert ratio(found) == pytest.approx((pi + 2 * asin(2 / 3)) / (pi - 2 * asin(2 / 3)), rel=1e-12)
    assert ratio(found) == pytest.approx(2.735, abs=1e-3)
    ends = [float(ks.solve(made, angle, crank_speed=1.0).slider_position) for angle in found]
    assert abs(ends[0] - ends[1]) == pytest.approx(0.200, rel=1e-12)


def test_whitworth_turns_between_extreme_speeds():
    """At its nearest and farthest the block moves across the lever: rates r / (r + d) and r / (r - d)."""
    made = whitworth(0.075, 0.050, 0.100, 0.135)
    s = ks.solve(made, np.linspace(0.0, 2 * pi, 720, endpoint=False), crank_speed=1.0)
    found = ks.extremes(s, "lever_rate")
    assert found.range == pytest.approx((0.075 / 0.125, 0.075 / 0.025), rel=1e-12)
    assert np.mean(s.rate("lever")) == pytest.approx(1.0, abs=1e-14)


def test_oscillating_cylinder_has_a_shapers_swing():
    made = ks.Mechanism("oscillating engine", ks.Crank(0.1), (ks.CylinderGroup((0.0, -0.4)),))
    s = ks.solve(made, np.linspace(0.0, 2 * pi, 72, endpoint=False), crank_speed=1.0)
    assert ks.extremes(s, "cylinder_length").range == pytest.approx((0.3, 0.5), rel=1e-14)
    still = zeros(made, lambda s: s.rate("cylinder"))
    leans = [ks.solve(made, angle, crank_speed=1.0).placement.links["cylinder"].direction[0] for angle in still]
    assert sorted(leans) == pytest.approx([-0.25, 0.25], abs=1e-13)


def test_yoke_pump_torque_is_pressure_and_mass():
    """Force P against the motion and mass m on a pure cosine: T = r sin(phi) P + m r^2 omega^2 sin(2 phi) / 2."""
    r, mass, speed, push = 0.05, 4.0, 20.0, 300.0
    angle = np.linspace(0.1, 6.2, 12)
    made = ks.scotch_yoke(r, slider=ks.Link(mass))
    s = ks.solve(made, angle, crank_speed=speed, loads=[ks.ProcessForce(push)])
    inertia = mass * r**2 * speed**2 * np.sin(angle) * np.cos(angle)
    assert s.balancing_torque == pytest.approx(push * r * np.sin(angle) + inertia, rel=1e-12)
    slot = mass * r * speed**2 * np.cos(angle) + push
    assert s.scalar("slot_force") * -1.0 == pytest.approx(slot, rel=1e-12)
    assert s.scalar("guide_moment") == pytest.approx(-slot * r * np.sin(angle), rel=1e-12)


def test_inclined_slot_lengthens_the_stroke():
    slot = 1.0
    made = ks.scotch_yoke(0.05, slot_angle=slot)
    s = ks.solve(made, np.linspace(0, 2 * pi, 72, endpoint=False), crank_speed=1.0)
    half = 0.05 / np.sin(slot)
    assert ks.extremes(s, "slider_position").range == pytest.approx((-half, half), rel=1e-14)
    assert sqrt(0.05**2 + (0.05 / np.tan(slot)) ** 2) == pytest.approx(half, rel=1e-14)


# A force at a coupler point of a four-bar at rest, by hand


@pytest.fixture
def at_rest():
    four_bar = ks.four_bar(3.0, 4.0, np.sqrt(20.0), rocker_pivot=(6.0, -1.0))
    force = ks.Force(np.hypot(100.0, 200.0), at=("coupler", 2.0, 2.0), direction=np.arctan2(-200.0, 100.0))
    return ks.solve(four_bar, np.pi / 2, crank_speed=0.0, loads=force)


def test_the_pin_is_where_it_is_drawn(at_rest):
    assert at_rest.position("B") == pytest.approx((4.0, 3.0), rel=1e-14)


def test_torque_is_virtual_work_at_instant_centre(at_rest):
    assert float(at_rest.balancing_torque) == pytest.approx(75.0, rel=1e-13)


@pytest.mark.parametrize(
    ("joint", "force"), {"A": (-25, 50), "B": (75, -150), "O2": (-75, 150), "O": (-25, 50)}.items()
)
def test_reactions_are_two_and_three_force_members(at_rest, joint, force):
    assert at_rest.reaction(joint) == pytest.approx(force, rel=1e-12)
