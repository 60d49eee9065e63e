"""Chunks of a sweep run by workers or an executor; chunks whose worker dies run again."""

import os
import signal
import threading
import time
from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import contextmanager
from typing import Any

import numpy as np
import pandas as pd

from ..errors import KinetostaticsError
from .chunk import result_table, run_chunk

MAX_CHUNK_RUNS = 3
"""Number of runs of a chunk whose worker dies, before the faulty designs are isolated."""
MAX_DESIGN_RUNS = 2
"""Number of runs of a single design whose worker dies, before it fails."""
MAX_PENDING_CHUNKS = 256
"""Number of chunks submitted to an executor at a time; own workers get two each."""


class Workers:
    """Runs chunks in own processes, which are replaced when one dies, in an executor, or in this process.

    Own processes ignore Ctrl-C and SIGTERM, and end when this process ends.
    """

    def __init__(self, executor=None, count=None):
        self._given = executor or _SameProcess()
        self._pool: Any = None
        self._count = count
        self.capacity = 2 * count if count else MAX_PENDING_CHUNKS if executor else 1

    def __enter__(self):
        return self

    def __exit__(self, kind, *error):
        self._stop(at_once=kind is not None)

    def submit(self, *call) -> Future:
        """Future of a call, as from any executor."""
        try:
            return self._submit_once(call)
        except BrokenExecutor as error:
            self.count_deaths(error)
            self._stop(at_once=True)
            return self._submit_once(call)

    def use_one_process(self):
        """Start only one process from now on."""
        self._count = self._count and 1

    def cancel(self, futures):
        """Cancel pending calls of a user's executor.

        Own processes are stopped instead: cancelling their calls would break the thread that serves them.
        """
        if self._count is None:
            for future in futures:
                future.cancel()

    def result_unless_killed(self, *call):
        """Result of a call as a tuple of one; empty if the worker died."""
        try:
            return (self.submit(*call).result(),)
        except Exception as error:
            self.count_deaths(error)
            return ()

    def count_deaths(self, error):
        """Number of dead workers behind an error; raises the error if there is none."""
        if type(error).__name__ == "KilledWorker":  # Dask has tried several workers
            return MAX_CHUNK_RUNS
        if _is_lost_result(error):
            return 1
        if not isinstance(error, BrokenExecutor):
            raise error
        if self._count is None:
            raise KinetostaticsError(
                f"sweep: the executor broke, because a worker died or could not start ({error}); give workers=n "
                "instead of executor= for processes that are replaced when they die"
            ) from error
        return 1

    def _submit_once(self, call):
        if not self._count:
            return self._given.submit(*call)
        if self._pool is None:
            from loky import ProcessPoolExecutor

            self._pool = ProcessPoolExecutor(self._count, initializer=_start_worker, initargs=(os.getpid(),))
        with _signals_blocked():  # new processes inherit the mask
            return self._pool.submit(*call)

    def _stop(self, at_once):
        if self._pool is not None:
            self._pool.shutdown(kill_workers=at_once)
            self._pool = None


def _is_lost_result(error):
    """Whether Dask's executor mistook a table for an error.

    This happens if the worker dies after its table has arrived but before Dask reads the state of the call.
    """
    trace = error.__traceback__
    while trace and trace.tb_next:
        trace = trace.tb_next
    raised_in = trace and trace.tb_frame.f_globals.get("__name__")
    return raised_in == "distributed.cfexecutor" and isinstance(error, AttributeError | ValueError)


class _SameProcess(Executor):
    """Runs calls immediately in this process and thread."""

    def submit(self, function, /, *arguments, **options):
        future: Future = Future()
        future.set_result(function(*arguments, **options))
        return future


def _start_worker(parent):
    """Let a worker ignore signals, which the parent handles, and end with the parent.

    A worker that ended on a signal while sending a result would block the parent, which waits for the rest.
    """

    def exit_with_parent():
        while os.getppid() == parent:
            time.sleep(0.5)
        os._exit(1)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=exit_with_parent, daemon=True).start()


@contextmanager
def _signals_blocked():
    """Block Ctrl-C and SIGTERM on systems with signal masks."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def run_chunks(job, rows_of, numbers, workers):
    """Yield number and result of each chunk, in order of completion; ``rows_of(number)`` gives its designs."""
    waiting = deque(numbers)
    suspects: list[int] = []
    running: dict[Future, int] = {}
    deaths: Counter[int] = Counter()
    try:
        while waiting or running:
            while waiting and len(running) < workers.capacity:
                number = waiting.popleft()
                running[workers.submit(run_chunk, job, rows_of(number))] = number
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                number = running.pop(future)
                try:
                    found = future.result()
                except Exception as error:
                    deaths[number] += workers.count_deaths(error)
                    (waiting.appendleft if deaths[number] < MAX_CHUNK_RUNS else suspects.append)(number)
                else:
                    yield number, found
        workers.use_one_process()
        if suspects and not workers.result_unless_killed(run_chunk, job, rows_of(suspects[0])[:0]):
            raise KinetostaticsError("sweep: the workers die before any computation")
        for number in suspects:
            yield number, _isolate_deaths(job, rows_of(number), workers)
    finally:
        workers.cancel(running)


def _isolate_deaths(job, frame, workers):
    """Outputs of designs that may kill their worker, by bisection down to the faulty designs.

    A single design runs again, as its worker may have died for another reason.
    """
    alone = len(frame) == 1
    for _ in range(MAX_DESIGN_RUNS if alone else 1):
        for found in workers.result_unless_killed(run_chunk, job, frame):
            return found
    if alone:
        return result_table(
            job, frame, np.full((len(job.items), 1), np.nan), np.array(["the worker died with this design"])
        )
    halves = np.array_split(np.arange(len(frame)), 2)
    return pd.concat([_isolate_deaths(job, frame.iloc[half], workers) for half in halves])
