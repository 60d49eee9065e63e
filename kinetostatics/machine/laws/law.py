"""Law of motion: a position over the turn, a function of the crank angle, with three exact derivatives.

``law(phi)`` returns position, velocity, acceleration and jerk by phi (m, m/rad, m/rad2, m/rad3). Here stand the base
`Law`, its shift by a phase, laws in Chebyshev polynomials on panels, and the checks of a user's own law.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.arithmetic import TURN
from ...numbers.panels import Panels
from .curves import Motion

PLACES = 0.5 + 0.5 * chebyshev.chebpts1(24)
"""Places between two knots, relative to their distance, at which a law is sampled: Chebyshev points."""
TEST_STEPS = 720
"""Parts of the turn over which each derivative of a law is integrated and compared with the one before."""
GAUSS_POINTS = np.array([0.5 - np.sqrt(0.15), 0.5, 0.5 + np.sqrt(0.15)])
GAUSS_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
"""Points and weights of Gauss quadrature from 0 to 1."""
MAX_JUMP_SHARE = 0.1
"""Largest fraction of these parts in which a derivative may jump."""
KNOT_OFFSET = 1e-7
"""Distance from a knot, rad, at which jumps are measured."""
MIN_JUMP = 1e-4
"""Smallest jump of an acceleration or a jerk that is not rounding, relative to its largest value."""


class Breakpoint(NamedTuple):
    """A crank angle, rad, at which segments of a law join or its jerk jumps; `jumps` if the acceleration jumps too."""

    angle: float
    jumps: bool


class Law:
    """Position over the whole turn, m, with three derivatives by the crank angle: ``law(phi)``.

    Any function that returns these four arrays is a law; an attribute `knots` gives the angles at which its jerk or
    acceleration jumps.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> def law(phi):  # a law of one's own: mid-stroke 2 m, the cosine and a little of the third order
    ...     c1, s1, c3, s3 = np.cos(phi), np.sin(phi), np.cos(3 * phi), np.sin(3 * phi)
    ...     return 2 + 0.3 * c1 + 1e-4 * c3, -0.3 * s1 - 3e-4 * s3, -0.3 * c1 - 9e-4 * c3, 0.3 * s1 + 27e-4 * s3
    >>> round(ks.cams.from_law(law).coupler_length, 6)
    2.021864
    """

    knots: Any = ()
    """Crank angles at which the jerk may jump, rad."""
    joints: Any = ()
    """Knots at which segments join, possibly narrow and smooth there, rad."""

    def __call__(self, phi) -> Motion:
        raise TypeError(f"{type(self).__name__} must define __call__(phi) -> position, velocity, acceleration, jerk")

    def shifted(self, phase):
        """The same law delayed by a phase, rad.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> law = ks.laws.cosine(0.3, 2.0)
        >>> round(float(law.shifted(0.5)(0.5).position), 9), round(float(law(0.0).position), 9)
        (2.3, 2.3)
        """
        return ShiftedLaw(self, **checks.single_numbers("law", phase=(phase, "rad", {})))


@dataclass(frozen=True, eq=False)
class ShiftedLaw(Law):
    """A law delayed by a phase, rad; made by `Law.shifted`."""

    law: Any
    phase: float

    @property
    def knots(self):
        return tuple(knot + self.phase for knot in getattr(self.law, "knots", ()))

    @property
    def joints(self):
        return tuple(joint + self.phase for joint in getattr(self.law, "joints", ()))

    @property
    def force_error(self):
        return getattr(self.law, "force_error", None)

    def __call__(self, phi):
        return self.law(angle_array(phi) - self.phase)


def turn_angles(knots, count):
    """`count` even crank angles over the turn, and `PLACES` between neighbouring knots, rising, rad."""
    even, knots = np.linspace(0.0, TURN, count, endpoint=False), np.unique(np.mod(knots, TURN))
    between = knots[:, None] + np.diff(knots, append=knots[:1] + TURN)[:, None] * PLACES
    return np.unique(np.append(even, np.mod(between, TURN)))


def breakpoints_of(law):
    """Knots of a law at which segments join, or its acceleration or jerk jumps, each a `Breakpoint`."""
    joints = np.mod(np.array(getattr(law, "joints", ()), dtype=float), TURN)
    angle = np.unique(np.mod(np.array(getattr(law, "knots", ()), dtype=float), TURN))
    if not angle.size:
        return ()
    largest = [np.max(np.abs(part)) for part in _parts(law, turn_angles(angle, TEST_STEPS))[2:]]
    before, after = (_parts(law, np.mod(angle + side * KNOT_OFFSET, TURN))[2:] for side in (-1.0, 1.0))
    acceleration, jerk = np.abs(np.subtract(after, before)) > MIN_JUMP * np.array(largest)[:, None]
    return tuple(
        Breakpoint(float(place), bool(jumps))
        for place, jumps, bends in zip(angle, acceleration, jerk, strict=True)
        if jumps or bends or place in joints
    )


def angle_array(phi):
    """Crank angles as an array of float, rad."""
    phi = checks.to_plain_named("law", "crank angle", phi, "rad")
    if isinstance(phi, np.ndarray) and phi.size:
        checks.require("law", checks.count("the number of crank angles", phi.size, size=phi.itemsize))
    try:
        return np.asarray(phi, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"law: crank angles must be numbers, rad, got {checks.shown(phi)}") from None


def law_problem(law):
    """Problem of a law, as a sentence, or None."""
    if not callable(law) or isinstance(law, type):
        return f"law must be one of ks.laws, or a function of the crank angle, got {checks.shown(law)}"
    angle = np.array([-1.0, 0.5, 0.5 + TURN])
    try:
        given = law(angle)
        if any(map(checks.is_quantity, given)):
            return "law must give plain numbers, m and derivatives by rad, got quantities with units"
        parts = _parts(law, angle)
    except Exception as error:  # of the user's own function
        return f"law must give position and three derivatives of arrays of crank angles; it fails with: {error}"
    if len(parts) != len(Motion._fields):
        return f"law must give 4 arrays, position to jerk, got {len(parts)}"
    if not all(np.isfinite(part).all() for part in parts):
        return "law must give finite values"
    position = parts[0]
    if abs(position[2] - position[1]) > 1e-9 * max(abs(position[1]), 1e-30):
        return f"law must repeat after a turn, but gives {position[1]:.9g} m at 0.5 rad and {position[2]:.9g} a turn on"
    return _derivative_problem(law)


def _parts(law, angle):
    return [np.broadcast_to(np.asarray(part, dtype=float), angle.shape) for part in law(angle)]


def _derivative_problem(law):
    """Problem of a law whose derivatives do not integrate to the part before, except at a few jumps; or None."""
    edges = np.linspace(0.0, TURN, TEST_STEPS + 1)
    width = edges[1]
    ends = _parts(law, edges)
    inner = _parts(law, np.add.outer(GAUSS_POINTS * width, edges[:-1]))
    for order, (kind, changes) in enumerate(zip(Motion._fields, Motion._fields[1:], strict=False)):
        sums = width * GAUSS_WEIGHTS @ inner[order + 1]
        grown = np.diff(ends[order])
        allowed = 0.05 * width * np.max(np.abs(inner[order + 1])) + 1e-12 * np.max(np.abs(ends[order]))
        wrong = np.abs(grown - sums) > allowed
        if np.mean(wrong) > MAX_JUMP_SHARE:
            place = int(np.argmax(np.abs(grown - sums)))
            return (
                f"law must give exact derivatives by the crank angle in rad, but at {np.degrees(edges[place]):.4g} deg "
                f"its {kind} changes by {grown[place] / width:.6g} per rad, while its {changes} is "
                f"{sums[place] / width:.6g}"
            )
    return None


@dataclass(frozen=True, eq=False)
class PanelLaw(Law):
    """A law of the whole turn from Chebyshev polynomials on panels."""

    panels: Panels

    @property
    def knots(self):
        return tuple(self.panels.edges[:-1].tolist())

    def __repr__(self):
        return f"<Law in {len(self.panels.coefficients)} pieces>"

    def __call__(self, phi):
        return Motion(*self.panels.at(angle_array(phi), 3))
