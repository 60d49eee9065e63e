"""Four-bars: their bars, Grashof's class with the crank angles of assembly, and swing and transmission of the rocker.

The chain unit of the Belarusian study measures its crank angle from +y, clockwise, and the rocker angle from its start.
`chain_unit` builds it and `chain_unit_angle` converts its crank angle into the library's. Angles are in rad.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import asin, atan2, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from ..cycle.extremes import extremes
from ..errors import ParameterError
from ..machine.builders import four_bar
from ..machine.group import FRAME, Bar
from ..numbers import checks
from ..numbers.arithmetic import TURN
from ..numbers.formatting import with_units
from ..numbers.planar import cross, dot


class FourBar(NamedTuple):
    """Crank and coupler in a row, rocker from its fixed pivot (x, y) to the end of the coupler."""

    crank: Bar
    coupler: Bar
    rocker: Bar
    pivot: tuple[Any, Any]


class CrankSlider(NamedTuple):
    """Crank and coupler in a row to a slider on a guide."""

    crank: Bar
    coupler: Bar
    slider: str


def four_bar_shape(mechanism) -> FourBar | None:
    """The bars of a four-bar; None for any other mechanism."""
    bars = mechanism.bars
    if len(mechanism.groups) != 1 or len(bars) != 3 or mechanism.guides:
        return None
    crank, coupler, rocker = bars
    start = mechanism.joints[rocker.start]
    if coupler.start != crank.end or rocker.end != coupler.end or start.link != FRAME:
        return None
    return FourBar(crank, coupler, rocker, (start.along, start.across))


def crank_sliders(mechanism) -> tuple[CrankSlider, ...]:
    """Chains of crank, coupler and slider, one for each coupler from the crank to a slider."""
    joints, bars = mechanism.joints, mechanism.crank.bars
    return tuple(
        CrankSlider(crank, bar, joints[bar.end].link)
        for crank in bars
        for bar in mechanism.couplers
        if bar.start == crank.end and joints[bar.end].link in mechanism.guides
    )


FULL_TURN = ((0.0, TURN),)
CHANGE_POINT_TOLERANCE = 1e-12
"""Difference of the two sums of lengths, relative to them, below which a four-bar has a change point."""


@with_units(intervals="rad")
@dataclass(frozen=True)
class Grashof:
    """Class of a four-bar by Grashof's rule.

    Attributes
    ----------
    kind : str
        "crank-rocker", "double-crank", "double-rocker", "rocker-crank" (Grashof linkages, by the shortest link),
        "change-point", or "triple-rocker".
    turning_joints : tuple of str
        Joints whose two links turn fully against each other.
    intervals : tuple of (float, float)
        Crank-angle intervals in which it closes, rad, start in [0, 2 pi); one full turn if the crank makes full turns.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.linkage.grashof(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)))
    Grashof(kind='crank-rocker', turning_joints=('O', 'A'), intervals=((0, 6.28319),) rad)
    """

    kind: str
    turning_joints: tuple[str, ...]
    intervals: tuple[tuple[float, float], ...]


KINDS_BY_SHORTEST = "crank-rocker", "double-rocker", "rocker-crank", "double-crank"
"""Kinds of a Grashof linkage whose shortest link is the crank, coupler, rocker, frame."""


def grashof(mechanism):
    """Grashof class of a four-bar, the joints that turn fully, and the crank angles at which it closes.

    The shortest link turns fully against its neighbours if it and the longest are together shorter than the other two
    (Grashof's rule, as in Uicker, Pennock and Shigley). Equality makes a change-point linkage: there the links come to
    lie in one line, velocities are undefined there, and the assembly on both sides is the chosen one.

    Parameters
    ----------
    mechanism : Mechanism
        A four-bar of one design.

    Returns
    -------
    Grashof

    Raises
    ------
    ParameterError
        The mechanism is not a four-bar of one design, or its pivots coincide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.linkage.grashof(ks.four_bar(0.4, 0.3, 0.35, rocker_pivot=(0.3, 0.0)))
    >>> found.kind, [[round(end, 4) for end in interval] for interval in found.intervals]
    ('triple-rocker', [[3.9104, 8.656]])
    """
    crank, coupler, rocker, pivot = four_bar_of(mechanism)
    lengths = crank.length, coupler.length, rocker.length, np.hypot(*pivot)
    if any(map(np.ndim, lengths)):
        raise ParameterError("Grashof's rule is for one design at a time, got a batch of lengths")
    if not lengths[-1]:
        raise ParameterError("Grashof's rule needs a frame: the rocker's pivot lies at O")
    ends = (crank.start, crank.end), (coupler.start, coupler.end), (rocker.end, rocker.start)
    links = list(zip(lengths, KINDS_BY_SHORTEST, (*ends, (rocker.start, crank.start)), strict=True))
    shortest, *between, longest = ordered = sorted(links, key=lambda link: link[0])
    outer, inner = shortest[0] + longest[0], sum(length for length, *_ in between)
    joints: tuple[str, ...]
    _, kind, joints = shortest
    change_point = abs(outer - inner) <= CHANGE_POINT_TOLERANCE * inner
    if change_point:
        kind, limit = "change-point", shortest[0] * (1 + CHANGE_POINT_TOLERANCE)
        joints = tuple(dict.fromkeys(joint for length, _, pair in ordered if length <= limit for joint in pair))
    elif outer > inner:
        kind, joints = "triple-rocker", ()
    slack = 8 * CHANGE_POINT_TOLERANCE if change_point else 0.0
    return Grashof(kind, joints, _closed_intervals(lengths, atan2(pivot[1], pivot[0]), slack))


def four_bar_of(mechanism):
    """The bars of a four-bar; an error for any other mechanism."""
    checks.require("linkage", checks.mechanism("mechanism", mechanism))
    bars = four_bar_shape(mechanism)
    if bars is None:
        raise ParameterError(f"this is for four-bars, not for a {mechanism.name}")
    return bars


def _closed_intervals(lengths, frame_angle, slack):
    """Crank-angle intervals with the distance A-O2 between difference and sum of coupler and rocker, rad.

    `lengths` are those of crank r, coupler, rocker and frame b. At the distance D the crank is theta from the frame
    line, sin^2(theta / 2) = (D^2 - (r - b)^2) / (4 r b). Values within `slack` of 0 or 1, from rounded lengths of a
    change-point linkage, become 0 or 1.
    """
    r, coupler, rocker, b = lengths

    def at_distance(distance):
        square = (distance - (r - b)) * (distance + (r - b)) / (4 * r * b)
        return 2 * asin(sqrt(0.0 if square <= slack else 1.0 if square >= 1 - slack else square))

    near, far = at_distance(abs(coupler - rocker)), at_distance(coupler + rocker)
    if far <= near:
        return ()
    if near == 0 and far == pi:
        return FULL_TURN
    pieces = [(near, far), (-far, -near)]
    if near == 0:
        pieces = [(-far, far)]
    elif far == pi:
        pieces = [(near, TURN - near)]
    ends = ((frame_angle + start, frame_angle + end) for start, end in pieces)
    return tuple(sorted((start % TURN, start % TURN + end - start) for start, end in ends))


__all__ = [
    "Grashof",
    "Swing",
    "chain_unit",
    "chain_unit_angle",
    "characteristics",
    "grashof",
    "rocker_angle",
    "swing",
    "transmission_angle",
]

LENGTH_RULE = checks.Number("m", low=0.0, strict=True)
CHAIN_UNIT_RULES = {
    **dict.fromkeys(("crank length", "coupler length", "rocker length"), LENGTH_RULE),
    "pivot_x": checks.Optional(checks.Number("m")),
}
ANGLE_RULE, START_RULE = {"angle": checks.Number("rad", table=True)}, {"start": checks.Number("rad")}
QUARTER = pi / 2
ROCKER_ANGLES = 720
"""Crank angles per turn that make the rocker angle continuous."""


def chain_unit(crank_length, coupler_length, rocker_length, *, pivot_x=None, **links):
    """Four-bar of the chain unit, with the crank's pivot at O and the rocker's at (pivot_x, -rocker_length).

    Parameters
    ----------
    crank_length, coupler_length, rocker_length : float or array
        m; in the relative form rho, 1, lambda.
    pivot_x : float or array, optional
        Free start (the study's variant 2). By default the start is parallel (variant 1): crank and rocker are parallel
        when the crank points along +y, so pivot_x = sqrt(coupler_length^2 - crank_length^2).
    **links
        Links crank, coupler, rocker, and assembly, as for `four_bar`.

    Returns
    -------
    Mechanism

    Raises
    ------
    ParameterError
        The coupler is shorter than the crank, so the parallel start is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> unit = ks.linkage.chain_unit(0.1, 1.0, 0.5)  # in lengths of the coupler
    >>> [round(float(part), 6) for part in unit.groups[0].pivot]
    [0.994987, -0.5]
    """
    given = {"crank length": crank_length, "coupler length": coupler_length, "rocker length": rocker_length}
    found = checks.check_values("chain unit", CHAIN_UNIT_RULES, given | {"pivot_x": pivot_x})
    crank_length, coupler_length, rocker_length, pivot_x = found.values()
    if pivot_x is None:
        square = (coupler_length - crank_length) * (coupler_length + crank_length)
        if checks.has_known_values(square) and np.any(square <= 0):
            raise ParameterError(
                f"chain unit: parallel start needs a coupler longer than the crank, got {np.min(coupler_length)} m and "
                f"{np.max(crank_length)} m; give pivot_x for a free start"
            )
        pivot_x = np.sqrt(square)
    return four_bar(crank_length, coupler_length, rocker_length, rocker_pivot=(pivot_x, -rocker_length), **links)


def chain_unit_angle(angle):
    """Crank angle counted clockwise from +y as one counted counter-clockwise from +x, and the reverse, rad.

    The angle is a number or an array. Raises `ParameterError` for anything else.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> np.degrees(ks.linkage.chain_unit_angle(np.radians([0.0, 90.0, 120.0]))).round(9)
    array([ 90.,   0., -30.])
    """
    return QUARTER - np.asarray(checks.check_values("chain unit", ANGLE_RULE, {"angle": angle})["angle"])


def rocker_angle(solution, start=QUARTER):
    """Angle of the rocker, clockwise from its position at the crank angle `start`, (..., N), rad.

    Parameters
    ----------
    solution : Solution
        Solution of a four-bar.
    start : float
        rad; by default the angle at which crank and rocker of the chain unit are parallel.

    Returns
    -------
    array (..., N)
        rad; continuous, so that each turn of the rocker counts 2 pi.

    Raises
    ------
    ParameterError
        The solution is not of a four-bar.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), 0.0, crank_speed=1.0)
    >>> round(float(ks.linkage.rocker_angle(s)), 4)
    0.2115
    """
    link, turns = _bars_of(solution).rocker.link, solution.mechanism.turns
    start = checks.check_values("rocker_angle", START_RULE, {"start": start})["start"]
    grid, beginning = np.linspace(0.0, TURN * turns, ROCKER_ANGLES * turns + 1), solution.at(start)
    here, around = (_clockwise(at, link, beginning) for at in (solution, solution.at(start + grid)))
    course = np.unwrap(np.nan_to_num(around))
    periods, rest = np.divmod(solution.crank_angle - start, grid[-1])
    *designs, count = np.shape(np.atleast_1d(here))
    nearest = np.broadcast_to(np.rint(rest / grid[1]).astype(int), (*designs, count))
    nearby = np.take_along_axis(np.broadcast_to(course, (*designs, grid.size)), nearest, axis=-1)
    nearby = (nearby + periods * (course[..., -1:] - course[..., :1])).reshape(np.shape(here))
    return here + TURN * np.rint((nearby - here) / TURN)


def _clockwise(solution, link, beginning):
    """Angle of a link, clockwise from its angle in another solution, from -pi to pi, rad."""
    here, before = (at.placement.links[link].direction for at in (solution, beginning))
    return np.arctan2(cross(here, before), dot(here, before))


def transmission_angle(solution):
    """Angle between coupler and rocker at B, (..., N), in (0, pi), rad; forces grow as it nears 0 or pi.

    The solution, and errors, as for `rocker_angle`.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), 0.0, crank_speed=1.0)
    >>> np.degrees(ks.extremes(s, ks.linkage.transmission_angle).range).round(3)
    array([ 77.132, 102.868])
    """
    bars, links = _bars_of(solution), solution.placement.links
    coupler, rocker = (links[bar.link].direction for bar in (bars.coupler, bars.rocker))
    return np.arctan2(abs(cross(coupler, rocker)), dot(coupler, rocker))


@with_units(largest="rad", smallest="rad", largest_at="rad", smallest_at="rad")
@dataclass(frozen=True)
class Swing:
    """Swing of the rocker over a turn, clockwise from its start.

    Attributes
    ----------
    largest, smallest : float
        Extreme rocker angles psi, rad.
    largest_at, smallest_at : float
        Crank angles of the extremes, rad, counter-clockwise from +x.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.linkage.chain_unit(0.5, 1.0, 0.8), 0.0, crank_speed=1.0)
    >>> found = ks.linkage.swing(s)
    >>> round(found.range, 6), round(found.asymmetry, 6)
    (1.350263, 0.565195)
    """

    largest: float
    smallest: float
    largest_at: float
    smallest_at: float

    @property
    def range(self):
        """Total swing angle, rad."""
        return self.largest - self.smallest

    @property
    def asymmetry(self):
        """Asymmetry coefficient ``eta = |psi_min| / psi_max`` of the study."""
        return abs(self.smallest) / self.largest


def has_swinging_rocker(mechanism):
    """Whether the mechanism is a four-bar whose crank makes full turns and whose rocker does not."""
    bars = four_bar_shape(mechanism)
    return bars is not None and _rocker_swings(bars, grashof(mechanism))


def _rocker_swings(bars, found_class):
    return found_class.intervals == FULL_TURN and bars.rocker.start not in found_class.turning_joints


def swing(solution, start=QUARTER):
    """Swing of the rocker, from the exact extremes of its angle.

    Parameters
    ----------
    solution : Solution
        Solution of a four-bar whose crank makes full turns.
    start : float
        Crank angle at which the rocker angle is zero, rad; +y as in the study.

    Returns
    -------
    Swing

    Raises
    ------
    ParameterError
        The solution is not of a four-bar, its crank does not make full turns, or its rocker does.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), 0.0, crank_speed=1.0)
    >>> found = ks.linkage.swing(s)
    >>> [round(float(np.degrees(angle)), 3) for angle in (found.smallest, found.largest)]
    [-10.957, 12.117]
    """
    bars = _bars_of(solution)
    found_class = grashof(solution.mechanism)
    if not _rocker_swings(bars, found_class):
        raise ParameterError(
            "swing is for four-bars whose crank makes full turns and whose rocker does not; this one is a "
            f"{found_class.kind}{'' if found_class.intervals == FULL_TURN else ' that does not close all round'}"
        )
    found = extremes(solution, lambda at: rocker_angle(at, start))
    high, low = int(np.argmax(found.value)), int(np.argmin(found.value))
    return Swing(*map(float, (found.value[high], found.value[low], found.angle[high], found.angle[low])))


def _bars_of(solution):
    checks.require("linkage", checks.solution("solution", solution))
    return four_bar_of(solution.mechanism)


def _speed_problem(name, solution):
    """Sentence about a solution without crank speed, or None."""
    problem = checks.solution(name, solution)
    if problem is None and np.any(np.asarray(solution.crank_speed) == 0):
        return f"{name}: the crank speed is 0, but speeds are relative to it; give a crank speed"
    return problem


def characteristics(solutions, reference):
    """Swing, unevenness and transmission of four-bars, side by side as a pandas DataFrame.

    Parameters
    ----------
    solutions : dict of name to Solution
        Four-bars whose crank makes full turns.
    reference : str
        Name of the reference for amplitudes and speeds.

    Returns
    -------
    pandas.DataFrame
        A column for each mechanism; speeds relative to the crank's.

    Raises
    ------
    ParameterError
        The reference is unknown, or a solution is not of a four-bar with a turning crank and swinging rocker.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> units = {f"rho {rho}": ks.linkage.chain_unit(rho, 1.0, 0.5) for rho in (0.1, 0.2)}
    >>> units = {name: ks.solve(unit, 0.0, crank_speed=1.0) for name, unit in units.items()}
    >>> ks.linkage.characteristics(units, "rho 0.1").loc["amplitude ratio to rho 0.1"].round(4).to_dict()
    {'rho 0.1': 1.0, 'rho 0.2': 2.1452}
    """
    import pandas as pd

    if not isinstance(solutions, Mapping) or not solutions:
        raise ParameterError(f"characteristics: solutions must be a dict of name to Solution, got {solutions!r}")
    checks.require(
        "characteristics",
        checks.choice("reference", reference, tuple(solutions)),
        *(_speed_problem(name, solution) for name, solution in solutions.items()),
    )
    amplitude, speed = "largest rocker angle psi [deg]", "largest relative rocker speed"
    columns = {}
    for name, solution in solutions.items():
        found, rate = swing(solution), f"{_bars_of(solution).rocker.link}_rate"
        transmission = np.degrees(extremes(solution, transmission_angle).range)
        columns[name] = {
            amplitude: np.degrees(found.largest),
            "smallest rocker angle psi [deg]": np.degrees(found.smallest),
            "asymmetry |psi_min| / psi_max": found.asymmetry,
            speed: abs(extremes(solution, rate).largest / solution.crank_speed),
            "smallest transmission angle [deg]": transmission[0],
            "largest transmission angle [deg]": transmission[1],
        }
    table = pd.DataFrame(columns).rename_axis("quantity")
    for ratio, quantity in (("amplitude ratio", amplitude), ("speed ratio", speed)):
        table.loc[f"{ratio} to {reference}"] = table.loc[quantity] / table.loc[quantity, reference]
    return table


def __dir__():
    return __all__
