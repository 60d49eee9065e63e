"""Symbols of hand calculations: what numbers of a scene, and quantities of a solution, are called in formulas."""

import re
from typing import NamedTuple


class Symbol(NamedTuple):
    """What a number is called: F of ("F", "x", "slider") is the x component of force F of the slider.

    Attributes
    ----------
    base, axis, owner : str
    primes : int
        How many times it is differentiated by the crank angle.
    again : int
        Which of several that are spelled alike.
    """

    base: str
    axis: str = ""
    owner: str = ""
    primes: int = 0
    again: int = 1

    @property
    def text(self):
        count = str(self.again) if self.again > 1 else ""
        stem = "_".join(part for part in (self.base + self.axis + count, self.owner) if part)
        return re.sub(r"[^\w.]", "_", stem) + "'" * self.primes


def load_keys(loads):
    """What each load is called: as in paths, with its number where there are several of a kind."""
    found, counts = [], dict[str, int]()
    for item in loads:
        key = getattr(item, "PATH", "") or type(item).__name__
        counts[key] = counts.get(key, 0) + 1
        found.append(f"{key}{counts[key]}" if counts[key] > 1 else key)
    return found


LETTERS = {
    "mass": "m",
    "inertia": "J",
    "along": "a",
    "across": "b",
    "stiffness": "k",
    "coefficient": "c",
    "radius": "r",
    "pin_radius": "r",
    "roller_radius": "R",
    "half_length": "h",
    "mu": "mu",
    "free_position": "s0",
    "free_length": "l0",
    "free_angle": "theta0",
}
PATH_LETTERS = {
    "crank_speed": "omega",
    "crank_acceleration": "alpha",
    "gravity.acceleration": "g",
    "gravity.direction": "gamma",
}


def path_symbol(path):
    """Symbol of a number of the scene."""
    if path in PATH_LETTERS:
        return Symbol(PATH_LETTERS[path])
    *owner, last = [part for part in path.split(".") if part != "centre"]
    if last in ("x", "y"):
        return Symbol(last, "", "_".join(owner))
    if last.isdecimal() and owner:
        last = owner.pop() + last
    for name, letter in (("_length", "l"), ("guide_angle", "beta"), ("guide_offset", "e")):
        stem, found, label = last.partition(name)
        if found:
            return Symbol(letter, "", "_".join((*owner, stem + label)).strip("_"))
    return Symbol(LETTERS.get(last, last), "", "_".join(owner))


ENDING_LETTERS = {
    "_force": "F",
    "_moment": "M",
    "_position": "s",
    "_velocity": "v",
    "_angular_acceleration": "alpha",
    "_acceleration": "a",
    "_rate": "omega",
    "_energy": "E",
    "_friction_loss": "P",
}
"""Letters of quantities whose names end so."""


def quantity_symbol(quantity):
    """Symbol of a quantity by name."""
    if quantity.startswith("balancing_torque"):
        return Symbol("T")
    for ending, letter in ENDING_LETTERS.items():
        stem, found, label = quantity.partition(ending)
        if found:
            return Symbol(letter, "", stem + label)
    return Symbol(quantity)
