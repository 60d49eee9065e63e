"""Work against precision of the drive: periodic running, and motions over time that others published."""

import time

from ..errors import MissingLibraryError, NotGivenError
from ..numbers import checks
from .methods import motion, running
from .methods.high_precision.exact_running import exact_speed
from .timing import seconds

LONG = 0.2
"""Time, s, of what need not be timed again."""
ANGLES = 24
"""Crank angles at which speeds are compared."""


def study_running(scene, motor, flywheel=0.0, *, methods=None, repeats=3, progress=None):
    """Time and error of every method for periodic running under a motor.

    Parameters
    ----------
    scene, motor, flywheel
        As for `drive.steady`; loads must not depend on the speed, and the motor turn the crank counter-clockwise.
    methods : sequence of Method, optional
        `RUNNING_METHODS` unless told.
    repeats : int
        Of each timing; the median counts.
    progress : function, optional
        Called with the name of each method before it runs.

    Returns
    -------
    pandas.DataFrame
        A row for each method and setting: time [ms] of all, largest error of the crank speed at 24 crank angles
        relative to running at 30 digits, and for what a method cannot give the reason, with NaN for both.

    Raises
    ------
    MissingLibraryError
        The `precision` extra is not installed.
    NotGivenError
        Loads depend on the speed, or cannot be computed at many digits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-10.0))
    >>> motor = ks.drive.Motor.linear(20.0, 105.0)
    >>> table = ks.precision.study_running(pump, motor, 0.05, methods=ks.precision.RUNNING_METHODS[:1], repeats=1)
    >>> bool(table.loc[0, "error"] < 1e-12)
    True
    """
    import numpy as np

    driven = running.Problem(scene, motor, flywheel, np.zeros(1)).driven
    angles = np.arange(ANGLES) * driven.period / ANGLES
    problem, exact = running.Problem(scene, motor, flywheel, angles), exact_speed(driven, angles)

    def error(found):
        return float(np.abs(found / exact - 1.0).max())

    return _studied(problem, methods or running.METHODS, error, "crank speed", "1", repeats, progress)


def study_motion(name, *, methods=None, repeats=3, progress=None):
    """Time and error of every method for a published motion over time.

    Parameters
    ----------
    name : str
        Of `BENCHMARKS`: "slider-crank of SUNDIALS", "N-four-bar of IFToMM, N = 2".
    methods : sequence of Method, optional
        `MOTION_METHODS` unless told.
    repeats, progress
        As for `study_running`.

    Returns
    -------
    pandas.DataFrame
        As of `study_running`, with the error of the crank angle at the end, rad.

    Raises
    ------
    ParameterError
        There is no such benchmark.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import kinetostatics as ks
    >>> (steps,) = (method for method in ks.precision.MOTION_METHODS if method.name.endswith("RK4"))
    >>> coarse = [replace(steps, settings=(25,))]
    >>> table = ks.precision.study_motion("slider-crank of SUNDIALS", methods=coarse, repeats=1)
    >>> bool(table.loc[0, "error"] < 1e-3)  # rad
    True
    """
    problem_with_name = checks.choice("benchmark", name, tuple(motion.BENCHMARKS))
    checks.require("study_motion", problem_with_name)
    problem = motion.BENCHMARKS[name]()

    def error(found):
        return abs(float(found) - problem.exact)

    return _studied(problem, methods or motion.METHODS, error, "crank angle at the end", "rad", repeats, progress)


def _studied(problem, methods, error, label, unit, repeats, progress):
    import numpy as np
    import pandas as pd

    rows: list[dict] = []
    runs, times = {}, {}
    for method in methods:
        if progress:
            progress(method.name)
        for setting in method.settings:
            row = {"method": method.name, "ours": method.ours, "setting": method.setting, "value": setting}
            try:
                run = method.prepare(problem, label, setting)
                run()
                begun = time.perf_counter()
                row |= {"error": error(run()), "not given": ""}
                times[len(rows)] = time.perf_counter() - begun
                if times[len(rows)] < LONG:
                    runs[len(rows)] = run
            except (NotGivenError, MissingLibraryError) as why:
                row |= {"error": np.nan, "not given": str(why)}
            rows.append(row)
    table = pd.DataFrame(rows).assign(label=label, unit=unit)
    times |= dict(zip(runs, seconds(*runs.values(), repeats=repeats), strict=True))
    table.insert(4, "time [ms]", 1e3 * pd.Series(times, dtype=float))
    return table
