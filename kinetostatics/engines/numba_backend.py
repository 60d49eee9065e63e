"""Compiled loops over designs and crank angles, by numba (extra `fast`).

Sines and cosines of the crank angle are computed first, in a separate loop, and shared by all designs; those of the
last crank angles are cached. Large tasks run in threads.
"""

import importlib
import math
import os
import sys
import threading
from functools import cache, wraps

import numpy as np

from ..errors import MissingLibraryError
from .codegen import TURN


def core_count():
    """Number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _problem():
    """Reason why numba cannot be used, with its remedy, or None."""
    numba = sys.modules.get("numba")
    try:
        numba = numba or importlib.import_module("numba")
    except ImportError as error:  # missing, or installed with an incompatible NumPy, for example
        why = "is not installed" if error.name == "numba" else f"cannot be imported: {error}"
        return f'{why}: pip install "kinetostatics[fast]"'
    return "compiles nothing while NUMBA_DISABLE_JIT is set: unset it" if numba.config.DISABLE_JIT else None


def numba_available():
    """Whether numba is installed, can be imported, and compiles."""
    return _problem() is None


def require_numba():
    """Raise `MissingLibraryError` unless numba is available."""
    if problem := _problem():
        raise MissingLibraryError(f'the compiled engine needs numba, which {problem}; engine="numpy" works without it')


@cache
def load_compiled(text):
    """Module of a source, with machine code cached on disk."""
    from .code_cache import load_module

    require_numba()
    return load_module(text, keep=True)


MAX_KEPT_ANGLES = 10_000
"""Largest number of crank angles with cached values."""
_last = threading.local()


def keep_for_same_angles(compute):
    """Decorate a function of an array of crank angles: each thread caches the result of its last call."""

    @wraps(compute)
    def computed(angle):
        if angle.size > MAX_KEPT_ANGLES:
            return compute(angle)
        key = angle.shape, angle.tobytes()
        held = _last.__dict__
        known = held.get(compute)
        if known is None or known[0] != key:
            known = held[compute] = key, compute(angle)
        return known[1]

    return computed


def forget_angles():
    """Drop the cached results of this thread, so that the next timed call computes them."""
    _last.__dict__.clear()


VALUES_A_THREAD = 100_000
"""Values (designs * angles) that justify a separate thread."""
VECTOR_NUMBERS = 8
"""Doubles in the largest vector register."""
NO_ROWS = np.empty((0, 1, 0))
"""Tables of a loop without tables."""


@keep_for_same_angles
def compiled_sines(angle):
    """Sines and cosines, each (1 or designs, N), of crank angles, rad."""
    sine, cosine = np.empty(angle.shape), np.empty(angle.shape)
    load_compiled(TURN).shared(angle.ravel(), sine.ravel(), cosine.ravel())
    return sine, cosine


def angle_rows(angle, shape):
    """Crank angles (1 or designs, N) from an array (..., N), for results of a shape."""
    own = angle.size > shape[-1]
    return np.ascontiguousarray((np.broadcast_to(angle, shape) if own else angle).reshape(-1, shape[-1]))


def parameter_table(numbers, shape):
    """Parameters (designs, P) from numbers, each a float or an array (..., 1), for a batch shape."""
    if not shape:
        return np.array([numbers], dtype=float)
    table = np.empty((math.prod(shape), len(numbers)))
    arrays = {place: number for place, number in enumerate(numbers) if type(number) is not float and np.ndim(number)}
    table[...] = [0.0 if place in arrays else number for place, number in enumerate(numbers)]
    by_design = table.reshape(*shape, len(numbers))
    for place, number in arrays.items():
        by_design[..., place] = number[..., 0]
    return table


def row_table(rows, shape):
    """Tables (T, 1 or designs, N) from rows, each a number or an array (..., N), for results of a shape."""
    if not rows:
        return NO_ROWS
    one_row = all(math.prod(np.shape(row)[:-1]) == 1 for row in rows)
    if one_row:
        return np.array([np.broadcast_to(np.ravel(row), (1, shape[-1])) for row in rows], dtype=float)
    full = math.prod(shape[:-1]), shape[-1]
    return np.array([np.broadcast_to(row, shape).reshape(full) for row in rows], dtype=float)


def aligned_memory(*shape):
    """Uninitialised array of doubles, aligned for the largest vector register."""
    size = math.prod(shape)
    held = np.empty(size + VECTOR_NUMBERS)
    first = -held.ctypes.data // held.itemsize % VECTOR_NUMBERS
    return held[first : first + size].reshape(shape)


def run_loop(loop, angle, sine, cosine, parameters, tables, results):
    """Fill results (designs, outputs, N); large tasks run in threads.

    Angles with their sines and cosines are (1 or designs, N), tables (T, 1 or designs, N), parameters (designs, P).
    """
    designs, _, angles = results.shape
    pieces = designs * angles // VALUES_A_THREAD
    if pieces > 1:
        pieces = min(pieces, core_count(), designs if designs > 1 else angles)
    if pieces <= 1:
        loop(angle, sine, cosine, parameters, tables, results.ravel())
        return
    edges = np.linspace(0, designs if designs > 1 else angles, pieces + 1, dtype=int)

    def part(array, start, stop):
        """Part of an array (..., designs, N): some designs, or some angles of a single one."""
        if designs == 1:
            return np.ascontiguousarray(array[..., start:stop])
        return array if array.shape[-2] == 1 else np.ascontiguousarray(array[..., start:stop, :])

    def piece(start, stop):
        *turn, rows = (part(array, start, stop) for array in (angle, sine, cosine, tables))
        if designs > 1:
            loop(*turn, parameters[start:stop], rows, results[start:stop].ravel())
        else:
            found = np.empty((1, results.shape[1], stop - start), results.dtype)
            loop(*turn, parameters, rows, found.ravel())
            results[..., start:stop] = found

    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(pieces) as threads:
        list(threads.map(piece, edges[:-1], edges[1:]))
