"""Roller follower on a cam that turns with the crank: a slider on a guide, its roller pressed outward by the cam.

In the axes of the guide the roller centre is P = (s, e), with s(phi) by a law and e the offset of the guide from O.
Seen from the cam it moves by (s' + e, -s) with the crank angle, along the pitch curve; the cam pushes across that,

    (s, s' + e) / sqrt(s^2 + (s' + e)^2)

so it leans from the guide by the pressure angle, tan = (s' + e) / s (Norton, *Cam Design and Manufacturing Handbook*,
2009, chapter 7). The balance along the guide gives the contact force; of what acts along the guide, F, the crank feels
the moment -F s', whatever the cam looks like.
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.elementary import namespace, sqrt
from ..numbers.planar import dot, minus, number, plus, turned, unturned, vector
from .disk_cam import DiskCam
from .follower_law import Lawful
from .friction import Slide, Sliding
from .group import FRAME, Group, Output, Point, Resolved
from .guide import Guide, guide_outputs, slid
from .links import Joint, Link, LinkMotion, Wrench


class FollowerMotion(NamedTuple):
    """A placed follower: its motion, its coordinate along the guide, and across the pitch curve (along, across)."""

    follower: LinkMotion
    travel: Joint
    across: Any


class FollowerForces(NamedTuple):
    """`contact`: cam on follower, outward positive; `guide_*`: ground on follower; `on_follower`: of the crank."""

    contact: Any
    guide_force: Any
    guide_moment: Any
    on_follower: Wrench


def place(lift, guide):
    """Follower at its coordinate along the guide with two derivatives (kernel)."""
    travel = Joint(*lift)
    follower = slid(None, (travel.position, number(guide.offset)), travel, guide)
    return FollowerMotion(follower, travel, (travel.position, plus(guide.offset, travel.first)))


def resolve(motion, guide, load, push):
    """Forces on the follower (kernel).

    `push` is the applied force along the guide, `load` all else that acts on the follower, a wrench about P.
    """
    along, aside = unturned(vector(load.force), guide.direction)
    pushed = -plus(along, push)
    reach, climb = motion.across
    lean = climb / reach
    normal = turned((pushed, pushed * lean), guide.direction)
    return FollowerForces(
        contact=pushed * sqrt(1.0 + lean * lean),
        guide_force=-(aside + pushed * lean),
        guide_moment=number(minus(None, load.moment)),
        on_follower=Wrench(normal, pushed * motion.travel.first),
    )


@dataclass(frozen=True, eq=False)
class RollerFollower(checks.Checked, Group):
    """Follower on a straight guide whose roller runs on a cam fixed to the crank, as a law of the crank angle says.

    Parameters
    ----------
    cam : Law
        Coordinate of the roller centre along the guide, m, from the foot of O, by the crank angle from +x: one of
        `laws`, or a function that gives position and three derivatives. What the cam looks like follows: `disk`.
    guide : Guide
        From O outward; its offset is that of the roller centre.
    follower : Link
        Reference joint `pin`, along the guide; springs and other loads act on it by its name.
    pin : str
        Name of the roller centre.
    label : str
        Put behind the names of link and forces of a second roller follower in one mechanism.

    Raises
    ------
    ParameterError
        The law is none, or a value no machine can have; when it is solved: the roller centre comes to the foot of O.

    Notes
    -----
    "contact_force" (N), of the cam on the roller along the common normal, positive outward: where it is negative the
    follower would lift off. "guide_force" (N), ground on follower along the guide's left normal, and "guide_moment"
    (N m) about `pin`; "guide", the same force as a vector. "pressure_angle" (rad), of the contact force from the guide.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> s = ks.solve(machine, np.pi / 2, crank_speed=10.0, loads=ks.Spring(5e3, 0.0, on="follower"))
    >>> round(float(s.balancing_torque), 9)  # against -k s s': the spring drives
    -2.5
    >>> round(float(np.degrees(s.scalar("pressure_angle"))), 6)
    -11.309932
    """

    cam: Any
    guide: Guide = Guide()
    follower: Link = Link()
    pin: str = "R"
    label: str = ""

    TRUSTED = True
    PATHS: ClassVar = {"guide": ""}
    RULES = checks.Rules(
        "roller follower",
        cam=Lawful(),
        guide=checks.Made(Guide, "made by Guide.at or .through"),
        follower=checks.Made(Link, "a Link"),
        pin=checks.Name(),
        label=checks.Name(may_be_empty=True),
    )

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
    def motions(self):
        text = "of the contact force from the guide, positive with growing crank angle"
        return {"pressure_angle" + self.label: Output("rad", False, text)}

    @property
    def pairs(self):
        label = self.label
        sliding = Sliding(self._follower, self.pin, FRAME, "guide_force" + label, "guide_moment" + label)
        return {"guide" + label: sliding}

    @property
    def disk(self):
        """The cam itself, in its own axes: those of +x and +y at crank angle 0; for workshop and figures."""
        return DiskCam(self)

    def pitch(self, law):
        """Roller centre and two derivatives at the crank angles of a law's values, complex."""
        along = complex(*self.guide.direction)
        return along * (law.position + 1j * self.guide.guide_offset), along * law.velocity, along * law.acceleration

    def sliding(self, name, placement):
        return Slide(self.guide.line.direction, placement.travels[self._follower].first)

    def motion(self, name, placement):
        reach, climb = placement.details[self._follower].across
        return namespace(climb).atan(climb / reach)

    def place(self, placement):
        self._set(placement, place(self.cam.polar(placement.angle, placement.ray), self.guide.line))

    def follow(self, placement, joints):
        """Place the follower at its roller centre found in another way."""
        pin, direction = joints[self.pin], self.guide.direction
        travel = Joint(*(dot(direction, vector(part)) for part in pin))
        across = travel.position, self.guide.guide_offset + travel.first
        self._set(placement, FollowerMotion(LinkMotion(pin, direction, None, None), travel, across))

    def _set(self, placement, motion):
        placement.joints[self.pin] = motion.follower.joint
        placement.links[self._follower] = motion.follower
        placement.travels[self._follower] = motion.travel
        placement.details[self._follower] = motion

    def closure(self, placement):
        """Squared cosine of the pressure angle, negative where the roller centre is behind the foot of O."""
        reach, climb = placement.details[self._follower].across
        return reach * abs(reach) / (reach * reach + climb * climb)

    def requirement(self, placement):
        lowest = np.min(placement.travels[self._follower].position)
        return f"the roller centre must stay ahead of O along its guide, but its coordinate falls to {lowest:.6g} m"

    def elongation(self, placement, free_position):
        """Coordinate of the roller centre along the guide less a free position, m."""
        return placement.travels[self._follower].position - free_position

    def resolve(self, placement, loads, along) -> Resolved:
        motion, guide, label = placement.details[self._follower], self.guide.line, self.label
        found = resolve(motion, guide, loads[self._follower], along.get(self._follower))
        scalars = {
            "contact_force" + label: found.contact,
            "guide_force" + label: found.guide_force,
            "guide_moment" + label: found.guide_moment,
        }
        on_follower = turned((0.0, found.guide_force), guide.direction)
        return Resolved({"guide" + label: on_follower}, scalars, {"crank": found.on_follower})
