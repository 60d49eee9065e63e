"""What sets the speed of a cam with springs: lift-off by hand, surge of the springs, torque to start."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.cam_contacts import LOADS, solved
from support.machines import ANGLES

FOLLOWER = ks.CamRoller(ks.cams.Circle(0.1, (0.02, 0.01)), block=ks.Link(2.0))
FOLLOWING = ks.Mechanism("cam drive", ks.Crank(None), (FOLLOWER,))
PULL = ks.PointSpring(5e3, 0.03, between=("A", (0.0, 0.0)))


def test_follower_lifts_off_at_its_springs_limit():
    """Along the ray m (r'' - r) omega^2 = -k (r - l0) where the cam gives nothing: the least omega over the turn."""
    found = ks.design.lift_off_speed(ks.solve(FOLLOWING, ANGLES, crank_speed=10.0, loads=PULL))
    r, _, second = FOLLOWER.cam.radius(np.linspace(0, 2 * np.pi, 100_001))
    assert found == pytest.approx(np.sqrt(np.min(5e3 * (r - 0.03) / (2.0 * (r - second)))), rel=1e-8)
    for factor, positive in ((0.999, False), (1.001, True)):
        force = ks.solve(FOLLOWING, ANGLES, crank_speed=factor * found, loads=PULL)
        assert bool(np.any(ks.extremes(force, "cam_force").value > 0)) is positive


def test_a_damper_shifts_the_speed_of_lift_off():
    """Its force grows with the speed itself, so squares do not tell; the force at the speed found just vanishes."""
    loads = [PULL, ks.PointDamper(40.0, between=("A", (0.0, 0.0)))]
    found = ks.design.lift_off_speed(ks.solve(FOLLOWING, ANGLES, crank_speed=10.0, loads=loads))
    force = ks.solve(
        FOLLOWING, np.linspace(0, 2 * np.pi, 1440, endpoint=False), crank_speed=found, loads=loads
    ).cam_force
    assert abs(force.max()) < 1e-6 * abs(force.min())


def test_machine_held_on_both_sides_lifts_off_at_once():
    assert ks.design.lift_off_speed(solved()) == 0.0


def test_without_inertia_nothing_lifts_off():
    light = ks.Mechanism("light", ks.Crank(None), (ks.CamRoller(FOLLOWER.cam),))
    assert ks.design.lift_off_speed(ks.solve(light, ANGLES, crank_speed=10.0, loads=PULL)) == np.inf


def test_starting_torque_of_springs_weights_friction():
    rest = np.abs(solved(0.0, angles=np.linspace(0, 2 * np.pi, 7201)).balancing_torque)
    assert ks.design.starting_torque(solved()).value == pytest.approx(rest.max(), rel=1e-6)
    rubbing = solved(friction={"O": ks.PinFriction(0.1, 0.05)})
    assert ks.design.starting_torque(rubbing).value > 1.001 * rest.max()


def test_springs_surge_at_their_natural_frequency():
    found = ks.design.spring_surge(solved(), 30.0)
    stiffness = LOADS[1].stiffness
    assert found.natural_frequency == pytest.approx(np.pi * np.sqrt(stiffness / 30.0), rel=1e-14)
    assert found.order == pytest.approx(found.natural_frequency / 33.5)
    assert_allclose(found.amplitudes[:3], [2.0, 0.3, 0.0], atol=1e-12)
    assert found.speeds()[4] == pytest.approx(found.natural_frequency / 4)


TURNING = ks.Mechanism(
    "cam drive", ks.Crank(None), (ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0)),)
)


def turned(speed, free=0.04):
    return ks.solve(TURNING, ANGLES, crank_speed=speed, loads=ks.Spring(5e3, free, on="follower"))


def test_follower_on_turning_cam_lifts_off():
    """M s'' omega^2 + k (s - s0) = 0 with s = 0.05 + 0.01 cos: at the top, 2 omega^2 = 5000 (0.02 / 0.01)."""
    found = ks.design.lift_off_speed(turned(10.0), "contact_force")
    assert found == pytest.approx(np.sqrt(5e3), rel=1e-9)
    assert ks.design.lifted(turned(0.999 * found), "contact_force") == ()
    ((start, stop),) = ks.design.lifted(turned(1.2 * found), "contact_force")
    cosine = 0.01 / (0.01 * (1.44 * 2.0 - 1.0))
    assert_allclose([start, stop], [-np.arccos(cosine), np.arccos(cosine)], atol=1e-9)


def test_a_wrong_sided_spring_never_presses():
    assert ks.design.lifted(turned(1.0, free=0.1), "contact_force") == ((0.0, 2 * np.pi),)


def test_an_unknown_force_lists_the_known_ones():
    for function in (ks.design.lifted, ks.design.lift_off_speed):
        with pytest.raises(ks.ParameterError, match="'contact_force'"):
            function(turned(10.0), "contact")


def test_a_progressive_spring_surges_by_its_mean_rate():
    pump, angle = ks.crank_slider(0.1, 0.3), np.linspace(0, 2 * np.pi, 3600, endpoint=False)
    spring = ks.Spring(2e3, 0.25, cubic=4e5)
    solution = ks.solve(pump, angle, crank_speed=10.0, loads=spring)
    step = 1e-5
    rate = np.mean([spring_force(spring, solution.slider_position + side * step) for side in (1, -1)], axis=1)
    found = ks.design.spring_surge(solution, 0.5)
    assert found.natural_frequency == pytest.approx(np.pi * np.sqrt((rate[0] - rate[1]) / (2 * step) / 0.5), rel=1e-6)


def spring_force(spring, place):
    return spring.stiffness * (place - spring.free_position) + spring.cubic * (place - spring.free_position) ** 3


@pytest.mark.parametrize("loads", [[], [ks.Spring(2e3, 0.3), ks.Spring(2e3, 0.3)], ks.Spring(0.0, 0.3)])
def test_what_cannot_surge_is_refused(loads):
    solution = ks.solve(ks.crank_slider(0.1, 0.3), 0.5, crank_speed=10.0, loads=loads)
    with pytest.raises(ks.ParameterError, match="spring_surge: "):
        ks.design.spring_surge(solution, 0.5)


@pytest.mark.parametrize("orders", [0, [1, 0], [-1], [1.5], ["x"]])
def test_orders_are_whole_numbers_of_turns(orders):
    solution = ks.solve(ks.crank_slider(0.1, 0.3), 0.5, crank_speed=10.0, loads=ks.Spring(2e3, 0.3))
    with pytest.raises(ks.ParameterError, match="an order must be a whole number"):
        ks.design.spring_surge(solution, 0.5).speeds(orders)
