"""Figure of a block that carries a machine: its velocity over the turn, and loads by harmonic."""

import numpy as np

from ..errors import ParameterError
from ..machine.loads import TURN
from ..sizing.foundation import WAYS, Mount
from .axis_units import with_units
from .canvas import ACCENT, INK, STEEL, display_unit, finish_axes, panels


@with_units
def mount(result):
    """Velocity of a block's centre over the turn, and loads by harmonic, a row for each direction that moves.

    Bars show the load on a fixed frame, and the load of springs and dampers on the ground.

    Parameters
    ----------
    result : Mount
        As of `ks.sizing.mount`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.solve(ks.crank_slider(0.05, 0.16, slider=ks.Link(1.5)), 0.0, crank_speed=75.4)
    >>> figure = ks.plots.mount(ks.sizing.mount(pump, mass=75.0, stiffness=220e3, damping=0.02))
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['velocity, x [mm/s]', 'amplitude, x [N]']
    """
    if not isinstance(result, Mount):
        raise ParameterError(f"mount: result must be a Mount, as of ks.sizing.mount, got a {type(result).__name__}")
    order, angle = result.order, np.linspace(0.0, TURN / result.order[0], 721)
    curves = np.real(1j * order * result.crank_speed * result.displacement @ np.exp(1j * np.outer(order, angle)))
    moving = [way for way, curve in zip(WAYS, curves, strict=True) if np.any(curve)] or ["x"]
    figure, grid = panels(2 * len(moving), 2, 4.6, 2.8)
    for way, over, bars in zip(moving, grid[::2], grid[1::2], strict=True):
        unit, load = WAYS[way]
        over.plot(np.degrees(angle), 1e3 * curves[list(WAYS).index(way)], color=ACCENT, label="velocity")
        over.axhline(1e3 * getattr(result, f"v_rms_{way}"), color=INK, lw=0.8, ls=":", label="rms")
        finish_axes(over, f"velocity, {way} [m{unit}/s]", True, round(np.degrees(angle[-1])))
        table = result.harmonics(way).iloc[:8]
        factor, shown = display_unit(load, [table["force"].to_numpy()])
        loads = factor * table[["force", "ground"]].set_axis([f"{order:g}" for order in table.index])
        words = {"xlabel": "harmonic of the crank", "ylabel": f"amplitude, {way} [{shown}]"}
        loads.plot.bar(ax=bars, color=[STEEL, ACCENT], width=0.8, rot=0, **words)
        bars.legend(["on a fixed frame", "on the ground"], frameon=False, fontsize="small")
    return figure
