"""Crank-sliders worked in textbooks: printed values, the book's own model, and the exact values.

K: R. S. Khurmi and J. K. Gupta, *Theory of Machines*. U: J. J. Uicker, G. R. Pennock and J. E. Shigley, *Theory of
Machines and Mechanisms*. Crank angles count from the inner dead centre (slider farthest from O); gas load acts on the
slider toward the crank, and speed and acceleration of the slider are positive that way.

K computes motion with two harmonics, from which the exact motion differs by up to 0.5 per cent (2 per cent for the
rod). Each test therefore proves two things: the model of two harmonics, written out here, meets the printed figures
(PRINTED allows for what the book rounds on its way), and the library meets the exact ones to all documented digits.
"""

from decimal import Decimal
from math import acos, asin, cos, degrees, pi, radians, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
import pytest

import kinetostatics as ks

PRINTED = 1e-3
RPM = 2 * pi / 60
G = 9.81


class TwoHarmonics(NamedTuple):
    """Slider and rod of K, chapter 15; `rod_*` taken positive as printed."""

    speed: float
    acceleration: float
    rod_rate: float
    rod_acceleration: float
    obliquity: float

    @classmethod
    def of(cls, r, length, rpm, crank_degrees):
        """At a crank angle from the inner dead centre."""
        n, angle, speed = length / r, radians(crank_degrees), rpm * RPM
        return cls(
            speed * r * (sin(angle) + sin(2 * angle) / (2 * n)),
            speed**2 * r * (cos(angle) + cos(2 * angle) / n),
            speed * cos(angle) / n,
            speed**2 * sin(angle) / n,
            asin(sin(angle) / n),
        )


def area(diameter, inner=0.0):
    return pi / 4 * (diameter**2 - inner**2)


def machine(r, length, rpm, crank_degrees, *, slider=0.0, rod=ks.Link(), gas=0.0, vertical=False, weight=False):
    """The exact solution; a vertical machine has its cylinder above the crank and always weighs."""
    guide = pi / 2 if vertical else 0.0
    gravity = [ks.Gravity(G)] if vertical or weight else []
    return ks.solve(
        ks.crank_slider(r, length, guide_angle=guide, coupler=rod, slider=ks.Link(slider)),
        np.radians(crank_degrees) + guide,
        crank_speed=rpm * RPM,
        loads=[ks.ProcessForce(-gas), *gravity],
    )


def rod_force(solution):
    return np.hypot(*solution.reaction("B"))


def turning_moment(thrust, obliquity, r, crank_degrees):
    """K: of the piston thrust on the crank, exact for a given thrust."""
    angle = radians(crank_degrees)
    return thrust * r * sin(angle + obliquity) / cos(obliquity)


def printed(value):
    return pytest.approx(value, rel=PRINTED)


def exact(figures):
    """A documented exact value, to one unit of its last digit: some are cut off, not rounded."""
    return pytest.approx(float(figures), rel=0, abs=10.0 ** Decimal(figures).as_tuple().exponent)


def test_k_15_3_greatest_speed_of_the_slider():
    """K example 15.3: r 0.3 m, l 1 m, 200 rpm; printed 6.54 m/s at 75 deg."""
    n = 1 / 0.3
    assert degrees(acos((-n + sqrt(n**2 + 8)) / 4)) == pytest.approx(75, abs=0.5)
    assert TwoHarmonics.of(0.3, 1.0, 200, 75).speed == printed(6.54)

    found = ks.extremes(machine(0.3, 1.0, 200, 0.0), "slider_velocity")
    assert -found.value[0] == exact("6.56173")
    assert np.degrees(found.angle[0]) == exact("74.5289")


def test_k_15_4_speed_and_acceleration():
    """K example 15.4: r 0.3 m, l 1.5 m, 180 rpm, 40 deg; printed 4.19 m/s, 85.36 m/s2."""
    book = TwoHarmonics.of(0.3, 1.5, 180, 40)
    assert book.speed == pytest.approx(4.19, abs=0.01)
    assert book.acceleration == printed(85.36)

    s = machine(0.3, 1.5, 180, 40)
    assert -s.slider_velocity == exact("4.196434")
    assert -s.slider_acceleration == exact("85.59886")


def test_k_15_5_slider_and_rod():
    """K example 15.5: r 0.15 m, l 0.6 m, 450 rpm, 60 deg; printed 6.9 m/s, 124.91 m/s2, 5.9 rad/s, 481 rad/s2."""
    book = TwoHarmonics.of(0.15, 0.6, 450, 60)
    assert (round(book.speed, 1), round(book.rod_rate, 1)) == (6.9, 5.9)
    assert (book.acceleration, book.rod_acceleration) == (printed(124.91), printed(481))

    s = machine(0.15, 0.6, 450, 60)
    assert -s.slider_velocity == exact("6.905359")
    assert -s.slider_acceleration == exact("124.94934")
    assert -s.rate("coupler") == exact("6.033596")
    assert s.angular_acceleration("coupler") == exact("484.3947")


def test_k_15_7_guide_rod_and_torque():
    """K example 15.7: r 0.3 m, l 1.2 m, bore 0.5 m, 0.35 MPa net, 250 kg, 250 rpm, 60 deg.

    Printed: guide 10.97 kN, rod 50.65 kN, torque 14.491 kN m, which drives the crank.
    """
    gas = 0.35e6 * area(0.5)
    book = TwoHarmonics.of(0.3, 1.2, 250, 60)
    thrust = gas - 250 * book.acceleration
    assert thrust * tan(book.obliquity) == printed(10.97e3)
    assert thrust / cos(book.obliquity) == printed(50.65e3)
    assert turning_moment(thrust, book.obliquity, 0.3, 60) == printed(14.491e3)

    s = machine(0.3, 1.2, 250, 60, slider=250, gas=gas)
    assert s.guide_force == exact("10.9641e3")
    assert rod_force(s) == exact("50.6412e3")
    assert -s.balancing_torque == exact("14.48952e3")


def test_k_15_8_vertical_double_acting_engine():
    """K example 15.8: r 0.225 m, l 1.2 m, bore 0.3 m, piston rod 0.05 m, 30 and 1.5 kPa, 225 kg, 200 rpm, 125 deg.

    Printed: 3020 N m, which drives the crank. The documented exact value, 3017.12, takes the gas load as 2017 N.
    """
    gas = 30e3 * area(0.3) - 1.5e3 * area(0.3, 0.05)
    book = TwoHarmonics.of(0.225, 1.2, 200, 125)
    thrust = gas - 225 * book.acceleration + 225 * G
    assert turning_moment(thrust, book.obliquity, 0.225, 125) == printed(3020)

    s = machine(0.225, 1.2, 200, 125, slider=225, gas=round(gas), vertical=True)
    assert -s.balancing_torque == exact("3017.12")


def test_k_15_9_petrol_engine():
    """K example 15.9: r 0.05 m, l 0.2 m, bore 0.08 m, 0.7 MPa, 1 kg, 1800 rpm, 33 deg.

    Printed: gudgeon pin 1848 N, rod 1865.8 N, wall 254 N.
    """
    gas = 0.7e6 * area(0.08)
    book = TwoHarmonics.of(0.05, 0.2, 1800, 33)
    thrust = gas - book.acceleration
    assert thrust == printed(1848)
    assert thrust / cos(book.obliquity) == printed(1865.8)
    assert thrust * tan(book.obliquity) == printed(254)

    s = machine(0.05, 0.2, 1800, 33, slider=1, gas=gas)
    assert s.reaction("B")[0] == exact("1840.4")
    assert rod_force(s) == exact("1857.7")
    assert s.guide_force == exact("252.9")


def test_k_15_11_vertical_petrol_engine():
    """K example 15.11: r 0.06 m, l 0.25 m, bore 0.1 m, 700 kPa, 1.1 kg, 2000 rpm, 20 deg.

    Printed: net force 2255.6 N, rod 2265 N, wall 185.4 N (the last with the obliquity rounded to 4.7 deg).
    """
    gas = 700e3 * area(0.1)
    book = TwoHarmonics.of(0.06, 0.25, 2000, 20)
    thrust = gas - 1.1 * book.acceleration + 1.1 * G
    assert thrust == printed(2255.6)
    assert thrust / cos(book.obliquity) == printed(2265)
    assert round(degrees(book.obliquity), 1) == 4.7
    assert thrust * tan(radians(4.7)) == printed(185.4)

    s = machine(0.06, 0.25, 2000, 20, slider=1.1, gas=gas, vertical=True)
    assert s.reaction("B")[1] == exact("2249.85")
    assert rod_force(s) == exact("2257.47")
    assert s.guide_force == exact("185.30")


def test_k_15_12_double_acting_engine():
    """K example 15.12: r 0.2 m, l 0.6 m, bore 0.25 m, piston rod 0.05 m, 550 and 70 kPa, 60 kg, 120 rpm, 45 deg.

    Printed: 3929.03 N m, which drives the crank.
    """
    gas = 550e3 * area(0.25) - 70e3 * area(0.25, 0.05)
    book = TwoHarmonics.of(0.2, 0.6, 120, 45)
    assert turning_moment(gas - 60 * book.acceleration, book.obliquity, 0.2, 45) == printed(3929.03)

    s = machine(0.2, 0.6, 120, 45, slider=60, gas=gas)
    assert -s.balancing_torque == exact("3925.667")


def test_k_15_17_and_18_rod_as_two_masses():
    """K examples 15.17 and 15.18: rod 2 kg, l 0.25 m, mass centre 0.1 m from the small end, k_G 0.11 m, 23000 rad/s2.

    Printed: 1.1 and 0.9 kg, the second 0.121 m beyond the mass centre; with masses at the two ends instead, a couple of
    133.4 N m is missing. The rod hangs here as a crank turning about its small end: torque on it is inertia.
    """

    def torque(*links):
        hung = (ks.crank_slider(1.0, 9.0, crank=link) for link in links)
        return sum(ks.solve(one, 0.0, crank_speed=7.0, crank_acceleration=23000.0).balancing_torque for one in hung)

    rod = ks.Link(2.0, 0.1, 2.0 * 0.11**2)
    beyond = 0.11**2 / 0.1
    second = 2.0 * 0.1 / (0.1 + beyond)
    assert (round(2.0 - second, 1), round(second, 1), round(beyond, 3)) == (1.1, 0.9, 0.121)
    assert torque(ks.Link(2.0 - second), ks.Link(second, 0.1 + beyond)) == pytest.approx(torque(rod), rel=1e-14)

    at_the_ends = torque(ks.Link(2.0 * 0.15 / 0.25), ks.Link(2.0 * 0.1 / 0.25, 0.25))
    assert at_the_ends - torque(rod) == pytest.approx(133.4, rel=1e-12)


def test_k_15_20_heavy_rod():
    """K example 15.20: stroke 0.6 m, l 1.5 m, rod 250 kg with mass centre 0.5 m from the crank pin and k_G 0.65 m,
    slider 300 kg, 125 rpm, 30 deg, gravity across the stroke.

    Printed: 3840 N m. The book puts the rod's mass at its ends, corrects its inertia by a couple, adds the weight at
    the crank pin, and rounds the speed to 13.1 rad/s.
    """
    book = TwoHarmonics.of(0.3, 1.5, 13.1 / RPM, 30)
    at_slider, at_pin = 250 * 0.5 / 1.5, 250 * 1.0 / 1.5
    inertia = turning_moment((300 + at_slider) * book.acceleration, book.obliquity, 0.3, 30)
    couple = 250 * (0.5 * 1.0 - 0.65**2) * book.rod_acceleration * book.rod_rate / 13.1
    weight = at_pin * G * 0.3 * cos(radians(30))
    assert inertia + couple + weight == printed(3840)

    rod = ks.Link(250, 0.5, 250 * 0.65**2)
    light = machine(0.3, 1.5, 125, 30, slider=300, rod=rod)
    heavy = machine(0.3, 1.5, 125, 30, slider=300, rod=rod, weight=True)
    assert light.balancing_torque == exact("3415.723")
    assert heavy.balancing_torque - light.balancing_torque == exact("424.785")
    assert heavy.balancing_torque == exact("3840.509")


def test_u_p11_2_static_force():
    """U problem 11.2: r 75 mm, l 350 mm, at rest, 105 deg, 900 N on the slider.

    Printed: rod 920 N, guide 190 N, torque 61.4 N m (0.2 per cent low).
    """
    s = machine(0.075, 0.35, 0.0, 105, gas=900)
    assert rod_force(s) == exact("919.92")
    assert s.guide_force == exact("190.41")
    assert -s.balancing_torque == exact("61.504")
    assert (rod_force(s), s.guide_force, -s.balancing_torque) == (
        pytest.approx(920, rel=1e-3),
        pytest.approx(190, rel=3e-3),
        pytest.approx(61.4, rel=2e-3),
    )
