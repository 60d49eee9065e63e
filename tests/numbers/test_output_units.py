"""Units of output: dimensions, factors, and tables converted from SI and back."""

import math
import re
import subprocess
import sys
from functools import cache

import numpy as np
import pandas as pd
import pint
import pytest

import kinetostatics as ks
from kinetostatics.numbers.formatting import parse_heading
from kinetostatics.numbers.output_units import DIMENSIONS, dimension_name, output_units
from support.case_files import shipped, unlike_variants
from support.every import every

EXAMPLES = {name: example for name, (_, example) in DIMENSIONS.items()}
PUMP = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
MOTOR = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
FRICTION = {"guide": ks.GuideFriction(0.1)}


@every(
    ("unit", "dimension"),
    [
        *((unit, name) for name, units in DIMENSIONS.items() for unit in units),
        *(("N*m", "torque"), ("Wh", "energy"), ("N mm", "torque"), ("N/mm", "stiffness"), ("bar", "pressure")),
        *((unit, None) for unit in ("1", "", "%", "1/s", "N s", "kg m", "words", "N m/rad", "1/m")),
    ],
)
def test_units_know_their_dimension(unit, dimension):
    assert dimension_name(unit) == dimension


@every(
    ("chosen", "unit", "factor"),
    [
        ({"force": "kN"}, "N", 1e-3),
        ({"force": "lbf"}, "kN", 1000.0 / 4.4482216152605),  # by pint
        ({"angular speed": "rpm"}, "rad/s", 30.0 / math.pi),
        ({"angle": "rad"}, "deg", math.pi / 180.0),
        ({"inertia": "kg cm2"}, "kg*m**2", 1e4),
        ({"torque": "kN m"}, "J", 1.0),  # energy is another dimension
        ({"energy": "kJ"}, "N m", 1.0),
        ({"length": "mm"}, "m/s", 1.0),
    ],
)
def test_factors_go_from_a_unit_to_the_chosen_one(chosen, unit, factor):
    found, shown = output_units(chosen).of(unit)
    assert found == pytest.approx(factor, rel=1e-14)
    assert shown == (unit if factor == 1.0 else next(iter(chosen.values())))


@every(
    ("units", "message"),
    [
        ({"forc": "kN"}, r"dimension is 'forc', allowed: .*; did you mean 'force'\?"),
        ({"N": "kN"}, "dimension is 'N', allowed: .*; N measures force"),
        ({"force": "mm"}, 'force: "mm" does not measure the same as "N"; .*, such as "kN"'),
        ({"angular speed": "Hz"}, 'angular speed: "Hz" does not measure .*, such as "rpm"'),
        ({"force": "kNewtn"}, 'force: unit "kNewtn" is not known; give one that converts to "N"'),
        ({"force": 3}, 'force: a unit is a text, found 3, such as "kN"'),
        ({3: "kN"}, "dimension is 3, allowed"),
        ("kN", "units must be a dict of dimension to unit, as .*, got 'kN'"),
    ],
)
def test_what_is_no_choice_of_units_is_refused_in_one_sentence(units, message):
    for door in (output_units, PUMP.solve(8).frame, lambda units: ks.in_units(pd.DataFrame(), units)):
        with pytest.raises(ks.ParameterError, match=message):
            door(units)
    with pytest.raises(ks.ParameterError, match="table must be a pandas DataFrame, got 3"):
        ks.in_units(3, {})


REGISTRY = pint.UnitRegistry()


@cache
def by_pint(unit, other):
    """Factor between two units, by pint alone."""
    one, wanted = (re.sub(r"([a-z])(\d)", r"\1**\2", text.replace(" ", "*")) or "1" for text in (unit, other))
    return REGISTRY.Quantity(1.0, one).to(wanted).magnitude


def assert_converted(table, converted, units):
    """Every number of the converted table is that of the table by the factor of their units, which are the chosen."""
    assert len(table.columns) == len(converted.columns)
    for at, (column, shown) in enumerate(zip(table, converted, strict=True)):
        numbers, found = table.iloc[:, at], converted.iloc[:, at]
        (name, unit), (shown_name, shown_unit) = parse_heading(column), parse_heading(shown)
        if numbers.dtype.kind not in "fi":
            continue
        assert name == shown_name
        of_rows = "unit" in table and not unit and name != "ratio"
        pairs = zip(table["unit"], converted["unit"], strict=True) if of_rows else [(unit, shown_unit)] * len(table)
        pairs = list(pairs)
        assert [to for _, to in pairs] == [units.get(dimension_name(one), one) for one, _ in pairs]
        factors = [1.0 if one == to else by_pint(one, to) for one, to in pairs]
        np.testing.assert_allclose(found, numbers * factors, rtol=1e-12)


@cache
def run(flywheel=0.05):
    return ks.drive.steady(PUMP, MOTOR, flywheel=flywheel)


@cache
def tables():
    """A table of each kind by name, as a function of the units."""
    slow, rough = (ks.Scene(PUMP.mechanism, 50.0, **more).solve(36) for more in ({}, {"friction": FRICTION}))
    found = PUMP.solve(36)
    spring = ks.sizing.helical_spring(20e3, 0.02, preload=400.0, safety=1.3)
    designs = ks.designs.grid({"crank_length": "0.04..0.05 m:2"})
    swept = ks.sweep(PUMP, designs, ["largest O", "rms balancing_torque"], angles=36, progress=False)
    return {
        "solution": found.frame,
        "comparison": ks.compare(found, slow).frame,
        "running": run().frame,
        "drives": ks.compare(run(), run(0.5)).frame,
        "start": ks.drive.start(PUMP, MOTOR, 0.05).frame,
        "sizing": spring.table,
        "ground": lambda units: ks.in_units(found.ground.table(), units or {}),
        "losses": lambda units: ks.in_units(rough.losses.frame(), units or {}),
        "sweep": lambda units: ks.in_units(swept, units or {}),
    }


@pytest.mark.slow
@every("name", ["solution", "comparison", "running", "drives", "start", "sizing", "ground", "losses", "sweep"])
@every("units", [EXAMPLES, {"angle": "rad", "angular speed": "deg/s"}, {}])
def test_tables_are_the_same_in_other_units(name, units):
    table = tables()[name]
    assert_converted(table(None), table(units), units)


@pytest.mark.slow
@every("name", list(ks.shipped_cases()))
def test_results_of_shipped_cases_are_the_same_in_other_units(name):
    for variant in unlike_variants(name):
        s = shipped(name).solve(variant, 4)
        assert_converted(s.frame(), s.frame(EXAMPLES), EXAMPLES)


@pytest.mark.slow
def test_a_batch_of_designs_and_ratios_keep_their_numbers():
    batch = ks.solve(ks.crank_slider(np.array([[0.05], [0.06]]), 0.2), [0.1, 0.2], crank_speed=1.0).frame(
        {"length": "mm"}
    )
    assert batch["design"].tolist() == [0, 0, 1, 1]
    assert batch["A_x [mm]"].max() == pytest.approx(60.0 * math.cos(0.1))
    both = PUMP.solve(90), ks.Scene(PUMP.mechanism, 200.0).solve(90)
    assert ks.compare(*both).frame({"force": "kN"})["ratio"].equals(ks.compare(*both).frame()["ratio"])


@pytest.mark.slow
def test_usual_units_need_no_pint():
    code = (
        "import sys, kinetostatics as ks; s = ks.Scene(ks.crank_slider(0.1, 0.4), 10.0).solve(8);"
        f"s.frame({EXAMPLES!r}); assert 'pint' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
