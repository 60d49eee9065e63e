"""Better machines: static balancing, four-bar classes, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

demands         what is asked of a design, read from texts
derived         what follows from the numbers that vary
measures        outputs with their derivatives
problem         outputs of a scene as functions of the numbers that vary
search          the search by SciPy's optimisers
found           its result: the machine, what binds, what it costs
optimisation    any machine under limits
cam_start       the cam-balanced crank-slider that a search for its cam begins with
torque_free     cams that need no torque
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .found import Found
    from .fronts import Front, pareto
    from .optimisation import optimise
    from .robust import Spread
    from .torque_free import torque_free_cam

__all__ = ["Found", "Front", "Spread", "optimise", "pareto", "torque_free_cam"]

_WHERE = {
    "Found": "found",
    "Front": "fronts",
    "Spread": "robust",
    "optimise": "optimisation",
    "pareto": "fronts",
    "torque_free_cam": "torque_free",
}
"""Names by their module: loaded when first used."""


def __getattr__(name):
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found
