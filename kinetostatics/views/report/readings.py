"""Every quantity at every angle that the reader can choose, with its unit and as many digits as are known."""

import math

import numpy as np

from ...mechanics.quantities import components, of_scene, scale, still
from ...numbers.formatting import pretty
from ...results.rounding import FLOOR, zeroed
from ..canvas import display, in_sight, ordinary
from .movement import packed

DIGITS = 6
"""Digits of the largest value that are shown, at most."""
KINDS = ("force", "reaction", "friction", "slider", "motion", "whole", "rate")
"""Kinds of quantities in the order in which they are listed."""


def readings(machines):
    """What the page needs of each quantity that any of the machines has, in the order of their kinds."""
    found: dict[str, dict] = {}
    for machine in machines.values():
        for name, quantity in of_scene(machine.solution).items():
            if quantity.kind in KINDS and name not in found and not _is_still(machine.solution, quantity):
                found[name] = {
                    "quantity": quantity,
                    "of": [_values(other, other.solution, name) for other in machines.values()],
                    "between": [_values(other, other.between, name) for other in machines.values()],
                }
    ordered = sorted(found.items(), key=lambda item: KINDS.index(item[1]["quantity"].kind))
    texts = {
        name: output.text for machine in machines.values() for name, output in machine.scene.mechanism.outputs.items()
    }
    return {name: _sent(text=texts.get(name, ""), **item) for name, item in ordered}


def _is_still(solution, quantity):
    return quantity.kind == "rate" and still(solution.placement.links[quantity.owner].ratio)


def _values(machine, solution, name):
    """Values over the angles of a solution, (1 or 2, N), or None of a machine that lacks the quantity."""
    if name not in of_scene(solution) or _is_still(machine.solution, of_scene(solution)[name]):
        return None
    shape, rounding = solution.crank_angle.shape, FLOOR * float(np.max(scale(machine.solution, name)))
    return zeroed(np.stack([np.broadcast_to(part, shape) for part in components(solution, name)]), rounding)


def _sent(quantity, of, between, text):
    arrays = [values for values in of if values is not None]
    sizes = [np.hypot(*values) if quantity.vector else values for values in arrays]
    factor, unit = display(quantity.unit, sizes)
    sight = in_sight(sizes)
    return {
        "label": quantity.label,
        "kind": quantity.kind,
        "text": text,
        "unit": pretty(unit),
        "factor": factor,
        "vector": quantity.vector,
        "sight": factor * sight if np.isfinite(sight) else None,
        "decimals": decimals(factor * ordinary(sizes)),
        "values": [None if values is None else packed(factor * values, "<f8") for values in of],
        "between": [None if values is None else packed(factor * values, "<f8") for values in between],
    }


def decimals(largest):
    """Decimals with which a value of this size has as many digits as are shown."""
    if not largest > 0:
        return 0
    return min(12, max(0, DIGITS - 1 - math.floor(math.log10(largest))))
