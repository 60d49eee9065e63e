"""The certified reference: its two paths agree, a wrong digit is caught, the library lies within rounding of it."""

import sys
from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import KinetostaticsError, MissingLibraryError, NotGivenError, QuantityError
from kinetostatics.machine.cams import cam_roller
from kinetostatics.machine.groups import rocker, slider
from kinetostatics.mechanics.quantities import components
from kinetostatics.studies.methods.high_precision.certified import (
    Enclosure,
    certified,
    enclosure,
    independent,
    relative_errors,
)
from support.case_files import shipped
from support.machines import ANGLES, KINDS, Machine

pytestmark = pytest.mark.slow

flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
mp = pytest.importorskip("mpmath", reason="mpmath is not installed (extra: precision)").mp

FEW = ANGLES[::5]


def link(mass):
    return ks.Link(mass, (0.1 * mass, -0.02), 0.03 * mass)


def four_bar():
    return ks.four_bar(
        0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.4), assembly=-1, crank=link(1.0), coupler=link(2.0), rocker=link(3.0)
    )


def six_bar():
    rocker = ks.RockerGroup(0.4, 0.3, (0.35, 0.0), coupler=link(2.0), rocker=link(1.5))
    slider = ks.SliderGroup(0.5, on="B", pin="C", label="2", coupler=link(0.5), slider=link(3.0))
    return ks.Mechanism("six-bar", ks.Crank(0.1, link(1.0)), (rocker, slider))


def long_chain():
    """Both kinds of group on the crank and on each other, inclined guides, pairs as arrays and lists."""
    groups = (
        ks.RockerGroup(0.4, 0.3, np.array([0.35, 0.1]), coupler=link(2.0), rocker=link(1.5)),
        ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.05), on="B", pin="C", label="2", coupler=link(0.5), slider=link(3.0)),
        ks.RockerGroup(0.9, 0.8, [0.9, -0.5], -1, link(0.4), link(0.7), on="C", pin="D", label="3", pivot_name="O3"),
        ks.SliderGroup(0.5, ks.Guide.at(-1.0), -1, pin="E", label="4", coupler=link(0.5), slider=link(2.0)),
    )
    return ks.Mechanism("long chain", ks.Crank(0.1, link(1.0)), groups)


@cache
def scene(name):
    """A loaded mechanism of each kind in motion."""
    if name in KINDS:
        return Machine(name).solve(FEW)
    drive = {"crank_speed": 12.0, "crank_acceleration": -30.0}
    if name == "four-bar":
        return ks.solve(four_bar(), FEW, loads=ks.Gravity(), **drive)
    if name == "six-bar":
        loads = [ks.Gravity(9.81, -1.0), ks.Spring(1e3, 0.2, on="slider2")]
        return ks.solve(six_bar(), FEW, loads=loads, **drive)
    loads = [
        ks.Gravity(),
        ks.Gravity(1.0, 0.3),
        ks.ProcessForce(np.linspace(-50.0, 50.0, FEW.size), on="slider4"),
        ks.ProcessForce(lambda motion: 80.0 * np.sin(motion.crank_angle) * motion.travel("slider2"), on="slider2"),
    ]
    return ks.solve(long_chain(), FEW, crank_speed=np.linspace(-1.0, 20.0, FEW.size), crank_acceleration=3, loads=loads)


def quantities(s):
    """Names of torque, reactions, scalar forces, slider and link motion."""
    motion = ["slider_position", "slider_velocity", "slider_acceleration"] if "slider" in s.mechanism.links else []
    links = [name + ending for name in s.mechanism.links for ending in ("_rate", "_angular_acceleration")]
    shaking = ["shaking_force", "shaking_moment", "balancing_torque_by_power"]
    return [*s.reactions, *s.scalars, *motion, *links, *shaking]


@pytest.mark.parametrize("name", [*KINDS, "four-bar", "six-bar", "long chain"])
def test_both_paths_agree_to_30_digits(name):
    checks = 1 if name == "long chain" else 2
    found = {quantity: certified(scene(name), quantity, checks=checks) for quantity in quantities(scene(name))}
    assert max(item.agreement for item in found.values()) < 1e-35
    assert max(item.radius for item in found.values()) < 1e-34
    assert {item.bits for item in found.values()} == {128}


def test_as_many_digits_as_are_asked_for():
    found = certified(scene("six-bar"), "balancing_torque", digits=100, checks=1)
    assert found.bits == 512
    assert found.agreement < 1e-100


# The library in double precision

CASES = {
    "sawframe_2r63": ("plain", "cam-circle", "cam-cosine"),
    "mower_drive": ("unbalanced", "full", "partial-1", "partial-2", "partial-3", "optimal"),
    "chain_unit": ("rho-0.1", "rho-0.5", "free-start"),
}
VARIANTS = [(case, variant) for case, variants in CASES.items() for variant in variants]
SPRUNG = ("cam-circle", "cam-cosine")
"""Variants in which the spring nearly takes the load off the slider's pin."""


def worst_error(s, quantity):
    return relative_errors(components(s, quantity), certified(s, quantity, checks=2)).max()


@pytest.mark.parametrize(("case", "variant"), VARIANTS)
def test_double_precision_is_within_5e_15(case, variant):
    """Of the pin force that springs leave, within 1e-14: two forces of 200 kN leave 12 kN."""
    s = shipped(case).solve(variant, 360)
    names = ["balancing_torque", *s.reactions, *(["slider_acceleration"] if "slider" in s.mechanism.links else [])]
    errors = {name: float(worst_error(s, name)) for name in names}
    if variant in SPRUNG:
        pin = errors.pop("B")
        assert pin < 1e-14
        assert pin * np.hypot(*s.reaction("B")).max() < 1e-15 * s.largest_force_term
    assert {name: error for name, error in errors.items() if not error < 5e-15} == {}


# Near and at limit positions


def near_limit(distance):
    """Slider and rocker whose coupler is too short for a full turn, so far from where it is stretched out."""
    slider = ks.crank_slider(0.5, 0.4, crank=link(1.0), coupler=link(2.0), slider=link(3.0))
    yield slider, np.arcsin(0.8) - distance
    rocker = ks.four_bar(0.5, 0.3, 0.4, rocker_pivot=(0.6, 0.1), coupler=link(2.0), rocker=link(3.0))
    away = np.hypot(0.6, 0.1)
    yield rocker, np.arctan2(0.1, 0.6) + np.arccos((0.25 + away**2 - 0.49) / away) - distance


@pytest.mark.filterwarnings("ignore::kinetostatics.errors.ConditionWarning")
@pytest.mark.parametrize("which", [0, 1])
def test_bits_grow_near_a_limit_position(which):
    for distance, bits in ((1e-3, 128), (1e-9, 256), (1e-13, 256)):
        mechanism, angle = list(near_limit(distance))[which]
        s = ks.solve(mechanism, [angle - 0.5, angle - 0.2, angle], crank_speed=10.0, loads=ks.Gravity())
        found = certified(s, "A")
        assert found.bits == bits
        assert found.agreement < 1e-30
        assert found.radius < 1e-30


@pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")
def test_limit_and_beyond_are_refused_by_angle():
    stretched = ks.crank_slider(1.0, 1.0, guide=ks.Guide(None, 0.0, (0.0, 1.0)), slider=link(1.0))
    with pytest.raises(NotGivenError, match=r"crank angle 0\.0 rad \(0 deg\): SliderGroup is at a limit position"):
        enclosure(ks.solve(stretched, [0.5, 0.0], crank_speed=1.0, on_gap="nan"), "A")
    meeting = ks.four_bar(0.3, 0.4, 0.4, rocker_pivot=(0.3, 0.0), coupler=link(1.0))
    with pytest.raises(NotGivenError, match="RockerGroup is at a limit position"):
        enclosure(ks.solve(meeting, [1.0, 0.0], crank_speed=1.0, on_gap="nan"), "A")
    short = ks.crank_slider(0.5, 0.4, slider=link(1.0))
    with pytest.raises(NotGivenError, match=r"1\.2 rad .* does not close"):
        enclosure(ks.solve(short, [0.1, 1.2], crank_speed=1.0, on_gap="nan"), "slider_acceleration")


def test_what_is_zero_but_for_rounding_is_given_up():
    folded = ks.crank_slider(1.0, 1.0, slider=link(1.0))  # beyond 90 deg the pin stays at O
    s = ks.solve(folded, [2.0], crank_speed=1.0)
    with pytest.raises(NotGivenError, match=r"crank-slider at crank angle 2\.0 rad .* even with 4096 bits"):
        enclosure(s, "slider_acceleration")


# What must not pass


@pytest.mark.parametrize(
    ("module", "kernel", "place", "name", "quantity"),
    [
        (slider, "place", (2,), "plain", "balancing_torque"),  # the sine
        (slider, "resolve", (1, 0), "six-bar", "guide_force2"),
        (rocker, "motion_of", (3, 0), "six-bar", "O2"),  # the divisor
        (cam_roller, "resolve", (1,), "circle", "slot_force"),
    ],
)
def test_a_kernel_wrong_by_1e_27_is_caught(monkeypatch, module, kernel, place, name, quantity):
    right = getattr(module, kernel)

    def falsified(found, place):
        if not place:
            return found * (1 + flint.arb("1e-27"))
        parts = list(found)
        parts[place[0]] = falsified(parts[place[0]], place[1:])
        return found._make(parts) if hasattr(found, "_make") else tuple(parts)

    def wrong(*arguments, **options):
        return falsified(right(*arguments, **options), place)

    monkeypatch.setattr(module, kernel, wrong)
    both = rf"crank angle .* {quantity} is .*\d{{25}}.* but .*\d{{25}}.* differ by"
    with pytest.raises(KinetostaticsError, match=both):
        certified(scene(name), quantity)


def test_guide_is_taken_by_its_direction():
    """The stored pair is 1e-10 too long, which no kernel forgives."""
    x, y = np.cos(0.3) * (1 + 1e-10), np.sin(0.3) * (1 + 1e-10)
    s = ks.solve(ks.crank_slider(0.1, 0.4, guide=ks.Guide(None, 0.05, (x, y)), slider=link(1.0)), FEW, crank_speed=5.0)
    assert certified(s, "O").agreement < 1e-35
    assert 1e-11 < worst_error(s, "O") < 1e-9


@pytest.mark.parametrize(
    ("force", "why"),
    [
        (lambda motion: np.interp(motion.crank_angle, [0.0, 7.0], [0.0, 1.0]), "cannot be computed on arb numbers"),
        (lambda motion: np.asarray(motion.slider_position, dtype=float), "is computed in double precision"),
    ],
)
def test_a_process_force_in_double_precision_is_named(force, why):
    loads = [ks.Gravity(), ks.ProcessForce(force)]
    s = ks.solve(ks.crank_slider(0.1, 0.4, slider=link(1.0)), FEW, crank_speed=5.0, loads=loads)
    with pytest.raises(NotGivenError, match=f"load 2, ProcessForce on 'slider', {why}"):
        certified(s, "balancing_torque")


class Egg(ks.cams.Cam):
    def polar(self, angle, ray):
        """A user's own curve."""
        return 0.3 + 0.02 * ray[0], -0.02 * ray[1], -0.02 * ray[0]


def test_cams_that_cannot_be_certified_are_named():
    angle = np.linspace(0.0, 2 * np.pi, 64, endpoint=False)
    sampled = ks.cam_crank_slider(ks.cams.Sampled(angle, 0.3 + 0.01 * np.cos(angle)), 1.0, slider=link(1.0))
    with pytest.raises(NotGivenError, match="cam Sampled is computed in double precision"):
        enclosure(ks.solve(sampled, FEW, crank_speed=5.0), "A")
    own = ks.solve(ks.cam_crank_slider(Egg(), 1.0, slider=link(1.0)), FEW, crank_speed=5.0)
    assert enclosure(own, "A").radius < 1e-30
    with pytest.raises(NotGivenError, match="no independent formula for cam Egg"):
        certified(own, "A")


def test_other_refusals():
    s = scene("circle")
    assert enclosure(s, "pressure_angle").radius < 1e-30
    with pytest.raises(NotGivenError, match="quantity of the independent path is 'pressure_angle'"):
        independent(s, "pressure_angle", [0])
    with pytest.raises(QuantityError, match="'nonsense'"):
        certified(s, "nonsense")
    batch = ks.solve(ks.crank_slider(np.array([[0.1], [0.2]]), 1.0), FEW, crank_speed=5.0)
    with pytest.raises(NotGivenError, match="needs a single design"):
        certified(batch, "A")


@pytest.mark.parametrize("library", ["flint", "mpmath"])
def test_a_missing_library_is_told(monkeypatch, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingLibraryError, match=r'needs python-flint and mpmath: .*"kinetostatics\[precision\]"'):
        certified(scene("plain"), "balancing_torque")


# Errors, and what is left behind


def test_errors_are_taken_exactly():
    middle = np.array([1.0, -2.0, 1.0, 1.0])
    with flint.ctx.workprec(128):
        exact = np.array([flint.arb(1) + flint.arb(2) ** -80, *map(flint.arb, middle[1:])], dtype=object)
    reference = Enclosure((middle,), (exact,), 0.0, 128)
    errors = relative_errors((np.array([1.0, -2.0 - 2.0**-51, np.nan, np.inf]),), reference)
    np.testing.assert_array_equal(errors, [2.0**-81, 2.0**-52, np.nan, np.inf])


def test_errors_of_a_vector_and_of_zero():
    parts = np.array([3.0, 0.0]), np.array([4.0, 0.0])
    exact = tuple(np.array([*map(flint.arb, part)], dtype=object) for part in parts)
    found = relative_errors((parts[0] + 3e-3, parts[1] + 4e-3), Enclosure(parts, exact, 0.0, 128))
    np.testing.assert_allclose(found, 1e-3)
    nothing = enclosure(scene("four-bar").at(FEW), "crank_rate")
    assert nothing.radius == 0.0
    zero = enclosure(scene("circle"), "slider_rate")
    np.testing.assert_array_equal(relative_errors((np.zeros(FEW.size),), zero), 0.0)
    np.testing.assert_array_equal(relative_errors((np.full(FEW.size, 1e-20),), zero), np.inf)


def test_precision_and_kernels_are_left_as_they_were():
    before = flint.ctx.prec, mp.prec
    certified(scene("four-bar"), "A", checks=1)
    with pytest.raises(QuantityError):
        certified(scene("four-bar"), "nonsense")
    assert (flint.ctx.prec, mp.prec) == before
