"""Commands that write: what they read is never replaced, and where nothing can be written is told before any work."""

import os
from pathlib import Path

import pytest

from support.commands import VARY, refused


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


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("command", ["run", "sweep"])
def test_unwritable_files_are_refused_first(saw, places, idle, command, place, capsys):
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
