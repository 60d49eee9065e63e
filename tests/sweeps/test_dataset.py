"""Folders that sweeps write to, resume from, and refuse."""

import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.sweeps import chunk, dataset
from kinetostatics.sweeps import workers as dispatch
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.case_files import written
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, sweep


def counted(calls):
    """A function that counts how often it is called, whose text tells no counts."""

    def made(crank, mass):
        calls.append(np.size(crank))
        return factories.pump(crank, mass)

    return made


@every("folder", [5, 2.5, ["here"], b"here", True])
def test_a_folder_that_is_no_path_is_refused(folder):
    with pytest.raises(ks.ParameterError, match="sweep: folder must be a path, got"):
        sweep(factories.pump, DESIGNS, OUTPUTS, folder=folder)


@pytest.mark.slow
def test_a_folder_holds_a_dataset_that_pandas_reads(tmp_path, expected):
    folder = tmp_path / "new" / "sweep"
    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=folder), expected)
    assert_equal(pd.read_parquet(folder), expected)
    assert len(list(folder.glob("part-*.parquet"))) == 6
    named = DESIGNS.set_index(pd.Index([f"design {row}" for row in range(41)], name="name"))
    found = sweep(factories.pump, named, OUTPUTS, chunk=7, folder=tmp_path / "named")
    assert_equal(found, expected.set_index(named.index))
    assert_equal(pd.read_parquet(tmp_path / "named"), found)


@pytest.mark.slow
def test_rows_may_share_a_name(tmp_path, expected):
    twice = DESIGNS.set_index(pd.Index([0] * 41))
    found = sweep(factories.pump, twice, OUTPUTS, chunk=7)
    assert_equal(found.reset_index(drop=True), expected)
    assert_equal(sweep(factories.pump, twice, OUTPUTS, chunk=7, folder=tmp_path), found)


@pytest.mark.slow
def test_finished_folder_is_read_again(tmp_path):
    calls: list[int] = []
    first = sweep(counted(calls), DESIGNS, OUTPUTS, chunk=7, folder=tmp_path)
    calls.clear()
    assert_equal(sweep(counted(calls), DESIGNS, OUTPUTS, chunk=7, folder=tmp_path), first)
    assert calls == [1]  # the trial before a sweep


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
def test_an_interrupted_sweep_goes_on_where_it_stopped(tmp_path, expected, monkeypatch, error):
    calls: list[int] = []
    function, run = counted(calls), chunk.run_chunk

    def interrupted(job, frame):
        if 30 in frame.index:
            raise error
        return run(job, frame)

    monkeypatch.setattr(dispatch, "run_chunk", interrupted)
    with pytest.raises(error):
        sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path)
    assert len(list(tmp_path.glob("part-*"))) == 4
    (tmp_path / ".part-000004-half.parquet").write_bytes(b"PAR1 half written")
    monkeypatch.undo()
    calls.clear()
    assert_equal(sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path), expected)
    assert sum(calls) == 1 + 7 + 6
    assert_equal(pd.read_parquet(tmp_path), expected)


@pytest.mark.slow
def test_a_killed_process_leaves_a_folder_that_goes_on(tmp_path, expected):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from support import factories as f; import kinetostatics as ks;"
        " ks.sweep(f.deadly_once(0.3, sys.argv[2]), f.DESIGNS, f.OUTPUTS, chunk=7, folder=sys.argv[3], progress=False)"
    )
    marker, folder = tmp_path / "died", tmp_path / "sweep"
    here = str(Path(__file__).parents[1])
    killed = subprocess.run([sys.executable, "-c", code, here, str(marker), str(folder)], check=False)
    assert killed.returncode == -signal.SIGKILL
    assert len(list(folder.glob("part-*"))) == 2
    function = factories.deadly_once(0.3, marker)
    assert_equal(sweep(function, DESIGNS, OUTPUTS, chunk=7, folder=folder), expected)


@pytest.mark.slow
def test_stopped_worker_sweep_goes_on(tmp_path, expected, monkeypatch):
    """By an error while results come in."""
    put = dataset.Dataset.keep

    def full(self, number, rows):
        if number == 3:
            raise OSError("disk full")
        put(self, number, rows)

    monkeypatch.setattr(dataset.Dataset, "keep", full)
    with ThreadPoolExecutor(2) as executor:
        with pytest.raises(OSError, match="disk full"):
            sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path, executor=executor)
        monkeypatch.setattr(dataset.Dataset, "keep", put)
        assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, chunk=7, folder=tmp_path, executor=executor), expected)


OTHERS = {
    "function": {"source": factories.picky},
    "designs": {"designs": DESIGNS + 1},
    "columns, designs": {"designs": DESIGNS.rename(columns={"mass": "mass [g]"})},
    "outputs": {"outputs": ["rms O"]},
    "angles": {"angles": 180},
    "chunk": {"chunk": 8},
    "reference": {"outputs": ["ratio rms O"], "reference": factories.pump(0.2)},
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_sweep_in_the_folder_is_refused(tmp_path, name):
    options = {"source": factories.pump, "designs": DESIGNS, "outputs": OUTPUTS, "chunk": 7, "folder": tmp_path}
    if name == "reference":
        options |= {"outputs": ["ratio rms O"], "reference": factories.pump(0.1)}
    sweep(**options)
    with pytest.raises(ks.ParameterError, match=f"another sweep, which differs in .*{name.split(', ')[0]}"):
        sweep(**options | OTHERS[name])


def test_cases_differ_by_variants_and_files(tmp_path):
    """Not by comments, other variants or how the same variant is named."""
    designs, options = pd.DataFrame({"crank_speed": [30, 33]}), {"chunk": 1, "folder": tmp_path / "sweep", "angles": 12}
    case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"])
    sweep(case, designs, OUTPUTS, variant="cam-circle", **options)
    sweep(SAW, designs, OUTPUTS, **options)
    changed = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam.radius", "0.31 m")
    with pytest.raises(ks.ParameterError, match="another sweep, which differs in variant;"):
        sweep(changed, designs, OUTPUTS, **options)


def test_a_case_that_was_loaded_is_swept_as_it_was(tmp_path):
    """Whatever becomes of its file, and with the file that it names."""
    case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"])
    designs = pd.DataFrame({"crank_speed": [30.0]})
    before = sweep(case, designs, OUTPUTS)
    changed = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam.radius", "0.31 m")
    assert_equal(sweep(case, designs, OUTPUTS), before)
    assert not sweep(changed, designs, OUTPUTS).equals(before)


@pytest.mark.slow
def test_files_that_a_case_names_are_part_of_it(tmp_path):
    designs, options = pd.DataFrame({"crank_speed": [30.0, 33.0]}), {"angles": 12, "folder": tmp_path / "sweep"}
    cam = {"kind": "sampled", "table": "cam.csv"}
    for radius in (0.3, 0.31):
        rows = (f"{angle}, {radius + 0.02 * np.cos(np.radians(angle))}" for angle in range(0, 360, 5))
        (tmp_path / "cam.csv").write_text("\n".join(["angle [deg], radius [m]", *rows]), encoding="utf-8")
        case = written(tmp_path, "sawframe_2r63", ["plain", "cam-circle"], "cam", cam)
        if radius == 0.3:
            assert sweep(case, designs, OUTPUTS, **options)[FAILED].eq("").all()
    with pytest.raises(ks.ParameterError, match="differs in variant;"):
        sweep(case, designs, OUTPUTS, **options)
