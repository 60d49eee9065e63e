"""Shares of the sources of a force: inertia and weight of each link, and each load, at the peak of the total and alone.

At a given motion inverse dynamics is linear in masses, inertias and loads, so a force is the sum of those that each
source causes alone. This is superposition (Uicker, Pennock and Shigley, *Theory of Machines and Mechanisms*, dynamic
force analysis). The share of a source is its value where the total is largest; of a vector V_i its projection on the
total,

    R = sum V_i        share_i = V_i . R / |R|        sum share_i = |R|

Peaks do not add: sources have theirs at different crank angles, and may cancel. Each source is solved alone, every
other number zero, so that a small share keeps its digits beside large ones that cancel.

Friction follows the size of the reactions and is not linear, nor is the separating force of teeth. With them a row is
the effect of leaving out its source: the force of the whole machine less that of the machine without the source.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.kinks import has_sign_changes
from ..cycle.load_functions import with_resolution
from ..cycle.means import TERM_ROUNDING, WARNING_ERROR, closed_turn, means
from ..cycle.rounding import FLOOR, PLACED, zeroed
from ..engines.engines import NUMPY
from ..errors import ConditionWarning, ParameterError, QuantityError
from ..machine.friction import NO_FRICTION, frictions_by_joint
from ..machine.group import GROUND
from ..machine.loads import Force, Gravity, loads_with_mass
from ..mechanics import jamming
from ..mechanics.load_values import numbered_titles
from ..mechanics.quantities import Quantity, components, magnitude, of_scene, without_bars
from ..numbers import checks
from ..numbers.formatting import angle as angle_text
from ..numbers.formatting import number

KINDS, LINEAR_ENERGIES = ("force", "reaction", "whole"), ("load_torque",)
"""Kinds of quantities that are linear in masses and loads, and the names of others that are."""
TOTAL = "total"
"""Name of the last row."""
FRICTION_ANGLES = 360
"""Even crank angles at which machines without a source are tested for jamming."""


class Share(NamedTuple):
    """Share of one source in a force or moment, N or N m.

    Attributes
    ----------
    source : str
        "inertia of coupler", "weight of coupler", "Spring on 'slider'", "friction O" ...
    value : float
        At the peak of the total: of a vector its projection on the total.
    peak, angle : float
        Value of largest magnitude over the period, of a vector its magnitude, and its crank angle, rad; NaN for a
        constant.
    rms : float
        Root mean square over the crank angle.
    """

    source: str
    value: float
    peak: float
    angle: float
    rms: float


@dataclass(frozen=True, eq=False)
class Shares:
    """Shares of the sources of one force or moment of a machine; made by `Solution.shares`.

    Attributes
    ----------
    quantity, unit, label : str
    rows : tuple of Share
        A row for each source.
    total : Share
        The quantity itself at its peak.
    superposed : bool
        Whether the shares add up to the total; with friction each is the effect of leaving out its source.
    solution : Solution

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> shares = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(360).shares("O")
    >>> shares
    <Shares of O: peak 286596 N of 4 sources>
    >>> print(f"{shares['inertia of coupler'].value / shares.total.value:.0%} of it by the coupler's inertia")
    19% of it by the coupler's inertia
    """

    quantity: str
    unit: str
    label: str
    rows: tuple[Share, ...]
    total: Share
    superposed: bool
    solution: Any = field(repr=False)

    def __getitem__(self, source):
        """`Share` of a source by its name."""
        found = {row.source: row for row in (*self.rows, self.total)}
        problem = checks.choice("source", source, tuple(found))
        if problem:
            raise QuantityError(f"shares of {self.quantity}: {problem}")
        return found[source]

    @property
    def rest(self):
        """Total less the sum of all rows, N or N m: rounding without friction."""
        return self.total.value - sum(row.value for row in self.rows)

    @property
    def heading(self):
        """Heading of the values: "share", or with friction "effect of leaving out"."""
        return "share" if self.superposed else "effect of leaving out"

    @property
    def note(self):
        """Sentence on rows that do not add up to the total; "" if they do."""
        if not self.superposed:
            cause = "friction" if self.solution.friction.acting else "thrust of teeth"
            why = f"{cause} is not linear: each row is the force of the whole machine less that without its source"
        elif abs(self.rest) > WARNING_ERROR * max(abs(row.peak) for row in (*self.rows, self.total)):
            why = "a group of your own is not linear in masses and loads"
        else:
            return ""
        added = self.total.value - self.rest
        return f"{why}; the rows add up to {number(added)} of {number(self.total.value)} {self.unit}"

    def frame(self):
        """A row for each source and the total, a pandas DataFrame.

        Columns: share at the peak of the total (with friction the effect of leaving out), in the unit and in percent of
        the total. Then peak of the source alone with its crank angle, and its root mean square. `attrs` holds the
        `note`.
        """
        import pandas as pd

        rows = (*self.rows, self.total)
        value, peak, angle, rms = np.array([row[1:] for row in rows]).T
        columns = {
            f"{self.heading} [{self.unit}]": value,
            "of total [%]": 100.0 * value / self.total.value,
            f"peak [{self.unit}]": peak,
            "peak at [deg]": np.degrees(zeroed(angle, PLACED)),
            f"rms [{self.unit}]": rms,
        }
        index = pd.Index([row.source for row in rows], name="source")
        table = with_resolution(pd.DataFrame(columns, index), self.solution)
        if self.note:
            table.attrs["note"] = self.note
        return table

    def __str__(self):
        heads = ("source", f"{self.heading} [{self.unit}]", f"peak [{self.unit}]", "at [deg]", f"rms [{self.unit}]")
        lines = [heads]
        for row in (*self.rows, self.total):
            numbers = (number(row.value), number(row.peak), angle_text(np.degrees(row.angle)), number(row.rms))
            lines.append((row.source, *numbers))
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        rest = widths[1:]
        texts = ["  ".join([name.ljust(widths[0]), *map(str.rjust, others, rest)]) for name, *others in lines]
        return "\n".join(filter(None, [*map(str.rstrip, texts), self.note]))

    def __repr__(self):
        return f"<Shares of {self.quantity}: peak {number(self.total.value)} {self.unit} of {len(self.rows)} sources>"


def shares(solution, name) -> Shares:
    """Shares of the sources of one quantity; see `Solution.shares`."""
    name, quantity = _linear_quantity(solution, name)
    turn = closed_turn(solution, "shares")
    engine = NUMPY if getattr(solution.engine, "compiled", False) else solution.engine
    whole = replace(solution, engine=engine, friction=turn.at.friction)
    superposed = not has_sign_changes(solution)
    find, other_machines = (_alone, sources_alone) if superposed else (_left_out, machines_without)
    others = other_machines(whole)
    if not solution.mechanism.trusted:
        _require_massless_links(others, name)
    parts = [Part(TOTAL, partial(components, name=name), *_peak(whole, name))]
    parts += [find(whole, name, source, other) for source, other in others.items()]
    _require_finite(solution, name, parts)
    total = parts[0]
    if total.peak == 0.0:
        raise ParameterError(f"shares: {name} is 0 all over the period, so no source has a share in it")
    at = whole.moved_to(turn.clear(np.array([0.0 if np.isnan(total.angle) else total.angle])))
    values = np.array([part.read(at) for part in parts])[..., 0]  # (parts, 1 or 2)
    along = values[0] / np.hypot(*values[0]) if quantity.vector else np.ones(1)
    noise = FLOOR * max(abs(part.peak) for part in parts)
    numbers = zeroed([values @ along, [part.peak for part in parts], _root_mean_squares(turn, whole, parts)], noise)
    rows = [
        Share(part.source, float(value), float(peak), part.angle if peak else np.nan, float(rms))
        for part, (value, peak, rms) in zip(parts, numbers.T, strict=True)
    ]
    return Shares(name, quantity.unit, quantity.label, tuple(rows[1:]), rows[0], superposed, solution)


def _linear_quantity(solution, name) -> tuple[str, Quantity]:
    """Name without bars of a force or moment that is linear in masses and loads, and the quantity."""
    checks.require("shares", checks.quantity(name))
    known = of_scene(solution)
    linear = [key for key, found in known.items() if found.kind in KINDS or key in LINEAR_ENERGIES]
    bare = without_bars(solution, name)
    if known[bare].kind == GROUND:
        raise QuantityError(
            f"shares: {bare} is a force on the frame, at places that a machine with one source alone may lack. Use "
            f"shares of its reactions or shaking force: {', '.join(linear)}"
        )
    if bare not in linear:
        raise QuantityError(
            f"shares: {bare} is not linear in masses and loads; forces and moments are, which are {', '.join(linear)}"
        )
    return bare, known[bare]


# Machines with one source, or without it


def sources_alone(solution):
    """By source: the machine with this source alone, all other masses and loads zero; without friction."""
    weightless = solution.mechanism
    for name, link in weightless.links.items():
        weightless = weightless.with_link(name, link.without_mass())
    heavy = {name: link for name, link in solution.mechanism.links.items() if _has_inertia(link)}
    found: dict[str, tuple[Any, tuple[Any, ...]]]
    found = {f"inertia of {name}": (weightless.with_link(name, link), ()) for name, link in heavy.items()}
    found |= {f"weight of {name}": (weightless, (weight,)) for name, weight in _weights(solution).items()}
    gravity = tuple(item for item in solution.loads if isinstance(item, Gravity))
    for title, item in _titled_loads(solution):  # the weight of a spring or shaft is its own
        found[title] = weightless, (item, *gravity) if loads_with_mass((item,)) else (item,)
    return {
        source: replace(solution, mechanism=mechanism, loads=loads, friction=NO_FRICTION, silent=True)
        for source, (mechanism, loads) in found.items()
    }


def machines_without(solution):
    """By source, friction of each joint among them: the machine without this source.

    A link without inertia keeps its weight as a force at its mass centre; one without weight is lifted there.
    """
    made, weights = solution.mechanism, _weights(solution)
    found: dict[str, dict[str, Any]] = {}
    for name, link in made.links.items():
        if _has_inertia(link):
            kept = (weights[name],) if name in weights else ()
            rest = made.with_link(name, link.without_mass())
            found[f"inertia of {name}"] = {"mechanism": rest, "loads": (*solution.loads, *kept)}
    for name, weight in weights.items():
        found[f"weight of {name}"] = {"loads": (*solution.loads, replace(weight, value=-weight.value))}
    for title, item in _titled_loads(solution):
        place = next(place for place, other in enumerate(solution.loads) if other is item)  # one of several alike
        found[title] = {"loads": (*solution.loads[:place], *solution.loads[place + 1 :])}
    for joint in solution.friction.acting:
        rest = {name: pair for name, pair in solution.friction.items() if name != joint}
        found[f"friction {joint}"] = {"friction": frictions_by_joint(rest)}
    return {source: _with_friction_solved(replace(solution, silent=True, **parts)) for source, parts in found.items()}


def _has_inertia(link):
    return np.any(link.mass) or np.any(link.inertia)


def _weights(solution):
    """Weight of each link with mass as a force at its mass centre, by link."""
    gravity = solution.dynamics.gravity
    if gravity is None:
        return {}
    size, direction = np.hypot(*gravity), float(np.arctan2(gravity[1], gravity[0]))
    return {
        name: Force(float(link.mass * size), at=(name, *link.centre), direction=direction)
        for name, link in solution.mechanism.links.items()
        if np.any(link.mass)
    }


def _titled_loads(solution):
    """Titles and loads, without weight."""
    loads = [item for item in solution.loads if not isinstance(item, Gravity)]
    return list(zip(numbered_titles(loads), loads, strict=True))


def _require_massless_links(machines, name):
    """Refuse groups of the user's own that cannot resolve a link without mass, whose force is None."""
    for source, machine in machines.items():
        try:
            components(machine.moved_to(np.zeros(1)), name)
        except (TypeError, AttributeError) as error:
            raise ParameterError(
                f"shares: a group of your own fails if only {source} acts ({error}). A zero is passed to "
                "its resolve as None; add it by the functions of kinetostatics.numbers.planar"
            ) from error


def _with_friction_solved(solution):
    """The solution with enough passes over its friction; an error where it jams."""
    solved = solution.at(np.linspace(0.0, solution.period, FRICTION_ANGLES, endpoint=False))
    jamming.require_free(solved, "shares")
    return solved


# Values, peaks and means


class Part(NamedTuple):
    """A source, the function that reads its components from the whole machine at crank angles, and its peak."""

    source: str
    read: Callable[[Any], Any]
    peak: float
    angle: float


def _alone(whole, name, source, other):
    """`Part` of a source by the machine with this source alone."""
    return Part(source, lambda at: components(other.moved_to(at.crank_angle), name), *_peak(other, name))


def _left_out(whole, name, source, other):
    """`Part` of a source by the machine without it."""

    def effect(at):
        return np.subtract(components(at, name), components(other.moved_to(at.crank_angle), name))

    def size(at):
        found = effect(at)
        return found[0] if len(found) == 1 else magnitude(found)

    return Part(source, effect, *_peak(whole, size))


def _peak(solution, quantity):
    """Value of largest magnitude over the period, and its crank angle, rad; of equal values the first."""
    found = extrema(solution, quantity, pulsed=False)
    if not len(found):
        return float(found.constant), np.nan
    size = np.abs(found.value)
    place = int(np.argmax(size >= (1.0 - FLOOR) * size.max()))
    return float(found.value[place]), float(found.angle[place])


def _require_finite(solution, name, parts):
    """Refuse a force that grows without bound, or without any value."""
    for part in parts:
        if not np.isfinite(part.peak):
            of = name if part.source == TOTAL else f"{name} by {part.source}"
            raise ParameterError(
                f"shares: {solution.mechanism.name}: {of} grows without bound at crank angle "
                f"{np.degrees(part.angle):.6g} deg, so it has no peak"
            )


def _root_mean_squares(turn, whole, parts):
    """Root mean square of each part over the crank angle, (parts,)."""

    def squares(angle):
        at = whole.moved_to(turn.clear(angle))
        return np.array([np.square(part.read(at)).sum(axis=0) for part in parts])

    largest = np.array([part.peak**2 for part in parts])
    floor = TERM_ROUNDING * np.sqrt(largest * largest.max())
    found, errors, *_ = means(squares, turn, floor)
    if np.any(errors > WARNING_ERROR * largest + floor):
        text = "shares: root mean squares have fewer than nine correct digits, so uneven are the loads"
        warnings.warn(text, ConditionWarning, stacklevel=4)
    return np.sqrt(found)
