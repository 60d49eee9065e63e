"""Values of a solution as another engine or precision gives them, beside proven bounds and the exact values."""

from typing import NamedTuple

import numpy as np

from kinetostatics.engines import programs
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.numbers.leaves import with_fields
from kinetostatics.studies.methods.enclosures import on_arb

BITS = 200


class Found(NamedTuple):
    """Values compared, those off by more than their bound, those without one, and the worst share of a bound."""

    values: int
    wrong: list
    unbounded: int
    share: float


def exact_values(solution, names=None):
    """Every quantity of a solution, or some, by the kernels on arb numbers: rows of components by name."""
    from flint import arb, ctx

    with ctx.workprec(BITS):
        exact = on_arb(arb, with_fields(solution, engine=solution.engine))
        return {name: components(exact, name) for name in names or of_scene(solution)}


def errors(solution, exact, backends):
    """By backend: values beside exact ones, as of `exact_values`."""
    from flint import ctx

    made, leaves = programs.of(solution.dynamics, tuple(exact))
    rows = [row for name in exact for row in exact[name]]
    with ctx.workprec(BITS):
        return {
            backend: _beside(
                backend.run(made, solution.dynamics, leaves), backend.bounds(made, solution.dynamics, leaves), rows
            )
            for backend in backends
        }


def _beside(values, bounds, rows):
    from flint import arb

    wrong, count, unbounded, share = [], 0, 0, 0.0
    for place, (own, bound, middle) in enumerate(zip(values, bounds, rows, strict=True)):
        truths = np.broadcast_to(np.asarray(middle, dtype=object), own.shape)
        for value, most, truth in zip(own.ravel(), bound.ravel(), truths.ravel(), strict=True):
            if not arb(truth).is_finite():
                continue
            count += 1
            if not np.isfinite(most):
                unbounded += 1
                continue
            error = abs(arb(float(value)) - truth) if np.isfinite(value) else arb("inf")
            if not error.abs_lower() <= arb(float(most)):
                wrong.append((place, float(value), float(arb(truth).mid()), float(most)))
            if most > 0 and np.isfinite(value):
                share = max(share, float(error.abs_lower()) / float(most))
    return Found(count, wrong, unbounded, share)
