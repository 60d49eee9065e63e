"""Constraints of a design: limits of outputs, parsed from texts, and limits by load tables over travel."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from ..cycle.reductions import Output, SolutionNumber, parsed
from ..errors import ParameterError, QuantityError
from ..machine.loads import Table, value_of
from ..numbers import checks
from ..numbers.units import NUMBER, base_factor, to_si

_FORM = re.compile(r"(?P<output>[^<>=≤≥]*?)\s*(?P<relation><=|>=|==?|≤|≥)\s*(?P<value>[^<>=≤≥]*)")
MEAN = "mean"
"""Name of the mean of all duties in limits."""
_RELATIONS = {"≤": "<=", "≥": ">=", "==": "="}


def _is_plain(unit):
    """Whether outputs in a unit are compared with plain numbers: it is 1, or a unit without texts."""
    try:
        return unit == "1" or not base_factor(unit)
    except ValueError:
        return True


@dataclass(frozen=True)
class Constraint:
    """A limit of an output.

    Attributes
    ----------
    output : Output or SolutionNumber
    relation : "<=", ">=" or "="
    value : float
        SI.
    span : float, optional
        Length, m, of the table over travel that sets the limit; the unit of its excess.
    duty : str
        Duty in which it holds, or "mean"; empty: in each.
    """

    output: Output | SolutionNumber
    relation: str
    value: float
    span: float | None = None
    duty: str = ""

    @property
    def scale(self):
        """Size that makes excesses relative."""
        return self.span or abs(self.value) or 1.0

    @property
    def place(self):
        """The output with its duty."""
        return f"{self.duty}: {self.output}" if self.duty else str(self.output)

    def __str__(self):
        unit = self.output.unit if not self.output.ratio and not _is_plain(self.output.unit) else ""
        return f"{self.place} {self.relation} {self.value:.9g} {unit}".strip()


def parse_constraint(text, known, parts=None) -> Constraint:
    """Constraint from a text such as "largest O <= 0.75 kN" or "ratio mean_absolute balancing_torque >= 50".

    `known` is the scene, or another object with a mechanism. Raises `ParameterError` for any other text.
    """
    found = _FORM.fullmatch(text.strip()) if isinstance(text, str) else None
    if found is None or not found["value"]:
        raise ParameterError(
            f'limit {text!r} must be an output, a relation and a value, such as "largest O <= 0.75 kN" or "largest '
            'slider_position = 2.3 m"'
        )
    output = parse_output(found["output"], known, parts)
    plain = output.ratio or _is_plain(output.unit)
    try:
        number = re.fullmatch(NUMBER, found["value"].strip()) if plain else None
        unit = "1" if plain else output.unit
        value = float(found["value"]) if number else to_si(found["value"], unit) / base_factor(unit)  # hours stay hours
    except ValueError as error:
        raise ParameterError(f"limit {text!r}: {error}") from None
    return Constraint(output, _RELATIONS.get(found["relation"], found["relation"]), value)


def parse_output(text, known, parts=None) -> Output | SolutionNumber:
    """Output of a design, with its unit; an error if it is unknown, or the angle of an extreme, which jumps."""
    output = parsed(text, parts).of(known)
    if isinstance(output, SolutionNumber):
        return output
    if output.reduction.endswith("_at"):
        raise ParameterError(f"output {str(output)!r} is a place, which jumps; design by the value there")
    return output if output.unit else replace(output, unit="1")


def limit_list(texts):
    """Limits as a tuple; a single one may be given."""
    if not isinstance(texts, str | Iterable):
        raise ParameterError(
            f'design: limits must be texts, such as ["largest O <= 0.75 kN"], got {checks.shown(texts)}'
        )
    return (texts,) if isinstance(texts, str) else tuple(texts)


def parse_constraints(texts, known, parts=None):
    """Constraints from texts; one error lists all faults."""
    found, problems = [], []
    for text in limit_list(texts):
        try:
            found.append(text if isinstance(text, Constraint) else parse_constraint(text, known, parts))
        except (ParameterError, QuantityError) as error:
            problems.append(str(error))
    checks.require("design", *problems)
    return tuple(found)


def table_limits(scene):
    """Limits that keep each slider within its load tables over travel."""
    found = {}
    for table in map(value_of, scene.loads):
        if isinstance(table, Table) and table.over == "travel":
            position, span = (
                f"{table.slider or next(iter(scene.mechanism.guides))}_position",
                float(table.x[-1] - table.x[0]),
            )
            for reduction, relation, end in (("smallest", ">=", table.x[0]), ("largest", "<=", table.x[-1])):
                limit = Constraint(parse_output(f"{reduction} {position}", scene), relation, float(end), span)
                found[str(limit)] = limit
    return tuple(found.values())
