"""Dimensions of numbers: powers of m, kg and s; radians count as 1."""

import re

import numpy as np

NONE = (0.0, 0.0, 0.0)
BASES = {
    "m": (1, 0, 0),
    "kg": (0, 1, 0),
    "s": (0, 0, 1),
    "N": (1, 1, -2),
    "J": (2, 1, -2),
    "Pa": (-1, 1, -2),
    "W": (2, 1, -3),
}
"""Powers of m, kg and s of units that others are made of."""
SPELLED = {
    (0, 0, 0): "1",
    (1, 0, 0): "m",
    (2, 0, 0): "m2",
    (3, 0, 0): "m3",
    (4, 0, 0): "m4",
    (-1, 0, 0): "1/m",
    (-2, 0, 0): "1/m2",
    (0, 1, 0): "kg",
    (1, 1, 0): "kg m",
    (2, 1, 0): "kg m2",
    (0, 0, -1): "rad/s",
    (0, 0, -2): "rad2/s2",
    (1, 0, -1): "m/s",
    (1, 0, -2): "m/s2",
    (1, 1, -2): "N",
    (0, 1, -2): "N/m",
    (2, 1, -2): "N m",
    (3, 1, -2): "N m2",
    (2, 1, -3): "W",
    (1, 1, -1): "N s",
    (0, 1, -1): "N s/m",
}


_FACTOR = re.compile(r"([A-Za-z]+)(?:\*\*|\^)?(\d*)")


def dimension(unit):
    """Powers of m, kg and s in a unit such as "N*m*s/rad" or "m/s2"."""
    found = np.zeros(3)
    for over, part in enumerate(unit.split("/")):
        for base, power in _FACTOR.findall(part):
            found += (-1 if over else 1) * int(power or 1) * np.array(BASES.get(base, NONE))
    return tuple(found.tolist())


def spelled(dimension):
    """A unit of these powers."""
    if dimension in SPELLED:
        return SPELLED[dimension]
    named = zip(("m", "kg", "s"), dimension, strict=True)
    return " ".join(base + (f"{count:g}" if count != 1 else "") for base, count in named if count)
