# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .foundation import Mount as Mount
from .foundation import block_for as block_for
from .foundation import mount as mount
from .parts import Part as Part
from .play import ContactLoss as ContactLoss
from .play import contact_loss as contact_loss
from .result import Sized as Sized
from .scene_springs import BalancingSpring as BalancingSpring
from .scene_springs import spring_for as spring_for
from .scene_springs import spring_surge as spring_surge
from .sections import bar_strength as bar_strength
from .sections import pin_strength as pin_strength
from .springs import HelicalSpring as HelicalSpring
from .springs import SpringMaterial as SpringMaterial
from .springs import helical_spring as helical_spring
