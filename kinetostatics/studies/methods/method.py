"""What a method under study is: one way to a quantity, to be measured against the library's own.

How long a function takes, and on what machine and with what versions that was measured.
"""

import os
import platform
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from ...engines.numba_backend import forget_angles
from ...errors import NotGivenError
from ...machine.groups.change_points import SIDES

__all__ = ["Method", "NotGivenError", "on_a_side", "require_frictionless", "require_moving", "require_one_design"]


def with_numeric_side(mechanism):
    """The mechanism with sides in place of the words "open" and "crossed", which formulas of one side do not know."""
    if mechanism.passes:
        raise NotGivenError(f"{mechanism.name} passes change points, but the formulas keep to one side of them")
    groups = tuple(
        replace(group, assembly=SIDES[group.assembly]) if group.through else group for group in mechanism.groups
    )
    return replace(mechanism, groups=groups)


@dataclass(frozen=True)
class Method:
    """One way to the quantities of a solution.

    Attributes
    ----------
    name : str
        What charts and tables call it.
    prepare : function
        ``prepare(solution, quantity, setting)`` does whatever is done once for a mechanism and returns a function
        without arguments that computes the quantity at the solution's crank angles, as a tuple of its components (see
        `quantities.components`). It raises `NotGivenError` for what the method cannot give.
    setting : str
        What can be set, with its unit; empty if nothing.
    settings : tuple
        Values of the setting, from coarse to fine.
    ours : bool
        Whether it is the library's own path.
    bound : function, optional
        ``bound(solution, quantity)``: what the method itself proves its error to be at most, (N,). Without, it does not
        know how wrong it is.
    precision : "double" or "single"
        Of the library's own path.
    device : function, optional
        ``device()``: what computes, as "gpu: NVIDIA H100"; without, the processor, "cpu".

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
    """Raise `NotGivenError` for friction, whose forces depend on the reactions that they change."""
    if solution.friction:
        raise NotGivenError(f"its equations know no friction, but there is some in {', '.join(solution.friction)}")


def require_moving(solution):
    """Raise `NotGivenError` for friction where the crank rests, which has no sense then."""
    if solution.friction and not np.all(solution.crank_speed):
        raise NotGivenError("friction of a crank at rest has no sense")


def require_one_design(solution):
    """Raise `NotGivenError` for a batch of designs, and for crank angles that are no row."""
    if solution.shape != np.shape(solution.crank_angle) or len(solution.shape) != 1:
        raise NotGivenError(f"one mechanism at crank angles (N,) is needed, not a batch of shape {solution.shape}")


LIBRARIES = ("kinetostatics", "numpy", "scipy", "sympy", "numba", "jax", "python-flint", "mpmath")
MIN_MEASURED_TIME = 2e-3
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
    calls = [max(1, int(MIN_MEASURED_TIME / _mean_time(run, 1))) for run in runs]
    rounds = [[_mean_time(*pair) for pair in zip(runs, calls, strict=True)] for _ in range(repeats)]
    return [statistics.median(column) for column in zip(*rounds, strict=True)]


def _mean_time(run, calls):
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
