"""Forces on the frame of every machine: their sum is shaking force, weights and outside forces, moments likewise."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import KERNELS
from kinetostatics.mechanics.load_values import evaluate_load
from support.case_files import shipped
from support.chains import LOAD_KINDS, chain, load
from support.every import every
from support.followers import ANGLES, scene
from support.followers import KINDS as FOLLOWERS
from support.friction_machines import FOLLOWERS as RUBBING_FOLLOWERS
from support.friction_machines import KINDS, Drawn
from support.scenes import six_bar

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning", "ignore::kinetostatics.ConditionWarning")

SEVERAL = np.linspace(0.1, 6.2, 9)
ABOUT = (0.7, -0.4)


def outside(s):
    """Pairs of a force (x, y) from outside on the links and its point: weights, process forces, forces at points."""
    for item in s.loads:
        if isinstance(item, ks.Gravity):
            for name, link in s.mechanism.links.items():
                yield [link.mass * part for part in item.vector], s.position(name)
        elif isinstance(item, ks.ProcessForce) and item.reaction == "outside":
            value = evaluate_load(item, s).force
            joint = s.mechanism.references[item.on]
            yield [value * part for part in s.mechanism.guides[item.on].direction], s.position(joint)
        elif isinstance(item, ks.Force) and not _is_fixed(s.mechanism, item.at):
            (_, (force, _)) = next(iter(evaluate_load(item, s).wrenches(s)))
            yield force, s.position(item.at)
        elif isinstance(item, ks.BalanceShaft) and s.gravity is not None:  # weight at the axis, and of the unbalance
            turned = item.ratio * s.crank_angle + item.phase
            ends = np.array([np.cos(turned) + item.at[0], np.sin(turned) + item.at[1]])
            for share, point in ((item.mass - item.unbalance, s.position(item.at)), (item.unbalance, ends)):
                yield [share * part for part in s.gravity], point


def _is_fixed(mechanism, at):
    return at[0] == "frame" or not isinstance(at[0], str)


def error(s, about=ABOUT):
    """Largest errors of the sum and of the moment, relative to the largest forces and their levers."""
    total, turning = s.shaking_force, s.shaking_moment - (about[0] * s.shaking_force[1] - about[1] * s.shaking_force[0])
    sizes, levers = [np.abs(total)], [np.abs(turning)]
    for force, (x, y) in outside(s):
        total = total + np.stack([np.broadcast_to(part, s.shape) for part in force])
        couple = (x - about[0]) * force[1] - (y - about[1]) * force[0]
        turning = turning + couple
        sizes.append(np.abs(force[0]) + np.abs(force[1]))
        levers.append(np.abs(couple))
    for part in s.ground.values():
        sizes.append(np.abs(part.force))
        levers.append(np.abs(part.couple) + np.abs(part.force).max(axis=0) * np.hypot(*part.point))
    off, turned = np.abs(s.ground.resultant - total), np.abs(s.ground.moment(about) - turning)
    size, lever = (max(np.nanmax(part, initial=0.0) for part in parts) for parts in (sizes, levers))
    return np.nanmax(off) / size, np.nanmax(turned) / lever


def assert_balanced(s):
    s = replace(s, engine=KERNELS)  # to record each structure would take longer
    assert np.isfinite(s.ground.resultant).any()
    assert max(error(s)) < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("name", ks.shipped_cases())
def test_shipped_machines(name):
    for variant in shipped(name).variants.values():
        assert_balanced(variant.scene.solve(8, on_gap="nan"))


@pytest.mark.parametrize("seed", range(8))
def test_random_chains(seed):
    made, angles = chain(seed)
    assert_balanced(made.solve(angles))


@pytest.mark.parametrize("kind", LOAD_KINDS)
@every("seed", range(3))
def test_any_load(kind, seed):
    item = load(np.random.default_rng([seed, LOAD_KINDS.index(kind)]), kind, six_bar())
    if item is not None:
        assert_balanced(ks.Scene(six_bar(), 7.0, -3.0, (ks.Gravity(), item)).solve(SEVERAL))


@pytest.mark.parametrize("reaction", ["outside", "frame"])
def test_a_process_force_closes_outside_or_in_the_frame(reaction):
    saw = ks.crank_slider(0.1, 0.4, guide=ks.Guide.at(0.4, 0.05), coupler=ks.Link(2.0, 0.1), slider=ks.Link(3.0))
    s = ks.solve(saw, SEVERAL, crank_speed=9.0, loads=ks.ProcessForce(-80.0, reaction=reaction))
    assert_balanced(s)
    assert ("process_force" in s.ground) == (reaction == "frame")


def test_links_on_fixed_pins():
    dyad = ks.Dyad(0.4, 0.3, ("A", "F"), "D", 1, ks.Link(2.0, 0.1, 0.1), ks.Link(3.0, (0.1, 0.2), 0.1))
    still = ks.RockerGroup(0.3, 0.4, (0.7, 0.3), 1, ks.Link(2.0, 0.1), ks.Link(3.0, (0.1, 0.2)), "F", "G", label="_2")
    parts = ks.Pin(on="frame", at=(0.4, 0.1), name="F"), dyad, still
    s = ks.Scene(ks.Mechanism("on pins", ks.Crank(0.1), parts), 9.0, 4.0, [ks.Gravity()]).solve(SEVERAL)
    assert list(s.ground) == ["O", "dyad2_F", "F_2", "O2", "motor"]
    assert_balanced(s)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*KINDS, *RUBBING_FOLLOWERS])
@every("seed", range(3))
def test_friction_in_every_joint(kind, seed):
    made = Drawn(kind, seed, 0.5).scene
    assert_balanced(made.solve(SEVERAL, on_gap="nan"))


@pytest.mark.parametrize("kind", FOLLOWERS)
def test_followers(kind):
    assert_balanced(scene(FOLLOWERS[kind]()).solve(ANGLES))
