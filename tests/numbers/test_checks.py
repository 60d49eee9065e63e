"""Checks of values: rules, quantities of pint, suggestions."""

import subprocess
import sys
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pint
import pytest

import kinetostatics as ks
from kinetostatics.cycle.reductions import REDUCTIONS
from kinetostatics.numbers.checks import DimensionError, is_quantity, to_plain
from kinetostatics.numbers.checks.messages import SYNONYMS, nearest
from kinetostatics.numbers.units import to_si
from support.every import every
from support.units import UNITS

TURN = 2 * np.pi * np.arange(72) / 72
EVEN = 2 * np.pi * np.arange(40) / 40
ROUND = np.full(40, 0.3)
EITHER = "either guide or guide_angle"


def crank_slider(**changes):
    return ks.crank_slider(**{"crank_length": 0.3, "coupler_length": 1.1} | changes)


def solve(mechanism, angle=TURN, **changes):
    return ks.solve(mechanism, angle, **{"crank_speed": 1.0} | changes)


# Values


@every(
    ("make", "message"),
    [
        (lambda: ks.Link(np.array([[2.0], [-3.0]])), "Link: mass must be at least 0, got a smallest value of -3"),
        (
            lambda: ks.Link("heavy"),
            r"Link: mass must be a number or an array of shape \(designs, 1\), got 'heavy'",
        ),
        (
            lambda: ks.Link(centre=(1.0, 2.0, 3.0)),
            r"Link: centre must be \(along, across\) or a number, got \(1.0, 2.0, 3.0\)",
        ),
        (lambda: ks.Link(centre=(0.0, np.nan)), "Link: centre across must be finite, got nan"),
        (
            lambda: ks.Link(-1.0, (np.inf, 0.0), -3.0),  # every fault at once
            r"mass .* -1.0; centre along .* inf; inertia .* -3.0",
        ),
        (lambda: crank_slider(crank_length=-0.3), "crank length must be greater than 0, got -0.3"),
        (lambda: crank_slider(guide_angle=np.inf), "guide_angle must be finite, got inf"),
        (lambda: crank_slider(guide=ks.Guide.at(0.1), guide_angle=0.2), EITHER),
        (lambda: crank_slider(guide=ks.Guide.at(0.1), guide_offset=0.1), EITHER),
        (lambda: solve(crank_slider(), on_gap="skip"), "on_gap is 'skip', allowed: 'raise', 'nan'"),
        (
            lambda: solve(crank_slider(), loads=[ks.Spring(1.0, 0.0, on="slidr")]),
            "Spring: on is 'slidr', allowed: 'slider'; did you mean 'slider'",
        ),
        (
            lambda: solve(crank_slider(), loads=ks.ProcessForce(1.0, on="coupler")),
            "ProcessForce: on is 'coupler', allowed: 'slider'",
        ),
        (lambda: ks.cams.Circle(0.3, (0.0, 0.4)), "O must lie inside .* 0.4 m from O and its radius 0.3 m"),
        (lambda: ks.cams.Circle(0.3, (-0.3, 0.0)), "O must lie inside the pitch circle"),
        (lambda: ks.cam_crank_slider(ks.cams.Circle(0.3), 2.0, guide=ks.Guide.at(0.1), guide_angle=0.1), EITHER),
        (lambda: ks.cams.CosineLaw(0.3, 0.3), "mean must exceed the amplitude.* got mean 0.3 m and amplitude 0.3 m"),
        (lambda: ks.cams.Sampled(EVEN[:7], ROUND[:7]), "at least 8 points are needed, got 7"),
        (lambda: ks.cams.Sampled(EVEN, ROUND[:-1]), "angle and radius must be 1-D, of one length"),
        (lambda: ks.cams.Sampled(EVEN[::-1], ROUND), "angles must rise, but row 2 .5.96903 rad. follows 6.12611"),
        (lambda: ks.cams.Sampled(np.linspace(0, 2 * np.pi, 40), ROUND), "within one turn, end excluded"),
        (lambda: ks.cams.Sampled(EVEN, ROUND - 0.3), "radius must be greater than 0"),
        (lambda: ks.cams.Sampled(EVEN, np.where(EVEN > 3, np.nan, ROUND)), "radius must be finite"),
        (lambda: ks.cams.Sampled(np.where(EVEN > 3, np.nan, EVEN), ROUND), "angle must be finite"),
    ],
)
def test_impossible_values_are_refused(make, message):
    with pytest.raises(ks.ParameterError, match=message):
        make()


def test_all_errors_are_one_family_and_value_errors():
    assert issubclass(ks.ParameterError, ks.KinetostaticsError)
    assert issubclass(ks.ParameterError, ValueError)
    assert issubclass(ks.AssemblyError, ks.KinetostaticsError)
    assert issubclass(ks.QuantityError, AttributeError)


def test_single_precision_angles_are_warned_of():
    with pytest.warns(UserWarning, match="crank angles are in single precision") as caught:
        ks.solve(crank_slider(), TURN.astype(np.float32), crank_speed=1.0)
    assert caught[0].filename == __file__


# Names


@every(
    ("ask", "message"),
    [
        (lambda s: s.reaction("guid"), "crank-slider: reaction is 'guid', allowed: .*'guide'.*; did you mean 'guide'?"),
        (
            lambda s: s.position("b"),
            "joint or link is 'b', allowed: 'O', 'A', 'B', 'crank', 'coupler', 'slider'; did you mean 'B'",
        ),
        (
            lambda s: s.rate("couplr"),
            "crank-slider: link is 'couplr', allowed: 'crank', 'coupler', 'slider'; did you mean 'coupler'",
        ),
        (lambda s: s.inertia_force("block"), "crank-slider: link is 'block', allowed: 'crank', 'coupler', 'slider'"),
        (lambda s: s.scalar("guide_farce"), "'guide_farce', allowed: .*'guide_force'.*did you mean 'guide_force'"),
        (lambda s: s.cam_force, "'cam_force', allowed: "),
        (lambda s: s.slot_force, "'slot_force', allowed: "),
        (lambda s: s.pressure_angle, "crank-slider: quantity is 'pressure_angle', allowed: 'balancing_torque'"),
    ],
)
def test_unknown_names_list_valid_and_nearest(ask, message):
    with pytest.raises(ks.QuantityError, match=message):
        ask(solve(crank_slider()))


# Cams


def test_a_class_of_cam_must_say_its_radius():
    with pytest.raises(TypeError, match=r"Flat must define polar\(angle, ray\)"):
        type("Flat", (ks.cams.Cam,), {})().radius(0.0)


def test_constant_of_a_batch_has_its_shape():
    batch = solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(1.0)), np.array([0.0, 1.0, 2.0]))
    assert batch.guide_moment.shape == batch.balancing_torque.shape == (2, 3)


# Suggestions come from declared synonyms, and from spelling where there are none

SCENE = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.4, 0.0))
QUANTITIES = ("balancing_torque", "guide_force", "load_torque", "slider_position", "A", "B", "O")


def test_synonyms_are_of_words_that_the_library_has():
    made = SCENE.mechanism, FOUR_BAR
    known = {"compiled", "numpy", "jax", *REDUCTIONS, *SCENE.parameters, *QUANTITIES, *ks.__all__, "slider_velocity"}
    known |= {"slider_acceleration"}.union(*(mechanism.links for mechanism in made))
    assert {name.split()[-1] for name in SYNONYMS} <= known  # "mean balancing_torque" is an output


@every(
    ("word", "allowed", "meant"),
    [
        ("numba", ("numpy", "compiled"), "compiled"),
        ("NumPy", ("numpy", "compiled"), "numpy"),
        ("torque", QUANTITIES, "balancing_torque"),
        ("max O", QUANTITIES, "O"),
        ("piston_pin", QUANTITIES, "B"),
        ("o", QUANTITIES, "O"),
        ("|O|", QUANTITIES, "O"),
        ("crank_length (mm)", ("crank_length", "coupler_length"), "crank_length"),
        ("crank_length [mm]", ("crank_length", "coupler_length"), "crank_length"),
        ("rod.mass", tuple(SCENE.parameters), "coupler.mass"),
        ("rod2.mass", ("coupler.mass", "coupler2.mass"), "coupler2.mass"),
        ("rpm", tuple(SCENE.parameters), "crank_speed"),
        ("max", REDUCTIONS, "largest"),
        ("argmax", REDUCTIONS, "largest_at"),
        ("larges", REDUCTIONS, "largest"),
        ("proces force", ("force", "process force"), "process force"),
        ("zzz", REDUCTIONS, None),
        (3, REDUCTIONS, None),
        ("", REDUCTIONS, None),
    ],
)
def test_what_is_meant_is_found(word, allowed, meant):
    assert nearest(word, allowed) == meant


@every(
    ("wrong", "told"),
    [
        (lambda: SCENE.solve(3, engine="numba"), "did you mean 'compiled'"),
        (lambda: ks.extremes(SCENE.solve(3), "torque"), "did you mean 'balancing_torque'"),
        (lambda: ks.extremes(SCENE.solve(3), "max O"), "did you mean 'O'"),
        (lambda: SCENE.varied({"rod_length (mm)": 3.0}), "did you mean 'coupler_length'"),
        (lambda: ks.design.optimise(SCENE, vary={"crank_length": (0.2, 0.4)}, minimise="max O"), "mean 'largest O'"),
        (
            lambda: ks.design.optimise(SCENE, vary={"crank_length": (0.2, 0.4)}, minimise="ratio peak O"),
            "mean 'ratio largest O'",
        ),
    ],
)
def test_errors_ask_for_what_is_meant(wrong, told):
    with pytest.raises(ks.KinetostaticsError) as caught:
        wrong()
    assert told in str(caught.value)


# Quantities of pint of any registry, as plain numbers

DECIMALS = pint.UnitRegistry(None, non_int_type=Decimal)
DECIMALS.define("meter = [length] = m")
DECIMALS.define("millimeter = 0.001 * meter = mm")
UNITS.define("span = 0.25 * meter")


class Labelled:
    """An array as xarray's are: its to_numpy drops the unit."""

    shape, ndim = (2,), 1
    data = UNITS.Quantity(np.array([250.0, 500.0]), "mm")

    def to_numpy(self):
        """The magnitudes."""
        return self.data.magnitude


RIGHT = {
    "a length": (UNITS.Quantity(250.0, "mm"), "m", 0.25),
    "a whole number": (UNITS.Quantity(2, "km"), "m", 2000),
    "an angle in degrees": (UNITS.Quantity(180.0, "deg"), "rad", np.pi),
    "revolutions": (UNITS.Quantity(30.0, "rpm"), "rad/s", np.pi),
    "revolutions per minute": (UNITS.Quantity(60.0, "revolution") / UNITS.Quantity(1.0, "minute"), "rad/s", 2 * np.pi),
    "a ratio": (UNITS.Quantity(12.5, "percent"), "1", 0.125),
    "a ratio of lengths": (UNITS.Quantity(1.0, "mm") / UNITS.Quantity(1.0, "m"), "1", 1e-3),
    "decibels": (UNITS.Quantity(-10.0, "dB"), "1", 0.1),
    "pounds": (UNITS.Quantity(1.0, "lbf"), "N", 4.4482216152605),
    "a torque": (UNITS.Quantity(2.0, "N*m"), "N*m", 2.0),
    "a torsion spring": (UNITS.Quantity(np.pi, "N*m/deg"), "N*m/rad", 180.0),
    "a mass by its weight": (UNITS.Quantity(2.0, "kg*m/s**2"), "N", 2.0),
    "the application's registry": (pint.Quantity(250.0, "mm"), "m", 0.25),
    "a registry with units of one's own": (UNITS.Quantity(2.0, "span"), "m", 0.5),
    "decimals": (DECIMALS.Quantity(Decimal("250"), "mm"), "m", 0.25),
    "a decimal in a registry of floats": (UNITS.Quantity(Decimal("250"), "mm"), "m", 0.25),
    "a float in a registry of decimals": (DECIMALS.Quantity(250.0, "mm"), "m", 0.25),
    "a fraction": (UNITS.Quantity(Fraction(1, 4), "m"), "m", 0.25),
}


@every(("value", "unit", "wanted"), RIGHT.values(), ids=RIGHT)
def test_quantities_become_numbers_in_the_unit_wanted(value, unit, wanted):
    assert float(to_plain(value, unit)) == pytest.approx(wanted, rel=4e-16)


WRONG = {
    "frequency for a speed": (
        UNITS.Quantity(5.0, "Hz"),
        "rad/s",
        r"\[angle\] / \[time\].* which measures 1 / \[time\]",
    ),
    "1/s for a speed": (UNITS.Quantity(5.0, "1/s"), "rad/s", r"give \.to\('rad/s'\) where that is meant"),
    "a ratio for an angle": (UNITS.Quantity(5.0, ""), "rad", r"which measures a plain number"),
    "an angle for a ratio": (UNITS.Quantity(5.0, "deg"), "1", r"a plain number, as a ratio"),
    "N m for a torsion spring": (UNITS.Quantity(5.0, "N*m"), "N*m/rad", r"an angle is no plain number"),
    "a temperature": (UNITS.Quantity(20.0, "degC"), "m", r"which measures \[temperature\]"),
    "a difference of temperatures": (UNITS.Quantity(20.0, "delta_degF"), "kg", r"which measures \[temperature\]"),
    "an area for a length": (UNITS.Quantity(20.0, "cm**2"), "m", r"which measures \[length\]\^2"),
    "a unit alone": (UNITS.kg, "kg", "got the unit kilogram without one"),
    "an array": (UNITS.Quantity(np.ones(9), "kg"), "m", r"an array in kilogram, which measures \[mass\]"),
    "one of many": ([UNITS.Quantity(1, "m"), UNITS.Quantity(1, "s")], "m", r"got 1 second, which measures \[time\]"),
    "a unit that nobody knows": (UNITS.Quantity(1.0, "m"), "", "its unit is unknown"),
    "a long text": (UNITS.Quantity(10**200, "kg"), "m", r"\.\.\., which measures"),
}


@every(("value", "unit", "words"), WRONG.values(), ids=WRONG)
def test_another_dimension_is_told_with_what_is_wanted(value, unit, words):
    with pytest.raises(DimensionError, match=words):
        to_plain(value, unit)


def test_a_registry_that_lacks_the_unit_is_said_so():
    bare = pint.UnitRegistry(None)
    bare.define("ell = [ell]")
    with pytest.raises(ks.ParameterError, match=r"mass must be a number in kg, got 3 ell.*not defined"):
        ks.Link(bare.Quantity(3, "ell"))


def test_lists_and_arrays_of_quantities_convert():
    parts = [UNITS.Quantity(250.0, "mm"), UNITS.Quantity(2.0, "span"), 0.75]
    assert to_plain(parts, "m") == [0.25, 0.5, 0.75]
    assert to_plain(tuple(parts), "m") == (0.25, 0.5, 0.75)
    assert to_plain(np.array(parts, dtype=object), "m").tolist() == [0.25, 0.5, 0.75]
    assert to_plain(UNITS.Quantity([[250.0], [500.0]], "mm"), "m").tolist() == [[0.25], [0.5]]
    assert to_plain(Labelled(), "m").tolist() == [0.25, 0.5]


def test_what_is_no_quantity_comes_back_itself():
    for value in (1.0, 3, None, "300 mm", (1.0, 2.0), [1.0], np.ones(3), np.array([None, 1.0]), {}, True):
        assert to_plain(value, "m") is value
        assert not is_quantity(value)


def test_wrong_magnitudes_are_refused():
    for magnitude, words in (
        (1j, "complex number"),
        (np.ma.array([1.0]), "masked array"),
        (np.array([True]), "a truth value"),
    ):
        with pytest.raises(ks.ParameterError, match=words):
            ks.Link(UNITS.Quantity(magnitude, "g"))


def test_quantities_agree_with_the_texts_of_case_files():
    for text, unit in (("300 mm", "m"), ("320 rpm", "rad/s"), ("712 kN/m", "N/m"), ("12 deg", "rad"), ("5 lb", "kg")):
        assert to_plain(UNITS.Quantity(text), unit) == pytest.approx(to_si(text, unit), rel=4e-16)


@every("kind", [np.float16, np.float32, np.uint8])
def test_few_digits_are_converted_in_double_precision(kind):
    assert to_plain(UNITS.Quantity(kind(100), "mm"), "m") == 0.1
    assert to_plain(UNITS.Quantity(np.array([100], dtype=kind), "mm"), "m")[0] == 0.1
    with pytest.raises(ks.ParameterError, match="masked array"):
        ks.Link(UNITS.Quantity(np.ma.array([[1]], mask=[[True]], dtype=kind), "g"))


@pytest.mark.slow
def test_plain_numbers_import_no_pint():
    code = (
        "import sys, kinetostatics as ks; s = ks.solve(ks.crank_slider(0.1, 0.3, slider=ks.Link(1.0)), [0.1, 0.2], "
        "crank_speed=3.0).balancing_torque; sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
