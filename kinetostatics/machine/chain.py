"""What travels along the chain of groups: placed joints and links outward, forces inward.

A group is a frozen dataclass with eight members; a new kind of group needs nothing else. Kernels in `place` and
`resolve` that are arithmetic have their condition found by differentiation:

    links                   name -> `Link` of the links it adds
    references              name -> reference joint of these links
    lengths                 all lengths it has, places of mass centres among them, for a first look at the condition
    bars                    `Bar` for each link that keeps two joints at a distance
    place(placement)        read the joint it hangs on, add its own joints, links and details
    closure(placement)      margin, 1 at most: negative where the group cannot be assembled, small near a limit position
    requirement(placement)  what must hold for it to be assembled, with its numbers, for the error message
    resolve(placement, loads, pushes, forces)
                            find the forces on its links, demand what they need of the joint it hangs on

A group with a slider may have `elongation(placement, free_position)`, its travel from there without cancellation, and
any group `adds`, the names it adds, so that names given twice are found before anything is computed; `ks.check` tests a
group of one's own.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..errors import ParameterError
from ..numbers.planar import added
from .links import Wrench

MEMBERS = ("links", "references", "bars", "place", "closure", "requirement", "resolve")


class Adds(NamedTuple):
    """Names that a part of a mechanism adds: joints, links, and in `Forces` its reactions and scalars."""

    joints: tuple[str, ...]
    links: tuple[str, ...]
    reactions: tuple[str, ...] = ()
    scalars: tuple[str, ...] = ()


class Bar(NamedTuple):
    """A link that keeps joint `end` at a constant distance from joint `start`, its reference joint."""

    start: str
    end: str
    link: str
    length: Any


def added_by(part):
    """Names a part adds: what it says, else what follows from its links; of its forces nothing is known then."""
    if hasattr(part, "adds"):
        return part.adds
    fixed = {*part.references.values(), *(bar.start for bar in part.bars)} - {getattr(part, "on", "O"), "O"}
    ends = dict.fromkeys(bar.end for bar in part.bars)
    return Adds((*sorted(fixed - ends.keys()), *ends), tuple(part.links))


class Once(dict):
    """A table in which no name is set twice."""

    def __setitem__(self, name, value):
        if name in self:
            raise ParameterError(
                f"two parts of the mechanism add a force {name!r}, of which one would be lost; give one of them "
                "another label or pin"
            )
        super().__setitem__(name, value)


@dataclass
class Placement:
    """The mechanism at its crank angles: motion flows outward from the crank into these tables."""

    angle: Any
    ray: Any
    joints: dict = field(default_factory=dict)
    links: dict = field(default_factory=dict)
    details: dict = field(default_factory=dict)


@dataclass
class Forces:
    """Forces flow inward from the last group into these tables.

    `demand` holds, by joint, the force its pin must supply to the groups hanging on it; `crank_demand` the wrench about
    O that the crank must supply to the block in its slot; `reactions` (vectors) and `scalars` what the user asks for.
    """

    demand: dict = field(default_factory=dict)
    crank_demand: Wrench = Wrench(None, None)
    reactions: dict = field(default_factory=dict)
    scalars: dict = field(default_factory=dict)

    def require(self, joint, force):
        """Add to the force that a joint must supply."""
        self.demand[joint] = added(self.demand.get(joint), force)
