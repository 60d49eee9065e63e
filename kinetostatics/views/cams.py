"""Figures of cams: curves with the roller, pressure angle, curvature, contact pressure, and laws of motion."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.patches import Circle

from ..numbers import checks
from ..numbers.output_units import shown_units
from .axis_units import one_panel_each, with_units
from .canvas import ACCENT, FROM_X, INK, LOAD, STEEL, axes, close_curve, several_axes, with_line_styles
from .labels import label

POINTS_PER_TURN = 1440
"""Crank angles of a drawn curve over one turn."""
ANGLES_RULE = {"angles": checks.Number("deg", table=True)}
RADIUS_RULE = {"roller_radius": checks.Optional(checks.Number("m", low=0.0, strict=True))}
LIMIT_RULE = {"largest": checks.Optional(checks.Number("rad", low=0.0, strict=True))}
LIMIT_STYLE = {"color": ACCENT, "lw": 1.0, "ls": "--"}


@with_units
@one_panel_each(5.2, 4.6, 3)
def cam_profile(cam, roller_radius=None, side="disk", angles=(0, 120, 240), cutter_radius=None, ax=None):
    """A cam: pitch curve, working curve, the roller or face at some crank angles, and the path of a cutter.

    Parameters
    ----------
    cam : Cam or mapping of label to Cam
        Of ``ks.cams``. Several get a panel each.
    roller_radius : float
        m; None for the cam of a flat face.
    side : "disk" or "ring"
    angles : sequence of float
        Crank angles at which the roller is drawn, degrees.
    cutter_radius : float, optional
        m.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    >>> ks.plots.cam_profile(cam, roller_radius=0.05).get_aspect()
    1.0
    """
    angles = checks.check_values("cam_profile", ANGLES_RULE, {"angles": angles}, _cam_problem(cam))["angles"]
    ax = axes(ax)
    made = cam.profile(roller_radius, POINTS_PER_TURN, side)
    surface = close_curve(made.surface)
    if side == "disk":
        ax.fill(*surface, color=STEEL, alpha=0.25, lw=0)
    ax.plot(*surface, color=INK, lw=1.5, label="working curve")
    ax.plot(*close_curve(made.pitch), color=ACCENT, lw=0.8, ls="-.", label="pitch curve")
    if cutter_radius is not None:
        path = close_curve(made.cutter_path(cutter_radius))
        ax.plot(*path, color=LOAD, lw=0.8, ls="--", label="path of the cutter")
    posed = cam.profile(roller_radius, np.radians(angles), side)
    half_face = 0.3 * np.hypot(*made.surface).max()
    for degrees, centre, touch, (x, y) in zip(angles, posed.pitch.T, posed.surface.T, posed.normal.T, strict=True):
        if cam.flat:
            ax.plot(*(touch[:, None] + half_face * np.array([[-y, y], [x, -x]])), color=STEEL, lw=1.2)
        else:
            ax.add_patch(Circle(tuple(centre), posed.roller_radius, fc="none", ec=STEEL, lw=1.2))
        ax.plot(*np.stack([np.zeros(2), centre], axis=1), color=STEEL, lw=0.5, ls=":")
        ax.plot(*touch, ".", color=INK, ms=4)
        label(ax, f"{degrees:g}°", centre)
    ax.plot(0.0, 0.0, "+", color=INK, ms=8)
    label(ax, "O", (0.0, 0.0), fontsize="small")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set(xlabel="x [m]", ylabel="y [m]")
    ax.legend(frameon=False, fontsize="small", loc="upper right")
    return ax


@with_units
def cam_curvature(cams, roller_radius=None, side="disk", ax=None):
    """Curvature of pitch curves over the crank angle, and the limit for a roller.

    Parameters
    ----------
    cams : Cam or mapping of label to Cam
    roller_radius : float, optional
        m; a line shows the curvature from which the cam is undercut.
    side : "disk" or "ring"

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    >>> ks.plots.cam_curvature(cam, roller_radius=0.05).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    named = _items_by_label(cams, "cam_curvature", _cam_problem)
    side_problem = checks.choice("side", side, ("disk", "ring"))
    given = {"roller_radius": roller_radius}
    (radius,) = checks.check_values("cam_curvature", RADIUS_RULE, given, side_problem).values()
    ax = axes(ax)
    draw_each_over_turn(ax, named, lambda cam, angle: 1.0 / cam.curvature_radius(angle))
    if radius is not None:
        limit = (1.0 if side == "disk" else -1.0) / radius
        ax.axhline(limit, label=f"undercut by the roller, {side}", **LIMIT_STYLE)
    ax.axhline(0.0, color=INK, lw=0.5)
    return _label_axes(ax, "curvature of the pitch curve [1/m]", len(named) > 1 or radius is not None)


@with_units
def cam_pressure_angle(cams, largest=None, ax=None):
    """Pressure angle of cams over the crank angle, without a mechanism.

    Parameters
    ----------
    cams : Cam or mapping of label to Cam
    largest : float, optional
        A limit, rad, drawn on both sides of 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    >>> ks.plots.cam_pressure_angle(cam, largest=0.5).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    named = _items_by_label(cams, "cam_pressure_angle", _cam_problem)
    (largest,) = checks.check_values("cam_pressure_angle", LIMIT_RULE, {"largest": largest}).values()
    ax = axes(ax)
    draw_each_over_turn(ax, named, lambda cam, angle: np.degrees(cam.pressure_angle(angle)))
    for limit in () if largest is None else (-largest, largest):
        ax.axhline(np.degrees(limit), **LIMIT_STYLE)
    ax.axhline(0.0, color=INK, lw=0.5)
    return _label_axes(ax, "pressure angle [deg]", len(named) > 1)


@with_units
def contact_pressure(contacts, ax=None):
    """Hertz pressure of a roller or flat face on its cam over the crank angle.

    Lines mark changes of the contact side; the intervals in which a follower lifts off are shaded.

    Parameters
    ----------
    contacts : Contact, FollowerContact or mapping of label to one
        From ``ks.design.contact``.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    >>> saw = ks.cam_crank_slider(cam, 2.02, slider=ks.Link(600.0))
    >>> found = ks.design.contact(ks.Scene(saw, 10.0).solve(90), 0.05, 0.04, 210e9, 0.3)
    >>> ks.plots.contact_pressure(found).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    named = _items_by_label(contacts, "contact_pressure", _contact_problem)
    ax = axes(ax)
    for name, contact, style in with_line_styles(named):
        order = np.argsort(contact.crank_angle)
        (line,) = ax.plot(
            np.degrees(contact.crank_angle[order]), contact.pressure[order] / 1e6, linestyle=style, label=name
        )
        for angle in contact.changes:
            ax.axvline(np.degrees(angle), color=line.get_color(), lw=0.6, ls=":")
        lifted, period = getattr(contact, "lifted", ()), contact.solution.period
        shade = {"color": line.get_color(), "alpha": 0.12, "lw": 0}
        for span in lifted:
            for turns in (-1.0, 0.0, 1.0):  # an interval may pass the end of the period
                ax.axvspan(*np.degrees(np.clip(np.add(span, turns * period), 0.0, period)), **shade)
        if lifted:
            ax.fill_between([], [], label=f"{name}: lift-off" if name else "lift-off", **shade)
        if "pressure" in contact.limits:
            ax.axhline(contact.limits["pressure"] / 1e6, **LIMIT_STYLE)
    ax.set_ylim(0.0, 1.08 * ax.dataLim.ymax or 1.0)
    return _label_axes(ax, "Hertz pressure [MPa]", len(ax.get_legend_handles_labels()[1]) > 1)


@with_units
def law_motion(laws, ax=None):
    """Position, velocity, acceleration and jerk of laws over the turn, per radian of crank angle, in four axes.

    Parameters
    ----------
    laws : Law or mapping of label to Law
        Each over the whole turn, for example from ``ks.laws``.
    ax : sequence of 4 Axes, optional

    Returns
    -------
    sequence of 4 Axes

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> rise, back = ks.laws.cycloidal(1.7, 2.3, np.pi), ks.laws.cycloidal(2.3, 1.7, np.pi)
    >>> len(ks.plots.law_motion(ks.laws.joined(rise, back)))
    4
    """
    named = _items_by_label(
        laws, "law_motion", lambda law: None if callable(law) else f"must be a law, got {checks.shown(law)}"
    )
    four: Any = several_axes("law_motion", ax, 4, 1, (6.4, 7.2), sharex=True)
    factor, unit = shown_units().of("m")
    for order, part in enumerate(four):
        draw_each_over_turn(part, named, lambda law, angle, at=order: factor * law(angle)[at], 2 * POINTS_PER_TURN)
    texts = (f"position [{unit}]", f"velocity [{unit}/rad]", f"acceleration [{unit}/rad²]", f"jerk [{unit}/rad³]")
    for part, text in zip(four, texts, strict=True):
        part.set_ylabel(text)
    _label_axes(four[-1], texts[-1], False)
    if len(named) > 1:
        four[0].legend(frameon=False, fontsize="small")
    return four


def draw_each_over_turn(ax, named, value, points=POINTS_PER_TURN):
    """Draw ``value(item, angle)`` of each item over a turn of the crank; `angle` is an array, rad."""
    angle = np.linspace(0.0, 2 * np.pi, points + 1)
    for name, item, style in with_line_styles(named):
        ax.plot(np.degrees(angle), value(item, angle), linestyle=style, label=name)


def _label_axes(ax, text, legend):
    """Label the crank angle in degrees and the value `text`, and draw a legend if asked for; returns the Axes."""
    ax.set(xlabel=FROM_X.axis, ylabel=text)
    ax.set_xticks(np.arange(0, 361, 90))
    ax.set_xlim(0, 360)
    if legend:
        ax.legend(edgecolor="none", fontsize="small")
    return ax


def _items_by_label(items, owner, problem):
    """Checked items by label; a single one has the label ""."""
    named = dict(items) if isinstance(items, Mapping) else {"": items}
    wrong = [f"{name or 'it'} {text}" for name, item in named.items() if (text := problem(item))]
    checks.require(owner, *wrong, None if named else "there is nothing to draw")
    return named


def _cam_problem(cam):
    """Sentence on an object that is no cam, or None."""
    if not isinstance(cam, type) and all(hasattr(cam, name) for name in ("radius", "profile", "curvature_radius")):
        return None
    return f"must be one of ks.cams, got {checks.shown(cam)}"


def _contact_problem(found):
    """Sentence on an object that is no `Contact`, or None."""
    if hasattr(found, "largest_pressure"):
        return None
    return f"must be a Contact, as of ks.design.contact, got {checks.shown(found)}"
