"""Kernels in the crank angle from a pivot or guide: the same as the general ones, and exact where those lose digits."""

import math
from itertools import product

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import ConditionWarning
from kinetostatics.machine.groups import lever, near_dead_centre, rocker, slider
from kinetostatics.machine.guide import Line
from kinetostatics.machine.kinematic_state import Throw
from kinetostatics.mechanics.quantities import largest_term
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from support.every import every

TURN = np.linspace(-7.0, 7.0, 41)
SIDES = (1, -1)


def placed(crank, ahead=None):
    """The pin of a crank, A, and one beside it, C."""
    pins = () if ahead is None else (ks.Pin(on="crank", at=ahead, name="C"),)
    return ks.Mechanism("pins", ks.Crank(crank), (*pins, ks.SliderGroup(9.0 * crank))).place(TURN)


def lengths(seed):
    random = np.random.default_rng(seed)
    pivot = (random.uniform(-1, 1), 0.0 if seed % 3 == 0 else random.uniform(-1, 1))
    return *random.uniform(0.1, 1.0, 3), pivot, random.uniform(-0.3, 0.3)


def same(one, other, closure):
    """Check that two results are the same where the linkage closes and is not near a limit position."""
    good = closure > 1e-3
    assert good.any() or not (closure > 0).any()
    for a, b in zip(one, other, strict=True):
        here, there = (np.broadcast_to(values, TURN.shape)[good] for values in (a, b))
        np.testing.assert_allclose(here, there, rtol=1e-11, atol=1e-11)


def link(motion):
    return *motion.direction, motion.ratio, motion.ratio_slope


def pin(at):
    return *at.position, *at.first, *at.second


@every("seed", range(20))
def test_four_bar_equals_its_joint_motion(seed):
    a, b, h, pivot, aside = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, aside))
    name = "A" if seed % 2 else "C"
    for side, is_close in product(SIDES, (False, True)):
        found = rocker.turned_by_crank(placement, name, b, h, pivot, side, is_close, "")
        wanted = rocker.place(placement.joints[name], b, h, pivot, side)
        for part in ("coupler", "rocker"):
            same(link(getattr(found, part)), link(getattr(wanted, part)), wanted.closure)
        same(pin(found.pin), pin(wanted.pin), wanted.closure)
        same(found[3:], wanted[3:], wanted.closure)


@every("seed", range(20))
def test_slotted_lever_equals_its_joint_motion(seed):
    a, _, _, pivot, offset = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, offset))
    name, offset = "A" if seed % 2 else "C", None if seed % 4 == 0 else offset
    for side in SIDES:
        found = lever.passed(placement, name, pivot, offset, near_dead_centre.slotted, side)
        wanted = lever.place(placement.joints[name], pivot, offset, side)
        same(link(found.lever), link(wanted.lever), wanted.closure)
        same(found[2:], wanted[2:], wanted.closure)


@every("seed", range(20))
def test_slider_equals_its_joint_motion(seed):
    a, length, angle, _, offset = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, offset))
    name = "A" if seed % 2 else "C"
    guide = Line(None if seed % 3 else (math.cos(angle), math.sin(angle)), None if seed % 4 == 0 else offset)
    for side in SIDES:
        found = slider.passed(placement, name, length, guide, near_dead_centre.slid, side)
        wanted = slider.place(placement.joints[name], length, guide, side)
        same(link(found.coupler), link(wanted.coupler), wanted.closure)
        same((*found.travel, *found[2:6]), (*wanted.travel, *wanted[2:6]), wanted.closure)


def test_pivot_at_the_centre_has_finite_motion():
    together = ks.solve(ks.four_bar(0.5, 0.4, 0.3, rocker_pivot=(0.0, 0.0)), TURN, crank_speed=1.0)
    np.testing.assert_allclose(together.rate("rocker"), 1.0, rtol=1e-14)
    many = ks.four_bar(0.5, 0.4, 0.3, rocker_pivot=(np.array([[0.0], [0.2]]), np.array([[0.0], [0.1]])))
    np.testing.assert_allclose(ks.solve(many, TURN, crank_speed=1.0, on_gap="nan").rate("rocker")[0], 1.0, rtol=1e-14)
    with pytest.warns(ConditionWarning):
        met = ks.solve(ks.four_bar(0.5, 0.4, 0.4, rocker_pivot=(0.5, 0.0)), [0.0, 1e-30, 0.1], crank_speed=1.0)
    assert np.isfinite(met.position("B")).all()
    assert np.isfinite(met.rate("rocker")).all()


@every(
    "given, close",
    [
        ((0.3, 0.0, 2.0), False),
        ((0.3, 0.2, 0.5001), True),
        ((0.3, -0.2, 0.5001), True),
        ((0.3, 0.2, 0.0999), True),
        ((0.5, 0.1, 0.41), True),
        ((0.3, 0.2, 0.6), False),
        ((0.3, np.array([[0.0], [0.2]]), 0.5001), True),
        ((0.3, np.array([[0.0], [0.1]]), 0.5001), False),
    ],
)
def test_nearly_equal_lengths_are_recognised(given, close):
    radius, offset, length = given
    assert near_dead_centre.has_small_clearance(Throw((radius, 0.0), True), offset, length) is close
    assert near_dead_centre.has_small_clearance(Throw((0.6 * radius, 0.8 * radius)), offset, length) is close


@pytest.mark.slow
def test_traced_lengths_have_derivatives(double):
    body = ks.Link(3.0, 0.1, 0.1)

    def torque(x):
        lever = ks.LeverGroup((x, 0.13), lever=body)
        rocker = ks.RockerGroup(0.4, 0.3, (x, 0.1), rocker=body)
        angle = double.numpy.array([0.4])
        bars = (ks.Mechanism("bars", ks.Crank(0.1), (group,)) for group in (lever, rocker))
        return sum(ks.solve(each, angle, crank_speed=9.0, on_gap="nan").balancing_torque[0] for each in bars)

    slope, step = float(double.grad(torque)(0.35)), 1e-6
    assert slope == pytest.approx(float(torque(0.35 + step) - torque(0.35 - step)) / (2 * step), rel=1e-7)


HEAVY = ks.Link(3.0, 0.2, 5e-2)
INCLINED = {
    "lever": (ks.LeverGroup((3 / 16, 4 / 16), lever=HEAVY, block=ks.Link(1.0)), math.atan2(4.0, 3.0)),
    "cylinder": (ks.CylinderGroup((3 / 16, 4 / 16), rod=HEAVY, cylinder=HEAVY), math.atan2(4.0, 3.0)),
    "slider": (ks.SliderGroup(5 / 16, ks.Guide.at(1.0, 0.0), coupler=HEAVY, slider=HEAVY), 1.0 + 0.5 * math.pi),
}
"""A at an inclined pivot, or B at O: joints bear more without end, but the crank does not."""


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("name", INCLINED)
def test_torque_keeps_digits_that_reactions_lose(flint, name):
    group, angle = INCLINED[name]
    machine = ks.Mechanism(name, ks.Crank(5 / 16, ks.Link(1.0, 0.1)), (group,))
    for distance in (1e-12, 1e-8, 1e-4):
        s = ks.solve(machine, angle + distance * np.linspace(0.5, 1.0, 6), crank_speed=33.0, loads=ks.Gravity())
        torque, support = (enclosure(s, quantity) for quantity in ("balancing_torque", "O"))
        assert support.largest * distance > 30.0
        error = np.max(relative_errors(s.balancing_torque[None], torque)) * torque.largest
        assert error < 1e-14 * largest_term(s, "balancing_torque")
        assert np.max(relative_errors(s.reaction("O"), support)) < 5e-16 / distance


def test_clear_pivot_torque_is_crank_equilibrium():
    clear = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=HEAVY)
    assert not clear.has_unbounded_reactions
    s = ks.solve(clear, TURN, crank_speed=9.0)
    (x, y), (along, up) = s.position("A"), s.reaction("A")
    np.testing.assert_allclose(s.balancing_torque, x * up - y * along, rtol=1e-13, atol=1e-13)
