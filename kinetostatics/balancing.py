"""Static balancing by counterweights on links: full, partial, optimal, and what each costs.

A counterweight of mass m at the arm L adds its unbalance m L to the static moment m h of its link (`principal_points`).
Full balancing makes all static moments vanish; partial balancing, with one counterweight on the crank, sets the ratio

    (h1 / L_OA) / (h2 / L_AB)      1: no shaking force across the guide     0: nearly none along it
                                   1/2: least overall, by the mower study (Kotov 2024)
"""

from dataclasses import dataclass, field, replace

import numpy as np

from . import checks
from .errors import ParameterError
from .extremes import extremes
from .mechanism import Mechanism
from .principal_points import principal_points
from .quantities import label, magnitude
from .rocker_group import RockerGroup
from .slider_group import SliderGroup
from .solution import solve

RATIOS = {"across": 1.0, "along": 0.0, "overall": 0.5}


@dataclass(frozen=True)
class Counterweight:
    """What is fixed of a counterweight before its unbalance is known: its mass or its arm, and its limits.

    Parameters
    ----------
    mass : float, optional
        kg; the arm follows.
    arm : float, optional
        Distance of its mass centre from the link's reference joint, m; negative on the extension behind the joint. The
        mass follows.
    whole_link : bool
        Mass and arm are those of the link together with its counterweight, as for a new link.
    largest_mass, largest_arm : float, optional
        Limits, kg and m.
    keep_out : float, optional
        Radius around the reference joint that it must stay outside of, m.

    Raises
    ------
    ParameterError
        Both mass and arm are given, or neither, or a value is not possible.
    """

    mass: float | None = None
    arm: float | None = None
    whole_link: bool = False
    largest_mass: float | None = None
    largest_arm: float | None = None
    keep_out: float | None = None

    def __post_init__(self):
        given = [name for name in ("mass", "arm") if getattr(self, name) is not None]
        checks.require(
            "counterweight",
            None if len(given) == 1 else f"give either mass or arm, not {'both' if given else 'neither'}",
            *(
                checks.positive(name, getattr(self, name))
                for name in ("mass", "largest_mass", "largest_arm", "keep_out")
                if getattr(self, name) is not None
            ),
            None if self.arm is None else checks.finite("arm", self.arm) or (self.arm == 0 and "arm must not be 0"),
        )

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
                f"it belongs on the other side of the joint: arm {-self.arm:g} m"
            )
        reach = abs(self.arm) / size
        return 1.0 / reach, (reach * unbalance[0], reach * unbalance[1])

    def largest_unbalance(self):
        """Largest unbalance within the limits, kg m; infinite without limits."""
        mass, arm = (self.largest_mass, self.arm) if self.mass is None else (self.mass, self.largest_arm)
        return np.inf if mass is None or arm is None else mass * abs(arm)

    def problems(self, link, mass, arm):
        """How a counterweight found breaks its limits."""
        limits = [
            ("largest_mass", mass, "kg", np.greater, "exceeds the largest mass"),
            ("largest_arm", arm, "m", np.greater, "exceeds the largest arm"),
            ("keep_out", arm, "m", np.less, "lies inside the keep-out radius"),
        ]
        for name, found, unit, breaks, words in limits:
            limit = getattr(self, name)
            if limit is not None and mass > 0 and breaks(found, limit * (1 + np.sign(found - limit) * 1e-12)):
                yield f"{link}: the counterweight needed, {found:.6g} {unit}, {words} {limit:g} {unit}"


@dataclass(frozen=True, eq=False)
class Balanced:
    """A balanced mechanism and what was done to it.

    Attributes
    ----------
    bare, mechanism : Mechanism
        Before, and with its counterweights, ready for `solve`.
    counterweights : dict of link to (mass, (along, across))
        kg and m.
    """

    bare: Mechanism
    mechanism: Mechanism
    counterweights: dict = field(default_factory=dict)

    @property
    def ratio(self):
        """Ratio (h1 / L_OA) / (h2 / L_AB) reached; NaN where it has no meaning, as after full balancing."""
        found = principal_points(self.mechanism).static_moments
        lengths = {bar.link: bar.length for bar in self.mechanism.bars}
        if "crank" not in lengths or found["coupler"][0] == 0:
            return np.nan
        return (found["crank"][0] / lengths["crank"]) / (found["coupler"][0] / lengths["coupler"])

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
                "counterweight arm [m]": _signed(place),
                "counterweight phase [deg]": np.degrees(np.arctan2(place[1], place[0])),
                "counterweight unbalance [kg m]": mass * np.hypot(*place),
                "link mass before [kg]": bare.mass,
                "link mass after [kg]": new.mass,
                "link centre after [m]": _signed(new.centre),
                "link unbalance before [kg m]": bare.mass * np.hypot(*bare.centre),
                "link unbalance after [kg m]": new.mass * np.hypot(*new.centre),
            }
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("link")

    def effect(self, *, crank_speed, crank_acceleration=0.0, loads=()):
        """The price and the gain: largest forces, moments and torque before and after, as a pandas DataFrame."""
        import pandas as pd

        angle = np.zeros(1)
        drive = {"crank_speed": crank_speed, "crank_acceleration": crank_acceleration, "loads": loads}
        before, after = (solve(item, angle, **drive) for item in (self.bare, self.mechanism))
        rows = {"mass of links [kg]": [principal_points(item.mechanism).mass for item in (before, after)]}
        for name, unit, quantity in [
            ("largest shaking force", "N", "shaking_force"),
            ("largest shaking force along guide", "N", _along),
            ("largest shaking force across guide", "N", _across),
            ("largest shaking moment", "N m", "shaking_moment"),
            *((f"largest {label(joint)}", "N", joint) for joint in before.reactions),
            ("largest balancing torque", "N m", "balancing_torque"),
        ]:
            rows[f"{name} [{unit}]"] = [abs(extremes(item, quantity).largest) for item in (before, after)]
        table = pd.DataFrame.from_dict(rows, orient="index", columns=["before", "after"])
        table["change [%]"] = 100 * (table["after"] / table["before"] - 1)
        return table


def counterweight(mechanism, link, unbalance, weight):
    """Mechanism with a counterweight of given unbalance added to one link.

    Parameters
    ----------
    mechanism : Mechanism
    link : str
    unbalance : float or (along, across)
        Unbalance of the counterweight, mass times arm, kg m; of the link with it if ``weight.whole_link``.
    weight : Counterweight
        Its mass or arm, and its limits.

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        No such link, or the counterweight needed breaks its limits; with the numbers.
    """
    checks.require("counterweight", checks.choice("link", link, tuple(mechanism.links)))
    bare = mechanism.links[link]
    wanted = np.array(unbalance if np.ndim(unbalance) else (unbalance, 0.0), dtype=float)
    own = bare.mass * np.array(bare.centre)
    if weight.whole_link:
        whole, _ = weight.placed(wanted)
        mass, added = whole - bare.mass, wanted - own
        if mass <= 0 and np.any(added != 0):
            raise ParameterError(
                f"counterweight: the {link} with its counterweight would weigh {whole:.6g} kg, less than the "
                f"{bare.mass:g} kg it has; choose a shorter arm or a larger mass"
            )
        place = tuple(added / mass) if mass > 0 else (0.0, 0.0)
    else:
        mass, place = weight.placed(wanted)
    checks.require("counterweight", *weight.problems(link, mass, float(np.hypot(*place))))
    return Balanced(mechanism, mechanism.with_link(link, bare.joined(mass, place)), {link: (mass, place)})


def full(mechanism, *, crank, coupler=None, rocker=None):
    """Fully balanced mechanism: its common mass centre stands still.

    Parameters
    ----------
    mechanism : Mechanism
        Crank-slider (counterweights on crank and coupler) or four-bar (on crank and rocker).
    crank, coupler, rocker : Counterweight

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        A counterweight is missing or not needed, breaks its limits, or the mechanism cannot be balanced so.
    """
    given = {name: item for name, item in [("coupler", coupler), ("rocker", rocker)] if item is not None}
    outer = "rocker" if mechanism.group(RockerGroup) else "coupler"
    _refuse_cam(mechanism)
    _refuse_massless(mechanism)
    if set(given) != {outer}:
        raise ParameterError(
            f"full balancing of a {mechanism.name} takes a counterweight on crank and {outer}, got crank"
            f"{''.join(f' and {name}' for name in given) or ' only'}"
        )
    first = _set(mechanism, outer, (0.0, 0.0), given[outer])
    second = _set(first.mechanism, "crank", (0.0, 0.0), crank)
    return Balanced(mechanism, second.mechanism, {**second.counterweights, **first.counterweights})


def partial(mechanism, ratio="overall", *, crank):
    """Partially balanced crank-slider, by one counterweight on the crank.

    Parameters
    ----------
    mechanism : Mechanism
        Crank-slider.
    ratio : "across", "along", "overall" or float
        (h1 / L_OA) / (h2 / L_AB): 1, 0 or 1/2 by name.
    crank : Counterweight

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        The mechanism is no crank-slider or has no mass, the ratio is unknown, the condition cannot be reached by a
        counterweight on the crank, or the counterweight breaks its limits.
    """
    value = _ratio(ratio)
    _refuse_cam(mechanism)
    _refuse_massless(mechanism)
    if mechanism.group(SliderGroup) is None:
        raise ParameterError(f"partial balancing by ratio is for crank-sliders, not for a {mechanism.name}")
    lengths = {bar.link: bar.length for bar in mechanism.bars}
    moments = principal_points(mechanism).static_moments
    along, across = moments["coupler"]
    if value == 1 and across != 0:
        raise ParameterError(
            f"partial balancing: the coupler's mass centre lies {mechanism.links['coupler'].centre[1]:g} m off the "
            "line A-B, so no counterweight on the crank takes the force across the guide away; balance the coupler too"
        )
    return _set(mechanism, "crank", (value * lengths["crank"] * along / lengths["coupler"], 0.0), crank)


NORMS = ("largest", "mean", "along", "across", "weighted")


def optimal(mechanism, norm="largest", *, phase=False, weights=(1.0, 0.0), angles=360, **counterweights):
    """Counterweights whose unbalances minimise a norm of the shaking force over the turn, at constant crank speed.

    Parameters
    ----------
    mechanism : Mechanism
    norm : "largest", "mean", "along", "across" or "weighted"
        Largest or mean magnitude of the shaking force, its largest component along or across the guide, or the root
        mean square of force and moment with the given weights.
    phase : bool
        Whether a counterweight may lie beside its link's line.
    weights : (force, moment)
        For "weighted": 1/N and 1/(N m). A counterweight on the crank alone does not change the shaking moment.
    angles : int
        Crank angles at which the norm is taken.
    **counterweights : Counterweight
        By link, as ``crank=Counterweight(arm=0.03)``; the side they lie on is found, the sign of the arm does not
        matter. Limits are kept.

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        An unknown norm, a link that does not exist, no counterweight at all, or limits that cannot be kept.
    """
    from scipy.optimize import minimize

    _refuse_massless(mechanism)
    checks.require(
        "optimal balancing",
        checks.choice("norm", norm, NORMS),
        None if counterweights else "give at least one counterweight, such as crank=Counterweight(arm=0.03)",
        *(checks.choice("link", name, tuple(mechanism.links)) for name in counterweights),
    )
    turn = np.linspace(0, 2 * np.pi, angles, endpoint=False)
    size = 2 if phase else 1

    def balanced(unknowns):
        result = Balanced(mechanism, mechanism)
        for (name, weight), unbalance in zip(counterweights.items(), unknowns.reshape(-1, size), strict=True):
            step = _added(result.mechanism, name, np.append(unbalance, 0.0)[:2], weight)
            result = Balanced(mechanism, step.mechanism, {**result.counterweights, **step.counterweights})
        return result

    def objective(unknowns):
        solution = solve(balanced(unknowns * scale).mechanism, turn, crank_speed=1.0, on_gap="nan")
        return _norm(solution, norm, weights) / reference

    scale = max(float(np.hypot(*pair)) for pair in principal_points(mechanism).static_moments.values())
    reference = 1.0
    start = np.zeros(size * len(counterweights))
    reference = objective(start) or 1.0
    for _ in range(3):
        start = minimize(
            objective, start, method="Nelder-Mead", options={"xatol": 1e-12, "fatol": 1e-14, "maxiter": 4000}
        ).x
    return balanced(start * scale)


def _norm(solution, norm, weights):
    force = solution.shaking_force
    if norm == "largest":
        return np.max(magnitude(force))
    if norm == "mean":
        return np.mean(magnitude(force))
    if norm == "weighted":
        return np.sqrt(np.mean((weights[0] * magnitude(force)) ** 2 + (weights[1] * solution.shaking_moment) ** 2))
    return np.max(np.abs((_along if norm == "along" else _across)(solution)))


def _added(mechanism, link, unbalance, weight):
    """A counterweight of that unbalance, on whichever side, reduced to its limits."""
    size = float(np.hypot(*unbalance))
    limit = weight.largest_unbalance()
    kept = unbalance if size <= limit else unbalance * (limit / size)
    sided = weight if weight.arm is None else replace(weight, arm=float(np.copysign(weight.arm, kept[0])))
    return counterweight(mechanism, link, kept, sided)


def _set(mechanism, link, moment, weight):
    """Counterweight that gives a link this static moment."""
    change = complex(*moment) - _static_moment(mechanism, link)
    own = mechanism.links[link]
    target = change + (complex(*own.centre) * own.mass if weight.whole_link else 0.0)
    return counterweight(mechanism, link, (target.real, target.imag), weight)


def _static_moment(mechanism, link):
    """Static moment of a link, along + i across.

    In a four-bar the coupler's vector is a sum of those of rocker, crank and frame, so its static moment passes to
    crank and rocker in proportion to their lengths (Berkof and Lowen 1969).
    """
    moments = {name: complex(*pair) for name, pair in principal_points(mechanism).static_moments.items()}
    group = mechanism.group(RockerGroup)
    if group is not None:
        share = moments["coupler"] / group.coupler_length
        moments["crank"] -= share * mechanism.crank.length
        moments["rocker"] += share * group.rocker_length
    return moments[link]


def _ratio(ratio):
    if isinstance(ratio, str):
        checks.require("partial balancing", checks.choice("ratio", ratio, tuple(RATIOS)))
        return RATIOS[ratio]
    checks.require("partial balancing", checks.finite("ratio", ratio))
    return float(ratio)


def _refuse_cam(mechanism):
    if mechanism.crank.length is None:
        carried = principal_points(mechanism).carried.get("A", 0.0)
        raise ParameterError(
            f"the pin A of a {mechanism.name} runs at a varying distance from O with {carried:g} kg on it, so no "
            "counterweight on the crank balances it; use `optimal`, or a plain crank-slider"
        )


def _refuse_massless(mechanism):
    if not np.any(principal_points(mechanism).mass):
        raise ParameterError(f"the {mechanism.name} has no mass: there is nothing to balance")


def _signed(place):
    """Distance of a point from the joint, negative behind it."""
    return float(np.copysign(np.hypot(*place), place[0]))


def _along(solution):
    return np.tensordot(_guide_direction(solution), solution.shaking_force, 1)


def _across(solution):
    x, y = _guide_direction(solution)
    return np.tensordot((-y, x), solution.shaking_force, 1)


def _guide_direction(solution):
    group = solution.mechanism.group(SliderGroup)
    return (1.0, 0.0) if group is None else group.guide.direction
