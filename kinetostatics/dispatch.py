"""Chunks of a sweep handed to an executor, and run again when a worker dies."""

from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, ProcessPoolExecutor, wait

import numpy as np
import pandas as pd

from .chunks import rows, run_chunk
from .errors import KinetostaticsError

ATTEMPTS = 3
"""How often a chunk is run whose worker dies, before the designs that do it are looked for."""
WAITING = 256
"""Chunks handed to an executor at a time; two for each worker if it tells how many it has."""


def computed(job, rows_of, numbers, executor):
    """Number and result of each chunk, in the order in which they are done.

    Parameters
    ----------
    job : Job
    rows_of : function
        From the number of a chunk to its designs.
    numbers : sequence of int
    executor : Executor or None
        None: here, one after the other.
    """
    if executor is None:
        for number in numbers:
            yield number, run_chunk(job, rows_of(number))
        return
    with _Workers(executor) as workers:
        yield from _by_workers(job, rows_of, numbers, workers)


def _by_workers(job, rows_of, numbers, workers):
    waiting, suspects, running = deque(numbers), [], {}
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
                    deaths[number] += _deaths(error)
                    if deaths[number] < ATTEMPTS:
                        waiting.appendleft(number)
                    else:
                        suspects.append(number)
                else:
                    yield number, found
        if suspects:
            _require_life(job, rows_of(suspects[0]), workers)
        for number in suspects:
            yield number, _narrowed(job, rows_of(number), workers)
    finally:
        for future in running:
            future.cancel()


def _deaths(error):
    """How many deaths of workers an error tells of; raises it if none."""
    if isinstance(error, BrokenExecutor):
        return 1
    if type(error).__name__ == "KilledWorker":  # of Dask, which has tried several workers
        return ATTEMPTS
    raise error


def _require_life(job, frame, workers):
    """Raise an error if workers die without any design."""
    try:
        workers.submit(run_chunk, job, frame.iloc[:0]).result()
    except Exception as error:
        _deaths(error)
        raise KinetostaticsError("sweep: the workers of the executor die before they compute anything") from error


def _narrowed(job, frame, workers):
    """Outputs of designs that may kill their worker, run by themselves: half by half, down to those that do it."""
    try:
        return workers.submit(run_chunk, job, frame).result()
    except Exception as error:
        _deaths(error)
    if len(frame) == 1:
        return rows(job, frame, np.full((len(job.outputs), 1), np.nan), np.array(["the worker died with this design"]))
    halves = np.array_split(np.arange(len(frame)), 2)
    return pd.concat([_narrowed(job, frame.iloc[half], workers) for half in halves])


class _Workers:
    """An executor; of processes, one that is replaced when it breaks because a process died."""

    def __init__(self, executor):
        self._given = self._current = executor
        workers = getattr(executor, "_max_workers", None)
        self.capacity = 2 * workers if workers else WAITING

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._let_go()

    def submit(self, *call):
        try:
            return self._current.submit(*call)
        except BrokenExecutor:
            if not isinstance(self._current, ProcessPoolExecutor):
                raise
            self._let_go()
            self._current = _alike(self._current)
            return self._current.submit(*call)

    def _let_go(self):
        if self._current is not self._given:
            self._current.shutdown(cancel_futures=True)


def _alike(pool):
    """A pool of processes like one that broke, which does not tell its options otherwise."""
    return ProcessPoolExecutor(
        pool._max_workers,
        mp_context=pool._mp_context,
        initializer=pool._initializer,
        initargs=pool._initargs,
        max_tasks_per_child=pool._max_tasks_per_child,
    )
