"""Chunks of a sweep handed to an executor, and run again when a worker dies."""

from collections import Counter, deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait

import numpy as np
import pandas as pd

from .chunks import rows, run_chunk
from .errors import KinetostaticsError

ATTEMPTS = 3
"""How often a chunk is run whose worker dies, before the designs that do it are looked for."""
WAITING = 256
"""Chunks handed to an executor at a time; two for each worker if it tells how many it has."""


class Workers:
    """An executor, or this process; a pool of processes is replaced when it breaks because one of them died."""

    def __init__(self, executor=None):
        self._given = self._current = executor or _Here()
        count = getattr(executor, "_max_workers", None)
        self.capacity = 1 if executor is None else 2 * count if count else WAITING

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._let_go()

    def submit(self, *call) -> Future:
        """Future of a call, as from any executor."""
        try:
            return self._current.submit(*call)
        except BrokenExecutor:
            if not isinstance(self._current, ProcessPoolExecutor):
                raise
            self._let_go()
            self._current = _alike(self._current)
            return self._current.submit(*call)

    def survived(self, *call):
        """Result of a call in a tuple; an empty one if the worker died."""
        try:
            return (self.submit(*call).result(),)
        except Exception as error:
            _deaths(error)
            return ()

    def _let_go(self):
        if self._current is not self._given:
            self._current.shutdown(cancel_futures=True)


class _Here(Executor):
    """The process and thread that submits, at once."""

    def submit(self, function, /, *arguments, **options):
        future: Future = Future()
        future.set_result(function(*arguments, **options))
        return future


def _alike(pool):
    """A pool of processes like one that broke, whose options nothing public tells."""
    return ProcessPoolExecutor(
        pool._max_workers,
        mp_context=pool._mp_context,
        initializer=pool._initializer,
        initargs=pool._initargs,
        max_tasks_per_child=pool._max_tasks_per_child,
    )


def computed(job, rows_of, numbers, workers):
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
                    deaths[number] += _deaths(error)
                    (waiting.appendleft if deaths[number] < ATTEMPTS else suspects.append)(number)
                else:
                    yield number, found
        if suspects and not workers.survived(run_chunk, job, rows_of(suspects[0])[:0]):
            raise KinetostaticsError("sweep: the workers of the executor die before they compute anything")
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


def _narrowed(job, frame, workers):
    """Outputs of designs that may kill their worker, run by themselves: half by half, down to those that do it."""
    for found in workers.survived(run_chunk, job, frame):
        return found
    if len(frame) == 1:
        return rows(job, frame, np.full((len(job.outputs), 1), np.nan), np.array(["the worker died with this design"]))
    halves = np.array_split(np.arange(len(frame)), 2)
    return pd.concat([_narrowed(job, frame.iloc[half], workers) for half in halves])
