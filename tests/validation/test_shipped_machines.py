"""Shipped cases of whole machines against hand calculation: numbers of their drawings stand here once more."""

from functools import cache
from math import asin, cos, hypot, pi, radians, sin, sqrt

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every
from support.machines import second_harmonic

MACHINES = (
    "compressor",
    "pumpjack",
    "shaper",
    "v_twin",
    "in_line_twin",
    "sawframe_2r63_cutting",
    "toggle_press",
    "yoke_pump",
    "mower_drives",
)
case = cache(ks.load_case)


def fine(name, variant):
    """Solution at many angles, for means of what has kinks."""
    return case(name).solve(variant, angles=7200)


@pytest.mark.parametrize("name", MACHINES)
def test_shipped_variants_balance_their_powers(name):
    for variant in case(name).variants:
        s = case(name).solve(variant)
        assert s.power_residual < 1e-12
        assert np.isfinite(s.balancing_torque).all()


@every("name", MACHINES)
def test_shipped_machines_name_their_sources(name):
    assert "ssumed" in case(name).source


# Compressor: bore 100 mm, stroke 100 mm, clearance 5 mm, 1 to 6 bar, exponent 1.4

AREA = 78.54e-4


def test_compressor_torque_is_its_indicator_work():
    """Work n / (n - 1) p1 V ((p2 / p1)^((n - 1) / n) - 1) with V drawn in; chords lie above the lines."""
    n, ratio = 1.4, 6.0
    drawn_in = AREA * (0.105 - 0.005 * ratio ** (1 / n))
    work = n / (n - 1) * 1e5 * drawn_in * (ratio ** ((n - 1) / n) - 1)
    assert 2 * pi * np.mean(fine("compressor", "loaded").balancing_torque) == pytest.approx(work, rel=2e-3)


def test_compressor_gas_acts_by_travel_slope():
    """At 300 degrees, half way of compression: x = r cos + sqrt(l^2 - r^2 sin^2)."""
    loaded, idle = (case("compressor").solve(name, angles=12) for name in ("loaded", "unloaded"))
    r, rod, angle = 0.05, 0.2, radians(300)
    root = sqrt(rod**2 - (r * sin(angle)) ** 2)
    travel, slope = r * cos(angle) + root, -r * sin(angle) * (1 + r * cos(angle) / root)
    pressure = 1e5 * ((0.105 / (0.255 - travel)) ** 1.4 - 1)
    found = loaded.balancing_torque[10] - idle.balancing_torque[10]
    assert found == pytest.approx(pressure * AREA * slope, rel=2e-3)


# Frame saw in a log: 60 MPa, 8 saws, 3.6 mm, 250 mm, 20 mm, 320 rpm, stroke 600 mm


@every("way", ("", "cam-"))
def test_saw_cuts_by_the_volume_of_wood(way):
    idle, cutting = (case("sawframe_2r63_cutting").solve(f"{way}{name}") for name in ("idle", "cutting"))
    assert cutting.losses.drive == pytest.approx(60e6 * 8 * 3.6e-3 * 0.25 * 0.02 * 320 / 60, rel=1e-12)
    assert idle.losses.drive == pytest.approx(0.0, abs=1e-8)
    on = cutting.slider_velocity < 0
    couple = 0.2 * 14.4e3 * (cutting.loads[-1].foot(cutting) - cutting.slider_position)  # of the thrust about B
    np.testing.assert_allclose((cutting.guide_moment - idle.guide_moment + couple * on)[1:], 0.0, atol=1e-8)
    assert np.ptp(couple) == pytest.approx(0.2 * 14.4e3 * 0.6, rel=1e-3)


# Pumpjack: R .95, P 3.1, C 2.45, A 2.8, pivot (-2.45, 3.1) m; 40 kN and 30 kN


@pytest.mark.parametrize("degrees", [0.0, 30.0, 150.0, 290.0])
def test_pumpjack_torque_factor_is_of_triangles(degrees):
    """A R sin(alpha) / (C sin(beta)): alpha between crank and pitman, beta between pitman and beam (API 11E)."""
    mechanism = case("pumpjack").variants["weights"].mechanism
    s = ks.solve(mechanism, radians(degrees), crank_speed=0.0, loads=ks.Torque(2.8, on="rocker"))
    crank_pin = 0.95 * np.exp(1j * radians(degrees))
    to_bearing = complex(-2.45, 3.1) - crank_pin
    distance = abs(to_bearing)
    at_pin = np.arccos((3.1**2 + distance**2 - 2.45**2) / (2 * 3.1 * distance))
    pitman = to_bearing / distance * np.exp(-1j * at_pin)
    tail = crank_pin + 3.1 * pitman - complex(-2.45, 3.1)
    sin_alpha = (pitman / crank_pin).imag * 0.95
    sin_beta = (pitman / tail).imag * 2.45
    assert abs(tail) == pytest.approx(2.45, rel=1e-14)
    assert float(s.balancing_torque) == pytest.approx(-2.8 * 0.95 * sin_alpha / (2.45 * sin_beta), rel=1e-12)


def test_pumpjack_weights_relieve_the_torque():
    plain, weights = (case("pumpjack").solve(name) for name in ("no-weights", "weights"))
    moment = (4800 * 1.225 - 1200 * 0.7) * 9.81 * np.cos(plain.crank_angle)
    np.testing.assert_allclose(weights.balancing_torque - plain.balancing_torque, moment, atol=1e-9 * 5e4)
    assert np.abs(weights.balancing_torque).max() < 0.4 * np.abs(plain.balancing_torque).max()


def test_pumpjack_mean_torque_lifts_the_fluid():
    """30 kN over the stroke, but for the corners that the load takes 20 degrees of crank angle to round."""
    s = fine("pumpjack", "weights")
    stroke = np.ptp(s.position("H")[1])
    assert stroke == pytest.approx(2 * 2.8 * 0.95 / 2.45, rel=0.02)
    assert 2 * pi * abs(np.mean(s.balancing_torque)) == pytest.approx(30e3 * stroke, rel=0.03)


# Shaper: centres 240 mm, crank 120 mm, lever 450 mm; 4 kN over 400 mm


def test_shaper_time_ratio_is_of_its_drawing():
    swing = asin(120 / 240)
    forward = np.mean(fine("shaper", "cutting").slider_velocity > 0)
    assert (pi + 2 * swing) / (pi - 2 * swing) == pytest.approx(2.0, rel=1e-15)
    assert forward / (1 - forward) == pytest.approx(2.0, rel=2e-3)


def test_shaper_turns_back_at_its_stroke_ends():
    found = ks.extremes(case("shaper").solve("idle"), "slider_position")
    assert np.ptp(found.range) == pytest.approx(2 * 450e-3 * 120 / 240, rel=1e-13)
    assert np.degrees(found.angle) == pytest.approx([210, 330], abs=1e-6)


def test_shaper_mean_torque_is_the_work_of_its_cut():
    """4 kN over 396 mm, and ramps of 2 mm at both ends."""
    assert 2 * pi * np.mean(fine("shaper", "cutting").balancing_torque) == pytest.approx(4e3 * 0.398, rel=1e-4)
    assert abs(np.mean(fine("shaper", "idle").balancing_torque)) < 1e-9


# Twins: r 33 mm, l 120 mm, 6000 rpm; reciprocating .4 + .36 / 3, turning .36 * 2 / 3 for each rod

R, ROD, SPEED = 0.033, 0.120, 200 * pi
TO_AND_FRO, TURNING = 0.52, 0.24


def harmonics(name, variant, order):
    """Cosine and sine coefficients of the shaking force, complex, in units of r omega^2: kg."""
    s = case(name).solve(variant, angles=64)
    force = (s.shaking_force[0] + 1j * s.shaking_force[1]) / (R * SPEED**2)
    return 2 * np.mean(force * np.cos(order * s.crank_angle)), 2 * np.mean(force * np.sin(order * s.crank_angle))


def test_v_twin_shakes_by_its_pin_mass():
    cosine, sine = harmonics("v_twin", "plain", 1)
    assert cosine == pytest.approx(2 * TURNING + TO_AND_FRO, rel=1e-12)
    assert sine == pytest.approx(1j * (2 * TURNING + TO_AND_FRO), rel=1e-12)
    cosine, sine = harmonics("v_twin", "plain", 2)
    assert abs(cosine) < 1e-12
    assert sine == pytest.approx(sqrt(2) * TO_AND_FRO * second_harmonic(R / ROD), rel=1e-12)


def test_v_twin_counterweight_removes_first_harmonic():
    link = case("v_twin").variants["counterweight"].mechanism.links["crank"]
    assert link.mass * link.centre[0] == pytest.approx(-(2 * TURNING + TO_AND_FRO) * R, rel=1e-14)
    assert max(map(abs, harmonics("v_twin", "counterweight", 1))) < 1e-12
    assert harmonics("v_twin", "counterweight", 2) == pytest.approx(harmonics("v_twin", "plain", 2), rel=1e-12)


def test_gas_drives_over_two_turns_without_shaking():
    s, plain = (case("v_twin").solve(name, angles=1440) for name in ("firing", "counterweight"))
    assert s.period == pytest.approx(4 * pi)
    np.testing.assert_allclose(s.shaking_force, plain.at(s.crank_angle).shaking_force, rtol=1e-13)
    gas = s.balancing_torque - plain.at(s.crank_angle).balancing_torque
    by_hand = 0.0
    for number, bank in enumerate((pi / 4, 3 * pi / 4)):
        turned = s.crank_angle - bank
        slope = -R * np.sin(turned) * (1 + R * np.cos(turned) / np.sqrt(ROD**2 - (R * np.sin(turned)) ** 2))
        force = s.loads[number].force(s)
        assert force.max() <= 0.0  # never a vacuum in this cycle
        by_hand = by_hand - force * slope
    np.testing.assert_allclose(gas, by_hand, atol=1e-9)
    assert np.mean(gas) < 0


def test_opposed_throws_leave_the_second_harmonic():
    cosine, sine = harmonics("in_line_twin", "throws-together", 1)
    assert cosine == pytest.approx(2 * TURNING, rel=1e-12)
    assert sine == pytest.approx(2j * (TURNING + TO_AND_FRO), rel=1e-12)
    assert max(map(abs, harmonics("in_line_twin", "throws-opposed", 1))) < 1e-12
    for variant in ("throws-together", "throws-opposed"):
        cosine, sine = harmonics("in_line_twin", variant, 2)
        assert cosine == pytest.approx(-2j * TO_AND_FRO * second_harmonic(R / ROD), rel=1e-12)
        assert abs(sine) < 1e-12


# Toggle press: r 85 mm, rod 512 mm, links 300 mm, knuckle pivot (600, 350) mm


@pytest.mark.parametrize("degrees", [300.0, 335.0, 350.0])
def test_press_force_ratio_is_of_its_toggle(degrees):
    """Tilt t of both links: the rod pushes across by F (tan t + tan t) less what its own tilt does."""
    mechanism = case("toggle_press").variants["idle"].mechanism
    s = ks.solve(mechanism, radians(degrees), crank_speed=0.0, loads=ks.ProcessForce(-1.0, on="slider2"))
    pin = 0.085 * np.exp(1j * radians(degrees))
    pivot = complex(0.6, 0.35)
    to_pivot = pivot - pin
    opening = np.arccos((0.512**2 + abs(to_pivot) ** 2 - 0.3**2) / (2 * 0.512 * abs(to_pivot)))
    rod = to_pivot / abs(to_pivot) * np.exp(-1j * opening)
    knuckle = pin + 0.512 * rod
    tilt = np.arcsin((0.6 - knuckle.real) / 0.3)
    push = 2 * np.tan(tilt) / (rod.real - rod.imag * np.tan(tilt))
    assert hypot(*s.reaction("A")) == pytest.approx(push, rel=1e-11)
    assert float(s.balancing_torque) == pytest.approx(push * (rod / pin).imag * 0.085**2, rel=1e-11)


def test_press_works_near_its_dead_centre():
    s = fine("toggle_press", "coining")
    work = 2 * pi * np.mean(s.balancing_torque)
    lowest = ks.extremes(s, "slider2_position").range[1]
    assert lowest == pytest.approx(0.3 + 0.3 - 0.35, abs=1e-3)
    assert work == pytest.approx(400e3 * 0.003 / 2 + 400e3 * (lowest - 0.2499), rel=2e-3)
    assert np.abs(fine("toggle_press", "idle").balancing_torque).max() < 0.2 * s.balancing_torque.max()


# Scotch yoke: r 40 mm, 120 rpm; 60 bar out, -0.3 bar back on 12.57 cm^2


def test_the_yoke_moves_by_a_pure_cosine():
    s = case("yoke_pump").solve("pumping")
    np.testing.assert_allclose(s.slider_position, 0.04 * np.cos(s.crank_angle), atol=1e-16)
    np.testing.assert_allclose(s.slider_acceleration, -0.04 * (4 * pi) ** 2 * np.cos(s.crank_angle), atol=1e-14)


def test_the_power_of_the_pump_is_flow_times_pressure():
    s = fine("yoke_pump", "pumping")
    flow = 12.57e-4 * 0.08 * 120 / 60
    assert 4 * pi * np.mean(s.balancing_torque) == pytest.approx(60.3e5 * flow, rel=1e-5)


def test_pump_torque_is_force_times_sine_arm():
    pumping, idle = (case("yoke_pump").solve(name) for name in ("pumping", "idle"))
    sine = np.sin(pumping.crank_angle)
    pressure = np.where(sine < 0, 60e5, -0.3e5)
    gas = -pressure * 12.57e-4 * 0.04 * sine
    np.testing.assert_allclose(pumping.balancing_torque - idle.balancing_torque, gas, atol=1e-11)
