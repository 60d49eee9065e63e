"""Stability: the error of every method near places where it may fail, against a certified reference.

A place is a family of scenes with a number that approaches it: the distance from a dead centre, a mass ratio, the
size of the mechanism. A result counts as exact while its error is below the rounding unit times the condition
of the library, at crank angles counted from the last full turn.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import HintWarning, MissingLibraryError, NotGivenError
from ..machine.builders import cam_crank_slider, crank_slider, four_bar, slotted_lever
from ..machine.cams.cams import Circle, CosineLaw
from ..machine.links import Link
from ..machine.loads import Gravity, Spring
from ..mechanics.quantities import components
from ..mechanics.quantities import quantity as declared
from ..numbers import checks
from ..numbers.arithmetic import UNIT_ROUNDOFF
from ..solution.solution import Solution
from .methods.engines import proven_bound
from .methods.high_precision.certified import enclosure, relative_errors
from .methods.method import circumstances
from .precision import METHODS

CRANK_SPEED = 320 * math.pi / 30
BALANCING_SPRING = Spring.balancing(600.0, CRANK_SPEED, 2.0)
DISTANCES = tuple(10.0**k for k in range(-17, 0))


@dataclass(frozen=True)
class Place:
    """A family of scenes in which methods may fail.

    Attributes
    ----------
    name : str
    axis : str
        Meaning of the number that approaches the place, with its unit.
    numbers : tuple of float
    scene : function
        Solution for one number.
    quantity : str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> place = ks.stability.PLACES[0]
    >>> place.name, place.axis, place.quantity
    ('dead centres, inclined guide', 'crank angle from there [rad]', 'slider_position')
    >>> place.scene(1e-6).shape
    (400,)
    """

    name: str
    axis: str
    numbers: tuple[float, ...]
    scene: Callable[[float], Solution]
    quantity: str


def _solution(mechanism, angle, loads=(Gravity(),)):
    return Solution(mechanism, np.asarray(angle, dtype=float), CRANK_SPEED, 0.0, tuple(loads))


def _saw(size=1.0, crank_length=0.3, coupler_length=2.0, guide_offset=0.0, guide_angle=0.0):
    """Plain crank-slider like the sawframe, scaled in size."""
    return crank_slider(
        crank_length * size,
        coupler_length * size,
        guide_offset=guide_offset * size,
        guide_angle=guide_angle,
        coupler=Link(150.0, 0.5 * coupler_length * size, 20.5 * size**2),
        slider=Link(600.0),
    )


def _chain_unit(crank=0.1, coupler=0.4, rocker=0.3, pivot=(0.35, 0.1)):
    return four_bar(
        crank,
        coupler,
        rocker,
        rocker_pivot=pivot,
        crank=Link(1.0, crank / 2, 1e-3),
        coupler=Link(4.0, coupler / 2, 5e-2),
        rocker=Link(3.0, rocker / 2, 3e-2),
    )


def _cam_saw(cam, coupler_length, share=1.0):
    """Sawframe with a cam, and a share of the coupler's mass."""
    coupler = Link(150.0 * share, 1.0, 20.5 * share)
    return cam_crank_slider(cam, coupler_length, coupler=coupler, slider=Link(600.0))


def _around(angle, distance, count=200):
    return angle + distance * np.linspace(-1.0, 1.0, count)


def _before(angle, distance, count=20):
    return angle - distance * np.linspace(0.5, 1.0, count)


_TURN = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)


def _dead_centre(distance):
    """Guide through O; no length is a power of two, so that points on the guide are rounded."""
    mechanism = _saw(coupler_length=2.2, guide_angle=1.3)
    return _solution(mechanism, np.concatenate([_around(1.3, distance), _around(1.3 + math.pi, distance)]))


def _limit_position(distance):
    """Crank longer than the coupler; the coupler stands across the guide at 40 degrees of crank angle."""
    angle = math.radians(40.0)
    coupler = float(np.nextafter(2.0 * math.sin(angle), 3.0))
    return _solution(_saw(crank_length=2.0, coupler_length=coupler), _before(angle, distance))


def _barely_long_enough(distance):
    coupler = 0.5 * (1.0 + distance)
    mechanism = _saw(crank_length=0.3, coupler_length=coupler, guide_offset=0.2)
    return _solution(mechanism, _around(1.5 * math.pi, 0.5, 21))


def _singular_angle(distance):
    cam = CosineLaw(0.3, 2.0)
    angle = _around(float(cam.singular_angle), distance, 60)
    return _solution(_cam_saw(cam, cam.coupler_length), angle, [Gravity(), BALANCING_SPRING])


def _pressure_angle(distance):
    cam = Circle(0.3, (-0.3 * (1.0 - distance), 0.0))
    return _solution(_cam_saw(cam, 2.0), _around(math.pi / 2, 0.01, 21))


def _toggle(distance):
    """Coupler and rocker in one line: the limit position of this crank."""
    crank, coupler, rocker, pivot = 0.3, 0.4, 0.2, 0.7
    angle = math.acos((crank**2 + pivot**2 - (coupler + rocker) ** 2) / (2 * crank * pivot))
    just_closing = rocker * (1.0 + 8.0 * UNIT_ROUNDOFF)
    return _solution(_chain_unit(crank, coupler, just_closing, (pivot, 0.0)), _before(angle, distance))


def _just_turning(distance):
    """Crank and ground in one line are slightly shorter than coupler and rocker: the crank only just turns."""
    crank, coupler, ground = 0.3, 0.45, 0.7
    mechanism = _chain_unit(crank, coupler, (crank + ground - coupler) * (1.0 + distance), (ground, 0.0))
    return _solution(mechanism, _around(math.pi, 2.0 * math.sqrt(distance), 21))


def _just_sliding(distance):
    """The block of a slotted lever almost reaches the foot of the pivot on the slot."""
    lever, block = Link(3.0, 0.2, 5e-2), Link(1.0)
    mechanism = slotted_lever(0.1, pivot=(0.2, 0.0), offset=0.1 * (1.0 - distance), lever=lever, block=block)
    return _solution(mechanism, _around(0.0, 2.0 * math.sqrt(distance), 22))


def _folding(mechanism, *angles, count=10):
    """Scene by distance, before and after links are in one line at these crank angles."""

    def scene(distance):
        steps = np.concatenate([_before(0.0, distance, count), -_before(0.0, distance, count)])
        return _solution(mechanism, np.concatenate([angle + steps for angle in angles]))

    return scene


def _mass_ratio(ratio):
    mass = math.sqrt(ratio)
    coupler, slider, crank = Link(mass, 1.0, 0.1 * mass), Link(1.0 / mass), Link(mass, 0.1)
    return _solution(crank_slider(0.3, 2.0, coupler=coupler, slider=slider, crank=crank), _TURN)


def _nearly_balanced(share):
    """Spring and slider cancel; the torque of a coupler with a small share of its mass remains."""
    cam = CosineLaw(0.3, 2.0)
    return _solution(_cam_saw(cam, cam.coupler_length, share), _TURN, [BALANCING_SPRING])


_DISTANCE = "crank angle from there [rad]"
_IN_LINE = "crank angle from all links in line [rad]"
_ON_PIVOT = "crank angle from A on O2 [rad]"
_SHORT = "excess of the coupler's length [1]"
_PITCH_CIRCLE = "distance of O from the pitch circle [radii]"
_MASSES = "mass of coupler and crank over slider's [1]"
_FOLDED = {
    "change point": _folding(_chain_unit(0.2, 0.5, 0.2, (0.5, 0.0)), 0.0, count=20),
    "rhombus": _folding(_chain_unit(0.3, 0.3, 0.3, (0.3, 0.0)), 0.0, math.pi),
    "kite": _folding(_chain_unit(0.2, 0.2, 0.5, (0.5, 0.0)), math.pi),
    "kite, A passing O2": _folding(_chain_unit(0.2, 0.5, 0.5, (0.2, 0.0)), 0.0),
    "parallelogram": _folding(_chain_unit(0.2, 0.5, 0.2, (0.5, 0.0)), math.pi),
    "equal links": _folding(_saw(coupler_length=0.3), 0.5 * math.pi, count=20),
}
_SCALED = {
    "size": lambda size: _solution(_saw(size, guide_offset=0.1), _TURN, ()),
    "turns": lambda angle: _solution(_saw(guide_offset=0.1), angle + _TURN),
}
_SIZES, _RATIOS, _ANGLES = (tuple(10.0**k for k in range(*ends)) for ends in ((-9, 10), (-24, 1, 4), (8,)))
PLACES = (
    Place("dead centres, inclined guide", _DISTANCE, DISTANCES, _dead_centre, "slider_position"),
    Place("limit position", _DISTANCE, DISTANCES, _limit_position, "O"),
    Place("coupler barely long enough", _SHORT, DISTANCES, _barely_long_enough, "O"),
    Place("singular angle of the cosine cam", _DISTANCE, DISTANCES, _singular_angle, "cam_force"),
    Place("pressure angle toward 90 deg", _PITCH_CIRCLE, DISTANCES[2:], _pressure_angle, "cam_force"),
    Place("four-bar toggle", _DISTANCE, DISTANCES, _toggle, "O"),
    Place("four-bar change point", _IN_LINE, DISTANCES, _FOLDED["change point"], "O"),
    Place("four-bar that only just turns", "excess of the rocker's length [1]", DISTANCES[2:], _just_turning, "O"),
    Place("slotted lever that only just turns", "deficit of the slot's offset [1]", DISTANCES[2:], _just_sliding, "O"),
    Place("rhombus", _IN_LINE, DISTANCES, _FOLDED["rhombus"], "O"),
    Place("kite", _IN_LINE, DISTANCES, _FOLDED["kite"], "O"),
    Place("kite, A passing O2", _ON_PIVOT, DISTANCES, _FOLDED["kite, A passing O2"], "balancing_torque"),
    Place("parallelogram, folded", _IN_LINE, DISTANCES, _FOLDED["parallelogram"], "O"),
    Place("coupler as long as the crank", _IN_LINE, DISTANCES, _FOLDED["equal links"], "O"),
    Place("size", "size, times the sawframe's [1]", _SIZES, _SCALED["size"], "O"),
    Place("unequal masses", _MASSES, _RATIOS, _mass_ratio, "balancing_torque"),
    Place("many turns", "crank angle [rad]", _ANGLES, _SCALED["turns"], "balancing_torque"),
    Place("nearly balanced", "share of the coupler's mass [1]", DISTANCES, _nearly_balanced, "balancing_torque"),
)


__all__ = ["PLACES", "Place", "study", "summary"]

EXACT_ERROR = 1e-12
"""Error below which a result is called exact for any condition."""
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
"""Methods that allow any crank angles, each with its best setting."""


def study(places=None, methods=None, progress=None):
    """Error and behaviour of every method at every place.

    Parameters
    ----------
    places : sequence of Place, optional
        `PLACES` by default.
    methods : sequence of Method, optional
        `ks.precision.METHODS` by default, without methods that need even crank angles.
    progress : function, optional
        Called with the name of each place before its study.

    Returns
    -------
    pandas.DataFrame
        A row for each place, number and method: largest error over the crank angles, relative to the quantity's largest
        value. Then the largest condition, the change by one rounding of the crank angle, and the largest bound by
        `Solution.error_bound` for the library's own values, infinite without proof. Then the numbers of angles that
        lose digits, flip to the other assembly or are NaN; the exception raised; the reason if not given.

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
            warnings.simplefilter("ignore", HintWarning)  # places are extreme on purpose
            for number in place.numbers:
                rows += _study_number(place, number, chosen)
    return pd.DataFrame(rows)


def _study_number(place, number, methods):
    with np.errstate(all="ignore"):
        solution = place.scene(number)
        reference = enclosure(solution, place.quantity, digits=20)
        within_a_turn = solution.at(np.fmod(solution.crank_angle, 2 * math.pi))  # whole turns should not lose digits
        bound = UNIT_ROUNDOFF * within_a_turn.condition_of(place.quantity)
        *inner, last = solution.mechanism.groups
        flipped = replace(solution.mechanism, groups=(*inner, replace(last, assembly=-last.assembly)))
        other = np.array(components(replace(solution, mechanism=flipped), place.quantity))
        largest = float(np.max(proven_bound(solution, place.quantity))) / reference.largest
        rounding = _change_by_one_rounding(solution, place.quantity, reference)
    known = declared(solution, place.quantity)
    common = {"place": place.name, "axis": place.axis, "number": number, "quantity": place.quantity}
    common |= {"label": known.label, "unit": known.unit}
    return [
        {
            **common,
            "condition": np.max(bound) / UNIT_ROUNDOFF,
            "angle rounding": rounding,
            "bound": largest,
            **_behaviour(method, solution, place.quantity, reference, bound, other),
        }
        for method in methods
    ]


def _change_by_one_rounding(solution, quantity, reference):
    """Largest change of the quantity by half a unit in the last place of the crank angle, over its largest value.

    Infinite if the next number is beyond a limit position.
    """
    for way in (-math.inf, math.inf):
        try:
            moved = enclosure(solution.at(np.nextafter(solution.crank_angle, way)), quantity, digits=20)
        except NotGivenError:
            continue
        return 0.5 * float(relative_errors(moved.exact, reference).max())
    return math.inf


def _behaviour(method, solution, quantity, reference, bound, other):
    """Columns of a method; `other` are the components in the other assembly, to recognise methods that flip."""
    columns = {"method": method.name, "ours": method.ours, "error": np.nan, "angles": solution.crank_angle.size}
    columns |= {"lost": 0, "flipped": 0, "nan": 0, "raised": "", "not given": ""}
    try:
        with np.errstate(all="ignore"):
            found = np.array(method.prepare(solution, quantity, METHOD_SETTINGS[method.name])())
    except (NotGivenError, MissingLibraryError) as why:
        return columns | {"not given": str(why)}
    except Exception as error:
        return columns | {"raised": f"{type(error).__name__}: {error}"}
    errors = relative_errors(found, reference)
    missing = ~np.isfinite(found).all(axis=0)
    wrong = ~missing & ~(errors <= bound)
    nearer = np.linalg.norm(found - other, axis=0) < 1e-3 * np.linalg.norm(reference.middle - other, axis=0)
    counts = {"lost": int((wrong & ~nearer).sum()), "flipped": int((wrong & nearer).sum()), "nan": int(missing.sum())}
    return columns | counts | {"error": float(errors[~missing].max()) if not missing.all() else np.nan}


def summary(table):
    """Behaviour of each method at each place: worst error, its number, and the number of failing angles.

    The worst error covers the numbers whose condition leaves a digit; the table counts the others.

    Parameters
    ----------
    table : pandas.DataFrame
        Result of `study`.

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
        digits = part[(part["condition"] * UNIT_ROUNDOFF < 1.0) & part["error"].notna()]
        worst = digits.loc[digits["error"].idxmax()] if len(digits) else {}
        found = [
            ("raises", raised),
            ("gives up", given_up),
            ("gives NaN", counts["nan"]),
            ("flips assembly", counts["flipped"]),
            ("loses digits", counts["lost"]),
        ]
        fine = "exact" if digits["error"].max() < EXACT_ERROR else "as near as the condition allows"
        verdict = ", ".join(text for text, count in found if count) or fine
        rows.append(
            {
                "place": place,
                "method": method,
                "does": verdict if given else "does not give it",
                "worst error": worst.get("error", np.nan),
                "at": worst.get("number", np.nan),
                "condition there": worst.get("condition", np.nan),
                **counts,
                "raised": raised,
                "given up": given_up if given else 0,
                "of angles": int(part["angles"].sum()),
                "numbers without digits": int((part["condition"] * UNIT_ROUNDOFF >= 1.0).sum()),
            }
        )
    return pd.DataFrame(rows)


def write(folder, places=None, progress=None, page=None):
    """Run the study and write all rows and the summary as CSV to a folder, and charts by ``page(table, path)``.

    Returns the paths of the files. `views.charts.stability_page` draws charts as PNG and SVG.
    """
    from ..numbers.files import folder_write_problem, write_atomically

    checks.require("stability", folder_write_problem(folder))
    table = study(places, progress=progress)
    folder = Path(folder)
    paths = []
    for name, frame in (("stability", table), ("stability_summary", summary(table))):
        path = folder / f"{name}.csv"
        with write_atomically(path) as temporary:
            frame.assign(**circumstances()).to_csv(temporary, index=False)
        paths.append(path)
    return [*paths, *(page(table, folder / "stability") if page else ())]


def __dir__():
    return __all__
