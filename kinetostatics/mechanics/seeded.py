"""A solution on numbers that carry their derivatives by the logarithm of each length and of the crank angle."""

from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import Any

import numpy as np

from ..machine.cams import Cam
from ..machine.crank import ray
from ..machine.group import Group
from ..machine.guide import Guide
from ..machine.links import Link
from ..machine.loads import Load, ProcessForce, Table
from ..numbers.duals import Dual
from ..numbers.leaves import is_structural, mapped, with_fields
from .dynamics import Dynamics
from .pushes import amount, moving, pushed

STEP = 1e-4
"""Step of the crank angle for the third derivative of a cam that takes plain numbers only, rad."""


class Seeded:
    """`solution`: one at some points, with numbers that carry derivatives in place of its own."""

    def __init__(self, plain, points):
        self._plain, self._points, self._shape = plain, points, plain.shape or (1,)
        self._places = np.unravel_index(points, self._shape)
        lengths: list[Any] = []
        self._geometry(plain.mechanism, lengths.append)
        for item in plain.loads:
            mapped(_lengths(item), lengths.append)
        self._seeds, self._count = 0, len(lengths) + len(plain.loads) + 2
        self._angle = _array(self._seed(plain.crank_angle))
        mechanism = self._geometry(plain.mechanism, self._seed, {Group: self._group})
        speed, acceleration = mapped((plain.crank_speed, plain.crank_acceleration), self._constant)
        friction, sense = mapped((plain.friction, plain.sense), self._constant)
        idle = Dynamics(mechanism, self._angle, speed, acceleration, (), friction, sense)
        self.solution = replace(idle, loads=tuple(self._load(item, idle) for item in plain.loads))
        self.largest_pushes = {
            name: self._value(np.asarray(plain.largest(push))[..., None]) for name, push in plain.pushes.items()
        }

    def _geometry(self, item, number, special=None):
        """The item with its masses as they are, and other numbers in place of its lengths."""

        def link(own):
            mass, inertia = mapped((own.mass, own.inertia), self._constant)
            return with_fields(own, mass=mass, centre=mapped(own.centre, number), inertia=inertia)

        def guide(line):
            direction = (1.0, 0.0) if line.is_level else mapped(line.direction, self._constant)
            return with_fields(line, angle=None, guide_offset=mapped(line.guide_offset, number), exact=direction)

        return mapped(item, number, {Link: link, Guide: guide, **(special or {})})

    def _constant(self, value):
        return Dual(self._value(value)) if np.ndim(value) else value

    def _value(self, value):
        """Values at the points, one for all of a plain number."""
        if not np.ndim(value):
            return float(value)
        return np.broadcast_to(np.asarray(value, dtype=float), self._shape)[self._places]

    def _seed(self, value):
        value = self._value(value)
        return Dual(value, self._slopes(value))

    def _slopes(self, by_seed):
        """Derivatives by the next seed alone."""
        slopes = np.zeros((self._count, self._points.size))
        slopes[self._seeds] = by_seed
        self._seeds += 1
        return slopes

    def _group(self, group):
        parts = {
            field.name: self._geometry(getattr(group, field.name), self._seed)
            for field in fields(group)
            if not is_structural(field) and field.name != "cam"
        }
        if hasattr(group, "cam"):
            parts["cam"] = self._cam(group.cam)
        return with_fields(group, **parts)

    def _cam(self, cam):
        known, angle = self._seeds, self._plain.crank_angle
        plain = cam.polar(angle, ray(angle))
        try:
            copied = self._geometry(cam, self._seed)
            self._require_equal(copied.polar(self._angle, ray(self._angle)), plain)
        except Exception:  # whatever fails on numbers that are not plain
            self._seeds = known
            return _Values(self._tabled(cam, plain))
        return copied

    def _tabled(self, cam, plain):
        """Radius and derivatives of a cam that takes plain numbers only, by its size and by the crank angle."""
        angle = self._plain.crank_angle
        third = (
            (cam.polar(angle + STEP, ray(angle + STEP))[2] - cam.polar(angle - STEP, ray(angle - STEP))[2]) / 2 / STEP
        )
        values = [self._value(part) for part in (*plain, third)]
        by_angle, by_size = self._angle[0].slopes, self._slopes(1.0)
        return [_array(Dual(value, by_size * value + by_angle * slope)) for value, slope in pairwise(values)]

    def _load(self, item, idle):
        if not isinstance(item, Load):
            found = self._given(lambda: item.push(moving(idle)), pushed(item, self._plain))
            return ProcessForce(found, item.on)
        lengths = {name: mapped(part, self._seed) for name, part in _lengths(item)}
        copied = with_fields(mapped(item, self._constant), **lengths)
        if item.is_given:
            return copied
        return with_fields(copied, **{item.VALUE: self._value_of(item, idle)})

    def _value_of(self, item, idle):
        """What a table or function gives, with derivatives where it lets them through."""
        value = item.value_now
        if not isinstance(value, Table):
            return self._given(lambda: value(moving(idle)), amount(item, self._plain))
        pieces = [self._value(part) for part in value.pieces(self._plain)]
        return value.read(idle, [_array(Dual(part)) for part in pieces])

    def _given(self, compute, plain):
        """What a function of the user's computes, or its plain values where it takes plain numbers only."""
        known = self._seeds
        try:
            found = compute()
            self._require_equal([found], [plain])
        except Exception:  # whatever fails on numbers that are not plain
            self._seeds = known
            found = self._constant(plain)
        return _array(found) if isinstance(found, Dual) else found

    def _require_equal(self, parts, plain):
        for part, value in zip(parts, plain, strict=True):
            own = number_of(part).value
            if not np.allclose(own, self._value(value), rtol=1e-6, atol=0.0, equal_nan=True):
                raise ValueError("another value than by plain numbers")


def _lengths(item):
    """Name and value of each field of a load that holds lengths."""
    return tuple((name, getattr(item, name)) for name in getattr(item, "LENGTHS", ()))


@dataclass(frozen=True, eq=False)
class _Values(Cam):
    """A cam whose radius and derivatives are handed in."""

    values: Any

    def polar(self, angle, ray):
        return self.values


def _array(value):
    """The form in which kernels take numbers that are not plain."""
    found = np.empty(1, dtype=object)
    found[0] = value
    return found


def number_of(part):
    """The number in what a kernel gives; an absent one is zero."""
    part = np.ravel(part)[0] if isinstance(part, np.ndarray) else part
    return part if isinstance(part, Dual) else Dual(0.0 if part is None else float(part))
