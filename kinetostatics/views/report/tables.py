"""Tables of a report: frames as text, units readable, published figures beside ours, bars for shares.

Every quantity at every angle that the reader can choose, with its unit and as many digits as are known.
"""

import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...errors import CaseError
from ...mechanics.quantities import components, of_scene, scale, still
from ...numbers import checks, formatting
from ...numbers.formatting import angle, digits_of, pretty
from ...results.rounding import FLOOR, zeroed
from ..canvas import display, in_sight, ordinary
from .movement import packed

number = partial(formatting.number, infinity="∞")
"""A number as text, as all tables of the report show it."""


@dataclass(frozen=True)
class Table:
    """A table as text.

    Attributes
    ----------
    caption : str
    columns : list of str
    rows : list of list of str or (str, str)
        A pair is a text with another below it, smaller.
    words : int
        Columns from the left that hold words, not numbers.
    note : str
    code : bool
        Whether the first column holds names as in files.
    """

    caption: str
    columns: list[str]
    rows: list[list[Any]]
    words: int = 1
    note: str = ""
    code: bool = False


def of_frame(frame, caption, note=""):
    """Table of a frame whose index says what its rows are, and whose column `unit`, if any, their units."""
    columns = [str(name) for name in frame.columns]
    rows = []
    for name, values in zip(frame.index, frame.itertuples(index=False), strict=True):
        digits = [digits_of(str(name), column) for column in columns]
        cells = [
            pretty(value) if column == "unit" else angle(value) if column.endswith("[deg]") else number(value, most)
            for column, value, most in zip(columns, values, digits, strict=True)
        ]
        rows.append([str(name), *cells])
    words = 2 if columns[:1] == ["unit"] else 1
    return Table(caption, [frame.index.name or "", *columns], rows, words, note)


def with_published(frame, published, path, caption, note=""):
    """Table of a frame, the published figure behind ours in brackets where there is one."""
    require_places(frame, published, path)
    table = of_frame(frame, caption, note)
    places = {str(name): row for row, name in enumerate(frame.index)}
    columns = [str(name) for name in frame.columns]
    for quantity, entries in published.items():
        for column, printed in entries.items():
            row = table.rows[places[quantity]]
            place = 1 + columns.index(column)
            row[place] = f"{row[place]} ({printed})"
    return table


def require_places(frame, published, path):
    """Every published figure has a row and a column to stand in."""
    problems = [checks.choice("published: row", quantity, tuple(frame.index)) for quantity in published] + [
        checks.choice(f"published: column of {quantity!r}", column, tuple(frame.columns))
        for quantity, entries in published.items()
        if quantity in frame.index
        for column in entries
    ]
    if any(problems):
        raise CaseError(path, [problem for problem in problems if problem])


def times(ratio, bound=0.0):
    """How many times, in words; "" for NaN."""
    return "" if np.isnan(ratio) else f"{number(ratio, 4, bound)} ×"


READING_DIGITS = 6
"""Digits of the largest value that are shown, at most."""
KINDS = ("force", "reaction", "friction", "slider", "motion", "whole", "rate")
"""Kinds of quantities in the order in which they are listed."""


def readings(machines):
    """What the page needs of each quantity that any of the machines has, in the order of their kinds."""
    found: dict[str, dict] = {}
    for machine in machines.values():
        for name, quantity in of_scene(machine.solution).items():
            if quantity.kind in KINDS and name not in found and not _is_still(machine.solution, quantity):
                found[name] = {
                    "quantity": quantity,
                    "of": [_values(other, other.solution, name) for other in machines.values()],
                    "between": [_values(other, other.between, name) for other in machines.values()],
                }
    ordered = sorted(found.items(), key=lambda item: KINDS.index(item[1]["quantity"].kind))
    texts = {
        name: output.text for machine in machines.values() for name, output in machine.scene.mechanism.outputs.items()
    }
    return {name: _sent(text=texts.get(name, ""), **item) for name, item in ordered}


def _is_still(solution, quantity):
    return quantity.kind == "rate" and still(solution.placement.links[quantity.owner].ratio)


def _values(machine, solution, name):
    """Values over the angles of a solution, (1 or 2, N), or None of a machine that lacks the quantity."""
    if name not in of_scene(solution) or _is_still(machine.solution, of_scene(solution)[name]):
        return None
    shape, rounding = solution.crank_angle.shape, FLOOR * float(np.max(scale(machine.solution, name)))
    return zeroed(np.stack([np.broadcast_to(part, shape) for part in components(solution, name)]), rounding)


def _sent(quantity, of, between, text):
    arrays = [values for values in of if values is not None]
    sizes = [np.hypot(*values) if quantity.vector else values for values in arrays]
    factor, unit = display(quantity.unit, sizes)
    sight = in_sight(sizes)
    return {
        "label": quantity.label,
        "kind": quantity.kind,
        "text": text,
        "unit": pretty(unit),
        "factor": factor,
        "vector": quantity.vector,
        "sight": factor * sight if np.isfinite(sight) else None,
        "decimals": decimals(factor * ordinary(sizes)),
        "values": [None if values is None else packed(factor * values, "<f8") for values in of],
        "between": [None if values is None else packed(factor * values, "<f8") for values in between],
    }


def decimals(largest):
    """Decimals with which a value of this size has as many digits as are shown."""
    if not largest > 0:
        return 0
    return min(12, max(0, READING_DIGITS - 1 - math.floor(math.log10(largest))))
