"""The cam of a follower, in the axes of the crank: the path of the roller centre, or of the contact, on the disk.

A follower knows where its roller centre P(phi) is at each crank angle; on the cam that is P exp(-i phi). In polar form,
r over the polar angle, it is a cam like all others, with working curve, curvature, cutter path, drawing and files: the
crank angle that belongs to a polar angle is found by Newton's iteration.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property
from ..cams.cam import Cam
from ..laws.law import TURN

GRID = np.linspace(0.0, TURN, 2049)
"""Crank angles from which the iteration starts, rad."""
ITERATIONS = 8
OUTLINE = 181
"""Points of a drawn curve."""


@dataclass(frozen=True, eq=False)
class DiskCam(Cam):
    """Cam of a follower with ``pitch(law values) -> P, P', P''``; made by its `disk`.

    It turns with the crank; its polar angles, which are what cams call crank angles, are from +x at crank angle 0.
    """

    follower: Any

    TABULATED = True

    def curve(self, phi):
        """Roller centre on the cam at crank angles, and two derivatives by it, complex, m."""
        phi = np.asarray(checks.converted("cam", "crank angle", phi, "rad"), dtype=float)
        place, first, second = self.follower.pitch(self.follower.cam.law(phi))
        back = np.exp(-1j * phi)
        return back * place, back * (first - 1j * place), back * (second - 2j * first - place)

    def export(self, path, *, clockwise=True, **others):
        """Write the cam for the workshop, as every cam; see `Cam.export`.

        The roller goes around it clockwise, as it does where the crank turns counter-clockwise, unless told.
        """
        super().export(path, clockwise=clockwise, **others)

    @property
    def outline(self):
        """Points (2, K) of the pitch curve, the last again the first, m."""
        points = self.curve(np.linspace(0.0, TURN, OUTLINE))[0]
        return np.array([points.real, points.imag])

    @cached_property
    def _around(self):
        """Polar angle of the roller centre on the grid, falling by a turn."""
        angle = np.unwrap(np.angle(self.curve(GRID)[0]))
        if abs(angle[0] - angle[-1] - TURN) > 1e-6 or np.any(np.diff(angle) >= 0.0):
            place = int(np.argmax(np.diff(angle)))
            raise ParameterError(
                "the pitch curve of the follower's cam must go around O once, a point for each direction, but at crank "
                f"angle {np.degrees(GRID[place]):.6g} deg it does not; enlarge the cam"
            )
        return angle

    def crank_angle(self, polar_angle):
        """Crank angle in (-pi, pi] at which the roller is on a ray of the cam, rad."""
        wanted = np.asarray(checks.converted("cam", "polar angle", polar_angle, "rad"), dtype=float)
        around = self._around
        wanted = around[-1] + np.mod(wanted - around[-1], TURN)
        phi = np.interp(wanted, around[::-1], GRID[::-1])
        for _ in range(ITERATIONS):
            place, first, _ = self.curve(phi)
            off = np.angle(place * np.exp(-1j * wanted))
            phi = phi - off / (first / place).imag
        return phi

    def polar(self, angle, ray):
        place, first, second = self.curve(self.crank_angle(angle))
        rate = first / place
        bend = second / place - rate * rate
        r, turning = np.abs(place), rate.imag
        slope = rate.real / turning  # of log r by the polar angle
        curve = (bend.real - slope * bend.imag) / (turning * turning)
        return r, r * slope, r * (curve + slope * slope)

    @property
    def force_error(self):
        """As of the law, where that is a table."""
        return getattr(self.follower.cam.law, "force_error", None)

    @property
    def lengths(self):
        """What the pitch curve is made of, m."""
        return (float(np.max(np.abs(self.curve(GRID)[0]))),)

    @cached_property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O on a grid, m."""
        return float(np.min(np.abs(self.curve(GRID)[0])))
