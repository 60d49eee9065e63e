"""Formulas of engine theory."""

from math import comb

from scipy.special import binom


def second_harmonic(ratio):
    """A2 = lambda + lambda^3 / 4 + 15 lambda^5 / 128 + ... of the acceleration of a piston, lambda = crank / rod.

    From the binomial series of sqrt(1 - lambda^2 sin^2 phi) and the second cosine coefficients of its powers.
    """
    return sum(-8 * (-1) ** k * binom(0.5, k) * comb(2 * k, k - 1) / 4**k * ratio ** (2 * k - 1) for k in range(1, 40))
