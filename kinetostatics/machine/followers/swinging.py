"""Swinging roller follower on a cam that turns with the crank: an arm about a fixed pivot, pressed outward by the cam.

The arm stands at the angle beta(phi) from the line from its pivot Q to O, on the side that `assembly` selects. With l
the arm along p, the roller centre is P = Q + l p. Seen from the cam it moves by w = P' - left(P) with the crank angle.
The cam pushes across that, by left(w) / |w|, whose lever about Q is l times the cosine of the pressure angle,

    cosine = -(Q x p) / |w|,   Q x p = assembly |Q| sin(beta)

(Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 7). Moments about the pivot give the contact force. Of
M, the moment of all loads on the arm about it, the crank feels -M dtheta/dphi for any shape of the cam.
"""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan, cos, sin
from ...numbers.planar import cross, dot, left, length, number_or_zero, rotate, scale_vector, subtract_vectors
from ..cams.roller import OptionalRoller
from ..dimensions import Span, of_fixed_point
from ..group import FRAME, Bar, Declaration, GroupLink, Name, Output, Point, Resolved
from ..links import Joint, Link, LinkMotion, Turning, Wrench, link_between
from .follower import Follower

TERMS = {
    "distance": ("a", "from O to the pivot"),
    "inward": ("n", "unit vector from the pivot to O"),
    "reach": ("h", "from the pivot to the roller centre"),
}


class SwingingMotion(NamedTuple):
    """Motion of a follower; `across`: rate of the roller centre along the cam, turned outward; `lever`: Q x p."""

    arm: LinkMotion
    roller: Joint
    across: Any
    lever: Any


def place(swing, pivot, arm_length, side):
    """Arm at its angle from the line of centres with two derivatives (kernel)."""
    angle, first, second = swing
    distance = length(pivot)
    inward = (-pivot[0] / distance, -pivot[1] / distance)
    direction = rotate(inward, (cos(angle), -side * sin(angle)))
    ratio, slope = -side * first, -side * second
    reach = scale_vector(arm_length, direction)
    aside = left(reach)
    roller = Joint(
        (pivot[0] + reach[0], pivot[1] + reach[1]),
        scale_vector(ratio, aside),
        subtract_vectors(scale_vector(slope, aside), scale_vector(ratio * ratio, reach)),
    )
    arm = LinkMotion(Joint(pivot, None, None), direction, ratio, slope)
    return _met(arm, roller, side * distance * sin(angle))


def _met(arm, roller, lever):
    return SwingingMotion(arm, roller, left(subtract_vectors(roller.first, left(roller.position))), lever)


def resolve(motion, arm_length, load):
    """Force of the cam on the roller, of the ground on the arm, and wrench of the crank on the arm (kernel).

    `load` is the wrench of all others about the pivot.
    """
    couple = number_or_zero(load.moment)
    force = couple / (arm_length * motion.lever)
    pressed = scale_vector(force, motion.across)
    contact = force * length(motion.across)
    pivot = subtract_vectors(subtract_vectors(None, pressed), load.force)
    return contact, pivot, Wrench(pressed, -couple * motion.arm.ratio)


@dataclass(frozen=True, eq=False)
class SwingingFollower(Follower):
    """Arm about the fixed joint `pivot_name` whose roller runs on a cam fixed to the crank, by a law.

    Parameters
    ----------
    cam : Law
        Angle at the pivot from the direction to O to the roller centre, rad, between 0 and pi, by the crank angle from
        +x. One of `laws`, with rad for m, or a function that gives position and three derivatives. `disk` is the cam.
    arm_length : float or array
        From pivot to roller centre, m.
    pivot : (x, y)
        Fixed pivot, m.
    assembly : +1 or -1
        +1: the roller centre to the left of the direction from O to the pivot.
    arm : Link
        Reference joint `pivot_name`, along the direction to the roller centre; torsion springs and other loads act on
        it by its name.
    pin, pivot_name : str
        Names of the roller centre and of the pivot.
    label : str
        Appended to the names of link and forces of a second swinging follower in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).
    roller : Roller, optional
        Size and material of the roller, for its contact pressure.

    Raises
    ------
    ParameterError
        The law is invalid, or a value is impossible; when it is solved, the arm crosses the line of centres.

    Notes
    -----
    Results:

    - "contact_force" (N): cam on roller along the common normal, positive outward. Where it is negative the follower
      would lift off.
    - `pivot_name` (N): ground on arm, a vector.
    - "pressure_angle" (rad): angle of the contact force from the path of the roller centre.
    - "contact_pressure" (Pa), with a roller: where the force is negative on a ring around the pitch curve.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> swing = ks.laws.cosine(0.1, 0.5)
    >>> follower = ks.SwingingFollower(swing, 0.1, (0.12, 0.0), arm=ks.Link(2.0, (0.05, 0.0), 0.002))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> s = ks.solve(machine, np.pi / 2, crank_speed=10.0, loads=ks.Torque(30.0, on="arm"))
    >>> round(float(s.balancing_torque), 9)  # the spring's 30 N m on an arm that turns by 0.1 rad a rad
    -3.0
    """

    cam: Any
    arm_length: Annotated[Any, checks.Number("m", "arm length", low=0.0, strict=True)]
    pivot: Annotated[Any, checks.Pair("m", "follower pivot")]
    assembly: Annotated[int, checks.Sign()] = 1
    arm: GroupLink = Link()
    pin: str = "R"
    pivot_name: Name = "Q"
    label: str = ""
    roller: OptionalRoller = None
    plane: Any = None

    def _pivot_apart(self):
        """Yield the problem of a pivot at O."""
        x, y = self.pivot
        if checks.has_known_values(x * x + y * y) and np.any(at := np.hypot(x, y) == 0.0):
            yield checks.Problem("the follower's pivot must not be at O", at)

    LINKS: ClassVar = {"arm": "pivot_name"}
    TRUSTED = True
    LAW = ("beta", "rad")
    PATHS: ClassVar = {"pivot": "follower_pivot", "plane": "arm_plane"}
    RULES = checks.Rules("swinging follower", _pivot_apart)

    @property
    def declaration(self):
        text = "of the contact force from the way of the roller centre, without sign"
        return self.with_cam(
            Declaration(
                joints={self.pin: Point("arm", self.arm_length), self.pivot_name: Point(FRAME, *self.pivot)},
                bars=(Bar(self.pivot_name, self.pin, "arm", self.arm_length),),
                pairs=(Turning("arm", self.pivot_name),),
                motions={"pressure_angle": Output("rad", False, text)},
                lengths=(self.arm_length, *self.pivot),
            )
        )

    def pitch(self, law):
        """Roller centre and two derivatives at the crank angles of a law's values, complex."""
        placed = place(law[:3], self.pivot, self.arm_length, self.assembly).roller
        return tuple(x + 1j * y for x, y in placed)

    @property
    def dimensions(self):
        pivot = of_fixed_point("pivot", self.pivot_name)
        return {**super().dimensions, ("arm_length",): Span(self.pivot_name, self.pin), **pivot}

    def motion(self, name, placement):
        found = self.placed(placement)
        sine = dot(found.arm.direction, found.across)
        return atan(abs(sine / found.lever))

    def place(self, placement):
        swing = self.cam.polar(placement.angle, placement.ray)
        self._enter(placement, place(swing, self.pivot, self.arm_length, self.assembly))

    def follow(self, placement, joints):
        """Place the arm at its known roller centre."""
        roller = joints[self.pin]
        arm = link_between(Joint(self.pivot, None, None), roller, self.arm_length)
        self._enter(placement, _met(arm, roller, cross(self.pivot, arm.direction)))

    def _enter(self, placement, motion):
        self.enter(placement, motion, {self.pin: motion.roller, self.pivot_name: motion.arm.joint}, {"arm": motion.arm})

    def closure(self, placement):
        """Squared cosine of the pressure angle, negative where the arm is on the other side of the line of centres."""
        found = self.placed(placement)
        return self.assembly * found.lever * abs(found.lever) / dot(found.across, found.across)

    def requirement(self, placement):
        return (
            f"the {self.moved} must stay on its side of the line from O to {self.pivot_name}, its angle from it "
            "between 0 and pi"
        )

    def resolve(self, placement, loads, along) -> Resolved:
        contact, pivot, on_arm = resolve(self.placed(placement), self.arm_length, *self.of_links(loads))
        return self.resolved((pivot,), (contact,), {"crank": on_arm})
