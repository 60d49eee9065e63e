"""Figures. Nothing is shown, and nothing is set globally.

Every function draws on `ax` (a new one if not given) and returns it; `animation` returns the film.

Where a function takes `solutions`, give one `Solution` or a mapping of label to `Solution` to draw them together.
"""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np

from .cam_roller import CamRoller
from .checks import choice, require
from .extremes import extremes
from .linkage import chain_unit_angle
from .principal_points import principal_points
from .quantities import label, magnitude, unit, values
from .slider_group import SliderGroup

INK, STEEL, ACCENT = "0.15", "slategray", "tab:red"


def over_turn(solutions, quantity, ax=None):
    """One quantity over the crank angle.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    quantity : str
        As for `extremes`; of a reaction or a vector the magnitude is drawn.
    ax : matplotlib Axes, optional

    Returns
    -------
    Axes
    """
    ax = _axes(ax)
    curves = {
        name: (_degrees(solution), values(solution, quantity))
        for name, solution in _labelled(solutions, quantity).items()
    }
    factor, shown = _display(unit(quantity), [value for _, value in curves.values()])
    for name, (angle, value) in curves.items():
        ax.plot(angle, factor * value, label=name)
    return _finished(ax, f"{label(quantity)} [{shown}]", len(curves) > 1)


def torque(solutions, ax=None):
    """Balancing torque over the crank angle (study of sawframe 2R63, figure 6a)."""
    return over_turn(solutions, "balancing_torque", ax)


def cam_force(solutions, ax=None):
    """Force of the cam on the roller over the crank angle (figure 6b)."""
    return over_turn(solutions, "cam_force", ax)


def pressure_angle(solutions, ax=None):
    """Pressure angle of the cam pair over the crank angle (figure 5)."""
    return over_turn(solutions, "pressure_angle", ax)


def acceleration_error(solutions, ax=None):
    """Slider acceleration against a cosine law of the same stroke, relative to its amplitude (figure 3).

    With the stroke S from the true extremes of the slider position, the law is -S/2 omega^2 cos(phi).
    """
    ax = _axes(ax)
    labelled = _labelled(solutions, "slider_acceleration")
    for name, solution in labelled.items():
        amplitude = np.ptp(extremes(solution, "slider_position").value) / 2 * solution.crank_speed**2
        error = solution.slider_acceleration / amplitude + np.cos(solution.crank_angle)
        ax.plot(_degrees(solution), 100 * error, label=name)
    return _finished(ax, "deviation of slider acceleration\nfrom cosine law [% of amplitude]", len(labelled) > 1)


def hodograph(solutions, joint="O", ax=None, marks=30):
    """Hodograph of a joint reaction: the curve its tip draws over the turn (figure 7).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    joint : str
        Joint, or the vector attribute "shaking_force".
    ax : Axes, optional
    marks : float
        Step of the crank-angle marks, degrees.

    Returns
    -------
    Axes
        With equal scales on both axes.
    """
    ax = _axes(ax)
    labelled = _labelled(solutions, joint)
    curves = {name: _vector(solution, joint) for name, solution in labelled.items()}
    factor, shown = _display("N", curves.values())
    for name, solution in labelled.items():
        (line,) = ax.plot(*_closed(factor * curves[name]), label=name)
        _mark_angles(ax, solution, joint, factor, np.arange(0, 360, marks), line.get_color())
    ax.axhline(0, color=INK, lw=0.5)
    ax.axvline(0, color=INK, lw=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    name = label(joint)
    ax.set_xlabel(f"{name}, x [{shown}]")
    ax.set_ylabel(f"{name}, y [{shown}]")
    if len(labelled) > 1 or isinstance(solutions, Mapping):
        ax.legend(frameon=False)
    return ax


def chain_unit_motion(solutions, link, order=1, ax=None):
    """Relative angular velocity or acceleration of a link of the chain unit (Belarusian study, figures 5-12).

    Both are counted in the crank's sense of turning and divided by crank speed, or its square; the crank angle from
    +y, clockwise.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    link : "coupler" or "rocker"
    order : 1 or 2
        Velocity or acceleration.
    ax : Axes, optional

    Returns
    -------
    Axes
    """
    ax = _axes(ax)
    labelled = _labelled(solutions, f"{link}_rate")
    for name, solution in labelled.items():
        angle = np.degrees(chain_unit_angle(solution.crank_angle)) % 360
        rows = np.argsort(angle)
        speed = solution.crank_speed
        relative = (
            solution.rate(link) / speed if order == 1 else solution.angular_acceleration(link) / (speed * abs(speed))
        )
        ax.plot(angle[rows], relative[rows], label=name)
    kind = "velocity" if order == 1 else "acceleration"
    _finished(ax, f"relative angular {kind} of the {link} [1]", len(labelled) > 1)
    ax.set_xlabel("crank angle from +y, clockwise [deg]")
    return ax


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
    labelled = _labelled(solutions, "common mass centre")
    ax = mechanism(next(iter(labelled.values())), angles=(angle,), ax=ax)
    for name, solution in labelled.items():
        points = principal_points(solution.mechanism)
        (line,) = ax.plot(*_closed(points.mass_centre(solution)), label=name, zorder=5)
        ax.plot(*points.mass_centre(solution.at(np.radians([angle]))), "o", ms=4, color=line.get_color(), zorder=6)
    ax.legend(frameon=False, fontsize="small", title="path of the common mass centre", title_fontsize="small")
    return ax


def shaking_force(solutions, by="direction", ax=None):
    """Polar hodograph of the shaking force, by its own direction or by crank angle (mower study, figures 6a, 6b).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    by : "direction" or "crank angle"
        What the polar angle is.
    ax : polar Axes, optional

    Returns
    -------
    Axes
    """
    require("shaking_force", choice("by", by, ("direction", "crank angle")))
    if ax is None:
        ax = plt.subplots(subplot_kw={"projection": "polar"}, layout="constrained")[1]
    labelled = _labelled(solutions, "shaking_force")
    sizes = {name: magnitude(solution.shaking_force) for name, solution in labelled.items()}
    factor, shown = _display("N", sizes.values())
    for name, solution in labelled.items():
        x, y = solution.shaking_force
        angle = np.arctan2(y, x) if by == "direction" else solution.crank_angle
        ax.plot(*_closed(np.array([angle, factor * sizes[name]])), label=name)
    ax.set_title(f"shaking force [{shown}] by {by}", fontsize="medium")
    if len(labelled) > 1:
        ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.05, 1.0))
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
    ax = _axes(ax)
    _frame(ax, solution)
    shades = np.linspace(1.0, 0.3, len(angles))
    for angle, shade in zip(angles, shades, strict=True):
        pose = solution.at(np.radians([angle]))
        for bar, (x, y) in zip(_bars(ax, pose, shade), _bar_lines(pose), strict=True):
            bar.set_data(x, y)
        for group in _slider_groups(pose):
            ax.plot(*pose.position(group.pin), "s", ms=13, mfc=STEEL, mec="none", alpha=shade, zorder=3)
        for joint in pose.placement.joints:
            ax.plot(*pose.position(joint), "o", ms=5, mfc="white", mec=INK, alpha=shade, zorder=4)
        ax.annotate(
            f"{angle:g}°",
            pose.position("A")[:, 0],
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
        Reactions drawn as arrows from their joints ("guide" starts at B); the largest of all is half the
        mechanism's crank circle long.
    frames : int
        Poses in the turn.
    interval : float
        Time between them, ms.
    ax : Axes, optional

    Returns
    -------
    matplotlib.animation.FuncAnimation
    """
    from matplotlib.animation import FuncAnimation

    ax = _axes(ax)
    turn = solution.at(np.linspace(0, 2 * np.pi, frames, endpoint=False))
    _frame(ax, solution)
    bars = _bars(ax, turn, 1.0)
    lines = list(_bar_lines(turn))
    pins = [ax.plot([], [], "o", ms=6, mfc="white", mec=INK, zorder=4)[0] for _ in turn.placement.joints]
    positions = [turn.position(joint) for joint in turn.placement.joints]
    forces = [turn.reaction(joint) for joint in joints]
    largest = max(float(np.max(magnitude(force))) for force in forces)
    length = float(np.max(magnitude(turn.position("A"))))
    starts = [turn.position("B" if joint == "guide" else joint) for joint in joints]
    arrows = ax.quiver(
        *np.zeros((2, len(joints))),
        *np.zeros((2, len(joints))),
        angles="xy",
        scale_units="xy",
        scale=largest / length,
        color=ACCENT,
        width=0.005,
        zorder=5,
    )
    factor, shown = _display("N", [largest])
    ax.set_title(f"reactions at {', '.join(joints)}; longest arrow {factor * largest:.4g} {shown}", fontsize="small")
    caption = ax.text(0.02, 0.94, "", transform=ax.transAxes, fontsize="small")
    _equal(ax)

    def draw(step):
        for bar, (x, y) in zip(bars, lines, strict=True):
            bar.set_data(x[..., step], y[..., step])
        for pin, position in zip(pins, positions, strict=True):
            pin.set_data(position[:, [step]])
        arrows.set_offsets(np.array([start[:, step] for start in starts]))
        arrows.set_UVC(*np.array([force[:, step] for force in forces]).T)
        caption.set_text(f"crank angle {np.degrees(turn.crank_angle[step]):.0f}°")
        return [*bars, *pins, arrows, caption]

    return FuncAnimation(ax.figure, draw, frames=frames, interval=interval)


def _axes(ax):
    return plt.subplots(layout="constrained")[1] if ax is None else ax


def _labelled(solutions, name):
    return dict(solutions) if isinstance(solutions, Mapping) else {label(name): solutions}


def _degrees(solution):
    return np.degrees(solution.crank_angle)


def _display(name, arrays):
    """Factor and unit in which numbers of this size read well."""
    if name == "rad":
        return 180 / np.pi, "deg"
    largest = max(float(np.nanmax(np.abs(array))) for array in arrays)
    return (1e-3, f"k{name}") if name in ("N", "N m") and largest >= 1e4 else (1.0, name)


def _finished(ax, ylabel, legend):
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel(ylabel)
    ax.set_xlim(0, 360)
    ax.set_xticks(range(0, 361, 60))
    ax.axhline(0, color=INK, lw=0.5)
    ax.grid(alpha=0.3)
    if legend:
        ax.margins(y=0.18)
        ax.legend(frameon=False, loc="upper center", ncols=3, fontsize="small", columnspacing=1.0)
    return ax


def _vector(solution, joint):
    return solution.shaking_force if joint == "shaking_force" else solution.reaction(joint)


def _mark_angles(ax, solution, joint, factor, angles, color):
    """Crank-angle marks on a hodograph; marks that fall together share one label."""
    points = factor * _vector(solution.at(np.radians(angles)), joint)
    ax.plot(*points, "o", ms=3, color=color)
    near = 0.03 * np.max(np.ptp(points, axis=1))
    labels: dict[int, list[str]] = {}
    for row, point in enumerate(points.T):
        first = next((other for other in labels if np.hypot(*(points[:, other] - point)) < near), row)
        labels.setdefault(first, []).append(f"{angles[row]:g}°")
    for row, names in labels.items():
        ax.annotate(
            ", ".join(names), points[:, row], xytext=(3, 3), textcoords="offset points", fontsize="x-small", color=INK
        )


def _closed(curve):
    return np.concatenate([curve, curve[:, :1]], axis=1)


def _frame(ax, solution):
    """What does not move: the support, the guide over the stroke, the pitch curve of the cam or the crank circle."""
    turn = solution.at(np.linspace(0, 2 * np.pi, 721))
    if solution.mechanism.group(CamRoller) is not None:
        ax.plot(*turn.position("A"), color=ACCENT, lw=1, ls="--", label="pitch curve of the cam")
    else:
        ax.plot(*turn.position("A"), color=INK, lw=0.5, ls=":")
    ax.plot(0, 0, "o", ms=14, mfc="0.8", mec="none")
    for group in _slider_groups(solution):
        path = turn.position(group.pin)
        along = path.T @ group.guide.direction
        start, end = path[:, np.nanargmin(along)], path[:, np.nanargmax(along)]
        reach = 0.15 * (end - start)
        ax.plot(*np.column_stack([start - reach, end + reach]), color=INK, lw=6, alpha=0.15)


def _slider_groups(solution):
    return [group for group in solution.mechanism.groups if isinstance(group, SliderGroup)]


def _bars(ax, pose, shade):
    """One empty line for each bar, and one for the slotted crank."""
    count = len(list(_bar_lines(pose)))
    return [ax.plot([], [], color=STEEL, lw=2.5, alpha=shade, solid_capstyle="round")[0] for _ in range(count)]


def _bar_lines(pose):
    """Ends, x and y, of every bar, (2, N) each; the slotted crank reaches a little beyond the block."""
    if pose.mechanism.crank.length is None:
        tip = 1.15 * pose.position("A")
        yield _ends(pose.position("O"), tip)
    for bar in pose.mechanism.bars:
        yield _ends(pose.position(bar.start), pose.position(bar.end))


def _ends(start, end):
    return np.array([start[0], end[0]]), np.array([start[1], end[1]])


def _equal(ax):
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
