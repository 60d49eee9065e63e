"""The command ``sweep``: outputs of designs for people and for other programs."""

import io
import json

import pandas as pd
import pytest

from kinetostatics.cli import main

SWEEP = ["sweep", "sawframe_2r63", "--variant", "cam-circle", "--vary", "slider.mass=600..650 kg:3"]


def test_json_and_csv_hold_every_design_in_full(tmp_path, capsys):
    figure = tmp_path / "map.png"
    assert main([*SWEEP, "--json", "--plot", str(figure)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert main([*SWEEP, "--csv"]) == 0
    table = pd.read_csv(io.StringIO(capsys.readouterr().out), float_precision="round_trip")
    assert found["files"] == [str(figure)]
    assert found["failed"] == 0
    assert found["designs"] == table.assign(failed="").to_dict("records")
    assert len(table) == 3


def test_best_designs_say_which_way_a_ratio_is_better(capsys):
    assert main([*SWEEP, "--output", "ratio mean_absolute balancing_torque"]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "largest first: above 1 is in favour of the design" in words


def test_a_variant_with_friction_tells_what_it_loses_unasked(capsys):
    arguments = ["sweep", "sawframe_2r63_friction", "--variant", "plain", "--vary", "slider.mass=600..650 kg:2"]
    assert main(arguments) == 0
    assert "friction_loss" in capsys.readouterr().out


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_a_table_is_written_and_told(tmp_path, ending, capsys):
    path = tmp_path / f"designs{ending}"
    assert main([*SWEEP, "--out", str(path)]) == 0
    assert f"wrote {path}: 3 rows" in capsys.readouterr().out
    assert path.stat().st_size
