"""Sweeps through threads, processes and Dask: the same table, also where workers die."""

import asyncio
import logging
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import closing
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.sweeps import chunk, sweeps
from kinetostatics.sweeps import workers as dispatch
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, rising, sweep

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def cluster():
    """Executor of two Dask workers, each a process, which gives a task up after one death."""
    distributed = pytest.importorskip("distributed", reason="dask is not installed (extra: distributed)")
    dask = pytest.importorskip("dask")
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=logging.CRITICAL
        ) as local,
        distributed.Client(local) as client,
    ):
        yield client.get_executor()


@pytest.fixture
def tidy():
    """No process is left behind; those of the Dask cluster beside come and go by themselves."""
    before = set(multiprocessing.active_children())
    yield
    left = set(multiprocessing.active_children()) - before
    assert not {process for process in left if not process.name.startswith("Dask")}


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_local_executors_give_the_same_table(expected, kind):
    with kind(2) as executor:
        assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor, chunk=7), expected)
        assert_equal(sweep(SAW, rising(20), OUTPUTS, executor=executor, chunk=7), sweep(SAW, rising(20), OUTPUTS))


def test_dask_gives_the_same_table(cluster, expected):
    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=cluster, chunk=7), expected)
    made = lambda crank, mass: factories.pump(crank, mass)  # noqa: E731
    assert_equal(sweep(made, DESIGNS, OUTPUTS, executor=cluster, chunk=7), expected)


def test_each_worker_computes_on_one_core(monkeypatch):
    taken = []
    monkeypatch.setattr(numba_backend, "core_count", lambda: 5)
    monkeypatch.setattr(sweeps, "run_chunks", lambda job, *rest: taken.append(job.threads) or (_ for _ in ()))
    with ThreadPoolExecutor(2) as executor, pytest.raises(KeyError):
        sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor)
    with pytest.raises(KeyError):
        sweep(factories.pump, DESIGNS, OUTPUTS)
    assert taken == [1, 5]


def test_a_function_that_cannot_travel_is_refused():
    with (
        ProcessPoolExecutor(1) as executor,
        pytest.raises(ks.ParameterError, match="define the function at the top of a module"),
    ):
        sweep(lambda crank, mass: factories.pump(crank, mass), DESIGNS, OUTPUTS, executor=executor)


def test_workers_give_the_same_table_of_any_function(tidy, expected):
    made = lambda crank, mass: factories.pump(crank, mass)  # noqa: E731
    assert_equal(sweep(made, DESIGNS, OUTPUTS, workers=2, chunk=7), expected)


def test_a_worker_that_dies_costs_nothing(tidy, tmp_path, expected):
    marker = tmp_path / "died"
    function = factories.deadly_once(0.3, marker)
    assert_equal(sweep(function, DESIGNS, OUTPUTS, workers=2, chunk=7), expected)
    assert marker.exists()


def test_a_worker_of_dask_that_dies_costs_nothing(cluster, tmp_path, expected):
    marker = tmp_path / "died"
    assert_equal(
        sweep(factories.deadly_once(0.3, marker), DESIGNS, OUTPUTS, executor=cluster, chunk=7, folder=tmp_path / "out"),
        expected,
    )
    assert marker.exists()


@pytest.mark.parametrize("columns", [2, 3, 4])
def test_a_table_that_dask_takes_for_an_error_is_computed_again(columns):
    """The worker dies between the arrival of its table and the look at the state of its call."""
    cfexecutor = pytest.importorskip("distributed.cfexecutor", reason="dask is not installed (extra: distributed)")

    class Lost:
        status = "lost"

        async def _result(self, raiseit):
            return pd.DataFrame(np.ones((1, columns)), columns=list("abcd"[:columns]))

    async def finish(future):
        await cfexecutor._cascade_future(Lost(), future)

    future = Future()
    asyncio.run(finish(future))
    with ThreadPoolExecutor(1) as executor, dispatch.Workers(executor) as workers:
        assert workers.count_deaths(future.exception()) == 1
        with pytest.raises(ValueError, match="of the user"):
            workers.count_deaths(ValueError("of the user"))


def test_cases_go_to_workers(tidy):
    assert_equal(sweep(SAW, rising(20), OUTPUTS, workers=1, chunk=7), sweep(SAW, rising(20), OUTPUTS))


def assert_only_lost(found, expected, rows):
    assert set(found[FAILED][rows]) == {"the worker died with this design"}
    assert found.loc[rows].iloc[:, 2:4].isna().all(axis=None)
    assert_equal(found.drop(rows), expected.drop(rows))


@pytest.fixture
def impatient(monkeypatch):
    """Chunks are run once before the designs that kill their worker are looked for: each death costs a second."""
    monkeypatch.setattr(dispatch, "MAX_CHUNK_RUNS", 1)


def test_only_killing_designs_are_given_up(tidy, impatient, expected):
    """Also the first, on which the sweep is tried."""
    rows = [19, 21]
    function = factories.deadly(*DESIGNS["crank [mm]"][rows] * 0.001)
    found = sweep(function, DESIGNS[19:23], OUTPUTS, workers=1, chunk=2)
    assert_only_lost(found, expected[19:23], rows)


def test_only_killing_designs_are_given_up_by_dask(cluster, expected):
    found = sweep(factories.deadly(0.3), DESIGNS[19:21], OUTPUTS, executor=cluster, chunk=2)
    assert_only_lost(found, expected[19:21], [20])


def test_workers_that_die_of_themselves_end_the_sweep(tidy, impatient):
    with pytest.raises(ks.KinetostaticsError, match="die before any computation"):
        sweep(factories.Poison(), DESIGNS, OUTPUTS, workers=1, chunk=50)


@pytest.mark.parametrize("death", ["when it starts", "when it computes"])
def test_broken_executor_ends_the_sweep(tidy, death):
    """Whoever made it may make it anew; nobody else does."""
    broken = (
        ThreadPoolExecutor(1, initializer=factories.pump)
        if death == "when it starts"
        else ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork"))
    )
    with broken as executor, pytest.raises(ks.KinetostaticsError, match=r"the executor broke.*give workers=n"):
        sweep(factories.deadly(0.3), DESIGNS, OUTPUTS, executor=executor, chunk=7)


def test_only_public_names_of_executors_are_used():
    """Any executor will do: this one has nothing but what the standard promises."""

    class Bare(Executor):
        def submit(self, function, /, *arguments, **options):
            made: Future = Future()
            made.set_result(function(*arguments, **options))
            return made

    assert_equal(sweep(factories.pump, DESIGNS, OUTPUTS, executor=Bare()), sweep(factories.pump, DESIGNS, OUTPUTS))


COUNTS = [0, -1, True, 2.0, "2", int, 10**6, float("nan"), [2]]


@pytest.mark.parametrize("count", COUNTS)
def test_a_number_of_workers_that_cannot_be_is_refused(count):
    with pytest.raises(ks.ParameterError, match="workers must be a whole number of processes from 1 to"):
        sweep(factories.pump, DESIGNS, OUTPUTS, workers=count)


def test_workers_and_an_executor_together_are_refused():
    with ThreadPoolExecutor(1) as executor, pytest.raises(ks.ParameterError, match="workers or an executor, not both"):
        sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor, workers=1)


def test_what_cannot_travel_to_workers_is_refused():
    lock = threading.Lock()
    with pytest.raises(ks.ParameterError, match=r"cannot go to other processes.*give it no open files or locks"):
        sweep(lambda crank, mass: factories.pump(crank, mass) if lock else None, DESIGNS, OUTPUTS, workers=1)


WATCHED = """
import sys; sys.path.insert(0, sys.argv[1])
from support import factories; import kinetostatics as ks
ks.sweep(factories.slow, factories.DESIGNS, factories.OUTPUTS, chunk=1, workers=2, progress=False)
"""


def test_workers_end_with_their_parent_however_it_ends(tmp_path, monkeypatch):
    """Here by a signal that nobody can answer; each worker writes down its process when it computes."""
    monkeypatch.setenv("KINETOSTATICS_TEST_NOTES", str(tmp_path))
    parent = subprocess.Popen(
        [sys.executable, "-c", WATCHED, str(Path(__file__).parents[1])],
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    processes = waited(lambda: [int(path.name) for path in tmp_path.iterdir()], lambda found: len(found) == 2)
    parent.kill()
    assert parent.wait() == -signal.SIGKILL
    assert waited(lambda: list(filter(alive, processes)), lambda found: not found) == []


def test_workers_leave_group_signals_to_the_parent(tidy):
    """One that ended while it handed over a result would leave half of it, for whose rest the parent waits."""
    with dispatch.Workers(count=1) as workers:
        found = [workers.submit(signal.getsignal, number).result() for number in (signal.SIGINT, signal.SIGTERM)]
    assert found == [signal.SIG_IGN, signal.SIG_IGN]


def test_stopped_sweep_drops_waiting_calls(tidy, monkeypatch, caplog, capfd):
    """The thread of a library that serves the processes must not fail, and tell of it, before we say our line."""

    def stopped():
        with dispatch.Workers(count=1) as workers:
            workers.capacity = 9  # more than the processes are handed at a time
            with closing(dispatch.run_chunks(None, lambda number: 60 * number, range(9), workers)) as found:
                next(found)
                raise KeyboardInterrupt

    monkeypatch.setattr(dispatch, "run_chunk", lambda job, seconds: time.sleep(seconds))
    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert caplog.records == []
    assert capfd.readouterr() == ("", "")


def waited(look, enough, seconds=60):
    """What a look tells as soon as it is enough, or at last."""
    end = time.monotonic() + seconds
    while not enough(found := look()) and time.monotonic() < end:
        time.sleep(0.05)
    return found


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_errors_of_the_library_end_the_sweep(monkeypatch):
    monkeypatch.setattr(chunk, "run_chunk", None)
    with ThreadPoolExecutor(1) as executor:
        for error in (ks.errors.MissingLibraryError("no numba here"), OSError("disk full")):
            monkeypatch.setattr(chunk, "compute_batch", partial(raising, error))
            with pytest.raises(type(error), match=str(error)):
                sweep(factories.pump, DESIGNS, OUTPUTS, executor=executor)


def raising(error, *call):
    raise error


class Mortal:
    """Workers of which some die: by the number of designs they are given, and how often they do so before."""

    def __init__(self, dying):
        self.dying, self.tried = dying, []

    def result_unless_killed(self, function, job, frame):
        """What a call gives in a tuple, as of `Workers`."""
        names = tuple(frame.index)
        self.tried.append(names)
        return () if self.dying(names, self.tried.count(names)) else ((names,),)


def test_harmless_design_is_tried_again(monkeypatch):
    """Design 2 kills its worker each time; that of design 3 dies once, of something else."""
    monkeypatch.setattr(dispatch, "result_table", lambda job, frame, numbers, reasons: [*frame.index, *reasons])
    monkeypatch.setattr(dispatch.pd, "concat", list)
    hands = Mortal(lambda names, times: 2 in names or (names == (3,) and times == 1))
    found = dispatch._isolate_deaths(SimpleNamespace(items=()), pd.DataFrame({"x": [0.0] * 4}), hands)
    assert found == [((0, 1),), [[2, "the worker died with this design"], ((3,),)]]
    assert hands.tried.count((2,)) == dispatch.MAX_DESIGN_RUNS
