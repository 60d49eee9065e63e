"""Dataclasses whose fields keep to a table of rules."""

from typing import Any, ClassVar

from .problems import fitting, require
from .rules import UNSURE


class Rules:
    """What the fields of a dataclass must be, field -> rule; `also` finds problems of several fields together."""

    def __init__(self, owner, also=None, **rules):
        """`are_plain(values)` tells of a mapping whether all values are well and kept as they are."""
        self.owner, self.also, self.rules = owner, also, rules
        self.are_plain = _look(rules)

    def admit(self, item):
        """Put into the fields what is to be kept of them, or raise `ParameterError`."""
        self.keep(vars(item), self.owner)
        if self.also is not None:
            require(self.owner, *self.also(item))

    def keep(self, values, owner):
        """The same in a mapping of field to value."""
        if self.are_plain(values):
            return
        for field, rule in self.rules.items():
            found = rule.quick(values[field])
            if found is UNSURE:
                values.update(examined(owner, self.rules, values))
                return
            values[field] = found


def _look(rules):
    """Function that tells of values by field whether all are kept as they are, written for the rules in one line."""
    scope: dict[str, Any] = {}
    lines = [f"    {field} = values[{field!r}]" for field in rules]
    conditions = []
    for field, rule in rules.items():
        condition, objects = rule.plainly(field) if hasattr(rule, "plainly") else _quickly(rule, field)
        scope |= objects
        conditions.append(condition)
    exec("\n".join(["def look(values):", *lines, f"    return {' and '.join(conditions) or 'True'}"]), scope)
    return scope["look"]


def _quickly(rule, value):
    return f"quick_at_{value}({value}) is {value}", {f"quick_at_{value}": rule.quick}


class Checked:
    """A dataclass whose fields keep to its table of rules."""

    RULES: ClassVar[Rules]

    def __post_init__(self):
        rules = self.RULES
        if rules.also is not None or not rules.are_plain(self.__dict__):
            rules.admit(self)


def examined(owner, rules, values, *others):
    """What to keep of values by name, each by its rule; one `ParameterError` for all that is wrong, `others` too."""
    found, problems = {}, list(others)
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
