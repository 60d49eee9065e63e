"""Cylinder group (RPR): rod on a pin, sliding in a cylinder that swings about a fixed pivot.

The slotted lever turned inside out: rod and cylinder point at each other, so their motion is that of a lever without
offset; only the couple of the pair is taken about the pivot.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

from ...numbers import checks
from ...numbers.planar import number_or_zero, scale_vector
from ..group import FRAME, Declaration, Group, Output, Point, Resolved, rules_of_parts, separation
from ..links import Link, Slide, Sliding, Slot, Turning, Wrench
from . import lever, near_dead_centre
from .branches import Branch


@dataclass(frozen=True, eq=False)
class CylinderGroup(checks.Checked, Branch, Group):
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
        Appended to the names of links and forces of a second cylinder group in one mechanism.

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

    LINKS: ClassVar = {"rod": "on", "cylinder": "pivot_name"}
    TRUSTED = True
    PATHS: ClassVar = {"pivot": "cylinder_pivot"}
    assembly: ClassVar = 1
    kernels = None, near_dead_centre.slotted
    RULES = checks.Rules(
        "cylinder group",
        pivot=checks.Pair("m", "cylinder pivot"),
        **rules_of_parts(("rod", "cylinder"), "on", "pivot_name"),
    )

    @property
    def declaration(self):
        return Declaration(
            joints={self.pivot_name: Point(FRAME, *self.pivot)},
            slots=(Slot("cylinder", self.on, "rod"),),
            inner=(Turning("rod", self.on),),
            pairs=(
                Turning("cylinder", self.pivot_name),
                Sliding("rod", self.on, "cylinder", "cylinder_force", "cylinder_moment", self.pivot_name),
            ),
            motions={"cylinder_length": Output("m", False, f"from {self.pivot_name} to {self.on}")},
            lengths=self.pivot,
        )

    def sliding(self, name, placement):
        motion = self.placed(placement)
        return Slide(motion.lever.direction, lever.slid(motion))

    motion, follow = lever.LeverGroup.motion, lever.LeverGroup.follow

    @property
    def clearance(self):
        """Offset and pivot, for `near_dead_centre.has_small_clearance`."""
        return 0.0, self.pivot

    def place(self, placement):
        if self.branch:
            motion = lever.passed(placement, self.on, self.pivot, None, *self.branch)
        else:
            motion = lever.place(placement.joints[self.on], self.pivot, None, 1)
        rod = motion.block._replace(direction=scale_vector(-1.0, motion.block.direction))
        self.enter(placement, motion, {self.pivot_name: motion.lever.joint}, {"rod": rod, "cylinder": motion.lever})

    def requirement(self, placement):
        return f"{separation(placement, self.on, self.pivot_name)} be greater than zero"

    def resolve(self, placement, loads, along) -> Resolved:
        on_rod, on_cylinder = self.of_links(loads)
        found = lever.resolve(self.placed(placement), on_cylinder, on_rod)
        scalars = found.slot, number_or_zero(on_cylinder.moment)
        return self.resolved((found.inner, found.pivot), scalars, {self.on: Wrench(found.inner, None)})
