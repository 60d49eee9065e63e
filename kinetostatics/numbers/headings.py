"""Headings of columns, a name with its unit in brackets: "slider.mass [kg]"."""

import re

from . import checks
from .texts import normal
from .units import factor

_HEADING = re.compile(r"([^\[\]]*)(?:\[([^\[\]]*)\])?")
_ROUND = re.compile(r"(.*?)\s*\(([^()]*)\)")
"""A heading with its unit in brackets that are not meant for it."""


def heading(name, unit):
    """Heading of a column."""
    return f"{name} [{unit}]"


def parted(text):
    """Name and unit of a heading; the unit is empty where there is none."""
    found = _HEADING.fullmatch(str(text).strip())
    return (found[1].strip(), (found[2] or "").strip()) if found else (str(text).strip(), "")


def tolerant(text):
    """Name and unit of a heading of a user's file, as the library writes them.

    Capital letters, blanks and hyphens in the name are no difference, and the unit may stand in round brackets:
    "Crank angle (deg)" heads crank_angle.
    """
    name, unit = parted(text)
    rounded = None if unit else _ROUND.fullmatch(name)
    name, unit = rounded.groups() if rounded else (name, unit)
    return "_".join(normal(name).lower().replace("-", " ").split()), unit.strip()


def si_columns(columns, known=None, unknown=None):
    """Name and factor to SI of each column of a table of designs, and what is wrong with them.

    Parameters
    ----------
    columns : sequence of str
        Names, with the unit in brackets ("spring.stiffness [kN/m]") or none for SI.
    known : mapping of name to SI unit, optional
        What there is to vary; any name and unit will do if not given.
    unknown : function, optional
        Says what is wrong with a name that is none of these.

    Returns
    -------
    columns : tuple of (column, name, factor)
    problems : list of str
    """
    found: dict[str, tuple[str, str, float]] = {}
    problems = []
    for column in columns:
        name, unit = parted(column)
        problem = None
        if known is not None and name not in known:
            problem = _in_round_brackets(name, known)
            problem = problem or (unknown(name) if unknown else checks.choice("parameter", name, tuple(known)))
        if name in found:
            problem = f"parameter {name!r} has two columns"
        scale = 1.0
        if unit and not problem:
            try:
                scale = factor(unit, unit if known is None else known[name])
            except ValueError as error:
                problem = f"parameter {column!r}: {error}"
        found[name] = (column, name, scale)
        problems += [problem] if problem else []
    return tuple(found.values()), problems


def _in_round_brackets(text, known):
    """What is wrong with the heading of a known name that has its unit in round brackets, or None."""
    found = _ROUND.fullmatch(text)
    if not found or found[1] not in known:
        return None
    return f"parameter {text!r} has its unit in round brackets; write {heading(*found.groups())!r}"
