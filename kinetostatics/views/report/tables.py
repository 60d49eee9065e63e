"""Tables of a report: frames as text, units readable, published figures beside ours, bars for shares."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...errors import CaseError
from ...numbers import checks, formatting
from ...numbers.formatting import angle, digits_of, pretty

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
