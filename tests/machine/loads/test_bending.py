"""Rows at which tables bend: kinks, jumps and coarse rows, but not fine rows of a smooth curve."""

from itertools import pairwise

import numpy as np

import kinetostatics as ks
from kinetostatics.machine.loads.table_pieces import KINK_TOLERANCE, kink_rows
from support.every import every

TURN = 2 * np.pi
FINE = np.linspace(0.1, 0.3, 1101)
UNEVEN = 0.1 + 5.0 * (FINE - 0.1) ** 2


def gas(x):
    return -4e3 * (0.03 / (x - 0.07)) ** 1.3


def along(x, y, back=None):
    return ks.Table(x, y, over="travel", back=back)


def waves(count, start=0.0):
    x = start + np.linspace(0.0, TURN, count, endpoint=False)
    return x, 2e3 * np.exp(np.cos(x - 0.7)) + 300.0 * np.sin(3.0 * x)


SMOOTH = {
    "along": along(FINE, gas(FINE)),
    "around": ks.Table(*waves(1100)),
    "uneven": along(UNEVEN, gas(UNEVEN)),
    "rounded": along(FINE, np.round(gas(FINE), 2)),
    "line": along([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]),
    "line with rows close together": along([0.1, 0.2, 0.2 + 1e-7, 0.2 + 2e-7, 0.3], np.full(5, 7.0)),
    "nothing": along(FINE, 0.0 * FINE),
    "two turns": ks.Table(2.0 * waves(2200)[0], waves(2200)[1], period=2 * TURN),
}


@every("name", SMOOTH)
def test_fine_rows_of_a_smooth_curve_bend_nothing(name):
    assert not SMOOTH[name].is_bent(KINK_TOLERANCE)
    assert SMOOTH[name].is_bent(0.0)


SHARP = {
    "kink": (np.abs(FINE - 0.2) * 1e4, [550]),
    "jump": (gas(FINE) + 1e3 * (FINE > 0.2), [550, 551]),
    "spike of a row": (gas(FINE) + 1e3 * (np.arange(1101) == 300), [299, 300, 301]),
    "small spike": (gas(FINE) + 1.0 * (np.arange(1101) == 300), [299, 300, 301]),
    "kink near an end": (gas(FINE) + 1e6 * np.maximum(0.0, 0.101 - FINE), [5, 6]),
}


@every("name", SHARP)
def test_kinks_jumps_and_spikes_among_fine_rows_stay(name):
    y, expected = SHARP[name]
    found = kink_rows(along(FINE, y))
    assert found.size <= 5
    assert all(np.abs(found - row).min() <= 1 for row in expected), found
    assert np.array_equal(found, kink_rows(along(FINE, 0.0 * FINE + 1.0, y)))  # also where the other stroke is smooth


@every("width", [1e-9, 1e-6, 1e-3])
@every("height", [1.0, 0.01])
def test_no_spike_of_three_rows_passes_as_a_parabola(width, height):
    x = np.sort(np.append(np.linspace(0.1, 0.3, 4), [0.2, 0.2 + width, 0.2 + 2 * width]))
    y = 1.0 + height * (x == 0.2 + width)
    assert kink_rows(along(x, y)).tolist() == [2, 3, 4]


def test_a_narrow_smooth_bump_is_split():
    x = np.linspace(0.1, 0.3, 20_001)
    found = x[kink_rows(along(x, np.exp(-(((x - 0.2) / 3e-3) ** 2))))]
    assert 4 < found.size < 20
    assert np.abs(found - 0.2).max() < 0.015


@every("seed", range(4))
def test_between_bends_a_table_is_polynomial(seed):
    rng = np.random.default_rng(seed)
    x = np.sort(np.append(rng.uniform(0.1, 0.3, 400), [0.1, 0.3]))
    y = gas(x) + 10.0 ** rng.uniform(-1, 3) * np.cumsum(rng.standard_normal(x.size) * (rng.random(x.size) < 0.05))
    kept = [0, *kink_rows(along(x, y)), x.size - 1]
    for low, high in pairwise(kept):
        if x[high] - x[low] < 0.2 / 32:  # longer ones may be several polynomials
            at = np.linspace(x[low], x[high], 300)
            fit = np.polynomial.Chebyshev.fit(at, np.interp(at, x, y), 7)
            assert np.abs(fit(at) - np.interp(at, x, y)).max() < 2 * KINK_TOLERANCE * np.abs(y).max()
