"""Interactive figures by Bokeh: curves over the crank angle, hodographs.

In each, `line 0`, `line 1` ... are the machines, `cursor` is the chosen crank angle, `tip 0` ... the points there.
"""

from typing import Any

import numpy as np

from ...errors import MissingLibraryError
from ...mechanics.quantities import of_scene, quantity, values
from ...numbers.formatting import pretty_unit
from ..canvas import close_curve, display_unit, drawn_limit, hidden_beyond, with_peaks

COLOURS = ("#1f4e79", "#b5482f", "#3a7d44", "#8a6d1d", "#6b4a8f", "#3f6f7f", "#8c3b5e", "#5a5a5a")
"""Quiet colours of the machines, in their order."""
DASHES = ("solid", "dashed", "dotdash", "dotted", "dashdot", "solid", "dashed", "dotdash")
"""Line styles of the machines; they distinguish curves in print without colour."""
SVG_DASHES = ("", "6", "2 4 6 4", "2 4", "6 4 2 4", "", "6", "2 4 6 4")
"""The same line styles as dash arrays of SVG, for the keys."""
FONT = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif"
TOOLS = "pan,box_zoom,wheel_zoom,reset,save"


def require_bokeh():
    """Import Bokeh; an error with the install command if it is missing."""
    try:
        import bokeh
    except ImportError:
        raise MissingLibraryError(
            'the report\'s figures need Bokeh, which is not installed: pip install "kinetostatics[report]"'
        ) from None
    return bokeh


def over_turn(solutions, name, height=300):
    """A quantity over the crank angle, for the machines that have it; of a vector the magnitude."""
    have = _having(solutions, name)
    known = quantity(next(iter(have.values())), name)
    found = {row: values(s, name) for row, s in have.items()}
    sight = drawn_limit(list(found.values()))
    found = {row: hidden_beyond(sight, value) for row, value in found.items()}
    factor, unit = display_unit(known.unit, found.values())
    curves = {row: (np.degrees(s.crank_angle), factor * found[row]) for row, s in have.items()}
    label = f"|{known.label}|" if known.vector else known.label
    return curves_over(list(solutions), curves, f"{label} [{pretty_unit(unit) or '1'}]", height)


def _having(solutions, name):
    """Solutions that have a quantity, by their row, with the crank angles of its extremes added."""
    return with_peaks({row: s for row, s in enumerate(solutions.values()) if name in of_scene(s)}, name)


def curves_over(names, curves, label, height=300):
    """Figure of curves (degrees, values) by the row of their machine, over the longest period."""
    from bokeh.models.annotations import Span

    plot = _plot(height, "crank angle [°]", label)
    period = max(_period(angle) for angle, _ in curves.values())
    for row in range(len(names)):
        angle, value = curves.get(row, (np.empty(0), np.empty(0)))
        if len(angle):
            own = _period(angle)
            turns = np.arange(max(1, round(period / own)))  # a closed curve over as many of its periods as fit
            angle = np.append((own * turns[:, None] + angle).ravel(), own * len(turns))
            value = np.append(np.tile(value, len(turns)), value[:1])
        _line(plot, row, names[row], {"angle": angle, "value": value})
    plot.x_range.update(start=0.0, end=period, bounds=(-0.02 * period, 1.02 * period))
    plot.below[0].ticker = np.linspace(0.0, period, 5).tolist()
    plot.add_layout(Span(location=0.0, dimension="height", line_color="#444444", line_width=1, name="cursor"))
    _hover(plot, [("", "@variant"), ("angle", "@angle{0.0}°"), ("value", "@value{0.0000 a}")], "vline")
    return plot


def _period(angle):
    """Period of crank angles over whole turns, degrees; the last step, after the last angle, is not among them."""
    return 360.0 * max(1, round((angle[-1] - angle[0] + np.max(np.diff(angle))) / 360.0)) if len(angle) > 1 else 360.0


def hodograph(solutions, name, height=420):
    """Hodograph of a vector over the turn, for the machines that have it."""
    from bokeh.models import ColumnDataSource, Scatter

    have = _having(solutions, name)
    vectors = {row: of_scene(s)[name].read(s) for row, s in have.items()}
    known = of_scene(next(iter(have.values())))[name]
    sight = drawn_limit([np.hypot(*vector) for vector in vectors.values()])
    vectors = {row: hidden_beyond(sight, vector) for row, vector in vectors.items()}
    factor, unit = display_unit(known.unit, vectors.values())
    plot = _plot(
        height, f"{known.label}, x [{pretty_unit(unit)}]", f"{known.label}, y [{pretty_unit(unit)}]", match_aspect=True
    )
    names = list(solutions)
    for row, name in enumerate(names):  # of a machine without it the line is empty
        angle = np.degrees(have[row].crank_angle) if row in have else np.empty(0)
        x, y = factor * vectors.get(row, np.empty((2, 0)))
        closed = close_curve(np.stack([angle, x, y]))
        _line(plot, row, name, dict(zip(("angle", "x", "y"), closed, strict=True)), "x", "y")
        tip = Scatter(x="x", y="y", size=9, fill_color=COLOURS[row % len(COLOURS)], line_color="white")
        _add(plot, f"tip {row}", ColumnDataSource({"x": x[:1], "y": y[:1]}), tip)
    text = "@x{0.0000 a}, @y{0.0000 a}"
    _hover(plot, [("", "@variant"), ("angle", "@angle{0.0}°"), ("x, y", text)], "mouse")
    return plot


def _plot(height, x_label, y_label, **options):
    from bokeh.models import PlainText
    from bokeh.models.annotations import Span
    from bokeh.plotting import figure

    plot: Any = figure(
        height=height, sizing_mode="stretch_width", tools=TOOLS, active_drag="box_zoom", active_scroll=None, **options
    )
    plot.toolbar.update(logo=None, autohide=True)
    for scale in (plot.x_range, plot.y_range):
        scale.only_visible = True
    plot.update(min_border_left=62, min_border_right=16, outline_line_color=None, background_fill_color=None)
    plot.border_fill_color = None
    for axis, label in ((plot.below[0], x_label), (plot.left[0], y_label)):
        axis.axis_label = PlainText(label)
        axis.update(axis_line_color="#b8bfc7", major_tick_line_color="#b8bfc7", minor_tick_line_color=None)
        axis.update(axis_label_text_font=FONT, axis_label_text_font_style="normal", axis_label_text_font_size="12px")
        axis.update(major_label_text_font=FONT, major_label_text_font_size="11px", major_label_text_color="#3d4852")
    plot.grid.grid_line_color = "#e4e8ec"
    plot.add_layout(Span(location=0.0, dimension="width", line_color="#9aa4ae", line_width=1))
    return plot


def _line(plot, row, name, columns, x="angle", y="value"):
    from bokeh.models import ColumnDataSource, Line

    source = ColumnDataSource({**columns, "variant": [name] * len(columns["angle"])})
    colour, dash = COLOURS[row % len(COLOURS)], DASHES[row % len(DASHES)]
    _add(plot, f"line {row}", source, Line(x=x, y=y, line_color=colour, line_dash=dash, line_width=2))


def _add(plot, name, source, glyph):
    """Add a glyph alone; Bokeh's own functions add a glyph each for selected, muted and other points."""
    from bokeh.models.renderers import GlyphRenderer

    plot.renderers.append(GlyphRenderer(data_source=source, glyph=glyph, name=name))


def _hover(plot, tooltips, mode):
    from bokeh.models import HoverTool

    lines = [item for item in plot.renderers if (item.name or "").startswith("line")]
    plot.add_tools(
        HoverTool(tooltips=tooltips, mode=mode, renderers=lines, line_policy="nearest", point_policy="snap_to_data")
    )
