"""Free bodies: the forces on every link of every machine are in equilibrium, act where they should, and refuse."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.mechanics.free_body import free_body
from support import chains, followers, friction_machines
from support.case_files import shipped, variant_names
from support.every import every
from support.scenes import OWN, SCENES, six_bar

ANGLES = np.array([0.1, 0.9, 2.0, 3.3, 4.6, 5.9])
CLOSED = 1e-13


def imbalance(solution):
    """Largest sum of forces, and of moments about O, on a link, relative to the largest of them and their arms."""
    worst = 0.0
    for link in solution.mechanism.links:
        actions = free_body(solution.dynamics, link)
        forces, moments = np.array([item.force for item in actions]), np.array([item.moment() for item in actions])
        arms = np.hypot(*np.array([item.point for item in actions]).swapaxes(0, 1)).max(initial=0.0)
        size = np.abs(forces).max(initial=0.0)
        for total, scale in ((forces, size), (moments, max(np.abs(moments).max(initial=0.0), size * arms))):
            worst = max(worst, np.abs(total.sum(axis=0)).max(initial=0.0) / (scale or 1.0))
    return worst


@pytest.mark.slow
@every("case", shipped_cases())
def test_forces_on_every_link_of_shipped_machines_are_in_equilibrium(case):
    for variant in variant_names(case):
        assert imbalance(shipped(case).variant(variant).scene.solve(ANGLES)) < CLOSED


@every("name", SCENES)
def test_forces_on_every_link_are_in_equilibrium(name):
    assert imbalance(SCENES[name].solve(ANGLES)) < CLOSED


@pytest.mark.slow
@every("kind", followers.KINDS)
def test_forces_on_followers_and_their_cams_are_in_equilibrium(kind):
    assert imbalance(followers.scene(followers.KINDS[kind]()).solve(followers.ANGLES)) < CLOSED


@pytest.mark.slow
@every("kind", (*friction_machines.KINDS, *friction_machines.FOLLOWERS))
def test_friction_is_in_equilibrium(kind):
    scene = friction_machines.Drawn(kind, 3, 0.5).scene
    solution = scene.solve(np.array([0.3, 1.1, 2.9, 5.0]), on_gap="nan")
    closed = solution.closed & solution.converged
    assert closed.any()
    assert imbalance(scene.solve(solution.crank_angle[closed])) < CLOSED


@pytest.mark.slow
@every("seed", range(5))
def test_forces_on_every_link_of_random_chains_are_in_equilibrium(seed):
    scene, angles = chains.chain(seed)
    assert imbalance(scene.solve(angles)) < CLOSED


@every("seed", range(2))
def test_loads_of_all_kinds_are_in_equilibrium(seed):
    random = np.random.default_rng(seed)
    loads = filter(None, (chains.load(random, kind, six_bar()) for kind in chains.LOAD_KINDS))
    assert imbalance(ks.Scene(six_bar(), 7.0, 20.0, list(loads)).solve(ANGLES)) < CLOSED


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_springs_with_mass_are_in_equilibrium():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    loads = ks.Gravity(9.81, -0.9), ks.Spring(5e5, 2.0, mass=100.0), ks.GasSpring(0.01, 0.01, 2e6, at=2.0)
    assert imbalance(ks.Scene(saw, 33.5, 20.0, loads).solve(ANGLES)) < CLOSED


def test_forces_on_the_slider_of_a_saw():
    saw = ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0))
    s = ks.Scene(saw, 33.5, loads=[ks.Gravity(), ks.Spring(1e5, 2.0), ks.ProcessForce(-500.0)]).solve(np.array([0.4]))
    found = {item.name: item for item in free_body(s.dynamics, "slider")}
    assert list(found) == ["B", "guide", "inertia", "weight", "Spring on 'slider'", "ProcessForce on 'slider'"]
    assert found["B"].force == pytest.approx(s.reaction("B"), rel=1e-14)
    assert found["inertia"].force[0] == pytest.approx(-600.0 * s.slider_acceleration, rel=1e-14)
    assert found["weight"].force[1] == pytest.approx(-600.0 * 9.81)
    assert found["Spring on 'slider'"].force[0] == pytest.approx(-1e5 * (s.slider_position - 2.0), rel=1e-13)
    coupler = {item.name: item for item in free_body(s.dynamics, "coupler")}
    assert coupler["B"].force == pytest.approx(-s.reaction("B"))
    crank = {item.name: item for item in free_body(s.dynamics, "crank")}
    assert crank["balancing torque"].couple == pytest.approx(s.balancing_torque)
    assert crank["balancing torque"].kind == "drive"


@every("friction", [{}, {"cam": ks.RollerFriction(0.05, 0.02, 0.05)}])
def test_a_roller_and_the_frame_push_each_other_at_their_contact(friction):
    cam, roller = ks.cams.Circle(0.3, (-0.0219, 0.004)), ks.Roller(0.05, 0.04, 210e9, 0.3)
    saw = ks.cam_crank_slider(cam, 2.0219, slider=ks.Link(600.0), block=ks.Link(30.0), roller=roller)
    s = ks.solve(saw, ANGLES, crank_speed=33.5, friction=friction)
    found = {item.name: item for item in free_body(s.dynamics, "block")}["cam"]
    force, point, couple = s.ground["cam"]
    np.testing.assert_allclose(found.force, -force, rtol=0.0, atol=CLOSED * np.abs(force).max())
    np.testing.assert_allclose(found.point, point, rtol=0.0, atol=CLOSED)
    assert not found.couple.any()
    assert not couple.any()
    assert np.hypot(*(point - s.position("A"))) == pytest.approx(0.05)


def test_loads_act_where_they_are_given():
    bars = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    loads = [
        ks.Force(200.0, at=("coupler", 0.1, 0.05), direction=0.3),
        ks.PointForce(50.0, between=(("rocker", 0.2), "A")),
    ]
    s = ks.solve(bars, ANGLES, crank_speed=10.0, loads=[*loads, ks.Torque(7.0, on="rocker", against="coupler")])
    coupler = {item.name: item for item in free_body(s.dynamics, "coupler")}
    force = coupler["Force at ('coupler', 0.1, 0.05)"]
    assert force.point == pytest.approx(s.position(("coupler", 0.1, 0.05)))
    assert np.all(force.couple == 0.0)
    assert coupler["Torque on 'rocker'"].couple == pytest.approx(-7.0)
    rocker = {item.name: item for item in free_body(s.dynamics, "rocker")}
    assert rocker["PointForce between ('rocker', 0.2, 0) and 'A'"].point == pytest.approx(s.position(("rocker", 0.2)))


def test_unknown_link_is_refused_with_those_there():
    s = ks.solve(ks.crank_slider(0.3, 2.0), 0.3, crank_speed=1.0)
    with pytest.raises(ks.QuantityError, match=r"link is 'slidr', allowed: 'crank', 'coupler', 'slider'; did you mean"):
        free_body(s.dynamics, "slidr")


def test_own_group_that_does_not_declare_its_pairs_is_refused():
    s = OWN["group"][0].solve(ANGLES)
    with pytest.raises(ks.ParameterError, match="does not declare all its pairs with their forces"):
        free_body(s.dynamics, "pan")
