"""sin, cos and sqrt of whatever array, or number, the caller brought.

The kernels take their elementary functions from here and from nowhere else, so one source of physics runs on NumPy,
on JAX, on dask, on object arrays of `arb` numbers and, with these three overloaded, inside numba.
"""

import numpy as np

_namespaces = dict.fromkeys((np.ndarray, np.float64, float, int), np)


def namespace(x):
    """Array namespace (array API standard) that `x` belongs to; NumPy for plain numbers."""
    kind = type(x)
    if kind not in _namespaces:
        from array_api_compat import array_namespace, is_array_api_obj

        _namespaces[kind] = array_namespace(x) if is_array_api_obj(x) else np
    return _namespaces[kind]


def is_foreign_array(x):
    """Whether `x` is an array of a library other than NumPy: JAX, dask, PyTorch ..."""
    if isinstance(x, np.ndarray | np.generic | float | int | list | tuple):
        return False
    from array_api_compat import is_array_api_obj

    return is_array_api_obj(x)


def read_only(array):
    """The array, locked against writing if it is NumPy's: results are kept and handed out again."""
    if isinstance(array, np.ndarray):
        array.flags.writeable = False
    return array


def sin(x):
    return namespace(x).sin(x)


def cos(x):
    return namespace(x).cos(x)


def sqrt(x):
    return namespace(x).sqrt(x)


_OBJECT = np.dtype(object)
ROUNDING = 4e-15
"""How far below zero, in its unit, a square counts as zero that rounding made negative."""
TINY = 2.0**-200
"""Smallest square, in its unit: its root may divide without making infinities and NaN; far below rounding."""


def root(square, unit):
    """Root of a square that counts in `unit`: finite where it is zero but for rounding, NaN where it is negative."""
    if getattr(square, "dtype", None) == _OBJECT:
        return np.frompyfunc(_root_of_object, 2, 1)(square, unit)
    xp = namespace(square)
    return xp.where(square >= -ROUNDING * unit, xp.sqrt(xp.maximum(square, TINY * unit)), xp.nan)


def _root_of_object(square, unit):
    if hasattr(square, "forgiving_root"):
        return square.forgiving_root(unit)
    return (TINY * unit if -ROUNDING * unit <= square < TINY * unit else square).sqrt()


def condition(margin, terms=None, result=None):
    """How many times errors are magnified where rates and forces are divided by a root whose square is `margin`.

    That makes 1 / margin. Where the `terms` of an acceleration cancel to a small `result`, as they do at change points,
    their errors stay: up to 1 / margin once more. A result below its own rounding counts as zero.
    """
    xp = namespace(margin)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = 1.0 / xp.where(margin < -ROUNDING, xp.nan, margin * (margin > 0))
        if terms is None:
            return found
        cancelled = terms / xp.maximum(abs(result) - ROUNDING * found * terms, 0.0)
        return found * xp.where(cancelled < found, cancelled, found)


def stack(arrays):
    """Arrays of one shape as one array, along a new first axis."""
    xp = namespace(arrays[0])
    return np.array(arrays) if xp is np else xp.stack(arrays)  # np.stack takes three times as long
