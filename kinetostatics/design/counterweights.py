"""Counterweights on links: the mechanism with them, masses, arms, limits, and their effect on forces and torque."""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ..cycle.extremes import extremes
from ..cycle.rounding import zeroed
from ..errors import ParameterError
from ..machine.crank import Rotor
from ..machine.group import CRANK
from ..machine.mechanism import Mechanism
from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import label_of
from ..numbers import checks
from ..numbers.formatting import with_units
from ..numbers.planar import cross, dot
from ..solution.scene import solve
from .linkage import crank_sliders

PARALLEL_TOLERANCE = 1e-9
"""Sine of the angle between guides up to which they are parallel."""
CHANGE_TOLERANCE = 1e-10
"""Negligible change, per cent."""

MASS, LENGTH = (checks.Optional(checks.Number(unit, low=0.0, strict=True)) for unit in ("kg", "m"))
COUNTERWEIGHT_RULES = {
    "mass": MASS,
    "arm": checks.Optional(checks.Number("m")),
    "largest_mass": MASS,
    "largest_arm": LENGTH,
    "keep_out": LENGTH,
    "plane": checks.Optional(checks.Number("m")),
}
UNBALANCE_RULE = {"unbalance": checks.Pair("kg*m", parts=("along", "across"), lone=True)}


@dataclass(frozen=True)
class Counterweight:
    """A counterweight of given mass or arm, with limits; the balancing function sets its unbalance.

    Parameters
    ----------
    mass : float, optional
        kg; the arm follows.
    arm : float, optional
        Distance of its mass centre from the link's reference joint, m; negative on the extension behind the joint. The
        mass follows.
    whole_link : bool
        Whether mass and arm are those of the link including its counterweight, as for a new link.
    largest_mass, largest_arm : float, optional
        Limits, kg and m.
    keep_out : float, optional
        Radius around the reference joint in which the counterweight must not lie, m.
    plane : float, optional
        Position along the crankshaft of a counterweight on the crank, m; by default that of the link's mass centre.

    Raises
    ------
    ParameterError
        Both mass and arm are given, or neither, or a value is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> weight = ks.Counterweight(arm=-0.05, largest_mass=6.0)  # behind O, its mass to be found
    >>> found = ks.balancing.partial(mower, "overall", crank=weight)
    >>> round(found.counterweights["crank"][0], 3)  # kg
    3.547
    """

    mass: float | None = None
    arm: float | None = None
    whole_link: bool = False
    largest_mass: float | None = None
    largest_arm: float | None = None
    keep_out: float | None = None
    plane: float | None = None

    def __post_init__(self):
        given = [name for name in ("mass", "arm") if getattr(self, name) is not None]
        either = None if len(given) == 1 else f"give either mass or arm, not {'both' if given else 'neither'}"
        values = {name: getattr(self, name) for name in COUNTERWEIGHT_RULES}
        vars(self).update(checks.check_values("counterweight", COUNTERWEIGHT_RULES, values, either))
        checks.require("counterweight", "arm must not be 0" if self.arm == 0 else None)

    def placed(self, unbalance):
        """Mass and position (along, across) that give an unbalance (along, across), kg m."""
        size = float(np.hypot(*unbalance))
        if self.mass is not None:
            return self.mass, (unbalance[0] / self.mass, unbalance[1] / self.mass)
        if size == 0 or self.arm is None:
            return 0.0, (0.0, 0.0)
        if self.arm * unbalance[0] < 0:
            raise ParameterError(
                f"counterweight: at the arm {self.arm:g} m its mass would have to be {unbalance[0] / self.arm:.6g} kg; "
                f"place it on the other side of the joint: arm {-self.arm:g} m"
            )
        reach = abs(self.arm) / size
        return 1.0 / reach, (reach * unbalance[0], reach * unbalance[1])

    def unbalances(self):
        """Smallest and largest unbalance within the limits, kg m."""
        mass, arm = (self.largest_mass, self.arm) if self.mass is None else (self.mass, self.largest_arm)
        largest = np.inf if mass is None or arm is None else mass * abs(arm)
        return (self.mass or 0.0) * (self.keep_out or 0.0), largest

    def problems(self, link, mass, arm):
        """Sentences about exceeded limits of a counterweight, beyond rounding."""
        if mass == 0:
            return
        limits = [
            (self.largest_mass, mass, "kg", 1, "exceeds the largest mass"),
            (self.largest_arm, arm, "m", 1, "exceeds the largest arm"),
            (self.keep_out, arm, "m", -1, "lies inside the keep-out radius"),
        ]
        for limit, found, unit, sign, words in limits:
            if limit is not None and sign * (found - limit) > 1e-12 * limit:
                yield f"{link}: the counterweight needs {found:.6g} {unit}, {words} {limit:g} {unit}"


@with_units(counterweights="kg, m", in_planes="m, kg, m")
@dataclass(frozen=True, eq=False)
class Balanced:
    """A mechanism with counterweights.

    Attributes
    ----------
    bare, mechanism : Mechanism
        Before, and with its counterweights, ready for `solve`.
    counterweights : dict of link to (mass, (along, across))
        kg and m.
    in_planes : tuple of (plane, mass, (along, across))
        Counterweights of `in_two_planes`, with their positions along the crankshaft, m.

    Examples
    --------
    As `full`, `partial`, `optimal` and `counterweight` of ks.balancing return it.

    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.partial(mower, "overall", crank=ks.Counterweight(arm=-0.05))
    >>> round(found.added_mass, 3), round(found.ratio, 6)
    (3.547, 0.5)
    >>> found.report()["counterweight arm [m]"].to_dict()
    {'crank': -0.05}
    """

    bare: Mechanism = field(repr=False)
    mechanism: Mechanism = field(repr=False)
    counterweights: dict = field(default_factory=dict)
    in_planes: tuple = ()

    @property
    def ratio(self):
        """Resulting ratio (h1 / L_OA) / (h2 / L_AB); NaN if undefined, as after full balancing."""
        chains = crank_sliders(self.mechanism)
        if not chains:
            return np.nan
        crank, coupler, _ = chains[0]
        points = principal_points(self.mechanism)
        first, second = (points.static_moments[bar.link][0] for bar in (crank, coupler))
        if abs(second) <= 1e-12 * points.mass * coupler.length:
            return np.nan
        return (first / crank.length) / (second / coupler.length)

    @property
    def added_mass(self):
        """Mass of all counterweights, kg."""
        return sum(mass for mass, _ in self.counterweights.values())

    def report(self):
        """Counterweights and links before and after, as a pandas DataFrame with a row for each link."""
        import pandas as pd

        moduli = principal_points(self.mechanism).moduli
        rows = {}
        for name, (mass, place) in self.counterweights.items():
            bare, new = self.bare.links[name], self.mechanism.links[name]
            rows[name] = {
                "modulus h [m]": moduli[name],
                "counterweight mass [kg]": mass,
                "counterweight arm [m]": _signed_distance(place),
                "counterweight phase [deg]": np.degrees(np.arctan2(place[1], place[0])),
                "counterweight unbalance [kg m]": mass * np.hypot(*place),
                "link mass before [kg]": bare.mass,
                "link mass after [kg]": new.mass,
                "link centre after [m]": _signed_distance(new.centre),
                "link unbalance before [kg m]": bare.mass * np.hypot(*bare.centre),
                "link unbalance after [kg m]": new.mass * np.hypot(*new.centre),
            }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("link")

    def effect(self, *, crank_speed, crank_acceleration=0.0, loads=()):
        """Largest forces, moments and torque before and after, as a pandas DataFrame.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> mower = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
        >>> found = ks.balancing.partial(mower, "overall", crank=ks.Counterweight(arm=-0.05))
        >>> found.effect(crank_speed=62.8).loc["mass of links [kg]"].round(3).to_dict()
        {'before': 7.0, 'after': 10.167, 'change [%]': 45.238}
        """
        import pandas as pd

        angle = np.zeros(1)
        drive = {"crank_speed": crank_speed, "crank_acceleration": crank_acceleration, "loads": loads}
        before, after = (solve(item, angle, **drive) for item in (self.bare, self.mechanism))
        several = " of {}" if len(self.mechanism.guides) > 1 else ""
        quantities = {
            "shaking force [N]": "shaking_force",
            **{
                f"shaking force {way} guide{several.format(slider)} [N]": partial(component, slider=slider)
                for slider in self.mechanism.guides or (None,)
                for way, component in (("along", along_guide), ("across", across_guide))
            },
            "shaking moment [N m]": "shaking_moment",
            **{f"{label_of(before, joint)} [N]": joint for joint in before.reactions},
            "balancing torque [N m]": "balancing_torque",
        }
        rows = {"mass of links [kg]": [principal_points(item.mechanism).mass for item in (before, after)]}
        for name, quantity in quantities.items():
            rows[f"largest {name}"] = [abs(extremes(item, quantity).largest) for item in (before, after)]
        table = pd.DataFrame.from_dict(rows, orient="index", columns=["before", "after"])
        table["change [%]"] = zeroed(100 * (table["after"] / table["before"] - 1), CHANGE_TOLERANCE)
        return table


def counterweight(mechanism, link, unbalance, weight):
    """Mechanism with a counterweight of given unbalance added to one link.

    Parameters
    ----------
    mechanism : Mechanism
    link : str
    unbalance : float or (along, across)
        Unbalance of the counterweight, mass times arm, kg m; with ``weight.whole_link`` that of the whole link.
    weight : Counterweight
        Its mass or arm, and its limits.

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        The link is unknown, or the counterweight exceeds its limits; the message gives the numbers.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.counterweight(mower, "crank", -0.2, ks.Counterweight(mass=4.0))
    >>> mass, (along, across) = found.counterweights["crank"]
    >>> mass, round(float(along), 6)
    (4.0, -0.05)
    """
    problem = checks.choice("link", link, tuple(mechanism.links))
    if problem is None and weight.plane is not None and (link != CRANK or weight.whole_link):
        problem = (
            f"a plane is for a counterweight that is added to the crank, got {link}, whole_link={weight.whole_link}"
        )
    found = checks.check_values("counterweight", UNBALANCE_RULE, {"unbalance": unbalance}, problem)["unbalance"]
    bare, wanted = mechanism.links[link], np.array(found, dtype=float)
    if weight.whole_link:
        whole, _ = weight.placed(wanted)
        mass, added = whole - bare.mass, wanted - bare.mass * np.array(bare.centre)
        if mass <= 0 and np.any(added != 0):
            raise ParameterError(
                f"counterweight: the {link} with its counterweight would have {whole:.6g} kg, less than the "
                f"{bare.mass:g} kg of the bare link; choose a shorter arm or a larger mass"
            )
        place = tuple(added / mass) if mass > 0 else (0.0, 0.0)
    else:
        mass, place = weight.placed(wanted)
    checks.require("counterweight", *weight.problems(link, mass, float(np.hypot(*place))))
    new = bare.joined(mass, place) if weight.plane is None else Rotor.of(bare).joined(mass, place, weight.plane)
    return Balanced(mechanism, mechanism.with_link(link, new), {link: (mass, place)})


def counterweight_on_either_side(mechanism, link, unbalance, weight):
    """As `counterweight`, with the arm of the weight on the side of the unbalance (along, across)."""
    arm = None if weight.arm is None else float(np.copysign(weight.arm, unbalance[0]))
    return counterweight(mechanism, link, tuple(unbalance), replace(weight, arm=arm))


def _signed_distance(place):
    """Distance of a point from the joint, negative if `along` is."""
    return float(np.copysign(np.hypot(*place), place[0]))


def along_guide(solution, slider=None):
    """Shaking force along a guide, N."""
    return dot(guide_direction(solution.mechanism, slider), solution.shaking_force)


def across_guide(solution, slider=None):
    """Shaking force across a guide, to the left of it, N."""
    return cross(guide_direction(solution.mechanism, slider), solution.shaking_force)


def guide_direction(mechanism, slider=None):
    """Direction of the guide of a slider, or of all guides, which must be parallel; +x without any."""
    guides = mechanism.guides
    if slider is not None:
        return guides[slider].direction
    directions = [guide.direction for guide in guides.values()] or [(1.0, 0.0)]
    x, y = directions[0]
    if any(abs(x * v - y * u) > PARALLEL_TOLERANCE for u, v in directions):
        raise ParameterError(
            f"along and across the guide are undefined for a {mechanism.name} with guides of {' and '.join(guides)} "
            'that are not parallel; use "largest" or "mean"'
        )
    return directions[0]


def balancing_table(reference, variants, sampling=None):
    """Counterweights and shaking forces of variants, a pandas DataFrame with a column for each balanced link.

    Units are mm, kg and N; forces are in the first column of each variant. `reference` is the solution of the
    unbalanced mechanism, `variants` are (Balanced, Solution) by name; `sampling`, the crank-angle step of a published
    study, rad, adds the extremes on its grid.
    """
    import pandas as pd

    true_before = extremes(reference, "shaking_force").range[1]
    columns = {}
    for name, (balanced, solution) in variants.items():
        forces = {}
        if sampling:
            grid = np.arange(0.0, 2 * np.pi - 1e-9, sampling)
            before, (x, y) = (item.at(grid).shaking_force for item in (reference, solution))
            largest, largest_before = np.max(np.hypot(x, y)), np.max(np.hypot(*before))
            forces = {
                "largest F_x on the study's grid [N]": _largest_by_size(x),
                "largest F_y on the study's grid [N]": _largest_by_size(y),
                "largest |F| on the study's grid [N]": largest,
                "reduction of |F| on the study's grid [%]": 100 * (1 - largest / largest_before),
            }
        found = extremes(solution, "shaking_force")
        forces["largest |F| [N]"] = found.range[1]
        forces["at crank angle [deg]"] = np.degrees(found.angle[np.argmax(found.value)]) if len(found) else np.nan
        forces["reduction of |F| [%]"] = 100 * (1 - found.range[1] / true_before)
        for link, row in balanced.report().iterrows():
            columns[f"{name} {link}"] = {
                "modulus h [mm]": 1e3 * row["modulus h [m]"],
                "link centre with counterweight [mm]": 1e3 * row["link centre after [m]"],
                "link mass with counterweight [kg]": row["link mass after [kg]"],
                "link unbalance with counterweight [kg mm]": 1e3 * row["link unbalance after [kg m]"],
                "link unbalance before [kg mm]": 1e3 * row["link unbalance before [kg m]"],
                "counterweight unbalance [kg mm]": 1e3 * row["counterweight unbalance [kg m]"],
                "counterweight mass [kg]": row["counterweight mass [kg]"],
                "counterweight arm [mm]": 1e3 * row["counterweight arm [m]"],
                "counterweight phase [deg]": row["counterweight phase [deg]"],
                **forces,
            }
            forces = {}
    return pd.DataFrame(columns).rename_axis("quantity").round(9) + 0.0


def _largest_by_size(values):
    """Value of largest magnitude, with its sign; of values equal to rounding the first."""
    size = np.abs(values)
    return values[np.argmax(size >= (1 - 1e-12) * size.max())]
