"""Curves of solutions over the crank angle, and hodographs of their reactions."""

from collections.abc import Mapping

import numpy as np

from ..errors import QuantityError
from ..mechanics import quantities
from ..mechanics.quantities import of_mechanism, values
from ..numbers.checks import choice, singles
from ..results.extremes import extremes
from . import peaks
from .canvas import (
    FROM_X,
    INK,
    axes,
    closed,
    display,
    drawn_over_turn,
    finished,
    in_order,
    in_sight,
    labelled,
    ordinary,
    styled,
)
from .labels import label
from .peaks import with_peaks
from .studies import require_turning

LEAST_MARKS = 0.01
"""Least step of the crank-angle marks, degrees."""


def over_turn(solutions, quantity, ax=None, counted=FROM_X):
    """One quantity over the crank angle; curves that cover each other are one, under all their labels.

    Extremes between the crank angles solved, kinks and jumps are on the curve.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    quantity : str
        As for `extremes`; of a reaction or a vector the magnitude is drawn.
    ax : matplotlib Axes, optional
    counted : Counted, optional
        How crank angles are counted, from +x and counter-clockwise unless told.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> solutions = {name: saw.solve(name, 90) for name in ("plain", "cam-cosine")}
    >>> ax = ks.plots.over_turn(solutions, "slider_velocity")
    >>> ax.get_xlabel(), len(ax.get_legend().get_texts())
    ('crank angle from +x, counter-clockwise [deg]', 2)
    """
    ax = axes(ax)
    named = with_peaks(labelled(solutions, quantity), quantity)
    read = {name: values(solution, quantity) for name, solution in named.items()}
    declared = _declared(named, quantity)
    factor, shown = display(declared.unit, list(read.values()))
    curves = {name: in_order(named[name], factor * value, counted) for name, value in read.items()}
    drawn_over_turn(ax, curves)
    finished(ax, f"{declared.label} [{shown}]", len(curves) > 1, _longest(named), counted)
    peaks.framed(ax, [value for _, value in curves.values()], shown)
    peaks.shaded(ax, named, curves, counted)
    return ax


def torque(solutions, ax=None, counted=FROM_X):
    """Balancing torque over the crank angle (study of sawframe 2R63, figure 6a).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    ax : Axes, optional
    counted : Counted, optional
        As for `over_turn`.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> solutions = {name: saw.solve(name, 90) for name in ("plain", "cam-cosine")}
    >>> ax = ks.plots.torque(solutions)
    >>> ax.get_xlabel()  # ax.figure.savefig("torque.svg") keeps it
    'crank angle from +x, counter-clockwise [deg]'
    """
    return over_turn(solutions, "balancing_torque", ax, counted)


def cam_force(solutions, ax=None):
    """Force of the cam on the roller over the crank angle (figure 6b).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With a cam roller.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ks.plots.cam_force(saw.solve("cam-circle", 90)).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    return over_turn(solutions, "cam_force", ax)


def pressure_angle(solutions, ax=None):
    """Pressure angle of the cam pair over the crank angle (figure 5).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With a cam roller.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ks.plots.pressure_angle(saw.solve("cam-circle", 90)).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    return over_turn(solutions, "pressure_angle", ax)


def acceleration_error(solutions, ax=None, slider=None):
    """Slider acceleration against a cosine law of the same stroke, relative to its amplitude (figure 3).

    With the stroke S from the true extremes of the slider position and psi the crank angle from the guide, the law is
    -S/2 (omega^2 cos(psi) + alpha sin(psi)); deviations are relative to S/2 omega^2. The only slider, or that without a
    label, is meant unless told.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With a slider.
    ax : Axes, optional
    slider : str, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ks.plots.acceleration_error(saw.solve("cam-circle", 90)).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    ax = axes(ax)
    named = labelled(solutions, "slider acceleration")
    require_turning(named)
    curves = {}
    for name, solution in named.items():
        half_stroke = np.ptp(extremes(solution, lambda motion: motion.travel(slider)).value) / 2
        square, alpha = solution.crank_speed**2, solution.crank_acceleration
        psi = solution.crank_angle - solution.mechanism.guides[slider or solution.mechanism.slider].guide_angle
        law = -half_stroke * (square * np.cos(psi) + alpha * np.sin(psi))
        error = (solution.travel_acceleration(slider) - law) / (half_stroke * square)
        curves[name] = in_order(solution, 100 * error, FROM_X)
    drawn_over_turn(ax, curves)
    finished(ax, "deviation of slider acceleration\nfrom cosine law [% of amplitude]", len(named) > 1, _longest(named))
    peaks.framed(ax, [value for _, value in curves.values()], "%")
    peaks.shaded(ax, named, curves, FROM_X)
    return ax


def hodograph(solutions, joint="O", ax=None, marks=30, counted=FROM_X):
    """Hodograph of a joint reaction: the curve its tip draws over the turn (figure 7).

    Extremes of the magnitude between the crank angles solved, kinks and jumps are on it. Where it has no value it ends
    at a cross, where it grows far beyond the rest at the head of an arrow.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    joint : str
        Joint, or the vector attribute "shaking_force".
    ax : Axes, optional
    marks : float
        Step of the crank-angle marks, degrees; marks stand where the solution has that angle, to half a degree.
    counted : Counted, optional
        How the marks count crank angles, from +x and counter-clockwise unless told.

    Returns
    -------
    Axes
        With equal scales on both axes.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ax = ks.plots.hodograph(saw.solve("plain", 90), "O", marks=60)
    >>> ax.get_aspect()
    1.0
    """
    marks = singles("hodograph", marks=(marks, "deg", {"low": LEAST_MARKS}))["marks"]
    ax = axes(ax)
    named = with_peaks(labelled(solutions, joint), joint)
    curves = {name: _vector(solution, joint) for name, solution in named.items()}
    declared = _declared(named, joint)
    factor, shown = display(declared.unit, curves.values())
    sizes = [np.hypot(*curve) for curve in curves.values()]
    sight = in_sight(sizes)
    whole = curves
    curves = {name: np.where(np.hypot(*curve) <= sight, curve, np.nan) for name, curve in curves.items()}
    most = 2.0 * ordinary(sizes)
    extents = {name: factor * min(_extent(curve), most) for name, curve in curves.items()}
    whys: set[str] = set()
    for name, solution, style in styled(named):
        (line,) = ax.plot(*closed(factor * curves[name]), linestyle=style, label=name)
        rows = [row for row in _marked(solution, marks) if np.isfinite(curves[name][0, row])]
        ax.plot(*factor * curves[name][:, rows], "o", ms=3, color=line.get_color())
        ends = list(peaks.ends(solution, whole[name], curves[name]))
        peaks.marked(ax, ends, factor * curves[name], line.get_color())
        whys |= {end.why for end in ends if end.why}
        rows += [end.row for end in ends if end.row not in rows]
        near = max(0.03 * extents[name], 0.02 * max(extents.values()))
        period = np.degrees(solution.period)
        texts = _shared(counted(_degrees(solution)[rows], period) % period, factor * curves[name][:, rows], near)
        for text, point in texts:
            label(ax, text, point, color=line.get_color() if len(named) > 1 else INK)
    ax.axhline(0, color=INK, lw=0.5)
    ax.axvline(0, color=INK, lw=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    notes = [f"× {why}" for why in sorted(whys)]
    if any(np.any(size > sight) for size in sizes):
        notes.insert(0, f"▸ beyond the frame: {peaks.size([factor * size for size in sizes], shown)}")
    if notes:
        peaks.noted(ax, notes)
    ax.set_xlabel(f"{declared.label}, x [{shown}]")
    ax.set_ylabel(f"{declared.label}, y [{shown}]")
    if len(named) > 1 or isinstance(solutions, Mapping):
        ax.legend(frameon=False)
    return ax


def _extent(curve):
    """Largest extent of a curve (2, N) in x or y, where it has values."""
    found = curve[:, np.isfinite(curve).all(axis=0)]
    return float(np.max(np.ptp(found, axis=1))) if found.size else 0.0


def _degrees(solution):
    return np.degrees(solution.crank_angle)


def _longest(named):
    """Longest period of solutions, degrees."""
    return round(np.degrees(max(solution.period for solution in named.values())))


def _vector(solution, name):
    """Values of a vector, (2, N)."""
    vectors = {known: found for known, found in of_mechanism(solution.mechanism).items() if found.vector}
    if name not in vectors:
        raise QuantityError(choice(f"{solution.mechanism.name}: reaction", name, tuple(vectors)))
    return vectors[name].read(solution)


def _declared(named, name):
    """Unit and label of a quantity that all solutions have."""
    return quantities.quantity(next(iter(named.values())), name)


def _marked(solution, step):
    """Rows of the solution whose crank angles are multiples of a step in degrees, to half a degree."""
    period = np.degrees(solution.period)
    apart = np.mod(_degrees(solution) - np.arange(0, period, step)[:, None] + period / 2, period) - period / 2
    return np.argmin(np.abs(apart), axis=1)[np.abs(apart).min(axis=1) < 0.5]


def _shared(degrees, points, near):
    """Labels of points (2, M) by their crank angles, with their places: one for points nearer to each other than so."""
    labels: dict[int, list[str]] = {}
    for row, point in enumerate(points.T):
        first = next((other for other in labels if np.hypot(*(points[:, other] - point)) < near), row)
        labels.setdefault(first, []).append(f"{degrees[row]:.4g}°")
    for row, names in labels.items():
        yield ", ".join(names) if len(names) < 5 else f"{names[0]}, {names[1]} … {names[-1]}", points[:, row]
