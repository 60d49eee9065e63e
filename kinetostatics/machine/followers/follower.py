"""Followers of a cam on the crank: the law of their motion, the contact with the cam, and the cam itself.

The coordinate of a follower is a law of the crank angle phi, so its motion is exact. The cam follows from it: with the
roller centre or contact P(phi), as a complex number, its curve in the axes of the crank is P exp(-i phi). In polar form
it is a cam as all others, with working curve, curvature, cutter path and files; Newton's iteration gives the crank
angle of a polar angle.
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property
from ...numbers.planar import curvature, left, scale_vector, subtract_vectors
from ..cams.cam import Cam
from ..cams.roller import LineContact, relative_radius
from ..crank import ray as ray_at
from ..dimensions import Radius
from ..group import Group, Label, Name, Output, Plane
from ..laws.law import TURN, Breakpoint, breakpoints_of, law_problem, turn_angles
from ..links import CamDriven, Rolling

GRID_ANGLES = 2048
"""Even crank angles among those at which Newton's iteration starts."""
NEWTON_STEPS = 8
OUTLINE_POINTS = 181
"""Points of a drawn curve."""


@dataclass(frozen=True, eq=False)
class DiskCam(Cam):
    """Cam of a follower, made by its `disk`; its polar angles count from +x at crank angle 0."""

    follower: Any

    TABULATED = True

    @property
    def flat(self):
        """Whether the follower has a flat face."""
        return self.follower.BODY == "face"

    def curve(self, phi):
        """Roller centre on the cam at crank angles, and its first two derivatives, complex, m."""
        phi = np.asarray(checks.to_plain_named("cam", "crank angle", phi, "rad"), dtype=float)
        place, first, second = self.follower.pitch(self.follower.cam.law(phi))
        back = np.exp(-1j * phi)
        return back * place, back * (first - 1j * place), back * (second - 2j * first - place)

    def export(self, path, *, clockwise=True, **others):
        """Write the cam for the workshop, as every cam; see `Cam.export`.

        By default the roller goes around it clockwise, as for a crank that turns counter-clockwise.
        """
        super().export(path, clockwise=clockwise, **others)

    @property
    def outline(self):
        """Points (2, K) of the pitch curve, the last again the first, m."""
        points = self.curve(np.linspace(0.0, TURN, OUTLINE_POINTS))[0]
        return np.array([points.real, points.imag])

    @cached_property
    def knots(self):
        """Polar angles of the knots of the law, each a `Breakpoint`."""
        return tuple(
            Breakpoint(float(np.angle(self.curve(knot.angle)[0])), knot.jumps) for knot in self.follower.cam.knots
        )

    @cached_property
    def _grid(self):
        """Crank angles at which Newton's iteration starts, rad."""
        return np.append(turn_angles([knot.angle for knot in self.follower.cam.knots], GRID_ANGLES), TURN)

    @cached_property
    def _around(self):
        """Polar angle of the roller centre on the grid, falling by a turn."""
        angle = np.unwrap(np.angle(self.curve(self._grid)[0]))
        if abs(angle[0] - angle[-1] - TURN) > 1e-6 or np.any(np.diff(angle) >= 0.0):
            place = int(np.argmax(np.diff(angle)))
            raise ParameterError(
                "the pitch curve of the follower's cam must go around O once, a point for each direction, but at crank "
                f"angle {np.degrees(self._grid[place]):.6g} deg it does not; enlarge the cam"
            )
        return angle

    def crank_angle(self, polar_angle):
        """Crank angle in (-pi, pi] at which the roller is on a ray of the cam, rad."""
        wanted = np.asarray(checks.to_plain_named("cam", "polar angle", polar_angle, "rad"), dtype=float)
        around = self._around
        wanted = around[-1] + np.mod(wanted - around[-1], TURN)
        phi = np.interp(wanted, around[::-1], self._grid[::-1])
        for _ in range(NEWTON_STEPS):
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
        """`force_error` of the law, if that is a table."""
        return getattr(self.follower.cam.law, "force_error", None)

    @property
    def lengths(self):
        """Largest distance of the pitch curve from O, m."""
        return (float(np.max(np.abs(self.curve(self._grid)[0]))),)


@dataclass(frozen=True, eq=False)
class FollowerLaw:
    """Law of a follower as a curve of `cam`: ``polar(angle, ray)`` gives its coordinate and two derivatives."""

    law: Any

    TABULATED = True
    RULES = checks.Rules("law of a follower")  # no number of it is a parameter by itself

    def __repr__(self):
        return f"<FollowerLaw by {type(self.law).__name__}>"

    @cached_property
    def knots(self):
        """Where segments of the law join, or it bends or jumps, each a `Breakpoint`."""
        return breakpoints_of(self.law)

    @property
    def lengths(self):
        """Largest coordinate on a grid over the turn."""
        return (float(np.max(np.abs(self.law(np.linspace(0.0, 2 * np.pi, 24))[0]))),)

    def polar(self, angle, ray):
        shape = np.shape(angle)
        angle = np.asarray(angle, dtype=float)
        return tuple(np.broadcast_to(np.asarray(part, dtype=float), shape) for part in self.law(angle)[:3])

    def radius(self, phi):
        """Coordinate and two derivatives at crank angles, rad."""
        return self.polar(phi, ray_at(np.asarray(phi, dtype=float)))


class LawRule:
    """Rule of the field `cam`: a law of the whole turn, kept as a `FollowerLaw`."""

    def quick(self, value):
        return value if type(value) is FollowerLaw else checks.UNDECIDED

    def check(self, value, field=""):
        if type(value) is FollowerLaw:
            return value, None
        problem = law_problem(value)
        return (value, f"{field}: {problem}") if problem else (FollowerLaw(value), None)


class Follower(checks.Checked, Group):
    """Follower of one link, `moved`, by a law of the crank angle; the folder lists what a new one must give."""

    cam: Annotated[Any, LawRule()]
    pin: Name
    label: Label
    plane: Plane
    roller: Any

    hangs_on = ("O",)
    BODY = "roller"
    """Field of the body that the cam presses on, "face" if it is flat."""

    @property
    def pressed(self):
        """Body that the cam presses on: its `Roller` or `Face`, or None."""
        return getattr(self, self.BODY)

    @property
    def rollers(self):
        return {self.pin: None if self.roller is None else self.roller.radius}

    @property
    def disk(self):
        """Cam in its own axes, +x and +y at crank angle 0; for workshop and figures."""
        return DiskCam(self)

    @property
    def outlines(self):
        return {"crank": self.disk.outline}

    @property
    def dimensions(self):
        return {("roller", "radius"): Radius(self.pin)}

    @property
    def knots(self):
        return self.cam.knots

    @property
    def moved(self):
        """Name of the link that the cam moves."""
        return self._key

    def with_cam(self, declaration):
        """A declaration with the contact on the cam."""
        (link,) = self.LINKS
        pressure = {} if self.pressed is None else {"contact_pressure": LineContact(self.pressed, "contact_force")}
        led = CamDriven(link, self.pin, "crank", "contact_force", flat=self.BODY == "face")
        rolls = () if led.flat else (Rolling(link, self.pin, "contact_force", "crank"),)
        return declaration._replace(led=(led,), contacts=pressure, pairs=(*declaration.pairs, *rolls))

    @cached_property
    def tightest(self):
        """Smallest radius of curvature of the pitch curve, on a grid, m."""
        _, first, second = self.disk.curve(turn_angles([knot.angle for knot in self.knots], GRID_ANGLES))
        with np.errstate(divide="ignore"):
            curved = abs(abs(first) ** 3 / (np.conj(first) * second).imag)
        return curved.min(axis=-1, keepdims=True)

    @cached_property
    def outputs(self):
        text = f"cam on {self.moved} along the common normal, positive outward"
        return {self.called("contact_force"): Output("N", False, text), **super().outputs}

    def relative_radius(self, name, placement, side):
        """Radius of relative curvature of a roller: the cam is inside the pitch curve if it presses outward."""
        return relative_radius(path_curvature(placement.joints[self.pin]), self.roller.radius, -side)


def path_curvature(joint):
    """Curvature of the path of a joint as seen from the crank, 1/m, positive where it is convex from outside.

    In this view the joint moves around the cam clockwise.
    """
    place, first, second = joint
    along = subtract_vectors(first, left(place))
    return -curvature(along, subtract_vectors(subtract_vectors(second, scale_vector(2.0, left(first))), place))
