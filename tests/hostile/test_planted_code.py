"""Machine code that was damaged, or that others could have planted, never runs."""

import os
import pickle
import shutil
import stat
import warnings
from pathlib import Path

import pytest

from kinetostatics.engines import code_cache
from kinetostatics.engines.code_cache import CHECKSUMS, UntrustedError, is_intact, load_module, require_private
from kinetostatics.errors import CacheWarning

pytestmark = [
    pytest.mark.slow_start,
    pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners and modes of POSIX"),
]
TEXT = """
from numba import njit

@njit("float64(float64)", cache=KEEP)
def twice(x):
    return 2.0 * x
"""
FILES = ("*.py", "*.nbi", "*.nbc", CHECKSUMS)


@pytest.fixture(autouse=True)
def told_anew():
    code_cache._tell.cache_clear()
    yield
    code_cache._tell.cache_clear()


@pytest.fixture(scope="module")
def pristine(tmp_path_factory):
    """A folder with one program."""
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    folder = tmp_path_factory.mktemp("pristine")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("KINETOSTATICS_CACHE", str(folder))
        load_module(TEXT, keep=True)
    return folder


@pytest.fixture
def entry(pristine, tmp_path, monkeypatch):
    """The folder of the program, in a copy."""
    shutil.copytree(pristine, tmp_path / "programs")
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "programs"))
    return next((tmp_path / "programs").iterdir())


class Planted:
    """A pickle that leaves a file when it is read."""

    def __init__(self, path):
        self.path = str(path)

    def __reduce__(self):
        return Path.touch, (Path(self.path),)


def flipped(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0x10
    path.write_bytes(content)


def cut(path):
    path.write_bytes(path.read_bytes()[:-7])


def halved(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def made_folder(path):
    path.unlink()
    path.mkdir()


def made_link(path):
    path.rename(path.parent.parent.parent / "elsewhere")
    path.symlink_to(path.parent.parent.parent / "elsewhere")


def made_dangling(path):
    path.unlink()
    path.symlink_to("nowhere")


def made_pipe(path):
    path.unlink()
    os.mkfifo(path)


DAMAGE = {
    "flipped": flipped,
    "cut": cut,
    "halved": halved,
    "empty": lambda path: path.write_bytes(b""),
    "garbage": lambda path: path.write_bytes(b"\x80\x05garbage" * 40),
    "text": lambda path: path.write_text("[" * 20_000),
    "longer": lambda path: path.write_bytes(path.read_bytes() + b"{"),
    "missing": Path.unlink,
    "a folder": made_folder,
    "a link": made_link,
    "a link to nowhere": made_dangling,
    "a pipe": made_pipe,
    "planted": lambda path: path.write_bytes(pickle.dumps(Planted(path.with_name("ran")))),
}


@pytest.mark.parametrize(
    ("file", "damage"),
    [
        *((file, "flipped") for file in FILES),
        *((CHECKSUMS, damage) for damage in DAMAGE if damage != "flipped"),
        *(("*.nbc", damage) for damage in ("missing", "a link", "a pipe", "planted")),
    ],
)
def test_damaged_machine_code_is_recompiled(entry, file, damage):
    DAMAGE[damage](next(entry.rglob(file)))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert load_module(TEXT, keep=True).twice(2.1) == 4.2
    assert [item.category for item in caught] == [CacheWarning]
    assert "was damaged and is compiled again" in str(caught[0].message)
    assert is_intact(entry)
    again = load_module(TEXT, keep=True)
    assert (sum(again.twice.stats.cache_hits.values()), again.twice(2.1)) == (1, 4.2)
    assert not list(entry.parent.rglob("ran"))


@pytest.mark.parametrize("name", ["other.py", "__pycache__/other.nbi", "__pycache__/{}.cpython-311.pyc"])
def test_files_that_were_not_there_make_it_damaged(entry, name):
    (entry / name.format(entry.name)).write_bytes(pickle.dumps(Planted(entry / "ran")))
    with pytest.warns(CacheWarning, match="was damaged"):
        assert load_module(TEXT, keep=True).twice(2.1) == 4.2


def loosened(select, bits):
    def arrange(entry):
        path = select(entry)
        path.chmod(stat.S_IMODE(path.stat().st_mode) | bits)

    return arrange


def handed_over(select):
    def arrange(entry):
        os.lchown(select(entry), 12345, -1)

    return arrange


PLACES = {
    "folder": lambda entry: entry.parent,
    "entry": lambda entry: entry,
    "index": lambda entry: next(entry.rglob("*.nbi")),
    "code": lambda entry: next(entry.rglob("*.nbc")),
    "text": lambda entry: next(entry.rglob("*.py")),
    "checksums": lambda entry: entry / CHECKSUMS,
    "place of the code": lambda entry: entry / "__pycache__",
    "parent": lambda entry: entry.parent.parent,
}
OPEN = {
    **{f"{name}, group": loosened(place, 0o020) for name, place in PLACES.items()},
    **{f"{name}, all": loosened(PLACES[name], 0o002) for name in ("entry", "code", "parent")},
    "folder, all, sticky": loosened(PLACES["folder"], 0o1002),
}
FOREIGN = {name: handed_over(place) for name, place in PLACES.items()}


def assert_untrusted(entry, message):
    """Not even with a seal that fits is anything read; it stays as it is."""
    before = {path: path.stat().st_mtime_ns for path in entry.rglob("*")}
    with pytest.warns(CacheWarning, match=message) as caught:
        module = load_module(TEXT, keep=True)
    assert len(caught) == 1
    assert (sum(module.twice.stats.cache_hits.values()), module.twice(2.1)) == (0, 4.2)
    assert {path: path.stat().st_mtime_ns for path in entry.rglob("*")} == before


@pytest.mark.parametrize("name", OPEN)
def test_what_others_may_write_is_not_trusted(entry, name):
    OPEN[name](entry)
    assert_untrusted(entry, "others may write to")


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="only root gives files away")
@pytest.mark.parametrize("name", FOREIGN)
def test_what_belongs_to_another_user_is_not_trusted(entry, name):
    FOREIGN[name](entry)
    assert_untrusted(entry, "belongs to another user")


def test_link_into_a_writable_folder_is_not_trusted(entry, tmp_path, monkeypatch):
    (tmp_path / "open").mkdir()
    entry.parent.rename(tmp_path / "open" / "programs")
    (tmp_path / "open").chmod(0o777)
    (tmp_path / "link").symlink_to(tmp_path / "open" / "programs")
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "link"))
    assert_untrusted(tmp_path / "open" / "programs" / entry.name, "others may write to .*open")


def test_a_link_that_others_may_replace_is_not_trusted(entry, tmp_path, monkeypatch):
    (tmp_path / "open").mkdir()
    (tmp_path / "open").chmod(0o777)
    (tmp_path / "open" / "link").symlink_to(entry.parent)
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path / "open" / "link"))
    assert_untrusted(entry, "others may write to .*open")


def test_own_folder_in_a_sticky_one_is_trusted(tmp_path):
    (tmp_path / "shared" / "own").mkdir(parents=True, mode=0o700)
    (tmp_path / "shared").chmod(0o1777)
    require_private(tmp_path / "shared" / "own")
    (tmp_path / "shared").chmod(0o777)
    with pytest.raises(UntrustedError, match="shared; give another folder, or chmod go-w"):
        require_private(tmp_path / "shared" / "own")


def test_code_planted_for_the_interpreter_never_runs(tmp_path, monkeypatch):
    """Bytecode beside the text, by any name that the import system would look for."""
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    folder = tmp_path / "programs"
    (folder / "__pycache__").mkdir(parents=True)
    names = [code_cache._name(TEXT), code_cache._name(TEXT, *code_cache._machine())]
    for name in names:
        for place in (folder, folder / "__pycache__", tmp_path):
            (place / f"{name}.py").write_text("raise SystemExit")
            (place / f"{name}.cpython-311.pyc").write_bytes(b"planted")
    folder.chmod(0o700)
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(folder))
    monkeypatch.syspath_prepend(tmp_path)
    assert load_module(TEXT, keep=True).twice(2.1) == 4.2
