"""Rockers whose pin is the crank pin of a group that passes change points.

The angle of the rocker is followed over a turn of the crank, once, when the mechanism is made. It is `Carrier.turns`
times the crank angle plus a remainder within half a turn about `Carrier.degrees`; both numbers are part of the
structure.
"""

from contextlib import suppress

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import TURN
from ...numbers.brackets import find_roots
from ...numbers.parameter_tree import replace_unchecked
from ..crank import Crank
from ..kinematic_state import Throw, place
from .branches import SEVERAL_DESIGNS

ANGLES = np.linspace(0.0, TURN, 721)
"""Crank angles at which the rocker is followed, rad."""
MAX_REMAINDER = 165.0
"""Largest remainder of a rocker's angle, degrees: at 180 the cosine of its half changes its sign."""
ANGLE_TOLERANCE = 1e-9
"""Difference of angles, rad, or turns that is rounding."""
AWAY = 0.0123
"""Crank angle at which the search for change points begins, rad; a change point there is unlikely."""


def on_rocker(group, groups, throws):
    """A group of a chain with its passage through change points on the pin of a rocker."""
    placement = Crank(throws["A"].at[0] if "A" in throws else None).place(ANGLES)
    links: dict[str, str] = {}
    with np.errstate(all="ignore"), suppress(KeyError):  # of joints that no part places
        for other in groups:
            own = _on_rocker(other, placement, links) if other.through and other.on not in throws else other
            if other is group:
                return own
            place(own, placement)
            links |= {name: point.link for name, point in own.joints.items()}
    return _on_rocker(group, placement, links)


def _on_rocker(group, placement, links):
    swing = placement.course(group.on).swing
    if swing is None:
        group.refuse_word("a pin of the crank at a constant radius or of a rocker")
    centre, radius, direction = swing
    passage, link = group.passage_on(Throw((radius, 0.0), ahead=True), centre), links[group.on]
    if not passage:
        return replace_unchecked(group, passage="")
    x, y, _ = np.broadcast_arrays(*direction, ANGLES)
    angle = np.unwrap(np.arctan2(y, x))
    angle = angle + TURN * (angle[..., :1] < ANGLE_TOLERANCE - np.pi)
    turned, problem = np.ravel(angle[..., -1] - angle[..., 0]) / TURN, None
    if not np.ptp(angle):
        problem = "stands still"
    elif not np.all(abs(turned - np.round(turned[0])) < ANGLE_TOLERANCE):
        problem = "does not repeat its motion after a turn of the crank, or not so in all designs"
    else:
        turns = round(float(turned[0]))
        rest = np.degrees(angle - turns * ANGLES)
        degrees = round(float(rest.max() + rest.min()) / 2.0)
        problem = "turns too unevenly" if np.max(abs(rest - degrees)) > MAX_REMAINDER else None
    text = f"assembly {group.assembly!r} on {group.on!r}: the {link} {problem}; give +1 or -1"
    checks.require(group.RULES.owner, text if problem else None)
    return replace_unchecked(group, passage=f"{passage} {turns} {degrees} {link}")


def change_points(mechanism, group, known):
    """Yield crank angles in [0, 2 pi) of the change points that a group passes on a rocker, rad, without `known`."""

    def distance(angle, _=None):
        return group.placed(mechanism.place(angle)).divisor[1]

    grid = ANGLES + AWAY
    values = distance(grid)
    checks.require("change points", SEVERAL_DESIGNS if values.ndim > 1 else None)
    change = np.flatnonzero(values[1:] * values[:-1] < 0.0)
    found = np.mod(find_roots(distance, grid[change], grid[change + 1]) + ANGLE_TOLERANCE, TURN) - ANGLE_TOLERANCE
    for angle in found.clip(0.0).tolist():
        if all(abs(angle - other) > ANGLE_TOLERANCE for other in known):
            yield angle
