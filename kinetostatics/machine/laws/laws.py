"""Laws of motion of `ks.laws`: segments by the standard curves of cam design, and laws of the whole turn.

harmonic, cycloidal, polynomial,
modified_sine, modified_trapezoid,
dwell                             segments of a turn, for `joined`; each is a function of its own angle
cosine, joined, table             laws of the whole turn: law(phi) -> position, velocity, acceleration, jerk by phi

``cams.from_law`` makes the cam whose slider follows a law of the whole turn.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from . import curves
from .curves import Motion
from .law import TURN, Law, angle_array
from .turn_table import TurnTable

TURN_TOLERANCE = 1e-12
"""Largest difference of the segments together from a whole turn, relative to the turn."""
POLYNOMIALS = {"3-4-5": (3, 4, 5), "4-5-6-7": (4, 5, 6, 7)}


@dataclass(frozen=True, eq=False)
class Segment:
    """Part of a turn: the position moves from `start` to `end`, m, over `angle`, rad, by a standard curve.

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
        """Largest velocity, acceleration and jerk of the curve for a stroke of 1 over an angle of 1."""
        return self.rise.coefficients

    @property
    def knots(self):
        """Angles from its start at which its acceleration or jerk jumps, rad."""
        return tuple(self.angle * part for part in self.rise.breaks)

    def __call__(self, phi) -> Motion:
        """Motion at angles from the start of the segment, rad."""
        phi = angle_array(phi)
        beyond = TURN_TOLERANCE * TURN
        if np.any((phi < -beyond) | (phi > self.angle + beyond)):
            raise ParameterError(
                f"segment: angles must lie from 0 to its {self.angle:.9g} rad, got {np.min(phi):.6g} to "
                f"{np.max(phi):.6g}; joined(...) makes a law of the whole turn"
            )
        return self.at(phi)

    def at(self, phi):
        """Motion as of `__call__`, unchecked."""
        stroke, share = self.end - self.start, 1.0 / self.angle
        found = self.rise(np.clip(phi * share, 0.0, 1.0))
        position = self.start + stroke * found.position
        scales = (stroke * share**order for order in (1, 2, 3))
        return Motion(position, *(scale * part for scale, part in zip(scales, found[1:], strict=True)))


def _segment(owner, rise, angle, **positions):
    given: dict[str, Any] = {name: (position, "m", {}) for name, position in positions.items()}
    given["angle"] = (angle, "rad", {"low": 0.0, "strict": True, "high": TURN + 1e-9})
    found = list(checks.single_numbers(owner, **given).values())
    return Segment(found[0], found[-2], found[-1], rise)


def harmonic(start, end, angle) -> Segment:
    """Segment: simple harmonic motion, half a cosine; next to a dwell its acceleration jumps.

    Parameters
    ----------
    start, end : float
        Positions, m.
    angle : float
        Crank angle of the segment, rad.

    Raises
    ------
    ParameterError
        A value is not a number, or the angle not between 0 and a turn.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.laws.harmonic(0.0, 1.0, 1.0).coefficients.velocity
    1.5707963267948966
    """
    return _segment("harmonic", curves.HARMONIC, angle, start=start, end=end)


def cycloidal(start, end, angle):
    """Segment: cycloidal motion, whose acceleration is a sine; start, end, angle as for `harmonic`.

    For a stroke of 1 over an angle of 1 the peak velocity is 2, acceleration 2 pi, jerk 4 pi^2.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.cycloidal(0.0, 1.0, 1.0).coefficients]
    [2.0, 6.2832, 39.4784]
    """
    return _segment("cycloidal", curves.CYCLOIDAL, angle, start=start, end=end)


def modified_sine(start, end, angle):
    """Segment: modified sine (Neklutin), of low peak velocity; start, end, angle as for `harmonic`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.modified_sine(0.0, 1.0, 1.0).coefficients]
    [1.7596, 5.528, 69.4664]
    """
    return _segment("modified_sine", curves.MODIFIED_SINE, angle, start=start, end=end)


def modified_trapezoid(start, end, angle):
    """Segment: modified trapezoid (Neklutin), of low peak acceleration; start, end, angle as for `harmonic`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(part, 4) for part in ks.laws.modified_trapezoid(0.0, 1.0, 1.0).coefficients]
    [2.0, 4.8881, 61.426]
    """
    return _segment("modified_trapezoid", curves.MODIFIED_TRAPEZOID, angle, start=start, end=end)


def polynomial(start, end, angle, powers="3-4-5") -> Segment:
    """Segment: sum of powers of the angle with rest at both ends.

    Parameters
    ----------
    start, end, angle : float
        As for `harmonic`.
    powers : "3-4-5", "4-5-6-7" or sequence of int
        Two powers or more, from 2 to 15, rising. With the lowest power n, n - 1 derivatives are zero at the start; with
        k powers, k - 1 derivatives are zero at the end.

    Raises
    ------
    ParameterError
        As for `harmonic`, or the powers are invalid.

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
    return _segment("polynomial", curves.Powers(tuple(map(int, found))), angle, start=start, end=end)


def dwell(position, angle):
    """Segment: rest at a position, m, over an angle, rad; errors as for `harmonic`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> print(*ks.laws.dwell(0.1, 1.0)(0.5))
    0.1 0.0 0.0 0.0
    """
    return _segment("dwell", curves.Rest(), angle, position=position)


__all__ = [
    "Law",
    "Motion",
    "Segment",
    "cosine",
    "cycloidal",
    "dwell",
    "harmonic",
    "joined",
    "modified_sine",
    "modified_trapezoid",
    "polynomial",
    "table",
]

JUMP_TOLERANCE = 1e-9
"""Largest jump between segments that is rounding, relative to the largest value of its kind."""
JUMPS = {
    "position": ("m", "; let it start where the one before ends"),
    "velocity": ("m/rad", ""),
    "acceleration": ("m/rad2", '; take a cycloidal or modified curve there, or allow it by smooth="velocity"'),
}
"""Unit of each kind of value that may jump between segments, and what removes the jump."""


@dataclass(frozen=True, eq=False)
class Cosine(Law):
    """mean + amplitude cos(phi - phase); made by `cosine`."""

    amplitude: float
    mean: float
    phase: float = 0.0

    def __call__(self, phi):
        psi = angle_array(phi) - self.phase
        even, odd = self.amplitude * np.cos(psi), self.amplitude * np.sin(psi)
        return Motion(self.mean + even, -odd, -even, odd)


def cosine(amplitude, mean, phase=0.0) -> Law:
    """Law of the whole turn: position = mean + amplitude cos(phi - phase), the simple harmonic motion.

    Parameters
    ----------
    amplitude : float
        Half the stroke, m.
    mean : float
        Mid-stroke, m.
    phase : float
        Crank angle of the farthest position, rad.

    Raises
    ------
    ParameterError
        A value is not a number, or the amplitude not greater than 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> [round(float(part), 9) for part in ks.laws.cosine(0.3, 2.0)(0.0)]
    [2.3, -0.0, -0.3, 0.0]
    """
    rules = {
        "amplitude": (amplitude, "m", {"low": 0.0, "strict": True}),
        "mean": (mean, "m", {}),
        "phase": (phase, "rad", {}),
    }
    return Cosine(**checks.single_numbers("cosine law", **rules))


@dataclass(frozen=True, eq=False)
class JoinedLaw(Law):
    """Sequence of segments that fill a turn; made by `joined`."""

    segments: tuple[Segment, ...]

    @property
    def starts(self):
        return np.concatenate([[0.0], np.cumsum([part.angle for part in self.segments])])

    @property
    def joints(self):
        return tuple(self.starts)

    @property
    def knots(self):
        return tuple(
            start + knot for start, part in zip(self.starts, self.segments, strict=False) for knot in part.knots
        )

    def __call__(self, phi):
        phi = np.mod(angle_array(phi), TURN)
        starts = self.starts
        place = np.clip(np.searchsorted(starts, phi, side="right") - 1, 0, len(self.segments) - 1)
        found = np.empty((4, *phi.shape))
        for number in np.unique(place):
            here = place == number
            found[:, here] = self.segments[number].at(phi[here] - starts[number])
        return Motion(*found)


def joined(*segments, smooth="acceleration") -> Law:
    """Law of the whole turn from a sequence of segments that starts at crank angle 0: rise, dwell, return ...

    Parameters
    ----------
    segments : Segment
        From `cycloidal`, `dwell` and the others; their angles add up to one turn.
    smooth : "acceleration" or "velocity"
        Highest derivative that must not jump between segments. "velocity" allows jumps of the acceleration, and with it
        of the forces.

    Raises
    ------
    ParameterError
        The segments do not fill a turn, or a value jumps between them; the message gives both values at each place.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> import numpy as np
    >>> rise = ks.laws.cycloidal(1.7, 2.3, np.pi / 2)
    >>> back = ks.laws.modified_sine(2.3, 1.7, np.pi)
    >>> law = ks.laws.joined(rise, ks.laws.dwell(2.3, np.pi / 4), back, ks.laws.dwell(1.7, np.pi / 4))
    >>> round(float(law(2.0).position), 12)
    2.3
    """
    if len(segments) == 1 and isinstance(segments[0], list | tuple):
        segments = tuple(segments[0])
    others = ((n, part) for n, part in enumerate(segments, 1) if not isinstance(part, Segment))
    checks.require(
        "joined",
        *(f"segment {n} must be made by ks.laws, got {checks.shown(part)}" for n, part in others),
        checks.choice("smooth", smooth, ("velocity", "acceleration")),
        None if segments else "no segments",
    )
    total = sum(part.angle for part in segments)
    if abs(total - TURN) > TURN_TOLERANCE * TURN:
        remedy = f"a dwell of {TURN - total:.9g} rad is missing" if total < TURN else "shorten them"
        raise ParameterError(
            f"joined: segments must fill a turn of {TURN:.9g} rad, but take {total:.9g} ({np.degrees(total):.6g} deg); "
            f"{remedy}"
        )
    motions = np.array([segment.at(np.linspace(0.0, segment.angle, 65)) for segment in segments])
    largest, angle, jumps = np.abs(motions).max(axis=(0, 2)), 0.0, []
    for number, segment in enumerate(segments, 1):
        angle += segment.angle
        before, after = motions[number - 1, :, -1], motions[number % len(segments), :, 0]
        for (kind, (unit, remedy)), here, there, size in zip(JUMPS.items(), before, after, largest, strict=False):
            if abs(there - here) > JUMP_TOLERANCE * size and (kind, smooth) != ("acceleration", "velocity"):
                jumps.append(
                    f"the {kind} jumps at {np.degrees(angle):.6g} deg, from {here:.9g} to {there:.9g} {unit}, behind "
                    f"segment {number} of {len(segments)}{remedy}"
                )
    checks.require("joined", *jumps)
    return JoinedLaw(segments)


# Tables


class TableLaw(TurnTable, Law):
    """Spline through a table over the turn; made by `table`."""

    OWNER, VALUE, VALUES, SECOND = "table of a law", "position", "positions", "x''"

    @property
    def knots(self):
        return tuple(np.unique(np.mod(self.splines[0].t, TURN)).tolist())

    def __repr__(self):
        return f"<Law through {self.angle.size} points, forces within {self.force_error:.2g} of the largest>"

    def __call__(self, phi):
        phi = angle_array(phi)
        return Motion(*(spline(phi) for spline in self.splines))


def table(angle, position, noise=None):
    """Law of the whole turn from a table, by a periodic quintic spline.

    Parameters
    ----------
    angle : array (N,)
        rad, rising, within one turn, end excluded; spacing may vary.
    position : array (N,)
        m.
    noise : float, optional
        Standard deviation of the positions, m; for positions rounded to a step, 0.29 of the step. The spline is then
        the smoothest within that noise. Without noise it passes through every point.

    Returns
    -------
    Law
        Its `force_error` is the expected error of forces relative to the largest.

    Raises
    ------
    ParameterError
        Fewer than 8 points, angles not rising or beyond one turn, a value that is not finite, or noise smaller than any
        smooth curve through the positions allows.

    Warns
    -----
    UserWarning
        The table is too coarse or too noisy: `force_error` is 0.01 or more. Or the stated noise is more than three
        times the scatter of the positions, or less than a third.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> import numpy as np
    >>> angle = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)
    >>> law = ks.laws.table(angle, 2.0 + 0.3 * np.cos(angle))
    >>> round(float(law(1.0).velocity), 9)
    -0.252441295
    """
    return TableLaw(angle, position, noise)


def __dir__():
    return __all__
