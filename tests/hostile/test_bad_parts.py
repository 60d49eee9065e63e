"""Links, groups and loads with impossible input."""

import re
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.scenes import six_bar
from support.sliders import TURN, crank_slider, solve


@every("bad", [None, 3, "", "two\nlines", b"B", ("B",), object()])
@every(
    "make",
    [
        lambda bad: ks.SliderGroup(1.0, on=bad),
        lambda bad: ks.SliderGroup(1.0, pin=bad),
        lambda bad: ks.RockerGroup(0.4, 0.3, (0.35, 0.1), pivot_name=bad),
        lambda bad: ks.Pin(on=bad, at=(0.1, 0.0)),
        lambda bad: ks.Dyad(0.4, 0.3, ("A", bad)),
        lambda bad: ks.LeverGroup((0.0, -0.3), on=bad),
        lambda bad: ks.CylinderGroup((0.0, -0.3), pivot_name=bad),
        lambda bad: ks.YokeGroup(pin=bad),
        lambda bad: ks.Spring(1.0, 0.0, on=bad),
        lambda bad: ks.ProcessForce(1.0, on=bad),
        lambda bad: ks.Mechanism(bad, ks.Crank(0.1), (ks.SliderGroup(0.5),)),
    ],
)
def test_names_are_texts(make, bad):
    with pytest.raises(ks.ParameterError, match="must be a name, a text of one line"):
        make(bad)


@every("bad", [None, 3.0, "link", {}, ks.Link, ks.Gravity(), (2.0, 0.1, 0.05)])
@every(
    "make",
    [
        lambda bad: ks.Crank(0.1, bad),
        lambda bad: crank_slider(slider=bad),
        lambda bad: ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=bad),
        lambda bad: ks.CamRoller(ks.cams.Circle(0.3), bad),
        lambda bad: ks.Dyad(0.4, 0.3, dyad2=bad),
        lambda bad: ks.slotted_lever(0.1, pivot=(0.0, -0.3), block=bad),
        lambda bad: ks.CylinderGroup((0.0, -0.3), rod=bad),
        lambda bad: ks.scotch_yoke(0.1, block=bad),
    ],
)
def test_links_are_links(make, bad):
    with pytest.raises(ks.ParameterError, match="must be a Link, got"):
        make(bad)


@every("bad", [None, 0.3, "circle", ks.cams.Circle, ks.Link(), {}])
def test_a_cam_is_made_and_has_a_pitch_curve(bad):
    with pytest.raises(ks.ParameterError, match=r"cam must be one of ks\.cams or similar"):
        ks.cam_crank_slider(bad, 2.0)


@every("bad", [0.3, "level", (1.0, 0.0), ks.Guide, None])
def test_a_guide_is_a_guide(bad):
    with pytest.raises(ks.ParameterError, match="guide"):
        ks.SliderGroup(1.0, bad)


@every(
    "given",
    [
        (None, 0.0, (1.0, np.nan)),
        (None, 0.0, (2.0, 0.0)),
        (None, 0.0, 3.0),
        (None,),
        ((1.0, 0.0),),
        (np.nan,),
        ("ab",),
        (0.0, "3"),
    ],
)
def test_a_guide_has_a_direction_and_an_offset(given):
    with pytest.raises(ks.ParameterError, match="guide"):
        ks.Guide(*given)


@every("bad", [5.0, None, "AB", {}, (0.1,), (0.1, 0.2, 0.3), np.ones((2, 2)), np.ones((3, 1)), {0.1, 0.2}])
@every(
    "make",
    [
        lambda bad: ks.RockerGroup(0.4, 0.3, bad),
        lambda bad: ks.Pin("crank", bad),
        lambda bad: ks.slotted_lever(0.1, pivot=bad),
        lambda bad: ks.CylinderGroup(bad),
        lambda bad: ks.cams.Circle(0.3, bad),
        lambda bad: ks.Guide.through(bad, (1.0, 0.0)),
    ],
)
def test_a_point_is_a_pair_of_numbers(make, bad):
    with pytest.raises(
        ks.ParameterError, match=r"must be a (pair \((x, y|along, across)\), got|number or an array of shape)"
    ):
        make(bad)


@every(
    ("bad", "words"),
    [
        (None, "groups must be a tuple"),
        (ks.SliderGroup(0.5), "groups must be a tuple"),
        ("groups", "groups must be a tuple"),
        ({"a": 1}, "groups must be a tuple"),
        ((None,), "must be a group: RockerGroup"),
        ((ks.SliderGroup,), "it is a class, pass an instance of it"),
        ([ks.Link()], "must be a group: RockerGroup"),
        ((crank_slider(),), "must be a group|lacks"),
    ],
)
def test_groups_are_groups(bad, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.Mechanism("m", ks.Crank(0.1), bad)


def test_groups_in_a_list_become_a_tuple():
    assert type(ks.Mechanism("m", ks.Crank(0.1), [ks.SliderGroup(0.5)]).groups) is tuple


ROCKER, LEVER = ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ks.LeverGroup((0.1, 0.2))


@every(
    ("groups", "words"),
    [
        ((ROCKER, ks.SliderGroup(0.5, on="B", label="2")), "SliderGroup adds joint 'B' a second time"),
        ((ks.SliderGroup(0.5, pin="O"),), "adds joint 'O' a second time"),
        ((ks.SliderGroup(0.5, on="Q"),), "is attached to joint 'Q', which no part before it places"),
        ((replace(ROCKER, pivot_name="B"),), "adds joint 'B' a second time"),
        ((ROCKER, ks.SliderGroup(0.5, on="B", pin="B2", label="2")), "adds reaction 'B2' a second time"),
        ((ROCKER, replace(ROCKER, on="B", pin="C", label="2")), "adds joint 'O2' a second time"),
        ((ks.SliderGroup(0.5, pin="guide"),), "adds reaction 'guide' a second time"),
        ((ks.SliderGroup(0.5, pin="slider"),), "adds link 'slider' a second time, after the joint"),
        ((ks.SliderGroup(0.5, pin="guide_force"),), "adds quantity 'guide_force' a second time"),
        ((ks.SliderGroup(0.5, pin="shaking_force"),), "adds reaction 'shaking_force' a second time"),
        ((ks.SliderGroup(0.5, pin="coupler_rate"),), "'coupler_rate' a second time"),
        ((ks.SliderGroup(0.5), ks.SliderGroup(0.5, pin="coupler2", label="2")), "adds link 'coupler2' a second time"),
        ((ks.SliderGroup(0.5), ks.SliderGroup(0.5, pin="C")), "adds link 'coupler' a second time"),
        ((ks.Dyad(0.4, 0.3, ("A", "O"), "dyad1_A"),), "adds reaction 'dyad1_A' a second time"),
        ((ks.YokeGroup(pin="A"),), "adds joint 'A' a second time"),
        ((LEVER, ks.YokeGroup()), "adds link 'block' a second time"),
        ((LEVER, ks.YokeGroup(label="2"), ks.YokeGroup(pin="C", label="2")), "'slider2' a second"),
        ((replace(LEVER, pivot_name="slot_force"),), "adds quantity 'slot_force' a second time"),
        ((ks.CylinderGroup((0.1, 0.2), pivot_name="O"),), "adds joint 'O' a second time"),
        ((ks.Pin("crank", (0.1, 0.0), "A"),), "adds joint 'A' a second time"),
        ((ks.Pin("crank", (0.1, 0.0), "crank"),), "'crank' a second time"),
    ],
)
def test_names_given_twice_are_refused(groups, words):
    with pytest.raises(ks.ParameterError, match=re.escape(words)):
        ks.Mechanism("chain", ks.Crank(0.1), groups)


# What cannot be solved, at what are no crank angles, under what are no loads


@every("bad", [None, 3.0, "m", {}, ks.Mechanism, ks.Crank(0.1)])
def test_solve_wants_a_mechanism(bad):
    with pytest.raises(ks.ParameterError, match="mechanism must be a Mechanism"):
        ks.solve(bad, TURN, crank_speed=1.0)


@pytest.mark.slow_start
def test_a_variant_of_a_case_is_solved_by_itself():
    case = ks.load_case("sawframe_2r63")
    for whole in (case, *case.variants.values()):
        with pytest.raises(ks.ParameterError, match=r"call its \.solve\(angles\)"):
            ks.solve(whole, TURN, crank_speed=1.0)


@every("bad", [None, 9.81, "gravity", {}, ks.Gravity, ks.Spring, (g for g in ()), object(), ks.Link()])
@every("wrapped", [False, True])
def test_loads_are_loads(bad, wrapped):
    with pytest.raises(ks.ParameterError, match=r"loads must be Gravity, Spring, .* or TorsionDamper, got"):
        solve(loads=[bad] if wrapped else bad)


@every("angles", [[], (), np.empty(0), np.empty((3, 0)), "0.1", ["0.1", "0.2"], [True, False], [None], {}])
def test_angles_are_angles(angles):
    with pytest.raises(ks.ParameterError, match=r"crank_angle|no crank angles"):
        solve(crank_angle=angles)


THREE, TWO = np.array([[1.0], [1.1], [1.2]]), np.array([[1.0], [1.1]])


@every(
    "make",
    [
        lambda: ks.Link(TWO, THREE),
        lambda: ks.cams.Circle(TWO, (0.01 * THREE, 0.0)),
        lambda: ks.cams.CosineLaw(TWO, 5.0 * THREE),
        lambda: ks.RockerGroup(TWO, THREE, (1.0, 0.0)),
        lambda: solve(crank_slider(coupler_length=TWO, slider=ks.Link(THREE))),
        lambda: solve(crank_slider(coupler_length=TWO), crank_speed=THREE),
        lambda: solve(crank_slider(coupler_length=TWO), THREE + TURN),
        lambda: solve(crank_slider(coupler_length=TWO), loads=[ks.Gravity(THREE)]),
        lambda: solve(crank_slider(coupler_length=TWO), loads=[ks.ProcessForce(THREE)]),
        lambda: solve(loads=[ks.ProcessForce(np.ones(71))]),
        lambda: solve(crank_speed=np.ones(71)),
        lambda: solve(loads=[ks.Gravity(TWO), ks.Spring(THREE, 0.1)]),
    ],
)
def test_batches_of_unequal_length_do_not_fit_together(make):
    with pytest.raises(ks.ParameterError, match=r"these shapes do not fit together: .*\("):
        make()


# Bad loads


PLACES = {
    "number": 3.0,
    "nothing": (),
    "one number": (1.0,),
    "three numbers": (1.0, 2.0, 3.0),
    "two names": ("A", "B"),
    "four": ("coupler", 1.0, 2.0, 3.0),
    "name last": (1.0, "coupler"),
    "empty": "",
    "lines": "A\nB",
    "none": None,
    "bytes": b"B",
}


@every("what", PLACES)
def test_wrong_points_name_the_allowed_forms(what):
    for make in (lambda at: ks.Force(1.0, at=at), lambda at: ks.PointForce(1.0, between=("A", at))):
        with pytest.raises(ks.ParameterError, match=r"(at|between 2) must be a"):
            make(PLACES[what])


@every("what", ["AB", ("A",), ("A", "B", "C"), None, 3.0, {"A": "B"}])
def test_what_is_no_pair_of_points_is_refused(what):
    with pytest.raises(ks.ParameterError, match="between must be a pair of points"):
        ks.PointDamper(1.0, between=what)


MISPLACED = {
    "joint": (lambda: ks.Force(1.0, at="b"), r"Force: at is 'b', allowed: 'O', 'A', 'B', 'O2', 'C'"),
    "link as joint": (lambda: ks.Force(1.0, at="coupler"), r'name a place on it, \("coupler", along, across\)'),
    "link of a place": (lambda: ks.Force(1.0, at=("cupler", 0.1)), "did you mean 'coupler'"),
    "axis": (lambda: ks.Force(1.0, at="B", along="slider"), "Force: along is 'slider', allowed: .*'slider2'"),
    "torque": (lambda: ks.Torque(1.0, on="B"), "Torque: on is 'B', allowed: 'crank'"),
    "torque against": (lambda: ks.Torque(1.0, on="crank", against="x"), "against is 'x', allowed: .*'frame'"),
    "torque on itself": (lambda: ks.Torque(1.0, on="crank", against="crank"), "against the same link"),
    "spring": (lambda: ks.TorsionSpring(1.0, on="rocker2"), "did you mean 'rocker'"),
    "damper": (lambda: ks.TorsionDamper(1.0, on="rocker", against="rocker"), "against the same link"),
    "point": (lambda: ks.PointSpring(1.0, between=("B", "D")), "PointSpring: between 2 is 'D'"),
    "one link": (lambda: ks.PointForce(1.0, between=("B", ("rocker", 0.1))), "both points are of the rocker"),
    "frame": (lambda: ks.PointDamper(1.0, between=((0.0, 0.1), (1.0, 1.0))), "both points are fixed to the frame"),
    "slider": (lambda: ks.Spring(1.0, 0.0, cubic=3.0), "Spring: on is 'slider', allowed: 'slider2'"),
    "a class": (lambda: ks.Torque, "loads must be Gravity, Spring"),
}


@every("what", MISPLACED)
def test_a_load_on_what_is_not_there_names_what_is(what):
    make, words = MISPLACED[what]
    with pytest.raises(ks.ParameterError, match=words):
        ks.Scene(six_bar(), 1.0, 0.0, make())


def test_all_loads_that_are_wrong_are_told_at_once():
    with pytest.raises(ks.ParameterError, match=r"at is 'X'.*on is 'Y'"):
        ks.Scene(six_bar(), 1.0, 0.0, [ks.Force(1.0, at="X"), ks.Torque(1.0, on="Y")])


FORCES = {
    "reaction": lambda motion: motion.reaction("O")[0],
    "torque": lambda motion: motion.balancing_torque,
    "power": lambda motion: motion.balancing_torque_by_power,
    "inertia": lambda motion: motion.inertia_force("rocker")[0],
}


@pytest.mark.slow
@every("what", FORCES)
@every("kind", ["Force", "Torque", "ProcessForce"])
def test_load_reading_a_force_learns_what_it_may_read(kind, what):
    item = {
        "Force": lambda: ks.Force(FORCES[what], at="B"),
        "Torque": lambda: ks.Torque(FORCES[what], on="rocker"),
        "ProcessForce": lambda: ks.ProcessForce(FORCES[what], "slider2"),
    }[kind]()
    with pytest.raises(ks.ParameterError, match=r"which is missing, .* it may use crank_angle, .*velocity"):
        _ = ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=item).balancing_torque


TABLES = {
    "over": (lambda: ks.Table([0, 1], [0, 1], over="time"), "over is 'time', allowed: 'angle', 'travel'"),
    "lengths": (lambda: ks.Table([0, 1, 2], [0, 1], over="travel"), "of one length"),
    "back": (lambda: ks.Table([0, 1, 2], [0, 1, 2], back=[0, 1, 2]), "back is for a table over"),
    "back of another length": (lambda: ks.Table([0, 1], [0, 1], over="travel", back=[0]), "of one length"),
    "period": (lambda: ks.Table([0, 1, 2], [0, 1, 2], period=3.0), "2 pi or a whole multiple"),
    "huge period": (lambda: ks.Table([0, 1, 2], [0, 1, 2], period=10**400), "2 pi or a whole multiple"),
    "period of travel": (lambda: ks.Table([0, 1], [0, 1], over="travel", period=4 * np.pi), "one turn"),
    "nan": (lambda: ks.Table([0, np.nan, 2], [0, 1, 2]), "x must be finite"),
    "text": (lambda: ks.Table("abc", [0, 1, 2]), "x must be"),
    "slider": (lambda: ks.Table([0, 2, 4], [0, 1, 2], slider="slider"), "slider is for a table"),
    "to and fro": (lambda: ks.Table([0, 1, 0.5], [0, 1, 2], over="travel"), "travel must rise"),
    "one row": (lambda: ks.Table([0], [0], over="travel"), "at least 2 rows"),
    "no rows": (lambda: ks.Table([], []), "which is empty"),
}


@every("what", TABLES)
def test_bad_tables_are_refused(what):
    make, words = TABLES[what]
    with pytest.raises(ks.ParameterError, match=words):
        make()


def test_arrays_over_other_angles_are_refused():
    with pytest.raises(ks.ParameterError, match="do not fit"):
        ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(np.ones(7), on="rocker"))
    s = ks.solve(six_bar(), [0.1, 0.2], crank_speed=1.0, loads=ks.Torque(np.ones(2), on="rocker"))
    with pytest.raises(ks.ParameterError, match="Torque is a table over the given crank angles"):
        s.at(0.3)


@pytest.mark.parametrize("angles", [[0.1], [0.1, 0.2], np.linspace(0.0, 6.0, 50)], ids=len)
def test_single_value_array_is_a_constant(angles):
    one, plain = (
        ks.solve(six_bar(), angles, crank_speed=1.0, loads=ks.Torque(value, on="rocker"))
        for value in (np.array([3.0]), 3.0)
    )
    assert np.array_equal(one.balancing_torque, plain.balancing_torque)
    assert np.array_equal(one.reaction("O"), plain.reaction("O"))
