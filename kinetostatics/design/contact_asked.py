"""What a contact of a roller with its cam is asked with: the roller, both materials, limits."""

from typing import Any

from ..errors import ParameterError
from ..machine.cams import roller
from ..machine.cams.profile import POSITIVE
from ..machine.cams.profile import profile as working_curve
from ..machine.cams.roller import MODULUS
from ..numbers import checks
from ..results.turn import require_single
from .cam_contact import UNITS, Contact
from .cam_rollers import Roller

SIZE = {"low": 0.0}
PARTS = ("roller", "cam")
MATERIAL: dict[str, tuple[str, dict[str, Any]]] = {
    "youngs_modulus": ("Pa", {**POSITIVE, "usual": MODULUS.usual}),
    "poissons_ratio": ("1", {"low": 0.0, "high": 0.5 + 1e-12}),
}
"""Unit and bounds of what is told of each part's material."""


def contact(
    solution,
    roller_radius=None,
    width=None,
    youngs_modulus=None,
    poissons_ratio=None,
    *,
    roller_mass=0.0,
    roller_inertia=None,
    load_rating=None,
    life_exponent=10 / 3,
    limits=None,
):
    """Contact of the roller with its cam over the turn, and what exceeds limits.

    Parameters
    ----------
    solution : Solution
        Of one design, of a mechanism with a `CamRoller`.
    roller_radius, width : float
        m; what is left out of these four is that of the scene's own `Roller`.
    youngs_modulus : float or (roller, cam)
        Pa.
    poissons_ratio : float or (roller, cam)
    roller_mass : float
        Of what turns, a part of the block's mass, kg.
    roller_inertia : float, optional
        Of what turns about its pin, kg m2; m R^2 / 2 unless told.
    load_rating : float, optional
        Basic dynamic load rating C of its bearing (ISO 281), N.
    life_exponent : float
        10/3 for roller bearings, 3 for ball bearings.
    limits : dict of str to float, optional
        Largest "pressure" (Pa), "pin_load" (N), "friction_coefficient", "pressure_angle" (rad) and "starting_torque"
        (N m); smallest convex "curvature_radius" (m), "life" (h) and "lift_off_speed" (rad/s). `exceeded` tells by what
        they are broken.

    Returns
    -------
    Contact

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
    require_single(solution, "contact", "cam_force")
    groups = solution.mechanism.led_by_ground
    told = {"roller_radius": roller_radius, "width": width, "youngs_modulus": youngs_modulus}
    told |= {"poissons_ratio": poissons_ratio}
    if groups:
        told = _with_roller(told, groups[0].roller)
    limits = {} if limits is None else limits
    own = {"roller_mass": (roller_mass, "kg", SIZE), "life_exponent": (life_exponent, "1", POSITIVE)}
    optional = {"roller_inertia": (roller_inertia, "kg*m**2", SIZE), "load_rating": (load_rating, "N", POSITIVE)}
    own |= {name: item for name, item in optional.items() if item[0] is not None}
    values = checks.singles(
        "contact",
        None if groups else _no_roller(solution.mechanism),
        *_limit_problems(limits, load_rating),
        **_contact_rules(told),
        **own,
        **_limit_rules(limits),
    )
    cam, radius, mass = groups[0].cam, values["roller_radius"], values["roller_mass"]
    inertia = values.get("roller_inertia", 0.5 * mass * radius * radius)
    wheel = Roller(cam, radius, mass, inertia, values.get("load_rating"), values["life_exponent"])
    materials = [[values[f"{name} of the {part}"] for name in MATERIAL] for part in PARTS]
    kept = {name: values[f"limit {name!r}"] for name in UNITS if name in limits}
    found = Contact(solution, cam, radius, values["width"], roller.modulus(*materials), wheel, kept)
    for side in found.sides:
        working_curve(cam, radius, 8, side)
    return found


def _contact_rules(told):
    """Values and rules of what is told of a contact, a material of roller and cam each."""
    rules: dict[str, tuple[Any, str, dict[str, Any]]] = {
        name: (told[name], "m", POSITIVE) for name in ("roller_radius", "width")
    }
    pairs = [
        value if isinstance(value, list | tuple) and len(value) == 2 else (value, value)
        for value in map(told.get, MATERIAL)
    ]
    for part, *both in zip(PARTS, *pairs, strict=True):
        rules |= {
            f"{name} of the {part}": (value, *rule) for (name, rule), value in zip(MATERIAL.items(), both, strict=True)
        }
    return rules


def _limit_rules(limits):
    """Values and rules of the limits that there are."""
    known = {name: limits[name] for name in UNITS if isinstance(limits, dict) and name in limits}
    return {f"limit {name!r}": (value, UNITS[name], POSITIVE) for name, value in known.items()}


def _with_roller(told, roller):
    """What was told, the rest as of the roller of the scene; refused where that has none either."""
    lacking = [name for name, value in told.items() if value is None]
    if lacking and roller is None:
        raise ParameterError(f"contact: {', '.join(lacking)} must be told, as the scene's CamRoller has no Roller")
    return told | {name: _of_both(roller, name.removeprefix("roller_")) for name in lacking}


def _of_both(roller, name):
    """A number of the roller, of a material also that of its cam where it is another."""
    own, other = getattr(roller, name), getattr(roller, f"cam_{name}", None)
    return own if other is None else (own, other)


def _no_roller(mechanism):
    text = f"solution must be of a mechanism with a CamRoller, a {mechanism.name} has none"
    follows = any(group.led for group in mechanism.groups)
    return text + "; give its follower a Roller or Face, then contact_pressure is an output" * follows


def _limit_problems(limits, load_rating):
    """What is wrong with the names of limits, as sentences."""
    if not isinstance(limits, dict):
        return [f"limits must be a dict of name to number, got {checks.shown(limits)}"]
    rating = "a limit of the life takes the load_rating of the roller's bearing"
    unrated = "life" in limits and load_rating is None
    return [*(checks.choice("limit", name, tuple(UNITS)) for name in limits), rating if unrated else None]
