"""Values no machine can have, in every field of every constructor and in solve: one error each that names the field."""

import datetime as dt
import re
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

TURN = 2 * np.pi * np.arange(72) / 72
LINK = ks.Link(2.0, (0.1, 0.02), 0.05)


def crank_slider(**changes):
    return ks.crank_slider(**{"crank_length": 0.3, "coupler_length": 1.1, "coupler": LINK} | changes)


def solve(mechanism=None, crank_angle=TURN, **changes):
    return ks.solve(mechanism or crank_slider(), crank_angle, **{"crank_speed": 2.0} | changes)


CONSTRUCTORS = {
    "Link": (ks.Link, {"mass": 2.0, "centre": 0.1, "inertia": 0.05}),
    "Gravity": (ks.Gravity, {"acceleration": 9.81, "direction": -1.5}),
    "Spring": (ks.Spring, {"stiffness": 1e3, "free_position": 0.8}),
    "Spring.balancing": (ks.Spring.balancing, {"mass": 2.0, "crank_speed": 3.0, "free_position": 1.0}),
    "ProcessForce": (ks.ProcessForce, {"force": 30.0}),
    "Crank": (ks.Crank, {"length": 0.3}),
    "SliderGroup": (ks.SliderGroup, {"coupler_length": 1.1}),
    "RockerGroup": (ks.RockerGroup, {"coupler_length": 0.4, "rocker_length": 0.3, "pivot": (0.35, 0.1)}),
    "Pin": (partial(ks.Pin, "crank"), {"at": (0.1, 0.05)}),
    "Dyad": (ks.Dyad, {"length1": 0.4, "length2": 0.3}),
    "LeverGroup": (ks.LeverGroup, {"pivot": (0.35, 0.1), "offset": 0.02}),
    "CylinderGroup": (ks.CylinderGroup, {"pivot": (0.35, 0.1)}),
    "YokeGroup": (ks.YokeGroup, {"slot_angle": 1.3}),
    "Guide.at": (ks.Guide.at, {"guide_angle": 0.3, "guide_offset": 0.1}),
    "Guide.through": (ks.Guide.through, {"W1": (0.0, 0.1), "W2": (1.0, 0.2)}),
    "Circle": (ks.cams.Circle, {"radius": 0.3, "centre": (0.05, 0.0)}),
    "CosineLaw": (ks.cams.CosineLaw, {"amplitude": 0.3, "mean": 2.0, "guide_angle": 0.0}),
    "solve": (solve, {"crank_angle": TURN, "crank_speed": 2.0, "crank_acceleration": 1.0}),
}
TABLES = {("ProcessForce", "force"), *(("solve", name) for name in CONSTRUCTORS["solve"][1])}
"""Fields with a value for each crank angle."""


class Quantity:
    """A quantity as pint's are."""

    units, magnitude, shape = "gram", 300.0, ()


class Labelled:
    """A column as pandas' are."""

    shape = (72, 2)

    def to_numpy(self):
        """All numbers."""
        return np.ones(self.shape)


BAD = {
    "NaN": (float("nan"), "finite"),
    "infinity": (np.inf, "finite"),
    "NaN in NumPy": (np.float64("nan"), "finite"),
    "NaN in a batch": (np.array([[1.0], [np.nan]]), "finite"),
    "text": ("2,1", "a text; write a plain number in SI units"),
    "bytes": (b"2.1", "a text"),
    "array of texts": (np.array([["0.3"]]), "of <U3"),
    "truth": (True, "a truth value"),
    "truth in NumPy": (np.True_, "a truth value"),
    "truths": (np.array([[True]]), "of bool"),
    "complex": (1.0 + 1e-30j, "a complex number"),
    "complex batch": (np.array([[1.0 + 0j], [2.0]]), "of complex128"),
    "0-d complex": (np.array(1j), "a complex number"),
    "datetime": (dt.datetime(2026, 1, 1), "a time"),
    "timedelta": (dt.timedelta(1), "a time"),
    "NumPy's datetime": (np.datetime64("2026-01-01"), "no number"),
    "0-d datetime": (np.array("2026-01-01", dtype="M8[D]"), "no number"),
    "dictionary": ({"value": 2.0}, "no number"),
    "set": ({2.0}, "no number"),
    "object": (object(), "no number"),
    "class": (float, "no number"),
    "quantity": (Quantity(), "a quantity with its unit; give the plain number in SI units, as by .to("),
    "objects that are none": (np.array([[1.0], [None]]), "with no number"),
    "text in objects": (np.array([[1.0], ["2"]], dtype=object), "with a text"),
    "labelled table": (Labelled(), "a labelled table; give its numbers"),
    "masked": (np.ma.array([[1.0], [2.0]], mask=[[0], [1]]), "a masked array"),
    "huge integer": (10**400, "too large"),
    "huge fraction": (Fraction(10**400, 3), "too large"),
    "1e200": (1e200, "to be computed in double precision"),
    "nothing in a batch": (np.empty((0, 1)), "holds nothing"),
    "one value for each angle": (np.ones((1, 72)), "its last axis would be the crank angle"),
    "row": (np.ones(72), "its last axis would be the crank angle"),
    "square": (np.ones((2, 2)), "its last axis would be the crank angle"),
    "list": ([1.0, 2.0, 3.0], "got [1.0, 2.0, 3.0]"),
    "ragged list": ([[1.0, 2.0], [3.0]], "got [[1.0, 2.0], [3.0]]"),
}
SHAPES = {"one value for each angle", "row", "square", "list"}
"""What a table may be, or has its own test."""
NAMES = {"crank_angle": "crank"} | {f"{link}length": f"{link[:-1]} length" for link in ("coupler_", "rocker_")}
PAIRS = {"centre", "pivot", "at", "W1", "W2"}


def made(kind, **changes):
    make, fields = CONSTRUCTORS[kind]
    return make(**fields | changes)


FIELDS = [(kind, field) for kind, (_, fields) in CONSTRUCTORS.items() for field in fields]


def possible(kind, field, bad):
    """Whether it is right in the end: a table may have a shape, and a force be a function."""
    return (kind, field) in TABLES and (bad in SHAPES or (kind == "ProcessForce" and callable(BAD[bad][0])))


@every("kind, field, bad", [(*at, bad) for at in FIELDS for bad in BAD if not possible(*at, bad)])
def test_every_field_refuses_what_is_no_number_of_it(kind, field, bad):
    """With the name of the field, and what is wrong; a pair is told by its name alone."""
    value, words = BAD[bad]
    with pytest.raises(ks.ParameterError) as caught:
        made(kind, **{field: value})
    text = str(caught.value)
    assert NAMES.get(field, field) in text
    assert field in PAIRS or words in text or "no crank angles" in text
    assert len(text) < 600


LENGTHS = [
    ("Crank", "length"),
    ("SliderGroup", "coupler_length"),
    ("RockerGroup", "coupler_length"),
    ("RockerGroup", "rocker_length"),
    ("Dyad", "length1"),
    ("Dyad", "length2"),
    ("Circle", "radius"),
    ("CosineLaw", "amplitude"),
    ("CosineLaw", "mean"),
]
SIZES = [("Link", "mass"), ("Link", "inertia"), ("Gravity", "acceleration"), ("Spring", "stiffness")]


@every("value", [0, -0.0, -0.3, np.int16(-1), np.array([[1.0], [-1.0]]), 1e-200, 1e90])
@every(("kind", "field"), LENGTHS, ids=map(".".join, LENGTHS))
def test_lengths_must_be_greater_than_zero_and_computable(kind, field, value):
    with pytest.raises(ks.ParameterError, match=r"must be greater than 0|in double precision"):
        made(kind, **{field: value})


@every("value", [-1e-300, -5e-324, -1, np.float32(-2), Decimal("-0.1")])
@every(("kind", "field"), SIZES, ids=map(".".join, SIZES))
def test_sizes_must_not_be_negative(kind, field, value):
    with pytest.raises(ks.ParameterError, match=f"{field} must be at least 0, got -"):
        made(kind, **{field: value})


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


@every("bad", [0, 2, -1.5, True, "+1", None, np.array([1, -1]), "open up", [1]])
@every(
    "make",
    [
        lambda bad: ks.SliderGroup(1.0, assembly=bad),
        lambda bad: ks.RockerGroup(0.4, 0.3, (0.35, 0.1), assembly=bad),
        lambda bad: ks.Dyad(0.4, 0.3, assembly=bad),
    ],
)
def test_assembly_is_a_sign(make, bad):
    with pytest.raises(ks.ParameterError, match=r"assembly must be \+1 or -1"):
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


# solve


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


# What passes, as what it is


@every(
    "value",
    [
        2,
        2.0,
        np.int16(2),
        np.uint8(2),
        np.float32(2),
        np.float64(2),
        np.array(2.0),
        np.array([2]),
        Fraction(2),
        Decimal(2),
    ],
    ids=lambda value: type(value).__name__ + str(np.shape(value)),
)
@every(("kind", "field"), [case for case in FIELDS if case[1] not in PAIRS and case[0] != "solve"])
def test_any_real_number_becomes_a_float(kind, field, value):
    if "Circle" in kind or (kind, field) == ("CosineLaw", "amplitude"):
        value = value / type(value)(16) if isinstance(value, Fraction | Decimal) else value / 16.0
    thing = made(kind, **{field: value})
    numbers = vars(thing) if hasattr(thing, "__dict__") else thing._asdict()
    found = np.array([part for part in numbers.values() if isinstance(part, float | np.ndarray)], dtype=object)
    assert all(type(part) is float for part in found) or (kind, field) in TABLES
    assert float(np.ravel(value)[0]) in found or "balancing" in kind or field == "guide_angle"


def test_small_integers_do_not_overflow():
    """300 squared is more than 16 bits hold."""
    small = ks.crank_slider(np.int16(300), np.int16(900), slider=ks.Link(np.int8(100)))
    plain = ks.crank_slider(300.0, 900.0, slider=ks.Link(100.0))
    found, expected = (
        solve(m, crank_speed=speed).balancing_torque for m, speed in ((small, np.int16(300)), (plain, 300.0))
    )
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("angles", [np.array(TURN, dtype=object), list(TURN), tuple(map(Fraction, TURN.tolist()))])
def test_angles_of_plain_numbers_in_another_guise_are_floats(angles):
    s = solve(crank_angle=angles)
    assert s.crank_angle.dtype == float
    assert np.array_equal(s.balancing_torque, solve().balancing_torque)


@pytest.mark.slow_start
def test_columns_of_pandas_are_refused_with_the_remedy():
    import pandas as pd

    for make, words in [
        (lambda: ks.Link(pd.Series([1.0, 2.0])), r"mass .*\.to_numpy\(\)\[:, None\]"),
        (lambda: crank_slider(coupler_length=pd.Series(np.ones(72))), r"coupler length .*\.to_numpy\(\)"),
    ]:
        with pytest.raises(ks.ParameterError, match=words):
            make()
    column = pd.Series(2.0 + np.sin(TURN), index=TURN)
    s = solve(crank_speed=column, loads=ks.ProcessForce(column))
    assert np.array_equal(
        s.balancing_torque, solve(crank_speed=column.to_numpy(), loads=ks.ProcessForce(s.crank_speed)).balancing_torque
    )


# Names in chains


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
