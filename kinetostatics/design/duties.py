"""Duties: one machine in several scenes, each for a share of the time, such as a saw that idles and cuts.

Outputs are computed in each duty; the goal is their mean, weighted by the shares. A limit applies to every duty, or to
one duty: "cut: largest O <= 40 kN"; "mean: ..." limits the weighted mean.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..cycle.reductions import Output
from ..errors import ParameterError, QuantityError
from ..mechanics.quantities import of_scene
from ..numbers import checks
from .constraints import MEAN, Constraint, limit_list
from .problem import Problem, choose_design, compared_value, design_problem, scene_of

SHARE_TOLERANCE = 1e-9
"""Difference of the sum of shares from 1 that counts as rounding."""


class Duty(NamedTuple):
    """A duty: a Scene or variant, the reference of its ratios, its share of the time."""

    source: Any
    reference: Any
    share: float


def read_duties(source, variant, reference) -> dict[str, Duty]:
    """Duties by name of a dict of name to (scene, share); a case or scene is one duty of the name ""."""
    if not isinstance(source, Mapping):
        item, compared = choose_design(source, variant, reference)
        return {"": Duty(item, compared, 1.0)}
    problems = [None if variant is None else "variant is for cases; each duty has its scene"]
    problems += [None if source else "give at least one duty"]
    found: dict[str, Duty] = {}
    references = reference if isinstance(reference, Mapping) else dict.fromkeys(source, reference)
    problems += [checks.choice("duty of reference", name, tuple(source)) for name in references]
    for name, given in source.items():
        if not isinstance(name, str) or not name.strip() or ":" in name or name.strip() == MEAN:
            problems.append(f'a duty must have a name, not "{MEAN}" and without a colon, got {checks.shown(name)}')
        elif not isinstance(given, list | tuple) or len(given) != 2:
            problems.append(f"{name} must be a pair (scene, share), got {checks.shown(given)}")
        else:
            share, wrong = checks.single_number(f"share of {name}", given[1], "1", low=0.0, strict=True)
            compared = references.get(name)
            wrong_reference = compared is not None and design_problem(f"reference of {name}", compared, "a Scene")
            problems += [wrong, design_problem(name, given[0], "a Scene"), wrong_reference or None]
            found[name] = Duty(given[0], compared, share)
    checks.require("design", *problems)
    total = sum(duty.share for duty in found.values())
    parts = ", ".join(f"{name} {duty.share:g}" for name, duty in found.items())
    first, *others = found
    checks.require(
        "design",
        None if abs(total - 1.0) <= SHARE_TOLERANCE else f"the shares must sum to 1, got {total:.9g}: {parts}",
        *(
            f"the duties must be of one machine, but links or groups of {name}, a "
            f"{scene_of(found[name].source).mechanism.name}, differ from those of {first}"
            for name in others
            if _parts_of(found[name].source) != _parts_of(found[first].source)
        ),
    )
    return found


def mean_value(output, duties):
    """Mean of an output over duties, weighted by their shares; NaN where a machine lacks it."""
    return sum(duty.share * _value(output, duty) for duty in duties.values())


def _value(output, duty):
    scene = scene_of(duty.source)
    if isinstance(output, Output) and output.quantity not in of_scene(scene):
        return np.nan
    return compared_value(output, scene, duty.reference and scene_of(duty.reference))


def _parts_of(source):
    """Groups, links and joints of a machine, and the turns after which its motion repeats."""
    mechanism = scene_of(source).mechanism
    groups = [(type(group), getattr(group, "assembly", None)) for group in mechanism.groups]
    return groups, tuple(mechanism.links), tuple(mechanism.joints), mechanism.turns


def in_each(duties, function) -> dict:
    """Results by name of a function, called with the name and duty; one error lists all faults."""
    if "" in duties:
        return {"": function("", duties[""])}
    found: dict = {}
    faults: dict[str, list[str]] = {}
    for name, duty in duties.items():
        try:
            found[name] = function(name, duty)
        except (ParameterError, QuantityError) as error:
            faults.setdefault(str(error).removeprefix("design: "), []).append(name)
    checks.require("design", *(f"{', '.join(names)}: {text}" for text, names in faults.items()))
    return found


def limits_of(limits, names) -> dict[str, list]:
    """Limits by duty, and of the mean; a limit without duty applies to each."""
    found: dict[str, list] = {name: [] for name in (*names, MEAN)}
    problems = []
    for limit in limit_list(limits):
        own = getattr(limit, "duty", "")
        duty, colon, rest = limit.partition(":") if isinstance(limit, str) else (own, own, limit)
        if colon:
            problems.append(checks.choice(f"limit {str(limit)!r}: duty", duty.strip(), tuple(found)))
            found.get(duty.strip(), []).append(rest)
        else:
            for name in names:
                found[name].append(limit)
    checks.require("design", *problems)
    return found


class DutyProblem:
    """Problems of one machine in its duties, by name; outputs are means weighted by the shares of time.

    `quantities` are the quantities of each duty by name.
    """

    def __init__(self, duties, vary, quantities, angles, engine):
        def problem(name, duty):
            return Problem(duty.source, vary, quantities[name], duty.reference, angles, engine)

        self.parts: dict[str, Problem] = in_each(duties, problem)
        self.shares = {name: duty.share for name, duty in duties.items()}
        first = next(iter(self.parts.values()))
        self.names, self.low, self.high, self.angles = first.names, first.low, first.high, angles
        self.start, self.units, self.numbers = first.start, first.units, first.numbers
        self.stepped: Any = None
        starts = np.array([part.start for part in self.parts.values()])
        texts = [
            f"{path} is {', '.join(f'{value:.9g} in {name}' for name, value in zip(self.parts, row, strict=True))}"
            for path, row in zip(self.names, starts.T, strict=True)
            if np.ptp(row)
        ]
        checks.require("design", f"all duties need the same varied numbers, but {'; '.join(texts)}" if texts else None)

    @property
    def evaluations(self):
        return sum(part.evaluations for part in self.parts.values())

    @property
    def table_limits(self) -> tuple[Constraint, ...]:
        return tuple(replace(limit, duty=name) for name, part in self.parts.items() for limit in part.table_limits)

    @property
    def source(self):
        return {name: scene_of(part.source) for name, part in self.parts.items()}

    @property
    def reference(self):
        found = {name: part.reference and scene_of(part.reference) for name, part in self.parts.items()}
        return found if any(found.values()) else None

    def duty(self, name):
        """Problem of a duty; of "mean" this one."""
        return self if name == MEAN else self.parts[name]

    def scene(self, values):
        """Scenes of a design by duty."""
        return {name: part.scene(values) for name, part in self.parts.items()}

    def output(self, output, values):
        """Weighted mean of an output of a design, or a function of designs, and its derivatives."""
        if callable(output):
            return output(values)
        found = [part.output(output, values) for part in self.parts.values()]
        shares = np.array(list(self.shares.values()))
        return tuple(np.tensordot(shares, np.array(part), 1) for part in zip(*found, strict=True))
