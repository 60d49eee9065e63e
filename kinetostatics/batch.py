"""Batches of designs: arrays of shape (designs, 1) among the parameters, and the shape they give to every result."""

from dataclasses import fields, is_dataclass
from functools import cached_property

import numpy as np


class Batched:
    """A dataclass of parameters, which may be arrays of designs."""

    @cached_property
    def batch(self):
        """Shape that arrays of designs among the parameters have in common; () for a single design.

        An array of one axis is a table (of a cam, of a load over the crank angles), not a batch.
        """
        return np.broadcast_shapes(*_shapes(self))


def _shapes(item):
    if is_dataclass(item):
        item = [getattr(item, field.name) for field in fields(item)]
    if isinstance(item, tuple | list):
        return [shape for part in item for shape in _shapes(part)]
    shape = getattr(item, "shape", ())
    return [shape] if len(shape) > 1 else []


def wider(shape, *parts):
    """Shape of results that depend on these parts too: numbers, arrays, or parameters with a `batch`."""
    more = [found for part in parts if (found := getattr(part, "batch", None) or getattr(part, "shape", ()))]
    return np.broadcast_shapes(shape, *more) if more else shape
