"""Sizes that a number of a machine usually has: one beyond them looks like a slip of units."""

import math
from typing import NamedTuple

import numpy as np

from .values import known


class Usual(NamedTuple):
    """Sizes, without sign, between which a number lies that is not zero.

    Attributes
    ----------
    most, least : float
        In its SI unit, or in lengths of the machine's longest link.
    advice : str
        What is asked about one that does not.
    factor : float
        To SI from the unit that is asked about; 0 where it is none.
    in_links : bool
        Whether they are in lengths of the longest link.
    unit : str
        SI unit, where the rule of the number has told it.
    """

    most: float
    advice: str
    factor: float = 0.0
    least: float = 0.0
    in_links: bool = False
    unit: str = ""


FAR = 20.0
"""Lengths of the longest link beyond which nobody puts anything: millimetres beside metres make 1000."""
BY_UNIT = {
    "rad": Usual(2.0 * math.pi * (1.0 + 1e-9), "more than a whole turn; is it in degrees?", math.pi / 180.0),
    "m": Usual(FAR, "is it in mm?", 1e-3, in_links=True),
}
"""What holds for all numbers in a unit whose rule says nothing else."""


def usual_of(rule):
    """What is usual of a number by its rule; None where anything is."""
    found = rule.usual or BY_UNIT.get(rule.unit)
    return found and found._replace(unit=rule.unit)


def unusual(path, value, usual, longest=0.0):
    """What is odd about a number, as a sentence, or None."""
    most, advice, factor, least, in_links, si = usual
    unit = longest if in_links else 1.0
    if not known(value) or not unit:
        return None
    sizes = abs(value)
    worst = sizes if isinstance(sizes, float) else float(sizes.max())
    if worst <= most * unit:
        worst = 0.0 if least == 0.0 else float(np.min(sizes))
        if worst == 0.0 or worst >= least * unit:
            return None
    own = "" if si == "1" else " " + si.replace("**", "").replace("*", " ")
    beside = f", {worst / longest:.4g} times the longest link ({longest:.4g} m)" if in_links else ""
    odd = -worst if np.any(np.equal(value, -worst)) else worst
    meant = f" That makes {factor * odd:.6g}{own}" if factor else ""
    return f"{path} is {odd:.6g}{own}{beside}; {advice}{meant}"
