"""Numbers in two parts: a double, and what rounding took off it.

The second part is of first order: what rounding takes off *it* is some 2^-106 of the number, and is bounded along if
that is asked for. What a sum, product, quotient or root loses is found without error (Knuth; Veltkamp and Dekker; see
Muller et al. 2018, *Handbook of Floating-Point Arithmetic*, chapter 4).
"""

import numpy as np

from .elementary import SPLIT, UNIT, sum_and_rest
from .planar import number, plus, product

TINY = 2.0**-1000
"""More than what operations lose where a part is too small for a double."""
FARTHEST = 2.0**17
"""Crank angle, rad, up to which the multiple of pi / 16 next to it is taken off without error."""
CLEAR = 2.0**-20
"""Share of a number that its second part and error must stay below, to divide by it or take its root."""


class Twofold:
    """A number, or an array of them, in two parts, and a bound on how far their sum is from the exact one.

    Attributes
    ----------
    value : float or array
    rest : float or array or None
        None of a double that is exact.
    error : float or array or None
        None where no bound is asked for; 0 of what is exact.
    """

    __slots__ = ("_high", "error", "rest", "value")

    def __init__(self, value, rest=None, error=None):
        self.value, self.rest, self.error = value, rest, error
        self._high = None

    @property
    def high(self):
        """The first half of the digits of the value."""
        if self._high is None:
            spread = SPLIT * self.value
            self._high = spread - (spread - self.value)
        return self._high

    @property
    def off(self):
        """Bound on how far the value is from the exact number."""
        return number(self.error) + abs(number(self.rest))

    def _taken(self, other):
        """Another operand, which may be a plain number."""
        return other if isinstance(other, Twofold) else Twofold(other, None, None if self.error is None else 0.0)

    def __neg__(self):
        return Twofold(-self.value, None if self.rest is None else -self.rest, self.error)

    def __abs__(self):
        sign = np.copysign(1.0, self.value)
        return Twofold(abs(self.value), product(sign, self.rest), self.error)

    def __add__(self, other):
        other = self._taken(other)
        whole, lost = sum_and_rest(self.value, other.value)
        rest = plus(lost, plus(self.rest, other.rest))
        if self.error is None:
            return Twofold(whole, rest)
        rounding = 3.0 * UNIT * (abs(lost) + abs(number(self.rest)) + abs(number(other.rest)))
        return Twofold(whole, rest, self.error + other.error + rounding)

    __radd__ = __add__

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        other = self._taken(other)
        whole = self.value * other.value
        lost = _lost(self, other, whole)
        one, two = product(self.value, other.rest), product(other.value, self.rest)
        rest = plus(lost, plus(one, two))
        if self.error is None:
            return Twofold(whole, rest)
        error = abs(self.value) * other.error + abs(other.value) * self.error + self.off * other.off
        rounding = 4.0 * UNIT * (abs(lost) + abs(number(one)) + abs(number(two)))
        return Twofold(whole, rest, error + rounding + TINY)

    __rmul__ = __mul__

    def __rtruediv__(self, other):
        return self._taken(other) / self

    def __truediv__(self, other):
        other = self._taken(other)
        whole = np.divide(self.value, other.value)
        found = Twofold(whole)
        back = whole * other.value
        left = (self.value - back) - _lost(found, other, back)  # both differences are exact
        own = product(whole, other.rest)
        left = left + (number(self.rest) - number(own))
        rest = np.divide(left, other.value)
        if self.error is None:
            return Twofold(whole, rest)
        size = abs(other.value)
        rounding = 6.0 * UNIT * (abs(left) + abs(number(self.rest)) + abs(number(own)))
        error = (self.error + abs(whole) * other.error + rounding + abs(rest) * other.off) / (size - other.off)
        return Twofold(whole, rest, np.where(other.off < CLEAR * size, error + TINY, np.inf))

    def sqrt(self):
        whole = np.sqrt(self.value)
        found, back = Twofold(whole), whole * whole
        left = ((self.value - back) - _lost(found, found, back)) + number(self.rest)
        rest = np.divide(0.5 * left, whole)
        if self.error is None:
            return Twofold(whole, rest)
        curved = (abs(left) + self.error) * (abs(left) + self.error) / self.value
        error = (0.5 * self.error + 2.0 * UNIT * (abs(left) + abs(number(self.rest))) + 0.25 * curved) / whole + TINY
        return Twofold(whole, rest, np.where(self.off < CLEAR * self.value, error, np.inf))

    def kept_off_zero(self, unit):
        """The same where that is not less than the unit for certain; else nothing is known."""
        unit = self._taken(unit)
        if self.error is None:
            return Twofold(np.where(self.value > unit.value, self.value, np.nan), self.rest)
        least = self.value - self.off - unit.value - unit.off
        return Twofold(self.value, self.rest, np.where(least > 0.0, self.error, np.inf))

    def sign(self):
        found = np.copysign(1.0, self.value)
        if self.error is None:
            return Twofold(found)
        return Twofold(found, None, np.where(self.off < abs(self.value), 0.0, np.inf))


def sine_and_cosine(angle):
    """Of an angle in two parts, up to `FARTHEST`; beyond it nothing is known."""
    is_near = abs(angle.value) < FARTHEST
    turns = np.where(is_near, np.rint(angle.value * (1.0 / _STEP[0])), 0.0)
    first = angle.value - turns * _STEP[0]  # both exactly
    h, rest = sum_and_rest(first, -(turns * _STEP[1]))
    rest = np.where(is_near, (rest - turns * _STEP[2]) + number(angle.rest), np.nan)
    z = h * h
    odd, even = h * z * _polynomial(_ODD, z), z * z * _polynomial(_EVEN, z)
    small, known = Twofold(h, rest), angle.error is not None
    if known:
        small.error = np.where(is_near, angle.error + 2.0**-88, np.inf)
        off = abs(rest) + angle.error
        more = 2.0**-75 + (2.0**-23 + off) * off
    square = small * small
    halved = Twofold(-0.5 * square.value, -0.5 * square.rest, 0.5 * square.error if known else None)
    sine = small + Twofold(
        odd, (z * z * (1.0 / 24.0) - 0.5 * z) * rest, 8.0 * UNIT * abs(odd) + more if known else None
    )
    cosine = Twofold(1.0, None, 0.0 if known else None) + halved
    cosine = cosine + Twofold(even, h * z * (1.0 / 6.0) * rest, 8.0 * UNIT * abs(even) + more if known else None)
    place = np.asarray(turns % 32.0, dtype=int)
    s, c = (Twofold(_SINES[0, at], _SINES[1, at], 2.0**-105 if known else None) for at in (place, place + 8))
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
