"""The driver: a crank that turns about O and carries pin A, or a slotted crank that guides a block."""

from dataclasses import dataclass
from typing import Any

from ..numbers import checks
from ..numbers.elementary import cos, sin
from ..numbers.planar import minus, moment, number, subtracted, vector
from .chain import Adds, Bar, Forces, Placement
from .links import Joint, Link, LinkMotion, Wrench

ORIGIN = Joint((0.0, 0.0), None, None)


def ray(angle):
    """Unit vector of the crank."""
    return (cos(angle), sin(angle))


def pin(ray, length):
    """Joint A at the end of the crank."""
    x, y = length * ray[0], length * ray[1]
    minus_y = -y
    return Joint((x, y), (minus_y, x), (-x, minus_y))


def resolve(own, demand):
    """Force of the ground on the crank at O, and the torque that keeps the motion (kernel).

    `own` is the load of the crank itself, `demand` what it must supply to the chain, both wrenches about O.
    """
    return vector(subtracted(demand.force, own.force)), number(minus(demand.moment, own.moment))


@dataclass(frozen=True, eq=False)
class Crank(checks.Checked):
    """Crank of a given length with pin A at its end; `length=None` makes it the slotted guide of a `CamRoller`.

    The angle of the crank ray is the crank angle, from +x, counter-clockwise.
    """

    length: Any = None
    link: Link = Link()

    RULES = checks.Rules(
        "crank",
        length=checks.Optional(checks.Number("m", "crank length", low=0.0, strict=True)),
        link=checks.Made(Link, "a Link"),
    )

    @property
    def adds(self):
        joints = ("O",) if self.length is None else ("O", "A")
        return Adds(joints, ("crank",), ("O",), ("balancing_torque",))

    @property
    def links(self):
        return {"crank": self.link}

    @property
    def references(self):
        return {"crank": "O"}

    @property
    def lengths(self):
        return (*self.link.centre, 0.0 if self.length is None else self.length)

    @property
    def bars(self):
        return () if self.length is None else (Bar("O", "A", "crank", self.length),)

    def place(self, angle) -> Placement:
        direction = ray(angle)
        placement = Placement(angle, direction, {"O": ORIGIN}, {"crank": LinkMotion(ORIGIN, direction, 1.0, None)})
        if self.length is not None:
            placement.joints["A"] = pin(direction, self.length)
        return placement

    def resolve(self, placement, loads, forces: Forces):
        demand = forces.crank_demand
        if self.length is not None:
            at_pin = forces.demand.get("A")
            demand = Wrench(at_pin, moment(placement.joints["A"].position, at_pin))
        forces.reactions["O"], forces.scalars["balancing_torque"] = resolve(loads["crank"], demand)
