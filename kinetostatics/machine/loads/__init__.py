"""Loads on the links besides inertia: weight, forces and couples, springs, dampers, and tables of their values.

load        what a load is
gravity     weight
slider      spring and process force along a guide
places      points of links, by which loads say where they act
points      forces, springs and dampers at points
torsion     couples on links
tables      values by crank angle or travel
"""

from .gravity import Gravity
from .load import MOST_TURNS, TURN, Load, WholeTurns, is_given, period_of, refusals, value_of
from .points import Force, PointDamper, PointForce, PointSpring
from .slider import ProcessForce, Spring
from .tables import Tabulated
from .torsion import Torque

KINDS = (Gravity, Spring, ProcessForce, Force, PointForce, PointSpring, PointDamper, Torque)
"""Every load of the library."""

__all__ = [
    "KINDS",
    "MOST_TURNS",
    "TURN",
    "Load",
    "WholeTurns",
    "Tabulated",
    "is_given",
    "period_of",
    "refusals",
    "value_of",
    *(kind.__name__ for kind in KINDS),
]
