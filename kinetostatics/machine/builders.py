"""Builders of common mechanisms: crank-slider, four-bar, slotted lever and Scotch yoke, with or without a cam."""

import warnings

import numpy as np

from ..numbers import checks
from .cams.cam_roller import CamRoller
from .cams.cams import CosineLaw, LawCam
from .crank import Crank
from .followers.translating import RollerFollower
from .groups.lever import LeverGroup
from .groups.rocker import RockerGroup
from .groups.slider import SliderGroup
from .groups.yoke import YokeGroup
from .guide import Guide
from .links import Link, present
from .mechanism import Mechanism

LEVEL_GUIDE = Guide()
"""The guide along +x through O."""


def crank_slider(
    crank_length,
    coupler_length,
    *,
    guide_angle=0.0,
    guide_offset=0.0,
    guide=None,
    assembly=+1,
    crank=Link(),
    coupler=Link(),
    slider=Link(),
) -> Mechanism:
    """Plain crank-slider: crank O-A, coupler A-B, slider B on a straight guide.

    Parameters
    ----------
    crank_length, coupler_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    guide_angle : float
        Direction of the guide from +x, rad.
    guide_offset : float or array
        Signed distance of the guide from O along the guide's left normal, m.
    guide : Guide
        Replaces `guide_angle` and `guide_offset`; from ``Guide.through(W1, W2)``, for example.
    assembly : +1, -1, "open" or "crossed"
        Slider ahead of A along the guide (+1) or behind it (-1). "open" starts as +1 and "crossed" as -1, in the half
        turn behind the guide's right normal. Both pass change points, for example where coupler and crank are equally
        long and the guide runs through O. Without change points they keep that side.
    crank, coupler, slider : Link
        Mass properties; a link left out has no mass and costs nothing.

    Raises
    ------
    ParameterError
        A value is impossible, or both ways of giving the guide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> round(float(ks.solve(pump, 0.5, crank_speed=100.0).balancing_torque), 4)  # N m at 0.5 rad
    14.8753
    """
    group = SliderGroup(coupler_length, _guide(guide, guide_angle, guide_offset), assembly, coupler, slider)
    return Mechanism("crank-slider", Crank(crank_length, crank), (group,))


def cam_crank_slider(
    cam,
    coupler_length,
    *,
    guide_angle=0.0,
    guide_offset=0.0,
    guide=None,
    assembly=+1,
    crank=Link(),
    block=Link(),
    coupler=Link(),
    slider=Link(),
    roller=None,
) -> Mechanism:
    """Cam-balanced crank-slider: slotted crank, block with a roller on a fixed cam, coupler and slider.

    Parameters
    ----------
    cam : cams.Circle, cams.CosineLaw, cams.Harmonic or cams.Sampled
        Fixed cam, by the pitch curve of the roller centre.
    coupler_length, guide_angle, guide_offset, guide, assembly, crank, coupler, slider
        As for `crank_slider`; the mass centre of the slotted crank lies on it at a constant distance from O.
    block : Link
        Block with roller; reference joint A, along the crank ray.
    roller : Roller, optional
        Size and material of the roller, for its contact pressure.

    Raises
    ------
    ParameterError
        A value is impossible, or both ways of giving the guide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.cam_crank_slider(ks.cams.Circle(0.2, (-0.05, 0.0)), 0.8)
    >>> round(float(ks.solve(saw, 0.0, crank_speed=10.0).slider_position), 12)
    0.95
    """
    group = SliderGroup(coupler_length, _guide(guide, guide_angle, guide_offset), assembly, coupler, slider)
    if isinstance(cam, CosineLaw | LawCam):
        own, offset = group.guide, getattr(cam, "guide_offset", 0.0)
        direction = np.cos(own.guide_angle - cam.guide_angle)
        length, wanted = group.coupler_length, cam.coupler_length
        facts = (
            (f"guide_offset {own.guide_offset} m is not {offset:.9g}", own.guide_offset, offset),
            (f"assembly {group.assembly} is not +1", group.assembly, 1.0),
            (f"guide_angle {own.guide_angle} is not the cam's {cam.guide_angle}", direction, 1.0),
            (f"coupler_length {length} m is not the cam's {wanted} m", length, wanted),
        )
        known = [fact for fact in facts if all(map(checks.has_known_values, fact[1:]))]
        wrong = [text for text, value, by_law in known if np.any(np.abs(value - by_law) > 1e-9)]
        if wrong:
            kind = "cosine law" if isinstance(cam, CosineLaw) else "law"
            warnings.warn(f"the slider will not follow the {kind} of its cam: {'; '.join(wrong)}", stacklevel=2)
    return Mechanism("cam-balanced crank-slider", Crank(None, crank), (CamRoller(cam, block, roller), group))


def crank_slider_parts(mechanism):
    """(cam roller or None, slider group) of a mechanism by `crank_slider` or `cam_crank_slider`; None for others."""
    *before, last = mechanism.groups or (None,)
    rollers = [group for group in before if isinstance(group, CamRoller)]
    if not isinstance(last, SliderGroup) or (last.on, last.label) != ("A", "") or not len(before) == len(rollers) <= 1:
        return None
    return (rollers[0] if rollers else None), last


def with_roller_follower(mechanism, name, law, guide, follower, pin, label):
    """A machine under another name with a cam on its crank that moves a roller follower, the last of its groups."""
    added = RollerFollower(law, guide, follower, pin=pin, label=label)
    return Mechanism(name, mechanism.crank, (*mechanism.groups, added))


def four_bar(
    crank_length,
    coupler_length,
    rocker_length,
    *,
    rocker_pivot,
    assembly=+1,
    crank=Link(),
    coupler=Link(),
    rocker=Link(),
) -> Mechanism:
    """Four-bar: crank O-A, coupler A-B, rocker O2-B.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    rocker_pivot : (x, y)
        Fixed pivot O2 of the rocker, m.
    assembly : +1, -1, "open" or "crossed"
        B to the left of the direction from A to O2 (+1) or to the right (-1). In the half turn behind the
        direction O -> O2 "open" starts as +1 and "crossed" as -1. Both pass change points as inertia carries the links,
        so a parallelogram stays a parallelogram; without change points they keep that side. Lengths equal within 8 ulp
        of the longest make a change point. `Mechanism.turns` is the number of turns after which the branch closes.
    crank, coupler, rocker : Link
        Mass properties; a link left out has no mass and costs nothing.

    Raises
    ------
    ParameterError
        A value is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bars = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(2.0, 0.15, 0.02))
    >>> bool(ks.solve(bars, 0.7, crank_speed=10.0).power_residual < 1e-13)
    True
    """
    group = RockerGroup(coupler_length, rocker_length, rocker_pivot, assembly, coupler, rocker)
    return Mechanism("four-bar", Crank(crank_length, crank), (group,))


def slotted_lever(
    crank_length, *, pivot, offset=0.0, assembly=+1, crank=Link(), lever=Link(), block=Link()
) -> Mechanism:
    """Slotted lever: crank O-A, block at A sliding in a lever about a fixed pivot (crank shaper, Whitworth).

    Parameters
    ----------
    crank_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    pivot : (x, y)
        Fixed pivot O2, m. The lever rocks if O2 is farther from O than A, and makes full turns if it is nearer.
    offset : float or array
        Distance of the slot's axis to the left of the pivot, m.
    assembly : +1, -1, "open" or "crossed"
        The slot points to the block (+1) or away from it (-1). "open" starts as +1 and "crossed" as -1, in the half
        turn behind the direction O -> O2. Both pass change points. If the crank is as long as the distance of the
        pivot, the block passes the pivot. The lever then turns half as fast as the crank, and the motion closes after
        two turns. Without change points they keep that side.
    crank, lever, block : Link
        Mass properties; a link left out has no mass and costs nothing.

    Raises
    ------
    ParameterError
        A value is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> shaper = ks.slotted_lever(0.1, pivot=(0.0, -0.2), lever=ks.Link(8.0, 0.3, 0.4))
    >>> round(float(ks.solve(shaper, 0.0, crank_speed=6.0).rate("lever")), 12)
    1.2
    """
    group = LeverGroup(pivot, offset=offset, lever=lever, block=block, assembly=assembly)
    return Mechanism("slotted lever", Crank(crank_length, crank), (group,))


def scotch_yoke(
    crank_length,
    *,
    guide_angle=0.0,
    guide_offset=0.0,
    guide=None,
    slot_angle=np.pi / 2,
    crank=Link(),
    slider=Link(),
    block=Link(),
) -> Mechanism:
    """Scotch yoke: crank O-A, block at A in the slot of a slider on a straight guide.

    Parameters
    ----------
    crank_length : float or array
        m; arrays of shape (designs, 1) make a batch.
    guide_angle, guide_offset, guide
        As for `crank_slider`.
    slot_angle : float or array
        Angle of the slot from the guide's direction, rad; not 0 or pi.
    crank, slider, block : Link
        Mass properties; a link left out has no mass and costs nothing.

    Raises
    ------
    ParameterError
        A value is impossible, a slot parallel to the guide, or both ways of giving the guide.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.scotch_yoke(0.05, slider=ks.Link(mass=2.0))
    >>> round(float(ks.solve(pump, 0.0, crank_speed=10.0).slider_acceleration), 12)
    -5.0
    """
    group = YokeGroup(_guide(guide, guide_angle, guide_offset), slot_angle, slider=slider, block=block)
    return Mechanism("Scotch yoke", Crank(crank_length, crank), (group,))


def _guide(guide, angle, offset):
    if guide is None:
        is_level = type(angle) is type(offset) is float and angle == offset == 0.0
        return LEVEL_GUIDE if is_level else Guide.at(angle, offset)
    free = present(angle) is None and present(offset) is None
    checks.require("guide", None if free else "give either guide or guide_angle and guide_offset")
    return guide
