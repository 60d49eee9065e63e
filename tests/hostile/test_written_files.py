"""Files are written whole or not at all, with the permissions, owner and links that they had."""

import os
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.numbers import files
from support.every import every


@pytest.mark.parametrize("link", [False, True])
@every("mode", [0o600, 0o640, 0o644, 0o664, 0o777, 0o200])
def test_replaced_file_keeps_permissions_and_links(tmp_path, mode, link):
    file, name = tmp_path / "x.csv", tmp_path / "link.csv"
    file.write_text("old")
    file.chmod(mode)
    name.unlink(missing_ok=True)
    name.symlink_to("x.csv")
    with files.write_atomically(name if link else file) as temporary:
        assert Path(temporary).stat().st_mode & 0o077 == 0
        Path(temporary).write_text("new")
    assert file.stat().st_mode & 0o777 == mode
    assert (name.is_symlink(), name.resolve()) == (True, file)
    file.chmod(0o600)
    assert file.read_text() == "new"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.csv", "x.csv"]


@pytest.mark.parametrize("mask", [0o000, 0o022, 0o077])
def test_new_file_takes_the_process_permissions(tmp_path, mask, monkeypatch):
    before = os.umask(mask)
    set_mask = os.umask
    monkeypatch.setattr(os, "umask", None)
    try:
        with files.write_atomically(tmp_path / "x.csv") as temporary:
            Path(temporary).write_text("new")
    finally:
        set_mask(before)
    assert (tmp_path / "x.csv").stat().st_mode & 0o777 == 0o666 & ~mask


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may give files away")
def test_a_file_that_is_replaced_keeps_its_owner(tmp_path):
    file = tmp_path / "x.csv"
    file.write_text("old")
    os.chown(file, 12345, 54321)
    with files.write_atomically(file) as temporary:
        Path(temporary).write_text("new")
    assert (file.stat().st_uid, file.stat().st_gid) == (12345, 54321)


def test_read_only_file_is_refused(tmp_path):
    file = tmp_path / "x.csv"
    file.write_text("old")
    file.chmod(0o444)
    with pytest.raises(ks.errors.FileError, match="is read-only; allow writing"), files.write_atomically(file):
        pytest.fail("it may be written")
    assert file.read_text() == "old"


def test_a_link_to_nothing_is_written_through(tmp_path):
    (tmp_path / "link.csv").symlink_to("new.csv")
    with files.write_atomically(tmp_path / "link.csv") as temporary:
        Path(temporary).write_text("new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "new.csv").read_text() == "new"


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt, SystemExit, ValueError])
def test_interrupted_writing_leaves_nothing(tmp_path, error):
    file = tmp_path / "x.csv"
    file.write_text("old")

    def written():
        with files.write_atomically(file) as temporary:
            Path(temporary).write_text("half")
            raise error

    with pytest.raises(error):
        written()
    assert file.read_text() == "old"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("name", ["a\0b.csv", "\ud800.csv"])
def test_names_that_no_file_can_have_are_told(name):
    assert "is no name of a file here" in files.write_problem(name)


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc, where nothing can be made")
@every("path", ["/proc/new.csv", "/proc/new/folder/new.csv"])
def test_impossible_place_is_our_own_error(path):
    refused = pytest.raises(ks.FileError, match=f"{path} cannot be written: [A-Z][a-z ]*; give another place")
    with refused, files.write_atomically(path):
        raise AssertionError("nothing is written there")
