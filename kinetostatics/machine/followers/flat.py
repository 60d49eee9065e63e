"""Flat follower on a cam that turns with the crank: a slider whose face stands across its guide.

In the axes of the guide, from O, the face is at s(phi) by a law, and touches the cam where that moves along the face
alone: at -s' across the guide, to the left, so that cam force and guide are always parallel. The surface has the radius
of curvature s + s'', which must stay positive (Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 7).
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import root
from ...numbers.planar import minus, plus, turned, unturned, vector
from ..cams.roller import Face
from ..group import Output
from ..links import Wrench
from .follower import GUIDED_RULES, FollowerForces, GuidedFollower

TERMS = {
    "pushed": ("N", "force of the cam along the guide"),
    "lever": ("b", "from the pin to the contact, to the right"),
}
"""What hand calculations call lines of the kernels, and what they are."""


def forces(travel, guide, load, push):
    """Forces on the follower (kernel).

    `push` is the applied force along the guide, `load` all else that acts on the follower, a wrench about its pin.
    """
    along, aside = unturned(vector(load.force), guide.direction)
    pushed = -plus(along, push)
    lever = plus(guide.offset, travel.first)  # of the contact, right of the pin
    return FollowerForces(
        contact=pushed,
        guide_force=-aside,
        guide_moment=minus(minus(None, load.moment), lever * pushed),
        on_follower=Wrench(turned((pushed, 0.0), guide.direction), pushed * travel.first),
    )


@dataclass(frozen=True, eq=False)
class FlatFollower(GuidedFollower):
    """Follower on a straight guide whose flat face, across the guide, rests on a cam fixed to the crank.

    Parameters
    ----------
    cam : Law
        Distance of the face from O along the guide, m, by the crank angle from +x: one of `laws`, or a function that
        gives position and three derivatives. What the cam looks like follows: `disk`.
    guide : Guide
        From O outward; its offset, that of the pin, has to do with the moment on the guide alone.
    follower : Link
        Reference joint `pin`, along the guide; springs and other loads act on it by its name.
    pin : str
        Name of the point of the face on the guide.
    label : str
        Put behind the names of link and forces of a second follower in one mechanism.
    face : Face, optional
        Width and material of the face, for its contact pressure.

    Raises
    ------
    ParameterError
        The law is none, or a value no machine can have; when it is solved: the face comes to O.

    Notes
    -----
    "contact_force" (N), of the cam on the face, positive outward: where it is negative the follower would lift off.
    "guide_force" (N), ground on follower along the guide's left normal, and "guide_moment" (N m) about `pin`; "guide",
    the same force as a vector. "contact_place" (m), of the contact from O along the guide's left normal.
    "curvature_radius" (m), of the cam there: where it is not positive no cam moves the follower so. With a face
    "contact_pressure" (Pa), NaN where the follower would lift off.

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

    face: Face | None = None

    TRUSTED = True
    RULES = checks.Rules("flat follower", **GUIDED_RULES, face=checks.Optional(checks.Made(Face, "a Face")))
    forces = staticmethod(forces)

    @property
    def pressed(self):
        """What the cam presses on: its `Face`, or None."""
        return self.face

    @property
    def led(self):
        return tuple(led._replace(flat=True) for led in super().led)

    def relative_radius(self, name, placement, side):
        """That of the cam; NaN where nothing touches."""
        travel = placement.travels[self.moved]
        return (travel.position + travel.second) * root(side, 1.0)

    @property
    def motions(self):
        return {
            "contact_place" + self.label: Output("m", False, "of the contact, from O along the guide's left normal"),
            "curvature_radius" + self.label: Output("m", False, "of the cam at the contact, positive where convex"),
        }

    def motion(self, name, placement):
        travel = placement.travels[self.moved]
        return -travel.first if name == "contact_place" + self.label else travel.position + travel.second

    def pitch(self, law):
        """Contact and two derivatives at the crank angles of a law's values, complex."""
        along = complex(*self.guide.direction)
        return tuple(along * (part - 1j * slope) for part, slope in pairwise(law))

    def closure(self, placement):
        """Radius of curvature of the cam beside the distance of its contact from O, squared, negative if hollow."""
        travel = placement.travels[self.moved]
        radius, reach = travel.position + travel.second, travel.position
        return radius * abs(radius) / (radius * radius + reach * reach + travel.first * travel.first)

    def requirement(self, placement):
        travel = placement.travels[self.moved]
        smallest = np.min(travel.position + travel.second)
        return f"the cam must be convex, but its radius of curvature s + s'' falls to {smallest:.6g} m"
