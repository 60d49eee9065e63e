"""Figures of the studies' own kinds: relative motion of the chain unit, polar hodograph of the shaking force."""

import matplotlib.pyplot as plt
import numpy as np

from ..design.linkage import chain_unit_angle, four_bar_of
from ..mechanics.quantities import magnitude
from ..numbers.checks import choice, require
from .canvas import axes, closed, display, finished, labelled, styled


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


def require_turning(named):
    """Refuse solutions of a crank at rest."""
    still = [name for name, solution in named.items() if np.any(np.asarray(solution.crank_speed) == 0)]
    require(
        "plots", f"the crank speed of {', '.join(still)} is 0, but what is shown is relative to it" if still else None
    )
