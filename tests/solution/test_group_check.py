"""What is handed in is kept as it was, groups of one's own are tested, and slips of units are hinted at."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinetostatics as ks
from kinetostatics.machine.group import MEMBERS
from kinetostatics.machine.kinematic_state import Course, Orbit
from kinetostatics.machine.links import Joint, Wrench
from support.every import every
from support.scenes import Pan

TURN = 2 * np.pi * np.arange(72) / 72
ROD = ks.Link(2.0, (0.2, 0.05), 0.03)
SPEEDS = np.array([1.0, 3.0, 7.0])


def mechanism(**changes):
    values = {"crank_length": 0.1, "coupler_length": 0.4, "coupler": ROD, "slider": ks.Link(3.0)} | changes
    return ks.crank_slider(**values)


def solve(made=None, angle=TURN, **changes):
    return ks.solve(made or mechanism(), angle, **{"crank_speed": 5.0, "loads": ks.Gravity()} | changes)


# Arrays shared with the caller

PLACES = {
    "crank speed": lambda x: solve(crank_speed=x),
    "crank acceleration": lambda x: solve(crank_acceleration=x),
    "force": lambda x: solve(loads=ks.ProcessForce(x)),
    "mass": lambda x: solve(mechanism(slider=ks.Link(x))),
    "centre": lambda x: solve(mechanism(slider=ks.Link(2.0, (0.1, x), 0.1), crank=ks.Link(1.0, x))),
    "inertia": lambda x: solve(mechanism(coupler=ks.Link(2.0, 0.1, x / 10))),
    "crank length": lambda x: solve(mechanism(crank_length=x / 100)),
    "coupler length": lambda x: solve(mechanism(coupler_length=x)),
    "guide offset": lambda x: solve(mechanism(guide_offset=x / 100)),
    "guide by hand": lambda x: solve(mechanism(guide=ks.Guide(0.0, x / 100))),
    "stiffness": lambda x: solve(loads=ks.Spring(x, 0.3)),
    "gravity": lambda x: solve(loads=ks.Gravity(x)),
    "pivot": lambda x: solve(ks.four_bar(0.1, 4.0, 4.0, rocker_pivot=(x / 9, 3.0), rocker=ks.Link(1.0, 0.1))),
    "circle": lambda x: solve(ks.cam_crank_slider(ks.cams.Circle(x / 9, (x / 100, 0.0)), 2.0, slider=ks.Link(1.0))),
    "cosine law": lambda x: solve(ks.crank_slider(0.1, ks.cams.CosineLaw(x / 100, 2.0).coupler_length)),
    "crank angles": lambda x: solve(angle=TURN + x),
}


@pytest.mark.slow
@every("shape", [(), (1,), (1, 1)])
@every("name", PLACES)
def test_refilled_array_changes_nothing_made(name, shape):
    """Each in a loop over one buffer, read only when the loop is over."""
    buffer, made = np.empty(shape), []
    for value in SPEEDS:
        buffer[...] = value
        made.append(PLACES[name](buffer))
    expected = [PLACES[name](np.full(shape, value)) for value in SPEEDS]
    for found, wanted in zip(made, expected, strict=True):
        assert_array_equal(found.balancing_torque, wanted.balancing_torque)


def test_arrays_are_kept_as_read_only_copies():
    mass, length, speed = np.full((3, 1), 2), np.full((3, 1), 0.1, dtype=np.float32), np.full(72, 5.0)
    made = mechanism(crank_length=length, slider=ks.Link(mass))
    s = solve(made, crank_speed=speed)
    for kept in (made.links["slider"].mass, made.crank.length, s.crank_speed):
        assert kept.dtype == float
        with pytest.raises(ValueError, match="read-only"):
            kept[0] = 1.0
    assert mass.flags.writeable
    assert speed.flags.writeable
    assert replace(made.groups[0]).slider.mass is made.links["slider"].mass


class Flat(ks.cams.Cam):
    """A cam of the user's own that can be changed."""

    def __init__(self, mean):
        self.mean = mean

    def polar(self, angle, ray):
        """Nearly round."""
        return self.mean + 0.01 * ray[0], -0.01 * ray[1], -0.01 * ray[0]


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize("mean", [0.3, np.array(0.3), np.array([0.3])])
def test_own_cam_is_taken_as_it_is_when_made(interpreted, engine, mean):
    cam = Flat(mean)
    before = ks.cam_crank_slider(cam, 2.0, slider=ks.Link(3.0))
    torque = solve(before, engine=engine).balancing_torque
    if np.ndim(mean):
        cam.mean[...] = 0.5
    cam.mean = cam.mean * 0.0 + 0.5
    after = ks.cam_crank_slider(cam, 2.0, slider=ks.Link(3.0))
    assert_array_equal(solve(before, engine=engine).balancing_torque, torque)
    assert_array_equal(
        solve(after).balancing_torque,
        solve(ks.cam_crank_slider(Flat(0.5), 2.0, slider=ks.Link(3.0))).balancing_torque,
    )


def test_own_load_is_taken_as_it_is_when_solved():
    push = type("Push", (), {"on": "slider", "push": lambda self, motion: self.force})()
    made = []
    for push.force in SPEEDS:
        made.append(solve(loads=[push]))
    for s, force in zip(made, SPEEDS, strict=True):
        wanted = solve(loads=ks.ProcessForce(force)).balancing_torque
        assert_allclose(s.balancing_torque, wanted, rtol=0.0, atol=1e-14 * abs(wanted).max())


# Groups of one's own


@dataclass(frozen=True, eq=False)
class Mine(ks.RockerGroup):
    """A group of the user's own: the rocker group, with what is to be changed of it."""

    change: Any = None

    def place(self, placement):
        """Place, then change."""
        super().place(placement)
        if self.change in WRONG:
            WRONG[self.change][1](placement)

    def resolve(self, placement, loads, along):
        """Resolve, then change."""
        found = super().resolve(placement, loads, along)
        if self.change == "wrong force":
            x, y = found.demands["A"].force
            found.demands["A"] = Wrench((-x, y), None)
        if self.change == "other name":
            found.reactions["O"] = found.reactions.pop("B")
        return found


def _joint(placement, **changes):
    placement.joints["B"] = placement.joints["B"]._replace(**changes)


def _link(placement, name, **changes):
    placement.links[name] = placement.links[name]._replace(**changes)


def _times(factor, vector):
    return tuple(factor * part for part in vector)


WRONG = {
    "wrong first": ("first derivative of joint B", lambda p: _joint(p, first=_times(-1.0, p.joints["B"].first))),
    "wrong second": ("second derivative of joint B", lambda p: _joint(p, second=_times(1.1, p.joints["B"].second))),
    "no second": ("second derivative of joint B", lambda p: _joint(p, second=None)),
    "wrong ratio": ("ratio of rocker", lambda p: _link(p, "rocker", ratio=2.0 * p.links["rocker"].ratio)),
    "no ratio_slope": ("ratio_slope of coupler", lambda p: _link(p, "coupler", ratio_slope=None)),
    "long direction": (
        "direction of coupler",
        lambda p: _link(p, "coupler", direction=_times(2.0, p.links["coupler"].direction)),
    ),
    "wrong length": ("length of coupler", lambda p: _joint(p, position=_times(1.1, p.joints["B"].position))),
    "other joint": (
        "reference joint of coupler",
        lambda p: _link(p, "coupler", joint=Joint((9.0, 0.0), None, None)),
    ),
    "other swing": (
        "swing of B",
        lambda p: p.courses.update(B=Course(swing=p.course("B").swing._replace(radius=0.31))),
    ),
    "wrong departure": ("departure of B", lambda p: p.courses.update(B=Course(departure=p.joints["B"].second))),
    "wrong orbit": ("orbit of B", lambda p: p.courses.update(B=Course(orbit=Orbit(0.3, 0.01)))),
    "wrong force": ("work of the forces along x", lambda p: None),
}
"""By change: the check that sees it, and how it changes the placement; of a wrong force `resolve` does."""


def mine(change=None):
    return Mine(0.4, 0.3, (0.35, 0.1), coupler=ROD, rocker=ROD, change=change)


@pytest.mark.slow
@every("change", WRONG)
def test_check_says_what_is_wrong_with_a_group(change):
    report, (what, _) = ks.check(mine(change)), WRONG[change]
    assert not report
    assert any(problem.startswith(what) for problem in report.problems)
    assert f"WRONG  {report.errors[what]:7.1e}  {what}" in repr(report)


class Departing(ks.SliderGroup):
    """A slider group that tells its departure wrongly."""

    def departure(self, placement, position):
        """Too much by a tenth."""
        return 1.1 * super().departure(placement, position)


def test_check_reports_a_wrong_departure():
    assert ks.check(Departing(0.5)).problems[0].startswith("departure of slider")
    assert "departure of slider" in ks.check(ks.SliderGroup(0.5)).errors


class Outward(ks.SliderGroup):
    """A slider group that parts its elongation wrongly."""

    def outward(self, placement, position):
        """Too much by a tenth of the coupler."""
        return 0.1 * self.coupler_length, self.elongation(placement, position)


def test_check_reports_wrong_elongation_parts():
    assert ks.check(Outward(0.5)).problems[0].startswith("outward part of slider")


TABLE = 0.3 + 0.05 * np.cos(TURN)


@every(
    "group",
    [
        mine(),
        Pan(ROD),
        ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1), -1, ROD, ROD),
        ks.SliderGroup(0.5, on="B", pin="C", label="2"),
        ks.RockerGroup(0.4, 0.3, (0.35, 0.1), -1, ROD, ROD),
        ks.RockerGroup(4.0, 30.0, (30.5, 10.0), on="B", pin="C", pivot_name="O3", label="2"),
        ks.CamRoller(ks.cams.Circle(0.3, (0.05, 0.1)), ROD),
        ks.CamRoller(ks.cams.CosineLaw(0.3, 2.0), ROD),
        ks.CamRoller(ks.cams.Sampled(TURN, TABLE), ROD),
    ],
)
def test_check_passes_right_groups(group):
    report = ks.check(group)
    assert report.ok, report
    assert max(report.errors.values()) < 1e-8
    assert "checks pass" in repr(report)


@every(
    ("group", "words"),
    [
        (3.0, "group must be a group"),
        (ks.RockerGroup, "it is a class"),
        (ks.Link(), "group must be a group|lacks"),
        (ks.RockerGroup(1.0, 1.0, (500.0, 0.0)), "closes nowhere within 30 m of O"),
        (ks.SliderGroup(np.array([[0.5], [0.6]])), "one design, not a batch"),
    ],
)
def test_check_refuses_what_it_cannot_test(group, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.check(group)


def chain(change=None):
    return ks.Mechanism("mine", ks.Crank(0.1, ROD), (mine(change),))


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize("change", ["wrong force", "wrong ratio"])
def test_a_group_whose_forces_lose_power_is_warned_of(interpreted, engine, change):
    with pytest.warns(
        UserWarning, match=r"mine: the balancing torque .* differs from .* by up to .*see ks\.check\(group\)"
    ):
        solve(chain(change), engine=engine).reaction("O")


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
def test_right_own_group_equals_the_librarys(interpreted, engine):
    right = ks.Mechanism("mine", ks.Crank(0.1, ROD), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1), 1, ROD, ROD),))
    found, wanted = (solve(mechanism, engine=engine).balancing_torque for mechanism in (chain(), right))
    assert_allclose(found, wanted, rtol=0.0, atol=1e-14 * abs(wanted).max())


@pytest.mark.parametrize("on", [3, None, ["A"], "Q"])
def test_joint_of_an_own_group_is_named_and_there(on):
    with pytest.raises(ks.ParameterError, match=r"on of Pan must be a name|is attached to joint 'Q'"):
        ks.Mechanism("pan", ks.Crank(0.1), (Pan(ROD, on=on),))


@every("bad", [np.nan, np.inf, -np.inf])
@every("on_gap", ["raise", "nan"])
@every("shape", [(72,), (2, 36), (72, 1)])
def test_infinite_angles_are_refused_despite_gaps(bad, on_gap, shape):
    angle = TURN.copy()
    angle[40] = bad
    with pytest.raises(ks.ParameterError, match="crank angles must be finite"):
        solve(angle=angle.reshape(shape), on_gap=on_gap)


def test_undeclared_reaction_is_refused():
    words = r"mine: Mine resolves reaction 'O', which its outputs do not declare; Mine declares reaction 'B', but"
    with pytest.raises(ks.ParameterError, match=words):
        solve(chain("other name")).reaction("O")


def test_group_must_derive_from_group():
    lone = type("Lone", (), dict.fromkeys(MEMBERS))()
    with pytest.raises(ks.ParameterError, match=r"Lone is not derived from kinetostatics\.machine\.group\.Group"):
        ks.Mechanism("lone", ks.Crank(0.1), (lone,))


# States of links beside those of joints, guides and slots


NAMES = {
    "slider": (ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1)), "acceleration of B as a point of slider"),
    "travel": (ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1)), "acceleration of the travel of slider"),
    "rocker": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "acceleration of B by coupler"),
    "frame": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "velocity of O2 as a point of the frame"),
    "swing": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "centre and radius of the swing of B"),
    "slot": (ks.LeverGroup((0.1, -0.3), offset=0.05), "distance of A from the slot of lever"),
    "sliding": (ks.LeverGroup((0.1, -0.3), offset=0.05), "moment of sliding of slot"),
    "rod": (ks.CylinderGroup((0.3, -0.4)), "direction of rod along cylinder"),
    "pin": (ks.Pin(on="coupler", at=(0.1, 0.2), name="C"), "acceleration of C as a point of coupler"),
}


@every("name", NAMES)
def test_each_comparison_is_made_and_holds_to_rounding(name):
    group, what = NAMES[name]
    assert ks.check(group).errors[what] < 1e-12


def test_wrong_acceleration_is_named_once_each():
    class Own(ks.SliderGroup):
        """A slider group whose link says that it is slowed down where it is driven."""

        def place(self, placement):
            """Place, and turn an acceleration round."""
            super().place(placement)
            motion = placement.links["slider"]
            joint = motion.joint._replace(second=tuple(-part for part in motion.joint.second))
            placement.links["slider"] = motion._replace(joint=joint)

    wrong = {what for what, error in ks.check(Own(0.5)).errors.items() if error > 1e-6}
    assert {"acceleration of B as a point of slider", "acceleration of the travel of slider"} <= wrong
    assert np.all(["B" in what or "slider" in what for what in wrong])
