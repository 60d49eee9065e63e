"""Whether numba (extra `fast`) can be had, and generated source as its modules.

Compiled loops: recorded arithmetic over designs and crank angles, made machine code by numba (extra `fast`).

Sines and cosines of the crank angle come first, in a loop of their own, and are shared by all designs. Many values are
shared out to threads.

What was computed of the last crank angles: loops over designs ask for the sines of the same ones each time.
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
    """Why numba cannot be used and how to mend it, or None."""
    numba = sys.modules.get("numba")
    try:
        numba = numba or importlib.import_module("numba")
    except ImportError as error:  # not there, or installed beside a NumPy that it does not know, for instance
        why = "is not installed" if error.name == "numba" else f"cannot be imported: {error}"
        return f'{why}: pip install "kinetostatics[fast]"'
    return "compiles nothing while NUMBA_DISABLE_JIT is set: unset it" if numba.config.DISABLE_JIT else None


def numba_available():
    """Whether numba is installed, can be imported, and compiles."""
    return _problem() is None


def require_numba():
    """Raise `MissingLibraryError` unless numba is available."""
    if problem := _problem():
        raise MissingLibraryError(f'the compiled engine needs numba, which {problem}; engine="numpy" works without')


@cache
def load_compiled(text):
    """Module of a source, its machine code kept on disk."""
    from .code_cache import load_module

    require_numba()
    return load_module(text, keep=True)


MAX_KEPT_ANGLES = 10_000
"""Crank angles up to which they are kept."""
_last = threading.local()


def keep_for_same_angles(compute):
    """Function of an array of crank angles that is not repeated, in each thread, for those of the last call."""

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
    """Compute anew at the next call in this thread: what is timed shall not gain by having been called before."""
    _last.__dict__.clear()


VALUES_A_THREAD = 100_000
"""Values over designs and angles that are worth a thread of their own."""
VECTOR_NUMBERS = 8
"""Numbers in the largest vector of a processor."""
NO_ROWS = np.empty((0, 1, 0))
"""Tables of a loop that needs none."""


@keep_for_same_angles
def compiled_sines(angle):
    """Sines and cosines of crank angles (1 or designs, N), which designs may share."""
    sine, cosine = np.empty(angle.shape), np.empty(angle.shape)
    load_compiled(TURN).shared(angle.ravel(), sine.ravel(), cosine.ravel())
    return sine, cosine


def parameter_table(numbers, shape):
    """Parameters (designs, P) from numbers, each a float or an array (..., 1), for designs of a batch shape."""
    if not shape:
        return np.array([numbers], dtype=float)
    table = np.empty((math.prod(shape), len(numbers)))
    table[...] = [0.0 if np.ndim(number) else number for number in numbers]
    for place, number in enumerate(numbers):
        if np.ndim(number):
            table[:, place] = np.broadcast_to(number, (*shape, 1)).ravel()
    return table


def row_table(rows, shape):
    """Tables (T, 1 or designs, N) from rows, each a number or an array (..., N), of results of a shape."""
    if not rows:
        return NO_ROWS
    one_row = all(math.prod(np.shape(row)[:-1]) == 1 for row in rows)
    if one_row:
        return np.array([np.broadcast_to(np.ravel(row), (1, shape[-1])) for row in rows], dtype=float)
    full = math.prod(shape[:-1]), shape[-1]
    return np.array([np.broadcast_to(row, shape).reshape(full) for row in rows], dtype=float)


def aligned_memory(*shape):
    """Memory for numbers, which begins where vectors of every processor are loaded at once."""
    size = math.prod(shape)
    held = np.empty(size + VECTOR_NUMBERS)
    first = -held.ctypes.data // held.itemsize % VECTOR_NUMBERS
    return held[first : first + size].reshape(shape)


def run_loop(loop, angle, sine, cosine, parameters, tables, results):
    """Fill results (designs, outputs, N), in threads if there is much to do.

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

    def piece(start, stop):
        given = [_part(array, start, stop, designs) for array in (angle, sine, cosine, tables)]
        if designs > 1:
            loop(*given[:3], parameters[start:stop], given[3], results[start:stop].ravel())
        else:
            found = np.empty((1, results.shape[1], stop - start), results.dtype)
            loop(*given[:3], parameters, given[3], found.ravel())
            results[..., start:stop] = found

    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(pieces) as threads:
        list(threads.map(piece, edges[:-1], edges[1:]))


def _part(array, start, stop, designs):
    """Columns of an array (..., designs, N) for some designs, or for some angles of a single one."""
    if designs == 1:
        return np.ascontiguousarray(array[..., start:stop])
    return array if array.shape[-2] == 1 else np.ascontiguousarray(array[..., start:stop, :])
