"""Commands for sweeps and uncertainties."""

import io
import json
import sys
import warnings

import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cli import main, sweep_commands
from support.case_files import shipped
from support.every import every

SWEEP = ["sweep", "sawframe_2r63", "--variant", "cam-circle", "--vary", "slider.mass=600..650 kg:3"]


@pytest.mark.slow
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


@pytest.mark.slow
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
    assert told.startswith(shipped("sawframe_2r63").title)
    assert told.endswith(words)


def test_json_names_swept_variant_and_reference(capsys):
    assert main(["sweep", "sawframe_2r63", "--vary", "slider.mass=600..650 kg:2", "--angles", "12", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["variant"], found["reference"]) == ("cam-circle", "plain")


def test_best_designs_say_which_way_a_ratio_is_better(capsys):
    assert main([*SWEEP, "--output", "ratio mean_absolute balancing_torque"]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "largest first: above 1 is in favour of the design" in words


@pytest.mark.slow
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


# The option that tells how sure the largest values are

CASE = "sawframe_2r63"
SAW = ks.load_case(CASE)
PLAIN = ["run", CASE, "--variant", "plain", "--angles", "36", "--uncertain", "crank_length=0.01 mm"]


def test_sizes_go_to_the_variants_with_that_number():
    found = sweep_commands.standard_uncertainties(
        SAW, ["plain", "cam-cosine"], ["crank_length=0.01 mm", "slider.mass = 2 kg"]
    )
    wanted = {"crank_length": pytest.approx(1e-5), "slider.mass": 2.0}
    assert found == {"plain": wanted, "cam-cosine": {"slider.mass": 2.0}}


def test_given_sizes_precede_tolerances_of_the_case():
    found = sweep_commands.standard_uncertainties(SAW, ["cam-circle"], ["tolerances", "slider.mass=2 kg"])["cam-circle"]
    assert found["spring.stiffness"] == pytest.approx(7e3)
    assert found["block.mass"] == pytest.approx(20.0 / 12.0**0.5)  # uniform
    assert found["slider.mass"] == 2.0
    assert set(found) == set(SAW.tolerances)


@every(("texts", "message"), [
    (["foo"], "cannot read 'foo'; write path=size"), (["=1 mm"], "parameter is ''"), (["crank_length="], "unit"),
    (["crank_lenth=1 mm"], "did you mean 'crank_length'"), (["crank_length=0.1"], "has no unit"),
    (["slider.mass=1 m"], "does not measure the same"), (["crank_length=-1 mm"], "must not be negative"),
    (["crank_lenth=1 mm", "slider.mass=1 m"], "crank_lenth.*slider.mass"),
    (["slider.mass=1 kg", "slider.mass=2 kg"], "slider.mass is given more than once"),
])  # fmt: skip
def test_what_is_no_uncertainty_is_refused_all_at_once(texts, message):
    with pytest.raises(ks.ParameterError, match=message):
        sweep_commands.standard_uncertainties(SAW, ["plain"], texts)


def test_a_case_without_tolerances_says_so():
    with pytest.raises(ks.ParameterError, match=r"toggle_press.toml has no \[tolerances\]"):
        sweep_commands.standard_uncertainties(shipped("toggle_press"), ["idle"], ["tolerances"])


@pytest.mark.slow
def test_run_prints_uncertainty_and_its_sources(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "130")
    assert main(PLAIN) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("balancing") and "+-" in line)
    *told, rounding, path, share = line.split()[4:]
    assert told == ["40578.9", "+-", "2.9", "39.289", "2.9"]
    assert 1e-11 < float(rounding) < 1e-9
    assert (path, share) == ("crank_length", "100")


@pytest.mark.slow
def test_number_of_no_variant_is_refused(capsys):
    assert main([*PLAIN[:2], "--variant", "cam-cosine", "--uncertain", "crank_length=1 mm"]) == 2
    assert "did you mean" in capsys.readouterr().err
    assert main([*PLAIN[:2], "--angles", "36", "--uncertain", "cam.radius=1 mm"]) == 0
    assert capsys.readouterr().out.count("this variant has none of the uncertain numbers") == 5


@pytest.mark.slow
def test_json_has_all_digits(capsys):
    assert main([*PLAIN, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["variants"]["plain"]["uncertainty"]
    assert told["inputs"] == {"crank_length": pytest.approx(1e-5)}
    solution = SAW.solve("plain", 36)
    found = ks.extremes(solution, "O")
    wanted = solution.at(found.angle[found.value.argmax()]).uncertainty("|O|", told["inputs"])
    assert told["largest"]["reaction O"]["tolerance"] == pytest.approx(float(wanted.tolerance), rel=1e-12)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:toggle press. the uncertainties of .* are of first order")
def test_uncertainty_shares_are_rounded_up(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "130")
    press = ["run", "toggle_press", "--variant", "coining", "--angles", "36", "--uncertain", "crank_length=0.05 mm"]
    assert main([*press, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["variants"]["coining"]["uncertainty"]["largest"]
    assert main(press) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if "+-" in line]
    assert len(lines) == len(found) > 10
    for line, row in zip(lines, found.values(), strict=True):
        total, (tolerance, rounding) = line.partition("+-")[2].split()[0], line.split()[-4:-2]
        assert float(tolerance) >= row["tolerance"]
        assert float(rounding) >= row["rounding"]
        assert (total == tolerance) or row["tolerance"] < 1e6 * row["rounding"]


@pytest.mark.slow
def test_a_warning_is_printed_once_without_code(capsys):
    press = ["run", "toggle_press", "--variant", "coining", "--angles", "36", "--uncertain", "crank_length=0.05 mm"]
    before = warnings.formatwarning
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = lambda *given, **_: sys.stderr.write(warnings.formatwarning(*given[:4]))
        assert main(press) == 0
    (told,) = [line for line in capsys.readouterr().err.splitlines() if "first order" in line]
    assert told.startswith("kinetostatics: warning: toggle press: the uncertainties of guide_force2, A, B, ")
    assert warnings.formatwarning is before
