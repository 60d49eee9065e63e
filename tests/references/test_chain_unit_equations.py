"""The chain unit study's equations (8)-(14), (17)-(22) and their relative forms, against 50-digit tables and ours.

As printed; plus and minus signs, which our copy has lost, follow from the study's own derivation. In the relative form
of the coupler's acceleration the study prints b, which there is b / l. Of its relative rates our copy keeps the letters
of the divisors, lambda^2 + 1 - 2 eta and the root of lambda^2 - eta^2; its dividends are those of (10) and (18).
"""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies.methods.papers import chain_unit_accelerations, chain_unit_by_atan_acos
from support.case_files import four_bar_table
from support.machines import largest

LAMBDA = 2 / 3
CLOSE = 2e-15
"""Relative to the largest of a column."""


def relative_form(rho, lam, angle):
    """Angular accelerations of coupler and rocker, relative to the square of the crank's speed, with eta and eta1."""
    eta1 = np.sqrt(lam**2 - rho**2 + 1)
    phi = angle - (np.pi / 2 + np.arctan(lam / np.sqrt(1 - rho**2)))
    sine, cosine = np.sin(phi), np.cos(phi)
    eta = eta1 * rho * cosine
    a1 = np.sqrt(rho**2 + eta1**2 - 2 * eta)
    k1, k1_ = a1**2, 2 * rho * eta1 * sine
    p1 = -(np.sqrt(1 - rho**2) * np.sin(angle) - lam * np.cos(angle) - rho)
    p1_ = -(np.sqrt(1 - rho**2) * np.cos(angle) + lam * np.sin(angle))
    v, v_, u, u_ = k1, k1_, sine, cosine
    s2, s3 = k1 + 1 - lam**2 - 2 * k1, k1 + lam**2 - 1 - 2 * k1
    s_ = -2 * rho * eta1 * sine
    w2 = np.sqrt(4 * k1 - (k1 + 1 - lam**2) ** 2)
    w3 = np.sqrt(4 * lam**2 * k1 - (k1 + lam**2 - 1) ** 2)
    w2_ = 2 * rho * eta1 * sine * (2 - (k1 + 1 - lam**2)) / w2
    w3_ = 2 * rho * eta1 * sine * (2 * lam**2 - (k1 + lam**2 - 1)) / w3

    def braces(s, w, w_):
        return u * (w * s_ - w_ * s) / (v * w**2) + s * (v * u_ - u * v_) / (w * v**2)

    coupler = rho * ((k1 * p1_ - p1 * k1_) / k1**2 - eta1 * braces(s2, w2, w2_))
    rocker = eta1 * rho * (sine * (k1 + 2 * rho * (eta1 * cosine - rho)) / a1**4 + braces(s3, w3, w3_))
    return coupler, rocker


def relative_rates(rho, lam, angle):
    """Angular velocities of coupler and rocker, relative to the crank's, with eta and eta1."""
    eta1 = np.sqrt(lam**2 - rho**2 + 1)
    phi = angle - (np.pi / 2 + np.arctan(lam / np.sqrt(1 - rho**2)))
    eta = eta1 * rho * np.cos(phi)
    square, root = lam**2 + 1 - 2 * eta, np.sqrt(lam**2 - eta**2)
    p1 = -(np.sqrt(1 - rho**2) * np.sin(angle) - lam * np.cos(angle) - rho)
    coupler = rho * (p1 - eta1 * np.sin(phi) * (eta - lam**2) / root) / square
    rocker = rho * (-(eta1 * np.cos(phi) - rho) + eta1 * np.sin(phi) * (eta - 1) / root) / square
    return coupler, rocker


def in_lengths(rho, lam, angle):
    return chain_unit_accelerations(rho, 1.0, lam, np.sqrt((1 - rho) * (1 + rho)), angle)


@pytest.mark.parametrize("form", [in_lengths, relative_form])
@pytest.mark.parametrize("rho", [0.1, 0.5])
def test_printed_accelerations_equal_the_50_digit_tables(rho, form):
    expected = four_bar_table(rho)
    coupler, rocker = form(rho, LAMBDA, np.radians(expected["angle_deg"]))
    assert largest(coupler + expected["e_AB"]) < CLOSE * largest(expected["e_AB"])  # the table counts the other way
    assert largest(rocker - expected["e_h"]) < CLOSE * largest(expected["e_h"])


def rates_in_lengths(rho, lam, angle):
    """Equations (10) and (18), with the lengths rho, 1, lambda."""
    return chain_unit_by_atan_acos(rho, 1.0, lam, np.sqrt((1 - rho) * (1 + rho)), angle)[2:]


@pytest.mark.parametrize("form", [rates_in_lengths, relative_rates])
@pytest.mark.parametrize("rho", [0.1, 0.5])
def test_printed_rates_equal_the_50_digit_tables(rho, form):
    expected = four_bar_table(rho)
    coupler, rocker = form(rho, LAMBDA, np.radians(expected["angle_deg"]))
    assert largest(coupler + expected["w_AB"]) < CLOSE * largest(expected["w_AB"])
    assert largest(rocker - expected["w_h"]) < CLOSE * largest(expected["w_h"])


@pytest.mark.parametrize("lengths", [(0.03, 0.3, 0.2, 0.28), (0.075, 0.3, 0.2, 0.28), (0.15, 0.3, 0.2, 0.26)])
def test_free_start_in_si_units_equals_ours(lengths):
    """Variant 2 of the study: the same equations, with the pivot's x given; at its faster speed."""
    angle = np.radians(np.arange(0.0, 360.0, 5.0))
    mechanism = ks.linkage.chain_unit(*lengths[:3], pivot_x=lengths[3])
    s = ks.solve(mechanism, ks.linkage.chain_unit_angle(angle), crank_speed=-62.8)
    for link, found in zip(("coupler", "rocker"), chain_unit_accelerations(*lengths, angle), strict=True):
        ours = -s.angular_acceleration(link)
        assert largest(62.8**2 * found - ours) < CLOSE * largest(ours)
