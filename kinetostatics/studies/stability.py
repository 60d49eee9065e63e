"""Stability: what every method does near the places where it should hurt, against a certified reference.

A place is a family of scenes with one number that leads toward it: the distance from a dead centre, a mass ratio, the
size of the mechanism. The error of a method counts as exact while it is below the rounding unit times the condition of
the problem, which the library reports itself, at crank angles counted from the last full turn.
"""

import math
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import HintWarning, MissingLibraryError, NotGivenError
from ..mechanics.quantities import components
from ..mechanics.quantities import quantity as declared
from ..numbers import checks
from ..numbers.arithmetic import UNIT
from .methods import METHODS
from .methods.engines import proven
from .methods.high_precision.certified import differences, enclosure, relative_errors
from .places import PLACES, Place
from .timing import circumstances

__all__ = ["PLACES", "Place", "study", "summary"]

ORDINARY = 1e-12
"""Error up to which a result is called exact without mention of the condition."""
METHOD_SETTINGS = {
    "ours, NumPy": None,
    "ours, compiled": None,
    "ours, torque by powers": None,
    "float32 crank angles": None,
    "papers' formulas": None,
    "SymPy Kane, lambdified": None,
    "Newton iteration, global system": 6,
    "differences, 2nd order": 1e-4,
    "differences, 4th order": 1e-3,
    "harmonic series": 6,
    "two-mass coupler": None,
}
"""Methods that take any crank angles, each at its best setting."""


def study(places=None, methods=None, progress=None):
    """Error and behaviour of every method at every place.

    Parameters
    ----------
    places : sequence of Place, optional
        `PLACES` unless told.
    methods : sequence of Method, optional
        `ks.precision.METHODS` unless told, as many as take any crank angles.
    progress : function, optional
        Called with the name of each place before it is looked at.

    Returns
    -------
    pandas.DataFrame
        A row for each place, number and method: largest error over the crank angles, relative to the quantity's
        largest value; the largest condition; what one rounding of the crank angle makes of it; the largest bound that
        `Solution.error_bound` proves for the library's own values, infinite where it proves none; how many angles lose
        digits, flip to the other assembly, are NaN; what was raised; why it is not given.

    Raises
    ------
    MissingLibraryError
        The `precision` extra is not installed.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import kinetostatics as ks
    >>> place = replace(ks.stability.PLACES[0], numbers=(1e-6, 1e-3))
    >>> table = ks.stability.study([place], ks.precision.METHODS[:1])
    >>> table[["number", "lost", "flipped", "nan"]].values.tolist()
    [[1e-06, 0.0, 0.0, 0.0], [0.001, 0.0, 0.0, 0.0]]
    """
    import pandas as pd

    chosen = [method for method in (METHODS if methods is None else methods) if method.name in METHOD_SETTINGS]
    rows = []
    for place in PLACES if places is None else places:
        if progress:
            progress(place.name)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HintWarning)  # places are odd on purpose
            for number in place.numbers:
                rows += _at(place, number, chosen)
    return pd.DataFrame(rows)


def _at(place, number, methods):
    with np.errstate(all="ignore"):
        solution = place.scene(number)
        reference = enclosure(solution, place.quantity, digits=20)
        bound = UNIT * _within_a_turn(solution).condition_of(place.quantity)
        other = _other_assembly(solution, place.quantity)
        largest = float(np.max(proven(solution, place.quantity))) / reference.largest
        rounding = _of_one_rounding(solution, place.quantity, reference)
    known = declared(solution, place.quantity)
    common = {"place": place.name, "axis": place.axis, "number": number, "quantity": place.quantity}
    common |= {"label": known.label, "unit": known.unit}
    return [
        {
            **common,
            "condition": np.max(bound) / UNIT,
            "angle rounding": rounding,
            "bound": largest,
            **_behaviour(method, solution, place.quantity, reference, bound, other),
        }
        for method in methods
    ]


def _within_a_turn(solution):
    """The same at crank angles below a turn: the turns before are exact, nothing of them need be lost."""
    return solution.at(np.fmod(solution.crank_angle, 2 * math.pi))


def _of_one_rounding(solution, quantity, reference):
    """Largest change of the quantity by half a unit in the last place of the crank angle, over its largest value.

    Infinite where the next number is beyond a limit position.
    """
    for way in (-math.inf, math.inf):
        try:
            moved = enclosure(solution.at(np.nextafter(solution.crank_angle, way)), quantity, digits=20)
        except NotGivenError:
            continue
        return 0.5 * float(differences(moved, reference).max())
    return math.inf


def _other_assembly(solution, quantity):
    """The quantity in the other assembly: what a method that flips would find."""
    *inner, last = solution.mechanism.groups
    flipped = replace(solution.mechanism, groups=(*inner, replace(last, assembly=-last.assembly)))
    return np.array(components(replace(solution, mechanism=flipped), quantity))


def _behaviour(method, solution, quantity, reference, bound, other):
    nothing = {"method": method.name, "ours": method.ours, "error": np.nan, "angles": solution.crank_angle.size}
    counts = {"lost": 0, "flipped": 0, "nan": 0, "raised": "", "not given": ""}
    try:
        with np.errstate(all="ignore"):
            found = np.array(method.prepare(solution, quantity, METHOD_SETTINGS[method.name])())
    except (NotGivenError, MissingLibraryError) as why:
        return nothing | counts | {"not given": str(why)}
    except Exception as error:
        return nothing | counts | {"raised": f"{type(error).__name__}: {error}"}
    errors = relative_errors(found, reference)
    missing = ~np.isfinite(found).all(axis=0)
    wrong = ~missing & ~(errors <= bound)
    nearer = np.linalg.norm(found - other, axis=0) < 1e-3 * np.linalg.norm(reference.middle - other, axis=0)
    counts |= {"lost": int((wrong & ~nearer).sum()), "flipped": int((wrong & nearer).sum()), "nan": int(missing.sum())}
    worst = float(errors[~missing].max()) if not missing.all() else np.nan
    return nothing | counts | {"error": worst}


def summary(table):
    """What each method does at each place: worst error, where, and how many angles fail of all, a pandas DataFrame.

    The worst error is that of the numbers at which the condition leaves a digit; how many do not is told too.

    Parameters
    ----------
    table : pandas.DataFrame
        As of `study`.

    Returns
    -------
    pandas.DataFrame

    Examples
    --------
    >>> from dataclasses import replace
    >>> import kinetostatics as ks
    >>> place = replace(ks.stability.PLACES[0], numbers=(1e-6, 1e-3))
    >>> table = ks.stability.study([place], ks.precision.METHODS[:1])
    >>> ks.stability.summary(table)["does"].tolist()
    ['exact']
    """
    import pandas as pd

    rows = []
    for (place, method), part in table.groupby(["place", "method"], sort=False):
        counts = {name: int(part[name].sum()) for name in ("lost", "flipped", "nan")}
        raised, given_up = (int((part[name] != "").sum()) for name in ("raised", "not given"))
        given = given_up < len(part)
        digits = part[(part["condition"] * UNIT < 1.0) & part["error"].notna()]
        worst = digits.loc[digits["error"].idxmax()] if len(digits) else None
        rows.append(
            {
                "place": place,
                "method": method,
                "does": _verdict(counts, raised, given_up, digits["error"].max()) if given else "does not give it",
                "worst error": np.nan if worst is None else worst["error"],
                "at": np.nan if worst is None else worst["number"],
                "condition there": np.nan if worst is None else worst["condition"],
                **counts,
                "raised": raised,
                "given up": given_up if given else 0,
                "of angles": int(part["angles"].sum()),
                "numbers without digits": int((part["condition"] * UNIT >= 1.0).sum()),
            }
        )
    return pd.DataFrame(rows)


def _verdict(counts, raised, given_up, worst):
    said = [
        ("raises", raised),
        ("gives up", given_up),
        ("gives NaN", counts["nan"]),
        ("flips assembly", counts["flipped"]),
        ("loses digits", counts["lost"]),
    ]
    fine = "exact" if worst < ORDINARY else "as near as the condition allows"
    return ", ".join(text for text, count in said if count) or fine


def write(folder, places=None, progress=None, page=None):
    """Run the study into a folder: all rows and the summary as CSV, and what ``page(table, path)`` draws of it.

    Returns the paths of the files; `views.charts.stability_page` draws the chart, as PNG and SVG.
    """
    from ..numbers.files import unwritable_folder, written_whole

    checks.require("stability", unwritable_folder(folder))
    table = study(places, progress=progress)
    folder = Path(folder)
    paths = []
    for name, frame in (("stability", table), ("stability_summary", summary(table))):
        path = folder / f"{name}.csv"
        with written_whole(path) as temporary:
            frame.assign(**circumstances()).to_csv(temporary, index=False)
        paths.append(path)
    return [*paths, *(page(table, folder / "stability") if page else ())]


def __dir__():
    return __all__
