"""Better machines: static balancing, counterweights, four-bar classes; the contact of rollers and cams.

May import all rooms above: numbers to solution.

balancing       full, partial, optimal counterweights
linkage         classes of four-bars
cam_contact     contact(...) of a roller on its cam: side, curvature, Hertz pressure, limits
hertz           line contact of two cylinders
cam_rollers     the roller itself: spin and sliding, load and life of its pin
hardness        the pressure that steel bears
followers       lift-off, surge of springs, torque to start
"""

from importlib import import_module

_WHERE = {
    "cam_contact": ("Contact", "contact"),
    "hardness": ("hardness_from_pressure", "pressure_from_hardness"),
    "followers": ("Surge", "lift_off_speed", "spring_surge", "starting_torque"),
}
"""Names by the module that they are loaded from when first used."""


def __getattr__(name):
    place = next((place for place, names in _WHERE.items() if name in names), None)
    if place is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{place}"), name)


def __dir__():
    return sorted({*globals(), *(name for names in _WHERE.values() for name in names)})
