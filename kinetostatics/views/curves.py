"""Curves of solutions over the crank angle, hodographs of reactions and shaking force, motion of the chain unit."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np

from ..cycle.extremes import extremes
from ..design.linkage import four_bar_of
from ..errors import QuantityError
from ..mechanics import quantities
from ..mechanics.quantities import magnitude, of_mechanism, values
from ..numbers.checks import choice, require, single_numbers
from . import canvas
from .canvas import (
    FROM_X,
    FROM_Y_CLOCKWISE,
    INK,
    ZERO_TOLERANCE,
    axes,
    close_curve,
    display_unit,
    draw_curves,
    draw_over_turn,
    drawn_limit,
    finish_axes,
    ordinary_size,
    period_curve,
    solutions_by_label,
    with_line_styles,
    with_peaks,
)
from .labels import label


def chain_unit_motion(solutions, link, order=1, ax=None):
    """Relative angular velocity or acceleration of a link of the chain unit (Belarusian study, figures 5-12).

    Both are counted in the crank's sense of turning and divided by crank speed, or its square; the crank angle from
    +y, clockwise.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    link : "coupler" or "rocker"
        Link of the four-bar, whatever its name.
    order : 1 or 2
        Velocity or acceleration.
    ax : Axes, optional

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.linkage.chain_unit(0.1, 1.0, 0.5), 1.0).solve(90)
    >>> ks.plots.chain_unit_motion(s, "rocker").get_xlabel()
    'crank angle from +y, clockwise [deg]'
    """
    require(
        "chain_unit_motion",
        None if order in (1, 2) else f"order must be 1 or 2, got {order!r}",
        choice("link", link, ("coupler", "rocker")),
    )
    ax = axes(ax)
    named = solutions_by_label(solutions, f"{link} rate")
    require_turning(named)

    def relative(solution):
        turning, speed = getattr(four_bar_of(solution.mechanism), link).link, solution.crank_speed
        if order == 1:
            return solution.rate(turning) / speed
        return solution.angular_acceleration(turning) / (speed * abs(speed))

    named = with_peaks(named, relative)
    curves = {name: period_curve(solution, relative(solution), FROM_Y_CLOCKWISE) for name, solution in named.items()}
    draw_curves(ax, curves)
    kind = "velocity" if order == 1 else "acceleration"
    return finish_axes(ax, f"relative angular {kind} of the {link} [1]", len(named) > 1, counted=FROM_Y_CLOCKWISE)


def shaking_force(solutions, by="direction", ax=None):
    """Polar hodograph of the shaking force, by its own direction or by crank angle (mower study, figures 6a, 6b).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    by : "direction" or "crank angle"
        What the polar angle is.
    ax : polar Axes, optional

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bare = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> balanced = ks.balancing.partial(bare, crank=ks.Counterweight(arm=-0.05)).mechanism
    >>> solutions = {name: ks.Scene(item, 62.8).solve(90) for name, item in (("bare", bare), ("half", balanced))}
    >>> ks.plots.shaking_force(solutions).name
    'polar'
    """
    require("shaking_force", choice("by", by, ("direction", "crank angle")))
    if ax is None:
        ax = plt.subplots(subplot_kw={"projection": "polar"}, layout="constrained")[1]
    ax = axes(ax)
    named = with_peaks(solutions_by_label(solutions, "shaking_force"), "shaking_force")
    sizes = {name: magnitude(solution.shaking_force) for name, solution in named.items()}
    factor, shown = display_unit("N", sizes.values())
    largest = max(float(np.max(size)) for size in sizes.values())
    for name, solution, style in with_line_styles(named):
        x, y = solution.shaking_force
        angle = np.arctan2(y, x) if by == "direction" else solution.crank_angle
        zero = len(named) > 1 and np.max(sizes[name]) <= ZERO_TOLERANCE * largest
        text = f"{name} (0)" if zero else name
        ax.plot(*close_curve(np.array([angle, factor * sizes[name]])), linestyle=style, label=text)
    way = "the angle of its direction, from +x" if by == "direction" else FROM_X.axis.replace(" [deg]", "")
    ax.set_title(f"shaking force [{shown}] over {way}", fontsize="medium")
    ax.set_rlabel_position(67.5)
    if len(named) > 1:
        ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.05, 1.0))
    return ax


def require_turning(named):
    """Raise an error for solutions with the crank at rest."""
    still = [name for name, solution in named.items() if np.any(np.asarray(solution.crank_speed) == 0)]
    require(
        "plots", f"the crank speed of {', '.join(still)} is 0, but what is shown is relative to it" if still else None
    )


MIN_MARK_STEP = 0.01
"""Smallest step of the crank-angle marks, degrees."""


def over_turn(solutions, quantity, ax=None, counted=FROM_X):
    """One quantity over the crank angle; curves that coincide are drawn once, with all their labels.

    The curve includes extremes between the crank angles solved, kinks and jumps.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    quantity : str
        As for `extremes`; of a reaction or a vector the magnitude is drawn.
    ax : matplotlib Axes, optional
    counted : AngleConvention, optional
        Convention for crank angles; by default from +x, counter-clockwise.

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
    named = with_peaks(solutions_by_label(solutions, quantity), quantity)
    read = {name: values(solution, quantity) for name, solution in named.items()}
    declared = quantities.quantity(next(iter(named.values())), quantity)
    factor, shown = display_unit(declared.unit, list(read.values()))
    curves = {name: period_curve(named[name], factor * value, counted) for name, value in read.items()}
    return draw_over_turn(ax, named, curves, f"{declared.label} [{shown}]", shown, counted)


def torque(solutions, ax=None, counted=FROM_X):
    """Balancing torque over the crank angle (study of sawframe 2R63, figure 6a).

    `solutions`, `ax` and `counted` as for `over_turn`.

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

    `solutions`, with a cam roller, and `ax` as for `over_turn`.

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

    `solutions`, with a cam roller, and `ax` as for `over_turn`.

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
    -S/2 (omega^2 cos(psi) + alpha sin(psi)); deviations are relative to S/2 omega^2. The default is the only slider, or
    the one without a label.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With a slider.
    ax : Axes, optional
    slider : str, optional

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ks.plots.acceleration_error(saw.solve("cam-circle", 90)).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    ax = axes(ax)
    named = solutions_by_label(solutions, "slider acceleration")
    require_turning(named)
    curves = {}
    for name, solution in named.items():
        half_stroke = np.ptp(extremes(solution, lambda motion: motion.travel(slider)).value) / 2
        square, alpha = solution.crank_speed**2, solution.crank_acceleration
        psi = solution.crank_angle - solution.mechanism.guides[slider or solution.mechanism.slider].guide_angle
        law = -half_stroke * (square * np.cos(psi) + alpha * np.sin(psi))
        error = (solution.travel_acceleration(slider) - law) / (half_stroke * square)
        curves[name] = period_curve(solution, 100 * error, FROM_X)
    label = "deviation of slider acceleration\nfrom cosine law [% of amplitude]"
    return draw_over_turn(ax, named, curves, label, "%", FROM_X)


def hodograph(solutions, joint="O", ax=None, marks=30, counted=FROM_X):
    """Hodograph of a joint reaction: the curve its tip draws over the turn (figure 7).

    The curve includes extremes of the magnitude between the crank angles solved, kinks and jumps. It ends with a cross
    where it has no value, and with an arrow head where it grows far beyond the rest.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    joint : str
        Joint, or the vector attribute "shaking_force".
    ax : Axes, optional
    marks : float
        Step of the crank-angle marks, degrees; a mark appears if the solution has that angle, to half a degree.
    counted : AngleConvention, optional
        Convention for the marks; by default from +x, counter-clockwise.

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
    marks = single_numbers("hodograph", marks=(marks, "deg", {"low": MIN_MARK_STEP}))["marks"]
    ax = axes(ax)
    named = with_peaks(solutions_by_label(solutions, joint), joint)
    whole = {}
    for name, solution in named.items():
        vectors = {known: found for known, found in of_mechanism(solution.mechanism).items() if found.vector}
        if joint not in vectors:
            raise QuantityError(choice(f"{solution.mechanism.name}: reaction", joint, tuple(vectors)))
        whole[name] = vectors[joint].read(solution)
    declared = quantities.quantity(next(iter(named.values())), joint)
    factor, shown = display_unit(declared.unit, whole.values())
    sizes = [np.hypot(*curve) for curve in whole.values()]
    sight = drawn_limit(sizes)
    curves = {name: canvas.hidden_beyond(sight, curve) for name, curve in whole.items()}
    most = 2.0 * ordinary_size(sizes)
    finite = {name: curve[:, np.isfinite(curve).all(axis=0)] for name, curve in curves.items()}
    extents = {
        name: factor * min(np.ptp(part, axis=1).max() if part.size else 0.0, most) for name, part in finite.items()
    }
    whys: set[str] = set()
    for name, solution, style in with_line_styles(named):
        curve = factor * curves[name]
        (line,) = ax.plot(*close_curve(curve), linestyle=style, label=name)
        rows = [row for row in _rows_at_marks(solution, marks) if np.isfinite(curve[0, row])]
        ax.plot(*curve[:, rows], "o", ms=3, color=line.get_color())
        ends = list(canvas.curve_ends(solution, whole[name], curves[name]))
        for end in ends:
            mark = {"marker": "x", "ms": 6, "mew": 1.5} if end.why else {"marker": (3, 0, end.angle - 90.0), "ms": 8}
            ax.plot(*curve[:, end.row], ls="", color=line.get_color(), zorder=4, **mark)
        whys |= {end.why for end in ends if end.why}
        rows += [end.row for end in ends if end.row not in rows]
        near = max(0.03 * extents[name], 0.02 * max(extents.values()))
        period = np.degrees(solution.period)
        degrees = counted(np.degrees(solution.crank_angle)[rows], period) % period
        for text, point in _merge_labels(degrees, curve[:, rows], near):
            label(ax, text, point, color=line.get_color() if len(named) > 1 else INK)
    ax.axhline(0, color=INK, lw=0.5)
    ax.axvline(0, color=INK, lw=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    notes = [f"× {why}" for why in sorted(whys)]
    if any(np.any(size > sight) for size in sizes):
        notes.insert(0, f"▸ beyond the frame: {canvas.size_text([factor * size for size in sizes], shown)}")
    if notes:
        canvas.write_notes(ax, notes)
    ax.set_xlabel(f"{declared.label}, x [{shown}]")
    ax.set_ylabel(f"{declared.label}, y [{shown}]")
    if len(named) > 1 or isinstance(solutions, Mapping):
        ax.legend(frameon=False)
    return ax


def _rows_at_marks(solution, step):
    """Rows of the solution whose crank angles are multiples of a step in degrees, to half a degree."""
    period = np.degrees(solution.period)
    apart = (
        np.mod(np.degrees(solution.crank_angle) - np.arange(0, period, step)[:, None] + period / 2, period) - period / 2
    )
    return np.argmin(np.abs(apart), axis=1)[np.abs(apart).min(axis=1) < 0.5]


def _merge_labels(degrees, points, near):
    """Crank-angle labels of points (2, M) with their places; points nearer than `near` share a label."""
    rows = range(points.shape[1])
    for group in canvas.grouped(rows, lambda row, other: np.hypot(*(points[:, row] - points[:, other])) < near):
        names = [f"{degrees[row]:.4g}°" for row in group]
        yield ", ".join(names) if len(names) < 5 else f"{names[0]}, {names[1]} … {names[-1]}", points[:, group[0]]
