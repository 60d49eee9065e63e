"""Studies of running and of motions over time: tables with units, charts, and what cannot be studied."""

import platform
import time
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies.methods import method, running
from kinetostatics.views import charts
from support.drives import BY_NAME, IDLE, MOTOR, SAW

pytestmark = pytest.mark.slow


def test_a_study_of_running_is_a_chart_with_units(tmp_path):
    pytest.importorskip("flint")
    methods = [BY_NAME["ours, NumPy"], replace(BY_NAME["collocation, Fourier"], settings=(9, 17, 33))]
    table = running.study_running(IDLE, MOTOR, 1000.0, methods=methods, repeats=1)
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
            lambda: running.study_running(ks.Scene(SAW, 1.0, loads=ks.TorsionDamper(1.0, on="crank")), MOTOR),
            ks.errors.NotGivenError,
            "do not depend on the speed",
        ),
        (
            lambda: running.study_running(IDLE, ks.drive.Motor.linear(9.0, 9.0, transmission=-1.0), 1.0),
            ks.errors.NotGivenError,
            "counter-clockwise",
        ),
        (lambda: running.study_motion("slider crank"), ks.ParameterError, "allowed: 'slider-crank of SUNDIALS'"),
    ],
)
def test_what_cannot_be_studied_says_why(call, kind, words):
    with pytest.raises(kind, match=words):
        call()


# How long a function takes, and where that was measured


def test_times_are_those_of_one_call_and_in_order():
    short, long = method.seconds(lambda: time.sleep(0.001), lambda: time.sleep(0.1), repeats=1)
    assert 0.001 <= short < 0.1 <= long < 10.0


def test_machine_and_versions_are_told():
    found = method.circumstances()
    assert f"numpy {np.__version__}" in found["versions"]
    assert platform.python_version() in found["versions"]
    assert "cores" in found["machine"]
