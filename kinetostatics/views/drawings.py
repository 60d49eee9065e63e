"""Drawings of the mechanism at given crank angles."""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.path import Path

from ..machine.group import FRAME
from ..numbers import checks
from .axis_units import with_units
from .cams import ANGLES_RULE
from .canvas import (
    ACCENT,
    FROM_X,
    INK,
    LOAD,
    STEEL,
    axes,
    grouped,
    set_equal_scales,
    solutions_by_label,
)
from .labels import label
from .strokes import Shape, at_angles, moving_surfaces, strokes_by_owner, whole_turn, working_curves

PIN = {"marker": "o", "ms": 5, "mfc": "white", "mec": INK}
_quarters = [Path.wedge(0, 90), Path.wedge(180, 270)]
MASS_CENTRE_PATH = Path.make_compound_path(*_quarters)
"""Dark quarters of the sign of a mass centre, as a marker."""
_ticks = np.arange(-0.8, 1.01, 0.4)
PIVOT = Path.make_compound_path(
    Path([(0, 0), (-0.7, -1.0), (0.7, -1.0), (0, 0)]),
    Path([(-1.0, -1.0), (1.0, -1.0)]),
    *(Path([(x, -1.0), (x - 0.3, -1.4)]) for x in _ticks),
)
"""A fixed pivot on hatched ground, as a marker with the pivot at its middle."""
MASS_CENTRE: tuple[dict[str, Any], ...] = (
    {"marker": "o", "ms": 8, "mfc": "white", "mec": INK, "mew": 0.8, "zorder": 3.5},
    {"marker": MASS_CENTRE_PATH, "ms": 8, "mfc": INK, "mec": "none", "zorder": 3.6},
)
GRAVITY_PLACE, GRAVITY_LENGTH = (0.93, 0.12), 30.0
"""Tip of the arrow of gravity, shares of the axes, and its length, typographic points."""
DOWNWARDS = np.cos(np.radians(1.0))
"""Cosine of the largest angle from -y without an arrow of gravity."""
COUNTERWEIGHT_KINDS = ("counterweight", "bar")
"""Kinds of strokes in counterweights."""
LINES: dict[str, dict[str, Any]] = {
    "bar": {"color": STEEL, "lw": 2.5, "solid_capstyle": "round", "zorder": 2},
    "slotted": {"color": STEEL, "lw": 7, "solid_capstyle": "round", "zorder": 2},
    "slot": {"color": "white", "lw": 3.5, "solid_capstyle": "round", "zorder": 2.1},
    "spring": {"color": INK, "lw": 1, "zorder": 2.5},
    "damper": {"color": INK, "lw": 1, "zorder": 2.5},
    "outline": {"color": ACCENT, "lw": 0.9, "ls": "-.", "zorder": 1.6},
    "surface": {"color": INK, "lw": 1.2, "zorder": 1.6},
    "tie": {"color": INK, "lw": 0.6, "zorder": 1.9},
    "line": {"color": INK, "lw": 0.8, "ls": "--", "zorder": 2.5},
    "force": {"color": LOAD, "lw": 1.5, "zorder": 5},
}
"""Styles of strokes drawn as lines, by kind."""
PLATES: dict[str, dict[str, Any]] = {
    "counterweight": {"fc": "0.75", "ec": "0.5", "lw": 0.8, "zorder": 1.5},
    "plate": {"fc": "lightsteelblue", "ec": STEEL, "lw": 1.5, "zorder": 1.8},
    "block": {"fc": STEEL, "ec": "none", "zorder": 3},
    "roller": {"fc": "none", "ec": INK, "lw": 1.0, "zorder": 3.2},
}
"""Styles of strokes drawn as filled shapes, by kind."""
MIN_TEXT_SHADE = 0.6
"""Smallest opacity of a crank angle beside a pose."""
GROUND_DEPTH = 3.0
"""Depth of the ground below a fixed pivot, in half lengths of a block."""


@with_units
def mechanism(solutions, angles=(40, 160, 280), ax=None, counted=FROM_X):
    """The mechanism at given crank angles: links, fixed pivots, guides, cams, mass centres and loads.

    A cam has its pitch curve and, if the radius of the roller is known, the working curve on each side that carries
    force. Loads, counterweights, joint names and mass centres are drawn in the first pose. An arrow "g" in the corner
    shows the direction of weight that does not act along -y. Arrows of loads point as the force or torque
    acts there; where it is zero or unknown, as at its largest magnitude; for functions, as a positive one.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        Several machines must have the same motion: the first is drawn, with the counterweights and loads of each.
    angles : sequence of float
        Crank angles, degrees; the first is drawn strongest.
    counted : AngleConvention
        Convention for the labels of crank angles; `angles` are from +x.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> shaper = ks.slotted_lever(0.1, pivot=(0.0, -0.2), lever=ks.Link(8.0, 0.3, 0.4))
    >>> ks.plots.mechanism(ks.Scene(shaper, 6.0, loads=[ks.Gravity()]).solve(8), angles=(60,)).get_aspect()
    1.0
    """
    angles = np.atleast_1d(checks.check_values("mechanism", ANGLES_RULE, {"angles": angles})["angles"])
    checks.require("mechanism", None if angles.ndim == 1 else f"angles must be a row of numbers, got {angles}")
    named, ax = solutions_by_label(solutions, ""), axes(ax)
    shades = np.linspace(1.0, 0.3, len(angles))
    poses = draw_poses(ax, named, angles, shades)
    moving = [poses.position(name) for name, point in poses.mechanism.joints.items() if point.link != FRAME]
    gaps = np.any(np.isnan(moving), axis=(0, 1))
    for row, (angle, shade) in enumerate(zip(angles, shades, strict=True)):
        text = f"{counted(angle):g}°{': cannot be assembled' if gaps[row] else ''}"
        label(ax, text, poses.position(first_moving_joint(poses.mechanism))[:, row], alpha=max(shade, MIN_TEXT_SHADE))
    return ax


def draw_poses(ax, named, angles, shades):
    """Draw machines by label at crank angles, degrees, each pose in a shade; returns the motion of the first."""
    solution = next(iter(named.values()))
    shape, poses = draw_fixed_parts(ax, solution), at_angles(solution, angles)
    strokes = [*shape.strokes(poses), *moving_surfaces(solution, poses)]
    owned = strokes_by_owner(named, angles[:1])
    once = [stroke for stroke, owners in owned if len(owners) == len(named)] + list(shape.ties(poses, solution.loads))
    moving = [name for name, point in shape.mechanism.joints.items() if point.link != FRAME]
    for row, shade in enumerate(shades):
        for stroke in strokes + (once if row == 0 else []):
            set_points(stroke_artist(ax, stroke, shade), stroke.points[..., row])
        for joint in moving:
            ax.plot(*poses.position(joint)[:, row], **PIN, alpha=shade, zorder=4)
    for name in shape.heavy:
        for style in MASS_CENTRE:
            ax.plot(*poses.position(name)[:, 0], **style)
    places = {name: poses.position(name)[:, 0] for name in shape.mechanism.joints}
    for names in grouped(places, lambda one, other: np.hypot(*(places[other] - places[one])) < 1e-6 * shape.size):
        label(ax, ", ".join(names), places[names[0]], color=INK, fontsize="small")
    _draw_own(ax, [(stroke, owners) for stroke, owners in owned if len(owners) < len(named)])
    _draw_gravity(ax, solution.dynamics.gravity)
    set_equal_scales(ax, [point - [0.0, GROUND_DEPTH * shape.half_block] for point in shape.grounds(solution.loads)])
    return poses


def _draw_gravity(ax, gravity):
    """Draw an arrow along gravity in the lower right corner, unless it acts along -y or is zero."""
    along = np.zeros(2) if gravity is None else np.ravel(gravity)
    size = np.hypot(*along)
    if size == 0.0 or along[1] < -DOWNWARDS * size:
        return
    frame = {"xycoords": "axes fraction", "textcoords": "offset points"}
    style = {"ha": "center", "va": "center", "fontsize": "small", "color": INK}
    arrow = {"arrowstyle": "-|>", "color": INK}
    ax.annotate("g", GRAVITY_PLACE, -GRAVITY_LENGTH * along / size, **frame, **style, arrowprops=arrow)


def _draw_own(ax, strokes):
    """Draw strokes of only some machines, in colours by machine, with a legend."""
    colours: dict[str, Any] = {}
    for stroke, owners in strokes:
        text = f"{'counterweight' if stroke.kind in COUNTERWEIGHT_KINDS else 'load'}: {', '.join(owners)}"
        known = text in colours
        colour = colours.setdefault(text, f"C{len(colours)}")
        drawn = stroke_artist(ax, stroke, 1.0)
        drawn.set(color=colour) if isinstance(drawn, Line2D) else drawn.set(fc=(colour, 0.12), ec=colour, alpha=None)
        drawn.set_label("_" if known else text)
        set_points(drawn, stroke.points[..., 0])
    if colours:
        ax.legend(frameon=False, fontsize="small", loc="upper right")


def draw_fixed_parts(ax, solution):
    """Draw fixed pivots, guides over the stroke, the pitch curve of the cam and the crank circle; return the shape."""
    made = solution.mechanism
    turn = whole_turn(solution)
    shape = Shape(turn)
    for joint, text in made.curves.items():
        ax.plot(*turn.position(joint), color=ACCENT, lw=1, ls="--", label=text)
    for body, points in working_curves(solution):
        if body == FRAME:
            ax.plot(*points, label="working curve of the cam", **LINES["surface"])
    for bar in made.crank.bars:
        ax.plot(*turn.position(bar.end), color=INK, lw=0.5, ls=":")
    for rail in shape.rails():
        ax.plot(*rail, color=INK, lw=0.8, alpha=0.6, zorder=1)
    for point in shape.grounds(solution.loads):
        ax.plot(*point, marker=PIVOT, ms=18, mfc="0.85", mec=INK, mew=0.8, zorder=1.6)
        ax.plot(*point, **PIN, zorder=4)
    return shape


def first_moving_joint(made):
    """Name of the first moving joint, from the crank outwards; O if there is none."""
    return next((name for name, point in made.joints.items() if point.link != FRAME), "O")


def stroke_artist(ax, stroke, shade):
    """Empty matplotlib artist of a stroke."""
    if stroke.kind in PLATES:
        return ax.add_patch(Polygon(np.full((3, 2), np.nan), alpha=shade, **PLATES[stroke.kind]))
    return ax.add_line(Line2D([], [], alpha=shade, **LINES[stroke.kind]))


def set_points(drawn, points):
    """Set the points (2, K) of a stroke's artist."""
    if isinstance(drawn, Line2D):
        drawn.set_data(points)
    else:
        drawn.set_xy(points.T)
