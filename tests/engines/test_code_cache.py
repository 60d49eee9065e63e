"""Generated modules: machine code kept on disk, sealed, private, and compiled anew where needed."""

import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import pytest

from kinetostatics.engines import code_cache
from kinetostatics.engines.code_cache import (
    CHECKSUMS,
    is_intact,
    load_module,
    new_entry,
)
from kinetostatics.errors import CacheWarning

TEXT = """
from numba import njit

@njit("float64(float64)", cache=KEEP)
def twice(x):
    return 2.0 * x
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of programs, which is not there yet; temporary files have a folder of their own."""
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "new" / "programs"))
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    code_cache._tell.cache_clear()
    yield tmp_path / "new" / "programs"
    assert not list((tmp_path / "temporary").iterdir())
    code_cache._tell.cache_clear()


def hits(module):
    return sum(module.twice.stats.cache_hits.values())


def modes(path):
    return {item.stat().st_mode & 0o777 for item in path.rglob("*") if item.is_dir()} | {path.stat().st_mode & 0o777}


def file_modes(path):
    return {item.stat().st_mode & 0o777 for item in path.rglob("*") if item.is_file()}


@pytest.mark.slow
@pytest.mark.parametrize("mask", [0o022, 0o002, 0o000, 0o077])
def test_machine_code_is_found_again_by_its_user_alone(numba, folder, mask):
    before = os.umask(mask)
    try:
        first, second = load_module(TEXT, keep=True), load_module(TEXT, keep=True)
    finally:
        os.umask(before)
    assert (hits(first), hits(second)) == (0, 1)
    assert first.twice(2.1) == second.twice(2.1) == 4.2
    assert len(list(folder.iterdir())) == 1
    assert modes(folder) == {0o700}
    assert file_modes(folder) == {0o600}


@pytest.mark.slow
def test_what_is_not_to_be_kept_leaves_nothing(numba, folder):
    assert load_module(TEXT).twice(2.1) == 4.2
    assert not folder.exists()


def test_modules_of_plain_python_need_no_numba(folder):
    assert load_module("def thrice(x):\n    return 3 * x\n").thrice(2) == 6


def test_home_is_written_as_a_tilde(numba, folder, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    monkeypatch.setenv("KINETOSTATICS_CACHE", "~/mine")
    monkeypatch.chdir(tmp_path)
    load_module(TEXT, keep=True)
    assert list((tmp_path / "mine").iterdir())
    assert not (tmp_path / "~").exists()


@pytest.mark.slow
def test_one_warning_for_all_programs_not_kept(numba, folder):
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for number in range(3):
            assert load_module(f"{TEXT}#{number}", keep=True).twice(2.0) == 4.0
    assert [item.category for item in caught] == [CacheWarning]
    assert f"others may write to {folder}" in str(caught[0].message)
    assert not list(folder.iterdir())


def test_numbas_own_folder_is_left_alone(numba, folder, monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "numba"))
    with pytest.warns(CacheWarning, match="NUMBA_CACHE_DIR is set"):
        assert load_module(TEXT, keep=True).twice(2.0) == 4.0
    assert not (tmp_path / "numba").exists()


def test_of_two_writers_the_first_makes_the_entry(tmp_path):
    entry = tmp_path / "entry"
    with new_entry(entry) as one:
        (one / "text").write_text("one")
        with new_entry(entry) as other:
            (other / "text").write_text("other")
    assert (entry / "text").read_text() == "other"
    assert is_intact(entry)
    assert [path.name for path in tmp_path.iterdir()] == ["entry"]


@pytest.mark.slow
def test_simultaneous_processes_share_the_folder(numba, folder):
    module = "kinetostatics.engines.code_cache"
    code = f"from {module} import load_module; print(load_module({TEXT!r}, keep=True).twice(2.1))"
    command = [sys.executable, "-W", "error::kinetostatics.errors.CacheWarning", "-c", code]
    started = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    assert [(process.communicate()[0], process.returncode) for process in started] == [("4.2\n", 0)] * 2
    assert [is_intact(entry) for entry in folder.iterdir()] == [True]


# Nowhere to keep it


def no_home(monkeypatch, tmp_path):
    monkeypatch.setattr(Path, "home", classmethod(_raising(RuntimeError("Could not determine home directory."))))
    return "Could not determine home"


def home_missing(monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path / "nonexistent"))
    return "there is no home folder"


def home_unknown(monkeypatch, tmp_path):
    import platformdirs

    monkeypatch.setattr(platformdirs, "user_cache_path", lambda name: Path("~/.cache") / name)
    return "there is no home folder"


def platformdirs_missing(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "platformdirs", None)
    return "platformdirs, which finds the folder, is missing"


def given(place, message):
    def arrange(monkeypatch, tmp_path):
        (tmp_path / "file").touch()
        monkeypatch.setenv("KINETOSTATICS_CACHE", place.format(tmp_path))
        return message

    return arrange


def _raising(error):
    def fail(*_):
        raise error

    return fail


NOWHERE = {
    "no home is known": no_home,
    "home is missing": home_missing,
    "home stays a tilde": home_unknown,
    "platformdirs is missing": platformdirs_missing,
    "a file": given("{}/file", "file"),
    "below a file": given("{}/file/programs", "file"),
    "a name too long": given("{}/" + "n" * 300, "too long"),
    "home of nobody": given("~nobody-of-this-name/programs", "KINETOSTATICS_CACHE is '~nobody"),
}


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="names and messages of POSIX")
@pytest.mark.parametrize("name", NOWHERE)
def test_no_folder_compiles_in_memory(numba, folder, monkeypatch, tmp_path, name):
    pytest.importorskip("platformdirs")
    monkeypatch.delenv("KINETOSTATICS_CACHE")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.chdir(tmp_path)
    message = NOWHERE[name](monkeypatch, tmp_path)
    present = set(tmp_path.iterdir())
    with pytest.warns(CacheWarning, match=f"compiled again in each session.*{message}"):
        assert load_module(TEXT, keep=True).twice(2.1) == 4.2
    assert set(tmp_path.iterdir()) == present


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="limits of POSIX")
@pytest.mark.parametrize("limit", [0, 10, 200, 1000, 3000])
def test_a_full_disk_compiles_in_memory(numba, folder, limit):
    """The text, numba's index, or the machine code itself does not fit."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    try:
        with pytest.warns(CacheWarning, match=r"compiled again in each session.*too large"):
            module = load_module(TEXT, keep=True)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert module.twice(2.1) == 4.2
    assert not list(folder.iterdir())


def test_where_users_have_no_numbers_nothing_is_asked(tmp_path, monkeypatch):
    monkeypatch.delattr(os, "getuid", raising=False)
    tmp_path.chmod(0o777)
    code_cache.require_private(tmp_path)


def test_what_else_lies_in_the_folder_is_no_matter(numba, folder):
    folder.mkdir(parents=True, mode=0o700)
    (folder / "__pycache__").mkdir()
    (folder / "kinetostatics_0123456789abcdef.py").write_text("raise SystemExit")
    load_module(TEXT, keep=True)
    assert hits(load_module(TEXT, keep=True)) == 1
    assert len(list(folder.rglob(CHECKSUMS))) == 1


def test_a_named_folder_is_made_for_the_user_alone(tmp_path, monkeypatch):
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "deep" / "own"))
    folder = code_cache.programs_folder()
    assert folder == tmp_path / "deep" / "own"
    assert folder.stat().st_mode & 0o077 == 0


def test_an_entry_is_there_when_it_is_whole_and_sealed(tmp_path):
    with new_entry(tmp_path / "entry") as made:
        (made / "code").write_text("x")
        assert not (tmp_path / "entry").exists()
    assert is_intact(tmp_path / "entry")
    assert [path.name for path in tmp_path.iterdir()] == ["entry"]
    (tmp_path / "entry" / "more").write_text("y")
    assert not is_intact(tmp_path / "entry")


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt])
def test_an_entry_that_fails_leaves_nothing(tmp_path, error):
    def interrupted():
        with new_entry(tmp_path / "entry") as made:
            (made / "text").write_text("half")
            raise error

    with pytest.raises(error):
        interrupted()
    assert list(tmp_path.iterdir()) == []
