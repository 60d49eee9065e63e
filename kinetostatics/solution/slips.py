"""Which numbers of a scene look like slips of units: those beyond what their rules call usual."""

from typing import NamedTuple

from ..engines.program import plausibility_test
from ..machine import plausibility
from ..numbers import paths
from ..numbers.checks import Usual, usual_of
from ..numbers.parameter_tree import Numbered, made, put_together
from .parameters import Parameters


class Judged(NamedTuple):
    """A number of a kind of scenes of which something is usual: its path, its place among the leaves, and that.

    `is_own`: whether it is the mechanism's own.
    """

    path: str
    leaf: int
    usual: Usual
    is_own: bool


def look(kind):
    """The plausibility test of a kind, see `plausibility_test`: all lengths of its mechanism are looked at together."""
    apart = (item for item in kind.answer(judged) if not (item.is_own and item.usual.unit == "m"))
    return plausibility_test(kind, [(item.leaf, item.usual) for item in apart])


def judged(kind):
    """Numbers of a kind of which something is usual, each `Judged`."""
    ones = _scene(put_together(kind.structure, lambda: 1.0, lambda: None, lambda: None))
    numbered, found = _scene(kind.numbered), []
    for path, place in paths.places(ones).items():
        leaf, usual = place.value(numbered), usual_of(place.rule)
        if isinstance(leaf, Numbered) and usual:
            found.append(Judged(path, leaf, usual, place.steps[0] == "mechanism"))
    return found


def of_scene(solution):
    """Sentences on what looks like a slip in the scene of a solution."""
    values = solution.apart[1].numbers
    numbers = [(path, values[leaf], usual) for path, leaf, usual, _ in solution.kind.answer(judged)]
    mechanism = solution.mechanism
    return (
        *plausibility.of_scene(mechanism, solution.crank_speed, numbers),
        *plausibility.of_loads(mechanism, solution.loads),
    )


def _scene(parts):
    return made(Parameters, **parts._asdict())
