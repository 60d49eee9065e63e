"""What all followers of a cam on the crank have in common: the cam itself, the force of contact and its pressure."""

from typing import Any

from ..numbers import checks
from ..numbers.planar import curvature, left, stretched, subtracted
from .declared import Led
from .disk_cam import DiskCam
from .follower_law import Lawful
from .group import Group, Output
from .roller import Touch

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
