"""Machines under a motor: periodic running, flywheels, run-up and coast-down.

May import errors, numbers to solution.
"""

from .energy_flow import EnergyFlow
from .flywheel_sizing import Flywheel, flywheel
from .motor import Motor
from .running import Running
from .savings import DrivenComparison
from .steady_running import steady
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
