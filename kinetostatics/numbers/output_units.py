"""Units of output: a unit for each dimension, chosen by the user, and tables in these units.

The library computes in SI; tables, figures and reports convert here. Factors come from the table of usual units;
pint converts others.
"""

from collections.abc import Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cache

from . import checks
from .formatting import heading, number, parse_heading
from .units import base_dimensions, base_factor, factor, quoted

DIMENSIONS = {
    "length": ("m", "mm"),
    "angle": ("rad", "deg"),
    "time": ("s", "ms"),
    "speed": ("m/s", "mm/s"),
    "acceleration": ("m/s2", "mm/s2"),
    "angular speed": ("rad/s", "rpm"),
    "angular acceleration": ("rad/s2", "deg/s2"),
    "mass": ("kg", "t"),
    "inertia": ("kg m2", "kg cm2"),
    "force": ("N", "kN"),
    "torque": ("N m", "kN m"),
    "stiffness": ("N/m", "N/mm"),
    "pressure": ("Pa", "MPa"),
    "energy": ("J", "kJ"),
    "power": ("W", "kW"),
}
"""SI unit of each dimension, and another one as an example."""
_NAMES = {base_dimensions(unit): name for name, (unit, _) in DIMENSIONS.items() if name != "energy"}
RATIOS = ("ratio",)
"""Columns that have no unit, though the table has a column `unit`."""


@cache
def dimension_name(unit):
    """Dimension of a unit, one of `DIMENSIONS`, or None; of a torque's dimension, J and Wh measure energy."""
    try:
        name = _NAMES.get(base_dimensions(unit))
    except ValueError:  # words in brackets are no unit
        return None
    return "energy" if name == "torque" and ("J" in unit or "W" in unit) else name


@dataclass(frozen=True)
class OutputUnits:
    """Units by dimension; every other unit stays as it is."""

    chosen: Mapping[str, str] = field(default_factory=dict)

    def of(self, unit):
        """Factor from a unit to the one chosen for its dimension, and the chosen one; 1.0 and the unit without."""
        wanted = self.chosen.get(dimension_name(unit), unit) if self.chosen else unit
        return (1.0, unit) if wanted == unit else (base_factor(unit) / base_factor(wanted), wanted)

    def text(self, value, unit):
        """A number with its unit."""
        factor, shown = self.of(unit)
        return f"{number(factor * value)} {shown}"

    def numbers(self, by_heading):
        """Numbers by headings with units, "mean power [W]"."""
        found = {}
        for text, value in by_heading.items():
            name, unit = parse_heading(text)
            factor, shown = self.of(unit)
            found[heading(name, shown) if unit else text] = factor * value
        return found

    def table(self, frame, kept=()):
        """A pandas DataFrame in these units: by the units in its headings, and in its column `unit`.

        Numbers in columns without a unit in the heading have the unit of their row, except ratios. Rows whose names are
        in `kept` keep their unit.
        """
        if not self.chosen:
            return frame
        found, headings, of_rows = frame.copy(), list(frame.columns), []
        for at, column in enumerate(frame.columns):
            name, unit = parse_heading(column)
            if frame.dtypes.iloc[at].kind not in "fi":
                continue
            if unit:
                scale, shown = self.of(unit)
                headings[at] = column if shown == unit else heading(name, shown)
                found.isetitem(at, frame.iloc[:, at] * scale)
            elif name not in RATIOS:
                of_rows.append(at)
        if "unit" in headings and of_rows:
            of_units = [(1.0, unit) if name in kept else self.of(unit) for name, unit in frame["unit"].items()]
            for at in of_rows:
                found.isetitem(at, frame.iloc[:, at] * [factor for factor, _ in of_units])
            found = found.assign(unit=[unit for _, unit in of_units])
        return found.set_axis(headings, axis=1)


SI = OutputUnits()
_shown = ContextVar("units of figures and reports", default=SI)


def shown_units():
    """`OutputUnits` of the figures and reports that are made now."""
    return _shown.get()


@contextmanager
def shown_in(units):
    """Make figures and reports in other units; None keeps those of the outer block."""
    before = _shown.set(shown_units() if units is None else output_units(units))
    try:
        yield
    finally:
        _shown.reset(before)


def output_units(units, owner="units"):
    """`OutputUnits` of a user's mapping of dimension to unit; None is SI.

    `ParameterError` for an unknown dimension, or a unit that does not measure it.
    """
    if units is None or isinstance(units, OutputUnits):
        return units or SI
    example = 'units must be a dict of dimension to unit, as {"force": "kN", "length": "mm"}'
    checks.require(owner, None if isinstance(units, Mapping) else f"{example}, got {checks.shown(units)}")
    checks.require(owner, *(_unit_problem(name, unit) for name, unit in units.items()))
    return OutputUnits(dict(units))


def _unit_problem(name, unit):
    """Sentence on a dimension or unit that cannot be used, or None."""
    if problem := checks.choice("dimension", name, tuple(DIMENSIONS)):
        meant = dimension_name(name) if isinstance(name, str) else None
        return f"{problem}; {name} measures {meant}" if meant else problem
    si, example = DIMENSIONS[name]
    try:
        if not isinstance(unit, str):
            raise ValueError(f"a unit is a text, found {quoted(unit)}")
        factor(unit, si)
    except ValueError as error:
        return f'{name}: {error}, such as "{example}"'
    return None


def in_units(table, units):
    """A table in other units: by the units in its headings, and in its column "unit" if it has one.

    Parameters
    ----------
    table : pandas.DataFrame
        As the library returns them: of `sweep`, ``s.losses.frame()``, ``s.ground.table()`` ...
    units : dict of dimension to unit
        Dimensions are "length", "angle", "time", "speed", "acceleration", "angular speed", "angular acceleration",
        "mass", "inertia", "force", "torque", "stiffness", "pressure", "energy" and "power"; a unit is a text, "kN".

    Returns
    -------
    pandas.DataFrame
        A new one. Other units stay unchanged.

    Raises
    ------
    ParameterError
        An unknown dimension, or a unit that does not measure it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
    >>> designs = ks.designs.grid({"crank_length": "0.2..0.3 m:2"})
    >>> table = ks.sweep(saw, designs, ["largest O"], angles=90, progress=False)
    >>> list(ks.in_units(table, {"length": "mm", "force": "kN"}))
    ['crank_length [mm]', 'largest O [kN]', 'failed']
    """
    problem = None if hasattr(table, "isetitem") else f"table must be a pandas DataFrame, got {checks.shown(table)}"
    checks.require("in_units", problem)
    return output_units(units, "in_units").table(table)
