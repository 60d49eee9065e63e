"""Contact of a cam with its roller or flat face over the turn: `contact`, and the result for followers on disk cams.

The contact force of a follower is positive outward: the cam is a disk inside the pitch curve. Where it is negative, a
grooved cam carries the roller on a ring around the pitch curve, and an open cam loses contact, as a flat face does.
Formulas are those of `cam_contact`. The relative radius of a flat face is the radius of curvature s + s'' of the cam
(Norton, *Cam Design and Manufacturing Handbook*, 2009, chapters 7 and 12).
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..cycle.limit_positions import require_single
from ..errors import ParameterError
from ..machine.cams import roller
from ..machine.cams.profile import POSITIVE, SIDE_SIGNS, Peak
from ..machine.cams.profile import profile as working_curve
from ..machine.cams.roller import MODULUS_RULE
from ..machine.followers.follower import path_curvature
from ..machine.group import FRAME
from ..numbers import checks
from ..numbers.lazy import cached_property
from .cam_contact import LIMIT_UNITS, CamContact, Contact, Roller
from .follower_speed import lifted


@dataclass(frozen=True, eq=False, repr=False)
class FollowerContact(CamContact):
    """Contact of a follower with its disk cam over the turn; made by `contact`.

    Attributes
    ----------
    solution : Solution
    cam : Cam
        The `disk` of the follower.
    roller_radius, width : float
        m; radius 0 for a flat face.
    modulus : float
        E* of both materials together, Pa.
    follower : group
        A `RollerFollower`, `FlatFollower` or `SwingingFollower`.
    limits : dict of str to float

    Examples
    --------
    >>> import kinetostatics as ks
    >>> follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> s = ks.solve(machine, [0.0, 1.0], crank_speed=40.0, loads=ks.Spring(5e3, 0.04, on="follower"))
    >>> found = ks.design.contact(s, 0.01, 0.015, 210e9, 0.3)
    >>> print(f"{found.largest_pressure.value / 1e6:.0f} MPa, radius {found.smallest_radius.value * 1e3:.1f} mm")
    144 MPa, radius 39.0 mm
    >>> found.lifted
    ()
    """

    follower: Any = field(kw_only=True)

    def __repr__(self):
        spans = (f"{np.degrees(start):.6g} to {np.degrees(stop):.6g} deg" for start, stop in self.lifted)
        return super().__repr__()[:-1] + "".join(f"\n    lift-off         {span}" for span in spans) + ">"

    @property
    def flat(self):
        """Whether the follower has a flat face."""
        return self.follower.led[0].flat

    @property
    def _body(self):
        return "flat face" if self.flat else super()._body

    @property
    def force_name(self):
        """Name of the contact force among the quantities of the mechanism."""
        return self.follower.led[0].force

    @property
    def contact_force(self):
        """Force of the cam on the follower along the common normal, N; positive outward, negative at lift-off."""
        return self.solution.scalar(self.force_name)

    @property
    def cam_force(self):
        """The contact force, N, positive toward the inside of the pitch curve."""
        return -self.contact_force

    @property
    def pressure_angle(self):
        """Pressure angle, rad, with the sign of the mechanism's quantity; 0 for a flat face."""
        if self.flat:
            return np.zeros(self.crank_angle.shape)
        return self.solution.measure(self.follower.called("pressure_angle"))

    @property
    def curvature(self):
        """Curvature of the pitch curve, 1/m, positive where it is convex; for a flat face that of the cam."""
        if self.flat:
            return 1.0 / self.solution.measure(self.follower.called("curvature_radius"))
        return path_curvature(self.solution.placement.joints[self.follower.pin])

    @property
    def _side(self):
        return np.full(self.crank_angle.shape, SIDE_SIGNS["disk"]) if self.flat else super()._side

    @property
    def relative_radius(self):
        """Radius of the equivalent cylinder on a plane, m; NaN where a flat face loses contact."""
        if self.flat:
            return np.where(self.contact_force < 0.0, np.nan, self.curvature_radius)
        return super().relative_radius

    # over the period

    @cached_property
    def lifted(self):
        """Crank-angle intervals of lift-off, where the contact force is negative, pairs in rad; as `design.lifted`."""
        return lifted(self.solution, self.force_name)

    @property
    def sides(self):
        """Sides of the pitch curve on which the cam carries the follower somewhere in the period."""
        return ("disk",) if self.flat else super().sides

    @cached_property
    def largest_pressure(self):
        """Largest Hertz pressure over the period, Pa, and its crank angle."""
        return self._highest(lambda at: np.nan_to_num(at.pressure))

    @cached_property
    def largest_pressure_angle(self):
        """Largest size of the pressure angle, rad, and its crank angle."""
        return Peak(0.0, 0.0) if self.flat else self._highest(lambda at: np.abs(at.pressure_angle))

    @cached_property
    def smallest_radius(self):
        """Smallest radius of curvature of the cam where it is convex, m, and its crank angle; None if it is not."""
        sharpest = self._highest(lambda at: 1.0 / at.curvature_radius)
        return Peak(1.0 / sharpest.value, sharpest.angle) if sharpest.value > 0.0 else None

    def _curve_limits_exceeded(self):
        angle, radius = (self.limits.get(name) for name in ("pressure_angle", "curvature_radius"))
        steep, sharp = self.largest_pressure_angle, self.smallest_radius
        if angle is not None and steep.value > angle:
            yield (
                f"pressure angle: {np.degrees(steep.value):.6g} deg at {np.degrees(steep.angle):.6g} deg, more than "
                f"{np.degrees(angle):.6g}"
            )
        if radius is not None and sharp is not None and sharp.value < radius:
            yield (
                f"radius of curvature of the cam: {sharp.value:.6g} m at {np.degrees(sharp.angle):.6g} deg, less than "
                f"{radius:.6g}"
            )

    def frame(self):
        """Table with a row for each crank angle, a pandas DataFrame."""
        return super().frame().assign(**{"pressure_angle [rad]": self.pressure_angle})


ROLLER_RULES: dict[str, tuple[str, dict[str, Any]]] = {
    "roller_mass": ("kg", {"low": 0.0}),
    "life_exponent": ("1", POSITIVE),
    "roller_inertia": ("kg*m**2", {"low": 0.0}),
    "load_rating": ("N", POSITIVE),
}
ROLLER_DEFAULTS = {"roller_mass": 0.0, "life_exponent": 10 / 3}
ROLLER_LIMITS = ("pin_load", "friction_coefficient", "life")
"""Limits of the roller on its pin, which are computed for a `CamRoller` only."""
MATERIAL_RULES: dict[str, tuple[str, dict[str, Any]]] = {
    "youngs_modulus": ("Pa", {**POSITIVE, "usual": MODULUS_RULE.usual}),
    "poissons_ratio": ("1", {"low": 0.0, "high": 0.5 + 1e-12}),
}
"""Unit and bounds of each material property."""


def contact(
    solution,
    roller_radius=None,
    width=None,
    youngs_modulus=None,
    poissons_ratio=None,
    *,
    follower=None,
    roller_mass=ROLLER_DEFAULTS["roller_mass"],
    roller_inertia=None,
    load_rating=None,
    life_exponent=ROLLER_DEFAULTS["life_exponent"],
    limits=None,
):
    """Contact of a roller or flat face with its cam over the turn, and exceeded limits.

    Parameters
    ----------
    solution : Solution
        Of one design, of a mechanism with a `CamRoller` or a follower.
    roller_radius, width : float
        m; of these four, missing ones come from the scene's own `Roller` or `Face`. A flat face has no radius.
    youngs_modulus : float or (roller, cam)
        Pa.
    poissons_ratio : float or (roller, cam)
    follower : str, optional
        Link of the follower, "follower" or "arm" with its label, if there are several; the default is the `CamRoller`,
        or the only follower. A follower takes none of the four numbers of the roller below, nor limits of them.
    roller_mass : float
        Mass of the roller, a part of the block's mass, kg.
    roller_inertia : float, optional
        About its pin, kg m2; default m R^2 / 2.
    load_rating : float, optional
        Basic dynamic load rating C of its bearing (ISO 281), N.
    life_exponent : float
        10/3 for roller bearings, 3 for ball bearings.
    limits : dict of str to float, optional
        Largest "pressure" (Pa), "pin_load" (N), "friction_coefficient", "pressure_angle" (rad) and "starting_torque"
        (N m); smallest convex "curvature_radius" (m), "life" (h) and "lift_off_speed" (rad/s); see `Contact.exceeded`.

    Returns
    -------
    Contact or FollowerContact

    Raises
    ------
    ParameterError
        A value no machine can have, no cam in the mechanism, a batch of designs, or a roller that undercuts the side of
        the cam that it runs on.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.CosineLaw(0.3, 2.0)
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600.0))
    >>> solution = ks.solve(saw, 0.5, crank_speed=10.0, loads=ks.Spring.balancing(600.0, 11.0, 2.0))
    >>> found = ks.design.contact(solution, 0.05, 0.04, 210e9, 0.3, limits={"pressure": 1e9})
    >>> print(f"{found.largest_pressure.value / 1e6:.1f} MPa on the {found.sides[0]}")
    289.1 MPa on the disk
    """
    checks.require("contact", checks.solution("solution", solution))
    group = _group_of(solution.mechanism, follower)
    (led,) = group.led
    of_follower, part = led.body != FRAME, "face" if led.flat else "roller"
    require_single(solution, "contact", led.force)
    given = {"roller_radius": roller_radius, "width": width, "youngs_modulus": youngs_modulus}
    given |= {"poissons_ratio": poissons_ratio}
    limits = {} if limits is None else limits
    known = limits if isinstance(limits, dict) else {}
    own = {"roller_mass": roller_mass, "life_exponent": life_exponent}
    optional = {"roller_inertia": roller_inertia, "load_rating": load_rating}
    own |= {name: value for name, value in optional.items() if value is not None}
    values = checks.single_numbers(
        "contact",
        *(_follower_problems(led, roller_radius, own, known) if of_follower else ()),
        *_limit_problems(limits, load_rating),
        **_contact_rules(given, group, part),
        **{name: (value, *ROLLER_RULES[name]) for name, value in own.items()},
        **{f"limit {name!r}": (known[name], unit, POSITIVE) for name, unit in LIMIT_UNITS.items() if name in known},
    )
    materials = [[values[f"{name} of the {body}"] for name in MATERIAL_RULES] for body in (part, "cam")]
    kept = {name: values[f"limit {name!r}"] for name in LIMIT_UNITS if name in limits}
    size = values.get("roller_radius", 0.0), values["width"], roller.contact_modulus(*materials)
    found: CamContact
    if of_follower:
        found = FollowerContact(solution, group.disk, *size, limits=kept, follower=group)
        sides = () if led.flat else found.sides[:1]  # an open cam has no ring
    else:
        radius, mass = values["roller_radius"], values["roller_mass"]
        inertia = values.get("roller_inertia", 0.5 * mass * radius * radius)
        wheel = Roller(group.cam, radius, mass, inertia, values.get("load_rating"), values["life_exponent"])
        found = Contact(solution, group.cam, *size, limits=kept, roller=wheel)
        sides = found.sides
    for side in sides:
        working_curve(found.cam, found.roller_radius, 8, side)
    return found


def _group_of(mechanism, follower):
    """Group of the contact: that of the link, else the roller on a fixed cam, else the only follower."""
    groups = {group.led[0].link: group for group in mechanism.groups if group.led}
    if not groups:
        raise ParameterError(
            f"contact: a {mechanism.name} has no cam; contact needs a mechanism with a CamRoller or a follower"
        )
    if follower is not None:
        checks.require("contact", checks.choice("follower", follower, tuple(groups)))
        return groups[follower]
    if not mechanism.led_by_ground and len(groups) > 1:
        names = ", ".join(map(repr, groups))
        raise ParameterError(f"contact: a {mechanism.name} has several followers; choose one as follower: {names}")
    return (*mechanism.led_by_ground, *groups.values())[0]


def _follower_problems(led, roller_radius, own, limits):
    """Sentences about numbers and limits, by name, that the contact of a follower does not have."""
    if led.flat and roller_radius is not None:
        yield f"the {led.link} has a flat face, so it takes no roller_radius"
    given = [
        name
        for name, value in own.items()
        if not (isinstance(value, int | float) and value == ROLLER_DEFAULTS.get(name))
    ]
    if names := [*given, *(name for name in limits if name in ROLLER_LIMITS)]:
        yield f"load and life of a roller are computed for a CamRoller only; the {led.link} takes no {', '.join(names)}"


def _contact_rules(given, group, part):
    """Values and rules of a contact, missing values from the scene's own part; the materials of part and cam."""
    if part == "face":
        given = {name: value for name, value in given.items() if name != "roller_radius"}
    lacking = [name for name, value in given.items() if value is None]
    found, own_part = dict(given), next((touch.body for touch in group.contacts.values()), None)
    if lacking and own_part is None:
        raise ParameterError(
            f"contact: {', '.join(lacking)} must be given, since the {group.led[0].link} has no {part.title()}"
        )
    for name in lacking:
        field_name = name.removeprefix("roller_")
        own, other = getattr(own_part, field_name), getattr(own_part, f"cam_{field_name}", None)
        found[name] = own if other is None else (own, other)
    rules: dict[str, tuple[Any, str, dict[str, Any]]] = {
        name: (found[name], "m", POSITIVE) for name in ("roller_radius", "width") if name in found
    }
    for place, body in enumerate((part, "cam")):
        for name, rule in MATERIAL_RULES.items():
            value = found[name]
            paired = isinstance(value, list | tuple) and len(value) == 2
            rules[f"{name} of the {body}"] = (value[place] if paired else value, *rule)
    return rules


def _limit_problems(limits, load_rating):
    """Sentences about wrong names of limits."""
    if not isinstance(limits, dict):
        return [f"limits must be a dict of name to number, got {checks.shown(limits)}"]
    rating = "a limit of the life takes the load_rating of the roller's bearing"
    unrated = "life" in limits and load_rating is None
    return [*(checks.choice("limit", name, tuple(LIMIT_UNITS)) for name in limits), rating if unrated else None]
