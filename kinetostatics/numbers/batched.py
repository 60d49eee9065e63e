"""Parameters that may be arrays of designs, and the shape that these have in common."""

import numpy as np

from ..errors import ParameterError
from .checks import fitting
from .lazy import cached_property
from .leaves import Leaves, wider
from .paths import places
from .structures import taken_apart


class Batched:
    """A dataclass of parameters, which may be arrays of designs."""

    @cached_property
    def batch(self):
        """Shape that arrays of designs among the parameters have in common; () for a single design.

        An array of one axis is a table (of a cam, of a load over the crank angles), not a batch.
        """
        leaves = Leaves()
        taken_apart(self, leaves)
        try:
            return wider((), *(leaf for leaf in (*leaves.numbers, *leaves.tables) if np.ndim(leaf) > 1))
        except ValueError:
            raise _unfitting(self) from None


def _unfitting(item):
    """Error that names the arrays of designs in an item, which do not fit together."""
    shapes = {path: np.shape(place.value(item)) for path, place in places(item).items()}
    problem = fitting(**{path: shape for path, shape in shapes.items() if len(shape) > 1})
    return ParameterError(f"{getattr(item, 'name', type(item).__name__)}: {problem}")
