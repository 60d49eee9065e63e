# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .result import Sized as Sized
