"""Data sets and written files that are damaged, foreign or full."""

import json
import os
import shutil
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from pyarrow import parquet

import kinetostatics as ks
from kinetostatics.errors import CacheWarning, KinetostaticsError
from kinetostatics.numbers import files
from kinetostatics.sweeps.dataset import MANIFEST, Dataset
from support.every import every

DESIGNS = pd.DataFrame({"crank": np.linspace(0.1, 0.3, 9)}, index=[f"design {row}" for row in range(9)])
OUTPUT = "rms O"


def pump(crank):
    return ks.Scene(ks.crank_slider(crank, 4.0 * crank, slider=ks.Link(1.0)), 10.0, 0.0, (ks.Gravity(),))


def sweep(folder, designs=DESIGNS, output=OUTPUT):
    return ks.sweep(pump, designs, output, angles=12, chunk=3, folder=folder, progress=False)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("finished")
    return folder, sweep(folder), sweep(tmp_path_factory.mktemp("other"), DESIGNS * 1.1)


@pytest.fixture
def expected(finished):
    return finished[1]


@pytest.fixture
def folder(finished, tmp_path):
    return Path(shutil.copytree(finished[0], tmp_path / "sweep"))


def part(folder, number=1):
    return folder / f"part-{number:06d}.parquet"


def changed(change, told=True):
    """Damage by a program that reads and writes Parquet, keeping what the part tells of itself or not."""

    def damage(path):
        before = parquet.read_table(path)
        after = pa.Table.from_pandas(change(before.to_pandas()))
        told_before = {b"kinetostatics": before.schema.metadata[b"kinetostatics"]} if told else {}
        parquet.write_table(after.replace_schema_metadata({**after.schema.metadata, **told_before}), path)

    return damage


def number_changed(frame):
    frame.iloc[1, 1] *= 1 + 1e-15
    return frame


def flipped(where):
    def damage(path):
        content = bytearray(path.read_bytes())
        content[int(where * (len(content) - 1))] ^= 0x04
        path.write_bytes(content)

    return damage


def told(text):
    def damage(path):
        table = parquet.read_table(path)
        parquet.write_table(table.replace_schema_metadata({**table.schema.metadata, b"kinetostatics": text}), path)

    return damage


DAMAGE = {
    "empty": lambda path: path.write_bytes(b""),
    "cut": lambda path: path.write_bytes(path.read_bytes()[:-20]),
    "half": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "text": lambda path: path.write_text("crank,rms O\n1,2\n"),
    "zeros": lambda path: path.write_bytes(bytes(path.stat().st_size)),
    "another chunk": lambda path: shutil.copy(part(path.parent, 2), path),
    "rows missing": changed(lambda frame: frame.iloc[:2]),
    "rows twice": changed(lambda frame: pd.concat([frame, frame])),
    "rows in another order": changed(lambda frame: frame.iloc[::-1]),
    "rows named otherwise": changed(lambda frame: frame.rename(index=str.upper)),
    "index named": changed(lambda frame: frame.rename_axis("name")),
    "column missing": changed(lambda frame: frame.drop(columns="rms O [N]")),
    "column more": changed(lambda frame: frame.assign(more=1.0)),
    "column renamed": changed(lambda frame: frame.rename(columns={"rms O [N]": "rms O [kN]"})),
    "columns in another order": changed(lambda frame: frame[frame.columns[::-1]]),
    "single precision": changed(lambda frame: frame.astype({"rms O [N]": np.float32})),
    "numbers as texts": changed(lambda frame: frame.astype({"rms O [N]": str})),
    "whole numbers": changed(lambda frame: frame.assign(**{"rms O [N]": [1, 2, 3]})),
    "a number changed": changed(number_changed),
    "a number lost": changed(lambda frame: frame.assign(**{"rms O [N]": np.nan})),
    "a reason changed": changed(lambda frame: frame.assign(failed="").assign(failed=["", "x", ""])),
    "nothing told": changed(lambda frame: frame, told=False),
    "told: a list": told("[]"),
    "told: nothing": told("{}"),
    "told: no JSON": told("{"),
    "told: nested": told("[" * 20_000),
    **{f"flipped at {where}": flipped(where) for where in np.linspace(0.0, 1.0, 6)},
}


@pytest.mark.slow
@every("name", DAMAGE)
def test_a_damaged_part_is_made_anew(folder, expected, name):
    DAMAGE[name](part(folder))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CacheWarning)
        found = sweep(folder)
    pd.testing.assert_frame_equal(found, expected, check_exact=True)
    pd.testing.assert_frame_equal(pd.read_parquet(folder), expected, check_exact=True)
    if name.startswith("flipped") and not caught:  # of what no reader looks at
        return
    assert [item.category for item in caught] == [CacheWarning]
    message = (
        f"{folder} these files are not parts of this sweep and are computed again or left out: part-000001.parquet"
    )
    assert message in str(caught[0].message)
    assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error", CacheWarning)
        sweep(folder)


@pytest.mark.slow
def test_a_part_of_another_sweep_is_made_anew(finished, folder, expected, tmp_path):
    sweep(tmp_path / "other", DESIGNS * 1.1)
    shutil.copy(part(tmp_path / "other"), part(folder))
    with pytest.warns(CacheWarning, match=r"part-000001.parquet \(the sweep differs from the written one\)"):
        pd.testing.assert_frame_equal(sweep(folder), expected, check_exact=True)


@pytest.mark.slow
def test_one_warning_names_some_of_many(folder, expected):
    for number in range(3):
        part(folder, number).write_bytes(b"")
    for number in (7, 8, 123456):
        shutil.copy(part(folder, 0), part(folder, number))
    with pytest.warns(CacheWarning) as caught:
        pd.testing.assert_frame_equal(sweep(folder), expected, check_exact=True)
    assert len(caught) == 1
    assert "part-000007.parquet (the sweep does not have this chunk)" in str(caught[0].message)
    assert str(caught[0].message).endswith("and 1 more")


def test_a_part_changed_during_the_sweep_is_reported(folder, monkeypatch):
    part(folder, 2).unlink()
    put = Dataset.keep

    def disturbed(self, number, whole):
        put(self, number, whole)
        part(folder, 0).write_bytes(b"")

    monkeypatch.setattr(Dataset, "keep", disturbed)
    with pytest.raises(KinetostaticsError, match=r"part-000000.parquet was changed while the sweep ran"):
        sweep(folder)


MANIFESTS = {
    "empty": b"",
    "no JSON": b"{",
    "no text": b"\xff\xfe\x00",
    "a list": b"[1, 2]",
    "a number": b"3",
    "null": b"null",
    "a text": b'"sweep"',
    "nested": b"[" * 100_000,
    "large": b" " * (10**7 + 1),
}


@pytest.mark.parametrize("name", MANIFESTS)
def test_a_manifest_that_tells_nothing_is_refused(folder, name):
    (folder / MANIFEST).write_bytes(MANIFESTS[name])
    with pytest.raises(ks.ParameterError, match=r"does not name the sweep of the folder: .*; give another"):
        sweep(folder)


@pytest.mark.parametrize("value", ["{}", '{"version": [1]}', '{"version": null, "function": {}, "angles": "12"}'])
def test_a_manifest_of_other_values_is_another_sweep(folder, value):
    (folder / MANIFEST).write_text(value)
    with pytest.raises(ks.ParameterError, match="contains another sweep, which differs in version"):
        sweep(folder)


def test_another_library_version_is_another_sweep(folder):
    record = json.loads((folder / MANIFEST).read_text())
    (folder / MANIFEST).write_text(json.dumps(record | {"version": "0.0.1"}))
    with pytest.raises(ks.ParameterError, match="contains another sweep, which differs in version;"):
        sweep(folder)


def manifest_folder(folder):
    (folder / MANIFEST).unlink()
    (folder / MANIFEST).mkdir()


def manifest_pipe(folder):
    (folder / MANIFEST).unlink()
    os.mkfifo(folder / MANIFEST)


def manifest_link(folder):
    (folder / MANIFEST).unlink()
    (folder / MANIFEST).symlink_to("nowhere")


def part_folder(folder):
    part(folder).unlink()
    part(folder).mkdir()


def part_pipe(folder):
    part(folder).unlink()
    os.mkfifo(part(folder))


def part_link(folder):
    part(folder).unlink()
    part(folder).symlink_to("nowhere")


def foreign(folder):
    (folder / MANIFEST).unlink()
    parquet.write_table(pa.table({"a": [1.0]}), part(folder))


def a_file(folder):
    shutil.rmtree(folder)
    folder.touch()


def below_a_file(folder):
    shutil.rmtree(folder.parent)
    folder.parent.touch()


PLACES = {
    "manifest is a folder": (manifest_folder, "does not name the sweep"),
    "manifest is a pipe": (manifest_pipe, "does not name the sweep"),
    "manifest is a link to nowhere": (manifest_link, "does not name the sweep"),
    "a part is a folder": (part_folder, "part-000001.parquet is no file; remove it"),
    "a part is a pipe": (part_pipe, "part-000001.parquet is no file; remove it"),
    "a part is a link to nowhere": (part_link, "part-000001.parquet is no file; remove it"),
    "files of something else": (foreign, f"contains part-000001.parquet, but no {MANIFEST}"),
    "a file": (a_file, "cannot be used: .*exists"),
    "below a file": (below_a_file, "cannot be used: "),
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="files of POSIX")
@pytest.mark.parametrize("name", PLACES)
def test_a_folder_that_cannot_be_used_is_refused(folder, name):
    arrange, message = PLACES[name]
    arrange(folder)
    with pytest.raises(ks.ParameterError, match=message):
        sweep(folder)


def test_a_manifest_that_is_lost_is_written_again(folder, expected):
    before = (folder / MANIFEST).read_bytes()
    (folder / MANIFEST).unlink()
    pd.testing.assert_frame_equal(sweep(folder), expected, check_exact=True)
    assert (folder / MANIFEST).read_bytes() == before


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() == 0, reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_is_refused(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(ks.ParameterError, match=r"cannot be used: .*denied"):
        sweep(tmp_path)


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="limits of POSIX")
def test_full_disk_is_reported_and_sweep_resumes(tmp_path, expected):
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
    try:
        with pytest.raises(KinetostaticsError, match=r"part-000000.parquet cannot be written: .*the same call goes on"):
            sweep(tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert [path.name for path in tmp_path.iterdir()] == [MANIFEST]
    pd.testing.assert_frame_equal(sweep(tmp_path), expected, check_exact=True)


# Two at once


def together(monkeypatch, other):
    """Let another sweep begin in the folder just before this one writes down that it is its own."""
    from kinetostatics.sweeps import dataset

    create = dataset._write_new

    def late(path, text):
        monkeypatch.setattr(dataset, "_write_new", create)
        other()
        create(path, text)

    monkeypatch.setattr(dataset, "_write_new", late)


def test_second_of_two_simultaneous_sweeps_is_refused(tmp_path, monkeypatch, expected):
    together(monkeypatch, lambda: sweep(tmp_path))
    with pytest.raises(ks.ParameterError, match="contains another sweep, which differs in designs"):
        sweep(tmp_path, DESIGNS * 1.1)
    pd.testing.assert_frame_equal(sweep(tmp_path), expected, check_exact=True)


def test_equal_simultaneous_sweeps_share_a_folder(tmp_path, monkeypatch, expected):
    together(monkeypatch, lambda: sweep(tmp_path))
    pd.testing.assert_frame_equal(sweep(tmp_path), expected, check_exact=True)
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


def test_manifest_is_exclusive_without_hard_links(tmp_path, monkeypatch, expected):
    def refused(*_):
        raise OSError("no hard links")

    monkeypatch.setattr(Path, "hardlink_to", refused)
    pd.testing.assert_frame_equal(sweep(tmp_path), expected, check_exact=True)
    together(monkeypatch, lambda: sweep(tmp_path / "new"))
    with pytest.raises(ks.ParameterError, match="contains another sweep"):
        sweep(tmp_path / "new", DESIGNS * 1.1)


# Files are written whole or not at all, with the permissions, owner and links that they had


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
