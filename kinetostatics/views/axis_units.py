"""What all plots can do: draw in the units that the user chooses, and several machines with a panel for each.

`display_unit` of the canvas scales values to the chosen units. Axes with a fixed unit in their label, such as "x [m]"
of a drawing or the crank angle in degrees, keep their data; their ticks show the chosen unit.
"""

import inspect
import re
from collections.abc import Mapping
from functools import wraps
from typing import Any

import numpy as np
from matplotlib.ticker import AutoLocator, FuncFormatter, ScalarFormatter

from ..numbers import checks
from ..numbers.formatting import heading, number, parse_heading
from ..numbers.output_units import shown_in, shown_units
from .canvas import panels

COMMON_ENTRIES = {
    "solutions": "solutions : Solution or mapping of label to Solution",
    "ax": "ax : Axes, optional",
    "units": """units : dict of dimension to unit, optional
    Units of values and axes, {"force": "kN"}, as for `in_units`.""",
}
"""Entries of parameters that `with_units` adds to docstrings, where these have none."""


class ScaledLocator(AutoLocator):
    """Round tick values in a unit other than that of the data."""

    def __init__(self, factor, unit):
        super().__init__()
        self.axis: Any
        self.factor, self.unit = factor, unit

    def __call__(self):
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin, vmax):
        return super().tick_values(self.factor * vmin, self.factor * vmax) / self.factor


def scale_axes(several):
    """Show the chosen units on axes whose labels name another unit of that dimension."""
    for axis in (axis for ax in several for axis in (ax.xaxis, ax.yaxis)):
        name, unit = parse_heading(axis.get_label_text())
        factor, shown = shown_units().of(unit)
        locator = axis.get_major_locator()
        if shown != unit:
            axis.set_major_locator(ScaledLocator(factor, shown))
            axis.set_major_formatter(FuncFormatter(lambda value, _, factor=factor: number(factor * value)))
            axis.set_label_text(heading(name, shown))
        elif isinstance(locator, ScaledLocator) and locator.unit != unit:  # drawn before in other units
            axis.set_major_locator(AutoLocator())
            axis.set_major_formatter(ScalarFormatter())


def with_units(plot):
    """The plot with the option `units`, and entries of all its parameters in its docstring."""
    own = inspect.signature(plot)

    @wraps(plot)
    def drawn(*given, units=None, **options):
        with shown_in(units):
            found = plot(*given, **options)
            drawn_on = np.ravel(getattr(getattr(found, "_fig", found), "axes", found))
            scale_axes([ax for ax in drawn_on if hasattr(ax, "xaxis")])
        return found

    option = inspect.Parameter("units", inspect.Parameter.KEYWORD_ONLY, default=None)
    vars(drawn)["__signature__"] = own.replace(parameters=[*own.parameters.values(), option])
    drawn.__doc__ = _with_entries(inspect.getdoc(plot) or "", [*own.parameters, "units"])
    return drawn


def _with_entries(text, names):
    """A docstring with common entries of those parameters that have none, in the order of names."""
    heading = "\n\nParameters\n----------\n"
    head, *more = re.split(heading if heading in text else r"\n\n(?=\w+\n---)", text, maxsplit=1)
    listed, _, rest = "".join(more).partition("\n\n") if heading in text else ("", "", "".join(more))
    entries = re.split(r"\n(?=\S)", listed) if listed else []
    known = {name: entry for entry in entries for name in re.split(", *", re.split(" :|\n", entry)[0])}
    entries = [known.get(name) or COMMON_ENTRIES[name] for name in names if name in known or name in COMMON_ENTRIES]
    return "\n".join([head + heading.rstrip(), *dict.fromkeys(entries), "", rest])


def one_panel_each(width, height, columns=1, pad=6.0):
    """Decorate a plot of one machine: of a mapping of label to machine it draws a panel for each, a list of Axes.

    Width and height of a panel in inches; `pad` is the distance of its title, typographic points.
    """
    return lambda plot: _with_panels(plot, width, height, columns, pad)


def _with_panels(plot, width, height, columns, pad):
    """The plot, which draws a panel for each machine of a mapping."""
    own = inspect.signature(plot)
    first = next(iter(own.parameters))

    @wraps(plot)
    def drawn(*given, **options):
        call = own.bind(*given, **options)
        named, ax = call.arguments[first], call.arguments.get("ax")
        if not isinstance(named, Mapping):
            return plot(*given, **options)
        several = list(np.ravel(() if ax is None else ax))
        if named and ax is None:
            several = panels(len(named), columns, width, height)[1]
        checks.require(
            plot.__name__,
            None if named else "there is nothing to draw",
            None if len(several) == len(named) else f"ax must be {len(named)} Axes, got {checks.shown(ax)}",
        )
        for part, (label, item) in zip(several, named.items(), strict=True):
            call.arguments |= {first: item, "ax": part}
            plot(*call.args, **call.kwargs)
            part.set_title(": ".join(filter(None, [str(label), part.get_title()])), fontsize="medium", pad=pad)
        return several

    return drawn
