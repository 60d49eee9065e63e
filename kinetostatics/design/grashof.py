"""Class of a four-bar by Grashof's rule: which joints turn fully, and at which crank angles it closes."""

from dataclasses import dataclass
from math import asin, atan2, pi, sqrt

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from . import shapes

CHANGE_POINT = 1e-12
"""Difference of the sums of lengths, relative to them, below which a four-bar can reach a change point."""


@dataclass(frozen=True)
class Grashof:
    """Class of a four-bar by Grashof's rule.

    Attributes
    ----------
    kind : str
        "crank-rocker", "double-crank", "double-rocker", "rocker-crank" (Grashof linkages, by the shortest link),
        "change-point", or "triple-rocker".
    turning_joints : tuple of str
        Joints whose two links turn fully against each other.
    intervals : tuple of (float, float)
        Crank-angle intervals in which it closes, rad, start in [0, 2 pi); one whole turn if the crank turns fully.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.linkage.grashof(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)))
    Grashof(kind='crank-rocker', turning_joints=('O', 'A'), intervals=((0.0, 6.283185307179586),))
    """

    kind: str
    turning_joints: tuple[str, ...]
    intervals: tuple[tuple[float, float], ...]


KINDS = {"crank": "crank-rocker", "coupler": "double-rocker", "rocker": "rocker-crank", "frame": "double-crank"}
"""Kind of a Grashof linkage by its shortest link."""


def grashof(mechanism):
    """Grashof class of a four-bar, the joints that turn fully, and the crank angles at which it closes.

    The shortest link turns fully against its neighbours if it and the longest are together shorter than the other two
    (Grashof's rule, as in Uicker, Pennock and Shigley). Equality makes a change-point linkage: there the links come to
    lie in one line, velocities at that angle are undefined, and on both sides of it the assembly is the chosen one.

    Parameters
    ----------
    mechanism : Mechanism
        A four-bar of one design.

    Returns
    -------
    Grashof

    Raises
    ------
    ParameterError
        The mechanism is no four-bar of one design, or its pivots coincide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.linkage.grashof(ks.four_bar(0.4, 0.3, 0.35, rocker_pivot=(0.3, 0.0)))
    >>> found.kind, [[round(end, 4) for end in interval] for interval in found.intervals]
    ('triple-rocker', [[3.9104, 8.656]])
    """
    crank, coupler, rocker, pivot = four_bar_of(mechanism)
    frame = np.hypot(*pivot)
    lengths = {"crank": crank.length, "coupler": coupler.length, "rocker": rocker.length, "frame": frame}
    ends = {
        "crank": (crank.start, crank.end),
        "coupler": (coupler.start, coupler.end),
        "rocker": (rocker.end, rocker.start),
        "frame": (rocker.start, crank.start),
    }
    if any(np.ndim(length) for length in lengths.values()):
        raise ParameterError("Grashof's rule is for one design at a time, got a batch of lengths")
    if frame == 0:
        raise ParameterError("Grashof's rule needs a frame: the rocker's pivot lies at O")
    ordered = sorted(lengths, key=lambda name: lengths[name])
    outer = lengths[ordered[0]] + lengths[ordered[3]]
    inner = lengths[ordered[1]] + lengths[ordered[2]]
    joints: tuple[str, ...]
    kind, joints = KINDS[ordered[0]], ends[ordered[0]]
    change_point = abs(outer - inner) <= CHANGE_POINT * inner
    if change_point:
        kind = "change-point"
        shortest = (name for name in ordered if lengths[name] <= lengths[ordered[0]] * (1 + CHANGE_POINT))
        joints = tuple(dict.fromkeys(joint for name in shortest for joint in ends[name]))
    elif outer > inner:
        kind, joints = "triple-rocker", ()
    slack = 8 * CHANGE_POINT if change_point else 0.0
    return Grashof(kind, joints, _closed_intervals(lengths, atan2(pivot[1], pivot[0]), slack))


def four_bar_of(mechanism):
    """The bars of a four-bar; an error for any other mechanism."""
    checks.require("linkage", checks.mechanism("mechanism", mechanism))
    bars = shapes.four_bar(mechanism)
    if bars is None:
        raise ParameterError(f"this is for four-bars, not for a {mechanism.name}")
    return bars


def _closed_intervals(lengths, frame_angle, slack):
    """Crank angles at which A is no nearer to O2 than the difference of coupler and rocker and no farther than the sum.

    At the distance D the crank stands at theta from the frame line, sin^2(theta / 2) = (D^2 - (r - b)^2) / (4 r b);
    within `slack` of 0 or 1, as rounding of the lengths of a change-point linkage makes it, it is 0 or 1.
    """
    r, b = lengths["crank"], lengths["frame"]

    def at_distance(distance):
        square = (distance - (r - b)) * (distance + (r - b)) / (4 * r * b)
        return 2 * asin(sqrt(0.0 if square <= slack else 1.0 if square >= 1 - slack else square))

    near = at_distance(abs(lengths["coupler"] - lengths["rocker"]))
    far = at_distance(lengths["coupler"] + lengths["rocker"])
    turn = 2 * pi
    if far <= near:
        return ()
    if near == 0 and far == pi:
        return ((0.0, turn),)
    if near == 0:
        pieces = [(frame_angle - far, frame_angle + far)]
    elif far == pi:
        pieces = [(frame_angle + near, frame_angle + turn - near)]
    else:
        pieces = [(frame_angle + near, frame_angle + far), (frame_angle - far, frame_angle - near)]
    return tuple(sorted((start % turn, start % turn + end - start) for start, end in pieces))
