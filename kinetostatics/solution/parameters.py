"""What the numbers of a scene are to a program: left out where zero, of no other kind, judged together with others."""

from ..numbers.leaves import Kept, with_fields


def is_zero(value):
    """Whether a value is the one number zero, which is absent from a program unless it is kept."""
    return isinstance(value, int | float) and value == 0


def with_kept(item, steps):
    """Copy of a tree in which a zero is kept as a number; nothing is checked."""
    if not steps:
        return Kept(0.0)
    step, *rest = steps
    if isinstance(step, int):
        return tuple(with_kept(part, rest) if place == step else part for place, part in enumerate(item))
    return with_fields(item, **{step: with_kept(getattr(item, step), rest)})


def is_judged_together(item, steps):
    """Whether a number stands in a part that has rules for several of its numbers together."""
    for step in steps:
        rules = getattr(item, "RULES", None)
        if rules is not None and rules.also is not None:
            return True
        item = item[step] if isinstance(step, int) else getattr(item, step)
    return False


def shaping(places, mechanism, groups):
    """Paths of what decides which change points some groups pass: pins of the crank, their own lengths and lines."""
    numbers = [number for number, group in enumerate(mechanism.groups) if group in groups]
    pins = {group.on for group in groups}
    numbers += [number for number, group in enumerate(mechanism.groups) if pins.intersection(group.throws)]
    owners = [("mechanism", "groups", number) for number in numbers] + [("mechanism", "crank")] * bool(numbers)
    links = {"link"}.union(*(group.own_names.values() for group in groups))
    return {
        path
        for path, place in places.items()
        if any(place.steps[: len(owner)] == owner for owner in owners) and not links & set(place.steps)
    }
