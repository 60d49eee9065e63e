"""Parts by name, from [sizing] of a case file, and their numbers for sweeps, tolerance studies and searches."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from ..cycle.reductions import SolutionNumber
from ..design.constraints import parse_constraint
from ..machine.cams.profile import POSITIVE
from ..numbers import checks
from ..numbers.units import to_si
from ..solution.scene import Scene
from ..solution.sections import Bar
from . import bearings, foundation, play, scene_springs, sections, springs

BAR = tuple(inspect.signature(Bar).parameters)
"""Options that describe the bar of a link."""
NOT_OPTIONS, OF_THE_SCENE = ("solution", "bar", "options"), ("stiffness", "travel", "crank_speed")
"""Arguments that are no options of a part; those of a spring that follow from its scene."""
LIST_LENGTH = 3
"""Largest number of values of an option: x, y, rotation."""


def _bar_strength(solution, *, link, **options):
    bar = Bar(**{name: options.pop(name) for name in BAR if name in options})
    return sections.bar_strength(solution, link, bar, **options)


def _spring(solution, *, spring="spring", **options):
    return scene_springs.spring_for(Scene.of(solution), spring, **options)


class Kind(NamedTuple):
    """A kind of part: function of a solution, class of its result, units and rules of numbers, sources of options."""

    size: Callable
    result: Any
    numbers: Mapping[str, tuple[Any, Mapping[str, Any]]]
    sources: tuple[Callable, ...] = ()

    @property
    def options(self):
        """Name of each option, and whether it is required."""
        return {
            name: item.default is item.empty
            for source in (self.size, *self.sources)
            for name, item in inspect.signature(source).parameters.items()
            if name not in NOT_OPTIONS and (self.size is not _spring or name not in OF_THE_SCENE)
        }


BEARINGS, SECTIONS, FOUNDATION = bearings.NUMBERS, sections.NUMBERS, foundation.NUMBERS
MOUNT = FOUNDATION | {"stiffness": (("N/m", "N/m", "N m/rad"), POSITIVE), "centre": (("m", "m"), {})}
BARS = SECTIONS | {"masses": (("m", "kg"), {"low": 0.0})}
KINDS = {
    "bearing": Kind(bearings.bearing, bearings.Bearing, BEARINGS),
    "plain bearing": Kind(bearings.plain_bearing, bearings.PlainBearing, BEARINGS),
    "bar": Kind(_bar_strength, sections.BarStrength, BARS, (sections.bar_strength, Bar)),
    "pin": Kind(sections.pin_strength, sections.PinStrength, SECTIONS),
    "play": Kind(play.contact_loss, play.ContactLoss, play.NUMBERS),
    "spring": Kind(_spring, scene_springs.BalancingSpring, springs.NUMBERS, (springs.helical_spring,)),
    "mount": Kind(foundation.mount, foundation.Mount, MOUNT),
    "block": Kind(foundation.block_for, foundation.Mount, FOUNDATION),
}
"""Kinds of parts by name."""


@dataclass(frozen=True)
class Part:
    """A named part of a machine to be sized.

    Parameters
    ----------
    name : str
    kind : str
        "bearing", "plain bearing", "bar", "pin", "play", "spring", "mount" or "block".
    options : mapping
        Arguments of the `sizing` function of its kind; for a bar also those of `Bar`.
    raw : mapping, optional
        Its table in a case file.

    Raises
    ------
    ParameterError
        The kind is unknown, or an option is unknown or missing.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5)
    >>> pin = ks.sizing.Part("pin_B", "pin", {"joint": "B", "diameter": 0.08, "width": 0.1})
    >>> designs = ks.designs.grid({"slider.mass": "400..600 kg:2"})
    >>> table = ks.sweep(saw, designs, [pin.number("shear_stress")], progress=False)
    >>> (table["pin_B.shear_stress [Pa]"] / 1e6).round(1).tolist()
    [15.4, 23.1]
    """

    name: str
    kind: str
    options: Mapping[str, Any]
    raw: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self):
        checks.require(f"part {self.name!r}", *self.problems(self.kind, self.options))

    @staticmethod
    def problems(kind, options):
        """Sentences on a wrong kind, and on options that are unknown or missing."""
        problem = checks.choice("kind", kind, tuple(KINDS))
        if problem is None and not isinstance(options, Mapping):
            problem = f'options must be a dict, as {{"joint": "B"}}, got {checks.shown(options)}'
        if problem:
            return [problem]
        known = KINDS[kind].options
        wrong = [checks.choice("option", name, tuple(known)) for name in options]
        missing = [f"{name} is missing" for name, needed in known.items() if needed and name not in options]
        return [*filter(None, wrong), *missing]

    def of(self, solution):
        """Result of sizing the part from a solution, a `Sized`."""
        return KINDS[self.kind].size(solution, **self.options)

    @property
    def rows(self):
        """Row of each number of the result by name: unit, meaning, formula."""
        return KINDS[self.kind].result.ROWS

    def number(self, number, ratio=False):
        """A number of the result, such as "life_hours", as an output of `sweep`, `tolerances` and `design.optimise`."""
        rows = self.rows
        checks.require(self.name, checks.choice("number", number, tuple(rows)))
        return SolutionNumber(f"{self.name}.{number}", partial(_number, self, number), rows[number].unit, ratio)

    def limit(self, text):
        """A limit for `design.optimise` from a text such as "life_hours >= 20000 h"."""
        return parse_constraint(f"{self.name}.{text}", None, {self.name: self})


def _number(part, number, solution):
    return getattr(part.of(solution), number)


def read_part(name, raw):
    """Part of a table of a case file, and the faults of the table: sentences after their keys.

    Numbers are texts with units, as in all case files.
    """
    options = dict(raw)
    kind, problems = options.pop("kind", None), []
    if not isinstance(kind, str) or kind not in KINDS:
        missing = f"is missing; allowed: {', '.join(map(repr, KINDS))}"
        return None, [f".kind {missing}" if kind is None else f".{checks.choice('kind', kind, tuple(KINDS))}"]
    for key, value in options.items():
        try:
            if key in KINDS[kind].numbers:
                options[key] = _in_si(key, value, *KINDS[kind].numbers[key])
        except ValueError as error:
            problems.append(f".{key} {error}")
    problems += [f": {problem}" for problem in Part.problems(kind, options)]
    return (None if problems else Part(name, kind, options, raw)), problems


def _in_si(key, value, unit, rule):
    """Value of an option in SI; several units are those of the numbers in a list, or in each inner list."""
    units = unit if isinstance(unit, tuple) else (unit,)
    if isinstance(value, list) and any(isinstance(part, list) for part in value):
        return [_in_si(key, part, unit, rule) for part in value]
    if isinstance(value, list):
        most = len(units) if len(units) > 1 else LIST_LENGTH
        if len(value) > most:
            raise ValueError(f"must have at most {most} numbers, found {len(value)}")
        return [_in_si(key, part, units[at % len(units)], rule) for at, part in enumerate(value)]
    if units[0] != "1":
        if not isinstance(value, str):
            raise ValueError(f'must be a text with a unit, such as "1 {units[0]}", found {value!r}')
        value = to_si(value, units[0])
    _, problem = checks.single_number(key, value, units[0], **rule)
    if problem:
        raise ValueError(problem.removeprefix(f"{key} "))
    return value
