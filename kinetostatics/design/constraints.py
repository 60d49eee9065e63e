"""What is asked of a design: an output to be made least or greatest, and limits of others, read from texts."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace

from ..errors import ParameterError
from ..machine.loads import Table, value_of
from ..numbers import checks
from ..numbers.units import NUMBER, to_si
from ..results.reductions import Output, parsed

_FORM = re.compile(r"(?P<output>[^<>=≤≥]*?)\s*(?P<relation><=|>=|==?|≤|≥)\s*(?P<value>[^<>=≤≥]*)")
_RELATIONS = {"≤": "<=", "≥": ">=", "==": "="}


@dataclass(frozen=True)
class Constraint:
    """An output and what it must be.

    Attributes
    ----------
    output : Output
    relation : "<=", ">=" or "="
    value : float
        SI.
    span : float, optional
        Of a limit that a table over travel sets, the length of the table, m, by which its misses are counted.
    """

    output: Output
    relation: str
    value: float
    span: float | None = None

    @property
    def scale(self):
        """Size by which misses of the limit are counted."""
        return self.span or abs(self.value) or 1.0

    def __str__(self):
        unit = self.output.unit if not self.output.ratio and self.output.unit != "1" else ""
        return f"{self.output} {self.relation} {self.value:.9g} {unit}".strip()


def parse_constraint(text, known) -> Constraint:
    """Demand from a text such as "largest O <= 0.75 kN" or "ratio mean_absolute balancing_torque >= 50".

    `known` is the scene, or what has a mechanism, that the output is of.

    Raises
    ------
    ParameterError
        The text has another form; the output or its unit is not known.
    """
    found = _FORM.fullmatch(text.strip()) if isinstance(text, str) else None
    if found is None or not found["value"]:
        raise ParameterError(
            f'limit {text!r} must be an output, a relation and a value, such as "largest O <= 0.75 kN" or "largest '
            'slider_position = 2.3 m"'
        )
    output = parse_output(found["output"], known)
    plain = output.ratio or output.unit == "1"
    try:
        number = re.fullmatch(NUMBER, found["value"].strip()) if plain else None
        value = float(found["value"]) if number else to_si(found["value"], "1" if plain else output.unit)
    except ValueError as error:
        raise ParameterError(f"limit {text!r}: {error}") from None
    return Constraint(output, _RELATIONS.get(found["relation"], found["relation"]), value)


def parse_output(text, known) -> Output:
    """Output of a design, with its unit; refused if nothing tells how it changes with the numbers.

    Raises
    ------
    ParameterError
        The text names no reduction and quantity, or the place of an extreme, which jumps.
    """
    output = parsed(text).of(known)
    if output.reduction.endswith("_at"):
        raise ParameterError(f"output {str(output)!r} is a place, which jumps; design by the value there")
    return output if output.unit else replace(output, unit="1")


def parse_constraints(texts, known):
    """Limits from their texts; all that is wrong with them in one error."""
    if not isinstance(texts, str | Iterable):
        raise ParameterError(
            f'design: limits must be texts, such as ["largest O <= 0.75 kN"], got {checks.shown(texts)}'
        )
    found, problems = [], []
    for text in (texts,) if isinstance(texts, str) else texts:
        try:
            found.append(text if isinstance(text, Constraint) else parse_constraint(text, known))
        except ParameterError as error:
            problems.append(str(error))
    checks.require("design", *problems)
    return tuple(found)


def table_limits(scene):
    """Limits that keep each slider within the tables over travel that loads read by it."""
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
