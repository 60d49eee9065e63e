"""Links: mass properties, motion, and the load of inertia and weight; pairs of links.

Motion is kept as kinematic coefficients, the derivatives by the crank angle phi (Uicker, Pennock and Shigley, *Theory
of Machines and Mechanisms*). With crank speed omega and crank acceleration alpha

    velocity = omega * first                acceleration = omega**2 * second + alpha * first

so geometry is computed once for all speeds, and rest is no special case. Lengths are in m, angles in rad; directions
are unit vectors, moments counter-clockwise. None is a zero that costs nothing.

`Turning`, `Sliding` and `Rolling` are the pairs of a group, by the name of their reaction; a pin is fixed to the link
that owns its joint. `Slot` and `CamDriven` describe how a joint or link is guided.
"""

from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

from ..numbers import checks
from ..numbers.lazy import cached_property
from ..numbers.planar import (
    add_vectors,
    cross,
    left,
    minus,
    moment,
    plus,
    product,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
    work,
)

TERMS = {
    "load.scale": ("W", "mass times the square of the crank speed"),
    "load.across": ("Z", "weight and inertia without the pull of the mass centre toward the reference joint"),
}


class Joint(NamedTuple):
    """Moving point: position, m, and first and second derivatives by crank angle (None: it does not move)."""

    position: Any
    first: Any
    second: Any


class LinkMotion(NamedTuple):
    """Motion of a link: reference joint, unit vector, d theta / d phi and its slope; None: it never turns."""

    joint: Joint
    direction: Any
    ratio: Any
    ratio_slope: Any


class Body(NamedTuple):
    """Mass properties of a link for kernels; zero is None."""

    mass: Any
    along: Any
    across: Any
    inertia: Any


class Wrench(NamedTuple):
    """A force and its moment about the link's reference joint, either of which may be absent."""

    force: Any
    moment: Any

    def plus(self, other):
        """Sum with another wrench on the same link."""
        return Wrench(add_vectors(self.force, other.force), plus(self.moment, other.moment))

    def times(self, factor):
        """The wrench of a unit force, by the size of the force."""
        return Wrench(scale_vector(factor, self.force), product(factor, self.moment))


@dataclass(frozen=True, eq=False)
class Link(checks.Checked):
    """Mass properties of one link.

    Parameters
    ----------
    mass : float or array
        kg; an array of shape (designs, 1) makes a batch.
    centre : (along, across) or float
        Mass centre in m from the link's reference joint (O for the crank, A for block and coupler, B for the slider, O2
        for the rocker). `along` runs along the crank ray for crank and block, A -> B for the coupler, O2 -> B for the
        rocker, the guide direction for the slider. `across` is a quarter turn counter-clockwise from it. A number means
        (number, 0). Levers, rods and others: see the group that adds them.
    inertia : float or array
        Moment of inertia about the mass centre, kg m2.

    Raises
    ------
    ParameterError
        A mass or inertia is negative, or a value is not finite.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> rod = ks.Link(mass=150.0, centre=1.0, inertia=20.5)  # mass centre 1 m from A on the line A -> B
    >>> rod.joined(10.0, (2.0, 0.0))  # with 10 kg at B: centre and inertia follow
    Link(mass=160.0, centre=(1.0625, 0.0), inertia=29.875)
    """

    mass: Annotated[Any, checks.Number("kg", low=0.0)] = 0.0
    centre: Annotated[Any, checks.Pair("m", parts=("along", "across"), lone=True)] = (0.0, 0.0)
    inertia: Annotated[Any, checks.Number("kg*m**2", low=0.0)] = 0.0
    plane = couple_unbalance = None

    RULES = checks.Rules("Link")

    def without_mass(self):
        """The link without mass and inertia, in its plane."""
        return Link()

    def joined(self, mass, place):
        """The link with a point mass (kg) fixed to it at place (along, across), m."""
        if mass == 0:
            return self
        whole = self.mass + mass
        x, y = ((self.mass * own + mass * new) / whole for own, new in zip(self.centre, place, strict=True))
        apart = (place[0] - self.centre[0]) ** 2 + (place[1] - self.centre[1]) ** 2
        return Link(whole, (x, y), self.inertia + self.mass * mass / whole * apart)

    @cached_property
    def body(self):
        """Mass properties for kernels."""
        return Body(*map(present, (self.mass, *self.centre, self.inertia)))


def present(value):
    """The value, or None for a plain number that is zero."""
    return None if isinstance(value, int | float) and value == 0 else value


def arm(direction, along, across):
    """Vector from a link's reference joint to its point (along, across); None for the joint itself."""
    if across is None:
        return scale_vector(along, direction)
    return add_vectors(scale_vector(along, direction), scale_vector(across, left(direction)))


def link_between(start, end, length):
    """Motion of a link between two joints, from the differences of positions and of both derivatives."""
    direction, first, second = (
        tuple(part / length for part in vector_or_zero(subtract_vectors(b, a))) for a, b in zip(start, end, strict=True)
    )
    return LinkMotion(start, direction, cross(direction, first), cross(direction, second))


def joint_at(link, along, across=None):
    """Point of a link at distances along its direction and across it, to the left, as joint (kernel); None is zero."""
    reach = arm(link.direction, along, across)
    return Joint(add_vectors(link.joint.position, reach), first_at(link, reach), second_at(link, reach))


def first_at(link, arm):
    """First kinematic coefficient of the point of a link at `arm` from its reference joint."""
    return add_vectors(link.joint.first, _turned(arm, link.ratio))


def second_at(link, arm):
    """Second kinematic coefficient of the point of a link at `arm` from its reference joint."""
    turning = subtract_vectors(_turned(arm, link.ratio_slope), scale_vector(product(link.ratio, link.ratio), arm))
    return add_vectors(link.joint.second, turning)


def _turned(arm, rate):
    if arm is None or rate is None:
        return None
    return (-rate * arm[1], rate * arm[0])


class PointMotion(NamedTuple):
    """Motion of a joint, or of the point of a link at `arm` from its reference joint."""

    joint: Joint
    arm: Any = None
    link: Any = None

    @property
    def position(self):
        return add_vectors(self.joint.position, self.arm)

    @property
    def first(self):
        return self.joint.first if self.link is None else first_at(self.link, self.arm)

    @property
    def second(self):
        return self.joint.second if self.link is None else second_at(self.link, self.arm)


def acceleration_of(first, second, speed_squared, crank_acceleration):
    """Acceleration of a point from its kinematic coefficients; None when it has none."""
    return add_vectors(scale_vector(speed_squared, second), scale_vector(crank_acceleration, first))


def angular_acceleration(ratio, ratio_slope, speed_squared, crank_acceleration):
    """Angular acceleration of a link; None when it has none."""
    return plus(product(speed_squared, ratio_slope), product(crank_acceleration, ratio))


def load(link, body, speed_squared, crank_acceleration, gravity):
    """Wrench of inertia and weight about the reference joint, its moment without the centripetal force; or None."""
    to_centre, mass, inertia = arm(link.direction, body.along, body.across), body.mass, body.inertia
    across, pull = None, None
    if mass is not None:
        scale, turned = mass * speed_squared, _turned(to_centre, link.ratio_slope)
        first = first_at(link, to_centre) if crank_acceleration is not None else None
        moved = acceleration_of(first, add_vectors(link.joint.second, turned), scale, product(mass, crank_acceleration))
        across = subtract_vectors(scale_vector(mass, gravity), moved)
        pull = scale_vector(product(scale, product(link.ratio, link.ratio)), to_centre)
    turning = angular_acceleration(
        link.ratio, link.ratio_slope, product(inertia, speed_squared), product(inertia, crank_acceleration)
    )
    return Wrench(add_vectors(across, pull), minus(moment(to_centre, across), turning))


def virtual_work(link, wrench):
    """Work of a wrench per unit of crank angle: the equivalent torque on the crank, N m."""
    return plus(work(wrench.force, link.joint.first), product(wrench.moment, link.ratio))


class Turning(NamedTuple):
    """Pin: `link` turns against another, by default the one that carries `joint`; the reaction acts on `link`.

    A link against itself is part of a rigid triangle and never turns.
    """

    link: str
    joint: str
    against: str = ""


class Sliding(NamedTuple):
    """Straight pair: `link` slides along another, at `joint`.

    `force` is the name of the force across the pair, `couple` that of the moment it carries, about the joint `about`,
    by default `joint`. The group answers ``sliding(name, placement)`` with a `Slide`.
    """

    link: str
    joint: str
    against: str
    force: str
    couple: str
    about: str = ""

    @property
    def name(self):
        """Name of the reaction: that of the force without suffix."""
        return self.force.removesuffix("_force")


class Rolling(NamedTuple):
    """Roller on a pin of `link`, on a curve of `against`; `force` is along the left normal of its path there."""

    link: str
    joint: str
    force: str
    against: str = "frame"

    @property
    def name(self):
        """Name of the pair: that of the force without suffix."""
        return self.force.removesuffix("_force")


class Meshing(NamedTuple):
    """Teeth of `link` in a fixed ring at twice the place of `joint`; `force` is the part of `name` across that ray."""

    link: str
    joint: str
    name: str
    force: str
    against: str = "frame"


class Slide(NamedTuple):
    """Direction of a straight pair (None: +x), rate d s / d phi, moment of a unit force about the other's joint."""

    direction: Any
    rate: Any
    moment: Any = None


class Slot(NamedTuple):
    """Link with a straight slot along which `joint` slides; `rod` is the link that slides in it as a piston.

    Without a rod a block at the joint slides. The line runs at `angle` from the link's direction, at `offset`
    to the left of its reference joint.
    """

    link: str
    joint: str
    rod: str = ""
    offset: Any = 0.0
    angle: Any = 0.0


class CamDriven(NamedTuple):
    """Link with one freedom, given by the curve in `cam`: the coordinate of its joint if it slides, else its angle.

    The angle counts from the direction to O, clockwise for an assembly of +1. The curve is fixed to the link `body`.
    `force` acts on the joint, a roller's centre, along the left normal of the curve, or on a `flat` face across the
    link.
    """

    link: str
    joint: str
    body: str
    force: str
    flat: bool = False
