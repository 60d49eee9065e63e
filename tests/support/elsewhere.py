"""Values of a solution as another engine or precision gives them, beside proven bounds and the exact values."""

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.program import program_of
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.numbers.parameter_tree import replace_unchecked
from kinetostatics.studies.methods.high_precision.enclosures import on_arb

from .bounded import Found
from .scenes import SCENES, SIZES, solve

BITS = 200
ANGLES = np.linspace(0.0, 6.2, 70)
PUMP = ks.crank_slider(0.05, 0.2, coupler=ks.Link(0.4, 0.1, 0.001), slider=ks.Link(1.0))
DIAGRAM = ks.Table([0.15, 0.21, 0.25], [-900.0, -400.0, -100.0], over="travel", back=[-1500.0, -700.0, -800.0])


def diverse():
    """Solutions of every shape, with tables and friction, by name."""
    pumped = ks.Scene(PUMP, 100.0, loads=[ks.ProcessForce(DIAGRAM), ks.Gravity()])
    springs = ks.GasSpring(1e-3, 3e-4, 3e5, at=0.2), ks.Spring(1e3, 0.2, mass=0.001)
    rubbed = ks.Scene(PUMP, 100.0, friction={"O": ks.PinFriction(0.1, 0.01)})
    return {
        "plain": solve(SCENES["plain"], ANGLES),
        "designs": solve(SCENES["plain"], ANGLES + SIZES),
        "one angle": solve(SCENES["plain"], np.array(0.7)),
        "one angle of a table": pumped.solve(0.7),
        "table over travel": pumped.solve(ANGLES),
        "designs under a table": pumped.varied({"slider.mass": np.array([[1.0], [2.0]])}).solve(ANGLES),
        "friction": rubbed.solve(ANGLES),
        "gas spring and spring with mass": ks.Scene(PUMP, 100.0, loads=[*springs, ks.Gravity()]).solve(ANGLES),
        "speeds": ks.Scene(PUMP, np.linspace(90.0, 110.0, ANGLES.size)).solve(ANGLES),
    }


def exact_values(solution, names=None):
    """Every quantity of a solution, or some, by the kernels on arb numbers: rows of components by name."""
    from flint import arb, ctx

    with ctx.workprec(BITS):
        exact = on_arb(arb, replace_unchecked(solution, engine=solution.engine))
        return {name: components(exact, name) for name in names or of_scene(solution)}


def errors(solution, exact, backends):
    """By backend: values beside exact ones, as of `exact_values`."""
    from flint import ctx

    made, leaves = program_of(solution.dynamics, tuple(exact))
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
