"""Solutions by both engines, compared."""

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.engines import COMPILED, NUMPY
from kinetostatics.mechanics.quantities import components
from support.case_files import shipped
from support.scenes import (
    SCENES,
    everything,
    solve,
)

ULP = 2.0**-52
ROUNDED = 1e-14
SHIPPED = {name: shipped(name) for name in ("sawframe_2r63", "chain_unit", "mower_drive")}
VARIANTS = [(case, name) for case in SHIPPED for name in SHIPPED[case].variants]


def again(solution, angles=None, engine="compiled", **options):
    """The same problem solved by another engine."""
    return ks.solve(
        solution.mechanism,
        solution.crank_angle if angles is None else angles,
        crank_speed=solution.crank_speed,
        crank_acceleration=solution.crank_acceleration,
        loads=solution.loads,
        engine=engine,
        **options,
    )


def assert_same(found, expected):
    """Every result has the same NaN, and differs by rounding, which fused sums and products do not share."""
    assert (found.engine, expected.engine) == (COMPILED, NUMPY)
    assert found.shape == expected.shape
    assert (found.reactions, found.scalars) == (expected.reactions, expected.scalars)
    for name in everything(expected):
        for one, other in zip(components(found, name), components(expected, name), strict=True):
            assert one.shape == other.shape, name
            assert np.array_equal(np.isnan(one), np.isnan(other)), name
            assert np.nanmax(np.abs(one - other)) <= ROUNDED * np.nanmax(np.abs(other)), name


def engine(angles, **options):
    return solve(SCENES["plain"], angles, **options).engine
