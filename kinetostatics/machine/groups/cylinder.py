"""Cylinder group (RPR): rod on a pin, sliding in a cylinder that swings about a fixed pivot.

The slotted lever turned inside out: rod and cylinder point at each other, so their motion is that of a lever without
offset; only the couple of the pair is taken about the pivot.
"""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from ...numbers import checks
from ...numbers.parameter_tree import replace_unchecked
from ...numbers.planar import number_or_zero, scale_vector
from ..group import FRAME, Group, Output, Point, Resolved, joint_reaction, separation
from ..links import Link, Slide, Sliding, Slot, Turning, Wrench
from . import lever, near_dead_centre


@dataclass(frozen=True, eq=False)
class CylinderGroup(checks.Checked, Group):
    """Rod on joint `on`, sliding in a cylinder about the fixed joint `pivot_name`: swinging cylinder.

    The pin must not meet the pivot. A fluid's pressure is a `PointForce` between places on rod and cylinder, as
    ``between=(("rod", along, 0.0), "O2")``; the joint `on` itself belongs to what the rod hangs on.

    Parameters
    ----------
    pivot : (x, y)
        Fixed pivot of the cylinder, m.
    on, pivot_name : str
        Names of the joint it hangs on and of the joint it adds.
    rod : Link
        Reference joint `on`, along the rod into the cylinder, toward the pivot.
    cylinder : Link
        Reference joint `pivot_name`, along the cylinder toward the rod's pin.
    label : str
        Put behind the names of links and forces of a second cylinder group in one mechanism.

    Raises
    ------
    ParameterError
        A value no machine can have.

    Notes
    -----
    Reactions: `on` (N) on the rod, from what carries the joint; `pivot_name` (N), ground on cylinder; "cylinder_force"
    (N), cylinder on rod along the cylinder's left normal, and "cylinder_moment" (N m) about the pivot.
    "cylinder_length" (m) is the distance from pivot to pin.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> engine = ks.Mechanism("oscillating engine", ks.Crank(0.1), (ks.CylinderGroup((0.0, -0.4)),))
    >>> round(float(ks.solve(engine, 0.0, crank_speed=6.0).measure("cylinder_length")), 6)
    0.412311
    """

    pivot: Any
    on: str = "A"
    rod: Link = Link()
    cylinder: Link = Link()
    pivot_name: str = "O2"
    label: str = ""
    is_close: bool = field(default=False, init=False, repr=False)

    TRUSTED = True
    PATHS: ClassVar = {"pivot": "cylinder_pivot"}
    RULES = checks.Rules(
        "cylinder group",
        pivot=checks.Pair("m", "cylinder pivot"),
        on=checks.Name(),
        rod=checks.InstanceOf(Link, "a Link"),
        cylinder=checks.InstanceOf(Link, "a Link"),
        pivot_name=checks.Name(),
        label=checks.Name(may_be_empty=True),
    )

    @property
    def links(self):
        return {self._rod: self.rod, self._cylinder: self.cylinder}

    @property
    def references(self):
        return {self._rod: self.on, self._cylinder: self.pivot_name}

    @property
    def slots(self):
        return (Slot(self._cylinder, self.on, self._rod),)

    @property
    def lengths(self):
        return (*self.pivot, *self.rod.centre, *self.cylinder.centre)

    @property
    def _rod(self):
        return "rod" + self.label

    @property
    def _cylinder(self):
        return "cylinder" + self.label

    @property
    def joints(self):
        return {self.pivot_name: Point(FRAME, *self.pivot)}

    @property
    def outputs(self):
        label, rod, cylinder = self.label, self._rod, self._cylinder
        on, pivot = f"{cylinder} on {rod}", self.pivot_name
        return {
            self.on + label: joint_reaction(rod, self.on),
            pivot: Output("N", True, f"ground on {cylinder}"),
            "cylinder_force" + label: Output("N", False, f"{on} along the left normal of the {cylinder}"),
            "cylinder_moment" + label: Output("N m", False, f"{on} about {pivot}", pivot),
        }

    @property
    def motions(self):
        return {"cylinder_length" + self.label: Output("m", False, f"from {self.pivot_name} to {self.on}")}

    @property
    def pairs(self):
        label, pivot = self.label, self.pivot_name
        force, moment = "cylinder_force" + label, "cylinder_moment" + label
        return {
            self.on + label: Turning(self._rod, self.on),
            pivot: Turning(self._cylinder, pivot),
            "cylinder" + label: Sliding(self._rod, self.on, self._cylinder, force, moment),
        }

    def sliding(self, name, placement):
        motion = placement.details[self._cylinder]
        return Slide(motion.lever.direction, lever.slid(motion))

    def motion(self, name, placement):
        return placement.details[self._cylinder].reach

    def on_crank(self, throws):
        """The group as it is on the pins of a crank: whether its pin comes close to the pivot."""
        throw = throws.get(self.on)
        is_close = throw is not None and near_dead_centre.passes_near_pivot(throw, 0.0, self.pivot)
        return self if is_close is self.is_close else replace_unchecked(self, is_close=is_close)

    def place(self, placement):
        """Add the pivot, rod and cylinder."""
        if self.is_close:
            motion = lever.passed(placement, self.on, self.pivot, None, near_dead_centre.slotted, 1)
        else:
            motion = lever.place(placement.joints[self.on], self.pivot, None, 1)
        placement.joints[self.pivot_name] = motion.lever.joint
        placement.links[self._rod] = motion.block._replace(direction=scale_vector(-1.0, motion.block.direction))
        placement.links[self._cylinder] = motion.lever
        placement.details[self._cylinder] = motion

    def follow(self, placement, joints):
        """Place rod and cylinder: no joint of theirs moves that could be found in another way."""
        self.place(placement)

    def closure(self, placement):
        return placement.details[self._cylinder].closure

    def requirement(self, placement):
        return f"{separation(placement, self.on, self.pivot_name)} be greater than zero"

    def resolve(self, placement, loads, along) -> Resolved:
        on_cylinder = loads[self._cylinder]
        found = lever.resolve(placement.details[self._cylinder], on_cylinder, loads[self._rod])
        return Resolved(
            {self.on + self.label: found.inner, self.pivot_name: found.pivot},
            {
                "cylinder_force" + self.label: found.slot,
                "cylinder_moment" + self.label: number_or_zero(on_cylinder.moment),
            },
            {self.on: Wrench(found.inner, None)},
        )
