"""What followers on a straight guide have in common, whatever face they show to a cam that turns with the crank.

Their coordinate s(phi) along the guide is a law, so motion is exact, and of what acts along the guide, F, the crank
feels the moment -F s', whatever the cam looks like.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from ..numbers import checks
from ..numbers.planar import dot, number, turned, vector
from . import follower
from .group import FRAME, Point, Resolved
from .guide import Guide, guide_outputs, slid
from .links import Joint, Link, LinkMotion, Wrench
from .pairs import Slide, Sliding

GUIDED_RULES = {
    **follower.RULES,
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
class GuidedFollower(follower.Follower):
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
