"""The command line with faulty files, options and output: one message, no traceback."""

import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.commands import VARY, held, refused
from support.every import every


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


@pytest.mark.parametrize(
    ("command", "spelling"),
    [*(("run", spelling) for spelling in SPELLINGS), *((command, SPELLINGS[0]) for command in WRITERS)],
)
def test_no_command_overwrites_its_input(saw, idle, command, spelling, capsys):
    message = refused(filled(command, case=saw, out=named(saw, spelling)), capsys)
    assert "is read as input and would be replaced; give another name" in message


def test_precision_keeps_tables_of_the_same_name(saw, idle, capsys):
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


@pytest.mark.parametrize(("command", "place"), [*(("run", place) for place in PLACES), ("sweep", "folder")])
def test_unwritable_files_are_refused_first(saw, places, idle, command, place, capsys):
    name, text = PLACES[place]
    assert text in refused(filled(command, case=saw, out=places / name), capsys)


FOLDERS = {
    "plot": ["plot", "{case}", "--out", "{out}"],
    "precision": ["precision", "{case}", "--variant", "plain", "--out", "{out}"],
    "sweep": ["sweep", "{case}", *VARY, "--out", "{out}"],
    "stability": ["stability", "--out", "{out}"],
}


@pytest.mark.parametrize(("command", "below"), [*((command, "") for command in FOLDERS), ("plot", "deeper/still")])
def test_impossible_folders_are_refused_first(saw, idle, command, below, capsys):
    file = saw.parent / "file"
    file.write_text("old")
    message = refused([text.format(case=saw, out=file / below) for text in FOLDERS[command]], capsys)
    assert f"{file} is no folder" in message
    assert file.read_text() == "old"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(saw, idle, capsys):
    (saw.parent / "locked").mkdir(mode=0o555)
    assert "may not be written to" in refused(["run", saw, "--csv", saw.parent / "locked" / "x.csv"], capsys)


# Options and names that cannot be are refused in a line, before any work

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


@pytest.mark.slow
@every("name", SHORT)
def test_options_that_cannot_be_are_refused_in_a_line(name, capsys):
    arguments, message = SHORT[name]
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    captured = capsys.readouterr()
    assert caught.value.code == 2
    assert captured.out == ""
    assert message in captured.err.splitlines()[-1]


def test_too_many_angles_name_their_memory(capsys):
    with pytest.raises(SystemExit):
        main(["run", "saw", "--angles", "1000000000"])
    assert "must be at most 10000000, as 1000000000 would need 1000 GB of memory" in capsys.readouterr().err


UNKNOWN = {
    "case": (["run", "no such"], "there is no file and no shipped case of this name"),
    "variant": (["run", "{case}", "--variant", "plan"], "did you mean 'plain'?"),
    "variant to compare": (["compare", "{case}", "--variant", "x"], "variant is 'x', allowed: 'plain', 'cam'"),
    "figure": (["plot", "{case}", "--out", "x", "--only", "torqe"], "did you mean 'torque'?"),
    "variant of precision": (["precision", "{case}", "--out", "x", "--variant", "x"], "variant is 'x'"),
    "variant of a sweep": (["sweep", "{case}", *VARY, "--variant", "x"], "variant is 'x'"),
    "reference of a sweep": (["sweep", "{case}", *VARY, "--reference", "x"], "variant is 'x'"),
    "reduction": (["sweep", "{case}", *VARY, "--output", "larges O"], "did you mean 'largest O'?"),
    "output": (["sweep", "{case}", *VARY, "--output", "O"], "must be a reduction and a quantity"),
    "parameter": (["sweep", "{case}", "--vary", "slider.mas=1..2 kg:2"], "did you mean 'slider.mass'?"),
    "unit": (["sweep", "{case}", "--vary", "slider.mass=1..2 zork:2"], "zork"),
    "spread": (["sweep", "{case}", "--vary", "slider.mass"], "write path=spread"),
    "too many workers": (["sweep", "{case}", *VARY, "--workers", "100000"], "whole number of processes from 1 to"),
}


@pytest.mark.parametrize("name", UNKNOWN)
def test_unknown_names_are_refused_first(saw, idle, name, capsys):
    arguments, message = UNKNOWN[name]
    assert message in refused([text.format(case=saw) for text in arguments], capsys)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["precision", "{case}", "--variant", "plain", "--quantity", "forc"], "quantity is 'forc', allowed: "),
        (["sweep", "{case}", *VARY, "--output", "largest forc"], "quantity is 'forc', allowed: "),
    ],
)
def test_unknown_quantities_write_nothing(saw, arguments, message, capsys):
    out = saw.parent / "out"
    assert message in refused([*(text.format(case=saw) for text in arguments), "--out", out], capsys)
    assert not out.exists()


def test_memory_that_runs_out_is_told_in_a_line(saw, monkeypatch, capsys):
    def solve(*_):
        raise MemoryError("Unable to allocate 8 GiB")

    monkeypatch.setattr("kinetostatics.casefile.case.Case.solve", solve)
    assert "there is not enough memory; use fewer" in refused(["run", saw], capsys)


# Whatever the output takes, and whatever stops a command, it ends in a line


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_unencodable_output_is_replaced(saw, encoding, monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding, errors="strict"))
    assert main(["run", str(saw), "--variant", "plain", "--angles", "8"]) == 0
    title = raw.getvalue().decode(encoding).splitlines()[0]
    assert title == ks.load_case(saw).title.encode(encoding, "replace").decode(encoding)


def test_errors_with_unencodable_letters_are_printed(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(raw, encoding="ascii", errors="strict"))
    assert main(["run", "säge"]) == 2
    sys.stderr.flush()
    assert raw.getvalue().startswith(b"kinetostatics: s?ge: 1 problem")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_closed_streams_cause_no_traceback(saw, stream, monkeypatch, capsys):
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
    assert done.stderr == "kinetostatics: standard output: No space left on device\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("how", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_stopped_sweep_says_so_and_leaves_no_process(saw, how, status, word):
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
