"""Hodographs: the curve of the tip of a force over the turn, in fixed axes or in the axes of a link."""

from collections.abc import Mapping

import numpy as np

from ..errors import QuantityError
from ..machine.group import GROUND, ROCKING
from ..machine.supports import places
from ..mechanics.quantities import of_scene
from ..numbers.checks import choice, require, single_numbers
from ..numbers.planar import rotate_back
from . import canvas
from .axis_units import with_units
from .canvas import (
    FROM_X,
    INK,
    axes,
    close_curve,
    display_unit,
    drawn_limit,
    ordinary_size,
    panels,
    solutions_by_label,
    with_line_styles,
    with_peaks,
)
from .labels import label

MIN_MARK_STEP = 0.01
"""Smallest step of the crank-angle marks, degrees."""
PANEL_SIZE = 4.4, 4.0
"""Width and height of a panel, inches."""
MAX_COLUMNS = 3


@with_units
def hodograph(solutions, joint="O", ax=None, marks=30, counted=FROM_X, on=None):
    """Hodograph of a force: the curve of its tip over the turn (figure 7).

    The curve includes extremes of the magnitude between the solved crank angles, kinks and jumps. It ends with a cross
    where it has no value, and with an arrow head where it grows far beyond the rest.

    In the axes of a link the force turns relative to the link. The curve then shows the side of the load on a pin fixed
    to the link (a polar wear diagram). Put an oil hole where the load never points.

    Parameters
    ----------
    joint : str
        Joint, for its reaction; or the vector attribute "shaking_force". For a force on the frame, a place of
        `Solution.ground`, "cam", "spring" ...; for a joint "ground O".
    marks : float
        Step of the crank-angle marks, degrees; a mark appears if the solution has that angle, to half a degree.
    counted : AngleConvention, optional
        Convention for the marks; by default from +x, counter-clockwise.
    on : str, optional
        Link in whose axes the force is drawn, along the link and across it, to the left; by default fixed axes.

    Raises
    ------
    QuantityError
        A vector or link is unknown; the message lists the known ones.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> ax = ks.plots.hodograph(saw.solve("plain", 90), "O", marks=60)
    >>> ax.get_aspect()
    1.0
    >>> ks.plots.hodograph(saw.solve("plain", 90), "A", on="crank").get_xlabel()
    'reaction A, along the crank [kN]'
    """
    marks = single_numbers("hodograph", marks=(marks, "deg", {"low": MIN_MARK_STEP}))["marks"]
    ax = axes(ax)
    given = solutions_by_label(solutions, joint)
    name = joint
    for solution in given.values():
        name = _vector_name(solution, name)
    shown, unit = _draw(ax, given, name, marks, counted, on)
    ways = ("x", "y") if on is None else (f"along the {on}", f"across the {on}")
    ax.set_xlabel(f"{shown}, {ways[0]} [{unit}]")
    ax.set_ylabel(f"{shown}, {ways[1]} [{unit}]")
    if len(given) > 1 or isinstance(solutions, Mapping):
        ax.legend(frameon=False)
    return ax


@with_units
def rocking_moment(solutions, ax=None, marks=30, counted=FROM_X):
    """Hodograph of the rocking moment: the curve of its vector (about x, about y) over the turn.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        Of machines with planes along the crankshaft.
    ax, marks, counted
        As for `hodograph`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=0.1),))
    >>> ks.plots.rocking_moment(ks.Scene(pump, 200.0).solve(90)).get_ylabel()
    'rocking moment about y [N m]'
    """
    ax = hodograph(solutions, ROCKING, ax, marks, counted)
    for name, way in (("xlabel", "x"), ("ylabel", "y")):
        ax.set(**{name: ax.properties()[name].replace(f", {way}", f" about {way}")})
    return ax


@with_units
def hodographs(solutions, marks=90, counted=FROM_X):
    """Hodographs of the forces on the frame, a panel for each place of contact (`Solution.ground`).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        A panel shows the solutions with the place.
    marks, counted
        As for `hodograph`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> figure = ks.plots.hodographs(ks.load_case("sawframe_2r63").solve("cam-circle", 90))
    >>> [ax.get_title() for ax in figure.axes]
    ['O', 'cam', 'guide', 'spring']
    """
    marks = single_numbers("hodographs", marks=(marks, "deg", {"low": MIN_MARK_STEP}))["marks"]
    given = solutions_by_label(solutions, GROUND)
    found = {name: None for solution in given.values() for name, place in places(solution).items() if place.pushes}
    styles = {
        key: {"linestyle": style, "color": f"C{row}"} for row, (key, _, style) in enumerate(with_line_styles(given))
    }
    figure, several = panels(len(found), 2 if len(found) == 4 else MAX_COLUMNS, *PANEL_SIZE)
    for ax, place in zip(several, found, strict=True):
        name = f"{GROUND} {place}"
        having = {key: solution for key, solution in given.items() if name in of_scene(solution)}
        _, unit = _draw(ax, having, name, marks, counted, styles=styles)
        ax.margins(0.16)
        ax.set_title(place)
        ax.set_xlabel(f"x [{unit}]")
        ax.set_ylabel(f"y [{unit}]")
        if len(having) > 1 or isinstance(solutions, Mapping):
            ax.legend(frameon=False, fontsize="small")
    figure.suptitle("force of the machine on the frame")
    return figure


def _vector_name(solution, name):
    """Name of the vector quantity that is drawn: the quantity itself, or the force on the frame at a place."""
    vectors = [known for known, found in of_scene(solution).items() if found.vector]
    if name in vectors:
        return name
    if f"{GROUND} {name}" in vectors:
        return f"{GROUND} {name}"
    allowed = dict.fromkeys(known.removeprefix(f"{GROUND} ") for known in vectors)
    raise QuantityError(choice(f"{solution.mechanism.name}: force", name, tuple(allowed)))


def _in_axes(solution, vector, on):
    """The vector in the axes of a link."""
    links = solution.mechanism.links
    require("hodograph", choice(f"{solution.mechanism.name}: on", on, tuple(links)))
    return np.stack(np.broadcast_arrays(*rotate_back(vector, solution.placement.links[on].direction)))


def _draw(ax, given, name, marks, counted, on=None, styles=None):
    """Curves of a vector by label on axes with equal scales, in styles by label; returns its label and unit."""
    named = with_peaks(given, name)
    declared = of_scene(next(iter(named.values())))[name]
    whole = {key: declared.read(solution) for key, solution in named.items()}
    if on is not None:
        whole = {key: _in_axes(solution, whole[key], on) for key, solution in named.items()}
    factor, unit = display_unit(declared.unit, whole.values())
    sizes = [np.hypot(*curve) for curve in whole.values()]
    sight = drawn_limit(sizes)
    curves = {key: canvas.hidden_beyond(sight, curve) for key, curve in whole.items()}
    extents = {key: factor * extent for key, extent in _extents(curves, 2.0 * ordinary_size(sizes)).items()}
    whys: set[str] = set()
    for key, solution, style in with_line_styles(named):
        curve = factor * curves[key]
        (line,) = ax.plot(*close_curve(curve), label=key, **(styles[key] if styles else {"linestyle": style}))
        color = line.get_color()
        rows = [row for row in _rows_at_marks(solution, marks) if np.isfinite(curve[0, row])]
        ax.plot(*curve[:, rows], "o", ms=3, color=color)
        ends = list(canvas.curve_ends(solution, whole[key], curves[key]))
        for end in ends:
            cross, arrow = {"marker": "x", "ms": 6, "mew": 1.5}, {"marker": (3, 0, end.angle - 90.0), "ms": 8}
            ax.plot(*curve[:, end.row], ls="", color=color, zorder=4, **(cross if end.why else arrow))
        whys |= {end.why for end in ends if end.why}
        rows += [end.row for end in ends if end.row not in rows]
        near = max(0.03 * extents[key], 0.02 * max(extents.values()))
        write_angles(ax, solution, curve, rows, near, counted, color if len(named) > 1 else INK)
    ax.axhline(0, color=INK, lw=0.5)
    ax.axvline(0, color=INK, lw=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    notes = [f"× {why}" for why in sorted(whys)]
    if any(np.any(size > sight) for size in sizes):
        notes.insert(0, f"▸ beyond the frame: {canvas.size_text([factor * size for size in sizes], unit)}")
    if notes:
        canvas.write_notes(ax, notes)
    return declared.label, unit


def _extents(curves, most):
    """Width or height of each curve with the origin, up to a largest one."""
    drawn = {name: np.column_stack([np.nan_to_num(curve), (0.0, 0.0)]) for name, curve in curves.items()}
    return {name: min(np.ptp(curve, axis=1).max(), most) for name, curve in drawn.items()}


def write_angles(ax, solution, curve, rows, near, counted, color):
    """Write the crank angles of rows at points of a curve; points nearer than `near` share a label."""
    period = np.degrees(solution.period)
    degrees = counted(np.degrees(solution.crank_angle)[rows], period) % period
    for text, point in _merge_labels(degrees, curve[:, rows], near):
        label(ax, text, point, color=color)


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
