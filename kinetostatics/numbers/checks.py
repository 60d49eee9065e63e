"""Checks of the values a user hands in. Kernels trust what has passed here.

A dataclass that is `Checked` says what its fields must be by a table of rules, field -> rule. Where every value is a
plain number in range nothing more is looked at; otherwise each is examined, all that is wrong is said at once, and the
object keeps floats and locked copies of arrays, so nothing it holds changes behind its back. A traced JAX number or an
`arb` enclosure passes as it is.
"""

import datetime as dt
import math
import numbers
from copy import copy
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any, ClassVar

import numpy as np

from ..errors import ParameterError
from .content import LIBRARY

HUGE, LONG = 1e150, 1e75
"""Sizes that double precision cannot square, and lengths (and their reciprocals) that it cannot twice."""
PLAIN = (int, float, np.integer, np.floating, Fraction, Decimal)
UNSURE: Any = object()
"""What a quick look at a value answers if it must be examined."""


class Problem(str):
    """What is wrong with a value, as a sentence; `designs` tells which of a batch have it, None all."""

    designs: Any

    def __new__(cls, text, wrong=None):
        made = super().__new__(cls, text)
        made.designs = wrong[..., 0] if np.ndim(wrong) > 1 else None
        return made


class _UnfitError(Exception):
    """A value that is no number; the message says what it is and what to hand in."""


# What a value is


def known(value):
    """Whether the values can be looked at now."""
    if isinstance(value, np.ndarray):
        return value.dtype != object
    return value is None or isinstance(value, numbers.Real | str | list | tuple)


@cache
def _unfit(kind: Any):
    """Why no value of this type is a number, and what to hand in; None if it may be one."""
    for kinds, words in (
        ((bool, np.bool_), "a truth value; give a number"),
        ((complex, np.complexfloating), "a complex number; give a real one"),
        ((str, bytes), "a text; write a plain number in SI units, without quotes"),
        ((dt.date, dt.time, dt.timedelta, np.timedelta64), "a time; give a number in SI units"),
    ):
        if issubclass(kind, kinds):
            return words
    if issubclass(kind, PLAIN) or kind in (np.ndarray, list, tuple):
        return None
    if hasattr(kind, "units") or hasattr(kind, "unit"):
        return "a quantity with its unit; give the plain number in SI units, as by .to('{unit}').magnitude"
    if hasattr(kind, "to_numpy"):
        return "a labelled table; give its numbers, .to_numpy(), and as .to_numpy()[:, None] for a batch of designs"
    if issubclass(kind, np.ma.MaskedArray):
        return "a masked array; give a plain one, .filled(...)"
    if issubclass(kind, np.ndarray):
        return None
    arithmetic = all(hasattr(kind, f"__{name}__") for name in ("add", "sub", "mul", "truediv", "neg"))
    return None if arithmetic and not issubclass(kind, np.generic) else "no number"


def unfit(value):
    """Why a value is no number, and what to hand in; None if it may be one."""
    return _unfit(type(value))


def shown(value):
    """How a value looks, short enough for a message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 120 else f"{text[:80]} ... {text[-20:]}"


def _number(value, table):
    """The value as a float or a locked array of floats; as it came if its values cannot be looked at now."""
    if table and hasattr(value, "to_numpy") and np.ndim(value) == 1:
        value = value.to_numpy()
    if words := _unfit(type(value)):
        raise _UnfitError(words)
    if isinstance(value, PLAIN):
        try:
            return float(value)
        except OverflowError:
            raise _UnfitError("too large") from None
    if isinstance(value, list | tuple):
        if not table:
            raise _UnfitError("")
        value = _array(value)
    elif isinstance(value, np.ndarray):
        value = np.asarray(value)
    shape = tuple(getattr(value, "shape", ()))
    if 0 in shape:
        raise _UnfitError(f"of shape {shape}, which holds nothing")
    if not table and shape not in ((), (1,)) and (len(shape) < 2 or shape[-1] != 1):
        raise _UnfitError(f"of shape {shape}; its last axis would be the crank angle, add one of length 1: [..., None]")
    if shape == () or (shape == (1,) and not table):
        return _number(value.ravel()[0], table) if isinstance(value, np.ndarray) else value
    return _locked(value) if isinstance(value, np.ndarray) else value


def _array(values):
    """The items of a list as an array."""
    for kind in set(map(type, values)):
        if words := _unfit(kind):
            raise _UnfitError(f"with {words}")
    try:
        return np.array(values)
    except ValueError:
        raise _UnfitError("of rows of unequal length") from None


def _locked(array):
    """A copy of an array as floats that nobody writes to; of objects if they are numbers of another kind."""
    if array.dtype == float and array.flags.owndata and not array.flags.writeable:
        return array
    kind: type = float
    if array.dtype == object:
        kinds = set(map(type, array.flat))
        for item in kinds:
            if words := _unfit(item):
                raise _UnfitError(f"with {words}")
        kind = float if all(issubclass(item, PLAIN) for item in kinds) else object
    elif array.dtype.kind not in "iuf":
        raise _UnfitError(f"of {array.dtype}; give real numbers")
    array = array.astype(kind)
    array.flags.writeable = False
    return array


def kept(item):
    """An object of the user's own as it is now: what is changed of it later is not seen."""
    values = getattr(item, "__dict__", {})
    arrays = {name: part.copy() for name, part in values.items() if isinstance(part, np.ndarray)}
    frozen = getattr(type(item), "__dataclass_params__", None)
    if not arrays and (not values or (frozen is not None and frozen.frozen)):
        return item
    item = copy(item)
    vars(item).update(arrays)
    return item


# Rules: what a field must be


@dataclass(frozen=True)
class Number:
    """A number, or an array (designs, 1) of them; as a `table`, one for each crank angle.

    A rule has ``quick(value)``, which answers what to keep or `UNSURE`, and ``taken(value, field)``, which gives what
    to keep and what is wrong with it, if anything, as a sentence.
    """

    unit: str = ""
    name: str = ""
    low: float | None = None
    strict: bool = False
    table: bool = False

    above: float = dataclass_field(init=False)
    below: float = dataclass_field(init=False)

    def __post_init__(self):
        above = -HUGE if self.low is None else 1.0 / LONG if self.strict else math.nextafter(self.low, -1.0)
        object.__setattr__(self, "above", above)
        object.__setattr__(self, "below", LONG if self.strict else HUGE)

    def quick(self, value):
        if type(value) is float and self.above < value < self.below:
            return value
        return float(value) if type(value) is int and self.above < value < self.below else UNSURE

    def taken(self, value, field=""):
        name = self.name or field
        try:
            number = _number(value, self.table)
        except _UnfitError as fault:
            words = f", {fault}".format(unit=self.unit or "1") if str(fault) else ""
            kind = "an array of numbers" if self.table else "an array of shape (designs, 1)"
            return value, f"{name} must be a number or {kind}, got {shown(value)}{words}"
        return number, self._out_of_range(name, number) if known(number) else None

    def _out_of_range(self, name, number):
        array = np.asarray(number, dtype=float)
        size, extreme = abs(array), array.min()
        if not (size.max() < np.inf):
            return Problem(f"{name} must be finite, got {shown(number)}", ~np.isfinite(array))
        if self.low is not None and not (extreme > self.low if self.strict else extreme >= self.low):
            found = number if array.ndim == 0 else f"a smallest value of {extreme:g}"
            words = f"{'greater than' if self.strict else 'at least'} {self.low:g}"
            return Problem(
                f"{name} must be {words}, got {found}", array <= self.low if self.strict else array < self.low
            )
        beyond = (size >= self.below) | (array <= self.above)
        if np.any(beyond):
            words = f"between {self.above:g} and {self.below:g}"
            return Problem(f"{name} must lie {words} to be computed in double precision, got {shown(number)}", beyond)
        return None


@dataclass(frozen=True)
class Pair:
    """A vector by its two components; `lone` numbers mean (number, 0)."""

    unit: str = ""
    name: str = ""
    parts: tuple[str, str] = ("x", "y")
    lone: bool = False
    rule: Number = dataclass_field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "rule", Number(self.unit))

    def quick(self, value):
        kind, quick = type(value), self.rule.quick
        if kind is tuple and len(value) == 2:
            first, second = quick(value[0]), quick(value[1])
            return UNSURE if first is UNSURE or second is UNSURE else (first, second)
        if self.lone:
            first = quick(value)
            return UNSURE if first is UNSURE else (first, 0.0)
        return UNSURE

    def taken(self, value, field=""):
        name = self.name or field
        words = _unfit(type(value))
        if words and not self.lone:
            words = words.format(unit=self.unit or "1")
            return value, f"{name} must be a pair {self._pair}, got {shown(value)}, {words}"
        if self.lone and (words or not (isinstance(value, list | tuple) or np.shape(value) == (2,))):
            return self._examined((value, 0.0), name)
        try:
            first, second = value
        except (TypeError, ValueError):
            either = " or a number" if self.lone else ""
            pair = self._pair if self.lone else f"a pair {self._pair}"
            return value, f"{name} must be {pair}{either}, got {shown(value)}"
        return self._examined((first, second), name)

    @property
    def _pair(self):
        return f"({', '.join(self.parts)})"

    def _examined(self, pair, name):
        found = [self.rule.taken(value, f"{name} {part}") for value, part in zip(pair, self.parts, strict=True)]
        return tuple(value for value, _ in found), found[0][1] or found[1][1]


@dataclass(frozen=True)
class Optional:
    """What another rule says, or None."""

    rule: Any

    def quick(self, value):
        return value if value is None else self.rule.quick(value)

    def taken(self, value, field=""):
        return (value, None) if value is None else self.rule.taken(value, field)


@dataclass(frozen=True)
class OrFunction:
    """What another rule says, or a function."""

    rule: Any

    def quick(self, value):
        return value if callable(value) else self.rule.quick(value)

    def taken(self, value, field=""):
        return (value, None) if callable(value) else self.rule.taken(value, field)


@dataclass(frozen=True)
class Made:
    """An object of a class, described in words for the message."""

    kind: type
    words: str

    def quick(self, value):
        return value if type(value) is self.kind else UNSURE

    def taken(self, value, field=""):
        return value, None if isinstance(value, self.kind) else f"{field} must be {self.words}, got {shown(value)}"


@dataclass(frozen=True)
class Own:
    """An object of the library or of the user's own that has some members; the user's own is kept as it is now."""

    members: tuple[str, ...]
    words: str

    def quick(self, value):
        own = not type(value).__module__.startswith(f"{LIBRARY}.")
        return UNSURE if own or not all(hasattr(value, name) for name in self.members) else value

    def taken(self, value, field=""):
        lacking = [name for name in self.members if not hasattr(value, name)]
        if isinstance(value, type) or len(lacking) == len(self.members):
            made = "; it is a class, make one of it" if isinstance(value, type) else ""
            return value, f"{field} must be {self.words}, got {shown(value)}{made}"
        if lacking:
            return value, f"{field} {type(value).__name__} lacks {', '.join(lacking)}"
        return kept(value), None


@dataclass(frozen=True)
class Name:
    """A name: text of one line, not empty unless it `may_be_empty`."""

    may_be_empty: bool = False

    def quick(self, value):
        return value if type(value) is str and value.isprintable() and (value or self.may_be_empty) else UNSURE

    def taken(self, value, field=""):
        if isinstance(value, str) and value.isprintable() and (value or self.may_be_empty):
            return str(value), None
        return value, f"{field} must be a name, a text of one line, got {shown(value)}"


@dataclass(frozen=True)
class Sign:
    """+1 or -1, or one of some words."""

    words: tuple[str, ...] = ()

    def quick(self, value):
        return value if type(value) is int and (value == 1 or value == -1) else UNSURE

    def taken(self, value, field=""):
        if isinstance(value, int | float | np.integer | np.floating) and type(value) is not bool and value in (1, -1):
            return int(value), None
        if isinstance(value, str) and value in self.words:
            return str(value), None
        words = f", nor one of {', '.join(map(repr, self.words))}" if isinstance(value, str) and self.words else ""
        return value, f"{field} must be +1 or -1, got {shown(value)}{words}"


class Rules:
    """What the fields of a dataclass must be, field -> rule; `also` finds problems of several fields together."""

    def __init__(self, owner, also=None, **rules):
        self.owner, self.also, self.rules = owner, also, rules
        self._looks = [(field, rule.quick) for field, rule in rules.items()]

    def admit(self, item):
        """Put into the fields what is to be kept of them, or raise `ParameterError`."""
        values = vars(item)
        for field, quick in self._looks:
            found = quick(values[field])
            if found is UNSURE:
                values.update(examined(self.owner, self.rules, values))
                break
            values[field] = found
        if self.also is not None:
            require(self.owner, *self.also(item))


class Checked:
    """A dataclass whose fields keep to its table of rules."""

    RULES: ClassVar[Rules]

    def __post_init__(self):
        self.RULES.admit(self)


def examined(owner, rules, values):
    """What to keep of values by name, each by its rule; one `ParameterError` for all that is wrong."""
    found, problems = {}, []
    for field, rule in rules.items():
        found[field], problem = rule.taken(values[field], field)
        problems.append(problem)
    if not any(problems):
        problems.append(fitting(**dict(_shapes(found))))
    require(owner, *problems)
    return found


def _shapes(values):
    """Name and shape of each array of designs among values and pairs of them."""
    for name, value in values.items():
        for part in value if type(value) is tuple else (value,):
            if len(shape := getattr(part, "shape", ())) > 1:
                yield name, shape


# Problems, one by one


def problem(name, value, **rule):
    """What is wrong with one number, as a sentence, or None."""
    return Number(name=name, **rule).taken(value)[1]


def finite(name, value):
    return problem(name, value)


def positive(name, value):
    return problem(name, value, low=0.0, strict=True)


def table(name, value):
    return problem(name, value, table=True)


def pair(name, value):
    """What is wrong with a vector (x, y), or None."""
    return Pair(name=name).taken(value)[1]


def require(owner, *problems):
    """Raise one `ParameterError` that lists every problem found."""
    found = [text for text in problems if text]
    if found:
        masks: list[Any] = [getattr(text, "designs", None) for text in found]
        designs = None if any(mask is None for mask in masks) else np.any(np.broadcast_arrays(*masks), axis=0)
        raise ParameterError(f"{owner}: " + "; ".join(found), designs)


def fitting(**shapes):
    """What is wrong with shapes, by what has them, that do not broadcast together, or None."""
    if len(shapes) < 2:
        return None
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        text = ", ".join(f"{name} {tuple(shape)}" for name, shape in shapes.items() if shape)
        return f"these shapes do not fit together: {text}; the last axis is the crank angle, designs come before it"
    return None


MEMORY = 10_000_000_000
"""Bytes that no table of angles or designs may take."""
ANGLE = 1000
"""Bytes that the results at a crank angle take, all forces in a table."""


def count(name, value, *, size=None):
    """What is wrong with a number of things, or None; with their `size` in bytes, they must have room in memory."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 1:
        return f"{name} must be a whole number of at least 1, got {value!r}"
    if size is not None and value * size > MEMORY:
        found = f"{value} would take {value * size // 10**9} GB" if value < 10**15 else "so many would take all"
        return f"{name} must be at most {MEMORY // size}, as {found} of memory"
    return None


def solution(name, value):
    """What is wrong with what must be a `Solution`, or None."""
    if hasattr(type(value), "power_residual"):
        return None
    return (
        f"{name} must be a Solution, as ks.solve(...), case.solve(name) and variant.solve() return, "
        f"got {_described(value)}"
    )


def case(name, value):
    """What is wrong with what must be a `Case`, or None."""
    return None if hasattr(value, "variants") else f"{name} must be a Case, as ks.load_case, got {_described(value)}"


def mechanism(name, value):
    """What is wrong with what must be a `Mechanism`, or None."""
    if hasattr(type(value), "references"):
        return None
    return f"{name} must be a Mechanism, as ks.crank_slider(...) and solution.mechanism are, got {_described(value)}"


def quantity(value, *, function=False):
    """What is wrong with what must name a quantity, or None."""
    if isinstance(value, str) or (function and callable(value)):
        return None
    other = ", or a function of a solution" if function else ""
    return f'quantity must be a name, such as "balancing_torque" or "O"{other}, got {_described(value)}'


def _described(value):
    """A value as errors show it: what it is, and short."""
    text = repr(value) if isinstance(value, str | int | float | None) else ""
    return text if 0 < len(text) < 80 else f"a {type(value).__name__}"


def choice(name, value, allowed):
    """What is wrong with a name that must be one of `allowed`; names the nearest."""
    if (type(value) is str and value in allowed) or any(value is word for word in allowed):
        return None
    return f"{name} is {shown(value)}, allowed: {', '.join(map(repr, allowed))}{hint(value, allowed)}"


def hint(value, allowed):
    """Question that names the nearest allowed word, empty if none is near."""
    near = nearest(value, allowed)
    return f"; did you mean {near!r}?" if near else ""


def nearest(value, allowed):
    """The allowed word that is like the one given, or None."""
    import difflib

    return next(iter(difflib.get_close_matches(str(value)[:100], list(allowed), n=1)), None)
