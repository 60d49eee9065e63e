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

from .gravity import Gravity
from .load import (
    Load,
    depends_on_sense,
    has_no_user_code,
    has_significant_kinks,
    kink_sources,
    kinks_of,
    may_refuse,
    period_on,
    refusals,
    significant_kinks,
    value_of,
)
from .points import Force, PointDamper, PointForce, PointSpring
from .slider import ProcessForce, Spring
from .table import Table
from .table_pieces import KINK_TOLERANCE, MAX_TURNS, TURN, WholeTurns, pad_rows, period_of
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
