# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .result import Sized as Sized
from .scene_springs import BalancingSpring as BalancingSpring
from .scene_springs import spring_for as spring_for
from .scene_springs import spring_surge as spring_surge
from .springs import HelicalSpring as HelicalSpring
from .springs import SpringMaterial as SpringMaterial
from .springs import helical_spring as helical_spring
