"""Axial force, shear force and bending moment inside a straight link, over its length and the turn.

The part of a link from its first pin to a section is in equilibrium: inertia, weight, forces of pins and loads on it,
and the forces of the section (d'Alembert; Timoshenko, *Strength of Materials*). With x from the first pin along t, n
the left normal of t, mu the mass per length, and the acceleration a, which is linear in x:

    N' = mu (a - g).t        V' = mu (g - a).n        M' = V

So between pins, point masses and loads N and V are quadratic in x, and M is cubic: extremes over x are those of
polynomials. N is positive in tension, V is the force of the part along n, and M > 0 stretches the fibre on the right of
t. M is 0 at both pins without friction.
"""

import warnings
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..errors import ConditionWarning
from ..machine.cams.profile import POSITIVE
from ..mechanics.free_body import INERTIA, LOAD, REACTION, WEIGHT, free_body
from ..numbers import checks
from ..numbers.formatting import with_units
from ..numbers.lazy import cached_property
from ..numbers.planar import cross, dot

BAR = {
    "area": ("m**2", POSITIVE),
    "modulus": ("m**3", POSITIVE),
    "mass": ("kg", {"low": 0.0}),
    "second_moment": ("m**4", POSITIVE),
    "youngs_modulus": ("Pa", POSITIVE),
}
"""Unit and rule of each number of a bar."""
PLACES = np.array([0.02, 0.17, 0.31, 0.46, 0.62, 0.77, 0.93])
"""Places in the period, relative to it, at which the forces are located on a link."""
TOPS, ZOOM, ZOOMS = 8, 16, 7
"""Highest samples of the turn that are refined; factor by which their step shrinks, and how often: to 1e-12 rad."""
NEAR_PERIOD = 1e-6
"""Distance from the end of the period, rad, below which a peak is at 0."""
TOLERANCE = 1e-9
"""Difference of places, and of a bar from its link, relative to lengths and masses, that is rounding."""


@dataclass(frozen=True, eq=False)
class Bar:
    """Section and mass of a straight link: a uniform bar from pin to pin, and point masses on it.

    Parameters
    ----------
    area : float
        A of the section, m2.
    modulus : float
        Section modulus W for bending in the plane of motion, m3: stress N/A +- M/W at the two outer fibres.
    masses : sequence of (x, mass)
        Point masses, kg, at x from the first pin, m.
    mass : float, optional
        Of the uniform bar, kg; by default what the link's mass leaves beside `masses`.
    second_moment, youngs_modulus : float, optional
        Second moment of area I, m4, and E, Pa; buckling and rigidity need them.

    Raises
    ------
    ParameterError
        A number is not finite, or not positive; a point mass or its place is negative.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.Bar(area=6e-3, modulus=3e-4, masses=[(1.0, 88.5)], mass=61.5).properties(2.0)
    (150.0, 1.0, 20.5)
    """

    area: float
    modulus: float
    masses: tuple[tuple[float, float], ...] = ()
    mass: float | None = None
    second_moment: float | None = None
    youngs_modulus: float | None = None

    def __post_init__(self):
        try:
            pairs, problem = [(x, mass) for x, mass in self.masses], None
        except (TypeError, ValueError):
            pairs, problem = [], f"masses must be pairs (x, mass), m and kg, got {checks.shown(self.masses)}"
        given = {name: (getattr(self, name), *of) for name, of in BAR.items() if getattr(self, name) is not None}
        for number, (x, mass) in enumerate(pairs, 1):
            given |= {f"x {number}": (x, "m", {"low": 0.0}), f"point mass {number}": (mass, "kg", {"low": 0.0})}
        found = checks.single_numbers("Bar", problem, **given)
        masses = [(found.pop(f"x {number}"), found.pop(f"point mass {number}")) for number in range(1, len(pairs) + 1)]
        vars(self).update(found, masses=tuple(masses))

    def properties(self, length):
        """Mass, kg, centre from the first pin, m, and moment of inertia about it, kg m2, for a length, m."""
        bar: Any = self.mass
        checks.require("Bar.properties", "give the bar its mass, kg" if bar is None else None)
        parts = [(0.5 * length, bar), *self.masses]
        total = sum(mass for _, mass in parts)
        centre = sum(x * mass for x, mass in parts) / total if total else 0.5 * length
        return total, centre, bar * length**2 / 12.0 + sum(mass * (x - centre) ** 2 for x, mass in parts)


@with_units(x="m", angle="rad")
class SectionPeak(NamedTuple):
    """Largest value in the bar over the period, at `x` from the first pin, m, and a crank angle, rad."""

    value: float
    x: float
    angle: float


@dataclass(frozen=True, eq=False, repr=False)
class Sections:
    """Forces inside a straight link; made by `Solution.sections`.

    Attributes
    ----------
    solution : Solution
    link : str
    bar : Bar
        With the mass of its uniform part.
    x : array (at,)
        Sections from the first pin, m; at a pin, load or point mass the section lies before it.
    stations : array
        Places of pins, loads and point masses, m, from 0 to the length between the pins.
    start : float
        Coordinate of the first pin on the link's own axis, m.
    placed : tuple of int
        Station of each pin force, load and point mass.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 50.0), slider=ks.Link(600))
    >>> found = ks.Scene(saw, 33.5).solve(360).sections("coupler", bar=ks.Bar(area=6e-3, modulus=3e-4))
    >>> print(f"{found.largest_moment.value:.0f} N m at {found.largest_moment.x:.3f} m")
    6545 N m at 0.851 m
    """

    solution: Any
    link: str
    bar: Bar
    x: np.ndarray
    stations: np.ndarray
    start: float
    placed: tuple[int, ...]

    def __repr__(self):
        value, x, angle = self.largest_moment
        where = f"{value:.6g} N m at {x:.6g} m and {np.degrees(angle):.6g} deg"
        return f"<Sections: {self.link}, {len(self.x)} sections, largest bending moment {where}>"

    axial_force = property(lambda self: self._curves[0], doc="Axial force (at, N), N, positive in tension.")
    shear_force = property(lambda self: self._curves[1], doc="Shear force (at, N), N.")
    bending_moment = property(lambda self: self._curves[2], doc="Bending moment (at, N), N m.")
    largest_tension = property(lambda self: self.largest["tension"], doc="A `SectionPeak`, N.")
    largest_compression = property(lambda self: self.largest["compression"], doc="A `SectionPeak`, N.")
    largest_shear = property(lambda self: self.largest["shear"], doc="Of its size, a `SectionPeak`, N.")
    largest_moment = property(lambda self: self.largest["moment"], doc="Of its size, a `SectionPeak`, N m.")

    @cached_property
    def largest(self):
        """`SectionPeak` of tension, compression, shear and moment by name."""
        return self.peaks(
            {
                "tension": lambda n, v, m: [n],
                "compression": lambda n, v, m: [-n],
                "shear": lambda n, v, m: [v, -v],
                "moment": lambda n, v, m: [m, -m],
            }
        )

    @cached_property
    def _curves(self):
        segment = np.clip(np.searchsorted(self.stations, self.x) - 1, 0, len(self.stations) - 2)
        at = self.solution.moved_to(np.atleast_1d(self.solution.crank_angle))
        found = evaluate(self.polynomials(at)[:, :, segment], self.x[:, None])
        return found.reshape(*found.shape[:2], *self.solution.shape)

    def polynomials(self, solution):
        """Coefficients of N, V and M by powers of x between the stations, (3, 4, segments, N), at other angles."""
        motion = solution.dynamics
        t = motion.as_vector(motion.placement.links[self.link].direction)
        axes = (t, np.stack([-t[1], t[0]]))
        pull = motion.as_vector(motion.gravity) - motion.acceleration((self.link, self.start, 0.0))
        pull = np.stack([dot(pull, axis) for axis in axes])  # force on a unit mass at the first pin, and its slope in x
        slope = np.stack([motion.rate(self.link) ** 2, -motion.angular_acceleration(self.link)])
        acting = [[*(dot(item.force, axis) for axis in axes), item.couple] for item in _actions(motion, self.link)]
        acting += [[*(mass * (pull + x * slope)), 0.0 * pull[0]] for x, mass in self.bar.masses]
        forces = np.zeros((len(self.stations), 3, pull.shape[-1]))  # along t, along n, couple
        np.add.at(forces, list(self.placed), acting)
        moments = forces[:, 1] * self.stations[:, None] + forces[:, 2]
        axial, shear, moment = (part[:-1].cumsum(axis=0) for part in (forces[:, 0], forces[:, 1], moments))
        per_length = self.bar.mass / self.stations[-1]
        (p, q), (p_slope, q_slope), none = per_length * pull, per_length * slope, 0.0 * axial
        return np.array(
            [
                [-axial, none - p, none - p_slope / 2.0, none],
                [shear, none + q, none + q_slope / 2.0, none],
                [-moment, shear, none + q / 2.0, none + q_slope / 6.0],
            ]
        )

    def peaks(self, choices) -> dict[str, SectionPeak]:
        """Largest value over bar and period of the polynomials that each ``choose(axial, shear, moment)`` lists."""
        from ..cycle.extremes import extrema, largest_of, warning

        turn = self.solution.sampled_for_forces

        def heights(at):
            return np.array([values.max(axis=0) for _, values in self._candidates(choices.values(), at)])

        if turn.limits.size:  # forces may grow without bound
            found = [extrema(self.solution, lambda at, row=row: heights(at)[row]) for row in range(len(choices))]
            found = [
                replace(item, quantity=f"{name} in {self.link}") for name, item in zip(choices, found, strict=True)
            ]
            if text := warning(self.solution, found):
                warnings.warn(text, ConditionWarning, stacklevel=5)
            value, angle = np.nan_to_num([largest_of(item) for item in found], posinf=np.inf).T
        else:
            value, angle = _refined(turn, heights)
        peaks, candidates = {}, self._candidates(choices.values(), turn.at.moved_to(angle))
        for row, (name, (places, values)) in enumerate(zip(choices, candidates, strict=True)):
            peaks[name] = SectionPeak(float(value[row]), float(places[values[:, row].argmax(), row]), float(angle[row]))
        return peaks

    def _candidates(self, choices, at):
        """Yield places and values (candidates, N) at ends of parts and turning points, for each choice."""
        low, high = self.stations[:-1, None], self.stations[1:, None]
        with np.errstate(invalid="ignore"):
            forces = self.polynomials(at)
            for choose in choices:
                polynomials = np.array(choose(*forces))
                places = np.array(np.broadcast_arrays(low, high, *_turning(polynomials)))
                places = np.clip(np.nan_to_num(places), low, high)
                values = evaluate(polynomials, places)
                yield places.reshape(-1, places.shape[-1]), values.reshape(-1, values.shape[-1])

    def table(self):
        """Largest tension, compression, shear force and bending moment with their places, a pandas DataFrame."""
        import pandas as pd

        units = {"tension": "N", "compression": "N", "shear": "N", "moment": "N m"}
        rows = [(name, units[name], at.value, at.x, np.degrees(at.angle)) for name, at in self.largest.items()]
        return pd.DataFrame(rows, columns=["largest", "unit", "value", "x [m]", "at [deg]"]).set_index("largest")


class WithSections:
    """Solutions give the forces inside their straight links."""

    def sections(self: Any, link, bar, at=101) -> Sections:
        """Axial force, shear force and bending moment inside a straight link between two pins.

        Parameters
        ----------
        link : str
            "coupler", "rocker", "crank" ...
        bar : Bar
            Its section, and its mass as a uniform bar and point masses.
        at : int
            Number of sections, evenly spaced from pin to pin.

        Returns
        -------
        Sections
            `.axial_force`, `.shear_force`, `.bending_moment` (at, N); `.largest_moment` ... over length and turn,
            whatever the sections and crank angles; `.table()`, ``ks.plots.sections(found)``.

        Raises
        ------
        ParameterError
            Mass, centre or inertia of the bar are not those of the link; a force on the link acts off the line of its
            pins, moves along it, or is a couple without a place; the mechanism does not close all round; a batch.
        QuantityError
            The link is unknown.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
        >>> bar = ks.Bar(area=6e-3, modulus=3e-4, masses=[(1.0, 88.5)])
        >>> ks.Scene(saw, 33.5).solve(360).sections("coupler", bar).largest_compression.value.__round__()
        218418
        """
        from ..cycle.means import closed_turn

        owner = f"sections of {link!r}"
        wrong = f"bar must be a ks.Bar(area=..., modulus=...), got {checks.shown(bar)}"
        size = 3 * 8 * self.crank_angle.size
        checks.require(owner, None if isinstance(bar, Bar) else wrong, checks.count("at", at, size=size))
        motion = self.moved_to(closed_turn(self, owner).period * PLACES).dynamics
        places, start, size = _places(motion, link, owner)
        bar = _own_bar(bar, motion.mechanism.links[link], start, max(places), owner)
        known = np.array([*places, *(x for x, _ in bar.masses)])
        stations = np.unique(known)
        stations = stations[np.diff(stations, prepend=-np.inf) > size]
        placed = np.abs(known[:, None] - stations).argmin(axis=1)
        return Sections(self, link, bar, np.linspace(0.0, stations[-1], at), stations, start, tuple(placed.tolist()))


def _refined(turn, heights):
    """Largest value of each height over a turn, and its crank angle: all are refined together by ever finer samples."""
    angle = np.union1d(turn.angle, turn.even.crank_angle)
    values, reach = heights(turn.at.moved_to(angle)), np.diff(angle).max()
    rises = np.diff(values, prepend=values[:, -1:]) > 0.0
    tops = np.where(rises & ~np.roll(rises, -1, axis=1), -values, np.inf)
    middle = angle[np.argsort(tops, axis=1, kind="stable")[:, :TOPS]]
    for _ in range(ZOOMS):
        near = middle[..., None] + reach * np.linspace(-1.0, 1.0, 2 * ZOOM + 1)
        found = heights(turn.at.moved_to(near.ravel() % turn.period)).reshape(-1, *near.shape)
        values = np.einsum("kk...->k...", found)
        middle = np.take_along_axis(near, values.argmax(axis=-1)[..., None], axis=-1)[..., 0]
        reach /= ZOOM
    angle = middle[np.arange(len(values)), values.max(axis=-1).argmax(axis=-1)] % turn.period
    return values.max(axis=(1, 2)), np.where(turn.period - angle < NEAR_PERIOD, 0.0, angle)


def evaluate(coefficients, x):
    """Polynomials by their coefficients (..., 4, segments, N) at x."""
    constant, first, second, third = np.moveaxis(coefficients, -3, 0)
    return constant + x * (first + x * (second + x * third))


def _turning(polynomials):
    """Both places where the slope of cubics (kinds, 4, segments, N) is zero; not finite where there is none."""
    _, c, half_b, a = np.moveaxis(polynomials, 1, 0)
    a = 3.0 * a
    with np.errstate(all="ignore"):
        far = -half_b - np.copysign(np.sqrt(half_b * half_b - a * c), half_b)
        return far / a, c / far


def _actions(motion, link):
    """Forces and couples on a link but its own inertia and weight."""
    return [item for item in free_body(motion, link) if item.kind not in (INERTIA, WEIGHT)]


def _places(motion, link, owner):
    """Distance of each action from the first pin, m, coordinate of that pin on the link's axis, and their rounding."""
    actions, placed = _actions(motion, link), motion.placement.links[link]
    origin, axis = motion.as_vector(placed.joint.position), motion.as_vector(placed.direction)
    rays = [item.point - origin for item in actions]
    along, across = (np.array([part(axis, ray) for ray in rays]) for part in (dot, cross))
    size = TOLERANCE * motion.mechanism.extent
    pins = [row.mean() for row, item in zip(along, actions, strict=True) if item.kind == REACTION]
    start, stop = (min(pins), max(pins)) if pins else (0.0, 0.0)
    texts = [None if stop - start > size else "it has no two pins, so it is not a bar between pins"]
    for item, x, y in zip(actions, along, across, strict=True):
        if np.ptp(x) > size:
            texts.append(f"{item.name!r} moves along it by {np.ptp(x):.4g} m or more")
        elif np.abs(y).max() > size:
            texts.append(f"{item.name!r} acts {np.abs(y).max():.4g} m off its axis")
        elif item.kind == LOAD and np.any(item.couple):
            texts.append(f"{item.name!r} is a couple without a place on the bar")
        elif not -size <= x.mean() - start <= stop - start + size:
            texts.append(f"{item.name!r} acts {x.mean() - start:.4g} m from the first pin, beyond the second")
    checks.require(owner, *texts)
    return along.mean(axis=1) - start, start, size


def _own_bar(bar, link, start, length, owner):
    """The bar with the mass of its uniform part; refused unless it has the link's mass, centre and inertia."""
    if bar.mass is None:
        bar = replace(bar, mass=max(0.0, link.mass - sum(mass for _, mass in bar.masses)))
    mass, centre, inertia = bar.properties(length)
    along, across = (link.centre[0] - start, link.centre[1]) if link.mass else (centre, 0.0)
    lost = (mass - link.mass, np.hypot(centre - along, across), inertia - link.inertia)
    sizes = (link.mass, length, max(link.mass * length**2, link.inertia))
    text = (
        f"the bar is not the link: its mass, {mass:.6g} kg, differs by {lost[0]:+.4g} kg, its centre, {centre:.6g} m "
        f"from the first pin, by {lost[1]:.4g} m, its moment of inertia, {inertia:.6g} kg m2, by {lost[2]:+.4g} kg m2; "
        "give the link these numbers, or change the bar"
    )
    equal = all(abs(part) <= TOLERANCE * size for part, size in zip(lost, sizes, strict=True))
    last = max((x for x, _ in bar.masses), default=0.0)
    beyond = f"a point mass lies at {last:.6g} m, beyond the second pin at {length:.6g} m"
    checks.require(owner, None if equal else text, beyond if last > length * (1.0 + TOLERANCE) else None)
    return bar
