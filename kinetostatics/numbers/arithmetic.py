"""sin, cos and sqrt of whatever array, or number, the caller brought.

The kernels take their elementary functions from here and from nowhere else, so one source of physics runs on NumPy,
on JAX, on dask, on object arrays of `arb` numbers and, with these three overloaded, inside numba.
"""

import numpy as np

from ..errors import ParameterError

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


def concrete_array(x):
    """Numbers as a NumPy array; None where a library traces them, as JAX does for a derivative, and shows no value."""
    try:
        return np.asarray(x)
    except TypeError:
        return None


def where_zero(x):
    """Where numbers are 0; nowhere if their values are not known."""
    known = concrete_array(x)
    return np.False_ if known is None else np.asarray(known == 0.0)


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


def atan(x):
    if _holds_objects(x):
        return np.frompyfunc(lambda part: part.arctan() if hasattr(part, "arctan") else part.atan(), 1, 1)(x)
    return x.atan() if hasattr(x, "atan") else namespace(x).atan(x)


_OBJECT = np.dtype(object)
UNIT_ROUNDOFF = 2.0**-53
"""Largest relative error of one rounding in double precision."""
SQUARE_TOLERANCE = 4e-15
"""How far below zero, in its unit, a square counts as zero that rounding made negative."""
SPLITTER, SINGLE_SPLITTER = 2.0**27 + 1.0, 2.0**12 + 1.0
"""Factors by which a number, in double or single precision, is split into two of half as many digits."""
MAX_SUM_TERMS = 6
"""Numbers that `total` takes, in every engine."""
NEGLIGIBLE_LENGTH = 2.0**-310
"""Unit, m, of which what counts as nothing changes no digit of any other distance."""
RELATIVE_OFFSET = 2.0**-90
"""Distance, in its unit, that counts as nothing but still has a direction."""


def clamped_sqrt(square, unit):
    """Root of a square that counts in `unit`; NaN where that is negative by more than rounding.

    NaN also where both are too small for the precision: no sign is known of such a square.
    """
    if _holds_objects(square):
        return _call_method("forgiving_root", square, unit, lambda square: square.sqrt())
    xp = namespace(square)
    return xp.where(square > -SQUARE_TOLERANCE * unit, xp.sqrt(xp.maximum(square, 0.0 * unit)), xp.nan)


def guarded_divisor(root, unit):
    """A root to divide by, not smaller than `unit`: rates and forces stay finite at their poles."""
    if _holds_objects(root):
        return _call_method("kept_off_zero", root, unit, lambda root: root)
    return namespace(root).maximum(root, unit)


def sign(x):
    """1.0 or -1.0, also of zero, which counts as approached from the side of its own sign."""
    if _holds_objects(x):
        return np.frompyfunc(_sign_of_one, 1, 1)(x)
    xp = namespace(x)
    if xp is not np:
        return xp.where(x < 0, -1.0, 1.0)
    return np.copysign(1.0, x) if isinstance(x, np.ndarray | float | int) else _sign_of_one(x)


def _sign_of_one(x):
    """Of a recorded number or an enclosure; of a plain one among them too."""
    return np.copysign(1.0, x) if isinstance(x, float | int) else x.sign() if hasattr(x, "sign") else x.sgn()


def stop_gradient(x):
    """The same number, whose derivatives count as zero: for what a solution does not change with to first order."""
    if _holds_objects(x):
        return np.frompyfunc(lambda part: part.held() if hasattr(part, "held") else part, 1, 1)(x)
    return x.held() if hasattr(x, "held") else x


def offset_from_zero(distance, unit):
    """A distance moved off zero by nothing that counts, so that it has a direction; an enclosure is left alone."""
    if _holds_objects(distance):
        return _call_method("moved_apart", distance, unit, lambda distance: distance)
    if not isinstance(distance, float | int) and not hasattr(distance, "dtype"):
        return distance.moved_apart(unit) if hasattr(distance, "moved_apart") else distance
    return distance + RELATIVE_OFFSET * unit


def compensated_sum(*terms):
    """Sum of up to six numbers, rounded as if once: what cancels leaves the digits that the numbers have.

    What each sum loses is found exactly, twice (Ogita, Rump and Oishi 2005, *Accurate sum and dot product*, SumK).
    Absent numbers are none. Enclosures and others of any precision need no help from rounding.
    """
    present = [term for term in terms if term is not None]
    if len(present) > MAX_SUM_TERMS:
        raise ParameterError(
            f"arithmetic.total takes {MAX_SUM_TERMS} numbers at most, got {len(present)}; make two of it"
        )
    recorded = next((term for term in present if hasattr(term, "total_with")), None)
    if recorded is not None:
        return recorded.total_with(present) if len(present) > 1 else recorded
    if not _are_floats(present):
        return sum(present)
    *lost, whole = vector_sum(vector_sum(present))
    return whole + sum(lost)


def sum_corrections(*terms):
    """Magnitudes of what a `total` adds up at last beside the sum; zero where that has not lost anything."""
    *parts, _ = vector_sum(vector_sum(terms))
    return sum(map(abs, parts))


def length_error(length, x, y):
    """What rounding took off the length of a vector: with it in a `total` that is as if exact.

    In exact arithmetic there is none, so it has no derivatives. The squares are taken in two parts (Veltkamp, Dekker).
    """
    recorded = next((part for part in (length, x, y) if hasattr(part, "rest_with")), None)
    if recorded is not None:
        return recorded.rest_with(length, x, y)
    if not _are_floats((length, x, y)):
        return None
    return compensated_sum(*square_difference_terms(length, x, y)) / (2.0 * length)


def square_difference_terms(length, x, y):
    """Terms of what the square of a length lacks of that of a vector, exactly."""
    (one, first), (two, second), (three, third) = map(two_square, (x, y, length))
    return one, first, two, second, -three, -third


def two_square(a, split=None):
    """Square of a number, rounded, and what that lost."""
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
    """What each sum of terms one after the other loses, and the last sum."""
    whole, lost = terms[0], []
    for term in terms[1:]:
        whole, rest = two_sum(whole, term)
        lost.append(rest)
    return *lost, whole


def two_sum(a, b):
    """Sum of two numbers, and what it loses by rounding (Knuth)."""
    whole = a + b
    part = whole - a
    return whole, (a - (whole - part)) + (b - part)


def _holds_objects(x):
    return getattr(x, "dtype", None) == _OBJECT


def _call_method(method, x, unit, exactly):
    """Apply a method of recorded numbers; enclosures and others of any precision need no help from rounding."""

    def of_one(x, unit):
        return getattr(x, method)(unit) if hasattr(x, method) else exactly(x)

    return np.frompyfunc(of_one, 2, 1)(x, unit)


def stack(arrays):
    """Arrays of one shape as one array, along a new first axis."""
    xp = namespace(arrays[0]) if arrays else np
    return np.array(arrays) if xp is np else xp.stack(arrays)  # np.stack takes three times as long
