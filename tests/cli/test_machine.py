"""Results for other programs: JSON and CSV of the commands, whole, exact, and alone on standard output."""

import csv
import io
import json
import math
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.cli import main, output
from support.case_files import shipped
from support.every import every

pytestmark = pytest.mark.slow


def test_json_of_run_has_the_true_extremes(capsys):
    assert main(["run", "sawframe_2r63_friction", "--variant", "cam-cosine", "--json", "--angles", "72"]) == 0
    found = json.loads(capsys.readouterr().out)
    solution = shipped("sawframe_2r63_friction").solve("cam-cosine", 72)
    told = found["variants"]["cam-cosine"]
    assert told["extremes"]["balancing_torque"]["largest"] == ks.extremes(solution, "balancing_torque").largest
    assert told["extremes"]["balancing_torque"]["unit"] == "N m"
    assert told["power_residual"] == solution.power_residual
    assert told["drive"]["mean_torque [N m]"] == solution.mean_torque
    assert told["drive"]["mean_power [W]"] == solution.mean_power
    assert told["drive"]["energy_per_turn [J]"] == solution.energy_per_turn
    assert told["losses"]["lost [W]"] == solution.losses.total
    assert told["losses"]["at"]["guide"]["mean [W]"] == solution.losses.friction["guide"]


def test_csv_of_run_is_the_table_of_every_angle(capsys):
    assert main(["run", "sawframe_2r63", "--variant", "plain", "--angles", "36", "--csv"]) == 0
    rows = csv.DictReader(io.StringIO(capsys.readouterr().out))
    solution = shipped("sawframe_2r63").solve("plain", 36)
    assert [float(row["balancing_torque [N m]"]) for row in rows] == solution.balancing_torque.tolist()


def test_a_file_of_run_and_json_go_together(tmp_path, capsys):
    path = tmp_path / "all.csv"
    arguments = ["run", "sawframe_2r63", "--variant", "plain", "--angles", "36", "--json", "--csv", str(path)]
    assert main(arguments) == 0
    json.loads(capsys.readouterr().out)
    assert len(pd.read_csv(path)) == 36


def test_list_gives_each_shipped_case_with_variants(capsys):
    assert main(["list", "--json"]) == 0
    cases = json.loads(capsys.readouterr().out)["cases"]
    assert [case["name"] for case in cases] == list(shipped_cases())
    assert main(["list", "--csv"]) == 0
    table = pd.read_csv(io.StringIO(capsys.readouterr().out))
    assert list(table["name"]) == list(shipped_cases())


def test_plot_gives_its_files(tmp_path, capsys):
    assert main(["plot", "yoke_pump", "--only", "torque", "--out", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["files"] == [str(tmp_path / "yoke_pump_torque.png")]


def test_both_on_standard_output_are_refused(capsys):
    assert main(["run", "sawframe_2r63", "--json", "--csv"]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert "give --csv a FILE" in told.err


VALUES = {
    "NaN": (math.nan, None),
    "infinity": (math.inf, "Infinity"),
    "minus infinity": (-math.inf, "-Infinity"),
    "NumPy's number": (np.float64(0.1), 0.1),
    "NumPy's truth": (np.bool_(True), True),
    "an array": (np.array([1.0, math.nan]), [1.0, None]),
    "a table": (pd.DataFrame({"a [m]": [1.0, math.nan]}), [{"a [m]": 1.0}, {"a [m]": None}]),
    "a real small number": (1e-300, 1e-300),
}


@every("name", VALUES)
def test_values_of_every_kind_are_numbers_of_json(name, capsys):
    given, wanted = VALUES[name]
    output.deliver(SimpleNamespace(word="x", json=True), lambda: {"value": given})
    assert json.loads(capsys.readouterr().out)["value"] == wanted


@pytest.mark.parametrize(("options", "terminal", "seen"), [
    ({}, True, True),
    ({}, False, False),
    ({"json": True}, True, False),
    ({"csv": "-"}, True, False),
    ({"csv": "x.csv"}, True, True),
])  # fmt: skip
def test_progress_shows_on_terminals_only(options, terminal, seen, monkeypatch):
    stream = io.StringIO()
    stream.isatty = lambda: terminal
    monkeypatch.setattr("sys.stderr", stream)
    assert list(output.progress(SimpleNamespace(**options), ["one", "two"], "solving")) == ["one", "two"]
    assert ("one" in stream.getvalue()) == seen
