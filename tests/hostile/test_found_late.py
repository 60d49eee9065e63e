"""What the last look before the release found: results of functions, ratios of nothing, limits counted as gaps."""

import datetime as dt
import math

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.mechanics import assembly
from kinetostatics.numbers.units import to_si
from kinetostatics.results.comparison import _ratio
from kinetostatics.results.reductions import FOUND, parsed
from support.every import every

TURN = 2 * np.pi * np.arange(72) / 72
BODIES = {"coupler": ks.Link(3.0, 1.5, 2.0), "rocker": ks.Link(2.0, 1.0, 1.0)}


def crank_slider(crank_length=0.3):
    return ks.crank_slider(crank_length, 1.1, coupler=ks.Link(2.0, 0.5, 0.2), slider=ks.Link(3.0))


def loaded(force, **period):
    return ks.solve(crank_slider(), TURN, crank_speed=5.0, loads=[ks.ProcessForce(force, **period)])


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow_start)])
@pytest.mark.parametrize(
    ("force", "words"),
    [
        (lambda motion: np.ma.array(np.cos(motion.crank_angle), mask=motion.crank_angle > 3), "masked array"),
        (lambda motion: np.timedelta64(5, "s"), "a time"),
        (lambda motion: dt.timedelta(5), "a time"),
        (lambda motion: True, "a truth value"),
        (lambda motion: "5", "a text"),
        (lambda motion: 5j, "a complex number"),
        (lambda motion: {}, "no number"),
    ],
)
def test_a_function_must_return_plain_numbers(force, words, engine):
    if engine == "compiled":
        pytest.importorskip("numba")
    with pytest.raises(ks.ParameterError, match=r"ProcessForce on 'slider': its function must return") as found:
        _ = ks.solve(
            crank_slider(), TURN, crank_speed=5.0, loads=[ks.ProcessForce(force)], engine=engine
        ).balancing_torque
    assert words in str(found.value)


@pytest.mark.parametrize("value", [np.timedelta64(1, "s"), np.timedelta64("NaT"), np.array([[1]], dtype="m8[s]")])
def test_times_of_numpy_are_no_lengths(value):
    with pytest.raises(ks.ParameterError, match=r"crank length must be a number .*(a time|of timedelta64)"):
        crank_slider(value)


def test_a_crank_without_length_says_what_it_is_for():
    with pytest.raises(ks.ParameterError, match="give the crank a length, or put a CamRoller before it"):
        crank_slider(None)


@pytest.mark.parametrize("turns", [101, 1000, 10**6, 10**15])
def test_a_period_is_no_longer_than_can_be_sampled(turns):
    with pytest.raises(ks.ParameterError, match="period must be at most 100 turns"):
        ks.ProcessForce(1.0, period=2 * math.pi * turns)


def test_loads_must_repeat_together_soon():
    loads = [ks.ProcessForce(1.0, period=2 * math.pi * turns) for turns in (7, 11, 13)]
    with pytest.raises(ks.ParameterError, match="repeat after 7, 11, 13 turns do so together after 1001 only, 100 at"):
        ks.solve(crank_slider(), TURN, crank_speed=5.0, loads=loads)


@every(
    ("reference", "balanced", "ratio"),
    [
        (0.0, 0.0, np.nan),
        (np.inf, np.inf, np.nan),
        (np.inf, 5.0, np.inf),
        (5.0, np.inf, 0.0),
        (5.0, 0.0, np.inf),
        (0.0, 5.0, 0.0),
        (np.nan, 5.0, np.nan),
        (5.0, np.nan, np.nan),
        (6.0, 2.0, 3.0),
        (1.0, 1e-13, np.inf),
    ],
)
def test_ratio_of_peaks(reference, balanced, ratio):
    assert _ratio(reference, balanced) == pytest.approx(ratio, nan_ok=True)


def test_nothing_against_nothing_has_no_ratio():
    massless = ks.solve(ks.crank_slider(0.3, 2.0), TURN, crank_speed=5.0)
    assert np.isnan(ks.compare(massless, massless).mean_torque_ratio)


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@pytest.mark.parametrize("lengths", [(1, 3, 2, 4), (1, 2, 1, 2), (2, 2, 1, 1), (1, 2, 2, 1), (1, 2.5, 3, 1.5)])
def test_change_points_compare_equal_to_themselves(lengths):
    """Torque extrema on both sides of a change point are not taken for each other."""
    crank, coupler, rocker, ground = lengths
    mechanism = ks.four_bar(crank, coupler, rocker, rocker_pivot=(ground, 0), **BODIES)
    solution = ks.solve(mechanism, TURN + 0.05, crank_speed=5.0, loads=[ks.Gravity()])
    assert ks.compare(solution, solution).torque_extremum_ratios == pytest.approx(1.0, abs=1e-9)


def test_a_change_point_beside_a_gap_is_no_gap():
    bodies = {"coupler": ks.Link(3.0, 1.5, 0.2), "rocker": ks.Link(2.0, 1.0, 0.1)}
    mechanism = ks.four_bar(0.4, 0.3, 0.4, rocker_pivot=(0.5, 0), **bodies)
    gaps = assembly.gap_intervals(mechanism)
    assert np.degrees(gaps) == pytest.approx(np.array([[101.536959, 258.463041]]))
    solution = ks.solve(mechanism, np.linspace(0.5, 1.0, 20), crank_speed=5.0, loads=[ks.Gravity()])
    with pytest.warns(ks.ConditionWarning, match="around crank angles 0 deg no value has a correct digit"):
        ks.extremes(solution, "balancing_torque")


@pytest.mark.parametrize(
    ("turns", "words"), [(0, "near a limit position"), (10**9, "many turns from 0"), (10**12, "many turns from 0")]
)
def test_the_warning_names_its_cause(turns, words):
    mechanism, angle = (crank_slider(), 1.0) if turns else (ks.crank_slider(1, 1, slider=ks.Link(1)), 1.5708)
    with pytest.warns(ks.ConditionWarning, match=words):
        ks.solve(mechanism, [angle + 2 * np.pi * turns], crank_speed=5.0)


@pytest.mark.parametrize("text", ["1e-400 m", "0.0001e-330 mm", "-3e-999 km"])
def test_numbers_too_small_are_not_zero(text):
    with pytest.raises(ValueError, match="too small for double precision"):
        to_si(text, "m")


@pytest.mark.parametrize("text", ["0 m", "0.000 mm", "0e5 km", "-0 m"])
def test_zero_is_zero(text):
    assert to_si(text, "m") == 0.0


def test_output_needs_a_quantity_first():
    with pytest.raises(ks.ParameterError, match="must be a reduction and a quantity") as found:
        parsed("largest")
    assert "did you mean" not in str(found.value)


def test_gaps_alone_are_no_reason_to_warn():
    swinging = ks.crank_slider(1.0, 0.8, slider=ks.Link(2.0))
    torque = ks.solve(swinging, TURN, crank_speed=5.0, on_gap="nan").balancing_torque
    assert 0 < np.isnan(torque).sum() < torque.size


@pytest.mark.slow_start
@pytest.mark.parametrize(("values", "kind"), [([True, False], "bool"), ([600j], "complex128")])
def test_designs_are_real_numbers(values, kind):
    designs = pd.DataFrame({"slider.mass [kg]": values})
    with pytest.raises(ks.ParameterError, match=rf"'slider.mass \[kg\]' must hold numbers, but is of type {kind}"):
        ks.sweep(ks.load_case("sawframe_2r63"), designs, ["largest O"], variant="plain")


@pytest.mark.slow_start
def test_mean_magnitudes_of_samples_know_their_kinks():
    """360 samples gave the mean torque to 5e-5 only, and the estimate of the error was up to 14 times too small."""
    case = ks.load_case("sawframe_2r63")
    true = ks.compare(case.solve("plain"), case.solve("plain")).mean_torques[0]
    for angles in (24, 48, 72, 180, 360, 720):
        found, error = FOUND["mean_absolute"](case.solve("plain", angles).balancing_torque[None])
        assert abs(found - true) <= error
        assert abs(found / true - 1) < 20.0 * angles**-3.0


@pytest.mark.parametrize(("values", "mean"), [([0.0] * 12, 0.0), ([-2.0] * 12, 2.0), ([-0.0, 0.0] * 6, 0.0)])
def test_mean_magnitudes_of_constants(values, mean):
    assert FOUND["mean_absolute"](np.array([values]))[0] == mean


@pytest.mark.parametrize("mass", ["2 ton", "3 tons", "1 kN s^2/m ton"])
def test_an_ambiguous_ton_is_refused(mass):
    with pytest.raises(ValueError, match="is not known"):
        to_si(mass, "kg")
    assert to_si("2 t", "kg") == to_si("2 tonne", "kg") == 2000.0
