"""Numbers in two parts: a double, and what rounding took off it.

The second part is of first order: what rounding takes off *it* is some 2^-106 of what led to the number. What a sum,
product, quotient or root loses is found without error (Knuth; Veltkamp and Dekker; see Muller et al. 2018, *Handbook of
Floating-Point Arithmetic*, chapter 4).
"""

import numpy as np

from .elementary import SPLIT, sum_and_rest
from .planar import number, plus, product

FARTHEST = 2.0**17
"""Crank angle, rad, up to which the multiple of pi / 16 next to it is taken off without error."""


class Twofold:
    """A number, or an array of them, in two parts.

    Attributes
    ----------
    value : float or array
    rest : float or array or None
        None of a double that is exact.
    """

    __slots__ = ("_high", "rest", "value")

    def __init__(self, value, rest=None):
        self.value, self.rest = value, rest
        self._high = None

    @property
    def high(self):
        """The first half of the digits of the value."""
        if self._high is None:
            spread = SPLIT * self.value
            self._high = spread - (spread - self.value)
        return self._high

    def __neg__(self):
        return Twofold(-self.value, None if self.rest is None else -self.rest)

    def __abs__(self):
        return Twofold(abs(self.value), product(np.copysign(1.0, self.value), self.rest))

    def __add__(self, other):
        other = _taken(other)
        whole, lost = sum_and_rest(self.value, other.value)
        return Twofold(whole, plus(lost, plus(self.rest, other.rest)))

    __radd__ = __add__

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        other = _taken(other)
        whole = self.value * other.value
        one, two = product(self.value, other.rest), product(other.value, self.rest)
        return Twofold(whole, plus(_lost(self, other, whole), plus(one, two)))

    __rmul__ = __mul__

    def __rtruediv__(self, other):
        return _taken(other) / self

    def __truediv__(self, other):
        other = _taken(other)
        whole = np.divide(self.value, other.value)
        back = whole * other.value
        left = (self.value - back) - _lost(Twofold(whole), other, back)  # both differences are exact
        left = left + (number(self.rest) - number(product(whole, other.rest)))
        return Twofold(whole, np.divide(left, other.value))

    def sqrt(self):
        whole = np.sqrt(self.value)
        found, back = Twofold(whole), whole * whole
        left = ((self.value - back) - _lost(found, found, back)) + number(self.rest)
        return Twofold(whole, np.divide(0.5 * left, whole))

    def kept_off_zero(self, unit):
        """The same where that is more than the unit; else nothing is known."""
        return Twofold(np.where(self.value > _taken(unit).value, self.value, np.nan), self.rest)

    def sign(self):
        return Twofold(np.copysign(1.0, self.value))


def _taken(other):
    """Another operand, which may be a plain number."""
    return other if isinstance(other, Twofold) else Twofold(other)


def sine_and_cosine(angle):
    """Of an angle in two parts, off by less than 2^-63 more up to `FARTHEST`; beyond it nothing is known."""
    is_near = abs(angle.value) < FARTHEST
    turns = np.where(is_near, np.rint(angle.value * (1.0 / _STEP[0])), 0.0)
    first = angle.value - turns * _STEP[0]  # both exactly
    h, rest = sum_and_rest(first, -(turns * _STEP[1]))
    rest = np.where(is_near, (rest - turns * _STEP[2]) + number(angle.rest), np.nan)
    z = h * h
    odd, even = h * z * _polynomial(_ODD, z), z * z * _polynomial(_EVEN, z)
    small = Twofold(h, rest)
    square = small * small
    halved = Twofold(-0.5 * square.value, -0.5 * square.rest)
    sine = small + Twofold(odd, (z * z * (1.0 / 24.0) - 0.5 * z) * rest)
    cosine = Twofold(1.0) + halved + Twofold(even, h * z * (1.0 / 6.0) * rest)
    place = np.asarray(turns % 32.0, dtype=int)
    s, c = (Twofold(_SINES[0, at], _SINES[1, at]) for at in (place, place + 8))
    return s * cosine + c * sine, c * cosine - s * sine


def _polynomial(coefficients, z):
    found = coefficients[0]
    for coefficient in coefficients[1:]:
        found = found * z + coefficient
    return found


def _lost(one, other, whole):
    """What a product lost."""
    a, b = one.high, other.high
    c, d = one.value - a, other.value - b
    return ((a * b - whole) + a * d + c * b) + c * d


_STEP = 0.1963495408417657, 7.596375632879957e-12, 2.5278328109949383e-22
"""pi / 16 in three parts, of which the first two have 33 digits."""
_ODD = -1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0
"""Of the powers of z in (sin(h) / h - 1) / z, z = h^2, up to h = pi / 32: the next makes 2^-76."""
_EVEN = 1.0 / 479001600.0, -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0, 1.0 / 24.0
"""Of those in ((cos(h) - 1) / z + 1 / 2) / z."""
_QUARTER = (
    (0.0, 0.0),
    (0.19509032201612828, -7.991079068461731e-18),
    (0.3826834323650898, -1.0050772696461588e-17),
    (0.5555702330196022, 4.709410940561677e-17),
    (0.7071067811865476, -4.833646656726457e-17),
    (0.8314696123025452, 1.4073856984728024e-18),
    (0.9238795325112867, 1.7645047084336677e-17),
    (0.9807852804032304, 1.8546939997825006e-17),
    (1.0, 0.0),
)
"""Sines of 0, pi / 16 ... pi / 2, each in two parts."""
_HALF = [*_QUARTER, *_QUARTER[-2:0:-1]]
_SINES = np.array([*_HALF, *[(-value, -rest) for value, rest in _HALF], *_HALF[:8]]).T
