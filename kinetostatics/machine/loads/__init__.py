"""Loads on the links besides inertia: weight, forces and couples, springs, dampers, and tables of their values.

load          protocol of loads, and their kinks and jumps
gravity       weight
slider        springs and forces along a guide
points        forces, springs and dampers at points of links
torsion       couples on links
table         values by crank angle or travel; table_pieces: look-up, kinks, crossings, rounding errors

May import numbers and the other modules of `machine` that describe links and their motion.
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
    "KINK_TOLERANCE",
    "MAX_TURNS",
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
    "depends_on_sense",
    "has_no_user_code",
    "has_significant_kinks",
    "kink_sources",
    "kinks_of",
    "may_refuse",
    "pad_rows",
    "period_of",
    "period_on",
    "refusals",
    "significant_kinks",
    "value_of",
]
