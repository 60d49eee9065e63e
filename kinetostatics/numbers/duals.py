"""Numbers that carry their derivatives along: forward differentiation by however many seeds."""

from functools import reduce

import numpy as np

from .elementary import APART, ROUNDING, rest, total
from .nothing import Nothing

OTHERS = (np.ndarray, Nothing)
"""What arithmetic is left to."""


class Dual:
    """Values at some crank angles (B,) or one for all, with derivatives by the seeds (seeds, B); None: they are zero.

    What kernels do with the elements of object arrays, as with recorded numbers (`engines.graph`).
    """

    __slots__ = ("slopes", "value")

    def __init__(self, value, slopes=None):
        self.value, self.slopes = value, slopes

    def _chained(self, value, factor):
        return Dual(value, None if self.slopes is None else self.slopes * factor)

    def __add__(self, other):
        if isinstance(other, OTHERS):
            return NotImplemented
        other = dual(other)
        return Dual(self.value + other.value, _sum(self.slopes, other.slopes))

    __radd__ = __add__

    def __neg__(self):
        return self._chained(-self.value, -1.0)

    def __sub__(self, other):
        return NotImplemented if isinstance(other, OTHERS) else self + -dual(other)

    def __rsub__(self, other):
        return NotImplemented if isinstance(other, OTHERS) else -self + other

    def __mul__(self, other):
        if isinstance(other, OTHERS):
            return NotImplemented
        other = dual(other)
        value = self.value * other.value
        return Dual(value, _sum(_scaled(self.slopes, other.value), _scaled(other.slopes, self.value)))

    __rmul__ = __mul__

    def __truediv__(self, other):
        if isinstance(other, OTHERS):
            return NotImplemented
        other = dual(other)
        value = np.divide(self.value, other.value)
        return Dual(
            value, _sum(_scaled(self.slopes, np.divide(1.0, other.value)), _scaled(other.slopes, -value / other.value))
        )

    def __rtruediv__(self, other):
        return NotImplemented if isinstance(other, OTHERS) else dual(other) / self

    def __pow__(self, exponent):
        if exponent != 2:
            raise TypeError(f"only squares are differentiated, not powers of {exponent}")
        return self * self

    def __abs__(self):
        return self._chained(np.abs(self.value), np.copysign(1.0, self.value))

    def sin(self):
        """Called by `numpy.sin` for an array of objects, as `cos`, `sqrt` and `arctan` are."""
        return self._chained(np.sin(self.value), np.cos(self.value))

    def cos(self):
        return self._chained(np.cos(self.value), -np.sin(self.value))

    def sqrt(self):
        root = np.sqrt(self.value)
        return self._chained(root, np.divide(0.5, root))

    def arctan(self):
        return self._chained(np.arctan(self.value), 1.0 / (1.0 + self.value * self.value))

    def sign(self):
        """Called by `elementary.sign`."""
        return Dual(np.copysign(1.0, self.value))

    def held(self):
        """Called by `elementary.held`."""
        return Dual(self.value)

    def forgiving_root(self, unit):
        """Called by `elementary.root`, as the next two by `divisor` and `apart`."""
        closed = self.value > -ROUNDING * dual(unit).value
        root = np.where(closed, np.sqrt(np.maximum(self.value, 0.0)), np.nan)
        return self._chained(root, np.divide(0.5, root))

    def kept_off_zero(self, unit):
        return Dual(np.maximum(self.value, dual(unit).value), self.slopes)

    def moved_apart(self, unit):
        return self + APART * unit

    def total_with(self, terms):
        """Called by `elementary.total`."""
        parts = [dual(term) for term in terms]
        return Dual(total(*(part.value for part in parts)), reduce(_sum, (part.slopes for part in parts)))

    def rest_with(self, length, x, y):
        """Called by `elementary.rest`."""
        return Dual(rest(*(dual(part).value for part in (length, x, y))))

    def _one(self):
        if np.size(self.value) != 1:
            raise TypeError("a kernel that looks at values takes one crank angle at a time")
        return float(np.ravel(self.value)[0])

    __float__ = _one

    def __bool__(self):
        return bool(self._one())

    def __lt__(self, other):
        return self._one() < float(other)

    def __le__(self, other):
        return self._one() <= float(other)

    def __gt__(self, other):
        return self._one() > float(other)

    def __ge__(self, other):
        return self._one() >= float(other)


def dual(value):
    """A plain value as one of them, all its derivatives zero."""
    return value if isinstance(value, Dual) else Dual(value)


def _sum(a, b):
    if a is None or b is None:
        return a if b is None else b
    return a + b


def _scaled(slopes, factor):
    return None if slopes is None else slopes * factor
