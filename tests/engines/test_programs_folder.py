"""The folder of machine code: named or usual, private, and sealed with what it holds."""

import os

import pytest

from kinetostatics.engines import programs_folder
from kinetostatics.engines.programs_folder import UntrustedError, is_intact, new_entry, require_private


def test_a_folder_that_is_named_is_made_for_the_user_alone(tmp_path, monkeypatch):
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "deep" / "own"))
    folder = programs_folder.programs_folder()
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


def test_an_entry_that_fails_leaves_nothing(tmp_path):
    with pytest.raises(ZeroDivisionError), new_entry(tmp_path / "entry"):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="users have no numbers here")
def test_what_others_may_write_is_not_trusted(tmp_path):
    require_private(tmp_path)
    tmp_path.chmod(0o777)
    with pytest.raises(UntrustedError, match=f"others may write to {tmp_path}"):
        require_private(tmp_path)
    assert issubclass(UntrustedError, OSError)
