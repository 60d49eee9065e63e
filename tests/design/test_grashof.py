"""Grashof class of four-bars, closed intervals, change points: against sweeps of every inversion."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design.linkage import grashof
from support.every import every
from support.machines import TURN, planar
from support.machines import four_bar_of as four_bar
from support.machines import swept as solved
from support.strategies import number, reproducible

pytestmark = pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")

JOINTS = ("O", "A", "B", "O2")
EXAMPLES = {
    "crank-rocker": (1.0, 3.0, 3.5, 4.0),
    "double-crank": (3.5, 4.0, 3.0, 1.0),
    "double-rocker": (3.5, 1.0, 3.0, 4.0),
    "rocker-crank": (3.0, 4.0, 1.0, 3.5),
    "triple-rocker": (2.0, 3.0, 3.5, 5.0),
}
CHANGE_POINTS = {
    "crank and rocker equal, parallelogram": (1.0, 2.0, 1.0, 2.0),
    "crank longer, parallelogram": (2.0, 1.0, 2.0, 1.0),
    "crank and frame equal, kite": (1.0, 2.0, 2.0, 1.0),
    "crank and coupler equal, kite": (1.0, 1.0, 2.0, 2.0),
    "rocker and frame equal, kite": (3.0, 3.0, 1.0, 1.0),
    "crank shortest": (1.0, 3.0, 2.5, 1.5),
    "frame shortest": (2.5, 3.0, 1.5, 1.0),
}
DECIMAL = [(0.16, 2.5, 0.28, 2.38), (0.12, 0.9, 0.82, 1.6), (1.01, 1.77, 2.92, 3.68)]
"""Shortest and longest link are as long as the other two in decimals, but not when rounded to binary."""


def joints_that_turn(lengths):
    """By sweeping: of each joint the inversion of the linkage in which it is the crank's pivot closes all the way."""
    inversions = {joint: np.roll(lengths, -number).tolist() for number, joint in enumerate(JOINTS)}
    return {joint for joint, found in inversions.items() if np.all(np.isfinite(solved(four_bar(found)).position("B")))}


# Grashof's classes


@pytest.mark.parametrize("kind", EXAMPLES)
def test_grashof_kind_equals_a_sweep(kind):
    found = grashof(four_bar(EXAMPLES[kind]))
    assert found.kind == kind
    assert set(found.turning_joints) == joints_that_turn(EXAMPLES[kind])


@pytest.mark.slow
@settings(reproducible, max_examples=60)
@given(lengths=st.tuples(*4 * [number(0.1, 3.0)]))
def test_turning_joints_of_random_bars_equal_a_sweep(lengths):
    ordered = sorted(lengths)
    assume(abs(ordered[0] + ordered[3] - ordered[1] - ordered[2]) > 0.02)
    assume(ordered[3] < sum(ordered[:3]))
    found = grashof(four_bar(lengths))
    assert set(found.turning_joints) == joints_that_turn(lengths)
    whole_turn = found.intervals == ((0.0, 2 * np.pi),)
    assert whole_turn == ("O" in found.turning_joints)


@pytest.mark.parametrize("assembly", [1, -1])
@pytest.mark.parametrize("kind", ["crank-rocker", "double-crank"])
def test_turning_joints_wind_around_each_other(kind, assembly):
    s = solved(four_bar(EXAMPLES[kind], 0.3, assembly))
    direction = {name: s.placement.links[name].direction for name in s.mechanism.links}
    angle = {name: np.unwrap(np.arctan2(y, x)) for name, (x, y) in direction.items()} | {"frame": np.zeros(TURN.size)}
    pairs = (("frame", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("rocker", "frame"))
    turns = {
        joint: np.ptp((angle[a] - angle[b])[[0, -1]]) / (2 * np.pi) for joint, (a, b) in zip(JOINTS, pairs, strict=True)
    }
    assert {joint for joint, number in turns.items() if round(number)} == set(grashof(s.mechanism).turning_joints)


@pytest.mark.parametrize("name", CHANGE_POINTS)
def test_change_point_linkages_are_recognised(name):
    found = grashof(four_bar(CHANGE_POINTS[name]))
    assert found.kind == "change-point"
    assert found.intervals == ((0.0, 2 * np.pi),)
    assert np.all(np.isfinite(solved(four_bar(CHANGE_POINTS[name])).position("B")))


@pytest.mark.parametrize("lengths", [*DECIMAL, (0.4, 0.7, 0.9, 0.2), (0.3, 0.3, 1.9, 1.9)])
def test_decimal_lengths_make_no_gap_by_rounding(lengths):
    found = grashof(four_bar(lengths))
    assert found.kind == "change-point"
    assert found.intervals == ((0.0, 2 * np.pi),)


@pytest.mark.parametrize("lengths", DECIMAL)
def test_decimal_change_point_is_warned_of(lengths):
    with pytest.warns(ks.ConditionWarning, match="near a limit position"):
        ks.solve(four_bar(lengths), np.radians([0.0, 90.0, 180.0, 270.0]), crank_speed=1.0)


def test_a_linkage_that_never_closes_has_no_interval():
    mechanism = four_bar((1.0, 1.0, 1.0, 5.0))
    found = grashof(mechanism)
    assert (found.turning_joints, found.intervals) == ((), ())
    with pytest.raises(ks.AssemblyError) as caught:
        ks.solve(mechanism, TURN, crank_speed=1.0)
    assert caught.value.intervals == ((0.0, 2 * np.pi),)


# Closed intervals


def assert_intervals_complement(mechanism):
    """Closed intervals and those of the error make up one turn, and NaN is exactly in the latter."""
    closed = grashof(mechanism).intervals
    with pytest.raises(ks.AssemblyError, match="difference and the sum of coupler and rocker lengths") as caught:
        ks.solve(mechanism, TURN, crank_speed=1.0)
    gaps = caught.value.intervals
    ends = np.sort(np.mod([end for interval in closed for end in interval], 2 * np.pi))
    edges = np.sort(np.mod([end for interval in gaps for end in interval], 2 * np.pi))
    assert_allclose(ends, edges, rtol=0, atol=1e-9)
    assert sum(end - start for start, end in (*closed, *gaps)) == pytest.approx(2 * np.pi, abs=1e-9)
    beside = np.concatenate([TURN, ends - 1e-9, ends + 1e-9])
    inside = np.any([np.mod(beside - start, 2 * np.pi) < end - start for start, end in closed], axis=0)
    s = solved(mechanism, beside)
    for values in (s.position("B")[0], s.rate("coupler"), s.angular_acceleration("rocker"), s.reaction("O2")[1]):
        assert np.array_equal(np.isfinite(values), inside)
    assert np.all(np.isfinite(s.position("A")))


@pytest.mark.slow
@every("frame_angle", [0.0, 0.1, 2.0, -2.5, np.pi])
@every("kind", ["double-rocker", "rocker-crank", "triple-rocker"])
def test_closed_intervals_complement_assembly_errors(kind, frame_angle):
    assert_intervals_complement(four_bar(EXAMPLES[kind], frame_angle))


@pytest.mark.slow
@settings(reproducible, max_examples=40)
@given(lengths=st.tuples(*4 * [number(0.1, 3.0)]), frame_angle=number(-3.1, 3.1))
def test_closed_intervals_of_random_bars_fit_the_gaps(lengths, frame_angle):
    """One interval or two, around the frame line or away from it."""
    mechanism = four_bar(lengths, frame_angle)
    closed = grashof(mechanism).intervals
    widths = [end - start for start, end in closed]
    assume(closed and min(widths) > 0.1 and sum(widths) < 6.1)
    assume(len(closed) == 1 or min(np.diff(np.sort(np.ravel(closed)))) > 0.1)
    assert_intervals_complement(mechanism)


# Change points


@pytest.mark.slow
@every("assembly", [1, -1])
@every("name", CHANGE_POINTS)
def test_change_point_results_are_finite_and_warned(name, assembly):
    """Every one of these has its links in line at crank angle 0, where no direction of motion is preferred."""
    _, coupler, rocker, frame = lengths = CHANGE_POINTS[name]
    with pytest.warns(ks.ConditionWarning, match=r"crank angle 0 deg.*about 0 correct digits.*solution\.condition"):
        s = ks.solve(four_bar(lengths, assembly=assembly), np.array([0.0, 0.5]), crank_speed=1.0, loads=ks.Gravity())
    for values in (s.rate("rocker"), s.angular_acceleration("coupler"), s.balancing_torque, s.reaction("O2")):
        assert np.all(np.isfinite(values))
    assert s.condition[0] > 1e15
    assert s.condition[1] < 1e4
    A, B = planar(s.position("A")), planar(s.position("B"))
    assert_allclose(abs(B - A), coupler, rtol=0, atol=1e-15 * max(lengths))
    assert_allclose(abs(B - frame), rocker, rtol=0, atol=1e-15 * max(lengths))


def test_grashof_refuses_other_linkages_and_batches():
    cam_driven = ks.Mechanism(
        "cam-driven four-bar",
        ks.Crank(),
        (ks.CamRoller(ks.cams.Circle(0.3, (0.0, 0.0))), ks.RockerGroup(0.8, 0.6, (0.7, 0.4))),
    )
    for mechanism in (ks.crank_slider(0.1, 0.3), cam_driven):
        with pytest.raises(ks.ParameterError, match=f"for four-bars, not for a {mechanism.name}"):
            grashof(mechanism)
    with pytest.raises(ks.ParameterError, match="one design at a time"):
        grashof(four_bar((np.array([[0.1], [0.2]]), 1.0, 1.0, 1.0)))
