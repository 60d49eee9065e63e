"""Two cylinders pressed together: line contact by Hertz (Johnson, *Contact Mechanics*, 1985, section 4.2).

With 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, F the force, w the width, and 1/Re the sum of both curvatures

    p0 = sqrt(F E* / (pi w Re)),   half width b = sqrt(4 F Re / (pi w E*))
"""

import numpy as np


def modulus(materials):
    """E* of both materials together, Pa, from (Young's modulus, Poisson's ratio) of each."""
    return 1.0 / sum((1.0 - ratio * ratio) / young for young, ratio in materials)


def pressure(force, width, modulus, radius):
    """Largest pressure in the contact, Pa."""
    return np.sqrt(np.abs(force) * modulus / (np.pi * width * radius))


def half_width(force, width, modulus, radius):
    """Half the width of the contact, m."""
    return np.sqrt(4.0 * np.abs(force) * radius / (np.pi * width * modulus))


def relative_radius(bend, roller_radius, force):
    """Radius of the cylinder that presses a plane as a roller does its cam, m, from the pitch curve's curvature.

    The working curve is the pitch curve moved by the roller's radius R, so that Re = R (1 - kappa R) on a disk inside
    it, where the force is not positive, and R (1 + kappa R) on a ring around it.
    """
    return roller_radius * (1.0 + np.where(force > 0.0, 1.0, -1.0) * bend * roller_radius)
