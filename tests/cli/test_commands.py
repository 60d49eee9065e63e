"""Commands and their printed text."""

import json
import math
import re
import subprocess
import sys
import warnings
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.cli import main
from kinetostatics.cli.options import STARTERS
from kinetostatics.cli.output import print_folded, print_table
from kinetostatics.views import figures
from support.case_files import shipped
from support.commands import printed_by
from support.every import every


@pytest.fixture
def broken(tmp_path):
    path = tmp_path / "broken.toml"
    path.write_text('title = "x"\nreference = "a"\n[variants.a]\nmechanism = "crank-slider"\n')
    return path


def test_run_prints_extremes_and_the_power_check(capsys):
    printed = printed_by(["run", "sawframe_2r63", "--variant", "plain"], capsys)
    row = next(line for line in printed.splitlines() if line.startswith("balancing torque  "))
    assert row.split()[-4:] == ["-40237.5", "320.632", "40578.9", "39.289"]  # each extremum beside its angle
    assert "power balance: the torques by equilibrium and by powers differ by" in printed
    assert "drive, exact means over the period: torque 0 N m, power 0 W; energy per turn 0 J" in printed
    assert "cam" not in printed.split("plain: crank-slider")[1]


@pytest.mark.slow
def test_run_prints_who_causes_a_force(capsys):
    options = ["run", "sawframe_2r63", "--variant", "cam-cosine", "--angles", "36", "--shares", "O"]
    printed = printed_by(options, capsys).split("who causes the peak: reaction O")[1]
    rows = {line[:20].strip(): line[20:].split() for line in printed.splitlines()}
    assert rows["inertia of coupler"] == ["19148.3", "97.3", "19149.9", "46.813", "12812.6"]
    assert rows["weight of slider"] == ["0", "0", "0", "0"]
    assert rows["total"][:3] == ["19679.6", "100", "19679.6"]
    found = json.loads(printed_by([*options, "--json"], capsys))["variants"]["cam-cosine"]["shares"]["O"]
    assert found["inertia of coupler"]["share [N]"] == pytest.approx(19148.3, rel=1e-5)


def test_run_refuses_shares_of_what_is_no_force(capsys):
    assert main(["run", "sawframe_2r63", "--angles", "12", "--shares", "slider_velocity"]) == 2
    assert "slider_velocity is not linear in masses and loads" in capsys.readouterr().err


@pytest.mark.slow
def test_run_prints_rounding_as_0_in_chain_order(capsys):
    assert main(["run", "in_line_twin", "--variant", "throws-opposed"]) == 0
    printed = capsys.readouterr().out.split("\n\npower balance")[0]
    assert not re.search(r"e-\d", printed)
    cells = {line[:29].strip(): line[29:].split() for line in printed.splitlines()}
    assert cells["shaking moment"] == ["N", "m", "0", "0"]
    assert cells["reaction guide1"][:2] == ["N", "0"]
    names = list(cells)
    assert names.index("guide force1") < names.index("guide force2")
    assert names.index("reaction guide1") < names.index("reaction C2") < names.index("reaction O")


@pytest.mark.slow
def test_run_writes_all_variants_to_csv_with_units(tmp_path, capsys):
    path = tmp_path / "new" / "saw.csv"
    assert main(["run", "sawframe_2r63", "--angles", "36", "--csv", str(path)]) == 0
    table = pd.read_csv(path)
    assert len(table) == 7 * 36
    assert {"variant", "crank_angle [deg]", "balancing_torque [N m]", "cam_force [N]", "B_x [m]"} <= set(table.columns)
    assert table["cam_force [N]"].isna().sum() == 2 * 36
    assert f"wrote {path}: 252 rows" in capsys.readouterr().out


def draw_nothing(figure, path, *_):
    plt.close(figure)
    return path


@pytest.mark.slow
def test_plot_writes_each_figure_of_the_case(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(figures, "save_figure", draw_nothing)
    assert main(["plot", "sawframe_2r63", "--out", str(tmp_path)]) == 0
    written = sorted(Path(line).name for line in capsys.readouterr().out.splitlines())
    names = ["acceleration_error", "cam_force", "hodograph", "mechanism", "overview"]
    names += ["pressure_angle", "sketch", "torque"]
    compared = [f"sawframe_2r63_{group}{name}.png" for group in ("", "upright-plain_") for name in names]
    assert written == sorted(compared)


@pytest.mark.slow
def test_an_svg_figure_is_reproduced_byte_for_byte(tmp_path):
    for folder in ("a", "b"):
        arguments = ["--out", str(tmp_path / folder), "--format", "svg", "--only", "torque"]
        assert main(["plot", "sawframe_2r63", *arguments]) == 0
    first, second = (tmp_path / folder / "sawframe_2r63_torque.svg" for folder in ("a", "b"))
    assert first.read_bytes() == second.read_bytes()
    assert first.read_bytes().startswith(b"<?xml")


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "no_such_case"],
        ["compare", "sawframe_2r63", "--variant", "cam"],
        ["plot", "sawframe_2r63", "--out", "unused", "--only", "torqe"],
    ],
)
def test_bad_input_ends_with_status_2_and_one_message(arguments, capsys):
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("kinetostatics: ")
    assert len(captured.err.splitlines()) < 24


def test_a_broken_case_writes_nothing(tmp_path, broken, capsys):
    target = tmp_path / "out.csv"
    assert main(["run", str(broken), "--csv", str(target)]) == 2
    assert not target.exists()
    assert "variants.a.crank_length is missing" in capsys.readouterr().err


def test_failed_writing_keeps_the_old_file(tmp_path, monkeypatch, capsys):
    target = tmp_path / "saw.csv"
    target.write_text("old")

    def fails(self, path, **_):
        with open(path, "w") as stream:  # noqa: PTH123
            stream.write("half")
        raise OSError("disk full")

    monkeypatch.setattr(pd.DataFrame, "to_csv", fails)
    assert main(["run", "sawframe_2r63", "--variant", "plain", "--csv", str(target)]) == 2
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]
    assert "disk full" in capsys.readouterr().err


@pytest.mark.slow
def test_module_and_shell_agree_and_show_no_traceback(broken):
    command = [sys.executable, "-m", "kinetostatics", "compare", str(broken)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert done.stderr.startswith(f"kinetostatics: {broken}: 3 problems")


@pytest.mark.slow
def test_single_variant_case_has_no_comparison(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(figures, "save_figure", draw_nothing)
    case = tmp_path / "one.toml"
    case.write_text(
        'title = "one"\nreference = "a"\n[variants.a]\nmechanism = "crank-slider"\ncrank_speed = "60 rpm"\n'
        'crank_length = "0.1 m"\ncoupler_length = "0.4 m"\nslider = { mass = "1 kg" }\n'
    )
    assert main(["run", str(case)]) == 0
    assert main(["plot", str(case), "--out", str(tmp_path)]) == 0
    assert main(["compare", str(case)]) == 2
    assert "nothing to compare" in capsys.readouterr().err


# Cases that are there, and new ones


def test_list_shows_cases_with_title_and_variants(capsys):
    printed = printed_by(["list"], capsys)
    assert re.findall(r"^\S+", printed, re.MULTILINE) == list(shipped_cases())
    words = " ".join(printed.split())
    assert "mower_drive Mower drive: static balancing of an offset crank-slider (unbalanced, full, partial-1" in words


@pytest.mark.slow
@pytest.mark.parametrize("kind", STARTERS)
def test_new_case_compares_and_designs_at_once(tmp_path, monkeypatch, capsys, kind):
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my pump", "--kind", kind]) == 0
    assert capsys.readouterr().out == 'wrote my pump.toml; kinetostatics run "my pump.toml"\n'
    printed = printed_by(["compare", "my pump.toml"], capsys)
    assert printed.startswith("my pump\n")
    assert " / " in printed
    assert main(["design", "my pump.toml"]) == 0
    assert "crank: least largest shaking_force, from " in capsys.readouterr().out


@pytest.mark.slow
def test_a_new_case_is_a_crank_slider_unless_told(tmp_path, capsys):
    assert main(["new", str(tmp_path / "mine")]) == 0
    assert main(["run", str(tmp_path / "mine.toml"), "--variant", "plain", "--angles", "24"]) == 0
    assert "plain: crank-slider" in capsys.readouterr().out


def test_a_new_case_never_takes_the_place_of_a_file(tmp_path, capsys):
    path = tmp_path / "pump.toml"
    path.write_text("old", encoding="utf-8")
    for name in (path, path.with_suffix("")):
        assert main(["new", str(name)]) == 2
        assert f"{path} exists already; give another name" in capsys.readouterr().err
    assert path.read_text(encoding="utf-8") == "old"


@every("name", ["tw.csv", "saw.v2", "folder/press.json"])
def test_new_case_with_wrong_ending_is_refused(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["new", name]) == 2
    suffix, stem = Path(name).suffix, str(Path(name).with_suffix(""))
    told = f"{name} ends in {suffix}, a case file in .toml: write {stem}.toml, or {name}.toml if this is the name"
    assert capsys.readouterr().err == f"kinetostatics: new: {told}\n"
    assert not any(tmp_path.iterdir())


def test_a_point_before_digits_stays_in_the_name(tmp_path, capsys):
    assert main(["new", str(tmp_path / "press 2.5")]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["press 2.5.toml"]


@pytest.mark.slow
@every(
    "arguments",
    [
        ["run", "compressor", "--variant", "unloaded", "--angles", "8", "--csv", "{}/deep/run.csv"],
        ["new", "{}/deep/press"],
        ["explain", "compressor", "--angle", "0 deg", "--out", "{}/deep/told.txt"],
        ["plot", "compressor", "--only", "torque", "--out", "{}/deep"],
    ],
    ids=" ".join,
)
def test_output_folders_are_made_and_reported(arguments, tmp_path, capsys):
    folder = tmp_path / arguments[0]
    arguments = [text.format(folder) for text in arguments]
    assert main(arguments) == 0
    (written,) = (folder / "deep").iterdir()
    assert arguments[0] != "plot" or written.read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().err == ("" if arguments[0] == "plot" else f"made folder {folder}\n")
    if arguments[0] != "new":
        assert main(arguments) == 0
        assert capsys.readouterr().err == ""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["new\nline", 'say "when"', "b\\c", "\N{GREEK SMALL LETTER OMEGA}.toml"])
def test_a_new_case_of_an_odd_name_is_read_again(tmp_path, name):
    for kind in STARTERS:
        assert main(["new", str(tmp_path / kind / name), "--kind", kind]) == 0
        (path,) = (tmp_path / kind).iterdir()
        assert ks.load_case(path).title == path.stem


def test_a_new_chain_is_named_as_it_is_titled(tmp_path):
    assert main(["new", str(tmp_path / "press 3"), "--kind", "chain"]) == 0
    case = ks.load_case(tmp_path / "press 3.toml")
    assert case.title == case.variant("plain").mechanism.name == "press 3"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("own", "turns"),
    [
        ('rocker_length = "2 m"\nrocker_pivot = ["4 m", "0 m"]\nassembly = "open"\n', 2),
        (
            'rocker_length = "3 m"\nrocker_pivot = ["3.5 m", "1 m"]\n[[variants.a.loads]]\nkind = "torque"\n'
            'on = "rocker"\nvalue = { file = "t.csv", period = "720 deg" }\n',
            2,
        ),
    ],
)
def test_run_covers_the_period_of_loads(tmp_path, own, turns):
    """A crank 1, coupler 3, rocker 2, ground 4 closes after two; so does a load with a period of two."""
    (tmp_path / "t.csv").write_text("crank_angle [deg], torque [N m]\n0, 0\n240, 3\n480, 1\n", encoding="utf-8")
    text = 'title = "turns"\nreference = "a"\n[variants.a]\nmechanism = "four-bar"\ncrank_speed = "60 rpm"\n'
    text += f'crank_length = "1 m"\ncoupler_length = "{5 - turns if "open" in own else 4} m"\n{own}'
    path = tmp_path / "turns.toml"
    path.write_text(text, encoding="utf-8")
    table = tmp_path / "out.csv"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.ConditionWarning)  # of the reactions that are infinite at change points
        assert main(["run", str(path), "--angles", "30", "--csv", str(table)]) == 0
    angles = pd.read_csv(table)["crank_angle [deg]"]
    assert angles.iloc[-1] == pytest.approx(29 / 30 * turns * 360)


@pytest.mark.parametrize(
    ("angle", "message"),
    [("40", "has no unit"), ("40 m", "does not measure the same"), ("nan deg", "must be text"), ("", "must be text")],
)
def test_a_start_angle_without_unit_is_refused(angle, message, capsys):
    with pytest.raises(SystemExit):
        main(["drive", "sawframe_2r63", "--start", angle])
    assert message in capsys.readouterr().err


@pytest.mark.slow
def test_run_prints_friction_losses_and_efficiency(capsys):
    assert main(["run", "sawframe_2r63_friction", "--variant", "cam-cosine", "--angles", "8"]) == 0
    text = capsys.readouterr().out.split("power lost by friction, exact means over the turn\n\n")[1]
    cells = {line.split()[0]: line.split()[1:] for line in text.splitlines() if line}
    assert re.match(r"lost at +mean \[W\] +share \[%\] +largest \[W\] +largest at \[deg\] +per turn \[J\]", text)
    assert {"O", "A", "B", "guide", "slot", "cam", "all"} < set(cells)
    assert float(cells["all"][0]) == pytest.approx(11733.0, rel=1e-5)
    assert "of 11733 W put in, 0 W is used and 11733 W lost: efficiency 0" in text


@pytest.mark.slow
def test_without_friction_no_losses_are_printed(capsys):
    for command in (["run", "mower_drive", "--variant", "full"], ["compare", "mower_drive", "--variant", "full"]):
        assert main(command) == 0
        assert not re.search("lost|efficiency", capsys.readouterr().out)


@pytest.mark.slow
def test_no_losses_for_a_saw_that_starts_from_rest(tmp_path, capsys):
    text = shipped_cases()["sawframe_2r63_friction"].read_text(encoding="utf-8")
    text = text.replace('crank_speed = "320 rpm"', 'crank_speed = "0 rpm"\ncrank_acceleration = "2 rad/s^2"')
    text = text.replace('"balance the slider"', '"674 kN/m"')
    path = tmp_path / "from_rest.toml"
    path.write_text(text, encoding="utf-8")
    assert main(["run", str(path), "--variant", "plain"]) == 0
    assert main(["compare", str(path), "--variant", "cam-cosine"]) == 0
    assert main(["plot", str(path), "--only", "losses", "--out", str(tmp_path)]) == 2
    printed = capsys.readouterr().out
    assert "reaction O" in printed
    assert not re.search("mean power lost|efficiency", printed)


@pytest.mark.slow
def test_explain_prints_or_writes_the_calculation(tmp_path, capsys):
    asked = ["explain", "sawframe_2r63", "--angle", "39.3 deg", "--variant", "cam-circle"]
    printed = printed_by(asked, capsys)
    assert "balancing torque at crank angle 0.685914 rad = 39.3 deg" in " ".join(printed.split())
    starts = {".html": "<!DOCTYPE html>", ".tex": r"\section*{", ".txt": "cam-balanced crank-slider"}
    for ending, start in starts.items():
        path = tmp_path / f"told{ending}"
        assert printed_by([*asked, "--out", str(path)], capsys) == f"{path}\n"
        assert path.read_text(encoding="utf-8").startswith(start)


@pytest.mark.slow
@every(
    "options, words", [([], "variant plain, the reference (another by --variant)"), (["--variant", "plain"], "plain")]
)
def test_explain_tells_the_variant(options, words, capsys):
    assert main(["explain", "sawframe_2r63", "--angle", "39.3 deg", *options]) == 0
    assert " ".join(capsys.readouterr().out.split("\n\n")[0].split()).endswith(words)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--angle", "39.3 deg", "--quantity", "torque"], "quantity is 'torque', allowed: 'balancing_torque'"),
        (["--angle", "39.3 deg", "--variant", "cam"], "'cam'"),
        (["--angle", "39.3 deg", "--out", "told.pdf"], ".html"),
    ],
)
def test_explain_refuses_what_is_not_there(options, words, capsys):
    assert main(["explain", "sawframe_2r63", *options]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.slow
def test_stability_prints_a_line_a_method(tmp_path, monkeypatch, capsys):
    from kinetostatics.studies import stability

    does = {"ours, NumPy": ["exact", "as near as the condition allows"], "series": ["gives NaN, loses digits"] * 2}
    rows = [
        {"place": place, "method": method, "does": text, "worst error": 1e-9, "condition there": 1e9}
        for method, texts in does.items()
        for place, text in zip(("toggle", "kite"), texts, strict=True)
    ]
    path = tmp_path / "stability_summary.csv"
    pd.DataFrame(rows).to_csv(path)
    monkeypatch.setattr(stability, "write", lambda *_, **__: ["stability.csv", path])
    printed = printed_by(["stability", "--out", str(tmp_path)], capsys)
    lines = {line[:11].strip(): line[11:].split() for line in printed.splitlines()}
    assert lines["ours, NumPy"] == ["1", "1", "0", "0"]
    assert lines["series"] == ["0", "0", "2", "2"]
    assert "toggle" not in printed
    assert "kite   ours, NumPy" in printed


def test_unit_slip_is_hinted_once_for_all_variants(tmp_path, capsys):
    """Where it is read, and not again where it is solved."""
    case = Path(shipped("sawframe_2r63").path).read_text()
    path = tmp_path / "turned.toml"
    path.write_text(re.sub('direction = "-90 deg"', 'direction = "-90 rad"', case))
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = lambda *given, **_: sys.stderr.write(warnings.formatwarning(*given[:4]))
        assert main(["run", str(path), "--variant", "plain", "--angles", "36"]) == 0
    (told,) = [
        line for line in capsys.readouterr().err.splitlines() if "is it in degrees? That makes -1.5708 rad" in line
    ]
    assert told.startswith(f"kinetostatics: warning: {path}: variants.plain, variants.cam-circle, ")


# What may be written on the line


@pytest.mark.parametrize("arguments", [["run", "sawframe_2r63", "--angles", "0"], ["runn", "sawframe_2r63"], []])
def test_wrong_usage_ends_with_status_2(arguments):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2


def test_version_is_that_of_the_library(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"kinetostatics {ks.__version__}\n"


# Tables as they are printed

NUMBERS = {
    -0.0: "0",
    -1e-20: "-1e-20",
    -2.5: "-2.5",
    1e-9: "1e-09",
    40578.94111: "40578.9",
    1234567.8: "1234568",
    -2.5e8: "-250000000",
    1e9: "1e+09",
    math.inf: "inf",
    math.nan: "",
}


def test_numbers_have_six_digits_without_exponent(capsys):
    print_table(pd.DataFrame({"smallest": list(NUMBERS)}, index=list("abcdefghij")))
    assert [line[1:].strip() for line in capsys.readouterr().out.splitlines()[2:]] == list(NUMBERS.values())


def test_angles_have_digits_of_a_whole_turn(capsys):
    print_table(pd.DataFrame({"at [deg]": [0.00940839, 359.97081, 1e-5, -1e-5, 90.0]}))
    cells = [line.split()[1] for line in capsys.readouterr().out.splitlines()[2:]]
    assert cells == ["0.009", "359.971", "0", "0", "90"]


WIDE = pd.DataFrame(
    {"unit": ["N m", "N"], **{f"variant-{number} of many": [1.25 * number, -1e5] for number in range(7)}},
    index=pd.Index(["largest coupler inertia force of all that there are", "cam force"], name="quantity"),
)


@pytest.mark.parametrize("columns", [40, 60, 80, 120, 200])
def test_a_table_fits_the_line_and_loses_nothing(columns, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", str(columns))
    print_table(WIDE)
    printed = capsys.readouterr().out
    assert max(map(len, printed.splitlines())) <= columns
    assert all(len(re.findall(rf"(?<![\d.]){number}(?![\d.])", printed)) >= 1 for number in ("1.25", "7.5", "0"))
    assert printed.count("-100000") == 7
    assert printed.count("variant-") == 7


def test_a_long_name_stays_whole(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "40")
    print_table(pd.DataFrame({"value": [1.0]}, index=["x" * 90]))
    print_folded("y" * 90)
    printed = capsys.readouterr().out
    assert "x" * 90 in printed
    assert "y" * 90 in printed


@pytest.mark.parametrize("width", ["", "0", "-5", "many", "1"])
def test_a_width_that_makes_no_sense_is_none(width, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", width)
    print_table(WIDE)
    assert 30 < max(map(len, capsys.readouterr().out.splitlines())) <= 80


def test_tables_without_rows_are_their_headings(capsys):
    print_table(pd.DataFrame({"a": [], "b": []}))
    assert capsys.readouterr().out.split() == ["index", "a", "b", "-----", "-", "-"]


@pytest.mark.slow
@every("name", ["sawframe_2r63", "mower_drive", "in_line_twin"])
def test_shipped_tables_fit_80_columns(name, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    assert main(["run", name, "--angles", "24"]) == 0
    printed = printed_by(["compare", name], capsys)
    assert max(map(len, printed.splitlines())) <= 80
    assert not re.search(r"\x1b|[\u2500-\u257f]", printed)
    assert not re.search(r"\de-1[2-9]", re.sub(r"differ by\s+\S+", "", printed))


def test_digits_that_are_not_known_are_not_printed(capsys):
    table = pd.DataFrame({"unit": ["N"] * 4, "largest": [40578.93, 40578.93, 1.5e-10, 40578.93]}, index=list("abcd"))
    bounds = pd.DataFrame({"unit": ["N"] * 4, "largest": [3.0, math.nan, 2e-10, math.inf]}, index=list("abcd"))
    print_table(table, bounds)
    cells = [line.split()[-1] for line in capsys.readouterr().out.splitlines()[2:]]
    assert cells == ["40579", "40578.9", "0", "40578.9"]
