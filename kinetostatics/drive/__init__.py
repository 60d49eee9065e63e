"""The machine under its real drive: motors, periodic running, flywheels, starting and coasting.

May import all rooms above: numbers to solution.

motor       motors: torque over speed at their own shaft
driven      the one degree of freedom: reduced inertia and load torque of a scene by crank angle and speed
senses      which way joints that rub move, over the crank angle
rubbing     the one degree of freedom with friction, which depends on the acceleration
pieces      functions of the crank angle as Chebyshev series between their kinks
bends       crank angles at which friction has kinks
resolution  pieces that resolve a machine's inertia and load torque
operating   the speed at which mean torques agree
newton      Newton's iteration on the energy of running
following   running found by following a machine from above
energy_flow where the energy of a turn goes
search      the flywheel with which a machine runs as evenly as is asked
saving      two machines in periodic running compared: what balancing saves
running_solution its solution at the true speed, for all that looks at solutions
powers      what its motor gives and what takes it
running     a machine in periodic running
periodic    exact periodic running, by all of these
summary     what running comes to, in one table
sizing      flywheels for a coefficient of fluctuation
trajectory  motion over time
stretches   motion over time with friction, stretch by stretch
standstill  whether coasting ends
transient   starting and coasting
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
