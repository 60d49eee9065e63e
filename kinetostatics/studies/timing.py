"""How long a function takes, and on what machine and with what versions that was measured."""

import os
import platform
import statistics
import time
from importlib import metadata
from pathlib import Path

from ..engines.numba_backend import forget_angles

LIBRARIES = ("kinetostatics", "numpy", "scipy", "sympy", "numba", "jax", "python-flint", "mpmath")
SHORTEST = 2e-3
"""Shortest stretch of time, s, that is taken to be measured well; a faster function is repeated within it."""


def seconds(*runs, repeats=5):
    """Median time of one call of each function, s.

    All take turns, so that a machine that is slow for a while is slow for all of them; first calls, which may compile,
    are not counted. Sines of the crank angles are computed in each call.

    Parameters
    ----------
    *runs : function
        Without arguments.
    repeats : int
        Rounds, of which the median counts.

    Returns
    -------
    list of float

    Examples
    --------
    >>> import kinetostatics as ks
    >>> scene = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
    >>> few, many = ks.precision.seconds(lambda: scene.solve(8).reaction("O"), lambda: scene.solve(9999).reaction("O"))
    >>> min(few, many) > 0.0  # the first is the shorter, but for a machine that is busy with other things
    True
    """
    for run in runs:
        run()
    calls = [max(1, int(SHORTEST / _stretch(run, 1))) for run in runs]
    rounds = [[_stretch(*pair) for pair in zip(runs, calls, strict=True)] for _ in range(repeats)]
    return [statistics.median(column) for column in zip(*rounds, strict=True)]


def _stretch(run, calls):
    for _ in range(calls // 2):  # after another function caches are cold
        run()
    start = time.perf_counter()
    for _ in range(calls):
        forget_angles()
        run()
    return max(time.perf_counter() - start, 1e-9) / calls


def _processor():
    """Name of the processor as the system tells it, else its architecture."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def circumstances():
    """Machine and versions of the libraries, as two texts.

    Returns
    -------
    dict of str to str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> list(ks.precision.circumstances())
    ['machine', 'versions']
    """
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    versions = "; ".join(f"{name} {version}" for name, version in found.items())
    machine = f"{_processor()}, {platform.system()}, {os.cpu_count()} cores"
    return {"machine": machine, "versions": f"Python {platform.python_version()}; {versions}"}
