"""Better machines: static balancing, counterweights, four-bar classes; the contact of rollers and cams.

May import all rooms above: numbers to drive.

balancing       full, partial, optimal counterweights
linkage         classes of four-bars
cam_contact     contact of a roller with its cam: side, curvature, Hertz pressure, limits
hertz           line contact of two cylinders
cam_rollers     the roller itself: spin and sliding, load and life of its pin
hardness        the pressure that steel bears
followers       lift-off, surge of springs, torque to start
torque_balancing   spring-loaded follower on a cam on the crank that leaves the mean torque alone
spring_follower    how far its spring is stretched at each crank angle
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .cam_contact import Contact, contact
    from .followers import Surge, lift_off_speed, lifted, spring_surge, starting_torque
    from .hardness import hardness_from_pressure, pressure_from_hardness
    from .torque_balancing import TorqueBalancing, torque_balancing_cam

__all__ = [
    "Contact",
    "Surge",
    "TorqueBalancing",
    "contact",
    "hardness_from_pressure",
    "lift_off_speed",
    "lifted",
    "pressure_from_hardness",
    "spring_surge",
    "starting_torque",
    "torque_balancing_cam",
]

_WHERE = {
    "Contact": "cam_contact",
    "Surge": "followers",
    "TorqueBalancing": "torque_balancing",
    "contact": "cam_contact",
    "hardness_from_pressure": "hardness",
    "lift_off_speed": "followers",
    "lifted": "followers",
    "pressure_from_hardness": "hardness",
    "spring_surge": "followers",
    "starting_torque": "followers",
    "torque_balancing_cam": "torque_balancing",
}
"""Names by their module: loaded when first used."""


def __getattr__(name):
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found
