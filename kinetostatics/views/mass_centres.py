"""Drawings of the common mass centre: its paths, and the principal points whose vectors lead to it."""

from typing import Any

import numpy as np

from ..mechanics.principal_points import principal_points as points_of
from ..numbers import checks
from ..solution.scene import solve
from . import drawings
from .axis_units import one_panel_each, with_units
from .canvas import (
    ACCENT,
    INK,
    ZERO_TOLERANCE,
    close_curve,
    grouped,
    single_solution,
    solutions_by_label,
    with_line_styles,
)
from .labels import label
from .strokes import at_angles, whole_turn

PRINCIPAL_POINT: dict[str, Any] = {"marker": "D", "ms": 4.5, "color": ACCENT, "ls": "", "zorder": 6}
PATHS: dict[str, dict[str, Any]] = {
    "mechanism": {"color": ACCENT, "lw": 1.6, "label": "path of S"},
    "before": {"color": INK, "lw": 1.2, "ls": ":", "label": "path of S before"},
}
SAME_POINT = 1e-6
"""Distance of principal points, relative to the reach of the links, up to which they share a label."""


@with_units
def mass_centres(solutions, angle=60, ax=None):
    """Paths of the common mass centre, at the scale of the mechanism (mower study, figures 5a, 5b).

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        Mechanisms of one geometry, with different masses; the first is drawn.
    angle : float
        Crank angle of the drawing, degrees, marked on every path.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bare = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> balanced = ks.balancing.partial(bare, crank=ks.Counterweight(arm=-0.05)).mechanism
    >>> solutions = {name: ks.Scene(item, 62.8).solve(90) for name, item in (("bare", bare), ("half", balanced))}
    >>> ks.plots.mass_centres(solutions).get_aspect()
    1.0
    """
    angle = checks.single_numbers("mass_centres", angle=(angle, "deg", {}))["angle"]
    named = solutions_by_label(solutions, "common mass centre")
    ax = drawings.mechanism(next(iter(named.values())), angles=(angle,), ax=ax)
    paths = {
        name: points_of(solution.mechanism, solution.loads).mass_centre(solution) for name, solution in named.items()
    }
    for name, solution, style in with_line_styles(named):
        points = points_of(solution.mechanism, solution.loads)
        reach = np.abs(solution.position(drawings.first_moving_joint(solution.mechanism))).max()
        rests = np.ptp(paths[name], axis=1).max() < ZERO_TOLERANCE * reach
        shown = {"marker": "o", "ms": 4, "ls": ""} if rests else {"linestyle": style}
        text = f"{name} (at rest)" if rests else name
        (line,) = ax.plot(*close_curve(paths[name]), label=text, zorder=5, **shown)
        ax.plot(*points.mass_centre(at_angles(solution, [angle])), "o", ms=4, color=line.get_color(), zorder=6)
    ax.legend(frameon=False, fontsize="small", title="path of the common mass centre", title_fontsize="small")
    return ax


@with_units
@one_panel_each(5.2, 4.6, 2)
def principal_points(mechanism, angle=60, before=None, ax=None):
    """Principal points H1, H2 ... on the links, the contour of their vectors from O, and the common mass centre S.

    H of a link is at h from its reference joint, fixed in the link. The vectors h, added from O, lead to S
    (mower study, figures 2, 5a, 5b). The contour stays parallel to the links. The path of S over the turn is also
    drawn, with `before` also the path of the machine before its counterweights.

    Parameters
    ----------
    mechanism : Mechanism, Solution or mapping of label to one
        Of one design. Several get a panel each. With a solution the masses of its springs count too.
    angle : float
        Crank angle of the drawing, degrees.
    before : Mechanism, optional
        The same mechanism with other masses.

    Raises
    ------
    ParameterError
        The argument is not a mechanism, is a batch of designs, or has no mass.
    AssemblyError
        The mechanism does not close at that crank angle.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bare = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> balanced = ks.balancing.partial(bare, crank=ks.Counterweight(arm=-0.035)).mechanism
    >>> ax = ks.plots.principal_points(balanced, 60, before=bare)
    >>> [text.get_text() for text in ax.texts if text.get_text()[0] in "HS"]
    ['H1', 'H2', 'H3', 'S']
    """
    angle = checks.single_numbers("principal_points", angle=(angle, "deg", {}))["angle"]
    given = {"mechanism": mechanism} | ({} if before is None else {"before": before})
    loads = {name: getattr(item, "loads", ()) for name, item in given.items()}
    given = {name: getattr(item, "mechanism", item) for name, item in given.items()}
    checks.require("principal_points", *(checks.mechanism(name, item) for name, item in given.items()))
    pose = solve(given["mechanism"], np.radians([angle]), crank_speed=1.0)
    ax = drawings.mechanism(pose, angles=(angle,), ax=ax)
    points = points_of(given["mechanism"], loads["mechanism"])
    corners = np.concatenate(points.contour(pose), axis=-1)
    _draw_points(ax, pose, points.vectors(pose))
    ax.plot(*corners, color=ACCENT, lw=1.0, ls="--", marker=".", ms=3, zorder=5, label="contour of the vectors h")
    for name, item in given.items():
        turn = whole_turn(single_solution(solve(item, [0.0], crank_speed=1.0, on_gap="nan")))
        path = points_of(item, loads[name]).mass_centre(turn)
        ax.plot(*path, zorder=5, **PATHS[name])
    ax.plot(*corners[:, -1], marker="o", ms=6, color=ACCENT, zorder=6.5)
    label(ax, "S", corners[:, -1], color=ACCENT, fontsize="small")
    ax.legend(frameon=False, fontsize="small")
    return ax


def _draw_points(ax, pose, vectors):
    """Draw H of each link with mass or a carried mass; numbers count all links from the crank outwards."""
    mechanism = pose.mechanism
    places = {
        f"H{number}": (pose.position(mechanism.references[name]) + vectors.get(name, 0.0))[:, 0]
        for number, (name, link) in enumerate(mechanism.links.items(), 1)
        if name in vectors or link.mass != 0.0
    }
    near = SAME_POINT * max(np.abs(pose.position(joint)).max() for joint in mechanism.joints)
    for names in grouped(places, lambda one, other: np.hypot(*(places[other] - places[one])) < near):
        ax.plot(*places[names[0]], **PRINCIPAL_POINT)
        label(ax, ", ".join(names), places[names[0]], color=ACCENT, fontsize="small")
