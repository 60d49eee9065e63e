"""Values and names that are no such thing."""

import dataclasses
import random
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.group import BEARINGS, GROUND, RESERVED, ROCKING
from kinetostatics.mechanics.quantities import of_mechanism
from support.every import every
from support.no_numbers import BAD
from support.sliders import TURN, crank_slider, solve

CONSTRUCTORS = {
    "Link": (ks.Link, {"mass": 2.0, "centre": 0.1, "inertia": 0.05}),
    "Gravity": (ks.Gravity, {"acceleration": 9.81, "direction": -1.5}),
    "Spring": (ks.Spring, {"stiffness": 1e3, "free_position": 0.8, "cubic": 30.0, "mass": 2.0}),
    "Spring.balancing": (
        ks.Spring.balancing,
        {"mass": 2.0, "crank_speed": 3.0, "free_position": 1.0, "spring_mass": 0.5},
    ),
    "GasSpring": (
        ks.GasSpring,
        {"area": 2e-3, "volume": 4e-4, "pressure": 4e5, "at": 0.3, "exponent": 1.3, "ambient": 1e5},
    ),
    "BalanceShaft": (
        ks.BalanceShaft,
        {"unbalance": 0.1, "phase": 0.4, "at": (0.1, 0.2), "inertia": 0.01, "mass": 2.0, "plane": 0.3},
    ),
    "ProcessForce": (ks.ProcessForce, {"force": 30.0}),
    "Force": (partial(ks.Force, at="B"), {"value": 30.0, "direction": 0.4}),
    "Force at a place": (lambda along: ks.Force(1.0, at=("coupler", along)), {"along": 0.1}),
    "Torque": (partial(ks.Torque, on="crank"), {"value": 30.0}),
    "PointForce": (partial(ks.PointForce, between=("A", "B")), {"value": 30.0}),
    "PointSpring": (partial(ks.PointSpring, between=("A", "O2")), {"stiffness": 1e3, "free_length": 0.2}),
    "PointDamper": (partial(ks.PointDamper, between=("A", "O2")), {"coefficient": 20.0}),
    "TorsionSpring": (partial(ks.TorsionSpring, on="rocker"), {"stiffness": 1e3, "free_angle": 0.2, "moment": 5.0}),
    "TorsionDamper": (partial(ks.TorsionDamper, on="rocker"), {"coefficient": 20.0}),
    "PinFriction": (ks.PinFriction, {"mu": 0.1, "radius": 0.02}),
    "GuideFriction": (ks.GuideFriction, {"mu": 0.1, "half_length": 0.04}),
    "SlotFriction": (ks.SlotFriction, {"mu": 0.1, "half_length": 0.04}),
    "RollerFriction": (ks.RollerFriction, {"mu": 0.1, "pin_radius": 0.01, "roller_radius": 4.0, "rolling_arm": 1e-3}),
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
FUNCTIONS = {("ProcessForce", "force"), ("Force", "value"), ("Torque", "value"), ("PointForce", "value")}
"""Fields that may be a function of the motion."""
TABLES = FUNCTIONS | {("solve", name) for name in CONSTRUCTORS["solve"][1]}
"""Fields with a value for each crank angle."""
SHAPES = {"one value for each angle", "row", "square", "list"}
"""What a table may be, or has its own test."""
NAMES = {"crank_angle": "crank"} | {f"{link}length": f"{link[:-1]} length" for link in ("coupler_", "rocker_")}
NAMES["along"] = "at"
PAIRS = {"centre", "pivot", "at", "W1", "W2", "along"}


def made(kind, **changes):
    make, fields = CONSTRUCTORS[kind]
    return make(**fields | changes)


FIELDS = [(kind, field) for kind, (_, fields) in CONSTRUCTORS.items() for field in fields]


def possible(kind, field, bad):
    """Whether it is right in the end: a table may have a shape, and a force be a function."""
    return ((kind, field) in TABLES and bad in SHAPES) or ((kind, field) in FUNCTIONS and callable(BAD[bad][0]))


@pytest.mark.slow
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
    ("PinFriction", "radius"),
    ("GuideFriction", "half_length"),
    ("RollerFriction", "pin_radius"),
    ("RollerFriction", "roller_radius"),
]
SIZES = [
    *(("Link", "mass"), ("Link", "inertia"), ("Gravity", "acceleration"), ("Spring", "stiffness")),
    *(("PointSpring", "stiffness"), ("PointSpring", "free_length"), ("PointDamper", "coefficient")),
    *(("TorsionSpring", "stiffness"), ("TorsionDamper", "coefficient")),
    *(("BalanceShaft", name) for name in ("unbalance", "inertia", "mass")),
    ("RollerFriction", "rolling_arm"),
    *((kind, "mu") for kind in CONSTRUCTORS if kind.endswith("Friction")),
]


@every("value", [0, -0.0, -0.3, np.int16(-1), np.array([[1.0], [-1.0]]), 1e-200, 1e90])
@every(("kind", "field"), LENGTHS, ids=map(".".join, LENGTHS))
def test_lengths_must_be_positive_and_computable(kind, field, value):
    with pytest.raises(ks.ParameterError, match=r"must be greater than 0|in double precision"):
        made(kind, **{field: value})


@every("value", [-1e-300, -5e-324, -1, np.float32(-2), Decimal("-0.1")])
@every(("kind", "field"), SIZES, ids=map(".".join, SIZES))
def test_sizes_must_not_be_negative(kind, field, value):
    with pytest.raises(ks.ParameterError, match=f"{field} must be at least 0, got -"):
        made(kind, **{field: value})


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


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_small_integers_do_not_overflow():
    """300 squared is more than 16 bits hold."""
    small = ks.crank_slider(np.int16(300), np.int16(900), slider=ks.Link(np.int8(100)))
    plain = ks.crank_slider(300.0, 900.0, slider=ks.Link(100.0))
    found, expected = (
        solve(m, crank_speed=speed).balancing_torque for m, speed in ((small, np.int16(300)), (plain, 300.0))
    )
    assert np.array_equal(found, expected)


@pytest.mark.parametrize("angles", [np.array(TURN, dtype=object), list(TURN), tuple(map(Fraction, TURN.tolist()))])
def test_angles_of_any_plain_type_are_floats(angles):
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

WORDS = (
    *(
        "A",
        "A2",
        "B",
        "B2",
        "C",
        "D",
        "O",
        "O2",
        "P",
        "guide",
        "guide2",
        "dyad1_A",
        "dyad12_A",
        "dyad1_B",
        "slot_force",
    ),
    *("cylinder_force2", "block_position", "crank", "crank_rate", "slider2_rate", "shaking_force", "frame"),
)
LABELS = ("", "2", "_B", "2_B", "_A", "_rate", "12", "_position")
COUNTS = {"slider": (2, 1, 5), "rocker": (2, 2, 3), "dyad": (2, 1, 3), "lever": (2, 1, 4), "cylinder": (2, 1, 4)}
COUNTS |= {"yoke": (2, 1, 6), "pin": (0, 1, 0)}
"""Links, joints and outputs that each kind of group adds."""


def group(kind, choose):
    on, pin, label = choose(("A", "A", "B", "C", "O2")), choose(WORDS), choose(LABELS)
    make = {
        "slider": lambda: ks.SliderGroup(1.0, on=on, pin=pin, label=label),
        "rocker": lambda: ks.RockerGroup(0.4, 0.3, (0.3, 0.1), on=on, pin=pin, pivot_name=choose(WORDS), label=label),
        "dyad": lambda: ks.Dyad(0.4, 0.3, (on, "O"), pin, label=label),
        "lever": lambda: ks.LeverGroup((0.3, 0.1), on=on, pivot_name=pin, label=label),
        "cylinder": lambda: ks.CylinderGroup((0.3, 0.1), on=on, pivot_name=pin, label=label),
        "yoke": lambda: ks.YokeGroup(on=on, pin=pin, label=label),
        "pin": lambda: ks.Pin(on=choose(("crank", "frame", "slider", "dyad1")), at=(0.1, 0.0), name=pin),
    }
    return make[kind]()


@pytest.mark.slow
@every("seed", range(6))
def test_no_name_is_lost_in_silence(seed):
    random.seed(seed)
    made = refused = 0
    for _ in range(60):
        kinds = random.choices(list(COUNTS), k=random.choice((1, 2, 3)))
        try:
            chain = ks.Mechanism("chain", ks.Crank(0.1), tuple(group(kind, random.choice) for kind in kinds))
        except ks.ParameterError:
            refused += 1
            continue
        made += 1
        links, joints, outputs = (sum(counts) for counts in zip((1, 2, 2), *map(COUNTS.get, kinds), strict=True))
        assert (len(chain.links), len(chain.joints), len(chain.outputs)) == (links, joints, outputs)
        travels, measured = 3 * len(chain.guides), sum(kind in ("lever", "cylinder") for kind in kinds)
        whole = len({*RESERVED} - {GROUND, ROCKING, *BEARINGS})  # of a scene; of planes and bearings
        assert len(of_mechanism(chain)) == outputs + whole + travels + measured + 2 * links
    assert made
    assert refused


@every("kind", sorted({*COUNTS} - {"pin"}))
def test_group_on_a_link_is_advised_to_use_a_pin(kind):
    made = group(kind, random.Random(1).choice)
    on = ("crank", "A") if kind == "dyad" else "crank"
    with pytest.raises(ks.ParameterError, match="is attached to 'crank', which is a link; put a Pin on that link"):
        ks.Mechanism("chain", ks.Crank(0.1), (dataclasses.replace(made, on=on),))
