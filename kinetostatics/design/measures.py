"""Reductions of curves with their derivatives: a number for a design from values evenly over the period.

As `results.reductions` has them, and exact derivatives of those very formulas by the numbers of the design.
"""

from typing import NamedTuple

import numpy as np

from ..results.peaks import REACH, THROUGH
from ..results.reductions import gained

SECTORS = 72
"""Parts of the period whose largest values are limited one by one: where peaks compete, each counts."""
WIDER = 12
"""The same where each largest value is taken with each smallest."""
SIDES = {"largest": (1.0,), "smallest": (-1.0,), "largest_absolute": (1.0, -1.0), "swing": (1.0, -1.0)}
"""By reduction that is a largest value: which sides of a quantity, or its integral, its extreme is on."""
_AROUND = np.arange(-REACH, REACH + 1)
_ORDERS = np.arange(2 * REACH + 1)


class Curve(NamedTuple):
    """Values (N,) of a quantity evenly over the period, and their derivatives (n, N)."""

    values: np.ndarray
    slopes: np.ndarray

    def reduced(self, reduction, turns=1):
        """Value of a reduction, and its derivatives (n,)."""
        return reduced(reduction, self, turns)

    def bounded(self, reduction, turns=1):
        """Values (parts,) whose largest is a reduction of `SIDES`, with derivatives (n, parts)."""
        return bounded(reduction, self, turns)


def size(values, slopes) -> Curve:
    """Magnitude of a vector, from its components (2, N) and their derivatives (n, 2, N)."""
    found = np.hypot(*values)
    towards = values / np.maximum(found, np.finfo(float).tiny)
    return Curve(found, np.einsum("cn,kcn->kn", towards, slopes))


def reduced(reduction, curve, turns=1):
    """Value of a reduction, and its derivatives (n,), of a curve over some turns."""
    if reduction in WEIGHTED:
        value, weights = WEIGHTED[reduction](curve.values)
        return value, curve.slopes @ weights
    if reduction == "swing":
        value, slopes = reduced("range", Curve(gained(curve.values), gained(curve.slopes)))
        return turns * value, turns * slopes
    if reduction == "range":
        (high, above), (low, below) = (top(curve, side) for side in (1.0, -1.0))
        return high + low, above + below
    if reduction == "largest_absolute":
        return max((top(curve, side) for side in (1.0, -1.0)), key=lambda pair: pair[0])
    if reduction in ("largest", "smallest"):
        side = 1.0 if reduction == "largest" else -1.0
        value, slopes = top(curve, side)
        return side * value, side * slopes
    return _harmonic(curve, turns * int(reduction.removeprefix("harmonic_")))


def bounded(reduction, curve, turns=1):
    """Values (parts,) whose largest is a reduction of `SIDES`, of "smallest" its negative, with derivatives (n, parts).

    Where peaks compete, each counts.
    """
    if reduction != "swing":
        parts = [tops(curve, side) for side in SIDES[reduction]]
        return np.concatenate([values for values, _ in parts]), np.concatenate([slopes for _, slopes in parts], axis=1)
    energy = Curve(turns * gained(curve.values), turns * gained(curve.slopes))
    (high, above), (low, below) = (tops(energy, side, WIDER) for side in SIDES[reduction])
    pairs = above[:, :, None] + below[:, None, :]
    return np.add.outer(high, low).ravel(), pairs.reshape(len(pairs), -1)


def top(curve, side):
    """Largest value, times a side, and its derivatives."""
    values, slopes = tops(curve, side, 1)
    return values[0], slopes[:, 0]


def tops(curve, side, sectors=SECTORS):
    """Largest value, times a side, in each of some equal parts of the period (parts,), with derivatives (n, parts).

    A peak between samples is that of the polynomial through the samples around it, where they go together.
    """
    values = side * curve.values
    count = values.size
    length = next(length for length in range(-(-count // sectors), count + 1) if count % length == 0)
    highest = np.arange(0, count, length) + values.reshape(-1, length).argmax(axis=1)
    near = (highest[:, None] + _AROUND) % count
    samples = values[near]
    weights = _through_peaks(samples)
    return np.einsum("sw,sw->s", weights, samples), side * np.einsum("sw,ksw->ks", weights, curve.slopes[:, near])


def _through_peaks(samples):
    """Weights of the samples around peaks (peaks, samples) in their heights; of the middle one alone where need be.

    That is, where it is no peak, or the samples do not go together, as at a jump.
    """
    bends = np.diff(samples, 2)[:, REACH - 2 : REACH + 1]
    peaks = np.flatnonzero((bends < 0).all(axis=1) & (samples[:, REACH - 1 : REACH + 2].argmax(axis=1) == 1))
    weights = np.tile((_AROUND == 0).astype(float), (len(samples), 1))
    series = samples[peaks] @ THROUGH.T
    first = series[:, 1:] * _ORDERS[1:]
    second = first[:, 1:] * _ORDERS[1:-1]
    place = parabola = 0.5 * (samples[peaks, REACH - 1] - samples[peaks, REACH + 1]) / bends[peaks, 1]
    with np.errstate(all="ignore"):
        for _ in range(3):
            powers = place[:, None] ** _ORDERS
            slope = np.einsum("pk,pk->p", first, powers[:, :-1])
            place = place - slope / np.einsum("pk,pk->p", second, powers[:, :-2])
        good = (abs(place) < 1.0) & (abs(place - parabola) <= 0.2)
    weights[peaks[good]] = place[good, None] ** _ORDERS @ THROUGH
    return weights


def _mean(values):
    return values.mean(), np.full(values.size, 1.0 / values.size)


def _mean_absolute(values):
    """Mean magnitude: samples less what their kinks add, where the sign changes on a straight line between two."""
    count = values.size
    sign, weights = np.where(values < 0.0, -1.0, 1.0), np.zeros(count)
    here = np.flatnonzero(sign != np.roll(sign, -1))
    there = (here + 1) % count
    before, after = abs(values[here]), abs(values[there])
    both = before + after
    excess = np.sum(before * after / both - both / 6.0)
    weights += sign
    np.add.at(weights, here, -sign[here] * ((after / both) ** 2 - 1.0 / 6.0))
    np.add.at(weights, there, -sign[there] * ((before / both) ** 2 - 1.0 / 6.0))
    return (abs(values).sum() - excess) / count, weights / count


def _rms(values):
    found = np.sqrt(np.mean(values * values))
    return found, values / (values.size * found) if found else np.zeros(values.size)


WEIGHTED = {"mean": _mean, "mean_absolute": _mean_absolute, "rms": _rms}
"""By reduction: function of values to the number, and its derivatives by each value."""


def _harmonic(curve, order):
    count = curve.values.size
    wave = np.exp(2j * np.pi * order * np.arange(count) / count) * ((1.0 if order == 0 else 2.0) / count)
    amplitude = curve.values @ wave
    value = abs(amplitude)
    return value, np.real(np.conj(amplitude) / (value or 1.0) * (curve.slopes @ wave))
