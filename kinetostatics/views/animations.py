"""Animation of the mechanism, with arrows for the reactions at its joints."""

from contextlib import suppress

import numpy as np

from ..errors import ParameterError
from ..machine.group import FRAME
from ..mechanics.quantities import magnitude
from ..numbers import checks
from .axis_units import with_units
from .canvas import ACCENT, axes, display_unit, set_equal_scales, single_solution
from .drawings import MASS_CENTRE, PIN, draw_fixed_parts, first_moving_joint, set_points, stroke_artist
from .strokes import UNCLIPPED_SHARE


@with_units
def animation(solution, joints=None, frames=72, interval=50, ax=None):
    """Animation of the mechanism over the period of its motion and loads, with arrows for the joint reactions.

    Show it in a notebook by ``HTML(animation.to_jshtml())``, or save it by ``animation.save("saw.gif")``.

    Parameters
    ----------
    solution : Solution
    joints : sequence of str, optional
        Reactions drawn as arrows from their joints ("guide" at B); by default at O, A and B. The
        largest of all is as long as the crank. Nothing is drawn where the mechanism does not close.
    frames : int
        Poses shown, at crank angles of the solution; if these cover less than a period, the whole period is solved,
        unless the solution contains tables over its crank angles.
    interval : float
        Time between them, ms.

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

    solution, ax = single_solution(solution), axes(ax)
    if joints is None:
        joints = [name for name in ("O", "A", "B") if name in solution.mechanism.outputs]
    joints = (joints,) if isinstance(joints, str) else tuple(joints)
    interval = checks.single_numbers(
        "animation",
        checks.count("frames", frames),
        None if joints else "joints must name at least one reaction",
        interval=(interval, "ms", {"low": 0.0, "strict": True}),
    )["interval"]
    angle, period = np.sort(solution.crank_angle), solution.period
    step = np.median(np.diff(angle)) if angle.size > 1 else 0.0
    if angle[-1] - angle[0] + 1.5 * step < period:
        with suppress(ParameterError):
            solution = solution.at(angle[0] + np.linspace(0.0, period, max(frames, 2), endpoint=False))
    move, paths = _moving_parts(ax, draw_fixed_parts(ax, solution), solution, joints)
    set_equal_scales(ax, paths[:, np.isfinite(paths).all(axis=0)].T)
    count = solution.crank_angle.size
    steps = np.linspace(0, count, min(frames, count), endpoint=False).astype(int)
    return FuncAnimation(ax.figure, move, frames=steps, interval=interval)


def _moving_parts(ax, shape, solution, joints):
    """A function that moves all parts to a step and returns their artists, and the points (2, K) of the parts.

    The largest arrow of the reactions is as long as the crank; its size is in the title.
    """
    made = solution.mechanism
    strokes = [*shape.counterweights(solution), *shape.strokes(solution), *shape.symbols(solution.loads, solution)]
    links = [stroke_artist(ax, stroke, 1.0) for stroke in strokes]
    spots = [(name, {**PIN, "zorder": 4}) for name, point in made.joints.items() if point.link != FRAME]
    spots += [(name, style) for name in shape.heavy for style in MASS_CENTRE]
    marks = [ax.plot([], [], **style)[0] for _, style in spots]
    positions = [solution.position(name) for name, _ in spots]
    forces = [_clipped_reaction(solution, joint) for joint in joints]
    largest = max(_largest_finite(magnitude(force)) for force in forces)
    length = _largest_finite(magnitude(solution.position(first_moving_joint(made))))
    starts = [solution.position(made.outputs[joint].at or joint) for joint in joints]
    arrows = ax.quiver(
        *np.zeros((4, len(joints))),
        angles="xy",
        scale_units="xy",
        scale=(largest or 1.0) / length,
        color=ACCENT,
        width=0.005,
        zorder=5,
    )
    factor, shown = display_unit("N", [largest])
    ax.set_title(f"reactions at {', '.join(joints)}; longest arrow {factor * largest:.4g} {shown}", fontsize="small")
    caption = ax.text(0.02, 0.94, "", transform=ax.transAxes, fontsize="small")

    def move(step):
        for link, stroke in zip(links, strokes, strict=True):
            set_points(link, stroke.points[..., step])
        for mark, position in zip(marks, positions, strict=True):
            mark.set_data(position[:, [step]])
        arrows.set_offsets(np.array([start[:, step] for start in starts]))
        arrows.set_UVC(*np.array([force[:, step] for force in forces]).T)
        caption.set_text(f"crank angle {np.degrees(solution.crank_angle[step]):.0f}°")
        return [*links, *marks, arrows, caption]

    return move, np.concatenate([*positions, *(stroke.points.reshape(2, -1) for stroke in strokes)], axis=1)


def _largest_finite(values):
    finite = values[np.isfinite(values)]
    return float(np.max(finite, initial=0.0)) or 1.0


def _clipped_reaction(solution, joint):
    """Reaction at a joint; near change points, where it grows without bound, limited to the size of most others."""
    force = solution.reaction(joint)
    if not solution.mechanism.grows(joint):
        return force
    size = magnitude(force)
    most = np.nanquantile(np.where(np.isfinite(size), size, np.nan), UNCLIPPED_SHARE)
    with np.errstate(invalid="ignore"):
        return np.where(size > most, np.nan_to_num(force / size, nan=0.0) * most, force)
