"""The machine under its real drive: motors, periodic running, flywheels, starting and coasting.

May import all rooms above: numbers to solution.

motor       motors: torque over speed at their own shaft
driven      the one degree of freedom: reduced inertia and load torque of a scene by crank angle and speed
pieces      functions of the crank angle as Chebyshev series between their kinks
periodic    exact periodic running
running     its solution, for all that looks at solutions
sizing      flywheels for a coefficient of fluctuation
transient   starting and coasting over time
"""

from .motor import Motor
from .periodic import Running, steady
from .sizing import Flywheel, flywheel
from .transient import Event, Trajectory, coast, start

__all__ = ["Event", "Flywheel", "Motor", "Running", "Trajectory", "coast", "flywheel", "start", "steady"]
