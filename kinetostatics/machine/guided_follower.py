"""What followers on a straight guide have in common, whatever face they show to a cam that turns with the crank.

Their coordinate s(phi) along the guide is a law, so motion is exact, and of what acts along the guide, F, the crank
feels the moment -F s', whatever the cam looks like.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from ..numbers import checks
from ..numbers.planar import dot, number, turned, vector
from .disk_cam import DiskCam
from .follower_law import Lawful
from .friction import Slide, Sliding
from .group import FRAME, Group, Output, Point, Resolved
from .guide import Guide, guide_outputs, slid
from .links import Joint, Link, LinkMotion, Wrench

RULES = {
    "cam": Lawful(),
    "guide": checks.Made(Guide, "made by Guide.at or .through"),
    "follower": checks.Made(Link, "a Link"),
    "pin": checks.Name(),
    "label": checks.Name(may_be_empty=True),
}


class FollowerForces(NamedTuple):
    """`contact`: cam on follower, outward positive; `guide_*`: ground on follower; `on_follower`: of the crank."""

    contact: Any
    guide_force: Any
    guide_moment: Any
    on_follower: Wrench


@dataclass(frozen=True, eq=False)
class GuidedFollower(checks.Checked, Group):
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
        return {self._follower: self.follower}

    @property
    def references(self):
        return {self._follower: self.pin}

    @property
    def lengths(self):
        return (*getattr(self.cam, "lengths", ()), self.guide.guide_offset, *self.follower.centre)

    @property
    def hangs_on(self):
        return ("O",)

    @property
    def _follower(self):
        return "follower" + self.label

    @property
    def joints(self):
        return {self.pin: Point(self._follower)}

    @property
    def guides(self):
        return {self._follower: self.guide}

    @property
    def outputs(self):
        text = f"cam on {self._follower} along the common normal, positive outward"
        return {
            "contact_force" + self.label: Output("N", False, text),
            **guide_outputs(self._follower, self.pin, self.label),
        }

    @property
    def pairs(self):
        label = self.label
        sliding = Sliding(self._follower, self.pin, FRAME, "guide_force" + label, "guide_moment" + label)
        return {"guide" + label: sliding}

    @property
    def disk(self):
        """The cam itself, in its own axes: those of +x and +y at crank angle 0; for workshop and figures."""
        return DiskCam(self)

    @property
    def outlines(self):
        return {"crank": self.disk.outline}

    def sliding(self, name, placement):
        return Slide(self.guide.line.direction, placement.travels[self._follower].first)

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
        placement.links[self._follower] = follower
        placement.travels[self._follower] = travel

    def elongation(self, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m."""
        return placement.travels[self._follower].position - free_position

    def resolve(self, placement, loads, along) -> Resolved:
        guide, label = self.guide.line, self.label
        travel, load = placement.travels[self._follower], loads[self._follower]
        found = type(self).forces(travel, guide, load, along.get(self._follower))
        scalars = {
            "contact_force" + label: found.contact,
            "guide_force" + label: found.guide_force,
            "guide_moment" + label: found.guide_moment,
        }
        on_follower = turned((0.0, found.guide_force), guide.direction)
        return Resolved({"guide" + label: on_follower}, scalars, {"crank": found.on_follower})
