"""Yoke group (RPP): block on a pin, sliding in the straight slot of a slider on a straight guide (Scotch yoke).

In the axes of the guide, at offset e, a slot at the angle beta through joint A at (x, y) meets the guide at x - (y - e)
cot(beta). The travel is linear in the motion of A, so there is neither dead centre nor limit position.
"""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import cos, sin
from ...numbers.planar import (
    minus,
    number_or_zero,
    plus,
    rotate,
    rotate_back,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
)
from ..dimensions import Angle, within
from ..group import FRAME, Declaration, Group, GroupLink, Label, Name, Plane, Point, Resolved
from ..guide import Guide, SliderGuide, known_slider, slider_motion
from ..links import Joint, Link, LinkMotion, Slide, Sliding, Slot, Turning

MIN_SLOT_SINE = 1e-9
"""Sine of the slot's angle below which the slot counts as parallel to the guide."""
TERMS = {
    "lean": ("lambda", "cotangent of the angle of the slot"),
    "rise": ("h", "height of the joint over the guide"),
    "back": ("b", "from the joint back to the pin along the guide"),
    "resolve.along": ("Q", "force on the slider along its guide"),
    "resolve.across": ("V", "force on the slider across its guide"),
}


class YokeMotion(NamedTuple):
    """A placed yoke group; `rise` is the height of joint A over the guide, `slot` the slot's (cosine, sine)."""

    block: LinkMotion
    slider: LinkMotion
    travel: Joint
    rise: Any
    slot: Any


def place(joint, guide, slot_angle):
    """Block and slider for a given joint (kernel); a guide direction of None is +x, an offset of None zero."""
    slot = cos(slot_angle), sin(slot_angle)
    lean = slot[0] / slot[1]
    (x, y), first, second = (rotate_back(vector_or_zero(part), guide.direction) for part in joint)
    rise = minus(y, guide.offset)
    back = -lean * rise
    travel = Joint(x + back, first[0] - lean * first[1], second[0] - lean * second[1])
    slider = slider_motion(joint.position, (back, -rise), travel, guide)
    return YokeMotion(LinkMotion(joint, rotate(slot, guide.direction), None, None), slider, travel, rise, slot)


def resolve(motion, guide, block_load, slider_load, push):
    """Reactions at `on` and of the guide; force and moment of slot and guide; `push` along the guide (kernel)."""
    cosine, sine = motion.slot
    along, across = rotate_back(vector_or_zero(slider_load.force), guide.direction)
    slot = -plus(along, push) / sine
    couple = minus(None, block_load.moment)
    on_block = scale_vector(slot, rotate((-sine, cosine), guide.direction))
    inner = subtract_vectors(subtract_vectors(None, on_block), block_load.force)
    guide_force = cosine * slot - across
    guide_moment = plus(minus(couple, slider_load.moment), motion.rise / sine * slot)
    scalars = slot, number_or_zero(couple), guide_force, guide_moment
    return (inner, rotate((0.0, guide_force), guide.direction)), scalars


@dataclass(frozen=True, eq=False)
class YokeGroup(checks.Checked, Group):
    """Block on joint `on` in the slot of a slider on `guide`: a Scotch yoke.

    The slider's joint `pin` is where the line through `on` along the slot meets the guide.

    Parameters
    ----------
    guide : Guide
    slot_angle : float or array
        From the guide's direction, counter-clockwise, rad; not 0 or pi.
    on, pin : str
        Names of the joint it is attached to and of the joint it adds.
    slider : Link
        Reference joint `pin`, along the guide.
    block : Link
        Reference joint `on`, along the slot; it does not turn.
    label : str
        Appended to the names of links and forces of a second yoke group in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        The slot is parallel to the guide, or a value is impossible.

    Notes
    -----
    Results:

    - `on` (N): on the block, from the link that carries the joint.
    - "slot_force" (N): slider on block along the slot's left normal; "slot_moment" (N m): about `on`.
    - "guide_force" (N): ground on slider along the guide's left normal; "guide_moment" (N m): about `pin`.
    - "guide" (N): the guide force as a vector.

    Examples
    --------
    >>> import math
    >>> import kinetostatics as ks
    >>> yoke = ks.YokeGroup(ks.Guide.at(0.0), slider=ks.Link(mass=5.0))
    >>> pump = ks.Mechanism("pump", ks.Crank(0.1), (yoke,))
    >>> round(float(ks.solve(pump, math.pi / 3, crank_speed=10.0).slider_position), 12)
    0.05
    """

    guide: SliderGuide = Guide()
    slot_angle: Annotated[Any, checks.Number("rad")] = np.pi / 2
    on: Name = "A"
    pin: Name = "B"
    slider: GroupLink = Link()
    block: GroupLink = Link()
    label: Label = ""
    plane: Plane = None

    def _parallel_slot_problem(self):
        """Yield the problem of designs whose slot is parallel to the guide."""
        if checks.has_known_values(self.slot_angle) and np.any(
            parallel := np.abs(np.sin(self.slot_angle)) < MIN_SLOT_SINE
        ):
            angle = np.broadcast_to(self.slot_angle, np.shape(parallel))[parallel].flat[0]
            yield checks.Problem(
                f"slot_angle {angle:.6g} rad makes the slot parallel to the guide; it must differ from 0 and pi, as "
                "pi/2 does",
                parallel,
            )

    LINKS: ClassVar = {"block": "on", "slider": "pin"}
    TRUSTED = True
    PATHS: ClassVar = {"guide": "", "plane": "block_plane"}
    RULES = checks.Rules("yoke group", _parallel_slot_problem)

    @property
    def declaration(self):
        return Declaration(
            joints={self.pin: Point("slider")},
            guides={"slider": self.guide},
            slots=(Slot("slider", self.on, angle=self.slot_angle),),
            pairs=(
                Turning("block", self.on),
                Sliding("slider", self.pin, FRAME, "guide_force", "guide_moment"),
                Sliding("block", self.on, "slider", "slot_force", "slot_moment"),
            ),
        )

    @property
    def dimensions(self):
        slot = Angle(self.pin, self.guide.direction)
        return {("slot_angle",): slot, **within("guide", self.guide.dimensions(self.pin))}

    def sliding(self, name, placement):
        motion = self.placed(placement)
        if name == self.called("guide"):
            return Slide(self.guide.line.direction, motion.travel.first)
        climbing = rotate_back(vector_or_zero(motion.block.joint.first), self.guide.line.direction)[1]
        return Slide(motion.block.direction, climbing / motion.slot[1])

    def place(self, placement):
        motion = place(placement.joints[self.on], self.guide.line, self.slot_angle)
        self.enter(placement, motion, travels={"slider": motion.travel})

    def follow(self, placement, joints):
        """Place block and slider at known joints."""
        joint, guide = placement.joints[self.on], self.guide.line
        slider, travel = known_slider(joints[self.pin], self.guide.direction)
        rise = minus(rotate_back(joint.position, guide.direction)[1], guide.offset)
        slot = cos(self.slot_angle), sin(self.slot_angle)
        block = LinkMotion(joint, rotate(slot, guide.direction), None, None)
        self.enter(placement, YokeMotion(block, slider, travel, rise, slot), travels={"slider": travel})

    def closure(self, placement):
        """Squared sine of the slot's angle: it closes at all finite crank angles."""
        sine = self.placed(placement).slot[1]
        return sine * sine + 0.0 * placement.angle

    def requirement(self, placement):
        return f"the slot of the {self.called('slider')} must not be parallel to its guide"

    def elongation(self, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m, without first rounding the coordinate."""
        motion = self.placed(placement)
        along = rotate_back(placement.joints[self.on].position, self.guide.line.direction)[0]
        return (along - free_position) - motion.slot[0] / motion.slot[1] * motion.rise

    def resolve(self, placement, loads, along) -> Resolved:
        (block_load, slider_load), (_, push) = self.of_links(loads), self.of_links(along)
        return self.resolved(*resolve(self.placed(placement), self.guide.line, block_load, slider_load, push))
