"""Names and units of what a solution offers: one list for extremes, tables, plots and the command line."""

from ..errors import QuantityError
from ..numbers import checks
from ..numbers.elementary import sqrt

UNITS = {
    "balancing_torque": "N m",
    "balancing_torque_by_power": "N m",
    "guide_force": "N",
    "guide_moment": "N m",
    "cam_force": "N",
    "slot_force": "N",
    "shaking_force": "N",
    "shaking_moment": "N m",
    "slider_position": "m",
    "slider_velocity": "m/s",
    "slider_acceleration": "m/s2",
    "pressure_angle": "rad",
}
VECTORS = ("shaking_force",)
RATES = {"_rate": "rad/s", "_angular_acceleration": "rad/s2"}
"""Endings that make a quantity of a link's name: "coupler_rate", "rocker_angular_acceleration"."""


def values(solution, quantity):
    """Values of a quantity over the crank angles; of a joint's reaction or a vector attribute, the magnitude."""
    if callable(quantity):
        return quantity(solution)
    parts = components(solution, quantity)
    return parts[0] if len(parts) == 1 else magnitude(parts)


def components(solution, quantity):
    """Values of a scalar quantity over the crank angles, or both components of a joint's reaction or a vector."""
    if quantity in UNITS:
        found = getattr(solution, quantity)
        return tuple(found) if quantity in VECTORS else (found,)
    if quantity == "closure":
        return solution.closure
    link, ending = _of_link(quantity)
    if link in solution.mechanism.links:
        return (solution.rate(link) if ending == "_rate" else solution.angular_acceleration(link),)
    if quantity in solution.reactions:
        return tuple(solution.reaction(quantity))
    if quantity in solution.scalars:
        return (solution.scalar(quantity),)
    known = (*UNITS, *solution.scalars, *solution.reactions)
    raise QuantityError(checks.choice(f"{solution.mechanism.name}: quantity", quantity, tuple(dict.fromkeys(known))))


def sizes(solution, quantity):
    """The same with the magnitude in place of the components of a vector."""
    parts = components(solution, quantity)
    return (magnitude(parts),) if quantity in VECTORS or quantity in solution.reactions else parts


def scale(solution, quantity):
    """Largest of the terms that a force, moment or torque is the sum of; 0 for a motion or a function of the user's.

    What is small beside it may be rounding of terms that cancel.
    """
    if callable(quantity) or _of_link(quantity)[0] or unit(quantity) not in ("N", "N m"):
        return 0.0
    return solution.largest_torque_term if unit(quantity) == "N m" else solution.largest_force_term


def unit(quantity):
    """Unit of a quantity, SI; a joint's reaction is in N."""
    return RATES.get(_of_link(quantity)[1]) or UNITS.get(_unlabelled(quantity), "N")


def label(quantity):
    """What a table or an axis calls a quantity."""
    named = _unlabelled(quantity) in UNITS or _of_link(quantity)[0]
    return quantity.replace("_", " ") if named else f"reaction {quantity}"


def _unlabelled(quantity):
    """Name of a quantity without the number of a second group: guide_force of "guide_force2"."""
    return quantity.rstrip("0123456789")


def _of_link(quantity):
    """Link and ending of a rate's name; two empty texts for any other quantity."""
    found = next((ending for ending in RATES if quantity.endswith(ending)), "")
    return quantity.removesuffix(found) if found else "", found


def magnitude(vector):
    """Length of a vector, first axis (x, y)."""
    return sqrt(vector[0] * vector[0] + vector[1] * vector[1])
