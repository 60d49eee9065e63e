"""What groups declare of slots, and of links that a cam leads."""

from typing import Any, NamedTuple


class Slot(NamedTuple):
    """A link along which `joint` slides in a straight line, in a slot; `rod` is the link that slides in it as a piston.

    Without a rod what slides is a block at the joint. The line runs at `angle` from the link's direction, at `offset`
    to the left of its reference joint.
    """

    link: str
    joint: str
    rod: str = ""
    offset: Any = 0.0
    angle: Any = 0.0


class Led(NamedTuple):
    """A link whose one freedom the curve in `cam` gives: where it slides the coordinate of its joint, else its angle.

    The angle counts from the direction to O, clockwise for an assembly of +1. The curve is fixed to the link `body` and
    gives `force` on the joint, a roller's centre, across its way along the curve, to the left; or on a `flat` face
    across the link.
    """

    link: str
    joint: str
    body: str
    force: str
    flat: bool = False
