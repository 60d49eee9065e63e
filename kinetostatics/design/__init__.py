"""Better machines: counterweights, four-bar classes, contact of cams, optimisation under limits, torque-free cams.

May import all rooms above: numbers to drive.

balancing       full, partial, optimal counterweights
linkage         four-bars: swing, transmission, the chain unit
grashof         their classes
cam_contact     contact of a roller with its cam: side, curvature, Hertz pressure, limits
contact_asked   what it is asked with: the roller, both materials, limits
cam_rollers     the roller itself: spin and sliding, load and life of its pin
hardness        the pressure that steel bears
followers       lift-off, surge of springs, torque to start
demands         what is asked of a design, read from texts
derived         what follows from the numbers that vary
measures        outputs with their derivatives
problem         outputs of a scene as functions of the numbers that vary
progress        bars that count its steps
search          the search by SciPy's optimisers
found           its result: the machine, what binds, what it costs
case_text       scenes as case files
spread          how numbers spread, and which quantile counts
robust          quantiles over spreads as what is made least or greatest
optimisation    any machine under limits
fronts          the best of one output for each value of another
cam_start       the cam-balanced crank-slider that a search for its cam begins with
torque_free     cams that need no torque
weights         what carries weight where a symmetric cam cannot
torque_balancing  spring-loaded follower on a cam on the crank that leaves the mean torque alone
torque_balanced what it gives and costs
spring_follower how far its spring is stretched at each crank angle
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..machine.profile import Peak
    from .cam_contact import Contact
    from .contact_asked import contact
    from .followers import Surge, lift_off_speed, lifted, spring_surge, starting_torque
    from .found import Found
    from .fronts import Front, pareto
    from .hardness import hardness_from_pressure, pressure_from_hardness
    from .optimisation import optimise
    from .robust import over_spread
    from .spread import Spread
    from .torque_balanced import TorqueBalancing
    from .torque_balancing import torque_balancing_cam
    from .torque_free import torque_free_cam
    from .weights import weight_options

__all__ = [
    "Contact",
    "Found",
    "Front",
    "Peak",
    "Spread",
    "Surge",
    "TorqueBalancing",
    "contact",
    "hardness_from_pressure",
    "lift_off_speed",
    "lifted",
    "optimise",
    "over_spread",
    "pareto",
    "pressure_from_hardness",
    "spring_surge",
    "starting_torque",
    "torque_balancing_cam",
    "torque_free_cam",
    "weight_options",
]

_WHERE = {
    "Contact": "cam_contact",
    "Found": "found",
    "Front": "fronts",
    "Peak": "cam_contact",
    "Spread": "spread",
    "Surge": "followers",
    "TorqueBalancing": "torque_balanced",
    "contact": "contact_asked",
    "hardness_from_pressure": "hardness",
    "lift_off_speed": "followers",
    "lifted": "followers",
    "optimise": "optimisation",
    "over_spread": "robust",
    "pareto": "fronts",
    "pressure_from_hardness": "hardness",
    "spring_surge": "followers",
    "starting_torque": "followers",
    "torque_balancing_cam": "torque_balancing",
    "torque_free_cam": "torque_free",
    "weight_options": "weights",
}
"""Names by their module: loaded when first used."""


def __getattr__(name):
    if name not in _WHERE:
        from ..numbers.checks import hint

        near = "" if name.startswith("_") else hint(name, __all__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{near}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found


def __dir__():
    return __all__
