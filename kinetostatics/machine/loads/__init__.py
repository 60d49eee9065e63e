"""Loads besides inertia: weight, forces, couples, springs, dampers, and tables of their values.

May import errors, numbers and the modules of `machine` that describe links and mechanisms.
"""

# ruff: noqa: F401 - other rooms import from here

from .balance_shaft import BalanceShaft, balance_shafts, loads_with_mass
from .dead_centres import dead_centres
from .gas_spring import GasSpring
from .gravity import Gravity
from .load import (
    Load,
    has_no_user_code,
    has_significant_kinks,
    kink_sources,
    kinks_of,
    period_on,
    refusals,
    significant_kinks,
    value_of,
)
from .points import Force, PointDamper, PointForce, PointSpring
from .slider import ProcessForce, Spring, spring_masses
from .table import DEAD_CENTRES, Table
from .table_pieces import KINK_TOLERANCE, MAX_TURNS, TURN, WholeTurns, period_of
from .torsion import Torque, TorsionDamper, TorsionSpring
from .work import Mowing, Sawing

KINDS = (
    *(Gravity, Spring, ProcessForce, Sawing, Mowing, GasSpring, Force, PointForce, PointSpring, PointDamper),
    *(Torque, BalanceShaft, TorsionSpring, TorsionDamper),
)
"""Every load of the library."""
