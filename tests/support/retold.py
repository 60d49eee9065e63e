"""A hand calculation done again from nothing but what it shows: its formulas as text, and the numbers given."""

import math
import re

import numpy as np

NAME = re.compile(r"(?<![\w.])[A-Za-z][\w.]*'*")
FOUND_TOGETHER = "solved together"


class Sized:
    """A number, and a bound to first order of its error: as many roundings as it comes of, each in units of 2^-53."""

    def __init__(self, value, size=0.0):
        self.value = float(value)
        self.size = float(size) + abs(self.value)

    def __add__(self, other):
        other = _sized(other)
        return Sized(self.value + other.value, self.size + other.size)

    def __sub__(self, other):
        return self + -_sized(other)

    def __neg__(self):
        return Sized(-self.value, self.size)

    def __mul__(self, other):
        other = _sized(other)
        return Sized(self.value * other.value, self.size * abs(other.value) + abs(self.value) * other.size)

    def __truediv__(self, other):
        other = _sized(other)
        quotient = float(np.divide(self.value, other.value))
        return Sized(quotient, np.divide(self.size + abs(quotient) * other.size, abs(other.value)))

    def __pow__(self, count):
        return Sized(self.value**count, count * abs(self.value) ** (count - 1) * self.size)

    def __abs__(self):
        return Sized(abs(self.value), self.size)

    def __radd__(self, other):
        return _sized(other) + self

    def __rsub__(self, other):
        return _sized(other) - self

    def __rmul__(self, other):
        return _sized(other) * self

    def __rtruediv__(self, other):
        return _sized(other) / self


def _sized(number):
    return number if isinstance(number, Sized) else Sized(number)


def _root(number):
    number = _sized(number)
    value = math.sqrt(max(number.value, 0.0))
    return Sized(value, number.size / (2.0 * max(value, 1e-8 * math.sqrt(number.size))))


FUNCTIONS = {
    "sqrt": _root,
    "sin": lambda angle: Sized(math.sin(_sized(angle).value), _sized(angle).size),
    "cos": lambda angle: Sized(math.cos(_sized(angle).value), _sized(angle).size),
    "atan": lambda slope: Sized(math.atan(_sized(slope).value), _sized(slope).size),
    "exp": lambda power: Sized(math.exp(_sized(power).value), math.exp(_sized(power).value) * _sized(power).size),
    "log": lambda number: Sized(math.log(_sized(number).value), _sized(number).size / abs(_sized(number).value)),
    "abs": abs,
    "sign": lambda number: Sized(math.copysign(1.0, _sized(number).value)),
    "max": lambda one, other: max(_sized(one), _sized(other), key=lambda number: number.value),
}


def evaluated(formula, known):
    """Value of a formula as text, with the values of symbols; a `Sized`."""
    source = NAME.sub(lambda found: f"known[{found[0]!r}]" if found[0] not in FUNCTIONS else found[0], formula)
    return _sized(eval(source.replace("^", "**"), {"known": known, **FUNCTIONS}))


def largest_error(told, chained=False):
    """Largest error of a step beside its own formula, relative to what each rounding may change.

    Numbers in formulas are those given, and values of steps before; `chained`: as computed here, from those given
    alone. Friction that is found by iteration is taken as shown, and its law looked at in the end.
    """
    known, laws, worst = {}, [], 0.0
    for step in told.steps:
        assert step.symbol not in known, f"{step.symbol} stands twice"
        known[step.symbol] = Sized(step.value)
        if FOUND_TOGETHER in step.words:
            laws.append(step)
        elif step.formula:
            before = {symbol: value for symbol, value in known.items() if symbol != step.symbol}
            found = evaluated(step.formula, before)
            worst = max(worst, _error(found, step.value))
            if chained:
                known[step.symbol] = found
    return max([worst, *(_error(evaluated(step.formula, known), step.value) / 100 for step in laws)])


def _error(found, value):
    if math.isnan(value) or math.isinf(value):
        return 0.0 if math.isnan(found.value) or found.value == value else math.inf
    return 0.0 if found.value == value else abs(found.value - value) / max(found.size, abs(value))
