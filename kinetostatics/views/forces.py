"""Figures of forces: shares of a force by source, and the free body of a link."""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from ..errors import ParameterError
from ..mechanics.free_body import DRIVE, INERTIA, LOAD, REACTION, WEIGHT
from ..mechanics.free_body import free_body as actions_on
from ..numbers import checks
from ..numbers.formatting import number
from .axis_units import one_panel_each, with_units
from .canvas import ACCENT, INK, STEEL, axes, display_unit, set_equal_scales, single_solution
from .drawings import MASS_CENTRE, PIN, set_points, stroke_artist
from .labels import label
from .strokes import Shape, left, whole_turn

BAR_HEIGHT = 0.38
ROW_HEIGHT = 0.5
"""Height of a row in a separate figure, inches."""
COLOURS = {REACTION: STEEL, INERTIA: ACCENT, WEIGHT: "tab:brown", LOAD: "tab:green", DRIVE: "tab:purple"}
"""Colours of arrows by kind of action."""


@with_units
@one_panel_each(7.0, 4.2, pad=22.0)
def shares(solution, quantity, ax=None):
    """Shares of all sources in a force or moment at its peak, a bar for each, with the peak of each single source.

    With friction the bars are effects of leaving out a source (`Solution.shares`).

    Parameters
    ----------
    solution : Solution or mapping of label to Solution
        Of one design. Several get a panel each.
    quantity : str
        As for `Solution.shares`: "O", "balancing_torque" ...

    Raises
    ------
    QuantityError, ParameterError, JammingError
        As for `Solution.shares`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> ax = ks.plots.shares(ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(8), "O")
    >>> ax.get_xlabel()
    'share of reaction O [kN]'
    >>> [text.get_text() for text in ax.get_yticklabels()][:2]
    ['inertia of coupler', 'inertia of slider']
    """
    checks.require("shares", checks.solution("solution", solution))
    found = solution.shares(quantity)
    rows = (*found.rows, found.total)
    own_figure, ax = ax is None, axes(ax)
    if own_figure:
        ax.figure.set_figheight(max(ax.figure.get_figheight(), ROW_HEIGHT * len(rows)))
    factor, unit = display_unit(found.unit, [np.array([row.peak for row in rows])])
    values, peaks = (factor * np.array(part) for part in zip(*((row.value, row.peak) for row in rows), strict=True))
    places = np.arange(len(rows))
    names = "at the peak of the total", "largest, of this source alone" if found.superposed else "largest effect"
    for shift, sizes, text, colour in ((-0.5, values, names[0], ACCENT), (0.5, peaks, names[1], "0.75")):
        bars = ax.barh(places + shift * BAR_HEIGHT, sizes, 0.94 * BAR_HEIGHT, label=text, color=colour)
        ax.bar_label(bars, [number(value, 4) for value in sizes], padding=3, fontsize="small")
    ax.set_yticks(places, [row.source for row in rows])
    ax.axhline(len(rows) - 1.5, color=INK, lw=0.5)
    ax.invert_yaxis()
    ax.axvline(0.0, color=INK, lw=0.8)
    of = "share of" if found.superposed else "effect on"
    ax.set_xlabel(f"{of} {found.label} [{unit}]")
    ax.margins(x=0.18)
    ax.grid(axis="x", alpha=0.3)
    ax.set_axisbelow(True)
    ax.legend(frameon=False, fontsize="small", loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return ax


# Free body

LONGEST_ARROW = 0.45
"""Length of the longest arrow, relative to the extent of the link."""
MIN_EXTENT = 12.0
"""Least extent of a link, in half lengths of a block."""
HEAD, COUPLE_RADIUS, ARROW_GAP = 0.08, 0.12, 0.05
"""Length of arrow heads, radius of the first arc and distance of arrows side by side, relative to the longest arrow."""
ARC, ARC_START, ARC_TURN = np.radians((250.0, 150.0, 115.0))
"""Angle of the arc of a couple, start of the first arc, and step between arcs at the same point."""
SAME_DIRECTION = np.cos(np.radians(12.0))
"""Cosine of the largest angle between arrows at one point that are drawn side by side."""
PRESSING = 0.5
"""Cosine of the largest angle from the mass centre of a pressing force, whose arrow ends at its point."""
MIN_DRAWN = 1e-9
"""Force, relative to the largest, below which there is no arrow."""
SCALE_SHARES = (1.0, 2.0, 5.0)
LABEL_MARGIN = 0.28
"""Margin left and right of the arrows for their values, relative to the width of the drawing."""


@with_units
@one_panel_each(5.2, 4.8, 2)
def free_body(solution, link, angle, ax=None):
    """Free body of a link: all forces on it as arrows to one scale, couples as arcs, with their values.

    Joint reactions, inertia force at the mass centre (-m a) with the couple -I alpha, weight, loads, and on the crank
    the balancing torque; together they are zero. Friction is in the reactions. An arrow points at its point where the
    force presses on the link there, otherwise it starts there; overlapping arrows are drawn side by side.

    Parameters
    ----------
    solution : Solution or mapping of label to Solution
        Of one design. Several get a panel each.
    link : str
        "crank", "coupler", "slider" ...
    angle : float
        Crank angle, degrees; it need not be one of those solved.

    Raises
    ------
    QuantityError
        The link is unknown; the message lists the known ones.
    AssemblyError, JammingError
        The mechanism does not close at that crank angle, or friction jams.
    ParameterError
        The solution is a batch of designs, or forces grow without bound there; or a group of your own does not declare
        the pairs that load the link.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> s = ks.Scene(saw, 33.5, loads=[ks.Gravity()]).solve(8)
    >>> ks.plots.free_body(s, "coupler", 60).get_title()
    'coupler at crank angle 60°'
    """
    angle = checks.single_numbers("free_body", angle=(angle, "deg", {}))["angle"]
    checks.require("free_body", checks.solution("solution", solution))
    solution = single_solution(solution.at(np.radians([angle]))).check()
    actions = actions_on(solution.dynamics, link)
    if not all(np.isfinite(part).all() for item in actions for part in (item.force, item.couple)):
        raise ParameterError(f"free_body: forces on the {link} grow without bound at crank angle {angle:g} deg")
    ax, shape = axes(ax), Shape(whole_turn(solution))
    extent = _draw_link(ax, shape, solution, link)
    _draw_forces(ax, actions, link, extent, solution.position(link)[:, 0])
    _draw_couples(ax, actions, link, LONGEST_ARROW * extent)
    ax.set_title(f"{link} at crank angle {angle:g}°", fontsize="medium")
    kinds = dict.fromkeys(item.kind for item in actions)
    handles = [Line2D([], [], color=COLOURS[kind], lw=2.0, label=kind) for kind in kinds]
    ax.legend(
        handles=handles, frameon=False, fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=5
    )
    set_equal_scales(ax)
    ax.margins(x=LABEL_MARGIN, y=0.15)
    return ax


def _draw_link(ax, shape, solution, link):
    """Draw a link in its pose with its joints and mass centre; its extent, m."""
    strokes = [*shape.strokes(solution, (link,)), *shape.ties(solution, solution.loads, (link,))]
    for stroke in strokes:
        set_points(stroke_artist(ax, stroke, 0.55), stroke.points[..., 0])
    places = [solution.position((link, *corner))[:, 0] for corner in shape.corners[link].T]
    for place in places:
        ax.plot(*place, **PIN, zorder=4)
    if link in shape.heavy:
        for style in MASS_CENTRE:
            ax.plot(*solution.position(link)[:, 0], **style)
    outlines = [stroke.points[..., 0].T for stroke in strokes]
    return max(float(np.nanmax(np.ptp(np.concatenate([places, *outlines]), axis=0))), MIN_EXTENT * shape.half_block)


def _draw_forces(ax, actions, link, extent, middle):
    """Draw the forces to one scale with their values, and the scale."""
    sizes = [float(np.hypot(*item.force[:, 0])) for item in actions]
    largest = max(sizes, default=0.0)
    shown = [(item, size) for item, size in zip(actions, sizes, strict=True) if size > MIN_DRAWN * largest]
    if not shown:
        return
    scale, gap = LONGEST_ARROW * extent / largest, ARROW_GAP * LONGEST_ARROW * extent
    factor, unit = display_unit("N", [np.array(sizes)])
    arrows: list[Any] = []  # points and the directions from them
    for item, size in shown:
        point, along = item.point[:, 0], item.force[:, 0] / size
        presses = along @ (middle - point) > PRESSING * np.hypot(*(middle - point))
        away = -along if presses else along
        near = [way for other, way in arrows if np.hypot(*(point - other)) < ARROW_GAP * extent]
        beside = sum(bool(away @ way > SAME_DIRECTION) for way in near)
        arrows.append((point, away))
        start = point + left(away) * gap * (-1) ** beside * ((beside + 1) // 2)
        far = start + away * size * scale
        tail, tip = (far, start) if presses else (start, far)
        _draw_arrow(ax, tail, tip, HEAD * LONGEST_ARROW * extent, COLOURS[item.kind])
        text = f"{_short(item, link)} {number(factor * size, 4)} {unit}"
        label(ax, text, far, color=COLOURS[item.kind], fontsize="small")
    _draw_scale(ax, scale / factor, factor * largest, unit, gap)


def _draw_arrow(ax, tail, tip, head, colour):
    """Arrow from tail to tip, (2,) each; its head is shorter on a short arrow."""
    length = np.hypot(*(tip - tail))
    along = (tip - tail) / length
    head = min(head, 0.5 * length)
    ax.plot(*np.transpose([tail, tip - 0.5 * head * along]), color=colour, lw=1.8, zorder=5, solid_capstyle="butt")
    _draw_head(ax, tip, along, head, colour)


def _draw_head(ax, tip, along, head, colour):
    barbs = [tip - head * along + side * 0.4 * head * left(along) for side in (1.0, -1.0)]
    ax.add_patch(Polygon([tip, *barbs], fc=colour, ec="none", zorder=5))


def _draw_scale(ax, scale, largest, unit, gap):
    """Bar of a round force to the scale of the arrows, below the drawing."""
    power = 10.0 ** np.floor(np.log10(0.5 * largest))
    size = max(share * power for share in SCALE_SHARES if share * power <= 0.5 * largest)
    ax.relim()
    low = ax.dataLim.min - [0.0, 4.0 * gap]
    bar = np.transpose([low, low + [size * scale, 0.0]])
    ax.plot(*bar, color=INK, lw=1.2, marker="|", ms=6)
    label(ax, f"{number(size)} {unit}", bar[:, 1], color=INK)


def _draw_couples(ax, actions, link, longest):
    """Draw the couples as arcs with their values; several at one point around each other."""
    moments = [abs(float(part[0])) for item in actions for part in (item.couple, item.moment())]
    floor = MIN_DRAWN * max(moments, default=0.0)
    shown = [item for item in actions if abs(item.couple[0]) > floor]
    factor, unit = display_unit("N m", [np.array([item.couple[0] for item in shown])])
    for place, item in enumerate(shown):
        row = sum(
            bool(np.hypot(*(other.point - item.point)[:, 0]) < longest * COUPLE_RADIUS) for other in shown[:place]
        )
        radius, sense = COUPLE_RADIUS * longest * (1.0 + 0.5 * row), np.sign(item.couple[0])
        turned = ARC_START + row * ARC_TURN + sense * np.linspace(0.0, ARC, 40)
        points = item.point + radius * np.array([np.cos(turned), np.sin(turned)])
        colour, head = COLOURS[item.kind], HEAD * longest
        ax.plot(*points, color=colour, lw=1.5, zorder=5)
        along = points[:, -1] - points[:, -3]
        along = along / np.hypot(*along)
        _draw_head(ax, points[:, -1] + 0.5 * head * along, along, head, colour)
        text = f"{_short(item, link)} {number(factor * item.couple[0], 4)} {unit}"
        label(ax, text, points[:, 20], color=colour, fontsize="small")


def _short(item, link):
    """Name of an action without the link that it is drawn on."""
    return item.name.replace(f" on {link!r}", "")
