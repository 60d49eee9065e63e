# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .play import ContactLoss as ContactLoss
from .play import contact_loss as contact_loss
from .result import Sized as Sized
