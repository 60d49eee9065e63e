"""Which numbers of a scene look like slips of units: those beyond what their rules call usual."""

from typing import NamedTuple

from ..engines.first_look import first_look
from ..machine import hints
from ..numbers import paths
from ..numbers.checks import Number, usual_of
from ..numbers.kinds import Numbered
from ..numbers.leaves import made, put_together
from .parameters import Parameters

FIELDS = ("mechanism", "crank_speed", "crank_acceleration", "loads", "friction")


class Judged(NamedTuple):
    """A number of a kind of scenes of which something is usual: its path, its place among the leaves, and its rule."""

    path: str
    leaf: int
    rule: Number
    is_own: bool
    """Whether it is the mechanism's own."""


def look(kind):
    """A first look at the numbers of a kind, see `first_look`: all lengths of its mechanism are looked at together."""
    apart = (item for item in kind.answer(judged) if not (item.is_own and item.rule.unit == "m"))
    return first_look(kind, [(item.leaf, usual_of(item.rule)) for item in apart])


def judged(kind):
    """Numbers of a kind of which something is usual, each `Judged`."""
    ones = _scene(put_together(kind.structure, lambda: 1.0, lambda: None, lambda: None))
    numbered, found = _scene(kind.numbered), []
    for path, place in paths.places(ones).items():
        leaf = place.value(numbered)
        if isinstance(leaf, Numbered) and usual_of(place.rule):
            found.append(Judged(path, leaf, place.rule, place.steps[0] == "mechanism"))
    return found


def of_scene(solution):
    """Sentences on what looks like a slip in the scene of a solution."""
    values = solution.apart[1].numbers
    numbers = [(item.path, values[item.leaf], item.rule) for item in solution.kind.answer(judged)]
    return hints.of_scene(solution.mechanism, solution.crank_speed, numbers)


def _scene(parts):
    return made(Parameters, **dict(zip(FIELDS, (*parts, None)[: len(FIELDS)], strict=True)))
