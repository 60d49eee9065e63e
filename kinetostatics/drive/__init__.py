"""The machine under its real drive: motors, periodic running, flywheels, starting and coasting.

May import all rooms above: numbers to solution.

motor         motors: torque over speed at their own shaft
one_dof       the scene as one degree of freedom: reduced inertia, load and friction torque
senses        senses of motion of joints with friction over the crank angle
pieces        functions of the crank angle as Chebyshev series between their kinks
bends         crank angles at which friction has kinks
resolution    pieces that resolve a machine's inertia and load torque
running       a machine in periodic running: speed, powers, energies, solution
energy_flow   energies of a turn by source, loss, load, joint and store
savings       tables of running, and two machines compared
steady        exact periodic running under a motor or a constant torque
flywheel      flywheels for a coefficient of fluctuation
stick_slip    motion over time with friction, stretch by stretch
trajectory    motion over time
transient     starting and coasting
"""

from .energy_flow import EnergyFlow
from .flywheel import Flywheel, flywheel
from .motor import Motor
from .running import Running
from .savings import DrivenComparison
from .steady import steady
from .trajectory import Event, Trajectory
from .transient import coast, start

__all__ = [
    "DrivenComparison",
    "EnergyFlow",
    "Event",
    "Flywheel",
    "Motor",
    "Running",
    "Trajectory",
    "coast",
    "flywheel",
    "start",
    "steady",
]


def __dir__():
    return __all__
