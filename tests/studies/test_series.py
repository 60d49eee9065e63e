"""Harmonic series: the first harmonics of the motion, and an error that falls with their number."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import Kernels
from kinetostatics.studies import needs as ingredients
from kinetostatics.studies.simplifications import harmonic_series
from support.studied import MECHANISMS, TURN, alone, change, cranked, solved


@pytest.fixture
def few_models(monkeypatch):
    """Of combinations, for tests of simplifications alone."""
    monkeypatch.setattr(ingredients, "MAX_MODELS", 10)


def by_series(solution, order):
    return replace(solution, engine=Kernels(harmonic_series(solution, order)))


@pytest.mark.parametrize("order", [1, 2, 3])
def test_truncated_series_has_the_first_harmonics_of_the_slider_motion(order):
    full = solved(cranked(guide_offset=0.05))
    series = by_series(full, order)
    spectrum = np.fft.rfft(full.slider_acceleration)
    spectrum[order + 1 :] = 0.0
    expected = np.fft.irfft(spectrum, n=TURN.size)
    assert np.max(np.abs(series.slider_acceleration - expected)) < 1e-12 * np.max(np.abs(expected))


@pytest.mark.parametrize("name", MECHANISMS)
def test_error_of_truncated_series_falls_with_the_order(few_models, name):
    full = solved(MECHANISMS[name])
    errors = [change(by_series(full, order), full, "O") for order in (1, 2, 4, 8, 16)]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > 1e-2
    assert errors[-1] < 1e-5
    found = alone(ks.needs(full, "O"))
    assert [found[name].error for name in ("one harmonic", "two harmonics")] == pytest.approx(errors[:2])
