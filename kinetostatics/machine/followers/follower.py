"""What all followers of a cam on the crank have in common: the cam itself, the force of contact and its pressure.

What a cam on the crank tells its follower: the coordinate of the follower as function of the crank angle.

What followers on a straight guide have in common, whatever face they show to a cam that turns with the crank.

Their coordinate s(phi) along the guide is a law, so motion is exact, and of what acts along the guide, F, the crank
feels the moment -F s', whatever the cam looks like.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.lazy import cached_property
from ...numbers.planar import curvature, dot, left, number, stretched, subtracted, turned, vector
from ..cams.roller import Touch
from ..crank import ray as ray_at
from ..group import FRAME, Group, Output, Point, Resolved
from ..guide import Guide, guide_outputs, slid
from ..laws.law import bends_of, law_problem
from ..links import Joint, Led, Link, LinkMotion, Slide, Sliding, Wrench
from .disk_cam import DiskCam


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
        return bends_of(self.law)

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


class Lawful:
    """Rule of the field that holds it: a law of the whole turn, or what was made of one."""

    def quick(self, value):
        return value if type(value) is FollowerLaw else checks.UNSURE

    def taken(self, value, field=""):
        if type(value) is FollowerLaw:
            return value, None
        problem = law_problem(value)
        return (value, f"{field}: {problem}") if problem else (FollowerLaw(value), None)


RULES = {"cam": Lawful(), "pin": checks.Name(), "label": checks.Name(may_be_empty=True)}


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
        return (Led(self.moved, self.pin, "crank", "contact_force" + self.label),)

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
            {} if self.pressed is None else {f"contact_pressure{label}": Touch(self.pressed, f"contact_force{label}")}
        )

    def relative_radius(self, name, placement, side):
        """Of a roller: its cam is inside the pitch curve where it presses outward, else around it."""
        return self.pressed.relative_radius(bend(placement.joints[self.pin]), -side)


def bend(joint):
    """Curvature of the path of a joint as seen from the crank, 1/m, positive where it is convex from outside.

    Seen so it goes around clockwise.
    """
    place, first, second = joint
    along = subtracted(first, left(place))
    return -curvature(along, subtracted(subtracted(second, stretched(2.0, left(first))), place))


GUIDED_RULES = {
    **RULES,
    "guide": checks.Made(Guide, "made by Guide.at or .through"),
    "follower": checks.Made(Link, "a Link"),
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
        self._set(placement, slid(None, (travel.position, number(line.offset)), travel, line), travel)

    def follow(self, placement, joints):
        """Place the follower at its pin found in another way."""
        pin, direction = joints[self.pin], self.guide.direction
        travel = Joint(*(dot(direction, vector(part)) for part in pin))
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
        on_follower = turned((0.0, found.guide_force), guide.direction)
        return Resolved({"guide" + label: on_follower}, scalars, {"crank": found.on_follower})
