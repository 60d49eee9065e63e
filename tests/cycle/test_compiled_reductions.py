"""Reductions by machine code: the same numbers as those of NumPy, whatever the values."""

import itertools

import numpy as np
import pytest

from kinetostatics.cycle.compiled_reductions import KINDS, CompiledReductions
from kinetostatics.cycle.reductions import parsed
from kinetostatics.engines import numba_backend
from kinetostatics.engines.codegen import ARGUMENTS

pytestmark = [
    pytest.mark.slow,  # all reductions as one compiled loop
    pytest.mark.skipif(not numba_backend.numba_available(), reason="numba is not installed (extra: fast)"),
]
OUTPUTS = [parsed(f"{kind} O") for kind in (*KINDS, "harmonic_2", "swing")]


def signals(count):
    """Values of many designs: waves, magnitudes, jumps, plateaus, noise, constants, what is no number."""
    generator = np.random.default_rng(5)
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    orders = np.arange(1, 6)[:, None]
    waves = [
        sum(generator.normal() * np.cos(order * turn + generator.uniform(0, 7)) for order in orders) for _ in range(60)
    ]
    made = [
        *waves,
        *map(np.abs, waves[:10]),
        *(-np.abs(wave) for wave in waves[:10]),
        *(np.hypot(wave, other) for wave, other in itertools.pairwise(waves)),
        *np.round(waves[:20]),
        *np.clip(waves[:20], -0.5, 0.5),
        *generator.normal(size=(20, count)),
        *(1e6 + np.array(waves[:5])),
        np.zeros(count),
        np.full(count, -3.0),
        np.where(turn < 1, 0.0, 10.0),
        np.where((turn < 1) | (turn > 6), 10.0, 0.0),
        np.where(np.arange(count) == 0, 1.0, 0.0),
        np.where(np.arange(count) == 5, np.nan, np.sin(turn)),
        np.where(np.arange(count) == 5, np.nan, 1.0),
        np.full(count, np.nan),
        np.where(np.arange(count) == 0, np.nan, np.sin(turn)),
        np.where(np.arange(count) == count - 1, np.nan, 2.0),
    ]
    return np.array(made)


@pytest.fixture(scope="module")
def handed_on():
    """A program's loop whose results are its tables."""
    text = f"""from numba import njit


@njit("{ARGUMENTS}", nogil=True)
def loop(angle, sine, cosine, parameters, tables, results):
    results = results.reshape((-1, tables.shape[2]))
    for design in range(tables.shape[1]):
        for row in range(tables.shape[0]):
            results[design * tables.shape[0] + row] = tables[row, design]
"""
    return numba_backend.load_compiled(text).loop


def reduced(loop, values, closure=None, turns=1, block=7):
    """What `CompiledReductions` finds of values (designs, N), and of closure, block by block."""
    closure = np.ones_like(values) if closure is None else closure
    designs, count = values.shape
    shape = len(OUTPUTS), designs
    found = np.empty(shape), np.zeros(shape, dtype=bool), np.zeros(designs, dtype=int), np.full(designs, np.nan)
    angle = np.linspace(0, 6, count)[None]
    given = angle, np.sin(angle), np.cos(angle), np.zeros((designs, 1)), np.array([values, closure])
    passes = CompiledReductions(OUTPUTS, [0] * len(OUTPUTS), 1, turns)
    half = designs // 2
    for start, stop in ((0, half), (half, designs)):
        passes(loop, given, np.empty((block, 2, count)), found, start, stop)
    return found


@pytest.mark.parametrize("count", [12, 13, 45, 360, 361])
@pytest.mark.parametrize("turns", [1, 2])
def test_numbers_and_doubts_are_those_of_numpy(handed_on, count, turns):
    values = signals(count)
    numbers, rough, *_ = reduced(handed_on, values, turns=turns)
    for item, found, doubtful in zip(OUTPUTS, numbers, rough, strict=True):
        with np.errstate(all="ignore"):
            expected, doubted = item.estimated(values, turns)
        size = np.nanmax(np.abs(values), axis=1, initial=0.0)
        np.testing.assert_array_equal(np.isnan(found), np.isnan(expected), err_msg=str(item))
        same = np.abs(found - expected) <= 1e-13 * np.maximum(size, 1.0)
        assert (same | np.isnan(expected)).all(), (item, np.flatnonzero(~same), found[~same], expected[~same])
        np.testing.assert_array_equal(doubtful, doubted, err_msg=str(item))


def test_open_designs_are_reported(handed_on):
    closure = np.ones((4, 20))
    closure[1, 7] = 0.005
    closure[2, 3:6] = -0.1
    closure[3, 2] = np.nan
    *_, gaps, nearest = reduced(handed_on, np.ones((4, 20)), closure)
    assert gaps.tolist() == [0, 0, 3, 1]
    np.testing.assert_array_equal(nearest, [np.nan, np.linspace(0, 6, 20)[7], np.nan, np.nan])
