"""Data of a mechanism and its loads for independent methods, without the library's kernels.

`structure` lists the joints, straight pairs and cams that groups declare, so users' own groups are covered too.
`LoadForces` gives loads as forces at points and couples, `FrictionForces` gives the friction of joints; both use
complex numbers for vectors in the plane.
"""

from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...errors import NotGivenError
from ...machine.cams.cams import Circle, CosineLaw, Harmonic
from ...machine.group import FRAME
from ...machine.links import CamDriven, Rolling, Sliding, Turning
from ...machine.loads import (
    Force,
    GasSpring,
    Gravity,
    PointDamper,
    PointForce,
    PointSpring,
    Spring,
    Torque,
    TorsionDamper,
    TorsionSpring,
)
from ...machine.loads.points import point_on_link
from ...mechanics.load_values import evaluate_load, slider_push
from ...numbers.lazy import cached_property

LINK_NUMBERS = "mass", "along", "across", "inertia"
CURVE_NAMES = {Circle: "circle", CosineLaw: "cosine law", Harmonic: "harmonic"}
"""Cams with closed formulas, and the names of the formulas."""
SAMPLED_CURVE = "given"
"""Name of any other curve: the curve itself computes its values and derivatives."""


class PartStructure(NamedTuple):
    """Crank or group: links with reference joints, joints with their links, bars (start, end, link), and pairs by name.

    Pairs name their other link, and the reference joint of their couple. `rods` are links that point
    against their slots. `curve` is the formula of a cam's curve, with the numbers of cosines and sines in it.
    """

    kind: str
    outputs: tuple[str, ...]
    links: tuple[tuple[str, str], ...]
    joints: tuple[tuple[str, str], ...]
    bars: tuple[tuple[str, str, str], ...]
    pins: tuple[tuple[str, Turning], ...]
    slides: tuple[tuple[str, Sliding], ...]
    rods: tuple[str, ...]
    cams: tuple[CamDriven, ...]
    curve: tuple[str, tuple[int, int]]


class Structure(NamedTuple):
    """A mechanism without its numbers; `zeros` are the names of the zero numbers."""

    parts: tuple[PartStructure, ...]
    zeros: frozenset[str]


def structure(mechanism):
    """Structure of a mechanism, and its numbers by name; `NotGivenError` for a group without declared pairs."""
    owners = {name: point.link for name, point in mechanism.joints.items()}
    parts = tuple(_part_structure(part, owners) for part in mechanism.parts)
    values: dict[str, Any] = {}
    for part in mechanism.parts:
        for name, point in part.joints.items():
            values |= {f"{name}_along": point.along, f"{name}_across": point.across}
        for bar in part.bars:
            values[f"{bar.link}_length"] = bar.length
        for slot in part.slots:
            values |= {f"{slot.link}_{slot.joint}_offset": slot.offset, f"{slot.link}_{slot.joint}_angle": slot.angle}
    zeros = frozenset(name for name, value in values.items() if isinstance(value, int | float) and value == 0)
    for name, guide in mechanism.guides.items():
        values |= {f"{name}_guide_angle": float(guide.guide_angle), f"{name}_guide_offset": guide.guide_offset}
    for name, link in mechanism.links.items():
        values |= zip((f"{name}_{part}" for part in LINK_NUMBERS), (link.mass, *link.centre, link.inertia), strict=True)
    return Structure(parts, zeros), values


def _part_structure(part, owners):
    pins, slides = {}, {}
    for name, pair in part.pairs.items():
        if isinstance(pair, Turning):
            pins[name] = pair._replace(against=pair.against or owners[pair.joint])
        elif isinstance(pair, Sliding):
            slides[name] = pair._replace(about=pair.about or pair.joint)
    found = {*pins, *slides, *(cam.force for cam in part.led), "balancing_torque"}
    found |= {name for pair in slides.values() for name in (pair.force, pair.couple)}
    missing = part.outputs.keys() - found
    held = {link for pair in pins.values() for link in (pair.link, pair.against)}
    free = part.links.keys() - held - {pair.link for pair in slides.values()}
    if missing or free:
        what = ", ".join(sorted(missing)) or f"joints of {', '.join(sorted(free))}"
        declared = f"{type(part).__name__} does not declare its pairs"
        raise NotGivenError(f"{declared}, as equations of motion need: {what}")
    return PartStructure(
        type(part).__name__,
        tuple(part.outputs),
        tuple(part.references.items()),
        tuple((name, point.link) for name, point in part.joints.items()),
        tuple((bar.start, bar.end, bar.link) for bar in part.bars),
        tuple(pins.items()),
        tuple(slides.items()),
        tuple(slot.rod for slot in part.slots),
        tuple(part.led),
        _curve(getattr(part, "cam", None)),
    )


def _curve(cam):
    name = CURVE_NAMES.get(type(cam), SAMPLED_CURVE)
    return name, ((len(cam.cosine), len(cam.sine)) if isinstance(cam, Harmonic) else (0, 0))


def cam_numbers(group, angle):
    """Numbers of the cams of a group by name; values at the crank angles for a cam without a formula."""
    values: dict[str, Any] = {}
    for led in group.led:
        cam, link = group.cam, led.link
        kind, _ = _curve(cam)
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
        pivot = group.joints.get(group.references[link])
        if pivot is not None and pivot.link == FRAME:
            values[f"{link}_from"] = np.arctan2(-pivot.across, -pivot.along)
            values[f"{link}_sense"] = -getattr(group, "assembly", 1)
    return values


def dot(a, b):
    return (a.conjugate() * b).real


def cross(a, b):
    return (a.conjugate() * b).imag


def require_massless(spring):
    """Refuse a spring with mass, because these methods have no formula for its inertia."""
    if np.any(spring.mass):
        raise NotGivenError(f"there is no independent formula for a spring with mass, got {spring.mass} kg")


class LoadForces:
    """Loads of a `solution` as forces at points and couples on links, in one posture, which derived classes give.

    They define ``at(link)``: reference joint, axis, velocity of the joint and angular velocity of a link. For numbers
    other than NumPy's they also define ``number`` of a load's parameter, ``value`` of a load, ``expj``, ``arg`` and
    ``where``.
    """

    solution: Any
    mechanism: Any
    at: Any
    expj: Any = staticmethod(lambda angle: np.exp(1j * angle))
    arg: Any = staticmethod(np.angle)
    where: Any = staticmethod(np.where)

    def number(self, value):
        return value

    def value(self, item):
        """Force or moment of a load, N or N m, that may be a table or a function."""
        return (
            slider_push(item, self.solution) if hasattr(item, "push") else evaluate_load(item, self.solution).value_now
        )

    @cached_property
    def declared(self):
        """Structure of the mechanism, and its numbers by name."""
        return structure(self.mechanism)

    def way(self, pair):
        """Direction of a straight pair, along the guide or slot."""
        if pair.against == FRAME:
            return self.at(pair.link)[1]
        angle = self.number(self.declared[1][f"{pair.against}_{pair.joint}_angle"])
        return self.at(pair.against)[1] * self.expj(angle)

    def posture(self, link):
        """As ``at(link)``, also for the frame."""
        return (0.0, 1.0, 0.0, 0.0) if link in (None, FRAME) else self.at(link)

    def point(self, place):
        """Link, position and velocity of a place."""
        link, along, across = point_on_link(self.mechanism, place)
        offset = self.number(along) + 1j * self.number(across)
        joint, axis, shift, spin = self.posture(link)
        return link, joint + offset * axis, shift + 1j * spin * offset * axis

    def effects(self):
        """Effects of all loads except gravity, as of a single load."""
        for item in self.solution.loads:
            if hasattr(item, "push") and hasattr(item, "wrenches"):
                raise NotGivenError(f"there is no independent formula for a {type(item).__name__}")
            if hasattr(item, "push"):
                place, along, *_ = self.at(item.on)
                yield item.on, self.push(item, dot(along, place)) * along, place, 0.0
            elif not isinstance(item, Gravity):
                yield from self.of(item)

    def of(self, item):
        """Effects of a load: tuples of link, force, point of action, and couple on the link."""
        if isinstance(item, Force):
            link, position, _ = self.point(item.at)
            axis = self.posture(item.along)[1]
            return [(link, self.value(item) * self.expj(self.number(item.direction)) * axis, position, 0.0)]
        if isinstance(item, Torque | TorsionSpring | TorsionDamper):
            couple = self.couple(item)
            other = [] if item.against in (None, FRAME) else [(item.against, 0.0, 0.0, -couple)]
            return [(item.on, 0.0, 0.0, couple), *other]
        if isinstance(item, PointForce | PointSpring | PointDamper):
            (link, start, shift), (other, end, swing) = map(self.point, item.between)
            force = self.pull(item, start - end, shift - swing)
            return [(link, force, start, 0.0), (other, -force, end, 0.0)]
        raise NotGivenError(f"there is no independent formula for a {type(item).__name__}")

    def push(self, item, coordinate):
        """Force of a load along the guide of its slider, which is at a coordinate, N."""
        if isinstance(item, GasSpring):
            volume = self.number(item.volume) + item.side * self.number(item.area) * (coordinate - self.number(item.at))
            compressed = (self.number(item.volume) / volume) ** self.number(item.exponent)
            gauge = self.number(item.pressure) * compressed - self.number(item.ambient)
            return item.side * self.number(item.area) * gauge
        if not isinstance(item, Spring):
            return self.value(item)
        require_massless(item)
        elongation = coordinate - self.number(item.free_position)
        return -self.number(item.stiffness) * elongation - self.number(item.cubic) * elongation**3

    def couple(self, item):
        """Couple of a load on its link, N m."""
        if isinstance(item, Torque) and not item.opposing:
            return self.value(item)
        (_, axis, _, spin), (_, base, _, turning) = self.posture(item.on), self.posture(item.against)
        if isinstance(item, Torque):
            if np.any(np.equal(self.solution.crank_speed, 0.0)):
                raise NotGivenError("an opposing torque at rest has no independent formula")
            return self.value(item) * self.where(spin < turning, 1.0, -1.0)
        if isinstance(item, TorsionDamper):
            return -self.number(item.coefficient) * (spin - turning)
        angle = self.arg(axis / base * self.expj(-self.number(item.free_angle)))
        return self.number(item.moment) - self.number(item.stiffness) * angle

    def pull(self, item, apart, opening):
        """Force on the first point of a load between two points, by the vector between them and its rate."""
        distance = abs(apart)
        if isinstance(item, PointDamper):
            unit = self.where(distance > 0, apart, opening)
            size = abs(unit)
            unit = unit / self.where(size > 0, size, 1.0)
            return -self.number(item.coefficient) * dot(unit, opening) * unit
        unit = apart / self.where(distance > 0, distance, 1.0)
        if isinstance(item, PointForce):
            return self.value(item) * unit
        return -self.number(item.stiffness) * (distance - self.number(item.free_length)) * unit


MAX_FRICTION_ITERATIONS = 2000
"""Largest number of repeated solutions with friction."""


class FrictionForces:
    """Friction of joints as forces and couples, from the reactions in one posture (`acting`, a `LoadForces`).

    Friction depends on the reactions and changes them. `converge` repeats the solution with the last friction until it
    stops changing. Each repetition reduces the error by about the coefficient of friction.
    """

    def __init__(self, acting):
        solution = acting.solution
        if solution.friction.senses:
            raise NotGivenError("friction with a given sense, not that of the motion, has no independent formula")
        self._acting, self._friction = acting, solution.friction.acting
        self._number, self._speed = acting.number, acting.number(solution.crank_speed)

    def converge(self, solve, named, largest, limit):
        """Unknowns of the equations, consistent with the friction that their forces cause.

        ``solve(effects)`` solves the equations with added effects: link, force, point and couple; ``named(unknowns)``
        gives forces by name, ``largest(unknowns)`` their magnitude. `limit` is the largest last change relative to it.
        """
        found = solve(())
        for _ in range(MAX_FRICTION_ITERATIONS if self._friction else 0):
            before, found = found, solve(self._effects(named(found)))
            if largest(found - before) <= limit * largest(found):
                return found
        if self._friction:
            raise NotGivenError(f"forces and friction still change after {MAX_FRICTION_ITERATIONS} iterations")
        return found

    def along(self, forces):
        """Friction force of each sliding pair by name; it is part of the reaction."""
        pairs = self._acting.mechanism.pairs
        slides = {name: item for name, item in self._friction.items() if isinstance(pairs[name], Sliding)}
        return {name: self._sliding(name, pairs[name], item, forces)[0][1] for name, item in slides.items()}

    def _effects(self, forces):
        pairs = self._acting.mechanism.pairs
        return [
            effect
            for name, friction in self._friction.items()
            for effect in self._KINDS[type(pairs[name])](self, name, pairs[name], friction, forces)
        ]

    def _turning(self, name, pair, friction, forces):
        other = pair.against or self._acting.mechanism.joints[pair.joint].link
        turning = self._acting.posture(pair.link)[-1] - self._acting.posture(other)[-1]
        size = self._number(friction.mu) * self._number(friction.radius) * abs(forces[name])
        couple = -size * self._sign(turning)
        return [(pair.link, 0.0, 0.0, couple), (other, 0.0, 0.0, -couple)]

    def _sliding(self, name, pair, friction, forces):
        place, way = self._acting.point(pair.joint)[1], self._acting.way(pair)
        press = abs(forces[pair.force])
        if friction.half_length is not None:
            edges = abs(forces[pair.couple]) / self._number(friction.half_length)
            press = self._acting.where(edges > press, edges, press)
        sliding = dot(way, self._moving(pair.link, place) - self._moving(pair.against, place))
        force = -self._number(friction.mu) * press * self._sign(sliding) * way
        return [(pair.link, force, place, 0.0), (pair.against, -force, place, 0.0)]

    def _rolling(self, name, pair, friction, forces):
        """Effects of a roller on its link, and the opposite effects on the link of the curve.

        A force along the curve turns the roller. It balances the couple of the pin and that of the normal force, which
        acts ahead of the contact.
        """
        _, place, moving = self._acting.point(pair.joint)
        moving = moving - self._moving(pair.against, place)
        way = moving / abs(moving)
        radius, arm = self._number(friction.roller_radius), self._number(friction.rolling_arm)
        reach = self._number(friction.mu) * self._number(friction.pin_radius)
        pressed = forces[pair.force]
        side = self._sign(pressed) * self._sign(self._speed)  # of the motion along the curve
        spin = self._acting.posture(pair.against)[-1] - side * abs(moving) / radius
        # along and across the curve, force and pin load: along * radius = arm * across + reach * load
        least = (radius**2 - reach**2) ** 0.5
        along = abs(pressed) * (arm * radius + reach * (least**2 + arm**2) ** 0.5) / least**2
        couple = reach * (pressed**2 + along**2) ** 0.5 * self._sign(spin - self._acting.at(pair.link)[-1])
        force = -along * way
        return [(pair.link, force, place, couple), (pair.against, -force, place, -couple)]

    _KINDS: ClassVar = {Turning: _turning, Sliding: _sliding, Rolling: _rolling}

    def _moving(self, link, place):
        """Velocity of the point of a link at a place."""
        joint, _, shift, spin = self._acting.posture(link)
        return shift + 1j * spin * (place - joint)

    def _sign(self, part):
        return self._acting.where(part < 0, -1.0, 1.0)
