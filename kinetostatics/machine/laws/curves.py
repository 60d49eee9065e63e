"""Standard rises of cam design, from 0 to 1 over an angle of 1, with three exact derivatives.

The sine-constant-cosine family (Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 3) includes the
harmonic, cycloidal, modified sine (Neklutin) and modified trapezoid curves. Sums of powers include the 3-4-5 and
4-5-6-7 polynomials (Rothbart, *Cam Design Handbook*, 2004, chapter 3).
"""

import math
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from ...numbers.formatting import with_units


@with_units()
class Motion(NamedTuple):
    """Position and three derivatives by the crank angle, m, m/rad, m/rad2, m/rad3; pure numbers for a rise.

    Attributes
    ----------
    position, velocity, acceleration, jerk : array (..., N)

    Examples
    --------
    >>> import kinetostatics as ks
    >>> motion = ks.laws.cosine(0.3, 2.0)(0.5)
    >>> round(float(motion.position), 6), round(float(motion.jerk), 6)
    (2.263275, 0.143828)
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    jerk: np.ndarray


class Coefficients(NamedTuple):
    """Largest sizes of velocity, acceleration and jerk of a rise of 1 over 1."""

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True)
class SineConstantCosine:
    """A rise whose acceleration is a quarter sine, a constant, half a cosine, a constant, and a quarter sine.

    `sines` is the share of the angle of both quarter sines, 0 or more; `cosine` the share of the half cosine.
    """

    sines: float
    cosine: float

    @property
    def breaks(self):
        """Places from 0 to 1 at which the jerk may jump."""
        first, second = self.sines / 2, (1.0 - self.cosine) / 2
        return (0.0, *sorted({first, second, 1.0 - second, 1.0 - first} - {0.0, 1.0}), 1.0)

    @property
    def coefficients(self):
        b, d = self.sines, self.cosine
        top, shortest = self._acceleration, min(b or d, d)
        return Coefficients(top * ((b + d) / math.pi + (1.0 - b - d) / 2), top, top * math.pi / shortest)

    @property
    def _acceleration(self):
        b, d, pi = self.sines, self.cosine, math.pi
        return 4 * pi**2 / ((pi**2 - 8) * (b * b - d * d) - 2 * pi * (pi - 2) * b + pi**2)

    def __call__(self, u):
        """Motion at places u from 0 to 1; the second half is the first, rotated about the middle."""
        late = u > 0.5
        u = np.where(late, 1.0 - u, u)
        b, d, pi, top = self.sines, self.cosine, math.pi, self._acceleration
        start, speed = (1.0 - d) / 2, b / pi + (1.0 - b - d) / 2
        base = b * b * (0.125 - 1.0 / pi**2)
        rising, falling = pi / b * u if b else u, pi / d * (u - start)
        zones = [
            lambda: (
                b / pi * (u - b / pi * np.sin(rising)),
                b / pi * (1.0 - np.cos(rising)),
                np.sin(rising),
                pi / b * np.cos(rising),
            ),
            lambda: (u * u / 2 + b * (1.0 / pi - 0.5) * u + base, u + b * (1.0 / pi - 0.5), 1.0 + 0.0 * u, 0.0 * u),
            lambda: (
                speed * u + (d / pi) ** 2 * (1.0 - np.cos(falling)) + base - start * start / 2,
                speed + d / pi * np.sin(falling),
                np.cos(falling),
                -pi / d * np.sin(falling),
            ),
        ]
        found = np.full((4, *np.shape(u)), np.nan)
        within = [u < b / 2, (u >= b / 2) & (u < start), u >= start]
        for inside, zone in zip(within, zones, strict=True):
            if np.any(inside):
                found = np.where(inside, zone(), found)
        position, velocity, acceleration, jerk = top * found
        return Motion(
            np.where(late, 1.0 - position, position), velocity, np.where(late, -acceleration, acceleration), jerk
        )


@dataclass(frozen=True)
class Powers:
    """A rise by powers: the coefficient of power n is the product of m / (m - n) over the other powers m."""

    powers: tuple[int, ...]

    breaks: ClassVar = (0.0, 1.0)

    @property
    def _polynomial(self):
        found = [0.0] * (max(self.powers) + 1)
        for one in self.powers:
            others = [other for other in self.powers if other != one]
            found[one] = math.prod(others) / math.prod(other - one for other in others)
        return np.polynomial.Polynomial(found)

    @property
    def coefficients(self):
        peaks = []
        for order in (1, 2, 3):
            curve = self._polynomial.deriv(order)
            roots = curve.deriv().roots()
            inner = roots.real[(abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)]
            peaks.append(float(np.max(np.abs(curve(np.concatenate([[0.0, 1.0], inner]))))))
        return Coefficients(*peaks)

    def __call__(self, u):
        """Motion at places u from 0 to 1; the second half is expanded at its end, so its zeros there are exact."""
        curve, late = self._polynomial, u > 0.5
        mirrored = curve(1.0) - curve(np.polynomial.Polynomial([1.0, -1.0]))
        ahead, behind = np.where(late, 0.0, u), np.where(late, 1.0 - u, 0.0)
        position, *others = (
            np.where(late, -((-1) ** order) * mirrored.deriv(order)(behind), curve.deriv(order)(ahead))
            for order in range(4)
        )
        return Motion(np.where(late, position + 1.0, position), *others)


@dataclass(frozen=True)
class Rest:
    """A dwell: no rise."""

    breaks: ClassVar = (0.0, 1.0)
    coefficients: ClassVar = Coefficients(0.0, 0.0, 0.0)

    def __call__(self, u):
        return Motion(*(0.0 * u for _ in range(4)))


HARMONIC = SineConstantCosine(0.0, 1.0)
CYCLOIDAL = SineConstantCosine(0.5, 0.5)
MODIFIED_SINE = SineConstantCosine(0.25, 0.75)
MODIFIED_TRAPEZOID = SineConstantCosine(0.25, 0.25)
