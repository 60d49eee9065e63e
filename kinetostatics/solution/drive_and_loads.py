"""Drive and loads of a scene or solution: in a line, and which of them are tables over the crank angles given."""

import numpy as np

from ..machine.loads import value_of
from ..numbers import checks


def tables_over_angles(item):
    """Names of what has a value for each crank angle given, unknown between them."""
    drive = ("crank_speed", item.crank_speed), ("crank_acceleration", item.crank_acceleration)
    loads = ((type(load).__name__, value_of(load)) for load in item.loads)
    return [
        name for name, value in (*drive, *loads) if np.ndim(value) and np.shape(value)[-1] > 1 and not callable(value)
    ]


def drive_and_loads_text(item):
    """Drive and loads of a scene or solution in a line."""
    loads = ", ".join(type(load).__name__ for load in item.loads) or "no loads"
    drive = f"crank_speed={_short_text(item.crank_speed)}, crank_acceleration={_short_text(item.crank_acceleration)}"
    rubbing = f", friction at {', '.join(item.friction)}" if item.friction else ""
    sense = "" if item.sense is None else f", sense={_short_text(item.sense)}"
    return f"{drive}{sense}, {loads}{rubbing}"


def _short_text(value):
    return checks.shown(value) if np.ndim(value) == 0 else f"<array of shape {np.shape(value)}>"
