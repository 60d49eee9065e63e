"""Roller and flat followers on a straight guide, moved by a cam that turns with the crank.

In the axes of the guide the pin is P = (s, e), with s(phi) by a law and e the offset of the guide from O. Of the force
along the guide, F, the crank feels the moment -F s' for any shape of the cam.

A roller centre moves by (s' + e, -s) along the pitch curve, seen from the cam, which pushes across that:

    (s, s' + e) / sqrt(s^2 + (s' + e)^2)

so the contact force is inclined to the guide by the pressure angle, tan = (s' + e) / s. A flat face touches the cam at
-s' across the guide, to the left, with a force along the guide. The cam has the radius of curvature s + s'', which must
stay positive (Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 7).
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, ClassVar

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan, clamped_sqrt, sqrt
from ...numbers.planar import minus, number_or_zero, plus, rotate, rotate_back, vector_or_zero
from ..cams.roller import Face, OptionalRoller
from ..dimensions import within
from ..group import EMPTY, FRAME, Declaration, GroupLink, Output, Point, Resolved
from ..guide import Guide, SliderGuide, known_slider, slider_motion
from ..links import Joint, Link, Slide, Sliding, Wrench
from .follower import Follower

TERMS = {
    "pushed": ("N", "force of the cam along the guide"),
    "lean": ("tau", "tangent of the pressure angle"),
    "lever": ("b", "from the pin to the contact, to the right"),
}


@dataclass(frozen=True, eq=False)
class GuidedFollower(Follower):
    """Follower on a guide, moved by a cam on the crank; its kinds give ``forces(travel, guide, load, push)``."""

    cam: Any
    guide: SliderGuide = Guide()
    follower: GroupLink = Link()
    pin: str = "R"
    label: str = ""

    LINKS: ClassVar = {"follower": "pin"}
    LAW = ("s", "m")
    MOTIONS: ClassVar[dict[str, Output]]
    PATHS: ClassVar = {"guide": "", "plane": "follower_plane"}
    forces: ClassVar[Any]

    @property
    def declaration(self):
        return self.with_cam(
            Declaration(
                joints={self.pin: Point("follower")},
                guides={"follower": self.guide},
                pairs=(Sliding("follower", self.pin, FRAME, "guide_force", "guide_moment"),),
                motions=self.MOTIONS,
                lengths=(*getattr(self.cam, "lengths", ()), self.guide.guide_offset),
            )
        )

    @property
    def dimensions(self):
        return {**super().dimensions, **within("guide", self.guide.dimensions(self.pin))}

    def sliding(self, name, placement):
        return Slide(self.guide.line.direction, placement.travels[self.moved].first)

    def place(self, placement):
        travel, line = Joint(*self.cam.polar(placement.angle, placement.ray)), self.guide.line
        self._enter(
            placement, slider_motion(None, (travel.position, number_or_zero(line.offset)), travel, line), travel
        )

    def follow(self, placement, joints):
        """Place the follower at its known pin."""
        self._enter(placement, *known_slider(joints[self.pin], self.guide.direction))

    def _enter(self, placement, follower, travel):
        self.enter(placement, travel, {self.pin: follower.joint}, {"follower": follower}, {"follower": travel})

    def resolve(self, placement, loads, along) -> Resolved:
        guide, (load,), (push,) = self.guide.line, self.of_links(loads), self.of_links(along)
        *scalars, on_follower = type(self).forces(placement.travels[self.moved], guide, load, push)
        of_guide = rotate((0.0, scalars[1]), guide.direction)
        return self.resolved((of_guide,), scalars, {"crank": on_follower})


def roller_forces(travel, guide, load, push):
    """Forces of cam and ground on the follower, moment of the ground, and wrench of the crank (kernel).

    `push` is the applied force along the guide, `load` all else that acts on the follower, a wrench about P.
    """
    along, aside = rotate_back(vector_or_zero(load.force), guide.direction)
    pushed = -plus(along, push)
    lean = plus(guide.offset, travel.first) / travel.position
    contact = pushed * sqrt(1.0 + lean * lean)
    guide_force = -(aside + pushed * lean)
    guide_moment = number_or_zero(minus(None, load.moment))
    on_follower = Wrench(rotate((pushed, pushed * lean), guide.direction), pushed * travel.first)
    return contact, guide_force, guide_moment, on_follower


@dataclass(frozen=True, eq=False)
class RollerFollower(GuidedFollower):
    """Follower on a straight guide whose roller runs on a cam fixed to the crank, by a law of the crank angle.

    Parameters
    ----------
    cam : Law
        Coordinate of the roller centre along the guide, m, from the foot of O, by the crank angle from +x. One of
        `laws`, or a function that gives position and three derivatives. `disk` is the cam that follows.
    guide : Guide
        From O outward; its offset is that of the roller centre.
    follower : Link
        Reference joint `pin`, along the guide; springs and other loads act on it by its name.
    pin : str
        Name of the roller centre.
    label : str
        Appended to the names of link and forces of a second roller follower in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).
    roller : Roller, optional
        Size and material of the roller, for its contact pressure.

    Raises
    ------
    ParameterError
        The law is invalid, or a value is impossible; when it is solved, the roller centre reaches the foot of O.

    Notes
    -----
    Results:

    - "contact_force" (N): cam on roller along the common normal, positive outward. Where it is negative the follower
      would lift off.
    - "guide_force" (N): ground on follower along the guide's left normal; "guide_moment" (N m): about `pin`.
    - "guide" (N): the guide force as a vector.
    - "pressure_angle" (rad): angle of the contact force from the guide.
    - "cam_radius" (m): distance of the roller centre from O.
    - "contact_pressure" (Pa), with a roller: where the force is negative on a ring around the pitch curve.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> s = ks.solve(machine, np.pi / 2, crank_speed=10.0, loads=ks.Spring(5e3, 0.0, on="follower"))
    >>> round(float(s.balancing_torque), 9)  # against -k s s': the spring drives
    -2.5
    >>> round(float(np.degrees(s.measure("pressure_angle"))), 6)
    -11.309932
    """

    roller: OptionalRoller = None
    plane: Any = None

    TRUSTED = True
    RULES = checks.Rules("roller follower")
    MOTIONS: ClassVar = {
        "pressure_angle": Output(
            "rad", False, "of the contact force from the guide, positive with growing crank angle"
        ),
        "cam_radius": Output("m", False, "of the pitch curve, from O to the roller centre"),
    }
    forces = staticmethod(roller_forces)

    def motion(self, name, placement):
        if name == self.called("cam_radius"):
            position, offset = placement.travels[self.moved].position, number_or_zero(self.guide.line.offset)
            return sqrt(position * position + offset * offset)
        reach, climb = self._across(placement)
        return atan(climb / reach)

    def pitch(self, law):
        """Roller centre and two derivatives at the crank angles of a law's values, complex."""
        along, (position, first, second, _) = complex(*self.guide.direction), law
        return along * (position + 1j * self.guide.guide_offset), along * first, along * second

    def _across(self, placement):
        """Normal of the pitch curve, along the guide and to its left, not of length 1."""
        travel = placement.travels[self.moved]
        return travel.position, plus(self.guide.line.offset, travel.first)

    def closure(self, placement):
        """Squared cosine of the pressure angle, negative where the roller centre is behind the foot of O."""
        reach, climb = self._across(placement)
        return reach * abs(reach) / (reach * reach + climb * climb)

    def requirement(self, placement):
        lowest = np.min(placement.travels[self.moved].position)
        return f"the roller centre must stay ahead of O along its guide, but its coordinate falls to {lowest:.6g} m"


def flat_forces(travel, guide, load, push):
    """The same for a flat face (kernel)."""
    along, aside = rotate_back(vector_or_zero(load.force), guide.direction)
    pushed = -plus(along, push)
    lever = plus(guide.offset, travel.first)  # of the contact, right of the pin
    guide_force = -aside
    guide_moment = minus(minus(None, load.moment), lever * pushed)
    on_follower = Wrench(rotate((pushed, 0.0), guide.direction), pushed * travel.first)
    return pushed, guide_force, guide_moment, on_follower


@dataclass(frozen=True, eq=False)
class FlatFollower(GuidedFollower):
    """Follower on a straight guide whose flat face, across the guide, rests on a cam fixed to the crank.

    Parameters
    ----------
    cam : Law
        Distance of the face from O along the guide, m, by the crank angle from +x: one of `laws`, or a function that
        gives position and three derivatives. `disk` is the cam that follows.
    guide : Guide
        From O outward; its offset is the offset of the pin and affects only the moment on the guide.
    follower : Link
        Reference joint `pin`, along the guide; springs and other loads act on it by its name.
    pin : str
        Name of the point of the face on the guide.
    label : str
        Appended to the names of link and forces of a second follower in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).
    face : Face, optional
        Width and material of the face, for its contact pressure.

    Raises
    ------
    ParameterError
        The law is invalid, or a value is impossible; when it is solved, the face reaches O.

    Notes
    -----
    Results:

    - "contact_force" (N): cam on face, positive outward. Where it is negative the follower would lift off.
    - "guide_force" (N): ground on follower along the guide's left normal; "guide_moment" (N m): about `pin`.
    - "guide" (N): the guide force as a vector.
    - "contact_place" (m): coordinate of the contact from O along the guide's left normal.
    - "curvature_radius" (m): radius of the cam at the contact. Where it is not positive, no cam gives this motion.
    - "contact_pressure" (Pa), with a face: NaN where the follower would lift off.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> follower = ks.FlatFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> s = ks.solve(machine, np.pi / 2, crank_speed=10.0, loads=ks.Spring(5e3, 0.0, on="follower"))
    >>> round(float(s.measure("contact_place")), 12), round(float(s.scalar("contact_force")), 9)
    (0.01, 250.0)
    """

    face: Annotated[Face | None, checks.Optional(checks.InstanceOf(Face, "a Face"))] = None
    plane: Any = None

    TRUSTED = True
    RULES = checks.Rules("flat follower")
    MOTIONS: ClassVar = {
        "contact_place": Output("m", False, "of the contact, from O along the guide's left normal"),
        "curvature_radius": Output("m", False, "of the cam at the contact, positive where convex"),
    }
    forces = staticmethod(flat_forces)
    rollers = EMPTY
    BODY = "face"

    def relative_radius(self, name, placement, side):
        """Radius of curvature of the cam; NaN without contact."""
        travel = placement.travels[self.moved]
        return (travel.position + travel.second) * clamped_sqrt(side, 1.0)

    def motion(self, name, placement):
        travel = placement.travels[self.moved]
        return -travel.first if name == self.called("contact_place") else travel.position + travel.second

    def pitch(self, law):
        """Contact and two derivatives at the crank angles of a law's values, complex."""
        along = complex(*self.guide.direction)
        return tuple(along * (part - 1j * slope) for part, slope in pairwise(law))

    def closure(self, placement):
        """Squared ratio of the cam's radius of curvature to the distance of its contact from O, negative if hollow."""
        travel = placement.travels[self.moved]
        radius, reach = travel.position + travel.second, travel.position
        return radius * abs(radius) / (radius * radius + reach * reach + travel.first * travel.first)

    def requirement(self, placement):
        travel = placement.travels[self.moved]
        smallest = np.min(travel.position + travel.second)
        return f"the cam must be convex, but its radius of curvature s + s'' falls to {smallest:.6g} m"
