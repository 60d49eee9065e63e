"""Curves of solutions over the crank angle, polar hodographs of the shaking force, motion of the chain unit."""

import matplotlib.pyplot as plt
import numpy as np

from ..cycle.extremes import extremes
from ..design.linkage import four_bar_of
from ..mechanics import quantities
from ..mechanics.quantities import magnitude, values
from ..numbers.checks import choice, require
from .axis_units import with_units
from .canvas import (
    FROM_X,
    FROM_Y_CLOCKWISE,
    ZERO_TOLERANCE,
    axes,
    close_curve,
    display_unit,
    draw_curves,
    draw_over_turn,
    finish_axes,
    period_curve,
    solutions_by_label,
    with_line_styles,
    with_peaks,
)


@with_units
def chain_unit_motion(solutions, link, order=1, ax=None):
    """Relative angular velocity or acceleration of a link of the chain unit (Belarusian study, figures 5-12).

    Both are positive in the crank's sense of rotation and divided by crank speed, or its square; the crank angle is
    from +y, clockwise.

    Parameters
    ----------
    link : "coupler" or "rocker"
        Link of the four-bar, for any name of the link.
    order : 1 or 2
        Velocity or acceleration.

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


@with_units
def shaking_force(solutions, by="direction", ax=None):
    """Polar hodograph of the shaking force, by its own direction or by crank angle (mower study, figures 6a, 6b).

    Parameters
    ----------
    by : "direction" or "crank angle"
        Meaning of the polar angle.
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
    require("plots", f"the crank speed of {', '.join(still)} is 0, but the figure is relative to it" if still else None)


@with_units
def over_turn(solutions, quantity, ax=None, counted=FROM_X):
    """One quantity over the crank angle; curves that coincide are drawn once, with all their labels.

    The curve includes extremes between the solved crank angles, kinks and jumps.

    Parameters
    ----------
    quantity : str
        As for `extremes`; of a reaction or a vector the magnitude is drawn.
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


@with_units
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


@with_units
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


@with_units
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


@with_units
def acceleration_error(solutions, ax=None, slider=None):
    """Slider acceleration against a cosine law of the same stroke, relative to its amplitude (figure 3).

    Let S be the stroke from the exact extremes of the slider position, and psi the crank angle from the guide. The law
    is -S/2 (omega^2 cos(psi) + alpha sin(psi)); deviations are relative to S/2 omega^2. By default the only slider, or
    the one without a label.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With a slider.
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
