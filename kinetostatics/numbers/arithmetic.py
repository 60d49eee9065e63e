"""Elementary functions of any number: NumPy, JAX and dask arrays, `arb` enclosures, recorded numbers.

The kernels take sin, exp, sqrt, clamped roots and compensated sums from here alone, so one source serves every engine.
Numbers of an engine have their own methods (`forgiving_root`, `kept_off_zero`, `total_with` ...).

`compensated_sum` is SumK with K = 3 (Ogita, Rump and Oishi, *Accurate sum and dot product*, SIAM J. Sci. Comput. 26,
2005) on Knuth's `two_sum`; `two_square` splits its argument as Veltkamp and Dekker do.
"""

import numpy as np

from ..errors import ParameterError

TURN = 2.0 * np.pi
"""Full turn, rad."""
_namespaces = dict.fromkeys((np.ndarray, np.float64, float, int), np)


def namespace(x):
    """Array namespace (array API standard) of `x`; NumPy for plain numbers."""
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


def concrete_array(x):
    """`x` as a NumPy array; None for traced numbers without a value, as in a derivative by JAX."""
    try:
        return np.asarray(x)
    except TypeError:
        return None


def where_zero(x):
    """Mask of the zeros of `x`; False for traced numbers."""
    known = concrete_array(x)
    return np.False_ if known is None else np.asarray(known == 0.0)


def read_only(array):
    """The array itself, locked against writing if it is a NumPy array: results are cached and returned again."""
    if isinstance(array, np.ndarray):
        array.flags.writeable = False
    return array


def sin(x):
    return namespace(x).sin(x)


def cos(x):
    return namespace(x).cos(x)


def sqrt(x):
    return namespace(x).sqrt(x)


def exp(x):
    return namespace(x).exp(x)


def log(x):
    """Natural logarithm; NaN of a negative number."""
    return namespace(x).log(x)


def atan(x):
    if _holds_objects(x):
        return np.frompyfunc(lambda part: part.arctan() if hasattr(part, "arctan") else part.atan(), 1, 1)(x)
    return x.atan() if hasattr(x, "atan") else namespace(x).atan(x)


_OBJECT = np.dtype(object)
UNIT_ROUNDOFF = 2.0**-53
"""Unit roundoff of double precision: largest relative error of one operation."""
SQUARE_TOLERANCE = 4e-15
"""Relative size of a negative square that `clamped_sqrt` takes for a rounding error."""
SPLITTER, SINGLE_SPLITTER = 2.0**27 + 1.0, 2.0**12 + 1.0
"""Factors that split a number in double or single precision into two halves (Veltkamp)."""
MAX_SUM_TERMS = 6
"""Largest number of terms of `compensated_sum`, in every engine."""
NEGLIGIBLE_LENGTH = 2.0**-310
"""Length, m, whose product with `RELATIVE_OFFSET` changes no digit of a distance in a machine."""
RELATIVE_OFFSET = 2.0**-90
"""Offset, in its unit, that gives a zero distance a direction and changes no digit of others."""


def clamped_sqrt(square, unit):
    """Root of a square, clamped to 0 where rounding makes the square negative, NaN where it is truly negative.

    `unit` is the size of the terms of the square: down to ``-SQUARE_TOLERANCE unit`` it counts as 0. NaN also where
    both underflow, because the sign of the square is then unknown.
    """
    if _holds_objects(square):
        return _call_method("forgiving_root", square, unit, lambda square: square.sqrt())
    xp = namespace(square)
    return xp.where(square > -SQUARE_TOLERANCE * unit, xp.sqrt(xp.maximum(square, 0.0 * unit)), xp.nan)


def guarded_divisor(root, unit):
    """The divisor ``max(root, unit)``: rates and forces stay finite at their poles."""
    if _holds_objects(root):
        return _call_method("kept_off_zero", root, unit, lambda root: root)
    return namespace(root).maximum(root, unit)


def sign(x):
    """1.0 or -1.0; a zero has the sign of its sign bit."""
    if _holds_objects(x):
        return np.frompyfunc(_sign_of_one, 1, 1)(x)
    xp = namespace(x)
    if xp is not np:
        return xp.where(x < 0, -1.0, 1.0)
    return np.copysign(1.0, x) if isinstance(x, np.ndarray | float | int) else _sign_of_one(x)


def _sign_of_one(x):
    return np.copysign(1.0, x) if isinstance(x, float | int) else x.sign() if hasattr(x, "sign") else x.sgn()


def stop_gradient(x):
    """The same number with zero derivatives, for values that do not change the solution to first order."""
    if _holds_objects(x):
        return np.frompyfunc(lambda part: part.held() if hasattr(part, "held") else part, 1, 1)(x)
    return x.held() if hasattr(x, "held") else x


def offset_from_zero(distance, unit):
    """A distance plus a negligible offset, so that zero has a direction too; enclosures are unchanged."""
    if _holds_objects(distance):
        return _call_method("moved_apart", distance, unit, lambda distance: distance)
    if not isinstance(distance, float | int) and not hasattr(distance, "dtype"):
        return distance.moved_apart(unit) if hasattr(distance, "moved_apart") else distance
    return distance + RELATIVE_OFFSET * unit


def compensated_sum(*terms):
    """Sum of up to six numbers, accurate as if rounded once, so cancellation loses no digits; None is skipped.

    Numbers of other kinds, such as enclosures, are summed plainly.
    """
    present = [term for term in terms if term is not None]
    if len(present) > MAX_SUM_TERMS:
        raise ParameterError(
            f"arithmetic.compensated_sum adds at most {MAX_SUM_TERMS} numbers, got {len(present)}; use two sums"
        )
    recorded = next((term for term in present if hasattr(term, "total_with")), None)
    if recorded is not None:
        return recorded.total_with(present) if len(present) > 1 else recorded
    if not _are_floats(present):
        return sum(present)
    *lost, whole = vector_sum(vector_sum(present))
    return whole + sum(lost)


def sum_corrections(*terms):
    """Sum of the magnitudes of the corrections in a `compensated_sum`; zero without rounding errors."""
    *parts, _ = vector_sum(vector_sum(terms))
    return sum(map(abs, parts))


def length_error(length, x, y):
    """Rounding error of the length of a vector (x, y): (x^2 + y^2 - l^2) / (2 l) with exact squares.

    In a `compensated_sum`, length plus error has no rounding error. The error has no derivatives: it is zero in exact
    arithmetic.
    """
    recorded = next((part for part in (length, x, y) if hasattr(part, "rest_with")), None)
    if recorded is not None:
        return recorded.rest_with(length, x, y)
    if not _are_floats((length, x, y)):
        return None
    return compensated_sum(*square_difference_terms(length, x, y)) / (2.0 * length)


def square_difference_terms(length, x, y):
    """Six terms whose exact sum is x^2 + y^2 - length^2."""
    (one, first), (two, second), (three, third) = map(two_square, (x, y, length))
    return one, first, two, second, -three, -third


def two_square(a, split=None):
    """Rounded square of a number, and its rounding error."""
    if split is None:
        split = SINGLE_SPLITTER if _is_single(a) else SPLITTER
    whole, spread = a * a, split * a
    high = spread - (spread - a)
    low = a - high
    return whole, ((high * high - whole) + 2.0 * high * low) + low * low


def _is_single(a):
    return getattr(getattr(a, "dtype", None), "itemsize", 8) == 4


def _are_floats(parts):
    return all(isinstance(part, float) or getattr(part, "dtype", _OBJECT) != _OBJECT for part in parts)


def vector_sum(terms):
    """Rounding error of each partial sum, then the last sum (VecSum)."""
    whole, lost = terms[0], []
    for term in terms[1:]:
        whole, rest = two_sum(whole, term)
        lost.append(rest)
    return *lost, whole


def two_sum(a, b):
    """Rounded sum of two numbers, and its rounding error (Knuth)."""
    whole = a + b
    part = whole - a
    return whole, (a - (whole - part)) + (b - part)


def _holds_objects(x):
    return getattr(x, "dtype", None) == _OBJECT


def _call_method(method, x, unit, exactly):
    """Values of a method of recorded numbers, element by element; of ``exactly(x)`` for numbers without it."""

    def of_one(x, unit):
        return getattr(x, method)(unit) if hasattr(x, method) else exactly(x)

    return np.frompyfunc(of_one, 2, 1)(x, unit)


def stack(arrays):
    """Arrays of one shape joined along a new first axis."""
    xp = namespace(arrays[0]) if arrays else np
    return np.array(arrays) if xp is np else xp.stack(arrays)  # np.stack takes three times as long
