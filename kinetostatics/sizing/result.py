"""Base of all results of sizing: numbers with unit, meaning and formula, notes, and a table."""

import warnings
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from ..errors import HintWarning
from ..numbers import formatting
from ..numbers.output_units import output_units


class Row(NamedTuple):
    """Description of a number of a result.

    Attributes
    ----------
    unit : str
        SI, except hours for life.
    meaning : str
    formula : str
        Formula with its source: author, year or textbook.
    """

    unit: str
    meaning: str
    formula: str


@dataclass(frozen=True, eq=False, repr=False)
class Sized:
    """Base of the results of `sizing`: numbers by name, and notes.

    A subclass lists its numbers in `ROWS`; each is a field or property. `notes` are sentences on points to check;
    the function that returns the result also warns of them.

    Attributes
    ----------
    notes : tuple of str

    Examples
    --------
    Functions of `sizing` return it.

    >>> import kinetostatics as ks
    >>> from kinetostatics.sizing.result import Row
    >>> class Couple(ks.sizing.Sized):
    ...     ROWS = {"arm": Row("m", "distance of two forces", "measured")}
    ...     arm = 0.25
    >>> Couple(notes=("the arm is short",))
    <Couple: arm 0.25 m; the arm is short>
    """

    ROWS: ClassVar[dict[str, Row]] = {}
    notes: tuple[str, ...]

    def __repr__(self):
        numbers = (
            f"{name} {formatting.number(float(getattr(self, name)), 5)} {unit}".removesuffix(" 1")
            for name, (unit, *_) in self.ROWS.items()
        )
        return f"<{type(self).__name__}: {', '.join(numbers)}{''.join(f'; {note}' for note in self.notes)}>"

    def table(self, units=None):
        """Value, unit, meaning and formula of each number, a pandas DataFrame; notes in ``attrs["notes"]``.

        `units` is a dict of dimension to unit as of `in_units`.
        """
        import pandas as pd

        rows = [(name, float(getattr(self, name)), *row) for name, row in self.ROWS.items()]
        found = pd.DataFrame(rows, columns=["number", "value", *Row._fields]).set_index("number")
        found.attrs["notes"] = list(self.notes)
        return output_units(units, "table").table(found)


def warn_of_notes(owner, result, stacklevel=3):
    """The result, after a `HintWarning` for each of its notes."""
    for note in result.notes:
        warnings.warn(HintWarning(owner, note), stacklevel=stacklevel)
    return result
