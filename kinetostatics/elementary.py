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


def stack(arrays):
    """Arrays of one shape as one array, along a new first axis."""
    xp = namespace(arrays[0])
    return np.array(arrays) if xp is np else xp.stack(arrays)  # np.stack takes three times as long
