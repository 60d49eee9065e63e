"""What all followers of a cam on the crank have in common: the cam itself, the force of contact and its pressure.

What a cam on the crank tells its follower: the coordinate of the follower as function of the crank angle.

What followers on a straight guide have in common, whatever face they show to a cam that turns with the crank.

Their coordinate s(phi) along the guide is a law, so motion is exact, and of what acts along the guide, F, the crank
feels the moment -F s', whatever the cam looks like.

The cam of a follower, in the axes of the crank: the path of the roller centre, or of the contact, on the disk.

A follower knows where its roller centre P(phi) is at each crank angle; on the cam that is P exp(-i phi). In polar form,
r over the polar angle, it is a cam like all others, with working curve, curvature, cutter path, drawing and files: the
crank angle that belongs to a polar angle is found by Newton's iteration.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property
from ...numbers.planar import (
    curvature,
    dot,
    left,
    number_or_zero,
    rotate,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
)
from ..cams.cam import Cam
from ..cams.roller import LineContact
from ..crank import ray as ray_at
from ..group import FRAME, Group, Output, Point, Resolved
from ..guide import Guide, guide_outputs, slider_motion
from ..laws.law import TURN, breakpoints_of, law_problem
from ..links import CamDriven, Joint, Link, LinkMotion, Slide, Sliding, Wrench

GRID = np.linspace(0.0, TURN, 2049)
"""Crank angles from which the iteration starts, rad."""
NEWTON_STEPS = 8
OUTLINE_POINTS = 181
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
        phi = np.asarray(checks.to_plain_named("cam", "crank angle", phi, "rad"), dtype=float)
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
        points = self.curve(np.linspace(0.0, TURN, OUTLINE_POINTS))[0]
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
        wanted = np.asarray(checks.to_plain_named("cam", "polar angle", polar_angle, "rad"), dtype=float)
        around = self._around
        wanted = around[-1] + np.mod(wanted - around[-1], TURN)
        phi = np.interp(wanted, around[::-1], GRID[::-1])
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


@dataclass(frozen=True, eq=False)
class FollowerLaw:
    """The law of a follower, as engines ask cams: ``polar(angle, ray)`` gives its coordinate and two derivatives."""

    law: Any

    TABULATED = True
    RULES = checks.Rules("law of a follower")  # no number of it is a parameter by itself

    def __repr__(self):
        return f"<FollowerLaw by {type(self.law).__name__}>"

    @cached_property
    def knots(self):
        """Where the law bends or jumps, each a `Knot`."""
        return breakpoints_of(self.law)

    @property
    def lengths(self):
        """Farthest from 0 that the follower gets, of some places on the turn."""
        return (float(np.max(np.abs(self.law(np.linspace(0.0, 2 * np.pi, 24))[0]))),)

    def polar(self, angle, ray):
        shape = np.shape(angle)
        angle = np.asarray(angle, dtype=float)
        return tuple(np.broadcast_to(np.asarray(part, dtype=float), shape) for part in self.law(angle)[:3])

    def radius(self, phi):
        """The same at crank angles, rad."""
        return self.polar(phi, ray_at(np.asarray(phi, dtype=float)))


class LawRule:
    """Rule of the field that holds it: a law of the whole turn, or what was made of one."""

    def quick(self, value):
        return value if type(value) is FollowerLaw else checks.UNDECIDED

    def check(self, value, field=""):
        if type(value) is FollowerLaw:
            return value, None
        problem = law_problem(value)
        return (value, f"{field}: {problem}") if problem else (FollowerLaw(value), None)


RULES = {"cam": LawRule(), "pin": checks.Name(), "label": checks.Name(may_be_empty=True)}


class Follower(checks.Checked, Group):
    """Follower of one link, `moved`, by a law of the crank angle; `pressed` is what touches the cam, or None."""

    cam: Any
    pin: str
    label: str
    moved: Any
    pressed: Any

    @property
    def hangs_on(self):
        return ("O",)

    @property
    def disk(self):
        """The cam itself, in its own axes: those of +x and +y at crank angle 0; for workshop and figures."""
        return DiskCam(self)

    @property
    def outlines(self):
        return {"crank": self.disk.outline}

    @property
    def led(self):
        return (CamDriven(self.moved, self.pin, "crank", "contact_force" + self.label),)

    @property
    def knots(self):
        return self.cam.knots

    @property
    def contact_force(self):
        """Output by name that all of them have."""
        text = f"cam on {self.moved} along the common normal, positive outward"
        return {"contact_force" + self.label: Output("N", False, text)}

    @property
    def contacts(self):
        label = self.label
        return (
            {}
            if self.pressed is None
            else {f"contact_pressure{label}": LineContact(self.pressed, f"contact_force{label}")}
        )

    def relative_radius(self, name, placement, side):
        """Of a roller: its cam is inside the pitch curve where it presses outward, else around it."""
        return self.pressed.relative_radius(path_curvature(placement.joints[self.pin]), -side)


def path_curvature(joint):
    """Curvature of the path of a joint as seen from the crank, 1/m, positive where it is convex from outside.

    Seen so it goes around clockwise.
    """
    place, first, second = joint
    along = subtract_vectors(first, left(place))
    return -curvature(along, subtract_vectors(subtract_vectors(second, scale_vector(2.0, left(first))), place))


GUIDED_RULES = {
    **RULES,
    "guide": checks.InstanceOf(Guide, "made by Guide.at or .through"),
    "follower": checks.InstanceOf(Link, "a Link"),
}


class FollowerForces(NamedTuple):
    """`contact`: cam on follower, outward positive; `guide_*`: ground on follower; `on_follower`: of the crank."""

    contact: Any
    guide_force: Any
    guide_moment: Any
    on_follower: Wrench


@dataclass(frozen=True, eq=False)
class GuidedFollower(Follower):
    """Follower on a guide, moved by a cam on the crank; its kinds give ``forces(travel, guide, load, push)``."""

    cam: Any
    guide: Guide = Guide()
    follower: Link = Link()
    pin: str = "R"
    label: str = ""

    LAW = ("s", "m")
    PATHS: ClassVar = {"guide": ""}
    forces: ClassVar[Any]

    @property
    def links(self):
        return {self.moved: self.follower}

    @property
    def references(self):
        return {self.moved: self.pin}

    @property
    def lengths(self):
        return (*getattr(self.cam, "lengths", ()), self.guide.guide_offset, *self.follower.centre)

    @property
    def moved(self):
        """Name of the link that the cam moves."""
        return "follower" + self.label

    @property
    def joints(self):
        return {self.pin: Point(self.moved)}

    @property
    def guides(self):
        return {self.moved: self.guide}

    @property
    def outputs(self):
        return {**self.contact_force, **guide_outputs(self.moved, self.pin, self.label)}

    @property
    def pairs(self):
        label = self.label
        sliding = Sliding(self.moved, self.pin, FRAME, "guide_force" + label, "guide_moment" + label)
        return {"guide" + label: sliding}

    def sliding(self, name, placement):
        return Slide(self.guide.line.direction, placement.travels[self.moved].first)

    def place(self, placement):
        travel, line = Joint(*self.cam.polar(placement.angle, placement.ray)), self.guide.line
        self._set(placement, slider_motion(None, (travel.position, number_or_zero(line.offset)), travel, line), travel)

    def follow(self, placement, joints):
        """Place the follower at its pin found in another way."""
        pin, direction = joints[self.pin], self.guide.direction
        travel = Joint(*(dot(direction, vector_or_zero(part)) for part in pin))
        self._set(placement, LinkMotion(pin, direction, None, None), travel)

    def _set(self, placement, follower, travel):
        placement.joints[self.pin] = follower.joint
        placement.links[self.moved] = follower
        placement.travels[self.moved] = travel

    def elongation(self, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m."""
        return placement.travels[self.moved].position - free_position

    def resolve(self, placement, loads, along) -> Resolved:
        guide, label = self.guide.line, self.label
        travel, load = placement.travels[self.moved], loads[self.moved]
        found = type(self).forces(travel, guide, load, along.get(self.moved))
        scalars = {
            "contact_force" + label: found.contact,
            "guide_force" + label: found.guide_force,
            "guide_moment" + label: found.guide_moment,
        }
        on_follower = rotate((0.0, found.guide_force), guide.direction)
        return Resolved({"guide" + label: on_follower}, scalars, {"crank": found.on_follower})
