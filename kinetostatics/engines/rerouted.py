"""A solution whose motion is found in another way: joints by any method, links and forces as in the library."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property, partial
from typing import Any

import numpy as np

from ..errors import NotGivenError
from ..machine.cam_roller import CamRoller
from ..machine.chain import Placement
from ..machine.crank import ray
from ..machine.links import Joint, LinkMotion
from ..machine.mechanism import Mechanism
from ..machine.rocker_group import RockerGroup, RockerMotion
from ..machine.slider_group import SliderGroup, SliderMotion
from ..numbers.planar import cross, dot, subtracted, turned, vector
from ..solution.solution import Solution

SERIES_SAMPLES = 512
"""Positions over the turn from which the coefficients of harmonic series are found."""


@dataclass(frozen=True, eq=False)
class Rerouted(Solution):
    """A solution whose placement comes from ``way(mechanism, crank_angle)`` instead of the groups' closed forms."""

    way: Callable[[Any, Any], Placement] = Mechanism.place

    @cached_property
    def placement(self):
        return self.way(self.mechanism, self.crank_angle)


def rerouted(solution, way, **changes):
    """The solution with another way to its placement, nothing of it computed yet."""
    given = {field.name: getattr(solution, field.name) for field in fields(Solution)} | changes
    return Rerouted(**given, way=way)


def assembled(mechanism, angle, joints) -> Placement:
    """Placement of a mechanism whose moving joints are known, by name, with their derivatives."""
    placement = mechanism.crank.place(angle)
    for group in mechanism.groups:
        _ASSEMBLE[type(group)](group, placement, joints)
    return placement


def _roller(group, placement, joints):
    joint = joints["A"]
    placement.joints["A"] = joint
    placement.links["block"] = LinkMotion(joint, placement.ray, 1.0, None)
    placement.details["cam"] = tuple(dot(vector(part), placement.ray) for part in joint)


def _slider(group, placement, joints):
    coupler_name, slider_name = group.links
    pin = placement.joints[group.pin] = joints[group.pin]
    direction = group.guide.direction
    coupler = _between(placement.joints[group.on], pin, group.coupler_length)
    slider = LinkMotion(pin, direction, None, None)
    sine, cosine = cross(direction, coupler.direction), dot(direction, coupler.direction)
    travel = Joint(*(dot(direction, part) for part in pin))
    placement.links |= {coupler_name: coupler, slider_name: slider}
    placement.details[slider_name] = SliderMotion(coupler, slider, sine, cosine, cosine, None, travel)


def _rocker(group, placement, joints):
    coupler_name, rocker_name = group.links
    pin = placement.joints[group.pin] = joints[group.pin]
    pivot = placement.joints[group.pivot_name] = Joint(tuple(group.pivot), None, None)
    coupler = _between(placement.joints[group.on], pin, group.coupler_length)
    rocker = _between(pivot, pin, group.rocker_length)
    q, p = coupler.direction, rocker.direction
    placement.links |= {coupler_name: coupler, rocker_name: rocker}
    sine, cosine = cross(q, p), dot(q, p)
    placement.details[rocker_name] = RockerMotion(coupler, rocker, pin, sine, cosine, sine, None)


_ASSEMBLE = {CamRoller: _roller, SliderGroup: _slider, RockerGroup: _rocker}


def _between(start, end, length):
    """Link from joint to joint: its direction and rate by the difference of their positions and velocities."""
    direction, first, second = (
        tuple(part / length for part in vector(subtracted(b, a))) for a, b in zip(start, end, strict=True)
    )
    return LinkMotion(start, direction, cross(direction, first), cross(direction, second))


def moving(mechanism):
    """Names of the joints that groups place; the crank pin is known exactly."""
    foreign = sorted({type(group).__name__ for group in mechanism.groups if type(group) not in _ASSEMBLE})
    if foreign:
        raise NotGivenError(f"only the library's own groups are known to this method, not {', '.join(foreign)}")
    return ["A"] * (mechanism.crank.length is None) + [
        group.pin for group in mechanism.groups if not isinstance(group, CamRoller)
    ]


def positions(mechanism, angle):
    """Positions of the moving joints, (joints, 2, ...)."""
    names, shape = moving(mechanism), np.shape(angle)
    joints = mechanism.place(angle).joints
    found = [[np.broadcast_to(part, shape) for part in joints[name].position] for name in names]
    return np.array(found, dtype=float).reshape(len(names), 2, *shape)


def closed_paths(mechanism, angle):
    """The same over a whole turn; refused where no joint moves but the crank pin, and where one cannot be found."""
    found = positions(mechanism, angle)
    if not found.size:
        raise NotGivenError(f"{mechanism.name} is a crank alone: it has no joint whose path is to be found as a series")
    if not np.all(np.isfinite(found)):
        raise NotGivenError(f"{mechanism.name} does not close all around the turn, which a Fourier series needs")
    return found


def joints_of(mechanism, position, first, second):
    return {
        name: Joint(tuple(position[k]), tuple(first[k]), tuple(second[k])) for k, name in enumerate(moving(mechanism))
    }


def harmonic_series(solution, order):
    """Way to a placement from Fourier series of the joints' paths, cut off after a harmonic of the crank angle.

    Of the plain crank-slider these are the series of engine theory (Biezeno and Grammel, *Technische Dynamik*), with
    coefficients to all powers of crank over coupler length.
    """
    mechanism = solution.mechanism
    path = closed_paths(mechanism, np.linspace(0.0, 2 * np.pi, SERIES_SAMPLES, endpoint=False))
    spectrum = 2.0 * np.fft.rfft(path)[..., : order + 1] / SERIES_SAMPLES
    spectrum[..., 0] /= 2.0
    spectrum[abs(spectrum) < 1e-14 * abs(spectrum).max()] = 0.0
    return partial(_by_series, order=order, series=dict(zip(moving(mechanism), spectrum.tolist(), strict=True)))


def _by_series(mechanism, angle, order, series):
    turns = list(_multiples(ray(angle), order))
    joints = {
        name: Joint(*(tuple(_summed(row, turns, k) for row in rows) for k in range(3))) for name, rows in series.items()
    }
    return assembled(mechanism, angle, joints)


def _multiples(ray, order):
    """Unit vectors at 1, 2 ... times the crank angle."""
    multiple = ray
    for _ in range(order):
        yield multiple
        multiple = turned(multiple, ray)


def _summed(coefficients, turns, derivative):
    """Derivative of the real part of the series, sum of a conj(turn), over its harmonics; absent terms left out."""
    total = coefficients[0].real if derivative == 0 else 0.0
    for k, (coefficient, (cosine, sine)) in enumerate(zip(coefficients[1:], turns, strict=True), 1):
        factor = coefficient * (1j * k) ** derivative
        for part, function in ((factor.real, cosine), (-factor.imag, sine)):
            if part != 0.0:
                total = total + part * function
    return total
