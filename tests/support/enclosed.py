"""Enclosures by the kernels, held against formulas of their own and the values in double precision."""

from typing import NamedTuple

import numpy as np
import pytest

from kinetostatics.engines.engines import NUMPY
from kinetostatics.mechanics.quantities import components
from kinetostatics.studies.methods.high_precision.enclosures import on_arb

BITS = 200


def assert_enclosed(solution, joint):
    """Torque and the reaction at a joint lie where arb enclosures and mpmath, which agree, say."""
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from kinetostatics.studies.methods.high_precision.certified import certified

    for quantity, values in (("balancing_torque", solution.balancing_torque[None]), (joint, solution.reaction(joint))):
        found = certified(solution, quantity)
        assert found.agreement < 1e-25
        np.testing.assert_allclose(values, found.middle, rtol=0, atol=1e-14 * found.largest)


class Worst(NamedTuple):
    """Largest magnitudes over crank angles: of a quantity, of its error, of its plain and of its tight bound."""

    size: float
    error: float
    plain: float
    tight: float


def worst(solution):
    """Of torque and of each reaction, by name."""
    from flint import arb, ctx

    names = ("balancing_torque", *solution.reactions)
    (values, plain), (_, tight) = (NUMPY.with_bounds(solution.dynamics, names, way) for way in (False, True))
    with ctx.workprec(BITS):
        exact = on_arb(arb, solution)
        errors = {name: differences(values[name], components(exact, name)) for name in names}
    return {
        name: Worst(*(_largest(rows) for rows in (values[name], errors[name], plain[name], tight[name])))
        for name in names
    }


def differences(values, exact):
    """Rows of values less those in arb numbers, as floats."""
    from flint import arb

    pairs = zip(np.atleast_2d(values), exact, strict=True)
    return [_row(row, np.broadcast_to(np.asarray(part, dtype=object), row.shape), arb) for row, part in pairs]


def _row(values, exact, arb):
    return [float(arb(float(value)) - truth) for value, truth in zip(values, exact, strict=True)]


def _largest(rows):
    return float(np.nanmax(np.sqrt(np.sum(np.square(np.atleast_2d(rows)), axis=0))))


def ordinary_angles(scene, even, between):
    """So many even crank angles a turn, off dead centres, and so many more between any two kinks of tables of loads.

    What is steep within a part of a degree has errors of its own, which few even angles miss or meet by chance.
    """
    period = scene.period
    angles = [np.arange(0.0, period - 1e-9, 2 * np.pi / even) + 0.01]
    motion = scene.solve(1.0).dynamics
    tables = [load.value_now for load in scene.loads if hasattr(getattr(load, "value_now", None), "kinks")]
    kinks = np.unique(np.concatenate([np.mod(np.concatenate(table.kinks(motion)), period) for table in tables] or [[]]))
    for start, end in zip(kinks, np.append(kinks[1:], kinks[:1] + period), strict=True):
        angles.append(start + (np.arange(between) + 0.5) / between * (end - start))
    return np.mod(np.concatenate(angles), period)
