"""Batches of designs: arrays of shape (designs, 1) among the parameters, and the shape they give to every result."""

from dataclasses import fields, is_dataclass
from functools import cached_property

import numpy as np

from .checks import fitting, require


class Batched:
    """A dataclass of parameters, which may be arrays of designs."""

    @cached_property
    def batch(self):
        """Shape that arrays of designs among the parameters have in common; () for a single design.

        An array of one axis is a table (of a cam, of a load over the crank angles), not a batch.
        """
        shapes = dict(_shapes(self, ()))
        require(type(self).__name__, fitting(**{" ".join(path): shape for path, shape in shapes.items()}))
        return np.broadcast_shapes(*shapes.values())


def _shapes(item, path):
    """Path and shape of each array of designs."""
    if is_dataclass(item):
        for field in fields(item):
            yield from _shapes(getattr(item, field.name), (*path, field.name))
    elif isinstance(item, tuple | list):
        for number, part in enumerate(item, 1):
            yield from _shapes(part, (*path, str(number)))
    elif len(shape := getattr(item, "shape", ())) > 1:
        yield path, shape


def wider(shape, *parts):
    """Shape of results that depend on these parts too: numbers, arrays, or parameters with a `batch`."""
    more = [found for part in parts if (found := getattr(part, "batch", None) or getattr(part, "shape", ()))]
    return np.broadcast_shapes(shape, *more) if more else shape
