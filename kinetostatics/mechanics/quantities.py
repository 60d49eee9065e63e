"""Quantities of a solution by name: unit, label, and the function that reads their values.

The groups declare units and labels. The table serves extremes, tables, plots, sweeps and the command line.
"""

import json
from collections.abc import Callable
from operator import attrgetter, methodcaller
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from ..errors import QuantityError
from ..machine.group import BEARINGS, GROUND, ROCKING, SHAFT_TORQUE, TRAVELS
from ..machine.links import Turning
from ..machine.supports import places
from ..numbers import checks
from ..numbers.arithmetic import sqrt

LOAD_FREE_KINDS = ("slider", "motion", "rate")
"""Kinds of quantities that do not depend on loads."""


class Quantity(NamedTuple):
    """A quantity of a mechanism.

    Attributes
    ----------
    unit : str
        SI.
    label : str
        Name in tables and on axes.
    read : function
        From a motion, dynamics or solution to values, (..., N) or for a vector (2, ..., N).
    vector : bool
    kind : str
        "reaction", "force" (a force, moment or torque by name), "slider", "motion", "contact" (a pressure), "rate" or
        "friction". Of the whole mechanism: "whole", or "energy" (in tables on request only). Not in tables: "ground"
        (a force on the frame) and "check" (of the solution).
    owner : str
        Link of a rate.
    """

    unit: str
    label: str
    read: Callable[[Any], Any]
    vector: bool = False
    kind: str = "force"
    owner: str = ""

    @property
    def reading(self):
        """Python code that reads it from a solution: ``.shaking_force``, ``.reaction("O")``."""
        how: Any = self.read.__reduce__()
        kind, (name, *given) = how[:2]
        return f".{name}" if kind is attrgetter else f".{name}({json.dumps(given)[1:-1]})"


FRICTION_CHECKS = ("friction_margin", "friction_residual")
"""Quantities that measure how well friction converged."""
OF_ALL_FRICTION = {"friction_loss": ("W", "friction"), "friction_torque": ("N m", "energy")}
OF_ALL_FRICTION |= dict.fromkeys(FRICTION_CHECKS, ("1", "check"))
"""Units and kinds of the quantities of all friction together."""
_known: WeakKeyDictionary[Any, dict[str, Quantity]] = WeakKeyDictionary()
_known_scenes: WeakKeyDictionary[Any, dict[Any, dict[str, Quantity]]] = WeakKeyDictionary()
"""Quantities of scenes by mechanism, then by joints with friction and places on the frame."""


def of_mechanism(mechanism) -> dict[str, Quantity]:
    """Every quantity of a mechanism, by name."""
    if known := _known.get(mechanism):
        return known
    found: dict[str, Quantity] = {}

    def add(name, unit, read, vector=False, kind="force", label=None, owner=""):
        found[name] = Quantity(unit, label or name.replace("_", " "), read, vector, kind, owner)

    outputs = {name: output for part in (*mechanism.groups, mechanism.crank) for name, output in part.outputs.items()}
    for name in ("balancing_torque", *(name for name in outputs if name != "balancing_torque")):
        if not outputs[name].vector:
            add(name, outputs[name].unit, methodcaller("scalar", name))
    for name, unit in WHOLE.items():
        add(name, unit, attrgetter(name), name == "shaking_force", "whole")
    if mechanism.has_planes:
        add(ROCKING, "N m", attrgetter(ROCKING), True, "whole")
        for name in mechanism.on_shaft:
            add(f"{SHAFT_TORQUE} {name}", "N m", methodcaller(SHAFT_TORQUE, name), label=f"shaft torque, {name}")
    for name, unit in ENERGIES.items():
        add(name, unit, attrgetter(name), kind="energy")
    for slider in mechanism.guides:
        for ending, unit, read in zip(TRAVELS, ("m", "m/s", "m/s2"), TRAVEL_READINGS, strict=True):
            add(slider + ending, unit, methodcaller(read, slider), kind="slider")
    for group in mechanism.groups:
        for name, output in group.motions.items():
            add(name, output.unit, methodcaller("measure", name), kind="motion")
        for name in group.contacts:
            add(name, "Pa", methodcaller("pressure", name), kind="contact")
    for name, output in outputs.items():
        if output.vector:
            add(name, output.unit, methodcaller("reaction", name), True, "reaction", f"reaction {name}")
    for name, side in BEARINGS.items() if mechanism.crank.bearings is not None else ():
        add(name, "N", methodcaller("reaction", "O", side), True, "reaction", f"reaction {name}")
    for link in mechanism.links:
        for ending, unit in RATES.items():
            add(link + ending, unit, methodcaller(ending[1:], link), kind="rate", owner=link)
    _known[mechanism] = found
    return found


def of_scene(scene) -> dict[str, Quantity]:
    """Every quantity of a scene, by name: of its mechanism, its friction, and its forces on the frame."""
    friction = tuple(getattr(scene, "friction", None) or ())
    pushed = tuple(name for name, place in places(scene).items() if place.pushes)
    known = _known_scenes.setdefault(scene.mechanism, {})
    if (friction, pushed) not in known:
        ground = {f"{GROUND} {place}".strip(): _ground(place) for place in ("", *pushed)}
        own = of_mechanism(scene.mechanism)
        known[friction, pushed] = own | _of_friction(scene.mechanism, friction) | ground
    return known[friction, pushed]


def _of_friction(mechanism, friction):
    """Quantities of the joints with friction; empty without friction."""
    found = {}
    for joint in friction:
        pin = isinstance(mechanism.pairs[joint], Turning)
        read = methodcaller("friction_at", joint)
        found[f"{joint}_friction"] = Quantity("N m" if pin else "N", f"friction {joint}", read, kind="friction")
        read = methodcaller("friction_loss_at", joint)
        found[f"{joint}_friction_loss"] = Quantity("W", f"friction loss {joint}", read, kind="friction")
    for name, (unit, kind) in OF_ALL_FRICTION.items() if friction else ():
        found[name] = Quantity(unit, name.replace("_", " "), attrgetter(name), kind=kind)
    return found


def _ground(place):
    """Force on the frame at a place, "" for the sum of all."""
    label = f"force on the frame, {place}" if place else "force on the frame"
    return Quantity("N", label, methodcaller("ground_force", *filter(None, [place])), True, "ground")


def resolved_names(scene):
    """Names of the quantities that one evaluation gives: closure, forces of groups, and friction."""
    of_friction = _of_friction(scene.mechanism, tuple(getattr(scene, "friction", None) or ()))
    return ("closure", *scene.mechanism.outputs, *of_friction)


def quantity(solution, name) -> Quantity:
    """Quantity of a solution by name; `QuantityError` with the known ones if it is unknown."""
    known = of_scene(solution)
    if not isinstance(name, str) or name not in known:
        raise QuantityError(checks.choice(f"{solution.mechanism.name}: quantity", name, tuple(known)))
    return known[name]


def without_bars(solution, name):
    """Name of a quantity without bars: "O" for "|O|"; `QuantityError` if it is unknown or no vector."""
    bars = isinstance(name, str) and len(name) > 2 and name[0] == name[-1] == "|"
    bare = name[1:-1] if bars else name
    if not quantity(solution, bare).vector and bars:
        raise QuantityError(f"{name}: only vectors have a magnitude, and {bare} is a number")
    return bare


def components(solution, name):
    """Values of a scalar quantity over the crank angles, or both components of a vector; "closure": of each group.

    Parameters
    ----------
    solution : Solution
    name : str
        A quantity as for `extremes`.

    Returns
    -------
    tuple of array (..., N)
        SI.

    Raises
    ------
    QuantityError
        The solution does not have the quantity.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(360)
    >>> len(ks.precision.components(s, "balancing_torque")), len(ks.precision.components(s, "O"))
    (1, 2)
    """
    if name == "closure":
        return solution.closure
    found = quantity(solution, name)
    values = found.read(solution)
    return tuple(values) if found.vector else (values,)


def unit_of(solution, name):
    """Unit of a quantity of a solution; "" for a user's function."""
    return "" if callable(name) else quantity(solution, name).unit


def label_of(solution, name):
    """Label of a quantity in tables and on axes; an unknown name is its own label."""
    known = of_scene(solution)
    return known[name].label if name in known else name


def values(solution, name):
    """Values of a quantity, (..., N): the magnitude of a vector, the result of a function."""
    if callable(name):
        return name(solution)
    parts = components(solution, name)
    return parts[0] if len(parts) == 1 else magnitude(parts)


def component_sizes(solution, name):
    """Components of a quantity, a tuple of (..., N); a vector gives its magnitude only."""
    parts = components(solution, name)
    vector = name != "closure" and quantity(solution, name).vector
    return (magnitude(parts),) if vector else parts


def largest_term(solution, name):
    """Largest term in the sum of a force, N, or moment, N m, 0 for others; much smaller values may be rounding."""
    return largest_term_in(solution, unit_of(solution, name))


def largest_term_in(solution, unit):
    """Largest term in the sums of forces, N, or of moments, N m; 0 for other units."""
    if unit == "N m":
        return solution.largest_torque_term
    return solution.largest_force_term if unit == "N" else 0.0


def magnitude(vector):
    """Length of a vector, first axis (x, y)."""
    return sqrt(vector[0] * vector[0] + vector[1] * vector[1])


WHOLE = {"balancing_torque_by_power": "N m", "shaking_force": "N", "shaking_moment": "N m"}
"""Units of the forces of the whole mechanism."""
TRAVEL_READINGS = "travel", "travel_velocity", "travel_acceleration"
"""Methods that read the coordinate of a slider and its derivatives by time."""
ENERGIES = {
    "reduced_inertia": "kg m2",
    "reduced_inertia_slope": "kg m2",
    "kinetic_energy": "J",
    "potential_energy": "J",
    "load_torque": "N m",
}
"""Units of inertia, energies and load torque of the whole mechanism."""
RATES = {"_rate": "rad/s", "_angular_acceleration": "rad/s2"}
"""Units of the rates of links, by the ending of their names."""
