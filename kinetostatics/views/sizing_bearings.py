"""Figure of a bearing: its load in the axes of both rings, and over the turn."""

import numpy as np

from ..errors import ParameterError
from ..machine.group import FRAME
from ..sizing.bearings import Bearing
from .axis_units import with_units
from .canvas import ACCENT, FROM_X, INK, STEEL, close_curve, display_unit, finish_axes, panels
from .hodographs import write_angles

ANGLES, MARKS = 1440, 8
"""Crank angles over the period, and those written at hodographs."""


@with_units
def bearing(found):
    r"""Hodographs of the load on each ring of a bearing in the ring's axes, and its size with the equivalent load.

    A roller has no hodograph, because its rotation does not repeat.

    Parameters
    ----------
    found : Bearing
        As of `ks.sizing.bearing`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").solve("plain", 4)
    >>> figure = ks.plots.bearing(ks.sizing.bearing(saw, "A", capacity=600e3, static_capacity=1e6))
    >>> figure.axes[1].get_title()
    'on the crank:\npoint load'
    """
    if not isinstance(found, Bearing):
        raise ParameterError(f"bearing: found must be a Bearing, of ks.sizing.bearing, got a {type(found).__name__}")
    at = found.solution.moved_to(np.linspace(0.0, found.solution.period, ANGLES, endpoint=False))
    curves = zip(found.pin.rings, found.pin.in_rings(at), strict=True)
    rings = {ring: curve for ring, curve in curves if np.isfinite(curve).all()}
    load = np.hypot(*found.pin.load(at))
    factor, unit = display_unit("N", [load])
    figure, (*polar, over) = panels(len(rings) + 1, 3, 4.2, 3.8)
    for ax, (ring, curve) in zip(polar, rings.items(), strict=True):
        ax.plot(*close_curve(factor * curve), color=STEEL)
        rows = range(0, ANGLES, ANGLES // MARKS)
        ax.plot(*factor * curve[:, rows], "o", ms=3, color=ACCENT)
        write_angles(ax, at, factor * curve, [*rows], 0.08 * factor * np.ptp(curve, axis=1).max(), FROM_X, INK)
        ways = ("x", "y") if ring == FRAME else (f"along the {ring}", "to its left")
        title = f"on the {ring}:\n{found.ring_loads.get(ring, 'no')} load"
        ax.set(xlabel=f"{ways[0]} [{unit}]", ylabel=f"{ways[1]} [{unit}]", title=title)
        ax.plot(0.0, 0.0, "+", ms=10, color=INK)
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.15)
        ax.grid(alpha=0.3)
    degrees = np.degrees(np.append(at.crank_angle, found.solution.period))
    over.plot(degrees, factor * np.append(load, load[0]), color=STEEL, label="|F|")
    over.axhline(factor * found.equivalent_load, color=ACCENT, ls="--", label="equivalent load P")
    over.set(title=f"load at {found.pin.name} over the turn")
    finish_axes(over, f"load [{unit}]", True, round(degrees[-1]))
    over.set_ylim(bottom=0.0)
    return figure
