"""A method under study, the checks that methods share, and the measurement of computing times.

A method is one way to compute a quantity of a solution; `precision` and `stability` compare its time and error with
those of the library itself.
"""

import os
import platform
import statistics
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from ...engines.numba_backend import forget_angles
from ...errors import MissingLibraryError, NotGivenError
from ...machine.groups.change_points import SIDES


def with_numeric_side(mechanism):
    """The mechanism with the assembly modes "open" and "crossed" given as signs, +1 and -1."""
    if mechanism.passes:
        raise NotGivenError(f"{mechanism.name} passes change points, but this method's formulas keep to one side")
    groups = tuple(
        replace(group, assembly=SIDES[group.assembly]) if group.through else group for group in mechanism.groups
    )
    return replace(mechanism, groups=groups)


@dataclass(frozen=True)
class Method:
    """A method to compute quantities of a solution.

    Attributes
    ----------
    name : str
        Name in charts and tables.
    prepare : function
        ``prepare(solution, quantity, setting)`` does the work needed once per mechanism and returns a function without
        arguments. This function computes the quantity at the solution's crank angles, as a tuple of its components (see
        `quantities.components`). `prepare` raises `NotGivenError` for quantities that the method does not give.
    setting : str
        Name of the parameter that trades time for accuracy, with its unit; empty if there is none.
    settings : tuple
        Values of the setting, from coarse to fine.
    ours : bool
        Whether the library itself computes in this way.
    bound : function, optional
        ``bound(solution, quantity)``: the proven bound on the method's error, (N,); None without proof.
    precision : "double" or "single"
        Precision of the library's own computation.
    device : function, optional
        ``device()``: the computing device, such as "gpu: NVIDIA H100"; by default "cpu".

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> ours = ks.precision.METHODS[0]
    >>> (torque,) = ours.prepare(s, "balancing_torque", None)()
    >>> ours.name, torque.shape
    ('ours, NumPy', (8,))
    """

    name: str
    prepare: Callable[[Any, str, Any], Callable[[], tuple[Any, ...]]]
    setting: str = ""
    settings: tuple[Any, ...] = (None,)
    ours: bool = False
    bound: Callable[[Any, str], Any] | None = None
    precision: str = "double"
    device: Callable[[], str] | None = None


def require_frictionless(solution):
    """Raise `NotGivenError` for a solution with friction."""
    if solution.friction:
        raise NotGivenError(f"its equations have no friction, but the scene has some in {', '.join(solution.friction)}")


def require_moving(solution):
    """Raise `NotGivenError` for friction with the crank at rest, whose direction is undefined."""
    if solution.friction and not np.all(solution.crank_speed):
        raise NotGivenError("friction of a crank at rest has no direction")


def require_one_design(solution):
    """Raise `NotGivenError` unless the solution is of one design at crank angles (N,)."""
    if solution.shape != np.shape(solution.crank_angle) or len(solution.shape) != 1:
        raise NotGivenError(f"one mechanism at crank angles (N,) is needed, not a batch of shape {solution.shape}")


def run_methods(methods, problem, quantity, measure, progress=None, **unknown):
    """Rows of a table, one for each method and setting, and by row number the functions to be timed.

    ``measure(method, run)`` returns further columns, one of them the error. If a method does not give the quantity, the
    columns come from `unknown` and the error is NaN. ``progress(name)`` is called before each method.
    """
    rows: list[dict] = []
    runs = {}
    for method in methods:
        if progress:
            progress(method.name)
        for setting in method.settings:
            row = {"method": method.name, "ours": method.ours, "setting": method.setting, "value": setting}
            row |= {"error": np.nan, "not given": "", **unknown}
            try:
                run = method.prepare(problem, quantity, setting)
                row |= measure(method, run)
                runs[len(rows)] = run
            except (NotGivenError, MissingLibraryError) as why:
                row["not given"] = str(why)
            rows.append(row)
    return rows, runs


LIBRARIES = ("kinetostatics", "numpy", "scipy", "sympy", "numba", "jax", "python-flint", "mpmath")
MIN_MEASURED_TIME = 2e-3
"""Shortest measured time, s; a faster function is called repeatedly."""
LONG_CALL = 1.0
"""A call that takes longer is timed in one round only, s."""


def seconds(*runs, repeats=5):
    """Median time of one call of each function, s.

    The functions take turns, so a busy machine slows all of them alike. First calls, which may compile, do not count.
    Each call includes the time for the sines of the crank angles.

    Parameters
    ----------
    *runs : function
        Functions without arguments.
    repeats : int
        Number of rounds; the median counts. A call longer than a second is timed in one round only.

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
    once = [_mean_time(run, 1) for run in runs]
    calls = [max(1, int(MIN_MEASURED_TIME / time)) for time in once]
    timed = list(zip(runs, calls, once, strict=True))
    rounds = [
        [time if time > LONG_CALL else _mean_time(run, count) for run, count, time in timed] for _ in range(repeats)
    ]
    return [statistics.median(column) for column in zip(*rounds, strict=True)]


def _mean_time(run, calls):
    for _ in range(calls // 2):  # warm the caches after another function
        run()
    start = time.perf_counter()
    for _ in range(calls):
        forget_angles()
        run()
    return max(time.perf_counter() - start, 1e-9) / calls


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
        with suppress(metadata.PackageNotFoundError):
            found[name] = metadata.version(name)
    versions = "; ".join(f"{name} {version}" for name, version in found.items())
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        processor = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        processor = platform.processor() or platform.machine()
    machine = f"{processor}, {platform.system()}, {os.cpu_count()} cores"
    return {"machine": machine, "versions": f"Python {platform.python_version()}; {versions}"}
