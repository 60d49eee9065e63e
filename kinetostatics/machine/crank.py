"""The driver: a crank that turns about O and carries pin A, or a slotted crank that guides a block."""

from dataclasses import dataclass
from typing import Any, ClassVar

from ..numbers import checks
from ..numbers.arithmetic import cos, sin
from ..numbers.planar import minus, number, subtracted, vector
from .group import FRAME, Bar, Output, Point, Resolved
from .links import Joint, Link, LinkMotion
from .pairs import Turning
from .placement import Course, Placement, Throw

ORIGIN = Joint((0.0, 0.0), None, None)


def ray(angle):
    """Unit vector of the crank."""
    return (cos(angle), sin(angle))


def pin(ray, length):
    """Joint A at the end of the crank."""
    x, y = length * ray[0], length * ray[1]
    minus_y = -y
    return Joint((x, y), (minus_y, x), (-x, minus_y))


def resolve(load):
    """Force of the ground on the crank at O, and the torque that keeps the motion (kernel).

    `load` is what acts on the crank, its own and what hangs on it, a wrench about O.
    """
    return vector(subtracted(None, load.force)), number(minus(None, load.moment))


@dataclass(frozen=True, eq=False)
class Crank(checks.Checked):
    """Crank of a given length with pin A at its end; `length=None` makes it the slotted guide of a `CamRoller`.

    The angle of the crank ray is the crank angle, from +x, counter-clockwise.

    Parameters
    ----------
    length : float or array, optional
        O to A, m; arrays of shape (designs, 1) make a batch.
    link : Link
        Mass properties; reference joint O, along the crank ray.

    Raises
    ------
    ParameterError
        The length is not finite, or not greater than 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> crank = ks.Crank(0.3, ks.Link(mass=40.0, centre=-0.05))  # a weight behind O
    >>> saw = ks.Mechanism("saw", crank, (ks.SliderGroup(2.0),))
    >>> saw.links["crank"].mass
    40.0
    """

    length: Any = None
    link: Link = Link()

    RULES = checks.Rules(
        "crank",
        length=checks.Optional(checks.Number("m", "crank length", low=0.0, strict=True)),
        link=checks.Made(Link, "a Link"),
    )

    @property
    def links(self):
        return {"crank": self.link}

    @property
    def references(self):
        return {"crank": "O"}

    PATHS: ClassVar = {"length": "crank_length", "link": "crank"}
    own_names: ClassVar = {"crank": "crank"}
    guides: ClassVar[dict] = {}
    motions: ClassVar[dict] = {}
    contacts: ClassVar[dict] = {}
    curves: ClassVar[dict] = {}
    pairs: ClassVar = {"O": Turning("crank", "O")}
    slots = ()
    led = ()
    hangs_on = ()
    trusted = True
    """Whether the library's own: a class derived from it may do otherwise."""

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        cls.trusted = False

    @property
    def names(self):
        """What its names come from."""
        return (self.length is None,)

    @property
    def reaches(self):
        """Length of the crank, if it has one, for a first look at the condition."""
        return () if self.length is None else (self.length,)

    @property
    def lengths(self):
        """All lengths it has, the place of its mass centre among them, for a first look at the condition."""
        return (*self.link.centre, 0.0 if self.length is None else self.length)

    @property
    def joints(self):
        pins = {} if self.length is None else {"A": Point("crank", self.length)}
        return {"O": Point(FRAME), **pins}

    @property
    def throws(self):
        """Its pin, if that does not slide."""
        return {} if self.length is None else {"A": Throw((self.length, 0.0), True)}

    @property
    def bars(self):
        return () if self.length is None else (Bar("O", "A", "crank", self.length),)

    @property
    def outputs(self):
        return {
            "O": Output("N", True, "ground on crank"),
            "balancing_torque": Output("N m", False, "on the crank, counter-clockwise, to keep the motion"),
        }

    def place(self, angle) -> Placement:
        direction = ray(angle)
        placement = Placement(angle, direction, {"O": ORIGIN}, {"crank": LinkMotion(ORIGIN, direction, 1.0, None)})
        if self.length is not None:
            placement.joints["A"] = pin(direction, self.length)
            placement.courses["A"] = Course(throw=self.throws["A"])
        return placement

    def resolve(self, placement, loads, along) -> Resolved:
        support, torque = resolve(loads["crank"])
        return Resolved({"O": support}, {"balancing_torque": torque}, {})
