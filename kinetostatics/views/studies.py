"""Figures of the studies' own kinds: relative motion of the chain unit, polar hodograph of the shaking force."""

import matplotlib.pyplot as plt
import numpy as np

from ..design.linkage import four_bar_of
from ..mechanics.quantities import magnitude
from ..numbers.checks import choice, require
from .canvas import (
    FROM_X,
    FROM_Y_CLOCKWISE,
    NOTHING,
    axes,
    closed,
    display,
    drawn_over_turn,
    finished,
    in_order,
    labelled,
    styled,
)
from .peaks import with_peaks


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
    named = labelled(solutions, f"{link} rate")
    require_turning(named)

    def relative(solution):
        turning, speed = getattr(four_bar_of(solution.mechanism), link).link, solution.crank_speed
        if order == 1:
            return solution.rate(turning) / speed
        return solution.angular_acceleration(turning) / (speed * abs(speed))

    named = with_peaks(named, relative)
    curves = {name: in_order(solution, relative(solution), FROM_Y_CLOCKWISE) for name, solution in named.items()}
    drawn_over_turn(ax, curves)
    kind = "velocity" if order == 1 else "acceleration"
    return finished(ax, f"relative angular {kind} of the {link} [1]", len(named) > 1, counted=FROM_Y_CLOCKWISE)


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
    named = with_peaks(labelled(solutions, "shaking_force"), "shaking_force")
    sizes = {name: magnitude(solution.shaking_force) for name, solution in named.items()}
    factor, shown = display("N", sizes.values())
    largest = max(float(np.max(size)) for size in sizes.values())
    for name, solution, style in styled(named):
        x, y = solution.shaking_force
        angle = np.arctan2(y, x) if by == "direction" else solution.crank_angle
        zero = len(named) > 1 and np.max(sizes[name]) <= NOTHING * largest
        text = f"{name} (0)" if zero else name
        ax.plot(*closed(np.array([angle, factor * sizes[name]])), linestyle=style, label=text)
    way = "the angle of its direction, from +x" if by == "direction" else FROM_X.axis.replace(" [deg]", "")
    ax.set_title(f"shaking force [{shown}] over {way}", fontsize="medium")
    ax.set_rlabel_position(67.5)
    if len(named) > 1:
        ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.05, 1.0))
    return ax


def require_turning(named):
    """Refuse solutions of a crank at rest."""
    still = [name for name, solution in named.items() if np.any(np.asarray(solution.crank_speed) == 0)]
    require(
        "plots", f"the crank speed of {', '.join(still)} is 0, but what is shown is relative to it" if still else None
    )
