"""Chunks of a sweep handed to workers or an executor, and run again when a worker dies."""

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
"""How often a chunk is run whose worker dies, before the designs that do it are looked for."""
MAX_DESIGN_RUNS = 2
"""How often a design by itself is run whose worker dies, before it has no numbers."""
MAX_PENDING_CHUNKS = 256
"""Chunks handed to an executor at a time; to workers of our own two for each."""


class Workers:
    """Where chunks run: processes of its own, which are replaced when one dies, an executor, or this process.

    Processes of its own leave Ctrl-C and SIGTERM to this one, and end with it however it ends.
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
            return self._submitted(call)
        except BrokenExecutor as error:
            self.deaths(error)
            self._stop(at_once=True)
            return self._submitted(call)

    def one_at_a_time(self):
        """From now on: processes that must be started anew are one."""
        self._count = self._count and 1

    def give_up(self, futures):
        """Nobody waits for these calls any longer: an executor that was given leaves out those not yet begun.

        Processes of our own are stopped with all that they have: to cancel calls under them as well breaks the thread
        that serves them, which tells of it.
        """
        if self._count is None:
            for future in futures:
                future.cancel()

    def survived(self, *call):
        """Result of a call in a tuple; an empty one if the worker died."""
        try:
            return (self.submit(*call).result(),)
        except Exception as error:
            self.deaths(error)
            return ()

    def deaths(self, error):
        """How many deaths of workers an error of a call tells of; raises it if none."""
        if type(error).__name__ == "KilledWorker":  # of Dask, which has tried several workers
            return MAX_CHUNK_RUNS
        if not isinstance(error, BrokenExecutor):
            raise error
        if self._count is None:
            raise KinetostaticsError(
                f"sweep: the executor broke, as one of its workers died or could not start ({error}); give workers=n "
                "in place of executor= for processes that are replaced when they die"
            ) from error
        return 1

    def _submitted(self, call):
        if not self._count:
            return self._given.submit(*call)
        if self._pool is None:
            self._pool = _pool(self._count)
        with _signals_blocked():  # what starts here inherits it
            return self._pool.submit(*call)

    def _stop(self, at_once):
        if self._pool is not None:
            self._pool.shutdown(kill_workers=at_once)
            self._pool = None


class _SameProcess(Executor):
    """The process and thread that submits, at once."""

    def submit(self, function, /, *arguments, **options):
        future: Future = Future()
        future.set_result(function(*arguments, **options))
        return future


def _pool(count):
    from loky import ProcessPoolExecutor

    return ProcessPoolExecutor(count, initializer=_start_worker, initargs=(os.getpid(),))


def _start_worker(parent):
    """Start of a worker: signals to all processes are left to the parent, and nothing is done that nobody waits for.

    A worker that ends while it hands over a result leaves half of it, for whose rest the parent waits for ever.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=_exit_with_parent, args=(parent,), daemon=True).start()


def _exit_with_parent(parent):
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


@contextmanager
def _signals_blocked():
    """Ctrl-C and SIGTERM wait, where there are signal masks."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def run_chunks(job, rows_of, numbers, workers):
    """Number and result of each chunk, in the order in which they are done.

    Parameters
    ----------
    job : Job
    rows_of : function
        From the number of a chunk to its designs.
    numbers : sequence of int
    workers : Workers
    """
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
                    deaths[number] += workers.deaths(error)
                    (waiting.appendleft if deaths[number] < MAX_CHUNK_RUNS else suspects.append)(number)
                else:
                    yield number, found
        workers.one_at_a_time()
        if suspects and not workers.survived(run_chunk, job, rows_of(suspects[0])[:0]):
            raise KinetostaticsError("sweep: the workers die before they compute anything")
        for number in suspects:
            yield number, _isolate_deaths(job, rows_of(number), workers)
    finally:
        workers.give_up(running)


def _isolate_deaths(job, frame, workers):
    """Outputs of designs that may kill their worker, run by themselves: half by half, down to those that do it.

    One alone is tried again: a worker may die of something else.
    """
    alone = len(frame) == 1
    for _ in range(MAX_DESIGN_RUNS if alone else 1):
        for found in workers.survived(run_chunk, job, frame):
            return found
    if alone:
        return result_table(
            job, frame, np.full((len(job.outputs), 1), np.nan), np.array(["the worker died with this design"])
        )
    halves = np.array_split(np.arange(len(frame)), 2)
    return pd.concat([_isolate_deaths(job, frame.iloc[half], workers) for half in halves])
