"""Work against precision: time and error of every method against a certified reference."""

import math
from dataclasses import fields
from pathlib import Path

import numpy as np

from ..mechanics.quantities import components
from ..mechanics.quantities import quantity as declared
from ..numbers import checks
from .methods import engines, papers
from .methods.global_system import newton
from .methods.high_precision.certified import Enclosure, certified, enclosure, relative_errors
from .methods.kane import equations
from .methods.method import Method, circumstances, run_methods, seconds
from .methods.running import BENCHMARKS, MOTION_METHODS, RUNNING_METHODS, study_motion, study_running

__all__ = [
    "BENCHMARKS",
    "METHODS",
    "MOTION_METHODS",
    "RUNNING_METHODS",
    "Enclosure",
    "Method",
    "certified",
    "circumstances",
    "components",
    "enclosure",
    "front",
    "relative_errors",
    "seconds",
    "study",
    "study_motion",
    "study_running",
]

METHODS = (
    *engines.METHODS,
    *papers.METHODS,
    *equations.METHODS,
    *newton.NEWTON_METHODS,
    *engines.APPROXIMATE_METHODS,
    *newton.INTEGRATION_METHODS,
    papers.AS_PRINTED,
)
"""All methods for a solution, in the order of charts."""
QUANTITY = "balancing_torque"


def study(solution, quantity=QUANTITY, *, methods=None, repeats=5, progress=None):
    """Time and error of every method for one quantity.

    The reference is certified. With friction no link or slider may reverse at a crank angle, because friction
    jumps there.

    Parameters
    ----------
    solution : Solution
        A single design at its crank angles, for example 360 in a turn.
    quantity : str
        "balancing_torque", a joint (its reaction), "slider_acceleration" ...
    methods : sequence of Method, optional
        `METHODS` by default.
    repeats : int
        Number of timings; the median counts, without the work done once for a mechanism.
    progress : function, optional
        Called with the name of each method before it runs.

    Returns
    -------
    pandas.DataFrame
        A row for each method and setting: time [ns/angle], largest error over the crank angles relative to the
        quantity's largest value, its proven bound (NaN if none), and the device. If a method does not give the
        quantity, the three numbers are NaN, with the reason.

    Raises
    ------
    MissingLibraryError
        The `precision` extra is not installed.
    NotGivenError
        A part of the scene cannot be certified: a sampled cam, or a process force by a function.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> table = ks.precision.study(s, methods=ks.precision.METHODS[:1], repeats=1)
    >>> table.loc[0, "method"], bool(table.loc[0, "error"] < 1e-14)
    ('ours, NumPy', True)
    """
    import pandas as pd

    checks.require("precision", checks.solution("solution", solution), checks.quantity(quantity))
    reference = certified(solution, quantity)

    def measure(method, run):
        error = float(np.max(relative_errors(run(), reference)))
        bound = np.max(method.bound(solution, quantity)) / reference.largest if method.bound else np.nan
        return {"error": error, "device": method.device() if method.device else "cpu", "bound": bound}

    methods = METHODS if methods is None else methods
    rows, runs = run_methods(methods, solution, quantity, measure, progress, device="", bound=np.nan)
    known = declared(solution, quantity)
    table = pd.DataFrame(rows).assign(
        quantity=quantity, label=known.label, unit=known.unit, angles=solution.crank_angle.size
    )
    times = pd.Series(seconds(*runs.values(), repeats=repeats), index=list(runs), dtype=float)
    table.insert(4, "time [ns/angle]", 1e9 * times / solution.crank_angle.size)
    return table


def front(table):
    """Rows without another row of smaller time and error, in order of time.

    Parameters
    ----------
    table : pandas.DataFrame
        Result of `study`.

    Returns
    -------
    pandas.DataFrame

    Examples
    --------
    >>> import pandas as pd
    >>> import kinetostatics as ks
    >>> rows = {"method": ["slow", "rough", "both"], "time [ns/angle]": [90.0, 5.0, 95.0], "error": [1e-15, 1e-3, 1e-2]}
    >>> ks.precision.front(pd.DataFrame(rows))["method"].tolist()
    ['rough', 'slow']
    """
    given = table.dropna(subset=["error"]).sort_values(["time [ns/angle]", "error"])
    return given[given["error"] < given["error"].cummin().shift(fill_value=np.inf)]


def case_study(case, folder, *, variants=None, quantities=(QUANTITY,), angles=360, progress=None, page=None):
    """Study a case and write one CSV to a folder, and charts if `page` is given; returns the paths.

    `variants` are by default one of each kind of mechanism; `angles` counts crank angles over the turn. ``page(table,
    path)`` draws the chart, as `views.charts.precision_page`, and returns the paths of its files. `ParameterError`,
    before any calculation, if the files cannot be written there, or would replace files of the case.
    """
    import pandas as pd

    from ..numbers.files import write_atomically, write_problem

    checks.require("precision", checks.case("case", case))
    path = Path(folder) / f"{case.path.stem}_precision.csv"
    written = [path, *(path.with_suffix(ending) for ending in (".png", ".svg"))]
    checks.require("precision", *dict.fromkeys(write_problem(item, inputs=case.files) for item in written))
    names = list(variants or variant_of_each_kind(case))
    for name in names:
        for quantity in quantities:
            components(case.solve(name, 8), quantity)
    tables = []
    for name in names:
        solution = case.solve(name, angles)
        if solution.friction:  # away from the dead centres, where it jumps
            solution = solution.at(solution.crank_angle + math.pi / angles)
        for quantity in quantities:
            found = study(solution, quantity, progress=progress)
            tables.append(found.assign(case=case.path.stem, variant=name))
    table = pd.concat(tables, ignore_index=True).assign(**circumstances())
    with write_atomically(path) as temporary:
        table.to_csv(temporary, index=False)
    return [path, *(page(table, path.with_suffix("")) if page else ())]


def variant_of_each_kind(case):
    """First variant of each kind of mechanism and cam in a case."""
    found: dict[tuple, str] = {}
    for name, variant in case.variants.items():
        groups = variant.mechanism.groups
        kinds = [(type(group), *(type(getattr(group, field.name)) for field in fields(group))) for group in groups]
        found.setdefault((variant.mechanism.name, *kinds), name)
    return list(found.values())


def __dir__():
    return __all__
