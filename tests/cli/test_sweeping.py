"""The command ``sweep``: outputs of designs for people and for other programs."""

import io
import json

import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.every import every

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


@every(
    "options, words",
    [
        ([], "variant cam-circle, the first besides the reference plain (another by --variant)"),
        (["--variant", "plain"], "variant plain"),
        (
            ["--reference", "cam-circle"],
            "variant plain, the first besides the reference cam-circle (another by --variant)",
        ),
        (["--output", "ratio largest O"], "(another by --variant); ratios refer to plain"),
        (["--variant", "plain", "--reference", "cam-cosine", "--output", "ratio largest O"], "refer to cam-cosine"),
    ],
)
def test_the_swept_variant_is_named_with_the_reason(options, words, capsys):
    vary = ["--vary", "slider.mass=600..650 kg:2", "--angles", "12"]
    assert main(["sweep", "sawframe_2r63", *vary, *options]) == 0
    told = " ".join(capsys.readouterr().out.split("\n\n")[0].split())
    assert told.startswith(ks.load_case("sawframe_2r63").title)
    assert told.endswith(words)


def test_json_names_swept_variant_and_reference(capsys):
    assert main(["sweep", "sawframe_2r63", "--vary", "slider.mass=600..650 kg:2", "--angles", "12", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["variant"], found["reference"]) == ("cam-circle", "plain")


def test_best_designs_say_which_way_a_ratio_is_better(capsys):
    assert main([*SWEEP, "--output", "ratio mean_absolute balancing_torque"]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "largest first: above 1 is in favour of the design" in words


def test_losses_of_a_variant_with_friction_are_shown(capsys):
    arguments = ["sweep", "sawframe_2r63_friction", "--variant", "plain", "--vary", "slider.mass=600..650 kg:2"]
    assert main(arguments) == 0
    assert "friction_loss" in capsys.readouterr().out


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_a_table_is_written_and_told(tmp_path, ending, capsys):
    path = tmp_path / f"designs{ending}"
    assert main([*SWEEP, "--out", str(path)]) == 0
    assert f"wrote {path}: 3 rows" in capsys.readouterr().out
    assert path.stat().st_size
