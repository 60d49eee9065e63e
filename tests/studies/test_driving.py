"""Methods for periodic running and motions over time: honest ones, which reach the same results."""

import json
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies import driving
from kinetostatics.studies.methods import motion, running
from kinetostatics.studies.methods.exact_running import exact_speed
from kinetostatics.views import charts
from support import DATA

REFERENCE = json.loads((DATA / "driven_sawframe.json").read_text(encoding="utf-8"))
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
IDLE = ks.Scene(SAW, 33.5, loads=ks.Gravity())
CUT = ks.ProcessForce(ks.Table(np.radians([7.0, 20.0, 173.0, 187.0, 340.0]), [0.0, 8e3, 8e3, 0.0, 0.0]))
CUTTING = ks.Scene(SAW, 33.5, loads=(ks.Gravity(), CUT))
ANGLES = np.arange(24) * np.pi / 12
BY_NAME = {method.name: method for method in running.METHODS}


def test_running_at_many_digits_is_that_of_the_reference_which_shares_no_formula():
    pytest.importorskip("flint")
    found = exact_speed(running.Problem(IDLE, MOTOR, 1000.0, ANGLES).driven, ANGLES)
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < 3e-16


def test_ours_is_running_at_many_digits_with_a_load_that_has_kinks():
    pytest.importorskip("flint")
    problem = running.Problem(CUTTING, MOTOR, 1000.0, ANGLES)
    found = BY_NAME["ours, NumPy"].prepare(problem, "", None)()
    assert np.abs(found / exact_speed(problem.driven, ANGLES) - 1.0).max() < 2e-14


@pytest.mark.parametrize(
    ("name", "setting", "error"),
    [
        ("stepping until it repeats, DOP853", 1e-3, 1e-2),
        ("stepping until it repeats, LSODA", 1e-5, 1e-3),
        ("shooting, DOP853", 1e-9, 1e-7),
        ("shooting, fixed steps, RK4", 216, 1e-10),
        ("shooting, fixed steps, RK8", 24, 1e-11),
        ("collocation, SciPy solve_bvp", 1e-7, 1e-6),
        ("collocation, Fourier", 33, 1e-10),
        ("collocation, Fourier", 65, 3e-14),
    ],
)
def test_rivals_come_to_the_same_running(name, setting, error):
    problem = running.Problem(IDLE, MOTOR, 1000.0, ANGLES)
    found = BY_NAME[name].prepare(problem, "", setting)()
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < error


@pytest.mark.parametrize("name", motion.BENCHMARKS)
@pytest.mark.parametrize(
    ("method", "setting", "error"),
    [("ours, NumPy", None, 1e-11), ("reduced inertia, RK45", 1e-7, 1e-3), ("reduced inertia, LSODA", 1e-9, 1e-4)],
)
def test_methods_reach_the_published_ends_of_motions(name, method, setting, error):
    problem = motion.BENCHMARKS[name]()
    (found,) = (one for one in motion.METHODS if one.name == method)
    assert abs(found.prepare(problem, "", setting)() - problem.exact) < error


def test_constraint_equations_reach_the_published_end_and_refuse_singular_positions():
    (constraints,) = (one for one in motion.METHODS if one.name.startswith("constraint"))
    problem = motion.slider_crank()
    assert abs(constraints.prepare(problem, "", 1e-5)() - problem.exact) < 1e-6
    with pytest.raises(ks.errors.NotGivenError, match="change points"):
        constraints.prepare(motion.n_four_bar(), "", 1e-5)


def test_a_study_of_running_is_a_chart_with_units(tmp_path):
    pytest.importorskip("flint")
    methods = [BY_NAME["ours, NumPy"], replace(BY_NAME["collocation, Fourier"], settings=(9, 17, 33))]
    table = driving.study_running(IDLE, MOTOR, 1000.0, methods=methods, repeats=1)
    assert table.set_index("method").loc["ours, NumPy", "error"] < 1e-14
    assert (table["time [ms]"] > 0.0).all()
    paths = charts.drive_page({"saw, idle": table}, tmp_path / "drive")
    assert [path.name for path in paths] == ["drive.png", "drive.svg"]
    ax = charts.work_precision(table)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [ms]", "error of the crank speed [1]")


@pytest.mark.parametrize(
    ("call", "kind", "words"),
    [
        (
            lambda: driving.study_running(ks.Scene(SAW, 1.0, loads=ks.TorsionDamper(1.0, on="crank")), MOTOR),
            ks.errors.NotGivenError,
            "do not depend on the speed",
        ),
        (
            lambda: driving.study_running(IDLE, ks.drive.Motor.linear(9.0, 9.0, transmission=-1.0), 1.0),
            ks.errors.NotGivenError,
            "counter-clockwise",
        ),
        (lambda: driving.study_motion("slider crank"), ks.ParameterError, "allowed: 'slider-crank of SUNDIALS'"),
    ],
)
def test_what_cannot_be_studied_says_why(call, kind, words):
    with pytest.raises(kind, match=words):
        call()
