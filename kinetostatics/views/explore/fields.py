"""Input fields of the page: for each parameter of a scene its group, label, display unit, range and step."""

import math
import re

import numpy as np

from ...numbers.formatting import pretty_unit
from ...numbers.output_units import dimension_name, shown_units

UNITS = {"rad": (180.0 / math.pi, "deg"), "rad/s": (30.0 / math.pi, "rpm")}
"""Factor and display unit for angles and angular speeds."""
STEPS_OF_A_SLIDER = 400
"""Steps of an input slider over its range, before its step is rounded up."""
SHORTEST = 0.2
"""Lower end of the range of a link's length, relative to its value: a link cannot have length 0."""
TINY = 1e-200
"""Size below which a number has the range of a zero."""
UNKNOWN_REACH = 1.0
"""Upper end of the range of a zero, SI, if no other number of the machine suggests one."""
DRIVE = ("crank_speed", "crank_acceleration")
PATH_OF_LINK = re.compile(r"(\w+?)_(\w*?)(\d*)")
"""Path of a number of a link or guide: "coupler_length2" is the length of "coupler2"."""
COORDINATES = re.compile(r".*(along|across|offset\d*|\.[xy])")
"""Paths of coordinates and offsets, which may be negative."""
WORDS = {
    "centre.along": "mass centre along",
    "centre.across": "mass centre across",
    "inertia": "moment of inertia",
    "mu": "coefficient of friction",
}
"""Words in a label for the end of a path."""
HIDDEN = re.compile(r"sense|exact\d*\.[xy]")
"""Parameters without a field: the sense is +1 or -1, and the components of a unit vector cannot change alone."""


def shown_unit(unit):
    """Factor from an SI unit to the display unit, and that unit."""
    factor, chosen = shown_units().of(unit)
    return (factor, chosen) if dimension_name(unit) in shown_units().chosen else UNITS.get(unit, (1.0, unit))


def fields(scene):
    """Fields of all numbers of a scene, group by group: dicts in SI, with display `unit` and the `factor` to it."""
    units = scene.units
    plain = {path: float(value) for path, value in scene.parameters.items() if np.ndim(value) == 0}
    links = {path.removesuffix(".mass") for path in plain if path.count(".") == 1 and path.endswith(".mass")}
    found: dict[str, list[dict]] = {}
    for path, value in plain.items():
        if HIDDEN.fullmatch(path):
            continue
        group, label = group_and_label(path, links)
        factor, unit = shown_unit(units[path])
        low, high = range_of(path, value, plain, units)
        step = round_step((high - low) * factor / STEPS_OF_A_SLIDER)
        found.setdefault(group, []).append(
            {
                "path": path,
                "group": group.replace("_", " "),
                "label": label,
                "value": value,
                "unit": pretty_unit(unit),
                "factor": factor,
                "low": math.floor(low * factor / step + 1e-9) * step / factor,
                "high": math.ceil(high * factor / step - 1e-9) * step / factor,
                "step": step / factor,
            }
        )
    return [field for group in found.values() for field in group]


def group_and_label(path, links):
    """Group of a parameter ("drive", "lengths", or its link or load), and its label in that group."""
    part, _, name = path.partition(".")
    if path in DRIVE:
        return "drive", path.replace("_", " ")
    match = PATH_OF_LINK.fullmatch(part)
    if part not in links and match and (match[1] == "guide" or match[1] + match[3] in links):
        part, name = match[1] + match[3], f"{match[2]}.{name}".strip(".")
    if not name:
        part, name = "lengths", path
    for end, word in WORDS.items():
        if name == end or name.endswith("." + end):
            name = name.removesuffix(end) + word
    return part, name.replace("_", " ").replace(".", " ")


def range_of(path, value, values, units):
    """Range of a number, SI: half a turn each way for angles, else 0 to twice the value, both ways for coordinates."""
    unit, dimension = units[path], dimension_name(units[path])
    if dimension == "angle":
        return min(-math.pi, value), max(math.pi, value)
    if abs(value) > TINY and COORDINATES.fullmatch(path):
        return -2.0 * abs(value), 2.0 * abs(value)
    if abs(value) > TINY:
        low = SHORTEST * value if "_length" in path else 0.0
        return (low, 2.0 * value) if value > 0 else (2.0 * value, 0.0)

    def largest(wanted):
        return max((abs(values[other]) for other in values if dimension_name(units[other]) == wanted), default=0.0)

    length, speed, own = largest("length"), largest("angular speed"), largest(dimension) if dimension else 0.0
    reach = {
        "mass": own,
        "inertia": own or largest("mass") * length**2,
        "length": 0.5 * own,
        "angular acceleration": 0.1 * speed**2,
    }.get(dimension, own)
    if unit == "N/m**3" and length:
        reach = largest("stiffness") / length**2
    reach = reach or UNKNOWN_REACH
    return (0.0 if dimension in ("mass", "inertia", "stiffness") else -reach), reach


def round_step(step):
    """The least number of 1, 2 or 5 times a power of ten that is not below a positive step."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9)) * power
