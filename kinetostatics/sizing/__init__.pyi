# Public names and where they are: read by type checkers, and by `numbers.lazy` to load each when first used.
from .bearings import bearing as bearing
from .bearings import equivalent_load as equivalent_load
from .bearings import plain_bearing as plain_bearing
from .result import Sized as Sized
