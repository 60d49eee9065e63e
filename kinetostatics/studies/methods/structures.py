"""What groups declare of a mechanism, apart from its numbers: who is joined to whom, what slides, what a cam leads.

Independent methods are built from that, so that they know every group, a user's own too, by what it declares alone.
"""

from typing import Any, NamedTuple

import numpy as np

from ...machine.cams.cams import Circle, CosineLaw, Harmonic
from ...machine.group import FRAME
from ...machine.links import Sliding, Turning
from .method import NotGivenError

LINK = "mass", "along", "across", "inertia"
CAMS = {Circle: "circle", CosineLaw: "cosine law", Harmonic: "harmonic"}
"""Cams with a formula of their own, by what that is called."""
GIVEN = "given"
"""What any other curve is called: its values and derivatives are taken as it gives them."""


class Pinned(NamedTuple):
    """A reaction by name, on a link from another, where a joint holds both."""

    name: str
    link: str
    joint: str
    other: str


class Slid(NamedTuple):
    """A straight pair: a joint of a link slides along another, whose force and couple about `about` act on the link.

    `vector` is the name of the force as a vector, if it has one; the link points against a slot in which it is a rod.
    """

    link: str
    joint: str
    other: str
    force: str
    couple: str
    about: str
    vector: str
    rod: bool


class Cam(NamedTuple):
    """What leads a link: a `Led`, and the formula of its curve, with how many terms of cosines and sines it has."""

    link: str
    joint: str
    body: str
    force: str
    flat: bool
    curve: str
    terms: tuple[int, int]


class Part(NamedTuple):
    """Crank or group: links with reference joints, joints with the links that own them, bars (start, end, link)."""

    kind: str
    outputs: tuple[str, ...]
    links: tuple[tuple[str, str], ...]
    joints: tuple[tuple[str, str], ...]
    bars: tuple[tuple[str, str, str], ...]
    pinned: tuple[Pinned, ...]
    slid: tuple[Slid, ...]
    cams: tuple[Cam, ...]


class Structure(NamedTuple):
    """A mechanism apart from its numbers, but for those that are zero."""

    parts: tuple[Part, ...]
    zeros: frozenset[str]


def structure(mechanism):
    """Structure of a mechanism, and its numbers by name.

    Raises
    ------
    NotGivenError
        A group does not declare what holds its links.
    """
    owners = {name: point.link for name, point in mechanism.joints.items()}
    parts = tuple(_part(part, owners) for part in mechanism.parts)
    values: dict[str, Any] = {}
    for part in mechanism.parts:
        values |= _geometry(part)
    zeros = frozenset(name for name, value in values.items() if isinstance(value, int | float) and value == 0)
    for name, guide in mechanism.guides.items():
        values |= {f"{name}_guide_angle": float(guide.guide_angle), f"{name}_guide_offset": guide.guide_offset}
    for name, link in mechanism.links.items():
        values |= zip((f"{name}_{part}" for part in LINK), (link.mass, *link.centre, link.inertia), strict=True)
    return Structure(parts, zeros), values


def _part(part, owners):
    kind = type(part).__name__
    pinned: list[Pinned] = []
    slid: list[Slid] = []
    for name, pair in part.pairs.items():
        if isinstance(pair, Turning):
            pinned.append(Pinned(name, pair.link, pair.joint, pair.against or owners[pair.joint]))
        elif isinstance(pair, Sliding):
            rod = any(slot.rod == pair.link for slot in part.slots)
            couple, vector = part.outputs.get(pair.couple), name if name in part.outputs else ""
            about = pair.joint if couple is None else couple.at or pair.joint
            slid.append(Slid(pair.link, pair.joint, pair.against, pair.force, pair.couple, about, vector, rod))
    cams = tuple(Cam(*led, *_curve(part.cam)) for led in part.led)
    found = {*(item.name for item in pinned), *(cam.force for cam in cams)}
    found |= {name for item in slid for name in (item.force, item.couple, item.vector)}
    missing = part.outputs.keys() - found - {"balancing_torque"}
    held = {item.link for item in pinned} | {item.link for item in slid} | {item.other for item in pinned}
    free = part.links.keys() - held
    if missing or free:
        what = ", ".join(sorted(missing)) or f"what holds {', '.join(sorted(free))}"
        raise NotGivenError(f"{kind} does not declare in its pairs what equations of motion are made of: {what}")
    return Part(
        kind,
        tuple(part.outputs),
        tuple(part.references.items()),
        tuple((name, point.link) for name, point in part.joints.items()),
        tuple((bar.start, bar.end, bar.link) for bar in part.bars),
        tuple(pinned),
        tuple(slid),
        cams,
    )


def _curve(cam):
    name = CAMS.get(type(cam), GIVEN)
    return name, ((len(cam.cosine), len(cam.sine)) if isinstance(cam, Harmonic) else (0, 0))


def _geometry(part):
    """Places of joints on links, lengths and slots."""
    values: dict[str, Any] = {}
    for name, point in part.joints.items():
        values |= {f"{name}_along": point.along, f"{name}_across": point.across}
    for bar in part.bars:
        values[f"{bar.link}_length"] = bar.length
    for slot in part.slots:
        place = f"{slot.link}_{slot.joint}"
        values |= {f"{place}_offset": slot.offset, f"{place}_angle": slot.angle}
    return values


def leading(group, angle):
    """Numbers of the cams of a group by name; of one without a formula what it gives at the crank angles."""
    values: dict[str, Any] = {}
    for led in group.led:
        cam, link = group.cam, led.link
        kind = CAMS.get(type(cam), GIVEN)
        if kind == "circle":
            own: dict[str, Any] = {"radius": cam.pitch_radius, "x": cam.centre[0], "y": cam.centre[1]}
        elif kind == "cosine law":
            a, b = cam.amplitude, cam.mean
            singular = (np.sqrt(b * b + 8 * a * a) - b) / (4 * a)
            length = (b + a * singular) * np.sqrt(1 - singular * singular)
            own = {"amplitude": a, "mean": b, "angle": cam.guide_angle, "singular": singular, "length": length}
        elif kind == "harmonic":
            own = {"angle": cam.guide_angle, **{f"cosine{k}": value for k, value in enumerate(cam.cosine)}}
            own |= {f"sine{k}": value for k, value in enumerate(cam.sine, 1)}
        else:
            with np.errstate(invalid="ignore", divide="ignore"):
                own = {str(k): part for k, part in enumerate(cam.polar(angle, (np.cos(angle), np.sin(angle))))}
        values |= {f"{link}_cam_{name}": value for name, value in own.items()}
        joints = {**group.joints}
        pivot = joints.get(group.references[link])
        if pivot is not None and pivot.link == FRAME:
            values[f"{link}_from"] = np.arctan2(-pivot.across, -pivot.along)
            values[f"{link}_sense"] = -getattr(group, "assembly", 1)
    return values
