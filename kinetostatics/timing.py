"""How long a function takes, and on what machine and with what versions that was measured."""

import os
import platform
import statistics
import time
from importlib import metadata

LIBRARIES = ("kinetostatics", "numpy", "scipy", "sympy", "numba", "jax", "python-flint", "mpmath")
SHORTEST = 2e-3
"""Shortest stretch of time, s, that is taken to be measured well; a faster function is repeated within it."""


def seconds(run, repeats=5):
    """Median time of one call over some repeats, s; the first call, which may compile, is not counted."""
    run()
    start = time.perf_counter()
    run()
    calls = max(1, int(SHORTEST / max(time.perf_counter() - start, 1e-9)))
    return statistics.median(_stretch(run, calls) for _ in range(repeats))


def _stretch(run, calls):
    start = time.perf_counter()
    for _ in range(calls):
        run()
    return (time.perf_counter() - start) / calls


def circumstances():
    """Machine and versions of the libraries, as two texts."""
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    versions = "; ".join(f"{name} {version}" for name, version in found.items())
    machine = f"{platform.machine()} {platform.system()}, {os.cpu_count()} cores"
    return {"machine": machine, "versions": f"Python {platform.python_version()}; {versions}"}
