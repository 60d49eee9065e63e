"""Roller follower on a cam that turns with the crank: a slider on a guide, its roller pressed outward by the cam.

In the axes of the guide the roller centre is P = (s, e), with s(phi) by a law and e the offset of the guide from O.
Seen from the cam it moves by (s' + e, -s) with the crank angle, along the pitch curve; the cam pushes across that,

    (s, s' + e) / sqrt(s^2 + (s' + e)^2)

so it leans from the guide by the pressure angle, tan = (s' + e) / s (Norton, *Cam Design and Manufacturing Handbook*,
2009, chapter 7). The balance along the guide gives the contact force; of what acts along the guide, F, the crank feels
the moment -F s', whatever the cam looks like.
"""

from dataclasses import dataclass

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan, sqrt
from ...numbers.planar import minus, number, plus, turned, unturned, vector
from ..cams.roller import Roller
from ..group import Output
from ..links import Wrench
from .follower import GUIDED_RULES, FollowerForces, GuidedFollower

TERMS = {
    "pushed": ("N", "force of the cam along the guide"),
    "lean": ("tau", "tangent of the pressure angle"),
}
"""What hand calculations call lines of the kernels, and what they are."""


def forces(travel, guide, load, push):
    """Forces on the follower (kernel).

    `push` is the applied force along the guide, `load` all else that acts on the follower, a wrench about P.
    """
    along, aside = unturned(vector(load.force), guide.direction)
    pushed = -plus(along, push)
    lean = plus(guide.offset, travel.first) / travel.position
    return FollowerForces(
        contact=pushed * sqrt(1.0 + lean * lean),
        guide_force=-(aside + pushed * lean),
        guide_moment=number(minus(None, load.moment)),
        on_follower=Wrench(turned((pushed, pushed * lean), guide.direction), pushed * travel.first),
    )


@dataclass(frozen=True, eq=False)
class RollerFollower(GuidedFollower):
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
    roller : Roller, optional
        Size and material of the roller, for its contact pressure.

    Raises
    ------
    ParameterError
        The law is none, or a value no machine can have; when it is solved: the roller centre comes to the foot of O.

    Notes
    -----
    "contact_force" (N), of the cam on the roller along the common normal, positive outward: where it is negative the
    follower would lift off. "guide_force" (N), ground on follower along the guide's left normal, and "guide_moment"
    (N m) about `pin`; "guide", the same force as a vector. "pressure_angle" (rad), of the contact force from the guide;
    "cam_radius" (m), of the roller centre from O.
    With a roller "contact_pressure" (Pa), where the force is negative on a ring around the pitch curve.

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

    roller: Roller | None = None

    TRUSTED = True
    RULES = checks.Rules("roller follower", **GUIDED_RULES, roller=checks.Optional(checks.Made(Roller, "a Roller")))
    forces = staticmethod(forces)

    @property
    def rollers(self):
        return {self.pin: None if self.roller is None else self.roller.radius}

    @property
    def pressed(self):
        """What the cam presses on: its `Roller`, or None."""
        return self.roller

    @property
    def motions(self):
        text = "of the contact force from the guide, positive with growing crank angle"
        return {
            "pressure_angle" + self.label: Output("rad", False, text),
            "cam_radius" + self.label: Output("m", False, "of the pitch curve, from O to the roller centre"),
        }

    def motion(self, name, placement):
        if name == "cam_radius" + self.label:
            position, offset = placement.travels[self.moved].position, number(self.guide.line.offset)
            return sqrt(position * position + offset * offset)
        reach, climb = self._across(placement)
        return atan(climb / reach)

    def pitch(self, law):
        """Roller centre and two derivatives at the crank angles of a law's values, complex."""
        along = complex(*self.guide.direction)
        return along * (law.position + 1j * self.guide.guide_offset), along * law.velocity, along * law.acceleration

    def _across(self, placement):
        """Across the pitch curve, along the guide and to its left, not of length 1."""
        travel = placement.travels[self.moved]
        return travel.position, plus(self.guide.line.offset, travel.first)

    def closure(self, placement):
        """Squared cosine of the pressure angle, negative where the roller centre is behind the foot of O."""
        reach, climb = self._across(placement)
        return reach * abs(reach) / (reach * reach + climb * climb)

    def requirement(self, placement):
        lowest = np.min(placement.travels[self.moved].position)
        return f"the roller centre must stay ahead of O along its guide, but its coordinate falls to {lowest:.6g} m"
