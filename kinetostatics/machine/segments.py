"""Segments of a turn in which a position goes from one value to another: the standard curves of cam design."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from . import rises
from .law import TURN, angles
from .rises import Motion

WHOLE = 1e-12
"""How far segments may be from a whole turn, relative to it."""
POLYNOMIALS = {"3-4-5": (3, 4, 5), "4-5-6-7": (4, 5, 6, 7)}


@dataclass(frozen=True, eq=False)
class Segment:
    """A part of a turn in which the position goes from `start` to `end`, m, in `angle`, rad, by a curve.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> rise = ks.laws.cycloidal(1.7, 2.3, np.pi)
    >>> [round(float(part), 6) for part in rise.at(np.pi / 2)]
    [2.0, 0.381972, 0.0, -0.763944]
    """

    start: float
    end: float
    angle: float
    rise: Any

    @property
    def coefficients(self):
        """Largest velocity, acceleration and jerk of the curve, as for a stroke of 1 in an angle of 1."""
        return self.rise.coefficients

    @property
    def knots(self):
        """Angles from its start at which its acceleration or jerk jumps, rad."""
        return tuple(self.angle * part for part in self.rise.breaks)

    def __call__(self, phi) -> Motion:
        """Motion at angles from the start of the segment, rad."""
        phi = angles(phi)
        beyond = WHOLE * TURN
        if np.any((phi < -beyond) | (phi > self.angle + beyond)):
            raise ParameterError(
                f"segment: angles must lie from 0 to its {self.angle:.9g} rad, got {np.min(phi):.6g} to "
                f"{np.max(phi):.6g}; joined(...) makes a law of the whole turn"
            )
        return self.at(phi)

    def at(self, phi):
        """The same, nothing checked."""
        stroke, share = self.end - self.start, 1.0 / self.angle
        found = self.rise(np.clip(phi * share, 0.0, 1.0))
        position = self.start + stroke * found.position
        scales = (stroke * share**order for order in (1, 2, 3))
        return Motion(position, *(scale * part for scale, part in zip(scales, found[1:], strict=True)))


def _segment(owner, start, end, angle, rise):
    given = {
        "start": (start, {}),
        "end": (end, {}),
        "angle": (angle, {"low": 0.0, "strict": True, "high": TURN + 1e-9}),
    }
    return Segment(**checks.singles(owner, **given), rise=rise)


def harmonic(start, end, angle):
    """Segment: simple harmonic motion, half a cosine; its acceleration jumps at both ends beside a dwell.

    Parameters
    ----------
    start, end : float
        Positions, m.
    angle : float
        Crank angle it takes, rad.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        A value is no number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.laws.harmonic(0.0, 1.0, 1.0).coefficients.velocity
    1.5707963267948966
    """
    return _segment("harmonic", start, end, angle, rises.HARMONIC)


def cycloidal(start, end, angle):
    """Segment: cycloidal motion, a sine of acceleration.

    Peak velocity 2, acceleration 2 pi, jerk 4 pi^2 of a stroke of 1 in an angle of 1.

    Parameters
    ----------
    start, end : float
        Positions, m.
    angle : float
        Crank angle it takes, rad.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        A value is no number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.cycloidal(0.0, 1.0, 1.0).coefficients]
    [2.0, 6.2832, 39.4784]
    """
    return _segment("cycloidal", start, end, angle, rises.CYCLOIDAL)


def modified_sine(start, end, angle):
    """Segment: modified sine, low velocity (Neklutin).

    Parameters
    ----------
    start, end : float
        Positions, m.
    angle : float
        Crank angle it takes, rad.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        A value is no number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.modified_sine(0.0, 1.0, 1.0).coefficients]
    [1.7596, 5.528, 69.4664]
    """
    return _segment("modified_sine", start, end, angle, rises.MODIFIED_SINE)


def modified_trapezoid(start, end, angle):
    """Segment: modified trapezoid, low acceleration (Neklutin).

    Parameters
    ----------
    start, end : float
        Positions, m.
    angle : float
        Crank angle it takes, rad.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        A value is no number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.modified_trapezoid(0.0, 1.0, 1.0).coefficients]
    [2.0, 4.8881, 61.426]
    """
    return _segment("modified_trapezoid", start, end, angle, rises.MODIFIED_TRAPEZOID)


def polynomial(start, end, angle, powers="3-4-5"):
    """Segment: sum of powers of the angle, whose coefficients follow from rest at both ends.

    Parameters
    ----------
    start, end, angle : float
        As for `harmonic`.
    powers : "3-4-5", "4-5-6-7" or sequence of int
        Two powers or more, from 2 to 15, rising; the lowest n leaves n - 1 derivatives zero at the start, so many
        powers as many less one at the end.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        As for `harmonic`, or the powers are none.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.polynomial(0.0, 1.0, 1.0).coefficients]
    [1.875, 5.7735, 60.0]
    """
    found: Any = POLYNOMIALS.get(powers) if isinstance(powers, str) else powers
    rising = isinstance(found, list | tuple) and all(isinstance(n, int | np.integer) and 2 <= n <= 15 for n in found)
    if not rising or len(found) < 2 or any(one >= other for one, other in pairwise(found)):
        names = " or ".join(map(repr, POLYNOMIALS))
        raise ParameterError(
            f"polynomial: powers must be {names}, or two or more whole numbers from 2 to 15, rising, got "
            f"{checks.shown(powers)}"
        )
    return _segment("polynomial", start, end, angle, rises.Powers(tuple(map(int, found))))


def dwell(position, angle):
    """Segment: rest at a position.

    Parameters
    ----------
    position : float
        m.
    angle : float
        Crank angle it takes, rad.

    Returns
    -------
    Segment

    Raises
    ------
    ParameterError
        A value is no number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> print(*ks.laws.dwell(0.1, 1.0)(0.5))
    0.1 0.0 0.0 0.0
    """
    given = {"position": (position, {}), "angle": (angle, {"low": 0.0, "strict": True, "high": TURN + 1e-9})}
    found = checks.singles("dwell", **given)
    return Segment(found["position"], found["position"], found["angle"], rises.Rest())
