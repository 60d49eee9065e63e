"""Better machines: static balancing, four-bar classes, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

demands         what is asked of a design, read from texts
derived         what follows from the numbers that vary
measures        outputs with their derivatives
problem         outputs of a scene as functions of the numbers that vary
search          the search by SciPy's optimisers
found           its result: the machine, what binds, what it costs
optimisation    any machine under limits
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .optimisation import optimise

__all__ = ["optimise"]

_WHERE = {"optimise": "optimisation"}
"""Names by their module: loaded when first used."""


def __getattr__(name):
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found
