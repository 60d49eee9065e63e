"""The command line, and the doors of studies and figures: what is wrong ends in one clear error, before any work."""

import io
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import kinetostatics as ks
from kinetostatics.cli import main
from kinetostatics.numbers import files
from kinetostatics.views.figures import draw_case
from support.every import every
from support.held import held
from support.shipped import shipped

mpl.use("agg")
TEXT = """
title = "Säge, пила, 鋸"
reference = "plain"
[common]
crank_speed = "60 rpm"
coupler_length = "2 m"
slider = { mass = "600 kg" }
[variants.plain]
mechanism = "crank-slider"
crank_length = "0.3 m"
[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "sampled", table = "saw_precision.csv" }
"""
CAM = "\n".join(["angle [deg], radius [m]", *(f"{a}, {0.3 + 0.01 * math.cos(math.radians(a))}" for a in range(360))])
SAW = shipped("sawframe_2r63")
PLAIN, FOUR_BAR = SAW.solve("plain", 36), shipped("chain_unit").solve("rho-0.5", 36)
STILL = ks.solve(FOUR_BAR.mechanism, FOUR_BAR.crank_angle, crank_speed=0.0)
TABLE = pd.DataFrame({"a": [1.0, 2.0], "b": [3.0, 4.0], "c": [1.0, 1.0]})
VARY = ["--vary", "slider.mass=600..700 kg:2"]


@pytest.fixture
def saw(tmp_path):
    """A case with a table of its own; both must be as they were at the end, with nothing else beside them."""
    case, table = tmp_path / "saw.toml", tmp_path / "saw_precision.csv"
    case.write_text(TEXT, encoding="utf-8")
    table.write_text(CAM, encoding="utf-8")
    ks.load_case(case)
    yield case
    assert case.read_text(encoding="utf-8") == TEXT
    assert table.read_text(encoding="utf-8") == CAM
    assert not [path for path in tmp_path.rglob("*") if path.name.startswith(".")]


@pytest.fixture
def idle(monkeypatch):
    """Nothing may be solved once the case is read; what is wrong must be seen before."""

    def work(*_, **options):
        raise AssertionError("work began")

    monkeypatch.setattr("kinetostatics.casefile.case.Case.solve", lambda case, name, *_: work(case.variant(name)))
    monkeypatch.setattr("kinetostatics.sweeps.sweeps.tried", work)
    monkeypatch.setattr("kinetostatics.studies.stability.study", work)


def refused(arguments, capsys):
    """The one error that a command ends with."""
    status = main([str(item) for item in arguments])
    captured = capsys.readouterr()
    assert (status, captured.out) == (2, "")
    assert captured.err.startswith("kinetostatics: ")
    assert "Traceback" not in captured.err
    return captured.err


# Files


def named(case, spelling):
    """Another name of a file of the case."""
    file = case.parent / ("saw_precision.csv" if "table" in spelling else "saw.toml")
    if "dots" in spelling:
        return file.parent / ".." / file.parent.name / file.name
    if "relative" in spelling:
        return Path(os.path.relpath(file))
    if "link" in spelling:
        other = file.parent / "other.csv"
        (other.symlink_to if "symlink" in spelling else other.hardlink_to)(file)
        return other
    return file


SPELLINGS = [f"{kind} of the {file}" for kind in ("name", "dots", "relative", "symlink", "hardlink")
             for file in ("case", "table")]  # fmt: skip
WRITERS = {
    "run": ["run", "{case}", "--csv", "{out}"],
    "compare": ["compare", "{case}", "--csv", "{out}"],
    "sweep": ["sweep", "{case}", *VARY, "--out", "{out}"],
    "plot of a sweep": ["sweep", "{case}", *VARY, "--plot", "{out}"],
}


def filled(command, **values):
    return [text.format(**values) for text in WRITERS[command]]


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("command", WRITERS)
def test_no_command_writes_over_what_it_reads_whatever_its_name(saw, idle, command, spelling, capsys):
    message = refused(filled(command, case=saw, out=named(saw, spelling)), capsys)
    assert "is read as input and would be replaced; give another name" in message


def test_precision_does_not_write_over_a_table_that_happens_to_have_its_name(saw, idle, capsys):
    message = refused(["precision", saw, "--out", saw.parent], capsys)
    assert "saw_precision.csv is read as input" in message


PLACES = {
    "folder": ("folder.csv", "is a folder"),
    "file in a file": ("saw.toml/x.csv", "is no folder, so nothing can be written to"),
    "other ending": ("x.xlsx", "the ending is '.xlsx', allowed: '.csv'"),
    "long name": ("x" * 300 + ".csv", "is no name of a file here: File name too long"),
    "read-only": ("read-only.csv", "is read-only; allow writing"),
    "link to read-only": ("link.csv", "is read-only; allow writing"),
    "loop": ("loop.csv", "is a symbolic link that leads in a circle"),
}


@pytest.fixture
def places(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "read-only.csv").write_text("old")
    (tmp_path / "read-only.csv").chmod(0o444)
    (tmp_path / "link.csv").symlink_to("read-only.csv")
    (tmp_path / "loop.csv").symlink_to("loop.csv")
    yield tmp_path
    assert (tmp_path / "read-only.csv").read_text() == "old"
    assert (tmp_path / "link.csv").is_symlink()


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("command", ["run", "sweep"])
def test_files_that_cannot_be_written_are_refused_before_the_work(saw, places, idle, command, place, capsys):
    name, text = PLACES[place]
    assert text in refused(filled(command, case=saw, out=places / name), capsys)


FOLDERS = {
    "plot": ["plot", "{case}", "--out", "{out}"],
    "precision": ["precision", "{case}", "--variant", "plain", "--out", "{out}"],
    "sweep": ["sweep", "{case}", *VARY, "--out", "{out}"],
    "stability": ["stability", "--out", "{out}"],
}


@pytest.mark.parametrize("below", ["", "deeper/still"])
@pytest.mark.parametrize("command", FOLDERS)
def test_folders_that_cannot_be_made_are_refused_before_the_work(saw, idle, command, below, capsys):
    file = saw.parent / "file"
    file.write_text("old")
    message = refused([text.format(case=saw, out=file / below) for text in FOLDERS[command]], capsys)
    assert f"{file} is no folder" in message
    assert file.read_text() == "old"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(saw, idle, capsys):
    (saw.parent / "locked").mkdir(mode=0o555)
    assert "may not be written to" in refused(["run", saw, "--csv", saw.parent / "locked" / "x.csv"], capsys)


@pytest.mark.parametrize("link", [False, True])
@every("mode", [0o600, 0o640, 0o644, 0o664, 0o777, 0o200])
def test_a_file_that_is_replaced_keeps_its_permissions_and_links_to_it_stay(tmp_path, mode, link):
    file, name = tmp_path / "x.csv", tmp_path / "link.csv"
    file.write_text("old")
    file.chmod(mode)
    name.unlink(missing_ok=True)
    name.symlink_to("x.csv")
    with files.written_whole(name if link else file) as temporary:
        assert Path(temporary).stat().st_mode & 0o077 == 0
        Path(temporary).write_text("new")
    assert file.stat().st_mode & 0o777 == mode
    assert (name.is_symlink(), name.resolve()) == (True, file)
    file.chmod(0o600)
    assert file.read_text() == "new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.csv", "x.csv"]


@pytest.mark.parametrize("mask", [0o000, 0o022, 0o077])
def test_a_new_file_has_the_permissions_that_the_process_gives_and_its_mask_is_never_touched(
    tmp_path, mask, monkeypatch
):
    before = os.umask(mask)
    set_mask = os.umask
    monkeypatch.setattr(os, "umask", None)
    try:
        with files.written_whole(tmp_path / "x.csv") as temporary:
            Path(temporary).write_text("new")
    finally:
        set_mask(before)
    assert (tmp_path / "x.csv").stat().st_mode & 0o777 == 0o666 & ~mask


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may give files away")
def test_a_file_that_is_replaced_keeps_its_owner(tmp_path):
    file = tmp_path / "x.csv"
    file.write_text("old")
    os.chown(file, 12345, 54321)
    with files.written_whole(file) as temporary:
        Path(temporary).write_text("new")
    assert (file.stat().st_uid, file.stat().st_gid) == (12345, 54321)


def test_a_file_that_is_read_only_is_refused_when_written_too(tmp_path):
    file = tmp_path / "x.csv"
    file.write_text("old")
    file.chmod(0o444)
    with pytest.raises(ks.errors.FileError, match="is read-only; allow writing"), files.written_whole(file):
        pytest.fail("it may be written")
    assert file.read_text() == "old"


def test_a_link_to_nothing_is_written_through(tmp_path):
    (tmp_path / "link.csv").symlink_to("new.csv")
    with files.written_whole(tmp_path / "link.csv") as temporary:
        Path(temporary).write_text("new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "new.csv").read_text() == "new"


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt, SystemExit, ValueError])
def test_whatever_stops_the_writing_nothing_is_left_of_it(tmp_path, error):
    file = tmp_path / "x.csv"
    file.write_text("old")

    def written():
        with files.written_whole(file) as temporary:
            Path(temporary).write_text("half")
            raise error

    with pytest.raises(error):
        written()
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("name", ["a\0b.csv", "\ud800.csv"])
def test_names_that_no_file_can_have_are_told(name):
    assert "is no name of a file here" in files.unwritable(name)


# Options


SHORT = {
    "empty case": (["run", ""], "argument CASE: must not be empty"),
    "empty variant": (["run", "saw", "--variant", ""], "argument --variant: must not be empty"),
    "empty csv": (["run", "saw", "--csv", " "], "argument --csv: must not be empty"),
    "empty folder": (["plot", "saw", "--out", ""], "argument --out: must not be empty"),
    "empty figure": (["plot", "saw", "--out", "x", "--only", ""], "argument --only: must not be empty"),
    "empty quantity": (["precision", "saw", "--out", "x", "--quantity", ""], "must not be empty"),
    "empty output": (["sweep", "saw", *VARY, "--output", ""], "argument --output: must not be empty"),
    "empty reference": (["sweep", "saw", *VARY, "--reference", ""], "must not be empty"),
    "empty plot": (["sweep", "saw", *VARY, "--plot", ""], "argument --plot: must not be empty"),
    "no command": ([], "the following arguments are required: COMMAND"),
    "unknown command": (["runn"], "invalid choice: 'runn' (choose from"),
    "unknown option": (["run", "saw", "--angels", "3"], "unrecognized arguments: --angels"),
    "nothing to vary": (["sweep", "saw"], "the following arguments are required: --vary"),
    "other format": (["plot", "saw", "--out", "x", "--format", "bmp"], "invalid choice: 'bmp'"),
    **{
        f"{option} {text!r}": ([command, "saw", *rest, option, text], f"argument {option}: must be ")
        for command, option, rest in (
            ("run", "--angles", []),
            ("sweep", "--angles", VARY),
            ("sweep", "--sample", VARY),
            ("precision", "--angles", ["--out", "x"]),
        )
        for text in ("0", "-1", "1.5", "1e3", "many", "", "nan", "1000000000", "9" * 5000, "1_000", "²")
    },
    **{
        f"--workers {text!r}": (["sweep", "saw", *VARY, "--workers", text], "argument --workers: must be ")
        for text in ("0", "-1", "two", "1.0")
    },
}


@every("name", SHORT)
def test_options_that_cannot_be_are_refused_in_a_line(name, capsys):
    arguments, message = SHORT[name]
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    captured = capsys.readouterr()
    assert caught.value.code == 2
    assert captured.out == ""
    assert message in captured.err.splitlines()[-1]


def test_so_many_angles_are_refused_with_the_memory_that_they_take(capsys):
    with pytest.raises(SystemExit):
        main(["run", "saw", "--angles", "1000000000"])
    assert "must be at most 10000000, as 1000000000 would take 1000 GB of memory" in capsys.readouterr().err


UNKNOWN = {
    "case": (["run", "no such"], "no such file, and no shipped case of that name"),
    "variant": (["run", "{case}", "--variant", "plan"], "did you mean 'plain'?"),
    "variant to compare": (["compare", "{case}", "--variant", "x"], "variant is 'x', allowed: 'plain', 'cam'"),
    "figure": (["plot", "{case}", "--out", "x", "--only", "torqe"], "did you mean 'torque'?"),
    "variant of precision": (["precision", "{case}", "--out", "x", "--variant", "x"], "variant is 'x'"),
    "variant of a sweep": (["sweep", "{case}", *VARY, "--variant", "x"], "variant is 'x'"),
    "reference of a sweep": (["sweep", "{case}", *VARY, "--reference", "x"], "variant is 'x'"),
    "reduction": (["sweep", "{case}", *VARY, "--output", "larges O"], "did you mean 'largest'?"),
    "output": (["sweep", "{case}", *VARY, "--output", "O"], "must be a reduction and a quantity"),
    "parameter": (["sweep", "{case}", "--vary", "slider.mas=1..2 kg:2"], "did you mean 'slider.mass'?"),
    "unit": (["sweep", "{case}", "--vary", "slider.mass=1..2 zork:2"], "zork"),
    "spread": (["sweep", "{case}", "--vary", "slider.mass"], "write path=spread"),
    "too many workers": (["sweep", "{case}", *VARY, "--workers", "100000"], "whole number of processes from 1 to"),
}


@pytest.mark.parametrize("name", UNKNOWN)
def test_names_that_are_not_known_are_refused_before_the_work(saw, idle, name, capsys):
    arguments, message = UNKNOWN[name]
    assert message in refused([text.format(case=saw) for text in arguments], capsys)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["precision", "{case}", "--variant", "plain", "--quantity", "forc"], "quantity is 'forc', allowed: "),
        (["sweep", "{case}", *VARY, "--output", "largest forc"], "quantity is 'forc', allowed: "),
    ],
)
def test_quantities_that_are_not_known_are_refused_before_anything_is_written(saw, arguments, message, capsys):
    out = saw.parent / "out"
    assert message in refused([*(text.format(case=saw) for text in arguments), "--out", out], capsys)
    assert not out.exists()


def test_memory_that_runs_out_is_told_in_a_line(saw, monkeypatch, capsys):
    def solve(*_):
        raise MemoryError("Unable to allocate 8 GiB")

    monkeypatch.setattr("kinetostatics.casefile.case.Case.solve", solve)
    assert "there is not enough memory; take fewer" in refused(["run", saw], capsys)


# Output


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
def test_letters_that_the_output_does_not_have_are_replaced(saw, encoding, monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding, errors="strict"))
    assert main(["run", str(saw), "--variant", "plain", "--angles", "8"]) == 0
    title = raw.getvalue().decode(encoding).splitlines()[0]
    assert title == ks.load_case(saw).title.encode(encoding, "replace").decode(encoding)


def test_errors_with_letters_that_the_output_does_not_have_are_told(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(raw, encoding="ascii", errors="strict"))
    assert main(["run", "säge"]) == 2
    sys.stderr.flush()
    assert raw.getvalue().startswith(b"kinetostatics: s?ge: 1 problem")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_streams_that_are_closed_end_no_command_with_a_traceback(saw, stream, monkeypatch, capsys):
    monkeypatch.setattr(sys, stream, None)
    assert main(["run", str(saw), "--variant", "plan"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == (
        "kinetostatics: standard output is closed; open it, or send it to /dev/null\n" if stream == "stdout" else ""
    )


COMMAND = [sys.executable, "-m", "kinetostatics"]


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_disk_is_told_in_a_line(saw):
    with open("/dev/full", "w") as full:  # noqa: PTH123
        command = [*COMMAND, "run", saw, "--variant", "plain", "--angles", "8"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr == "kinetostatics: [Errno 28] No space left on device\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("how", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_a_sweep_that_is_stopped_says_so_in_a_line_and_leaves_no_process(saw, how, status, word):
    """The signal goes to all its processes, as from a terminal, when one part is written and others wait."""
    vary = ["--vary", "slider.mass=600..700 kg:60000", "--variant", "plain", "--angles", "48", "--output", "rms O"]
    arguments = ["sweep", saw, *vary, "--workers", "1", "--out", saw.parent / "out"]
    with held("kinetostatics.sweeps.dataset:Dataset", "keep", arguments, start_new_session=True) as process:
        os.killpg(process.pid, how)
        assert process.communicate()[1] == f"kinetostatics: {word}\n"
        assert process.returncode == status
        assert_gone(process.pid)


def assert_gone(group):
    """No process of the group is left, soon; the fixture `soon_and_small` says how soon."""
    while True:
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)


# Functions


COUNTS = [-1, 0, 2.5, True, "many", None, math.nan, np.float64(3.0), np.int64(0), [3], 10**9, 10**400, 10**5000]


@every("count", COUNTS, ids=map(str, range(len(COUNTS))))
def test_numbers_of_crank_angles_that_cannot_be_are_refused(count):
    for solve in (SAW.variant("plain").solve, lambda angles: SAW.solve("plain", angles=angles)):
        with pytest.raises(ks.ParameterError, match=r"^solve: angles must be (a whole number of at least 1|at most 1)"):
            solve(count)


def test_numbers_of_crank_angles_may_be_integers_of_numpy():
    assert SAW.solve("plain", np.int16(8)).shape == (8,)


OTHERS = {
    "None": None,
    "number": 3,
    "name": "plain",
    "mechanism": PLAIN.mechanism,
    "case": SAW,
    "variant": SAW.variant("plain"),
    "list": [PLAIN],
    "table": TABLE,
    "class": ks.Solution,
}
SOLUTIONS = "must be a Solution, as ks.solve(...), case.solve(name) and variant.solve() return, got "
WANTED = {
    "extremes": (lambda thing: ks.extremes(thing, "O"), SOLUTIONS),
    "compare": (lambda thing: ks.compare(PLAIN, thing), f"balanced {SOLUTIONS}"),
    "compare, reference": (lambda thing: ks.compare(thing, PLAIN), f"reference {SOLUTIONS}"),
    "swing": (ks.linkage.swing, SOLUTIONS),
    "transmission angle": (ks.linkage.transmission_angle, SOLUTIONS),
    "rocker angle": (ks.linkage.rocker_angle, SOLUTIONS),
    "study": (ks.precision.study, SOLUTIONS),
    **{
        name: (getattr(ks.plots, name), SOLUTIONS)
        for name in ("torque", "cam_force", "pressure_angle", "acceleration_error", "hodograph", "shaking_force")
    },
    **{name: (getattr(ks.plots, name), SOLUTIONS) for name in ("mechanism", "mass_centres", "animation")},
    "over_turn": (lambda thing: ks.plots.over_turn(thing, "O"), SOLUTIONS),
    "over_turn, among others": (lambda thing: ks.plots.over_turn({"a": PLAIN, "b": thing}, "O"), f"b {SOLUTIONS}"),
    "chain_unit_motion": (lambda thing: ks.plots.chain_unit_motion(thing, "rocker"), SOLUTIONS),
    "characteristics": (lambda thing: ks.linkage.characteristics({"a": thing}, "a"), f"a {SOLUTIONS}"),
    "model_ladder": (ks.plots.model_ladder, "needs must be what ks.needs(...) returns"),
}


@every("other", OTHERS)
@every("name", WANTED)
def test_what_is_no_solution_is_refused_with_what_is_wanted(name, other):
    function, message = WANTED[name]
    with pytest.raises(ks.ParameterError) as caught:
        function(OTHERS[other])
    assert message in str(caught.value)
    plt.close("all")


CALLS = {
    **{
        f"principal points of {name}": (lambda thing=thing: ks.principal_points(thing), "mechanism must be a Mechanism")
        for name, thing in OTHERS.items()
        if name != "mechanism"
    },
    **{
        f"Grashof of {name}": (lambda thing=thing: ks.linkage.grashof(thing), "mechanism must be a Mechanism")
        for name, thing in OTHERS.items()
        if name != "mechanism"
    },
    **{
        f"needs of {name}": (lambda thing=thing: ks.needs(thing, "O"), "scene must be a Solution or a Case")
        for name, thing in OTHERS.items()
        if name != "case"
    },
    **{
        f"{kind.__name__} of {name}": (lambda thing=thing, kind=kind: kind(thing, TABLE, ["rms O"]), "must be a Case")
        for kind in (ks.sweep, ks.tolerances)
        for name, thing in OTHERS.items()
        if name not in ("case", "class", "variant")
    },
    **{
        f"quantity {quantity!r} of {kind.__name__}": (
            lambda quantity=quantity, kind=kind: kind(PLAIN, quantity),
            "quantity must be a name",
        )
        for quantity in (None, 3, ["O"], {"O": 1}, b"O")
        for kind in (ks.extremes, ks.needs, ks.plots.over_turn, ks.plots.hodograph, ks.precision.study)
    },
    **{
        f"{kind.__name__} of a table {table!r}": (lambda table=table, kind=kind: kind(table), "table")
        for table in (None, 3, {}, TABLE, TABLE[:0])
        for kind in (ks.plots.work_precision, ks.plots.error_by_distance)
    },
    **{
        f"axes {ax!r}": (lambda ax=ax, kind=kind: kind(PLAIN, ax=ax), "ax must be matplotlib Axes")
        for ax in (3, "polar", Figure)
        for kind in (ks.plots.torque, ks.plots.mechanism, ks.plots.shaking_force, ks.plots.animation)
    },
    **{
        f"{kind.__name__} of {outputs!r}": (lambda outputs=outputs, kind=kind: kind(outputs), "outputs must be texts")
        for outputs in (None, 3)
        for kind in (
            lambda outputs: ks.sweep(SAW, TABLE, outputs),
            lambda outputs: ks.tolerances(SAW, outputs),
        )
    },
    **{
        f"marks {marks!r}": (lambda marks=marks: ks.plots.hodograph(PLAIN, marks=marks), "marks must be")
        for marks in (0, -1, math.nan, math.inf, "ten", 1e-9)
    },
    **{
        f"angles {angles!r}": (lambda angles=angles: ks.plots.mechanism(PLAIN, angles=angles), "angles must be")
        for angles in ("ten", [math.nan], [[0, 1]], {"a": 1})
    },
    **{
        f"frames {frames!r}": (lambda frames=frames: ks.plots.animation(PLAIN, frames=frames), "frames must be a whole")
        for frames in (0, -1, 2.5, "ten")
    },
    "no solutions": (lambda: ks.plots.torque({}), "there are no solutions to draw"),
    "no reactions": (lambda: ks.plots.animation(PLAIN, joints=()), "joints must name at least one"),
    "other direction": (lambda: ks.plots.shaking_force(PLAIN, by="x"), "by is 'x'"),
    "third order": (lambda: ks.plots.chain_unit_motion(FOUR_BAR, "rocker", 3), "order must be 1 or 2, got 3"),
    "no coupler": (lambda: ks.plots.chain_unit_motion(FOUR_BAR, "crank"), "link is 'crank', allowed"),
    "motion at rest": (lambda: ks.plots.chain_unit_motion(STILL, "rocker"), "crank speed"),
    "map of nothing": (lambda: ks.plots.sweep_map(TABLE, [], "c"), "one or two different parameters"),
    "map of three": (lambda: ks.plots.sweep_map(TABLE, ["a", "b", "c"], "c"), "one or two different parameters"),
    "map of one twice": (lambda: ks.plots.sweep_map(TABLE, ["a", "a"], "c"), "one or two different parameters"),
    "map of another": (lambda: ks.plots.sweep_map(TABLE, ["a"], "d"), "no column 'd'; it has a, b, c"),
    "characteristics at rest": (lambda: ks.linkage.characteristics({"a": STILL}, "a"), "a: the crank speed is 0"),
    "characteristics of none": (lambda: ks.linkage.characteristics({}, "a"), "solutions must be a dict"),
    "characteristics of a list": (lambda: ks.linkage.characteristics([STILL], "a"), "solutions must be a dict"),
    "other reference": (lambda: ks.linkage.characteristics({"a": FOUR_BAR}, "b"), "reference is 'b', allowed: 'a'"),
    "start in words": (lambda: ks.linkage.rocker_angle(FOUR_BAR, "up"), "start must be a number"),
    "angle in words": (lambda: ks.linkage.chain_unit_angle("up"), "angle must be a number"),
    "precision of none": (lambda: ks.precision.case_study(None, "out"), "case must be a Case"),
    "figures of none": (lambda: draw_case(None, "out"), "case must be a Case"),
    "spreads in a list": (lambda: ks.tolerances(SAW, "rms O", ["a"]), "spreads must be a dict"),
}


@every("name", CALLS)
def test_calls_that_cannot_be_answered_are_refused(name):
    call, message = CALLS[name]
    with pytest.raises(ks.ParameterError) as caught:
        call()
    assert message in str(caught.value)
    plt.close("all")
