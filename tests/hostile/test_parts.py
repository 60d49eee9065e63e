"""Parts that are none, and names given twice, in every constructor that takes them: one error each."""

import re
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
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
    with pytest.raises(ks.ParameterError, match=r"cam must be one of ks\.cams or alike"):
        ks.cam_crank_slider(bad, 2.0)


@pytest.mark.parametrize(
    "bad",
    [
        0.3,
        "level",
        (1.0, 0.0),
        ks.Guide,
        None,
    ],
)
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
    with pytest.raises(ks.ParameterError):
        make(bad)


@every(
    ("bad", "words"),
    [
        (None, "groups must be a tuple"),
        (ks.SliderGroup(0.5), "groups must be a tuple"),
        ("groups", "groups must be a tuple"),
        ({"a": 1}, "groups must be a tuple"),
        ((None,), "must be a group: RockerGroup"),
        ((ks.SliderGroup,), "it is a class, make one of it"),
        ([ks.Link()], "must be a group: RockerGroup"),
        ((crank_slider(),), "must be a group|lacks"),
    ],
)
def test_groups_are_groups(bad, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.Mechanism("m", ks.Crank(0.1), bad)


def test_groups_in_a_list_become_a_tuple():
    assert type(ks.Mechanism("m", ks.Crank(0.1), [ks.SliderGroup(0.5)]).groups) is tuple


ROCKER = ks.RockerGroup(0.4, 0.3, (0.35, 0.1))


@every(
    ("groups", "words"),
    [
        ((ROCKER, ks.SliderGroup(0.5, on="B", label="2")), "SliderGroup adds joint 'B' a second time"),
        ((ks.SliderGroup(0.5, pin="O"),), "adds joint 'O' a second time"),
        ((ks.SliderGroup(0.5, pin="A"),), "adds joint 'A' a second time"),
        ((ks.SliderGroup(0.5, on="Q"),), "hangs on joint 'Q', which no part before it places"),
        ((replace(ROCKER, pivot_name="A"),), "adds joint 'A' a second time"),
        ((replace(ROCKER, pivot_name="B"),), "adds joint 'B' a second time"),
        ((replace(ROCKER, pivot_name="O"),), "adds joint 'O' a second time"),
        ((ROCKER, ks.SliderGroup(0.5, on="B", pin="B2", label="2")), "adds reaction 'B2' a second time"),
        ((ROCKER, replace(ROCKER, on="B", pin="C", label="2")), "adds joint 'O2' a second time"),
        ((ks.SliderGroup(0.5, pin="guide"),), "adds reaction 'guide' a second time"),
        ((ks.SliderGroup(0.5, pin="slider"),), "adds link 'slider' a second time, after the joint"),
        ((ks.SliderGroup(0.5, pin="guide_force"),), "adds quantity 'guide_force' a second time"),
        ((ks.SliderGroup(0.5, pin="shaking_force"),), "adds reaction 'shaking_force' a second time"),
        ((ks.SliderGroup(0.5, pin="closure"),), "adds reaction 'closure' a second time"),
        ((ks.SliderGroup(0.5, pin="coupler_rate"),), "'coupler_rate' a second time"),
        ((ks.SliderGroup(0.5), ks.SliderGroup(0.5, pin="coupler2", label="2")), "adds link 'coupler2' a second time"),
        ((ks.SliderGroup(0.5), ks.SliderGroup(0.5, pin="C")), "adds link 'coupler' a second time"),
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
        with pytest.raises(ks.ParameterError, match=r"it is solved by its own \.solve\(angles\)"):
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
