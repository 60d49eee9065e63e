"""Mower drive: 50-digit tables of the common mass centre and the shaking force, and the study's table 1.

Tables in tests/data come from an independent computation with 50-digit arithmetic. The study is A. V. Kotov, Tractors
and Agricultural Machinery 2024, 91(2), 167-180; its table 1 cuts digits off and takes maxima on a grid of 30 degrees.
"""

import json
from decimal import ROUND_DOWN, Decimal
from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from support import DATA
from support.case_files import shipped
from support.machines import largest

VARIANTS = {
    "unbalanced": "unbalanced",
    "partial-1": "partial_1_vertical",
    "partial-2": "partial_2_horizontal",
    "partial-3": "partial_3_total",
    "full": "full",
}
"""Name in the case file, name in the tables."""
CLOSE = 1e-12
SPEED = 600 * 2 * np.pi / 60
CRANK, COUPLER, SLIDER, GUIDE = 0.038, 0.3, 5.0, ((0.0, -0.02), (0.3, -0.02))
every_variant = pytest.mark.parametrize("variant", VARIANTS)


def data(name):
    path = DATA / f"mower_{name}.json"
    return json.loads(path.read_text(encoding="utf-8"))


@cache
def table(variant):
    rows = data(VARIANTS[variant])["rows"]
    return {name: np.array([row[name] for row in rows], dtype=float).T for name in rows[0]}


@cache
def parameters(variant):
    return {name: float(value) for name, value in data("summary")[VARIANTS[variant]].items()}


def built(variant):
    """From the masses and arms the tables were computed with."""
    given = parameters(variant)
    return ks.crank_slider(
        CRANK,
        COUPLER,
        guide=ks.Guide.through(*GUIDE),
        crank=ks.Link(given["m1"], given["L1"]),
        coupler=ks.Link(given["m2"], given["L2"]),
        slider=ks.Link(SLIDER),
    )


@cache
def case():
    return shipped("mower_drive")


def balanced(variant):
    """As the library balances it, from the case file."""
    return case().variants[variant].mechanism


def solve(mechanism, angle):
    return ks.solve(mechanism, angle, crank_speed=SPEED)


def scale(variant, name):
    """Largest value of a column; of those that full balancing makes zero, that of the unbalanced mechanism."""
    return largest(table("unbalanced" if variant == "full" else variant)[name])


# Tables


@every_variant
@pytest.mark.parametrize("made", [built, balanced])
def test_mass_centre_equals_the_50_digit_table(variant, made):
    mechanism = made(variant)
    s = solve(mechanism, np.radians(table(variant)["angle_deg"]))
    points = ks.principal_points(mechanism)
    found = {
        "S": points.mass_centre(s),
        "aS": points.mass_centre_acceleration(s),
        "F": s.shaking_force,
    }
    assert set(found) | {"angle_deg"} == set(table(variant))
    errors = {name: largest(values - table(variant)[name]) / scale(variant, name) for name, values in found.items()}
    assert {name: float(error) for name, error in errors.items() if not error < CLOSE} == {}


@every_variant
def test_mass_centre_velocity_is_the_tabled_slope(variant):
    """By the Fourier series of the 72 positions, whose harmonics fall below rounding long before the 36th."""
    path = table(variant)["S"]
    slope = np.fft.irfft(1j * np.arange(37) * np.fft.rfft(path), path.shape[1])
    s = solve(balanced(variant), np.radians(table(variant)["angle_deg"]))
    velocity = ks.principal_points(s.mechanism).mass_centre_velocity(s)
    assert largest(velocity - SPEED * slope) < CLOSE * SPEED * scale(variant, "S")


@every_variant
@pytest.mark.parametrize("made", [built, balanced])
def test_moduli_equal_the_tabled_ones(variant, made):
    moduli, given = ks.principal_points(made(variant)).moduli, parameters(variant)
    assert moduli["crank"] == pytest.approx(given["h1"], rel=1e-14, abs=1e-17)
    assert moduli["coupler"] == pytest.approx(given["h2"], rel=1e-14, abs=1e-16)
    assert moduli["slider"] == 0


@pytest.mark.parametrize("variant", [name for name in VARIANTS if name != "unbalanced"])
def test_counterweights_give_the_tabled_masses(variant):
    links, given = balanced(variant).links, parameters(variant)
    for link, mass, unbalance in (("crank", "m1", "crank_unbalance"), ("coupler", "m2", "coupler_unbalance")):
        assert links[link].mass == pytest.approx(given[mass], rel=1e-14)
        assert links[link].mass * links[link].centre[0] == pytest.approx(given[unbalance], rel=1e-14)
        assert links[link].centre[1] == 0


# Extremes

COMPONENTS = {"Fx": lambda s: s.shaking_force[0], "Fy": lambda s: s.shaking_force[1], "F": "shaking_force"}


@every_variant
@pytest.mark.parametrize("component", COMPONENTS)
def test_true_extremes_equal_the_summary(variant, component):
    """Of extremes alike by symmetry any one may be meant."""
    found = ks.extremes(solve(balanced(variant), 0.0), COMPONENTS[component])
    expected, size = parameters(variant).get(f"max_abs_{component}", 0.0), abs(found.largest)
    if expected == 0:
        assert size < CLOSE * parameters("unbalanced")["max_abs_F"]
        return
    assert size == pytest.approx(expected, rel=CLOSE)
    alike = found.angle[np.abs(found.value) > (1 - CLOSE) * expected]
    distance = np.abs(np.angle(np.exp(1j * (alike - np.radians(parameters(variant)[f"max_abs_{component}_at_deg"])))))
    assert np.min(distance) < 1e-7


@every_variant
@pytest.mark.parametrize("component", COMPONENTS)
def test_grid_maxima_equal_the_summary(variant, component):
    x, y = solve(balanced(variant), np.radians(np.arange(0, 360, 30))).shaking_force
    found = largest({"Fx": x, "Fy": y, "F": np.hypot(x, y)}[component])
    expected = parameters(variant)[f"grid30_max_abs_{component}"]
    assert found == pytest.approx(expected, rel=CLOSE, abs=CLOSE * parameters("unbalanced")["grid30_max_abs_F"])


# Table 1


@cache
def printed_entries():
    """Row, column and printed figure of every entry, from the case file."""
    published = case().published.balancing
    return [(row, column, text) for row, entries in published.items() for column, text in entries.items()]


@cache
def ours():
    return case().balancing_table()


def cut_off(value, printed):
    """A number with the digits beyond the printed ones cut off."""
    return Decimal(repr(float(value))).quantize(Decimal(printed), rounding=ROUND_DOWN)


def test_table_1_is_ours_cut_to_printed_digits():
    wrong = [
        (row, column, printed, float(ours().loc[row, column]))
        for row, column, printed in printed_entries()
        if cut_off(ours().loc[row, column], printed) != Decimal(printed)
    ]
    assert wrong == []


def test_table_1_is_whole():
    """Six rows for each of five counterweighted links, three of forces and one of reductions for each variant."""
    assert len(printed_entries()) == 6 * 5 + 3 * 4 + 3
    assert ("largest |F| on the study's grid [N]", "partial-3 crank", "533.4") in printed_entries()


def test_some_entries_of_table_1_are_not_rounded():
    """So that cutting off and rounding are told apart: 6.65 is printed 6.6, 50.67 is printed 50.6."""
    rounded = [
        printed
        for row, column, printed in printed_entries()
        if round(float(ours().loc[row, column]), 1) != float(printed)
    ]
    assert {"6.6", "50.6", "22.5"} <= set(rounded)


@pytest.mark.parametrize(("variant", "true"), [("partial-1", 22.27), ("partial-2", 29.81), ("partial-3", 56.56)])
def test_true_reduction_of_the_largest_force(variant, true):
    assert round(ours().loc["reduction of |F| [%]", f"{variant} crank"], 2) == true


def test_coarse_grid_hides_half_a_per_cent():
    unbalanced = parameters("unbalanced")
    on_grid = solve(balanced("unbalanced"), np.radians(np.arange(0, 360, 30))).shaking_force
    true = ks.extremes(solve(balanced("unbalanced"), 0.0), "shaking_force").largest
    assert (round(largest(np.hypot(*on_grid)), 2), round(true, 2)) == (1233.54, 1234.51)
    assert true == pytest.approx(unbalanced["max_abs_F"], rel=CLOSE)
    hidden = [
        1 - ours().loc["largest |F| on the study's grid [N]", name] / ours().loc["largest |F| [N]", name]
        for name in ("partial-1 crank", "partial-2 crank", "partial-3 crank")
    ]
    assert 0.005 < max(hidden) < 0.0055
    assert min(hidden) < 1e-12
