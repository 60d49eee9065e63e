"""Files: columns read to SI, and results that are written whole or not at all."""

import os
from pathlib import Path

import numpy as np
import pytest

from kinetostatics.errors import CaseError
from kinetostatics.numbers.files import headings, read_columns, read_text, unwritable, unwritable_folder, written_whole


def test_columns_are_read_to_si_in_the_order_wanted(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("# measured\nforce [kN], angle [deg]\n1.5, 180\n-2, 360\n")
    angle, force = read_columns(path, {"angle": "rad", "force": "N"})
    np.testing.assert_allclose(angle, [np.pi, 2 * np.pi], rtol=1e-15)
    assert force.tolist() == [1500.0, -2000.0]
    assert headings(path) == [("force", "kN"), ("angle", "deg")]


def test_blanks_in_headings_count_as_underscores(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("crank angle [deg], force back [kN]\n0, 1\n360, 1\n")
    assert headings(path) == [("crank_angle", "deg"), ("force_back", "kN")]
    assert [column.tolist() for column in read_columns(path, {"force_back": "N"})] == [[1000.0, 1000.0]]


def test_a_file_that_is_larger_than_it_may_be_is_refused(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text("x" * 100)
    assert read_text(path, 100) == "x" * 100
    with pytest.raises(CaseError, match="cannot be read"):
        read_text(path, 99)


def test_a_file_half_written_leaves_what_was_there(tmp_path):
    path = tmp_path / "out.csv"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError), written_whole(path) as temporary:
        open(temporary, "w").write(str(1 / 0))  # noqa: PTH123, SIM115
    assert (path.read_text(), list(tmp_path.iterdir())) == ("old", [path])


def test_what_cannot_be_written_is_said_before(tmp_path):
    (tmp_path / "file").write_text("x")
    assert unwritable(tmp_path / "new.csv") is None
    assert unwritable_folder(tmp_path / "new") is None
    assert "is read as input" in unwritable(tmp_path / "file", inputs=[tmp_path / "file"])
    assert unwritable_folder(tmp_path / "file" / "folder")


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="the system has no names for open files")
def test_an_open_pipe_takes_what_is_written():
    reading, writing = os.pipe()
    with written_whole(f"/dev/fd/{writing}") as path:
        Path(path).write_text("whole", encoding="utf-8")
    os.close(writing)
    assert os.read(reading, 99) == b"whole"
    os.close(reading)
