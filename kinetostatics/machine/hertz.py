"""Two cylinders pressed together: line contact by Hertz (Johnson, *Contact Mechanics*, 1985, section 4.2).

With 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, F the force, w the width, and 1/Re the sum of both curvatures

    p0 = sqrt(F E* / (pi w Re)),   half width b = sqrt(4 F Re / (pi w E*))
"""

import math

from ..numbers.arithmetic import sqrt


def modulus(one, other):
    """E* of two materials together, Pa, from (Young's modulus, Poisson's ratio) of each."""
    return 1.0 / (_compliance(*one) + _compliance(*other))


def _compliance(young, ratio):
    return (1.0 - ratio * ratio) / young


def pressure(force, width, modulus, radius):
    """Largest pressure in the contact, Pa; NaN where the radius is negative, as no body has such a surface."""
    return sqrt(abs(force) * modulus / (math.pi * width * radius))


def half_width(force, width, modulus, radius):
    """Half the width of the contact, m."""
    return sqrt(4.0 * abs(force) * radius / (math.pi * width * modulus))


def relative_radius(bend, roller_radius, side):
    """Radius of the cylinder that presses a plane as a roller does its cam, m, from the pitch curve's curvature.

    The working curve is the pitch curve moved by the roller's radius R, so that Re = R (1 - kappa R) on a disk inside
    it, side -1, and R (1 + kappa R) on a ring around it, side +1.
    """
    return roller_radius * (1.0 + side * bend * roller_radius)
