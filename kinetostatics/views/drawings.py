"""The mechanism itself: drawn at given crank angles, with the paths of its mass centre, and in motion."""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from ..errors import ParameterError
from ..machine.group import FRAME
from ..mechanics.motion import Motion
from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import magnitude
from ..numbers import checks
from . import symbols
from .canvas import ACCENT, INK, LOAD, STEEL, axes, closed, display, labelled, single, styled
from .labels import label
from .shape import Shape

LINES: dict[str, dict[str, Any]] = {
    "bar": {"color": STEEL, "lw": 2.5, "solid_capstyle": "round", "zorder": 2},
    "slotted": {"color": STEEL, "lw": 7, "solid_capstyle": "round", "zorder": 2},
    "slot": {"color": "white", "lw": 3.5, "solid_capstyle": "round", "zorder": 2.1},
    "spring": {"color": INK, "lw": 1, "zorder": 2.5},
    "damper": {"color": INK, "lw": 1, "zorder": 2.5},
    "outline": {"color": ACCENT, "lw": 0.9, "ls": "-.", "zorder": 1.6},
    "line": {"color": INK, "lw": 0.8, "ls": "--", "zorder": 2.5},
    "force": {"color": LOAD, "lw": 1.5, "zorder": 5},
}
"""How each kind of stroke is drawn as a line."""
PLATES: dict[str, dict[str, Any]] = {
    "counterweight": {"fc": "0.75", "ec": "0.5", "lw": 0.8, "zorder": 1.5},
    "plate": {"fc": "lightsteelblue", "ec": STEEL, "lw": 1.5, "zorder": 1.8},
    "block": {"fc": STEEL, "ec": "none", "zorder": 3},
}
"""How each kind of stroke is drawn as a filled shape."""
PIN = {"marker": "o", "ms": 5, "mfc": "white", "mec": INK}
MASS_CENTRE: tuple[dict[str, Any], ...] = (
    {"marker": "o", "ms": 8, "mfc": "white", "mec": INK, "mew": 0.8, "zorder": 3.5},
    {"marker": symbols.MASS_CENTRE, "ms": 8, "mfc": INK, "mec": "none", "zorder": 3.6},
)
MOST = 0.9
"""Share of the poses at which the arrow of a reaction that grows without bound is drawn as it is."""


def mass_centres(solutions, angle=60, ax=None):
    """Paths of the common mass centre, to one scale with the mechanism (mower study, figures 5a, 5b).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        Mechanisms of one geometry, with different masses; the first is drawn.
    angle : float
        Crank angle of the drawing, degrees, marked on every path.
    ax : Axes, optional

    Returns
    -------
    Axes
        With equal scales on both axes.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bare = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> balanced = ks.balancing.partial(bare, crank=ks.Counterweight(arm=-0.05)).mechanism
    >>> solutions = {name: ks.Scene(item, 62.8).solve(90) for name, item in (("bare", bare), ("half", balanced))}
    >>> ks.plots.mass_centres(solutions).get_aspect()
    1.0
    """
    checks.require("mass_centres", checks.finite("angle", angle))
    named = labelled(solutions, "common mass centre")
    ax = mechanism(next(iter(named.values())), angles=(angle,), ax=ax)
    for name, solution, style in styled(named):
        points = principal_points(solution.mechanism)
        (line,) = ax.plot(*closed(points.mass_centre(solution)), linestyle=style, label=name, zorder=5)
        ax.plot(*points.mass_centre(_posed(solution, [angle])), "o", ms=4, color=line.get_color(), zorder=6)
    ax.legend(frameon=False, fontsize="small", title="path of the common mass centre", title_fontsize="small")
    return ax


def mechanism(solution, angles=(40, 160, 280), ax=None):
    """The mechanism at given crank angles: links, fixed pivots, guides, cam (pitch curve), mass centres and loads.

    Loads, counterweights, joint names and mass centres are drawn in the first pose. Arrows point as the
    force or torque acts there; where it is zero or not known, as at its largest, and as positive ones of functions.

    Parameters
    ----------
    solution : Solution
    angles : sequence of float
        Crank angles, degrees; the first is drawn strongest.
    ax : Axes, optional

    Returns
    -------
    Axes
        With equal scales on both axes.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> shaper = ks.slotted_lever(0.1, pivot=(0.0, -0.2), lever=ks.Link(8.0, 0.3, 0.4))
    >>> ks.plots.mechanism(ks.Scene(shaper, 6.0, loads=[ks.Gravity()]).solve(8), angles=(60,)).get_aspect()
    1.0
    """
    try:
        angles = np.atleast_1d(np.asarray(angles, dtype=float))
    except (TypeError, ValueError):
        raise ParameterError(f"mechanism: angles must be numbers, in degrees, got {angles!r}") from None
    checks.require(
        "mechanism", None if angles.ndim == 1 and np.isfinite(angles).all() else f"angles must be finite, got {angles}"
    )
    solution, ax = single(solution), axes(ax)
    shape, poses = _frame(ax, solution), _posed(solution, angles)
    shades = np.linspace(1.0, 0.3, len(angles))
    strokes, first = list(shape.strokes(poses)), _posed(solution, angles[:1])
    once = [*shape.counterweights(first), *shape.signs(solution.loads, first)]
    moving = [name for name, point in shape.made.joints.items() if point.link != FRAME]
    for row, shade in enumerate(shades):
        for stroke in strokes + (once if row == 0 else []):
            _set(_artist(ax, stroke, shade), stroke.points[..., row])
        for joint in moving:
            ax.plot(*poses.position(joint)[:, row], **PIN, alpha=shade, zorder=4)
    for name in shape.heavy:
        for style in MASS_CENTRE:
            ax.plot(*poses.position(name)[:, 0], **style)
    for names, point in _together(poses, shape):
        label(ax, ", ".join(names), point, color=INK, fontsize="small")
    for row, (angle, shade) in enumerate(zip(angles, shades, strict=True)):
        label(ax, f"{angle:g}°", poses.position(_leading(poses.mechanism))[:, row], alpha=shade)
    _equal(ax)
    return ax


def animation(solution, joints=None, frames=72, interval=50, ax=None):
    """Animation of the mechanism over the period of its motion and loads, with arrows for the joint reactions.

    Show it in a notebook by ``HTML(animation.to_jshtml())``, or save it by ``animation.save("saw.gif")``.

    Parameters
    ----------
    solution : Solution
    joints : sequence of str, optional
        Reactions drawn as arrows from the joints that they act at ("guide" at B), of those at O, A and B the ones that
        it has unless told; the largest of all is as long as the crank. NaN where the mechanism does not close draws
        nothing.
    frames : int
        Poses shown, of the solution's crank angles; where these are less than a period, over the whole of it, unless
        the solution holds tables over its crank angles.
    interval : float
        Time between them, ms.
    ax : Axes, optional

    Returns
    -------
    matplotlib.animation.FuncAnimation

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5).solve(8)
    >>> film = ks.plots.animation(s, joints=["O"], frames=2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     film.save(Path(folder, "saw.gif"), writer="pillow", dpi=40)
    """
    from matplotlib.animation import FuncAnimation

    solution, ax = single(solution), axes(ax)
    if joints is None:
        joints = [name for name in ("O", "A", "B") if name in solution.mechanism.outputs]
    joints = (joints,) if isinstance(joints, str) else tuple(joints)
    checks.require(
        "animation",
        checks.count("frames", frames),
        checks.positive("interval", interval),
        None if joints else "joints must name at least one reaction",
    )
    solution = _whole(solution, frames)
    count = solution.crank_angle.size
    steps = np.linspace(0, count, min(frames, count), endpoint=False).astype(int)
    shape, made = _frame(ax, solution), solution.mechanism
    strokes = [*shape.counterweights(solution), *shape.strokes(solution), *shape.signs(solution.loads, solution)]
    parts = [_artist(ax, stroke, 1.0) for stroke in strokes]
    moving = [name for name, point in made.joints.items() if point.link != FRAME]
    spots = [(name, {**PIN, "zorder": 4}) for name in moving]
    spots += [(name, style) for name in shape.heavy for style in MASS_CENTRE]
    marks = [ax.plot([], [], **style)[0] for _, style in spots]
    positions = [solution.position(name) for name, _ in spots]
    forces = [_cut(solution, joint) for joint in joints]
    largest = max(_largest(magnitude(force)) for force in forces)
    length = _largest(magnitude(solution.position(_leading(made))))
    starts = [solution.position(made.outputs[joint].at or joint) for joint in joints]
    arrows = ax.quiver(
        *np.zeros((2, len(joints))),
        *np.zeros((2, len(joints))),
        angles="xy",
        scale_units="xy",
        scale=(largest or 1.0) / length,
        color=ACCENT,
        width=0.005,
        zorder=5,
    )
    factor, shown = display("N", [largest])
    ax.set_title(f"reactions at {', '.join(joints)}; longest arrow {factor * largest:.4g} {shown}", fontsize="small")
    caption = ax.text(0.02, 0.94, "", transform=ax.transAxes, fontsize="small")
    paths = np.concatenate([*positions, *(stroke.points.reshape(2, -1) for stroke in strokes)], axis=1)
    _equal(ax, paths[:, np.isfinite(paths).all(axis=0)].T)

    def draw(step):
        for part, stroke in zip(parts, strokes, strict=True):
            _set(part, stroke.points[..., step])
        for mark, position in zip(marks, positions, strict=True):
            mark.set_data(position[:, [step]])
        arrows.set_offsets(np.array([start[:, step] for start in starts]))
        arrows.set_UVC(*np.array([force[:, step] for force in forces]).T)
        caption.set_text(f"crank angle {np.degrees(solution.crank_angle[step]):.0f}°")
        return [*parts, *marks, arrows, caption]

    return FuncAnimation(ax.figure, draw, frames=steps, interval=interval)


def _whole(solution, frames):
    """The solution over its whole period, at its own crank angles if they are enough of it."""
    angle, period = np.sort(solution.crank_angle), solution.period
    step = np.median(np.diff(angle)) if angle.size > 1 else 0.0
    if angle[-1] - angle[0] + 1.5 * step >= period:
        return solution
    try:
        return solution.at(angle[0] + np.linspace(0.0, period, max(frames, 2), endpoint=False))
    except ParameterError:
        return solution


def _largest(values):
    finite = values[np.isfinite(values)]
    return float(np.max(finite, initial=0.0)) or 1.0


def _frame(ax, solution):
    """What does not move: fixed pivots, guides over the stroke, the pitch curve of the cam or the crank circle."""
    made = solution.mechanism
    turn = _posed(solution, np.linspace(0, 360 * made.turns, 720 * made.turns + 1))
    shape = Shape(turn)
    for joint, text in made.curves.items():
        ax.plot(*turn.position(joint), color=ACCENT, lw=1, ls="--", label=text)
    for bar in made.crank.bars:
        ax.plot(*turn.position(bar.end), color=INK, lw=0.5, ls=":")
    for slider, guide in made.guides.items():
        along = np.asarray(guide.direction, dtype=float)
        below, reach = 0.6 * shape.unit * symbols.left(along), 1.5 * shape.unit * along
        start, end = shape.ways[slider].T
        rail = symbols.hatched(start - reach - below, end + reach - below, 0.5 * shape.unit)
        ax.plot(*rail, color=INK, lw=0.8, alpha=0.6, zorder=1)
    for point in shape.grounds(solution.loads):
        ax.plot(*point, marker=symbols.PIVOT, ms=18, mfc="0.85", mec=INK, mew=0.8, zorder=1.6)
        ax.plot(*point, **PIN, zorder=4)
    return shape


def _posed(solution, degrees):
    """The mechanism at other crank angles, whatever its loads; of its speed only which way the crank turns."""
    ways = np.unique(np.sign(solution.crank_speed))
    return Motion(solution.mechanism, np.radians(degrees), float(ways[0]) if ways.size == 1 else 0.0, 0.0)


def _cut(solution, joint):
    """Reaction at a joint; near change points that are passed, where it grows without bound, no longer than most."""
    force = solution.reaction(joint)
    if not solution.mechanism.grows(joint):
        return force
    size = magnitude(force)
    most = np.nanquantile(np.where(np.isfinite(size), size, np.nan), MOST)
    with np.errstate(invalid="ignore"):
        return np.where(size > most, np.nan_to_num(force / size, nan=0.0) * most, force)


def _leading(made):
    """First joint that moves, from the crank outwards; O where none does."""
    return next((name for name, point in made.joints.items() if point.link != FRAME), "O")


def _together(poses, shape):
    """Names of joints with their place in the first pose, those that coincide together."""
    found: list[tuple[list[str], Any]] = []
    for name in shape.made.joints:
        place = poses.position(name)[:, 0]
        near = (names for names, other in found if np.hypot(*(place - other)) < 1e-6 * shape.size)
        names = next(near, None)
        if names is None:
            found.append(([name], place))
        else:
            names.append(name)
    return found


def _artist(ax, stroke, shade):
    """What a stroke is drawn by, still empty."""
    if stroke.kind in PLATES:
        return ax.add_patch(Polygon(np.full((3, 2), np.nan), alpha=shade, **PLATES[stroke.kind]))
    return ax.add_line(Line2D([], [], alpha=shade, **LINES[stroke.kind]))


def _set(artist, points):
    """Give what a stroke is drawn by its points (2, K)."""
    if isinstance(artist, Line2D):
        artist.set_data(points)
    else:
        artist.set_xy(points.T)


def _equal(ax, moving=()):
    """Equal scales, for what is drawn and for what moves, places (N, 2)."""
    ax.relim()
    if len(moving):
        ax.update_datalim(moving)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.autoscale_view()
