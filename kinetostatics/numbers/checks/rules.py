"""Rules that test and convert values, dataclasses with a rule for each field, and plausible ranges of numbers.

A rule has ``quick(value)``, which returns the value to store or `UNDECIDED`. Its ``check(value, field)`` returns two
things: the value to store, and its fault as a sentence or None.
"""

import math
import warnings
from dataclasses import dataclass
from dataclasses import field as dataclass_field
from typing import Annotated, Any, ClassVar, NamedTuple, get_args, get_origin

import numpy as np

from ...errors import HintWarning
from ..fingerprint import LIBRARY
from .messages import Problem, broadcast_problem, choice, require, shown, truth
from .values import (
    DimensionError,
    NotANumberError,
    has_known_values,
    is_quantity,
    not_a_number,
    snapshot,
    to_number,
    to_plain,
)


class PlausibleRange(NamedTuple):
    """Plausible magnitudes of a nonzero number; a number outside probably has the wrong unit.

    `most` and `least` are limits in the SI `unit`; with `in_links` they are multiples of the longest link. `advice` is
    the question in the hint. `factor` converts to SI from the unit that was probably meant; 0 if unknown.
    """

    most: float
    advice: str
    factor: float = 0.0
    least: float = 0.0
    in_links: bool = False
    unit: str = ""


MAX_LENGTH_IN_LINKS = 20.0
"""Largest plausible length over that of the longest link; a length in mm among lengths in m gives 1000."""
PLAUSIBLE_BY_UNIT = {
    "rad": PlausibleRange(2.0 * math.pi * (1.0 + 1e-9), "more than a whole turn; is it in degrees?", math.pi / 180.0),
    "m": PlausibleRange(MAX_LENGTH_IN_LINKS, "is it in mm?", 1e-3, in_links=True),
}
"""Plausible range by unit, for rules without a range of their own."""


def plausible_range_of(rule):
    """Plausible range that a rule gives, else that of its unit; None without either."""
    found = rule.usual or PLAUSIBLE_BY_UNIT.get(rule.unit)
    return found and found._replace(unit=rule.unit)


def implausibility(path, value, usual, longest=0.0):
    """Reason why a number is implausible, as a sentence, or None; `longest` is the longest link, m."""
    most, advice, factor, least, in_links, si = usual
    unit = longest if in_links else 1.0
    if not has_known_values(value) or not unit:
        return None
    sizes = abs(value)
    worst = sizes if isinstance(sizes, float) else float(sizes.max())
    if worst <= most * unit:
        worst = 0.0 if least == 0.0 else float(np.min(sizes))
        if worst == 0.0 or worst >= least * unit:
            return None
    own = "" if si == "1" else " " + si.replace("**", "").replace("*", " ")
    beside = f", {worst / longest:.4g} times the longest link ({longest:.4g} m)" if in_links else ""
    odd = -worst if np.any(np.equal(value, -worst)) else worst
    meant = f" That makes {factor * odd:.6g}{own}" if factor else ""
    return f"{path} is {odd:.6g}{own}{beside}; {advice}{meant}"


MAX_NUMBER, MAX_LENGTH = 1e150, 1e75
"""Largest number, so that its square does not overflow; largest `strict` number, the reciprocal of the least one."""
UNDECIDED: Any = object()
"""Result of ``quick`` for a value that needs ``check``."""


@dataclass(frozen=True)
class Number:
    """A number in a unit, or an array (designs, 1) of numbers; a `table` also has a number for each crank angle.

    The unit is "1" for a ratio and "" if unknown; pint quantities are converted to it. `low` is the least number, with
    `strict` excluded. A number outside its `usual` range is accepted; a hint may suggest another unit.
    """

    unit: str
    name: str = ""
    low: float | None = None
    strict: bool = False
    table: bool = False
    usual: PlausibleRange | None = None

    above: float = dataclass_field(init=False)
    below: float = dataclass_field(init=False)

    def __post_init__(self):
        above = -MAX_NUMBER if self.low is None else 1.0 / MAX_LENGTH if self.strict else math.nextafter(self.low, -1.0)
        object.__setattr__(self, "above", above)
        object.__setattr__(self, "below", MAX_LENGTH if self.strict else MAX_NUMBER)

    def quick(self, value):
        if type(value) is float and self.above < value < self.below:
            return value
        return float(value) if type(value) is int and self.above < value < self.below else UNDECIDED

    def check(self, value, field=""):
        name = self.name or field
        try:
            found = to_number(value, self.table, self.unit)
        except DimensionError as fault:
            return value, f"{name} {fault}"
        except NotANumberError as fault:
            words = f", {fault}".format(unit=self.unit or "1") if str(fault) else ""
            kind = "an array of numbers" if self.table else "an array of shape (designs, 1)"
            return value, f"{name} must be a number or {kind}, got {shown(value)}{words}"
        return found, self._out_of_range(name, found) if has_known_values(found) else None

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
            low = self.above if self.low is None or self.strict else self.low
            words = f"between {low:g} and {self.below:g}"
            return Problem(f"{name} must lie {words} to be computed in double precision, got {shown(number)}", beyond)
        return None


@dataclass(frozen=True)
class Pair:
    """A vector by its two components; if `lone`, a single number means (number, 0)."""

    unit: str
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
            return UNDECIDED if first is UNDECIDED or second is UNDECIDED else (first, second)
        if self.lone:
            first = quick(value)
            return UNDECIDED if first is UNDECIDED else (first, 0.0)
        return UNDECIDED

    def check(self, value, field=""):
        name = self.name or field
        try:
            value = to_plain(value, self.unit) if is_quantity(value) else value
        except DimensionError as fault:
            return value, f"{name} {fault}"
        words = not_a_number(value)
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

    def numbers(self, value):
        """Yield name, indices and rule of each number, for parameter paths."""
        for place, part in enumerate(self.parts):
            yield part, (place,), self.rule

    @property
    def _pair(self):
        return f"({', '.join(self.parts)})"

    def _examined(self, pair, name):
        found = [self.rule.check(value, f"{name} {part}") for value, part in zip(pair, self.parts, strict=True)]
        return tuple(value for value, _ in found), found[0][1] or found[1][1]


@dataclass(frozen=True)
class Series:
    """Coefficients of a series, a tuple: their names are orders from `start` on; `first` is the rule of the first."""

    unit: str
    letter: str = "a"
    start: int = 0
    first: Number | None = None
    rule: Number = dataclass_field(init=False)

    def __post_init__(self):
        object.__setattr__(self, "rule", Number(self.unit))

    def quick(self, value):
        if type(value) is not tuple or (self.first is not None and not value):
            return UNDECIDED
        found = tuple(self._rule(place).quick(part) for place, part in enumerate(value))
        return UNDECIDED if any(part is UNDECIDED for part in found) else found

    def check(self, value, field=""):
        try:
            value = to_plain(value, self.unit) if is_quantity(value) else value
        except DimensionError as fault:
            return value, f"{field} {fault}"
        several = isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim == 1)
        if not several or (self.first is not None and not len(value)):
            terms = f"({self.letter}{self.start}, {self.letter}{self.start + 1}, ...)"
            return value, f"{field} must be a tuple of numbers {terms}, got {shown(value)}"
        found = [
            self._rule(place).check(part, f"{field}.{place + self.start}".strip("."))
            for place, part in enumerate(value)
        ]
        return tuple(part for part, _ in found), next((problem for _, problem in found if problem), None)

    def numbers(self, value):
        """Yield name, indices and rule of each number, for parameter paths."""
        for place in range(len(value)):
            yield str(place + self.start), (place,), self._rule(place)

    def _rule(self, place):
        return self.rule if place or self.first is None else self.first


@dataclass(frozen=True)
class Optional:
    """None, or a value by another rule."""

    rule: Any

    def quick(self, value):
        return value if value is None else self.rule.quick(value)

    def check(self, value, field=""):
        return (value, None) if value is None else self.rule.check(value, field)


@dataclass(frozen=True)
class OrFunction:
    """A function, or a value by another rule."""

    rule: Any

    def quick(self, value):
        return value if callable(value) else self.rule.quick(value)

    def check(self, value, field=""):
        return (value, None) if callable(value) else self.rule.check(value, field)


@dataclass(frozen=True)
class InstanceOf:
    """An instance of a class; `words` name the class in the message."""

    kind: type
    words: str

    def quick(self, value):
        return value if type(value) is self.kind else UNDECIDED

    def check(self, value, field=""):
        return value, None if isinstance(value, self.kind) else f"{field} must be {self.words}, got {shown(value)}"


@dataclass(frozen=True)
class HasMembers:
    """An object with some members; of a user's own object a snapshot is stored, so later changes have no effect."""

    members: tuple[str, ...]
    words: str

    def quick(self, value):
        own = not type(value).__module__.startswith(f"{LIBRARY}.")
        return UNDECIDED if own or not all(hasattr(value, name) for name in self.members) else value

    def check(self, value, field=""):
        lacking = [name for name in self.members if not hasattr(value, name)]
        if isinstance(value, type) or len(lacking) == len(self.members):
            made = "; it is a class, pass an instance of it" if isinstance(value, type) else ""
            return value, f"{field} must be {self.words}, got {shown(value)}{made}"
        if lacking:
            return value, f"{field} {type(value).__name__} lacks {', '.join(lacking)}"
        return snapshot(value), None


@dataclass(frozen=True)
class Name:
    """A name: text of one line, not empty unless it `may_be_empty`."""

    may_be_empty: bool = False

    def quick(self, value):
        return value if type(value) is str and value.isprintable() and (value or self.may_be_empty) else UNDECIDED

    def check(self, value, field=""):
        if isinstance(value, str) and value.isprintable() and (value or self.may_be_empty):
            return str(value), None
        return value, f"{field} must be a name, a text of one line, got {shown(value)}"


@dataclass(frozen=True)
class Sign:
    """+1 or -1, or one of some words."""

    words: tuple[str, ...] = ()

    def quick(self, value):
        return value if type(value) is int and (value == 1 or value == -1) else UNDECIDED

    def check(self, value, field=""):
        if isinstance(value, int | float | np.integer | np.floating) and type(value) is not bool and value in (1, -1):
            return int(value), None
        if isinstance(value, str) and value in self.words:
            return str(value), None
        words = f", nor one of {', '.join(map(repr, self.words))}" if isinstance(value, str) and self.words else ""
        return value, f"{field} must be +1 or -1, got {shown(value)}{words}"


@dataclass(frozen=True)
class Word:
    """One of some words."""

    words: tuple[str, ...]

    def quick(self, value):
        return value if type(value) is str and value in self.words else UNDECIDED

    def check(self, value, field=""):
        return value, choice(field, value, self.words)


class Truth:
    """True or False."""

    def quick(self, value):
        return value if type(value) is bool else UNDECIDED

    def check(self, value, field=""):
        problem = truth(field, value)
        return value if problem else bool(value), problem


class Rules:
    """Rules by field of a dataclass; ``also(item)`` yields faults that concern several fields together."""

    def __init__(self, owner, also=None, **rules):
        self.owner, self.also, self.rules = owner, also, rules
        optional = {field: rule.rule.quick for field, rule in rules.items() if isinstance(rule, Optional)}
        self._quick = tuple((field, rule.quick) for field, rule in rules.items() if field not in optional)
        self._quick_if_given = tuple(optional.items())

    def admit_quickly(self, values):
        """Whether the quick rules admit all values by field; replaces each admitted one by the value to store."""
        for field, quick in self._quick:
            value = values[field]
            kept = quick(value)
            if kept is not value:
                if kept is UNDECIDED:
                    return False
                values[field] = kept
        for field, quick in self._quick_if_given:
            value = values[field]
            if value is not None:
                kept = quick(value)
                if kept is UNDECIDED:
                    return False
                values[field] = kept
        return True

    def admit(self, item):
        """Check the fields and store their values, or raise `ParameterError`."""
        self.keep(vars(item), self.owner)
        if self.also is not None:
            require(self.owner, *self.also(item))

    def keep(self, values, owner):
        """Check the values in a mapping by field and store them there, or raise `ParameterError`."""
        if not self.admit_quickly(values):
            values.update(check_values(owner, self.rules, values))


class Checked:
    """A dataclass whose fields are checked when it is made.

    A field ``Annotated[type, rule]`` has this rule. A derived class that declares the field with a plain type keeps it.
    """

    RULES: ClassVar[Rules]
    FIELD_RULES: ClassVar[dict[str, Any]] = {}

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        own, rules = cls.__annotations__, dict(cls.FIELD_RULES)
        for name, kind in own.items():
            if get_origin(kind) is Annotated:
                own[name], rules[name] = get_args(kind)
        inherited = [name for name in rules if name not in own]
        cls.FIELD_RULES = {name: rules[name] for name in (*inherited, *own) if name in rules}
        if table := vars(cls).get("RULES"):
            cls.RULES = Rules(table.owner, table.also, **cls.FIELD_RULES | table.rules)

    def __post_init__(self):
        rules = self.RULES
        if rules.also is not None or not rules.admit_quickly(self.__dict__):
            rules.admit(self)


def check_values(owner, rules, values, *others):
    """Values to store by name, each checked by its rule; one `ParameterError` lists all faults and the `others`."""
    found, problems = {}, list(others)
    for field, rule in rules.items():
        found[field], problem = rule.check(values[field], field)
        problems.append(problem)
    if not any(problems):
        problems.append(broadcast_problem(**dict(_shapes(found))))
    require(owner, *problems)
    return found


def _shapes(values):
    """Yield name and shape of each array of designs among the values, also inside pairs and series."""
    for name, value in values.items():
        for part in value if type(value) is tuple else (value,):
            if len(shape := getattr(part, "shape", ())) > 1:
                yield name, shape


def single_number(name, value, unit, *, high=None, unequal=None, **rule):
    """Pair of a single number as a float, and its fault as a sentence or None; `rule` as for `Number`."""
    found, problem = Number(unit, name, **rule).check(value)
    if isinstance(value, list | tuple) or (problem is None and (not has_known_values(found) or np.ndim(found))):
        problem = f"{name} must be one number, got {shown(value)}"
    if problem is None and high is not None and not found < high:
        problem = f"{name} must be less than {high:.9g}, got {found:.9g}"
    if problem is None and found == unequal:
        problem = f"{name} must not be {unequal:g}"
    return found, problem


def single_numbers(owner, *problems, **given):
    """Single numbers by name, each given as (value, unit, rule); one `ParameterError` lists all faults.

    A rule may contain another name for messages. One `HintWarning` reports implausible numbers.
    """
    found = {
        field: single_number(value=value, unit=unit, **{"name": field} | rule)
        for field, (value, unit, rule) in given.items()
    }
    require(owner, *(problem for _, problem in found.values()), *problems)
    values = {field: value for field, (value, _) in found.items()}
    odd = (
        implausibility(rule.get("name", field), values[field], rule["usual"]._replace(unit=unit))
        for field, (_, unit, rule) in given.items()
        if "usual" in rule
    )
    if text := "; ".join(filter(None, odd)):
        warnings.warn(HintWarning(owner, text), stacklevel=3)
    return values
