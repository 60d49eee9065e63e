"""Groups near dead centres: their elongation and toggle keep all digits."""

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
from kinetostatics.numbers.parameter_tree import replace_unchecked
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from kinetostatics.studies.methods.high_precision.enclosures import on_arb
from support.case_files import shipped
from support.enclosed import differences
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


@pytest.mark.slow
@every("seed", range(20))
def test_four_bar_equals_its_joint_motion(seed):
    a, b, h, pivot, aside = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, aside))
    name = "A" if seed % 2 else "C"
    for side, is_close in product(SIDES, (False, True)):
        joint = placement.joints[name]
        links = near_dead_centre.place(placement, name, b, h, pivot, side, is_close)
        found, wanted = rocker.motion_of(joint, h, pivot, *links), rocker.place(joint, b, h, pivot, side)
        for part in ("coupler", "rocker"):
            same(link(getattr(found, part)), link(getattr(wanted, part)), wanted.closure)
        same(pin(found.pin), pin(wanted.pin), wanted.closure)
        same((found.divisor[0], found.closure), (wanted.divisor[0], wanted.closure), wanted.closure)


@every("seed", range(20))
def test_slotted_lever_equals_its_joint_motion(seed):
    a, _, _, pivot, offset = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, offset))
    name, offset = "A" if seed % 2 else "C", None if seed % 4 == 0 else offset
    for side in SIDES:
        direction, *found = near_dead_centre.slotted(placement, name, pivot, offset, side)
        way, *wanted = lever.place(placement.joints[name], pivot, offset, side)
        (found[3], _), (wanted[3], _) = found[3], wanted[3]
        same((*direction, *found), (*way, *wanted), wanted[-1])


@every("seed", range(20))
def test_slider_equals_its_joint_motion(seed):
    a, length, angle, _, offset = lengths(seed)
    placement = placed(a, None if seed % 2 else (a, offset))
    name = "A" if seed % 2 else "C"
    guide = Line(None if seed % 3 else (math.cos(angle), math.sin(angle)), None if seed % 4 == 0 else offset)
    for side in SIDES:
        joint, reached = placement.joints[name], near_dead_centre.slid(placement, name, length, guide, side)
        found = slider.place(joint, length, guide, side, None, reached)
        wanted = slider.place(joint, length, guide, side)
        same(link(found.coupler), link(wanted.coupler), wanted.closure)
        one, other = ((*m.travel, m.sine, m.cosine, m.divisor[0], m.closure) for m in (found, wanted))
        same(one, other, wanted.closure)


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

    def torque(x, angle=np.array([0.4])):
        lever = ks.LeverGroup((x, 0.13), lever=body)
        rocker = ks.RockerGroup(0.4, 0.3, (x, 0.1), rocker=body)
        bars = (ks.Mechanism("bars", ks.Crank(0.1), (group,)) for group in (lever, rocker))
        return sum(ks.solve(each, angle, crank_speed=9.0, on_gap="nan").balancing_torque[0] for each in bars)

    slope, step = float(double.grad(torque)(0.35, double.numpy.array([0.4]))), 1e-6
    assert slope == pytest.approx(float(torque(0.35 + step) - torque(0.35 - step)) / (2 * step), rel=1e-7)


HEAVY = ks.Link(3.0, 0.2, 5e-2)
INCLINED = {
    "lever": (ks.LeverGroup((3 / 16, 4 / 16), lever=HEAVY, block=ks.Link(1.0)), math.atan2(4.0, 3.0)),
    "cylinder": (ks.CylinderGroup((3 / 16, 4 / 16), rod=HEAVY, cylinder=HEAVY), math.atan2(4.0, 3.0)),
    "slider": (ks.SliderGroup(5 / 16, ks.Guide.at(1.0, 0.0), coupler=HEAVY, slider=HEAVY), 1.0 + 0.5 * math.pi),
}
"""A at an inclined pivot, or B at O: joints bear more without end, but the crank does not."""


@pytest.mark.slow
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


# Elongation and departure of sliders, neither of which has the rounding of the travel

STRAIGHT = np.linspace(5.7, 6.28, 40)
"""Crank angles at which the toggle of the toggle press is nearly straight."""
ENDS = np.r_[-0.3:0.3:30j]
WAYS = {
    "out": (ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), ENDS),
    "offset": (ks.crank_slider(0.05, 0.2, guide_offset=0.004, slider=ks.Link(1.0)), ENDS),
    "behind": (ks.crank_slider(0.05, 0.2, assembly=-1, slider=ks.Link(1.0)), ENDS + np.pi),
    "inclined": (ks.crank_slider(0.05, 0.2, guide=ks.Guide.at(0.4), slider=ks.Link(1.0)), ENDS + 0.4),
}


def off(found, exact):
    """Largest difference of numbers from exact ones."""
    return max(abs(float(one - float(other))) for one, other in zip(exact, found, strict=True))


@every("name", [*WAYS, "toggle"])
def test_elongation_near_dead_centre_is_exact(name, flint):
    """Its error is less than half that of their difference, where it is counted from a place near the dead centre."""
    scene, turn = shipped("toggle_press").variants["idle"].scene, STRAIGHT
    if name in WAYS:
        mechanism, turn = WAYS[name]
        scene = ks.Scene(mechanism, 30.0)
    s = scene.solve(turn)
    slider = s.mechanism.slider or "slider2"
    free = float(s.travel(slider)[0])
    exact = on_arb(flint.arb, s).elongation(flint.arb(free), slider)
    assert off(s.elongation(free, slider), exact) < 0.5 * off(s.travel(slider) - free, exact)


@every("name", WAYS)
def test_departure_is_curvature_plus_elongation(name, flint):
    """On a pin of the crank, from the coupler alone."""
    mechanism, turn = WAYS[name]
    s = ks.Scene(mechanism, 30.0).solve(turn)
    (group,) = mechanism.groups
    free = group.side * 0.2
    run = on_arb(flint.arb, s)
    exact = run.mechanism.groups[0].departure(run.placement, flint.arb(free))
    by_parts = run.placement.travels["slider"].second + run.elongation(flint.arb(free))
    assert max(abs(float(one - other)) for one, other in zip(exact, by_parts, strict=True)) < 1e-50
    assert off(group.departure(s.dynamics.placement, free), exact) < 1e-17


def test_own_cam_beside_a_harmonic_one_counts():
    class Larger(ks.cams.Harmonic):
        """By a millimetre."""

        def polar(self, angle, ray):
            radius, *derivatives = super().polar(angle, ray)
            return radius + 1e-3, *derivatives

    spring = [ks.Spring(2e5, 2.0, cubic=1e7)]
    given = (0.27, -0.012, 0.024), (0.0002,)
    own, plain = (
        ks.Scene(ks.cam_crank_slider(cam, 2.01, slider=ks.Link(600.0)), 33.5, 0.0, spring).solve(36)
        for cam in (Larger(*given), ks.cams.Harmonic((0.271, *given[0][1:]), given[1]))
    )
    np.testing.assert_allclose(own.reaction("B"), plain.reaction("B"), rtol=0.0, atol=1e-13 * own.largest_force_term)


# Knuckles

CRANK, COUPLER, ROCKER = 0.085, 0.512, 0.3
AWAY, BESIDE = 0.6, 0.35
AROUND = np.linspace(0.0, 2 * np.pi, 240, endpoint=False) + 0.007
PRESSES = {"right": (1, 1), "left": (-1, 1), "right, upside down": (1, -1), "left, upside down": (-1, -1)}


def press(away=AWAY, beside=BESIDE, coupler=COUPLER, way=(1, 1), axis=0, off=0.0, guide=None, on="B"):
    """A toggle press whose toggle is so far from O along an axis, the ram moving along the other one toward it."""
    (x, y), turn = way, (lambda pair: pair[::-1] if axis else pair)
    pivot = turn((x * away, y * beside))
    through = [turn((x * away + off, y * beside)), turn((x * away + off, y * (beside - 0.6)))]
    rocker = ks.RockerGroup(coupler, ROCKER, pivot, -1 if (x * y > 0) is (axis == 0) else 1)
    ram = ks.SliderGroup(0.3, guide or ks.Guide.through(*through), on=on, pin="C", label="2", slider=ks.Link(150.0))
    return ks.Mechanism("press", ks.Crank(CRANK), (rocker, ram))


def plainly(mechanism):
    """The same by the formulas of other rockers."""
    rocker, ram = mechanism.groups
    return replace_unchecked(mechanism, groups=(replace_unchecked(rocker, toggle=""), ram))


def directions(mechanism):
    return ks.Scene(mechanism, 6.0).solve(AROUND).dynamics.placement.links["rocker"].direction


@pytest.mark.slow
@every("side, axis", [(side, axis) for side in PRESSES for axis in (0, 1)])
def test_toggle_pin_is_off_its_line_by_lengths(side, axis, flint):
    mechanism = press(way=PRESSES[side], axis=axis)
    assert mechanism.groups[0].toggle == "xy"[axis]
    exact = on_arb(flint.arb, ks.Scene(mechanism, 6.0).solve(AROUND)).placement.links["rocker"].direction[axis]
    straight = np.abs(exact.astype(float)) < 0.1
    known, plain = (
        np.max(np.abs(differences(directions(made)[axis], [exact])[0])[straight])
        for made in (mechanism, plainly(mechanism))
    )
    assert known < 1.2e-16 < 2e-16 < plain


OTHERS = {
    "guide beside the pivot": press(off=0.02),
    "inclined guide": press(guide=ks.Guide.at(-1.5, 0.62)),
    "guide given by its angle": press(guide=ks.Guide.at(-np.pi / 2, 0.6)),
    "coupler that may lean": press(away=0.45),
    "long coupler": press(away=0.88, coupler=0.8),
    "slider on the crank": press(on="A"),
}


@every("name", OTHERS)
def test_other_rockers_are_none(name):
    assert OTHERS[name].groups[0].toggle == ""


def test_a_batch_is_one_if_all_its_designs_are():
    guide = ks.Guide.through((0.6, 0.35), (0.6, -0.25))
    for pivots, toggle in (([[0.6], [0.602]], "x"), ([[0.6], [0.62]], "")):
        rocker = ks.RockerGroup(COUPLER, ROCKER, (np.array(pivots), BESIDE), -1)
        chain = rocker, ks.SliderGroup(0.3, guide, on="B", pin="C", label="2")
        assert ks.Mechanism("presses", ks.Crank(CRANK), chain).groups[0].toggle == toggle


def test_coupler_may_point_to_either_side():
    """As in a program, whose lengths may become others after it was recorded."""
    bars = ks.Mechanism("double crank", ks.Crank(0.4), (ks.RockerGroup(0.3, 0.35, (0.1, 0.02)),))
    for toggle, axis in (("x", 0), ("y", 1)):
        known = replace_unchecked(bars, groups=(replace_unchecked(bars.groups[0], toggle=toggle),))
        one, other = (directions(made)[axis] for made in (known, bars))
        assert np.min(other) < -0.9 < 0.9 < np.max(other)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=3e-15)
