"""Batches of designs: arrays of shape (designs, 1) among the parameters, and the shape they give to every result."""

from dataclasses import fields, is_dataclass

import numpy as np


def batch_shape(parameters):
    """Common shape of all arrays with batch axes among parameters, looked for in dataclasses, tuples and lists.

    An array of one axis is a table (of a cam, of a load over the crank angles), not a batch.
    """
    return np.broadcast_shapes(*_shapes(parameters))


def _shapes(item):
    if is_dataclass(item):
        item = [getattr(item, field.name) for field in fields(item)]
    if isinstance(item, tuple | list):
        return [shape for part in item for shape in _shapes(part)]
    shape = getattr(item, "shape", ())
    return [shape] if len(shape) > 1 else []
