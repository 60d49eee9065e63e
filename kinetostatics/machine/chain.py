"""What a field takes that holds a chain of groups."""

from ..numbers import checks
from .group import MEMBERS, Group

NAME = checks.Name()
GROUP = f"{Group.__module__}.{Group.__name__}"


class Chain:
    """Rule of a field that holds groups."""

    rule = checks.Own(MEMBERS, "a group: RockerGroup, SliderGroup, CamRoller or one of your own, derived from Group")

    def quick(self, value):
        if type(value) is tuple and all(isinstance(group, Group) and group.trusted for group in value):
            return value
        return checks.UNSURE

    def taken(self, value, field=""):
        if not isinstance(value, tuple | list):
            return value, f"{field} must be a tuple of groups, got {checks.shown(value)}"
        found = [self.rule.taken(group, "a group") for group in value]
        found += [NAME.taken(name, f"on of {type(group).__name__}") for group in value for name in _on(group)]
        strange = [group for group in value if not isinstance(group, Group)]
        found += [(group, f"{type(group).__name__} is not derived from {GROUP}") for group in strange]
        problem = next((problem for _, problem in found if problem), None)
        return tuple(group for group, _ in found[: len(value)]), problem


def _on(group):
    """Names that a group gives of what it hangs on."""
    found = getattr(group, "on", "O")
    return found if type(found) is tuple else (found,)
