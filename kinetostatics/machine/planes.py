"""Planes: where along the crankshaft the groups of a mechanism move.

The library is planar. A machine with several throws has a plane for each, at a position z along the crankshaft, which
points to the viewer as x and y do in the drawing. Motion, reactions and torque do not depend on it; the moment that
rocks the frame, the reactions of two bearings and the torque between throws do (`mechanics.shaft`).

 group     its `plane`; else the plane of the crank pin or group to which it is attached; else 0
    pin       of the crank: its `plane`, or free for groups of several planes, as A is; of another link: that link's
    crank     that of its mass centre if its link is a `Rotor`; else 0

A group moves in the plane of its joint, because pins do not tilt. A group on another group or on a pin with a plane
may repeat that plane; any other plane is an error. Weight and loads on a link act in its plane.
"""

from typing import Any

import numpy as np

from ..numbers import checks
from ..numbers.planar import number_or_zero
from .group import CRANK, FRAME


def _stated(groups):
    """Pairs of a group and its known planes: its own and those of the parts to which it is attached."""
    joints: dict[str, Any] = {}
    links: dict[str, Any] = {}
    for group in groups:
        carried = [joints.get(name) for name in group.hangs_on]
        carried += [links.get(point.link) for point in group.joints.values() if point.link not in group.links]
        found = [plane for plane in (group.plane, *carried) if plane is not None]
        if group.links and not found:
            found = [0.0]
        plane = found[0] if found else None
        joints |= {name: plane for name, point in group.joints.items() if point.link != FRAME}
        links |= dict.fromkeys(group.links, plane)
        yield group, found


def planes_by_link(mechanism):
    """Position along the crankshaft by link, m; a number, or an array of designs."""
    found = {CRANK: number_or_zero(mechanism.crank.link.plane)}
    for group, stated in _stated(mechanism.groups):
        found |= dict.fromkeys(group.links, stated[0] if stated else 0.0)
    return found


def plane_problems(mechanism):
    """Yield the problem of each part whose plane differs from the plane of the part that carries it."""
    for group, stated in _stated(mechanism.groups):
        values = list(filter(checks.has_known_values, stated))
        if other := [value for value in values[1:] if not np.array_equal(values[0], value)]:
            kind = type(group).__name__
            what = next(iter(group.links), getattr(group, "name", kind))
            yield (
                f"{kind}: {what} has plane {checks.shown(values[0])} m, but the part that carries it has plane "
                f"{checks.shown(other[0])} m. Give the plane once, to the pin of the crank or to the group on it"
            )
