# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .energy_flow import EnergyFlow as EnergyFlow
from .flywheel_sizing import Flywheel as Flywheel
from .flywheel_sizing import flywheel as flywheel
from .motor import Motor as Motor
from .running import Running as Running
from .savings import DrivenComparison as DrivenComparison
from .steady_running import steady as steady
from .trajectory import Event as Event
from .trajectory import Trajectory as Trajectory
from .transient import coast as coast
from .transient import start as start
