"""A cam as a Fourier series: each harmonic a number of its own, so that designs may vary it."""

from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from ..numbers import checks
from ..numbers.planar import minus, plus, product, turned, unturned
from .cam import Cam
from .crank import ray as ray_at
from .links import present

GRID = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)
"""Crank angles at which the smallest radius is looked for, rad."""


@dataclass(frozen=True, eq=False)
class Harmonic(checks.Checked, Cam):
    """Cam whose radius is a Fourier series of the crank angle from the guide.

    r = a0 + a1 cos(psi) + a2 cos(2 psi) + ... + b1 sin(psi) + b2 sin(2 psi) + ...,  psi = phi - guide_angle

    Harmonics that are zero cost nothing; a scene calls the others "cam.cosine.2", "cam.sine.1".

    Parameters
    ----------
    cosine : sequence of float or array
        a0, a1, a2, ... in m; the mean radius a0 is greater than 0.
    sine : sequence of float or array
        b1, b2, ... in m.
    guide_angle : float
        Direction from which the angle counts, rad from +x.

    Raises
    ------
    ParameterError
        A value is not finite, or the mean radius not positive; when a scene is solved: the radius falls to 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Harmonic(cosine=(0.3, 0.02), sine=(0.0, 0.005))
    >>> [round(float(part), 6) for part in cam.radius(0.0)]
    [0.32, 0.01, -0.02]
    """

    cosine: Any
    sine: Any = ()
    guide_angle: Any = 0.0

    ELEMENTWISE = True
    RULES = checks.Rules(
        "harmonic cam",
        cosine=checks.Series("m", letter="a", first=checks.Number("m", low=0.0, strict=True)),
        sine=checks.Series("m", letter="b", start=1),
        guide_angle=checks.Number("rad"),
    )

    @property
    def lengths(self):
        """What the pitch curve is made of, m."""
        return (*self.cosine, *self.sine)

    @property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O at 720 crank angles, m."""
        return np.min(self.polar(GRID, ray_at(GRID))[0])

    def polar(self, angle, ray):
        mean, farther, slope, second = self.about_mean(angle, ray)
        return mean + farther, slope, second

    def about_mean(self, angle, ray):
        """The mean radius, what r has besides, r' and r'': sums over the harmonics, from the highest down.

        Their sines and cosines follow from each other; they mostly grow smaller, so that little is lost by rounding.
        """
        psi = ray if present(self.guide_angle) is None else unturned(ray, ray_at(self.guide_angle))
        mean, *even = self.cosine
        terms, wave = [], psi
        for order in range(1, 1 + max(len(even), len(self.sine))):
            a, b = (present(part[order - 1]) if order <= len(part) else None for part in (even, self.sine))
            if a is not None or b is not None:
                cosine, sine = wave
                term = plus(product(a, cosine), product(b, sine))
                slope = float(order) * minus(product(b, cosine), product(a, sine))
                terms.append((term, slope, float(-order * order) * term))
            wave = turned(wave, psi)
        found = (reduce(add, reversed(parts)) for parts in zip(*terms, strict=True))
        return mean, *(found if terms else [0.0 * psi[0]] * 3)
