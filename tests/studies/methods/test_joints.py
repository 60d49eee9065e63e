"""Other ways to the motion of the joints: the error of each falls as its theory says."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies import precision
from kinetostatics.studies.precision import METHODS
from support.studied import torque_study

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")


@pytest.fixture(scope="module")
def torque():
    return torque_study()


def curve(table, method, first, last):
    """Settings and errors of a method over a stretch of its settings."""
    rows = table[(table["method"] == method) & table["value"].between(first, last)]
    return rows["value"].to_numpy(), rows["error"].to_numpy()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "order", "coarsest", "finest"),
    [("differences, 2nd order", 2, 1e-1, 1e-3), ("differences, 4th order", 4, 3e-1, 3e-2)],
)
def test_difference_error_falls_by_its_order(torque, method, order, coarsest, finest):
    """At steps from which rounding, which the step squared divides, is less than a hundredth of the error."""
    step, error = curve(torque, method, finest, coarsest)
    slopes = np.diff(np.log(error)) / np.diff(np.log(step))
    assert slopes == pytest.approx(order, abs=0.07)


@pytest.mark.parametrize("method", ["differences, 2nd order", "differences, 4th order"])
def test_difference_error_rises_again_by_rounding(torque, method):
    _, error = curve(torque, method, 0.0, 1e-3)
    assert error[-1] > 20 * error.min()
    assert error[-1] < 1e3 * 2.0**-53 / (1e-5 if "2nd" in method else 1e-4) ** 2


SINGULARITY = np.arccosh(2.0 / 0.3)
"""Crank angles pi/2 + i times this make the root in the kinematics zero; Fourier coefficients fall as exp(-k times it)
(see e.g. Trefethen, *Spectral Methods in MATLAB*, chapter 4).
"""


def test_spectral_error_falls_geometrically(torque):
    samples, error = curve(torque, "spectral differentiation", 8, 24)
    rates = -np.diff(np.log(error)) / np.diff(samples)
    assert rates == pytest.approx(SINGULARITY / 2, rel=0.03)


def test_spectral_turn_may_begin_at_any_angle():
    pump = ks.crank_slider(0.1, 0.5, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0))
    turn = np.linspace(0, 2 * np.pi, 36, endpoint=False) + np.pi / 36
    rubbing = {"guide": ks.GuideFriction(0.1), "O": ks.PinFriction(0.05, 0.02)}
    solution = ks.solve(pump, turn, crank_speed=10.0, loads=ks.Gravity(), friction=rubbing)
    (method,) = [method for method in METHODS if method.name == "spectral differentiation"]
    found = method.prepare(solution, "balancing_torque", 32)()
    assert np.abs(found - solution.balancing_torque).max() < 1e-10 * np.abs(solution.balancing_torque).max()
    uneven = solution.at(turn**1.01)
    with pytest.raises(ks.NotGivenError, match="even crank angles over one turn, end excluded"):
        method.prepare(uneven, "balancing_torque", 32)


def test_harmonic_series_error_falls_geometrically(torque):
    """The plain crank-slider on a guide through O has even harmonics only."""
    harmonics, error = curve(torque, "harmonic series", 2, 6)
    rates = -np.diff(np.log(error)) / np.diff(harmonics)
    assert rates == pytest.approx(SINGULARITY, rel=0.03)


def test_two_masses_need_the_mass_between_joints():
    """One of them would be negative, and the table says so."""
    mechanism = ks.crank_slider(0.3, 1.0, coupler=ks.Link(10.0, (-0.2, 0.0), 1.0), slider=ks.Link(5.0))
    solution = ks.solve(mechanism, np.linspace(0, 2 * np.pi, 12, endpoint=False), crank_speed=10.0)
    methods = [method for method in METHODS if method.name.startswith("two-mass")]
    table = precision.study(solution, methods=methods, repeats=1)
    assert len(table) == 2
    assert table["error"].isna().all()
    assert table["not given"].str.contains("is beyond its joints, so one of two masses at them would be negative").all()
