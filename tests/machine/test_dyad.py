"""Dyads between moving joints: the equations of all bodies, both assemblies, limits, and what is refused."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import AssemblyError, ConditionWarning, ParameterError
from support.chains import errors_beside_full_systems
from support.every import every
from support.machines import planar

ANGLES = np.linspace(0.1, 6.2, 7)
ROD, ARM = ks.Link(2.0, (0.2, 0.03), 0.05), ks.Link(3.0, (0.02, -0.04), 0.1)


def watt(assembly=1, lengths=(0.5, 0.45), **names):
    """Watt I: two pins of a four-bar, on rocker and coupler, joined by a dyad."""
    parts = (
        ks.RockerGroup(0.4, 0.3, (0.35, 0.1), coupler=ROD, rocker=ARM),
        ks.Pin(on="coupler", at=(0.2, 0.15), name="C"),
        ks.Pin(on="rocker", at=(0.1, -0.2), name="E"),
        ks.Dyad(*lengths, ("C", "E"), "D", assembly, ROD, ARM, **names),
    )
    return ks.Mechanism("Watt I", ks.Crank(0.1, ARM), parts)


def solve(made, angles=ANGLES, **options):
    return ks.solve(made, angles, crank_speed=1.0, **options)


@pytest.mark.slow
@every("assembly", [1, -1])
def test_motion_and_forces_satisfy_the_full_system(assembly):
    s = solve(watt(assembly), loads=[ks.Gravity()])
    for row in (0, 2, 5):
        errors = errors_beside_full_systems(s, row)
        assert {what: error for what, error in errors.items() if not error < 1e-14} == {}, row


@every("assembly", [1, -1])
def test_pin_lies_on_the_chosen_side(assembly):
    s = solve(watt(assembly))
    first, second, pin = (planar(s.position(name)) for name in ("C", "E", "D"))
    assert np.all(assembly * ((second - first).conjugate() * (pin - first)).imag > 0.0)
    assert np.max(np.abs(np.abs(pin - first) - 0.5)) < 1e-15
    assert np.max(np.abs(np.abs(pin - second) - 0.45)) < 1e-15


def test_swapped_ends_are_the_same_dyad():
    loads = [ks.Gravity()]
    there = solve(watt(1), loads=loads)
    parts = (*watt().groups[:-1], ks.Dyad(0.45, 0.5, ("E", "C"), "D", -1, ARM, ROD))
    back = solve(ks.Mechanism("Watt I", ks.Crank(0.1, ARM), parts), loads=loads)
    for name, same in {"dyad1_C": "dyad2_C", "dyad2_E": "dyad1_E", "O": "O"}.items():
        error = np.max(np.abs(there.reaction(name) - back.reaction(same)))
        assert error < 1e-14 * np.max(np.abs(there.reaction(name)))
    assert np.max(np.abs(there.reaction("D") + back.reaction("D"))) < 1e-14 * np.max(np.abs(there.reaction("D")))


def test_massless_neighbours_leave_the_pin_force():
    """Massless links bear forces along themselves only, and a slider on the pin bears their sum."""
    parts = (*watt().groups[:3], ks.Dyad(0.5, 0.45, ("C", "E")), ks.YokeGroup(on="D", pin="F", slider=ARM, label="2"))
    s = solve(ks.Mechanism("yoke on a dyad", ks.Crank(0.1), parts))
    for name, link in (("dyad1_C", "dyad1"), ("D", "dyad1")):
        along = np.array(s.placement.links[link].direction)
        across = along[0] * s.reaction(name)[1] - along[1] * s.reaction(name)[0]
        assert np.max(np.abs(across)) < 1e-14 * np.max(np.abs(s.reaction(name)))


# Where it does not close


def test_distant_joints_are_refused_with_intervals():
    with pytest.raises(AssemblyError) as refused:
        solve(watt(lengths=(0.3, 0.2)), np.linspace(0.0, 6.28, 60))
    words = str(refused.value)
    assert "the distance from C to E" in words
    assert "the lengths of dyad1 and dyad2, 0.1 and 0.5 m" in words
    assert "does not close for crank angles" in words
    low, high = refused.value.intervals[0]
    ends = solve(watt(), np.array([low, high]) % (2 * np.pi))
    reach = np.abs(planar(ends.position("C") - ends.position("E")))
    for distance in reach:
        assert min(abs(distance - 0.1), abs(distance - 0.5)) < 1e-9


def test_a_gap_is_nan_and_the_rest_exact():
    angles = np.linspace(0.0, 6.28, 60)
    s = solve(watt(lengths=(0.3, 0.2)), angles, on_gap="nan")
    open_there = np.isnan(s.reaction("D")[0])
    assert 0 < open_there.sum() < angles.size
    assert np.array_equal(open_there, s.closure[-1] < 0.0)
    assert not np.isnan(s.position("C")).any()


def test_dyad_near_its_limit_warns():
    reach = float(np.abs(planar(np.subtract(*(solve(watt(), 0.3).position(name) for name in ("C", "E"))))))
    made = watt(lengths=(0.3, reach - 0.3 + 1e-15))
    with pytest.warns(ConditionWarning, match="near a limit position"):
        s = solve(made, 0.3)
    assert s.condition > 1e8


# What is refused


@every(
    "fields, words",
    [
        ({"length1": -0.1}, "length1 must be greater than 0"),
        ({"length2": 0.0}, "length2 must be greater than 0"),
        ({"length1": np.nan}, "length1 must be finite"),
        ({"length1": "0.1"}, "length1 must be a number"),
        ({"on": "B"}, "on must be the names of two joints, got 'B'"),
        ({"on": ("B",)}, "on must be the names of two joints"),
        ({"on": ("B", "B")}, "on must name two different joints, got 'B' twice"),
        ({"on": ("B", 3)}, "on 2 must be a name"),
        ({"on": ("B", "")}, "on 2 must be a name"),
        ({"assembly": 0}, r"assembly must be \+1 or -1"),
        ({"dyad1": 2.0}, "dyad1 must be a Link"),
        ({"pin": "two\nlines"}, "pin must be a name"),
    ],
)
def test_what_no_dyad_can_have_is_refused(fields, words):
    with pytest.raises(ParameterError, match=f"dyad: {words}"):
        ks.Dyad(**{"length1": 0.4, "length2": 0.3} | fields)


def test_a_joint_that_no_part_places_is_named():
    with pytest.raises(ParameterError, match="Dyad is attached to joint 'X', which no part before it places"):
        ks.Mechanism("chain", ks.Crank(0.1), (ks.Dyad(0.4, 0.3, ("A", "X")),))


def test_a_second_dyad_needs_names_of_its_own():
    with pytest.raises(ParameterError, match=r"adds joint 'D' a second time.*adds link 'dyad1' a second time"):
        ks.Mechanism("chain", ks.Crank(0.1), (*watt().groups, ks.Dyad(0.5, 0.4, ("A", "E"))))
