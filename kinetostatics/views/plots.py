"""Figures. Nothing is shown, and nothing is set globally.

Every function draws on `ax` (a new one if not given) and returns it; `animation` returns the film.

Where a function takes `solutions`, give one `Solution` or a mapping of label to `Solution` to draw them together.
"""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np

from ..design.linkage import chain_unit_angle, four_bar_of
from ..errors import QuantityError
from ..mechanics import quantities
from ..mechanics.quantities import magnitude, of_mechanism, values
from ..numbers.checks import choice, require, singles
from ..results.extremes import extremes
from .cams import cam_curvature, cam_pressure_angle, cam_profile, contact_pressure, law_motion
from .canvas import INK, axes, closed, display, finished, labelled, styled
from .charts import error_by_distance, model_ladder, sweep_map, work_precision
from .drawings import animation, mass_centres, mechanism
from .fronts import front
from .labels import label
from .lost_power import losses, lost_power

__all__ = [
    "acceleration_error",
    "animation",
    "cam_curvature",
    "cam_force",
    "cam_pressure_angle",
    "cam_profile",
    "chain_unit_motion",
    "contact_pressure",
    "error_by_distance",
    "front",
    "hodograph",
    "law_motion",
    "losses",
    "lost_power",
    "mass_centres",
    "mechanism",
    "model_ladder",
    "over_turn",
    "pressure_angle",
    "shaking_force",
    "sweep_map",
    "torque",
    "work_precision",
]

LEAST_MARKS = 0.01
"""Least step of the crank-angle marks, degrees."""


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
    ax = axes(ax)
    named = labelled(solutions, quantity)
    curves = {name: (_degrees(solution), values(solution, quantity)) for name, solution in named.items()}
    declared = _declared(named, quantity)
    factor, shown = display(declared.unit, [value for _, value in curves.values()])
    for name, (angle, value), style in styled(curves):
        ax.plot(angle, factor * value, linestyle=style, label=name)
    return finished(ax, f"{declared.label} [{shown}]", len(curves) > 1, _longest(named))


def torque(solutions, ax=None):
    """Balancing torque over the crank angle (study of sawframe 2R63, figure 6a)."""
    return over_turn(solutions, "balancing_torque", ax)


def cam_force(solutions, ax=None):
    """Force of the cam on the roller over the crank angle (figure 6b)."""
    return over_turn(solutions, "cam_force", ax)


def pressure_angle(solutions, ax=None):
    """Pressure angle of the cam pair over the crank angle (figure 5)."""
    return over_turn(solutions, "pressure_angle", ax)


def acceleration_error(solutions, ax=None, slider=None):
    """Slider acceleration against a cosine law of the same stroke, relative to its amplitude (figure 3).

    With the stroke S from the true extremes of the slider position and psi the crank angle from the guide, the law is
    -S/2 (omega^2 cos(psi) + alpha sin(psi)); deviations are relative to S/2 omega^2. The only slider, or that without a
    label, is meant unless told.
    """
    ax = axes(ax)
    named = labelled(solutions, "slider acceleration")
    _require_turning(named)
    for name, solution, style in styled(named):
        half_stroke = np.ptp(extremes(solution, lambda motion: motion.travel(slider)).value) / 2
        square, alpha = solution.crank_speed**2, solution.crank_acceleration
        psi = solution.crank_angle - solution.mechanism.guides[slider or solution.mechanism.slider].guide_angle
        law = -half_stroke * (square * np.cos(psi) + alpha * np.sin(psi))
        error = (solution.travel_acceleration(slider) - law) / (half_stroke * square)
        ax.plot(_degrees(solution), 100 * error, linestyle=style, label=name)
    return finished(
        ax, "deviation of slider acceleration\nfrom cosine law [% of amplitude]", len(named) > 1, _longest(named)
    )


def hodograph(solutions, joint="O", ax=None, marks=30):
    """Hodograph of a joint reaction: the curve its tip draws over the turn (figure 7).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
    joint : str
        Joint, or the vector attribute "shaking_force".
    ax : Axes, optional
    marks : float
        Step of the crank-angle marks, degrees; marks stand where the solution has that angle, to half a degree.

    Returns
    -------
    Axes
        With equal scales on both axes.
    """
    marks = singles("hodograph", marks=(marks, "deg", {"low": LEAST_MARKS}))["marks"]
    ax = axes(ax)
    named = labelled(solutions, joint)
    curves = {name: _vector(solution, joint) for name, solution in named.items()}
    declared = _declared(named, joint)
    factor, shown = display(declared.unit, curves.values())
    extents = {name: factor * np.max(np.ptp(curve, axis=1)) for name, curve in curves.items()}
    for name, solution, style in styled(named):
        (line,) = ax.plot(*closed(factor * curves[name]), linestyle=style, label=name)
        rows = _marked(solution, marks)
        ax.plot(*factor * curves[name][:, rows], "o", ms=3, color=line.get_color())
        near = max(0.06 * extents[name], 0.025 * max(extents.values()))
        texts = _shared(_degrees(solution)[rows] % np.degrees(solution.period), factor * curves[name][:, rows], near)
        for text, point in texts:
            label(ax, text, point, color=line.get_color() if len(named) > 1 else INK)
    ax.axhline(0, color=INK, lw=0.5)
    ax.axvline(0, color=INK, lw=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(f"{declared.label}, x [{shown}]")
    ax.set_ylabel(f"{declared.label}, y [{shown}]")
    if len(named) > 1 or isinstance(solutions, Mapping):
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
        Which link of the four-bar, whatever it is called.
    order : 1 or 2
        Velocity or acceleration.
    ax : Axes, optional

    Returns
    -------
    Axes
    """
    require(
        "chain_unit_motion",
        None if order in (1, 2) else f"order must be 1 or 2, got {order!r}",
        choice("link", link, ("coupler", "rocker")),
    )
    ax = axes(ax)
    named = labelled(solutions, f"{link} rate")
    _require_turning(named)
    for name, solution, style in styled(named):
        turning = getattr(four_bar_of(solution.mechanism), link).link
        angle = np.degrees(chain_unit_angle(solution.crank_angle)) % 360
        rows = np.argsort(angle)
        speed = solution.crank_speed
        relative = (
            solution.rate(turning) / speed
            if order == 1
            else solution.angular_acceleration(turning) / (speed * abs(speed))
        )
        ax.plot(angle[rows], relative[rows], linestyle=style, label=name)
    kind = "velocity" if order == 1 else "acceleration"
    finished(ax, f"relative angular {kind} of the {link} [1]", len(named) > 1)
    ax.set_xlabel("crank angle from +y, clockwise [deg]")
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
    ax = axes(ax)
    named = labelled(solutions, "shaking_force")
    sizes = {name: magnitude(solution.shaking_force) for name, solution in named.items()}
    factor, shown = display("N", sizes.values())
    for name, solution, style in styled(named):
        x, y = solution.shaking_force
        angle = np.arctan2(y, x) if by == "direction" else solution.crank_angle
        ax.plot(*closed(np.array([angle, factor * sizes[name]])), linestyle=style, label=name)
    ax.set_title(f"shaking force [{shown}] by {by}", fontsize="medium")
    if len(named) > 1:
        ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.05, 1.0))
    return ax


def _require_turning(named):
    still = [name for name, solution in named.items() if np.any(np.asarray(solution.crank_speed) == 0)]
    require(
        "plots", f"the crank speed of {', '.join(still)} is 0, but what is shown is relative to it" if still else None
    )


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
