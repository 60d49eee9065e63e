"""The chain unit's four-bar in relative form, lambda = 2/3, rho = 0.1 and 0.5: 50-digit tables and published figures.

Tables in tests/data come from an independent computation with 50-digit arithmetic. There the crank angle counts from
+y, clockwise, at crank speed 1; psi, w_h and e_h of the rocker are positive clockwise, gamma, w_AB and e_AB of the
coupler counter-clockwise from +x. The published figures are those of the Belarusian study of the chain unit.
"""

from decimal import ROUND_DOWN, ROUND_HALF_UP, Decimal

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.linkage import chain_unit, chain_unit_angle, rocker_angle, swing
from kinetostatics.studies.methods.papers import chain_unit_by_atan_acos
from support.case_files import four_bar_data, four_bar_table
from support.machines import largest

RHO = (0.1, 0.5)
LAMBDA = 2 / 3
CLOSE = 1e-14
"""Relative to the largest of a column: a hundredth of what is asked for."""
EXTREMES = {
    "w_h_absmax": "rocker_rate",
    "e_h_absmax": "rocker_angular_acceleration",
    "w_AB_absmax": "coupler_rate",
    "e_AB_absmax": "coupler_angular_acceleration",
}

every_rho = pytest.mark.parametrize("rho", RHO)


def summary(rho):
    return {name: float(value) for name, value in four_bar_data("summary")[f"rho={rho}"].items()}


def solution(rho, size=1.0, speed=1.0):
    """At the crank angles of the table; the crank turns clockwise."""
    mechanism = chain_unit(size * rho, size, size * LAMBDA)
    return ks.solve(mechanism, chain_unit_angle(np.radians(four_bar_table(rho)["angle_deg"])), crank_speed=-speed)


def columns(s, size=1.0, speed=1.0):
    """What the tables hold, by their names."""
    along = s.position("B") - s.position("A")
    return {
        "psi": rocker_angle(s),
        "gamma": np.arctan2(along[1], along[0]),
        "w_AB": s.rate("coupler") / speed,
        "e_AB": s.angular_acceleration("coupler") / speed**2,
        "w_h": -s.rate("rocker") / speed,
        "e_h": -s.angular_acceleration("rocker") / speed**2,
        "B": s.position("B") / size,
    }


def assert_equals_table(found, rho):
    expected = four_bar_table(rho)
    errors = {name: largest(values - expected[name]) / largest(expected[name]) for name, values in found.items()}
    assert {name: float(error) for name, error in errors.items() if not error < CLOSE} == {}


def clockwise_degrees(angle):
    """A crank angle of the library as the study counts it."""
    return np.degrees(chain_unit_angle(angle)) % 360


@every_rho
def test_every_column_equals_the_50_digit_table(rho):
    found = columns(solution(rho))
    assert {"angle_deg", *found} == set(four_bar_table(rho))
    assert_equals_table(found, rho)


@every_rho
def test_scaled_dimensional_form_equals_the_table(rho):
    """A coupler of 300 mm and 31.4 rad/s, as in the study's experiments."""
    assert_equals_table(columns(solution(rho, 0.3, 31.4), 0.3, 31.4), rho)


@every_rho
def test_formulas_of_the_study_equal_the_table(rho):
    """Both links by atan and acos and the two-component rates, in the range for which they were derived."""
    angle = np.radians(four_bar_table(rho)["angle_deg"])
    gamma, psi, coupler_rate, rocker_rate = chain_unit_by_atan_acos(
        rho, 1.0, LAMBDA, np.sqrt((1 - rho) * (1 + rho)), angle
    )
    assert_equals_table({"gamma": -gamma, "psi": psi, "w_AB": -coupler_rate, "w_h": rocker_rate}, rho)


@every_rho
def test_swing_and_asymmetry_equal_the_summary(rho):
    found, expected = swing(solution(rho)), summary(rho)
    assert found.largest == pytest.approx(expected["psi_max"], rel=1e-14)
    assert found.smallest == pytest.approx(expected["psi_min"], rel=1e-14)
    assert found.range == pytest.approx(expected["psi_max"] - expected["psi_min"], rel=1e-14)
    assert found.asymmetry == pytest.approx(expected["asymmetry_eta"], rel=1e-13)
    places = clockwise_degrees(found.largest_at), clockwise_degrees(found.smallest_at)
    assert places == pytest.approx((expected["psi_max_at_deg"], expected["psi_min_at_deg"]), rel=0, abs=1e-9)


@every_rho
@pytest.mark.parametrize("name", EXTREMES)
def test_largest_rates_equal_the_summary(rho, name):
    found, expected = ks.extremes(solution(rho), EXTREMES[name]), summary(rho)
    assert abs(found.largest) == pytest.approx(expected[name], rel=1e-13)
    place = clockwise_degrees(found.angle[np.argmax(np.abs(found.value))])
    assert place == pytest.approx(expected[name + "_at_deg"], rel=0, abs=1e-9)


def figures():
    """The figures the study prints, as we find them."""
    swings = [swing(solution(rho)) for rho in RHO]
    speeds = [abs(ks.extremes(solution(rho), "rocker_rate").largest) for rho in RHO]
    return {
        "eta at 0.1": swings[0].asymmetry,
        "eta at 0.5": swings[1].asymmetry,
        "amplitude ratio": swings[1].largest / swings[0].largest,
        "speed at 0.1": speeds[0],
        "speed at 0.5": speeds[1],
        "speed ratio": speeds[1] / speeds[0],
    }


def test_amplitude_and_speed_ratios_equal_summary():
    found = figures()
    assert found["amplitude ratio"] == pytest.approx(float(four_bar_data("summary")["amplitude_ratio"]), rel=1e-13)
    assert found["speed ratio"] == pytest.approx(float(four_bar_data("summary")["speed_ratio"]), rel=1e-13)


@pytest.mark.parametrize(
    ("name", "recomputed", "printed", "rounding"),
    [
        ("eta at 0.1", "0.90436", "0.9", ROUND_DOWN),
        ("eta at 0.5", "0.55778", "0.56", ROUND_HALF_UP),
        ("amplitude ratio", "6.88552", "6.88", ROUND_DOWN),
        ("speed at 0.1", "0.151009", "0.151", ROUND_DOWN),
        ("speed at 0.5", "1.145557", "1.145", ROUND_DOWN),
        ("speed ratio", "7.58599", "7.58", ROUND_DOWN),
    ],
)
def test_printed_digits_are_ours_cut_off(name, recomputed, printed, rounding):
    """0.55778 is printed as 0.56; had 6.8855, 1.14556 and 7.58599 been rounded, their last digit would differ."""
    ours = Decimal(float(figures()[name]))
    assert ours.quantize(Decimal(recomputed), ROUND_HALF_UP) == Decimal(recomputed)
    assert ours.quantize(Decimal(printed), rounding) == Decimal(printed)
