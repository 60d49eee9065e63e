"""The command ``design``: tables, figures and the new case file, and errors as of the other commands."""

import json
import signal

import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.case_files import DUTIES, FRONT, STIFFER, saw_with
from support.commands import held, printed_by

pytestmark = pytest.mark.slow


@pytest.fixture
def saw(tmp_path):
    return saw_with(STIFFER + FRONT, tmp_path)


def test_design_prints_gains_and_writes_a_case(saw, tmp_path, capsys):
    out = tmp_path / "found.toml"
    assert main(["design", str(saw), "--out", str(out), "--plot", str(tmp_path / "figures")]) == 0
    printed, told = capsys.readouterr()
    words = " ".join(printed.split())
    assert "stiffer: greatest ratio mean_absolute balancing_torque, from cam-circle; ratios: plain / design" in words
    row = next(line for line in printed.splitlines() if line.startswith("ratio mean_absolute balancing_torque [1]"))
    assert row.split()[4:5] == ["6.08075"]
    assert float(row.split()[5]) > 20
    assert "spring.stiffness [N/m]" in printed
    assert "evaluations of all derivatives" in printed
    assert "trade: front of largest_absolute cam_force and ratio mean_absolute balancing_torque" in words
    assert f"wrote {out}: stiffer, trade" in printed
    assert told.splitlines() == ["searching for stiffer", "searching for trade"]
    assert len(list((tmp_path / "figures").iterdir())) == 2
    assert main(["compare", str(out), "--variant", "stiffer"]) == 0


def test_duties_are_printed_drawn_and_written_one_by_one(tmp_path, capsys):
    saw, out, figures = saw_with(DUTIES, tmp_path), tmp_path / "found.toml", tmp_path / "figures"
    printed = printed_by(["design", str(saw), "--out", str(out), "--plot", str(figures)], capsys)
    words = " ".join(printed.split())
    assert "balancing_torque, from cam-circle, cutting; ratios: plain / design" in words
    for row in ("mean: ratio mean_absolute", "cam-circle: ratio mean_absolute", "cutting: largest O [N]"):
        assert any(line.startswith(row) for line in printed.splitlines())
    assert sorted(path.stem.rpartition("shared-")[2] for path in figures.iterdir()) == ["cam-circle", "cutting"]
    told = json.loads(printed_by(["design", str(saw), "--json"], capsys))["found"]["shared"]
    assert told["shares"] == {"cam-circle": 0.25, "cutting": 0.75}
    assert told["power_residual"] < 1e-12
    assert main(["compare", str(out), "--variant", "shared-cutting"]) == 0


def test_only_named_designs_are_searched(saw, capsys):
    printed = printed_by(["design", str(saw), "--design", "stiffer", "--starts", "2"], capsys)
    assert "trade" not in printed
    assert "2 of 2 searches gave this result" in printed


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--design", "stifer"], "design is 'stifer', allowed: 'stiffer', 'trade'; did you mean 'stiffer'?"),
        (["--out", "found.csv"], "--out: "),
        (["--out", "."], "--out: . exists already; give another name"),
        (["--out", "/dev/null/found.toml"], "--out: "),
        (["--plot", "/dev/null"], "--plot: "),
    ],
)
def test_what_cannot_be_is_said_before_the_search(saw, capsys, more, message):
    assert main(["design", str(saw), *more]) == 2
    printed, told = capsys.readouterr()
    assert printed == ""
    assert message in told
    assert "searching" not in told


def test_a_case_without_designs_has_nothing_to_find(capsys):
    assert main(["design", "mower_drive"]) == 2
    assert "has no [design.NAME]" in capsys.readouterr().err


def test_the_case_itself_is_not_overwritten(saw, capsys):
    before = saw.read_text()
    assert main(["design", str(saw), "--out", str(saw)]) == 2
    assert saw.read_text() == before


def test_impossible_limit_ends_with_its_reason(tmp_path, capsys):
    saw = saw_with(f'{STIFFER}limits = ["ratio mean_absolute balancing_torque >= 1000"]\n', tmp_path)
    assert main(["design", str(saw), "--out", str(tmp_path / "found.toml")]) == 2
    told = capsys.readouterr().err
    assert "kinetostatics: stiffer: no design that keeps all limits was found" in told
    assert list(tmp_path.iterdir()) == [saw]


def test_tables_of_found_designs_replace_no_file(tmp_path, capsys):
    (tmp_path / "cam.csv").write_text(
        "angle [deg], radius [m]\n" + "".join(f"{step}, 0.3\n" for step in range(0, 360, 5))
    )
    more = '[variants.cut]\nmechanism = "cam-crank-slider"\ncoupler_length = "2 m"\n'
    more += 'cam = { kind = "sampled", table = "cam.csv" }\n'
    saw = saw_with(more + STIFFER.replace("cam-circle", "cut").replace("spring.stiffness", "coupler_length").replace(
        '"600 kN/m", "900 kN/m"', '"1.9 m", "2.1 m"'), tmp_path)  # fmt: skip
    found = tmp_path / "found.toml"
    assert main(["design", str(saw), "--out", str(found)]) == 0
    assert {path.name for path in tmp_path.glob("found*")} == {
        "found.toml",
        "found_cut_cam.csv",
        "found_stiffer_cam.csv",
    }
    assert ks.load_case(found).variant("stiffer").parameters["coupler_length"] == pytest.approx(2.1)
    found.unlink()
    (tmp_path / "found_cut_cam.csv").write_text("angle [rad], radius [m]\n0.0, 0.3\n", encoding="utf-8")
    capsys.readouterr()
    assert main(["design", str(saw), "--out", str(found)]) == 2
    told = capsys.readouterr().err
    assert "found_cut_cam.csv" in told
    assert "exists already" in told
    assert "searching" not in told


@pytest.mark.parametrize(
    ("sent", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_interrupted_search_leaves_no_partial_file(tmp_path, sent, status, word):
    saw = saw_with(STIFFER.replace("angles = 72", "angles = 72\nstarts = 2"), tmp_path)
    arguments = ["design", saw, "--out", tmp_path / "found.toml"]
    with held("kinetostatics.design.optimisation", "search_from", arguments) as process:
        process.send_signal(sent)
        told = process.communicate()[1]
    assert process.returncode == status
    assert told == f"searching for stiffer\nkinetostatics: {word}\n"
    assert list(tmp_path.iterdir()) == [saw]


def test_python_and_the_command_find_the_same(saw, tmp_path, capsys):
    main(["design", str(saw), "--design", "stiffer", "--out", str(tmp_path / "found.toml")])
    found = ks.load_case(saw).designs["stiffer"].find()
    written = ks.load_case(tmp_path / "found.toml").variant("stiffer")
    assert written.parameters["spring.stiffness"] == found.values["spring.stiffness"]
