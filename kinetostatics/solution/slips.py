"""Which numbers of a scene look like slips of units: those beyond what their rules call usual."""

from typing import NamedTuple

from ..engines.program import plausibility_test
from ..machine import plausibility
from ..numbers import paths
from ..numbers.checks import PlausibleRange, plausible_range_of
from ..numbers.parameter_tree import LeafIndex, construct_unchecked, unflatten
from .parameters import Parameters


class PlausibleNumber(NamedTuple):
    """A number of a kind of scenes of which something is usual: its path, its place among the leaves, and that.

    `is_own`: whether it is the mechanism's own.
    """

    path: str
    leaf: int
    usual: PlausibleRange
    is_own: bool


def scene_plausibility_test(kind):
    """The plausibility test of a kind, see `plausibility_test`: all lengths of its mechanism are looked at together."""
    apart = (item for item in kind.answer(plausible_numbers) if not (item.is_own and item.usual.unit == "m"))
    return plausibility_test(kind, [(item.leaf, item.usual) for item in apart])


def plausible_numbers(kind):
    """Numbers of a kind of which something is usual, each `Judged`."""
    ones = _parameters_of(unflatten(kind.structure, lambda: 1.0, lambda: None, lambda: None))
    numbered, found = _parameters_of(kind.numbered), []
    for path, place in paths.places_by_path(ones).items():
        leaf, usual = place.value(numbered), plausible_range_of(place.rule)
        if isinstance(leaf, LeafIndex) and usual:
            found.append(PlausibleNumber(path, leaf, usual, place.steps[0] == "mechanism"))
    return found


def plausibility_hints(solution):
    """Sentences on what looks like a slip in the scene of a solution."""
    values = solution.apart[1].numbers
    numbers = [(path, values[leaf], usual) for path, leaf, usual, _ in solution.kind.answer(plausible_numbers)]
    mechanism = solution.mechanism
    return (
        *plausibility.scene_hints(mechanism, solution.crank_speed, numbers),
        *plausibility.load_hints(mechanism, solution.loads),
    )


def _parameters_of(parts):
    return construct_unchecked(Parameters, **parts._asdict())
