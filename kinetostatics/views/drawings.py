"""The mechanism itself: drawn at given crank angles, with the paths of its mass centre, and in motion."""

import numpy as np

from ..errors import ParameterError
from ..machine.group import FRAME
from ..mechanics.motion import Motion
from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import magnitude
from ..numbers import checks
from .canvas import ACCENT, INK, STEEL, axes, closed, display, labelled, single, styled

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
    """The mechanism at given crank angles, with its hinges, guide, and cam (pitch curve).

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
    """
    try:
        angles = np.atleast_1d(np.asarray(angles, dtype=float))
    except (TypeError, ValueError):
        raise ParameterError(f"mechanism: angles must be numbers, in degrees, got {angles!r}") from None
    checks.require(
        "mechanism", None if angles.ndim == 1 and np.isfinite(angles).all() else f"angles must be finite, got {angles}"
    )
    solution, ax = single(solution), axes(ax)
    _frame(ax, solution)
    shades = np.linspace(1.0, 0.3, len(angles))
    for angle, shade in zip(angles, shades, strict=True):
        pose = _posed(solution, [angle])
        for bar, (x, y) in zip(_bars(ax, pose, shade), _bar_lines(pose), strict=True):
            bar.set_data(x, y)
        for joint in _sliding(pose.mechanism):
            ax.plot(*pose.position(joint), "s", ms=13, mfc=STEEL, mec="none", alpha=shade, zorder=3)
        for joint in pose.placement.joints:
            ax.plot(*pose.position(joint), "o", ms=5, mfc="white", mec=INK, alpha=shade, zorder=4)
        ax.annotate(
            f"{angle:g}°",
            pose.position(_leading(pose.mechanism))[:, 0],
            xytext=(5, 5),
            textcoords="offset points",
            fontsize="x-small",
            alpha=shade,
        )
    _equal(ax)
    return ax


def animation(solution, joints=("O", "A", "B"), frames=72, interval=50, ax=None):
    """Animation of the mechanism over one turn, with arrows for the joint reactions.

    Show it in a notebook by ``HTML(animation.to_jshtml())``, or save it by ``animation.save("saw.gif")``.

    Parameters
    ----------
    solution : Solution
    joints : sequence of str
        Reactions drawn as arrows from the joints that they act at ("guide" at B); the largest of all is as long as
        the crank. NaN where the mechanism does not close draws nothing.
    frames : int
        Poses shown, of the solution's crank angles.
    interval : float
        Time between them, ms.
    ax : Axes, optional

    Returns
    -------
    matplotlib.animation.FuncAnimation
    """
    from matplotlib.animation import FuncAnimation

    solution, ax = single(solution), axes(ax)
    joints = (joints,) if isinstance(joints, str) else tuple(joints)
    checks.require(
        "animation",
        checks.count("frames", frames),
        checks.positive("interval", interval),
        None if joints else "joints must name at least one reaction",
    )
    count = solution.crank_angle.size
    steps = np.linspace(0, count, min(frames, count), endpoint=False).astype(int)
    _frame(ax, solution)
    bars = _bars(ax, solution, 1.0)
    lines = list(_bar_lines(solution))
    blocks = [solution.position(joint) for joint in _sliding(solution.mechanism)]
    sliders = [ax.plot([], [], "s", ms=13, mfc=STEEL, mec="none", zorder=3)[0] for _ in blocks]
    pins = [ax.plot([], [], "o", ms=6, mfc="white", mec=INK, zorder=4)[0] for _ in solution.placement.joints]
    positions = [solution.position(joint) for joint in solution.placement.joints]
    forces = [_cut(solution, joint) for joint in joints]
    largest = max(float(np.nanmax(magnitude(force))) for force in forces)
    length = float(np.nanmax(magnitude(solution.position(_leading(solution.mechanism)))))
    outputs = solution.mechanism.outputs
    starts = [solution.position(outputs[joint].at or joint) for joint in joints]
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
    _equal(ax)

    def draw(step):
        for bar, (x, y) in zip(bars, lines, strict=True):
            bar.set_data(x[..., step], y[..., step])
        for marker, position in zip([*sliders, *pins], [*blocks, *positions], strict=True):
            marker.set_data(position[:, [step]])
        arrows.set_offsets(np.array([start[:, step] for start in starts]))
        arrows.set_UVC(*np.array([force[:, step] for force in forces]).T)
        caption.set_text(f"crank angle {np.degrees(solution.crank_angle[step]):.0f}°")
        return [*bars, *sliders, *pins, arrows, caption]

    return FuncAnimation(ax.figure, draw, frames=steps, interval=interval)


def _frame(ax, solution):
    """What does not move: the support, the guide over the stroke, the pitch curve of the cam or the crank circle."""
    made = solution.mechanism
    turn = _posed(solution, np.linspace(0, 360 * made.turns, 720 * made.turns + 1))
    for joint, text in made.curves.items():
        ax.plot(*turn.position(joint), color=ACCENT, lw=1, ls="--", label=text)
    for bar in made.crank.bars:
        ax.plot(*turn.position(bar.end), color=INK, lw=0.5, ls=":")
    ax.plot(0, 0, "o", ms=14, mfc="0.8", mec="none")
    for slider, guide in made.guides.items():
        path = turn.position(made.references[slider])
        along = path.T @ guide.direction
        start, end = path[:, np.nanargmin(along)], path[:, np.nanargmax(along)]
        reach = 0.15 * (end - start)
        ax.plot(*np.column_stack([start - reach, end + reach]), color=INK, lw=6, alpha=0.15)


def _posed(solution, degrees):
    """The mechanism at other crank angles, whatever its speed and loads."""
    return Motion(solution.mechanism, np.radians(degrees), 0.0, 0.0)


def _cut(solution, joint):
    """Reaction at a joint; near change points that are passed, where it grows without bound, no longer than most."""
    force = solution.reaction(joint)
    if not solution.mechanism.grows(joint):
        return force
    size = magnitude(force)
    most = np.nanquantile(np.where(np.isfinite(size), size, np.nan), MOST)
    with np.errstate(invalid="ignore"):
        return np.where(size > most, np.nan_to_num(force / size, nan=0.0) * most, force)


def _sliding(made):
    """Joints of the sliders."""
    return [made.references[slider] for slider in made.guides]


def _leading(made):
    """First joint that moves, from the crank outwards; O where none does."""
    return next((name for name, point in made.joints.items() if point.link != FRAME), "O")


def _bars(ax, pose, shade):
    """One empty line for each bar and slot."""
    count = len(list(_bar_lines(pose)))
    return [ax.plot([], [], color=STEEL, lw=2.5, alpha=shade, solid_capstyle="round")[0] for _ in range(count)]


def _bar_lines(pose):
    """Ends, x and y, of every bar and slotted link, (2, N) each; slots reach a little beyond the joint in them."""
    for slot in pose.mechanism.slots:
        start = pose.position(pose.mechanism.references[slot.link])
        yield _ends(start, start + 1.15 * (pose.position(slot.joint) - start))
    for start, end in _strokes(pose.mechanism):
        yield _ends(pose.position(start), pose.position(end))


def _strokes(made):
    """Pairs of joints of one link: ends of bars, and what makes triangles of them with further joints of the link."""
    bars = [(bar.start, bar.end) for bar in made.bars]
    ends = {point.link: [made.references[point.link]] for point in made.joints.values() if point.link != FRAME}
    for bar in made.bars:
        ends.setdefault(bar.link, [bar.start]).append(bar.end)
    further = [(name, point.link) for name, point in made.joints.items() if point.link != FRAME]
    return bars + [(end, name) for name, link in further if name not in ends[link] for end in ends[link]]


def _ends(start, end):
    return np.array([start[0], end[0]]), np.array([start[1], end[1]])


def _equal(ax):
    ax.relim()
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
