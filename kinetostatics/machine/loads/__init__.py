"""Loads on the links besides inertia: weight, forces and couples, springs, dampers, and tables of their values.

load        what a load is
gravity     weight
slider      spring and process force along a guide
places      points of links, by which loads say where they act
points      forces, springs and dampers at points
torsion     couples on links
tables      values by crank angle or travel: rows their rows, bending those that bend, crossings where they are passed
kinked      what loads declare of their kinks and jumps
period      turns after which loads repeat
"""

from .bending import STRAIGHT
from .crossings import in_rows
from .gravity import Gravity
from .kinked import bends_of, is_bent, kinked, kinks_of, period_on
from .load import Load, by_sense, is_given, may_refuse, refusals, value_of
from .period import MOST_TURNS, TURN, WholeTurns, period_of
from .points import Force, PointDamper, PointForce, PointSpring
from .slider import ProcessForce, Spring
from .tables import Table
from .torsion import Torque, TorsionDamper, TorsionSpring

KINDS = (
    Gravity,
    Spring,
    ProcessForce,
    Force,
    PointForce,
    PointSpring,
    PointDamper,
    Torque,
    TorsionSpring,
    TorsionDamper,
)
"""Every load of the library."""

__all__ = [
    "KINDS",
    "MOST_TURNS",
    "STRAIGHT",
    "TURN",
    "Force",
    "Gravity",
    "Load",
    "PointDamper",
    "PointForce",
    "PointSpring",
    "ProcessForce",
    "Spring",
    "Table",
    "Torque",
    "TorsionDamper",
    "TorsionSpring",
    "WholeTurns",
    "bends_of",
    "by_sense",
    "in_rows",
    "is_bent",
    "is_given",
    "kinked",
    "kinks_of",
    "may_refuse",
    "period_of",
    "period_on",
    "refusals",
    "value_of",
]
