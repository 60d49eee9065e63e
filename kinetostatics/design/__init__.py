"""Better machines: static balancing, four-bar classes, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

demands         what is asked of a design, read from texts
derived         what follows from the numbers that vary
measures        outputs with their derivatives
problem         outputs of a scene as functions of the numbers that vary
search          the search by SciPy's optimisers
found           its result: the machine, what binds, what it costs
case_text       scenes as case files
robust          quantiles over spreads as what is made least or greatest
optimisation    any machine under limits
fronts          the best of one output for each value of another
cam_start       the cam-balanced crank-slider that a search for its cam begins with
torque_free     cams that need no torque
weights         what carries weight where a symmetric cam cannot
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .found import Found
    from .fronts import Front, pareto
    from .optimisation import optimise
    from .robust import Spread, over_spread
    from .torque_free import torque_free_cam
    from .weights import weight_options

__all__ = [
    "Found",
    "Front",
    "Spread",
    "optimise",
    "over_spread",
    "pareto",
    "torque_free_cam",
    "weight_options",
]

_WHERE = {
    "Found": "found",
    "Front": "fronts",
    "Spread": "robust",
    "optimise": "optimisation",
    "over_spread": "robust",
    "pareto": "fronts",
    "torque_free_cam": "torque_free",
    "weight_options": "weights",
}
"""Names by their module: loaded when first used."""


def __getattr__(name):
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found
