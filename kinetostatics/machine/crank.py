"""The crank, which turns about O and carries pin A or guides a block in its slot, and pins on any link.

A `Pin` is a further joint fixed to a link, for more groups: ternary links, second throws, articulated rods.
"""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import cos, sin
from ..numbers.lazy import cached_property
from ..numbers.planar import minus, number_or_zero, subtract_vectors, vector_or_zero
from .dimensions import Span, of_fixed_point, of_point_on_link
from .group import EMPTY, FRAME, POSITION, Bar, Declaration, Group, Name, Output, Part, Plane, Point, Resolved
from .kinematic_state import Course, Placement, Throw
from .links import Joint, Link, LinkMotion, Turning, joint_at, present

ORIGIN = Joint((0.0, 0.0), None, None)


def ray(angle):
    """Unit vector of the crank."""
    return (cos(angle), sin(angle))


@dataclass(frozen=True, eq=False)
class Rotor(Link):
    """Mass properties of a crank with masses in several planes along the crankshaft.

    Parameters
    ----------
    mass, centre, inertia
        As for `Link`.
    plane : float or array
        Position of the mass centre along the crankshaft, m.
    couple_unbalance : (along, across)
        Sum of m (z - plane) (along, across) over its masses, kg m2: 0 if all lie in one plane.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.Rotor(3.0, centre=0.25).joined(1.0, (-0.75, 0.0), plane=0.5)  # a counterweight 0.5 m beside it
    Rotor(mass=4.0, centre=(0.0, 0.0), inertia=0.75, plane=0.125, couple_unbalance=(-0.375, 0.0))
    """

    plane: Annotated[Any, POSITION] = 0.0
    couple_unbalance: Annotated[Any, checks.Pair("kg*m**2", parts=("along", "across"))] = (0.0, 0.0)

    RULES = checks.Rules("Rotor")

    @staticmethod
    def of(link):
        """A link as a rotor, by default in the plane 0."""
        return link if isinstance(link, Rotor) else Rotor(link.mass, link.centre, link.inertia)

    def without_mass(self):
        return Rotor(plane=self.plane)

    def joined(self, mass, place, plane=None):
        """The rotor with a point mass (kg) fixed to it at place (along, across) in a plane, m; default: its plane."""
        if mass == 0:
            return self
        whole, z = self.mass + mass, self.plane if plane is None else plane
        offset = self.mass * mass / whole * (z - self.plane)
        couple = zip(self.couple_unbalance, self.centre, place, strict=True)
        body = super().joined(mass, place)
        centre = (self.mass * self.plane + mass * z) / whole
        return Rotor(
            whole, body.centre, body.inertia, centre, tuple(part + offset * (new - old) for part, old, new in couple)
        )


class BearingsRule(checks.Pair):
    """Rule of two positions along the crankshaft, the smaller one first."""

    def __post_init__(self):
        object.__setattr__(self, "rule", POSITION)

    def quick(self, value):
        return checks.UNDECIDED

    def check(self, value, field=""):
        found, problem = super().check(value, field)
        if problem is None and all(map(checks.has_known_values, found)) and not np.all(found[0] < found[1]):
            problem = f"{field} must be (left, right) with left < right, got {checks.shown(found)}"
        return found, problem


@dataclass(frozen=True, eq=False)
class Crank(checks.Checked, Part):
    """Crank of a given length with pin A at its end; `length=None` makes it the slotted guide of a `CamRoller`.

    The angle of the crank ray is the crank angle, from +x, counter-clockwise.

    Parameters
    ----------
    length : float or array, optional
        O to A, m; arrays of shape (designs, 1) make a batch.
    link : Link
        Mass properties; reference joint O, along the crank ray. A `Rotor` has masses in several planes.
    bearings : (left, right), optional
        Positions of two main bearings along the crankshaft, m, the smaller one first (``reaction("O", at="left")``).

    Raises
    ------
    ParameterError
        The length is not finite, or not greater than 0; the bearings are not a pair in order.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> crank = ks.Crank(0.3, ks.Link(mass=40.0, centre=-0.05))  # a weight behind O
    >>> saw = ks.Mechanism("saw", crank, (ks.SliderGroup(2.0),))
    >>> saw.links["crank"].mass
    40.0
    """

    length: Annotated[Any, checks.Optional(checks.Number("m", "crank length", low=0.0, strict=True))] = None
    link: Annotated[Link, checks.InstanceOf(Link, "a Link")] = Link()
    bearings: Annotated[Any, checks.Optional(BearingsRule("m", parts=("left", "right")))] = None

    RULES = checks.Rules("crank")

    PATHS: ClassVar = {"length": "crank_length", "link": "crank"}
    references: ClassVar = {"crank": "O"}
    hangs_on = ()
    TRUSTED = True

    @property
    def links(self):
        return {"crank": self.link}

    @property
    def names(self):
        """Facts that its names depend on."""
        return (self.length is None,)

    @property
    def declaration(self):
        """Joint O, and pin A if the crank has a length."""
        joints, pairs = {"O": Point(FRAME)}, (Turning("crank", "O"),)
        if self.length is None:
            return Declaration(joints, pairs=pairs)
        return Declaration(
            joints | {"A": Point("crank", self.length)}, (Bar("O", "A", "crank", self.length),), pairs=pairs
        )

    @property
    def dimensions(self):
        return {} if self.length is None else {("length",): Span("O", "A")}

    @property
    def throws(self):
        """Pin A, if the crank has a length."""
        return {} if self.length is None else {"A": Throw((self.length, 0.0), True)}

    @cached_property
    def outputs(self):
        text = "on the crank, counter-clockwise, to keep the motion"
        return {**super().outputs, "balancing_torque": Output("N m", False, text)}

    def place(self, angle) -> Placement:
        direction = ray(angle)
        placement = Placement(angle, direction, {"O": ORIGIN}, {"crank": LinkMotion(ORIGIN, direction, 1.0, None)})
        if self.length is not None:
            x, y = self.length * direction[0], self.length * direction[1]
            placement.joints["A"] = Joint((x, y), (-y, x), (-x, -y))
            placement.courses["A"] = Course(throw=self.throws["A"])
        return placement

    def resolve(self, placement, loads, along) -> Resolved:
        """Force of the ground on the crank at O, and the torque that keeps the motion."""
        support = vector_or_zero(subtract_vectors(None, loads["crank"].force))
        torque = number_or_zero(minus(None, loads["crank"].moment))
        return Resolved({"O": support}, {"balancing_torque": torque}, {})


@dataclass(frozen=True, eq=False)
class Pin(checks.Checked, Group):
    """Joint `name` fixed to the link `on`, which carries the force of the groups attached to the pin.

    It adds no link, no reaction and no condition of closure. Several groups may share a pin, each with its own label
    and its own reaction; their forces on the link add up.

    Parameters
    ----------
    on : str
        Name of the link: the crank, or a link of an earlier group, with that group's label;
        "frame" for a fixed point.
    at : (along, across)
        From the link's reference joint (see `Link`) along its direction and across it, a quarter turn
        counter-clockwise, m; on the frame (x, y) from O.
    name : str
    plane : float or array, optional
        Position of a pin of the crank along the crankshaft, m, and of the groups on it; see `machine.planes`.

    Raises
    ------
    ParameterError
        The place is not finite; or, from the mechanism, no part before the pin adds the link.

    Examples
    --------
    A connecting rod on the middle of the coupler of a four-bar:

    >>> import kinetostatics as ks
    >>> rod = ks.SliderGroup(0.5, ks.Guide.at(0.0, 0.1), on="C", pin="D", label="2")
    >>> bars = ks.RockerGroup(0.4, 0.3, (0.35, 0.1))
    >>> six_bar = ks.Mechanism("six-bar", ks.Crank(0.1), (bars, ks.Pin(on="coupler", at=(0.2, 0.05)), rod))
    >>> ks.solve(six_bar, 0.0, crank_speed=10.0).position("C").shape
    (2,)
    """

    on: Name
    at: Annotated[Any, checks.Pair("m", parts=("along", "across"))]
    name: Name = "C"
    plane: Plane = None

    TRUSTED = True
    PATHS: ClassVar = {"at": "pin_", "plane": "pin_plane_"}
    hangs_on, outputs = (), EMPTY
    RULES = checks.Rules("pin")

    @property
    def label(self):
        """Its name, for the paths of its numbers: "pin_C.along"."""
        return self.name

    @property
    def joints(self):
        return {self.name: Point(self.on, *self.at)}

    @property
    def dimensions(self):
        if self.on == FRAME:
            return of_fixed_point("at", self.name)
        return of_point_on_link("at", (self.on, *self.at), self.name)

    @property
    def throws(self):
        """The pin itself, if it is on the crank and not at O."""
        away = self.on == "crank" and any(present(part) is not None for part in self.at)
        return {self.name: Throw(self.at)} if away else {}

    @property
    def lengths(self):
        return self.at

    def place(self, placement):
        fixed = self.on == FRAME
        at = Joint(self.at, None, None) if fixed else joint_at(placement.links[self.on], *map(present, self.at))
        placement.joints[self.name] = at
        placement.courses.update({name: Course(throw=throw) for name, throw in self.throws.items()})

    def follow(self, placement, joints):
        """Keep the known position of a joint that moves."""
        if self.on == FRAME:
            self.place(placement)
        else:
            placement.joints[self.name] = joints[self.name]

    def closure(self, placement):
        return 1.0

    def requirement(self, placement):
        return "a pin closes wherever its link is"

    def resolve(self, placement, loads, along) -> Resolved:
        return Resolved({}, {}, {})
