"""Constraint equations of followers on a cam that turns with the crank: the distance from its pitch curve is zero.

The roller centre p, seen from the crank, is at C = n . (p - c) outside the nearest point c of the pitch curve. The unit
normal n there is the derivative of C by p, and kappa t t^T, with the curvature of the curve, the second. A flat face
keeps the distance h(psi) from O, by the angle psi of the cam from the face's normal. Multipliers are contact forces.
"""

from typing import Any, NamedTuple

import numpy as np

from ...machine.followers.flat import FlatFollower

ITERATIONS = 30


class Following(NamedTuple):
    """Equation `row`: a point of a link, so far along it, stays on the cam of a group that is fixed to the crank."""

    row: int
    crank: int
    link: int
    along: Any
    group: Any


class Gap(NamedTuple):
    """A distance, its derivatives by the coordinates of link and crank, x and y as one, and its second terms."""

    distance: Any
    normal: Any
    link_turn: Any
    crank_turn: Any
    second: Any


def gap(at, item, rates=None):
    """How far a follower is off its cam in a configuration, and with velocities its acceleration by them alone."""
    k = at.model.size
    spins = [0.0 if rates is None else rates[..., 2 * k + place] for place in (item.crank, item.link)]
    ray, axis = (at.cosine[..., place] + 1j * at.sine[..., place] for place in (item.crank, item.link))
    plane = at._plane(at.q)
    arm = item.along * axis
    apart = plane[..., item.link] + arm - plane[..., item.crank]
    speed: Any = 0.0
    if rates is not None:
        moving = at._plane(rates)
        speed = moving[..., item.link] + 1j * spins[1] * arm - moving[..., item.crank]
    turned = at.q[..., 2 * k + item.crank]
    if isinstance(item.group, FlatFollower):
        return _of_face(item, turned - at.q[..., 2 * k + item.link], apart, speed, axis, spins)
    return _of_roller(item, turned, (apart, speed, arm), ray, spins)


def _of_face(item, psi, apart, speed, axis, spins):
    angle = psi + item.group.guide.guide_angle
    law = item.group.cam.law(angle)
    height, aside = apart * axis.conj(), speed * axis.conj()
    turning, face = spins
    second = 2.0 * face * np.imag(aside) - face**2 * height.real - law.acceleration * (turning - face) ** 2
    return Gap(height.real - law.position, axis, height.imag + law.velocity, -law.velocity, second)


def _of_roller(item, turned, moved, ray, spins):
    apart, speed, arm = (part * ray.conj() for part in moved)
    disk, phi = item.group.disk, turned
    for _ in range(ITERATIONS):
        centre, first, second = disk.curve(phi)
        off = apart - centre
        phi = phi - _dot(off, first) / (_dot(off, second) - np.abs(first) ** 2)
    centre, first, second = disk.curve(phi)
    tangent = first / np.abs(first)
    normal = 1j * tangent
    curvature = -(np.conj(first) * second).imag / np.abs(first) ** 3
    turning, own = spins
    passing = speed - 1j * turning * apart
    rest = -(own**2) * arm - 2j * turning * speed - turning**2 * apart
    return Gap(
        _dot(normal, apart - centre),
        normal * ray,
        _dot(normal, 1j * arm),
        _dot(normal, -1j * apart),
        _dot(normal, rest) + curvature * _dot(tangent, passing) ** 2,
    )


def _dot(a, b):
    return (np.conj(a) * b).real
