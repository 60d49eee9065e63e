"""Cam roller: a block slides in the slotted crank and carries a roller at A that runs on a fixed cam.

The cam gives the radius r(phi) of the roller centre A along the crank ray (the pitch curve in polar form). The cam
force acts along the normal of the pitch curve, at the pressure angle tau from the ray, tan(tau) = r'/r; the slot force
acts across the ray. Equilibrium of the block gives both forces. The crank bears the slot force.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan, sign, sqrt
from ...numbers.parameter_tree import come_from_one_class
from ...numbers.planar import cross, dot, minus, polar_curvature, subtract_vectors, vector_or_zero
from ..crank import ray
from ..dimensions import Radius, within
from ..group import FRAME, Declaration, Group, GroupLink, Output, Plane, Point, Resolved
from ..kinematic_state import Course, Orbit
from ..laws.law import turn_angles
from ..links import CamDriven, Joint, Link, LinkMotion, Rolling, Slide, Sliding, Slot, Wrench
from .cam import RADIUS_ANGLES
from .roller import LineContact, OptionalRoller, relative_radius

CURVES = {"A": "pitch curve of the cam"}
TERMS = {
    "place.radius": ("r", "radius of the pitch curve"),
    "place.slope": ("r'", "its first derivative by phi"),
    "place.farther": ("p", "radius less the mean radius"),
    "place.curvature": ("r''", "its second derivative by phi"),
    "departing": ("b", "second derivative of the roller centre plus its place"),
    "resolve.force": ("Q", "resultant force on the block, with friction"),
    "resolve.lean": ("tau", "tangent of the pressure angle"),
    "resolve.outward": ("N", "force on the block along the ray"),
}


def place(ray, radius, slope, curvature):
    """Motion of the roller centre A on the ray, a `Joint`, from r, r' and r'' (kernel)."""
    x, y = ray
    along, across = radius * x, radius * y
    return Joint(
        (along, across),
        (slope * x - across, slope * y + along),
        subtract_vectors(departure(ray, slope, curvature), (along, across)),
    )


def departure(ray, slope, curvature):
    """Second derivative of the roller centre plus its position: r'' along the ray, 2 r' across it (kernel)."""
    x, y = ray
    sideways = 2.0 * slope
    departing = (curvature * x - sideways * y, curvature * y + sideways * x)
    return departing


def resolve(ray, radius, slope, load):
    """Cam force on the roller, slot force on the block, N, and the wrench of the crank about O (kernel).

    `load` is the wrench about A on the block, from its own loads and from the groups attached to it.
    """
    force = vector_or_zero(load.force)
    lean = slope / radius
    outward = dot(force, ray)
    cam = outward * sqrt(1.0 + lean * lean)
    slot = -(cross(ray, force) + outward * lean)
    on_crank = Wrench((-slot * ray[1], slot * ray[0]), minus(slot * radius, load.moment))
    return cam, slot, on_crank


@dataclass(frozen=True, eq=False)
class CamRoller(checks.Checked, Group):
    """Block and roller at joint A, guided by the slotted crank and the fixed `cam`.

    Parameters
    ----------
    cam : cams.Circle, cams.CosineLaw, cams.Harmonic, cams.Sampled or similar
        Any object with ``polar(angle, ray)`` that returns r, r', r'' in m.
    block : Link
        Block with roller; reference joint A, axis along the crank ray.
    roller : Roller, optional
        Size and material of the roller, for the contact pressure.
    plane : float or array, optional
        Position along the crankshaft, m.

    Raises
    ------
    ParameterError
        The cam gives no r, r', r''.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> roller = ks.CamRoller(ks.cams.Circle(0.3, centre=(-0.0219, 0.0)), block=ks.Link(20.0))
    >>> saw = ks.Mechanism("saw with a cam", ks.Crank(), (roller, ks.SliderGroup(2.0219, slider=ks.Link(600.0))))
    >>> s = ks.solve(saw, 0.0, crank_speed=33.5)
    >>> print(f"{s.cam_force:.0f} N")  # a ring around the roller pushes slider and block back inward
    205131 N
    """

    cam: Annotated[Any, checks.HasMembers(("polar",), "one of ks.cams or similar")]
    block: GroupLink = Link()
    roller: OptionalRoller = None
    plane: Plane = None

    TRUSTED = True
    PATHS: ClassVar = {"plane": "block_plane"}
    RULES = checks.Rules("cam roller")

    LINKS: ClassVar = {"block": "joint"}
    joint = "A"
    hangs_on = ("O",)
    curves = CURVES
    outputs: ClassVar = {
        "cam_force": Output("N", text="cam on roller along the normal, positive toward the inside of the pitch curve"),
        "slot_force": Output("N", text="slotted crank on block across the ray, positive with growing crank angle"),
    }

    @property
    def declaration(self):
        slot, contact = Sliding("block", "A", "crank", "slot_force", "slot_moment"), Rolling("block", "A", "cam_force")
        return Declaration(
            joints={"A": Point("block")},
            slots=(Slot("crank", "A"),),
            led=(CamDriven("block", "A", FRAME, "cam_force"),),
            pairs=(slot, contact),
            motions={
                "pressure_angle": Output("rad", text="of the cam pair, atan(r'/r), positive where the radius grows"),
                "cam_radius": Output("m", text="of the pitch curve, from O to the roller centre"),
            },
            contacts={} if self.roller is None else {"contact_pressure": LineContact(self.roller, "cam_force")},
            lengths=tuple(getattr(self.cam, "lengths", ())),
        )

    @property
    def dimensions(self):
        return {**within("cam", getattr(self.cam, "dimensions", {})), ("roller", "radius"): Radius("A")}

    @property
    def knots(self):
        return getattr(self.cam, "knots", ())

    @property
    def reaches(self):
        """Smallest radius of the pitch curve, m; on a grid if the cam has no `smallest_radius`."""
        found = getattr(self.cam, "smallest_radius", None)
        return (np.min(self.cam.polar(RADIUS_ANGLES[::30], ray(RADIUS_ANGLES[::30]))[0]) if found is None else found,)

    @cached_property
    def tightest(self):
        """Smallest radius of curvature of the pitch curve, on a grid, m; None for recorded numbers or enclosures."""
        angle = turn_angles([knot.angle for knot in self.knots], RADIUS_ANGLES.size)
        with np.errstate(divide="ignore"):
            curved = abs(1.0 / polar_curvature(*self.cam.polar(angle, ray(angle))))
        known = isinstance(curved, np.ndarray) and curved.dtype != object
        return curved.min(axis=-1, keepdims=True) if known else None

    @property
    def rollers(self):
        return {"A": None if self.roller is None else self.roller.radius}

    def relative_radius(self, name, placement, side):
        return relative_radius(polar_curvature(*placement.details["cam"]), self.contacts[name].body.radius, side)

    def sliding(self, name, placement):
        return Slide(placement.ray, placement.details["cam"][1])

    def motion(self, name, placement):
        radius, slope, _ = placement.details["cam"]
        return radius if name == "cam_radius" else atan(slope / radius)

    def place(self, placement):
        orbit = None
        if come_from_one_class(type(self.cam), "about_mean", "polar"):
            mean, farther, *derivatives = self.cam.about_mean(placement.angle, placement.ray)
            polar, orbit = (mean + farther, *derivatives), Orbit(mean, farther)
        else:
            polar = self.cam.polar(placement.angle, placement.ray)
        self._enter(placement, place(placement.ray, *polar), polar)
        placement.courses["A"] = Course(orbit=orbit, departure=departure(placement.ray, *polar[1:]))

    def closure(self, placement):
        """Squared cosine of the pressure angle, with the sign of the radius."""
        radius, slope, _ = placement.details["cam"]
        lean = slope / radius
        return sign(radius) / (1.0 + lean * lean)

    def requirement(self, placement):
        return f"the pitch curve must go around O, but its radius falls to {placement.details['cam'][0].min():.6g} m"

    def resolve(self, placement, loads, along) -> Resolved:
        radius, slope, _ = placement.details["cam"]
        cam, slot, on_crank = resolve(placement.ray, radius, slope, loads["block"])
        forces = {"cam_force": cam, "slot_force": slot, "slot_moment": minus(None, loads["block"].moment)}
        return Resolved({}, forces, {"crank": on_crank})

    def follow(self, placement, joints):
        """Place the block at a joint A that another method computed."""
        joint = joints["A"]
        radius, slope, outward = (dot(vector_or_zero(part), placement.ray) for part in joint)
        self._enter(placement, joint, (radius, slope, outward + radius))

    def _enter(self, placement, joint, polar):
        """Add joint A, the block, and `polar` = r, r', r'' to a placement."""
        placement.joints["A"] = joint
        placement.links["block"] = LinkMotion(joint, placement.ray, 1.0, None)
        placement.details["cam"] = polar
