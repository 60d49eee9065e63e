"""Helical springs: Norton's example, the study's saw, laws of scale, mass and surge, waves, and bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import kinetostatics as ks
from kinetostatics.machine.loads.surge import end_stiffness
from kinetostatics.sizing.springs import MATERIALS, NUMBERS
from support.case_files import shipped
from support.every import every
from support.units import UNITS

INCH, POUND = 0.0254, 4.4482216152605
PSI = POUND / INCH**2
SPEED = 320.0 * math.pi / 30.0
PAIR = {"arrangement": "opposed", "correction": "none"}
MUSIC = MATERIALS["music wire"]
pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")


def norton(**others):
    """Spring of Norton's example 14-4: music wire, 60 to 150 lb over 1 in."""
    wire, coil = 0.207 * INCH, 9.0 * 0.207 * INCH
    turns = MUSIC.shear_modulus * wire**4 / (8.0 * coil**3 * 90.0 * POUND / INCH)
    given = {"travel": INCH, "preload": 105.0 * POUND, "crank_speed": 1000.0 * math.pi / 30.0}
    return ks.sizing.HelicalSpring(wire_diameter=wire, coil_diameter=coil, active_turns=turns, **given | others)


def test_norton_example_14_4():
    found = norton()
    stresses = found.initial_stress, found.mean_stress, *(found.stress(f * POUND, "Wahl") for f in (60.0, 105.0))
    assert [f"{stress / PSI:.0f}" for stress in stresses] == ["33875", "59281", "37293", "65263"]
    assert found.largest_force == pytest.approx(150.0 * POUND)
    assert found.stiffness == pytest.approx(90.0 * POUND / INCH)


# The study's saw


@pytest.fixture(scope="module")
def saw():
    return shipped("sawframe_2r63").variants["cam-circle"].scene


@pytest.mark.slow
@pytest.mark.parametrize(("stress", "third", "exact"), [
    (600e6, ("1571 kg", "1262 kN/m"), ("1734 kg", "1393 kN/m")),
    (500e6, ("3672 kg", "2048 kN/m"), ("5561 kg", "3102 kN/m")),
])  # fmt: skip
def test_opposed_springs_of_the_saw(saw, stress, third, exact):
    found = ks.sizing.spring_for(saw, allowed_stress=stress, **PAIR)
    assert (f"{found.mass_by_third:.0f} kg", f"{found.stiffness_by_third / 1e3:.0f} kN/m") == third
    assert (f"{found.mass:.0f} kg", f"{found.stiffness / 1e3:.0f} kN/m") == exact
    assert end_stiffness(found.stiffness, found.mass, SPEED) == pytest.approx(600.0 * SPEED**2, rel=1e-11)
    assert found.carried_mass == pytest.approx(600.0)
    assert any(f"{found.mass:.4g} kg of steel for 600 kg: use gas springs" in note for note in found.notes)


def test_no_opposed_springs_of_400_mpa_balance_the_saw(saw):
    with pytest.raises(ks.ParameterError, match=r"no opposed springs .* 600 kg: .* ratio is 1\.77, .* gas springs"):
        ks.sizing.spring_for(saw, allowed_stress=400e6, **PAIR)


def test_push_pull_springs_of_the_saw_fail_by_fatigue(saw):
    found = ks.sizing.spring_for(saw, allowed_stress=600e6, correction="none")
    assert f"{found.mass:.0f} kg" == "238 kg"
    assert found.stress(found.amplitude, "none") == pytest.approx(600e6)
    assert f"{found.endurance[1] / 1e6:.0f} MPa" == "398 MPa"
    assert found.fatigue_safety < 398.0 / 600.0
    assert any("use gas springs" in note for note in found.notes)
    assert (f"{found.surge_ratio:.1f}", found.surge_ratio > 2.0) == ("5.3", True)


@pytest.mark.slow
def test_balance_of_the_saw_is_a_fixpoint(saw):
    """A scene with the springs found, their mass counted, asks for the same springs."""
    found = ks.sizing.spring_for(saw, safety=1.1, count=12)
    assert min(found.fatigue_safety, found.static_safety) == pytest.approx(1.1, rel=1e-9)
    sprung = saw.varied({"spring.stiffness": found.stiffness, "spring.mass": found.mass})
    again = ks.sizing.spring_for(sprung, safety=1.1, count=12)
    assert [again.mass, again.stiffness] == pytest.approx([found.mass, found.stiffness], rel=1e-9)
    reverse = ks.sizing.spring_for(replace(saw, crank_speed=-SPEED), safety=1.1, count=12)
    assert reverse.mass == pytest.approx(found.mass, rel=1e-12)
    assert found.surge_excitation == pytest.approx(ks.sizing.spring_surge(sprung.solve(4)).excitation, rel=1e-9)


@pytest.mark.slow
def test_a_mirrored_saw_has_the_same_springs():
    def sized(angle, sense):
        spring = ks.Spring.balancing(2.0, 60.0, free_position=0.31)
        pump = ks.crank_slider(0.02, 0.3, guide_angle=angle, guide_offset=0.01 * sense, slider=ks.Link(2.0))
        return ks.sizing.spring_for(ks.Scene(pump, 60.0 * sense, loads=spring))

    one, other = sized(0.4, 1.0), sized(-0.4, -1.0)
    assert one.mass == pytest.approx(other.mass, rel=1e-12)
    assert one.travel == pytest.approx(2.0 * (0.31 - math.sqrt(0.28**2 - 0.01**2)), rel=1e-12)


# Laws


@every(("arrangement", "at_ten", "of_the_saw"), [("push-pull", "5.342", "5.31"), ("opposed", "2.671", "2.66")])
@every(("count", "index"), [(1, 5.0), (7, 11.0)])
def test_surge_ratio_depends_on_stress_and_speed_alone(arrangement, at_ten, of_the_saw, count, index):
    """5.3 and 2.67 at 10 m/s and 600 MPa; 2.66 is that of the saw, whose slider reaches 10.053 m/s."""
    given = {"arrangement": arrangement, "count": count, "index": index, "correction": "none", "allowed_stress": 600e6}
    for stiffness, travel in ((5e5, 0.6), (8e3, 0.02)):
        found = ks.sizing.helical_spring(stiffness, travel, crank_speed=10.0 / (0.5 * travel), **given)
        law = math.pi * 600e6 / (10.0 * math.sqrt(2.0 * MUSIC.density * MUSIC.shear_modulus))
        assert found.surge_ratio == pytest.approx(law / (1 + (arrangement == "opposed")), rel=1e-12)
        assert found.stiffness == pytest.approx(stiffness, rel=1e-12)
        assert f"{found.surge_ratio:.3f}" == at_ten
    assert f"{ks.sizing.helical_spring(5e5, 0.6, crank_speed=SPEED, **given).surge_ratio:.2f}" == of_the_saw


@every("correction", ["none", "Ks", "Wahl"])
def test_mass_is_that_of_the_energy(correction):
    """Mass m = 4 rho G K^2 E / tau^2, E the energy at the largest force."""
    given = {"preload": 900.0, "count": 3, "allowed_stress": 5e8, "index": 6.0}
    found = ks.sizing.helical_spring(9e4, 0.03, correction=correction, **given)
    factor = {"none": 1.0, "Ks": 1.0 + 0.5 / 6.0, "Wahl": 23.0 / 20.0 + 0.615 / 6.0}[correction]
    energy = 3 * 0.5 * (900.0 + 3e4 * 0.015) ** 2 / 3e4
    assert found.mass == pytest.approx(4.0 * 7850.0 * 79.3e9 * factor**2 * energy / 5e8**2, rel=1e-12)
    assert found.stress(found.largest_force, correction) == pytest.approx(5e8, rel=1e-12)


@every(("given", "number"), [({}, "static_safety"), ({"preload": 100.0, "peened": False}, "fatigue_safety")])
def test_the_safety_asked_for_is_met_exactly(given, number):
    found = ks.sizing.helical_spring(20e3, 0.02, safety=1.4, **{"preload": 400.0} | given)
    assert getattr(found, number) == pytest.approx(1.4, rel=1e-10)
    assert min(found.fatigue_safety, found.static_safety) >= 1.4 * (1.0 - 1e-10)


def test_larger_springs_of_the_same_stress_are_alike():
    strong = MATERIALS["EN 10270-2 CrSi"]
    flat = replace(strong, exponent=0.0, thinnest=1e-6, thickest=10.0)
    small = ks.sizing.helical_spring(2e3, 0.01, preload=20.0, material=flat, crank_speed=50.0)
    large = ks.sizing.helical_spring(20e3, 0.1, preload=2000.0, material=flat, crank_speed=5.0)
    powers = {"m": 1, "kg": 3, "N/m": 1, "Hz": -1, "Pa": 0, "1": 0}
    for name, row in small.ROWS.items():
        assert getattr(large, name) == pytest.approx(getattr(small, name) * 10.0 ** powers[row.unit], rel=1e-9), name


# Other ways to the same numbers


def test_stiffness_by_twisting_a_wire():
    """Castigliano: energy of the torque F D / 2 along the wire."""
    found = norton()
    force, polar = 200.0, math.pi * found.wire_diameter**4 / 32.0
    length = math.pi * found.coil_diameter * found.active_turns
    energy = quad(lambda _: (force * found.coil_diameter / 2.0) ** 2 / (2.0 * 79.3e9 * polar), 0.0, length)[0]
    assert 2.0 * energy / force == pytest.approx(force / found.stiffness, rel=1e-12)


def test_the_end_of_the_springs_found_balances_the_mass_in_a_wave():
    """Waves: u'' = -z^2 u along the spring from its fixed foot; its end must push back with m3 w^2 u."""
    pump = ks.crank_slider(0.05, 0.3, slider=ks.Link(8.0))
    scene = ks.Scene(pump, 90.0, loads=ks.Spring.balancing(8.0, 90.0, free_position=0.3))
    found = ks.sizing.spring_for(scene, allowed_stress=450e6)
    square = found.mass * 90.0**2 / found.stiffness
    assert square > 0.1
    u, slope = solve_ivp(lambda _, y: [y[1], -square * y[0]], (0.0, 1.0), (0.0, 1.0), rtol=1e-11, atol=1e-13).y[:, -1]
    assert found.stiffness * slope / u == pytest.approx(8.0 * 90.0**2, rel=1e-8)


@every("found", [norton(), norton(preload=0.0), norton(peened=False), norton(preload=200.0 * POUND)])
def test_fatigue_safety_ends_on_the_limit(found):
    def excess(factor):
        mean = found.initial_stress + factor * (found.mean_stress - found.initial_stress)
        return factor * found.alternating_stress - found.alternating_limit(mean)

    assert excess(found.fatigue_safety) == pytest.approx(0.0, abs=1e-6 * found.endurance[1])
    assert excess(0.99 * found.fatigue_safety) < 0.0


@pytest.mark.slow
def test_buckling_has_the_textbook_limit():
    """Shigley, section 10-2: steel between plates is stable if L0 < 5.26 D; at the limit it buckles at 0.81 L0."""
    springs = (replace(norton(), active_turns=float(turns)) for turns in np.linspace(5.0, 30.0, 1000))
    found = next(spring for spring in springs if np.isfinite(spring.buckling_safety))
    assert found.free_length / found.coil_diameter == pytest.approx(5.26, abs=0.03)
    deflection = found.buckling_safety * found.largest_force / found.stiffness
    assert 0.7 < deflection / found.free_length < 0.812


def test_strength_of_crsi_wire_is_below_the_standard():
    """Least strengths of VDSiCr in EN 10270-2 by the diameter from which they hold, mm."""
    least = {1.41: 2060, 1.61: 2010, 2.01: 1960, 2.51: 1910, 3.51: 1860, 4.71: 1810, 5.61: 1760}
    for wire, strength in least.items():
        assert 0.97 * strength <= MATERIALS["EN 10270-2 CrSi"].tensile_strength(wire * 1e-3) / 1e6 <= strength


def test_strength_of_music_wire_is_that_of_norton():
    """184 649 psi d^-0.1625 with d in inches."""
    assert MUSIC.tensile_strength(0.207 * INCH) / PSI == pytest.approx(184649.0 * 0.207**-0.1625, rel=2e-4)


# What else a result gives


def test_table_and_quantities():
    plain = ks.sizing.helical_spring(20e3, 0.02, preload=400.0)
    told = ks.sizing.helical_spring(
        UNITS.Quantity(20, "N/mm"), UNITS.Quantity(2, "cm"), preload=UNITS.Quantity(0.4, "kN")
    )
    table = plain.table()
    assert list(table["value"]) == pytest.approx(list(told.table()["value"]), rel=1e-12)
    assert table.loc["mass", "unit"] == "kg"
    assert all(table["formula"].str.len() > 0)


@every(("given", "note"), [
    ({"crank_speed": 1e3}, "surge ratio "),
    ({"stiffness": 40e3}, "active turns; textbooks recommend 3"),
    ({"index": 3.0}, "index 3: wire is easily coiled"),
    ({"allowed_stress": 2e9}, "static safety is"),
    ({"allowed_stress": 1e6}, "wire of .* mm: strength of music wire is known from 0.3 to 6 mm"),
    ({"end_factor": 2.0, "index": 4.0, "stiffness": 2e3}, "it buckles"),
])  # fmt: skip
@pytest.mark.filterwarnings("default::kinetostatics.HintWarning")
def test_notes_warn(given, note):
    with pytest.warns(ks.HintWarning, match=note):
        ks.sizing.helical_spring(**{"stiffness": 20e3, "travel": 0.02, "preload": 400.0} | given)


def test_plot_shows_the_working_point():
    found = norton()
    haigh, drawing = ks.plots.helical_spring(found)
    points = [line.get_xydata()[0] for line in haigh.lines if line.get_marker() == "o"]
    assert points[0] == pytest.approx([found.mean_stress / 1e6, found.alternating_stress / 1e6])
    assert "D 47.32" in [text.get_text() for text in drawing.texts]
    for spring, ax, text in (("no spring", None, "must be a HelicalSpring"), (found, haigh, "2 Axes")):
        with pytest.raises(ks.ParameterError, match=text):
            ks.plots.helical_spring(spring, ax=ax)


# Bad input

SIZED = {"stiffness": 20e3, "travel": 0.02}
GIVEN = {"wire_diameter": 5e-3, "coil_diameter": 0.04, "active_turns": 6.0, "travel": 0.02}


@every("value", [0.0, -1.0, math.nan, math.inf, "one", None, [1.0, 2.0], np.ones((2, 1))])
@every(("make", "given", "name"), [
    *((ks.sizing.helical_spring, SIZED, name) for name in ("stiffness", "travel", "index", "safety", "end_factor")),
    (ks.sizing.helical_spring, SIZED, "allowed_stress"),
    *((ks.sizing.HelicalSpring, GIVEN, name) for name in GIVEN),
])  # fmt: skip
def test_wrong_numbers_are_named(make, given, name, value):
    if name == "allowed_stress" and value is None:  # by the safety
        return
    with pytest.raises(ks.ParameterError, match=name):
        make(**given | {name: value})


@every(("given", "text"), [
    ({"preload": -1.0}, "preload must be at least 0"),
    ({"crank_speed": math.nan}, "crank_speed must be finite"),
    ({"safety": 1e3}, "safety must be less than 100"),
    ({"index": 1.0}, "index must be greater than 1"),
    ({"material": "wood"}, "material is 'wood', allowed: 'music wire'"),
    ({"arrangement": "pull"}, "arrangement is 'pull', allowed: 'push-pull'"),
    ({"correction": "ks"}, "correction is 'ks', allowed"),
    ({"count": 1.5}, "count must be a whole number"),
    ({"count": 10**400}, "count must be at most"),
    ({"peened": "yes"}, "peened must be True or False"),
    ({"arrangement": "opposed", "preload": 50.0}, "preload must be at least 100 N, .* got 50 N"),
    ({"travel": -1.0, "index": 0.5, "count": 0}, "travel .*index .*count "),
])  # fmt: skip
def test_wrong_options_are_named(given, text):
    with pytest.raises(ks.ParameterError, match=text):
        ks.sizing.helical_spring(**SIZED | given)


def test_a_preload_beyond_all_travel_leaves_no_safety():
    assert ks.sizing.HelicalSpring(**GIVEN | {"preload": 1e30}).fatigue_safety == 0.0


def test_coils_must_be_wider_than_the_wire():
    with pytest.raises(ks.ParameterError, match=r"coil_diameter must be greater .*, got 0\.04 and 0\.04 m"):
        ks.sizing.HelicalSpring(**GIVEN | {"wire_diameter": 0.04})


@every(("given", "text"), [
    ({"density": 0.0}, "density must be greater than 0"),
    ({"exponent": -0.1}, "exponent must be at least 0"),
    ({"thinnest": 0.1}, r"thinnest must not exceed thickest, got 0\.1 and 0\.006 m"),
    ({"shear_modulus": 3e11}, "shear_modulus must be less .*, got 3e.11 and 2.068e.11 Pa"),
    ({"peened": (1.1e9, 4e8)}, "peened must be a mean from 0"),
    ({"unpeened": (3e8, 0.0)}, "unpeened must be a mean from 0"),
    ({"peened": 4e8}, "peened must be a pair"),
])  # fmt: skip
def test_wrong_materials_are_named(given, text):
    with pytest.raises(ks.ParameterError, match=text):
        replace(MUSIC, **given)


PUMP = ks.crank_slider(0.05, 0.3, slider=ks.Link(8.0))
SPRING = ks.Spring.balancing(8.0, 90.0, free_position=0.3)


@every(("scene", "name", "text"), [
    (ks.Scene(PUMP, 90.0), "spring", "no Spring among its loads"),
    (ks.Scene(PUMP, 90.0, loads=SPRING), "spring2", "spring is 'spring2', allowed: 'spring'"),
    (ks.Scene(PUMP, 0.0, loads=SPRING), "spring", "crank_speed must not be 0"),
    (ks.Scene(PUMP, np.array([[9.0], [8.0]]), loads=SPRING), "spring", "crank_speed must be one number"),
    (ks.Scene(PUMP, 90.0, loads=ks.Spring(np.array([[9.0], [8.0]]), 0.3)), "spring", "stiffness must be one number"),
    (ks.Scene(PUMP, 90.0, loads=ks.Spring(0.0, 0.3)), "spring", "stiffness must be greater than 0"),
    (ks.Scene(PUMP, 90.0, loads=ks.Spring(1e3, 0.3, cubic=1.0)), "spring", r"no cubic term, got 1\.0"),
    (
        ks.Scene(PUMP, 90.0, loads=ks.Spring(1e3, 0.3, mass=5.0)),
        "spring",
        "own mass uses up its stiffness at 90 rad/s.* 5 kg, 1000 N/m; give it less mass",
    ),
    (ks.Scene(ks.crank_slider(0.3, 0.2), 90.0, loads=SPRING), "spring", "spring_for: .* not"),
    (ks.Scene(ks.crank_slider(np.array([[0.05], [0.06]]), 0.3), 9.0, loads=SPRING), "spring", "one design at a time"),
    (PUMP, "spring", "scene must be a Scene"),
])  # fmt: skip
def test_scenes_without_a_balance_are_refused(scene, name, text):
    with pytest.raises(ks.ParameterError, match=text):
        ks.sizing.spring_for(scene, name)


def test_numbers_are_those_of_the_signatures():
    import inspect

    names = {*inspect.signature(ks.sizing.helical_spring).parameters, *ks.sizing.BalancingSpring.__dataclass_fields__}
    assert set(NUMBERS) <= names


def test_options_of_a_scene_are_those_of_a_spring():
    scene = ks.Scene(PUMP, 90.0, loads=SPRING)
    with pytest.raises(ks.ParameterError, match=r"option is 'saftey', allowed: .*; option is 'crank_speed', allowed"):
        ks.sizing.spring_for(scene, saftey=1.2, crank_speed=3.0)
    with pytest.raises(ks.ParameterError, match="correction is 'ks'"):
        norton().stress(100.0, "ks")
