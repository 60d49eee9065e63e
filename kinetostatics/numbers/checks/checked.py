"""Dataclasses whose fields keep to a table of rules."""

from typing import Any, ClassVar

from .problems import fitting, require
from .rules import UNSURE


class Rules:
    """What the fields of a dataclass must be, field -> rule; `also` finds problems of several fields together."""

    def __init__(self, owner, also=None, **rules):
        """`are_well(values)` tells of a mapping if all values are surely well, and puts in what is kept of them."""
        self.owner, self.also, self.rules = owner, also, rules
        self.are_well = _look(rules)

    def admit(self, item):
        """Put into the fields what is to be kept of them, or raise `ParameterError`."""
        self.keep(vars(item), self.owner)
        if self.also is not None:
            require(self.owner, *self.also(item))

    def keep(self, values, owner):
        """The same in a mapping of field to value."""
        if not self.are_well(values):
            values.update(examined(owner, self.rules, values))


def _look(rules):
    """Function for values by field that are mostly well, written for the rules as a hand would write it."""
    scope: dict[str, Any] = {"UNSURE": UNSURE}
    lines = ["def look(values):"]
    for field, rule in rules.items():
        condition, objects = rule.plainly(field) if hasattr(rule, "plainly") else ("False", {})
        scope |= objects | {f"quick_at_{field}": rule.quick}
        lines += [
            f"    {field} = values[{field!r}]",
            f"    if not ({condition}):",
            f"        kept = quick_at_{field}({field})",
            "        if kept is UNSURE: return False",
            f"        if kept is not {field}: values[{field!r}] = kept",
        ]
    exec("\n".join([*lines, "    return True"]), scope)
    return scope["look"]


class Checked:
    """A dataclass whose fields keep to its table of rules."""

    RULES: ClassVar[Rules]

    def __post_init__(self):
        rules = self.RULES
        if rules.also is not None or not rules.are_well(self.__dict__):
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
