"""Files: columns read to SI, and results that are written whole or not at all."""

import os
from pathlib import Path

import pytest

from kinetostatics.errors import CaseError
from kinetostatics.numbers.files import headings, read_columns, read_text, write_atomically


def test_blanks_in_headings_count_as_underscores(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("crank angle [deg], force back [kN]\n0, 1\n360, 1\n")
    assert headings(path) == [("crank_angle", "deg"), ("force_back", "kN")]
    assert [column.tolist() for column in read_columns(path, {"force_back": "N"})] == [[1000.0, 1000.0]]


def test_too_large_a_file_is_refused(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text("x" * 100)
    assert read_text(path, 100) == "x" * 100
    with pytest.raises(CaseError, match="cannot be read"):
        read_text(path, 99)


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="the system has no names for open files")
def test_an_open_pipe_takes_what_is_written():
    reading, writing = os.pipe()
    with write_atomically(f"/dev/fd/{writing}") as path:
        Path(path).write_text("whole", encoding="utf-8")
    os.close(writing)
    assert os.read(reading, 99) == b"whole"
    os.close(reading)
