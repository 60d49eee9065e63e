"""Sliders and number fields: for each parameter of a scene its group, shown unit, ends and digits."""

import math

import numpy as np

from ...numbers.formatting import pretty_unit
from ...numbers.output_units import dimension_name, shown_units

UNITS = {"rad": (180.0 / math.pi, "deg"), "rad/s": (30.0 / math.pi, "rpm")}
"""Factor and unit shown for units that people do not read."""
STEPS_OF_A_SLIDER = 400
"""Least number of steps of a slider between its ends."""
DRIVE = ("crank_speed", "crank_acceleration", "sense")


def shown_unit(unit):
    """Factor and unit in which a number of a field is shown."""
    factor, chosen = shown_units().of(unit)
    return (factor, chosen) if dimension_name(unit) in shown_units().chosen else UNITS.get(unit, (1.0, unit))


def fields(scene):
    """Fields of all numbers of a scene, in its order: dicts with path, group, label, value, unit, factor and ends."""
    found, values, units = [], scene.parameters, scene.units
    plain = {path: value for path, value in values.items() if np.ndim(value) == 0}
    largest: dict[str, float] = {}
    for path, value in plain.items():
        largest[units[path]] = max(largest.get(units[path], 0.0), abs(float(value)))
    for path, value in plain.items():
        if path == "sense":
            continue
        factor, unit = shown_unit(units[path])
        low, high = ends(float(value), units[path], largest[units[path]])
        step = round_step((high - low) * factor / STEPS_OF_A_SLIDER)
        part, dot, name = path.partition(".")
        group = part if dot else "drive" if path in DRIVE else "lengths"
        label = (name if dot else path).replace("_", " ").replace(".", " ")
        decimals = max(0, -math.floor(math.log10(step)))
        found.append(
            {
                "path": path,
                "group": group.replace("_", " "),
                "label": label,
                "value": float(value),
                "unit": pretty_unit(unit),
                "factor": factor,
                "low": math.floor(low * factor / step) * step / factor,
                "high": math.ceil(high * factor / step) * step / factor,
                "step": step / factor,
                "decimals": decimals,
            }
        )
    return found


def ends(value, unit, largest):
    """Ends of the slider of a number: zero to twice its value; of zero, as far as the largest number of its unit."""
    if value:
        return min(0.0, 2.0 * value), max(0.0, 2.0 * value)
    reach = math.pi if unit == "rad" else largest or 1.0
    return (0.0, reach) if unit in ("kg", "kg m2", "kg m^2") else (-reach, reach)


def round_step(step):
    """The next number 1, 2 or 5 times a power of ten above a positive one."""
    power = 10.0 ** math.floor(math.log10(step))
    return next(factor for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= step * (1 - 1e-9)) * power
