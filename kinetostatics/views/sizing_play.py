"""Loss of contact in a joint with play: forces and index over the crank angle."""

import numpy as np

from ..errors import ParameterError
from ..sizing.play import ContactLoss
from .axis_units import with_units
from .canvas import ACCENT, FROM_X, INK, LOAD, STEEL, axes, display_unit

LARGEST_SHOWN = 1.3
"""Limit of the force axis over the largest force without play: beyond it the pendulum does not describe the journal."""
LARGEST_INDEX = 10.0
"""Limit of the index axis."""
NAMED = 0.33
"""Energy of an impact, relative to the largest, above which it is written."""


@with_units
def contact_loss(result, ax=None):
    """Force without play and normal force with it over the crank angle; the index on a second axis.

    Bands show flights of the journal through its play, with the energy of the impact; dotted lines show where the force
    passes through zero.

    Parameters
    ----------
    result : ContactLoss
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import warnings
    >>> import kinetostatics as ks
    >>> with warnings.catch_warnings(action="ignore"):
    ...     found = ks.sizing.contact_loss(ks.load_case("sawframe_2r63").solve("cam-circle", 8), "O", clearance=1e-4)
    >>> ks.plots.contact_loss(found).get_title()
    'joint O: index infinite, largest impact 1.9 J'
    """
    if not isinstance(result, ContactLoss):
        raise ParameterError(f"contact_loss: result must be a ContactLoss of ks.sizing, got {result!r}")
    ax, degrees = axes(ax), np.degrees(result.angle)
    factor, unit = display_unit("N", [result.force])
    ax.plot(degrees, factor * result.force, color=STEEL, ls="--", label="|F| without play")
    ax.plot(degrees, factor * result.normal, color=INK, label="normal force N")
    ax.axhline(0.0, color=INK, lw=0.6)
    largest = LARGEST_SHOWN * factor * result.force.max()
    ax.set_ylim(max(-0.6 * largest, min(0.0, 1.1 * factor * result.normal.min())), largest)
    for flight in result.flights:
        ends = np.degrees([flight.start, flight.stop])
        for turns in (-1.0, 0.0, 1.0):  # a flight may pass the end of the period
            ax.axvspan(*(ends + turns * np.degrees(result.period)), color=ACCENT, alpha=0.25, lw=0)
        if flight.energy > NAMED * result.impact_energy:
            period, at_top = np.degrees(result.period), ax.get_xaxis_transform()
            place = np.clip(np.mod(ends.mean(), period), 0.05 * period, 0.95 * period)  # clear of the frame
            paper = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.0}
            ax.text(place, 0.97, f"{flight.energy:.2g} J", ha="center", va="top", transform=at_top, bbox=paper)
    for angle in np.degrees(result.reversals):
        ax.axvline(angle, color=ACCENT, lw=0.8, ls=":")
    ax.set(xlim=(0.0, np.degrees(result.period)), xlabel=FROM_X.axis, ylabel=f"force [{unit}]")
    ax.set_xticks(np.linspace(0.0, np.degrees(result.period), 5))
    beside = ax.twinx()
    beside.plot(degrees, result.index_curve, color=LOAD, lw=1.0)
    beside.set_ylim(0.0, min(LARGEST_INDEX, 1.3 * max(1.0, result.index)))
    beside.set_ylabel("index [1]", color=LOAD)
    index = f"{result.index:.2f}" if np.isfinite(result.index) else "infinite"
    ax.set_title(f"joint {result.joint}: index {index}, largest impact {result.impact_energy:.2g} J", pad=22.0)
    ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=2)
    return ax
