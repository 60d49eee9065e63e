"""Contacts along a line: their pressure from the forces found, and where a roller undercuts what carries it."""

import numpy as np

from ..errors import QuantityError
from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.planar import number


def pressure(dynamics, name):
    """Largest Hertz pressure of a contact of a `Dynamics`, by name; NaN where there is no such contact."""
    group = next((group for group in dynamics.mechanism.groups if name in group.contacts), None)
    if group is None:
        known = [own for group in dynamics.mechanism.groups for own in group.contacts]
        raise QuantityError(_unknown(dynamics.mechanism, name, known))
    touch = group.contacts[name]
    force = number(dynamics.resolved.scalars[touch.force])
    with np.errstate(divide="ignore", invalid="ignore"):
        return touch.body.pressure(force, group.relative_radius(name, dynamics.placement, sign(force)))


def _unknown(mechanism, name, known):
    if known:
        return checks.choice(f"{mechanism.name}: contact", name, tuple(known))
    return (
        f"{mechanism.name} has no contact pressure {name!r}: give its cam a roller, as CamRoller(cam, "
        "roller=ks.Roller(radius, width, youngs_modulus, poissons_ratio))"
    )


def refusals(solution):
    """Where rollers undercut the side of a cam that carries them, as sentences."""
    if not solution.kind.answer(_touching):
        return []
    state = solution.dynamics
    parts = [(group, name) for group in state.mechanism.groups for name in group.contacts]
    return [problem for group, name in parts for problem in _undercut(state, group, name, group.contacts[name])]


def _touching(kind):
    mechanism = kind.numbered.mechanism
    return any(group.contacts for group in mechanism.groups)


def _undercut(dynamics, group, name, touch):
    with np.errstate(all="ignore"):
        both = [np.asarray(group.relative_radius(name, dynamics.placement, side)) for side in (-1.0, 1.0)]
        if any(part.dtype != float for part in both) or not any(np.any(part <= 0.0) for part in both):
            return
        force = dynamics.scalar(touch.force)
        room = np.where(force > 0.0, both[1], both[0])
        cut = room <= 0.0
    if not cut.any():
        return
    worst = np.unravel_index(np.argmin(np.where(cut, room, np.inf)), cut.shape)
    radius = float(np.broadcast_to(touch.body.radius, cut.shape)[worst])
    bend = radius / (1.0 - float(room[worst]) / radius)
    angle = np.degrees(np.broadcast_to(dynamics.crank_angle, cut.shape))
    yield checks.Problem(
        f"the roller, radius {radius:.6g} m, undercuts the side of its cam that carries it at {cut.sum()} crank angles "
        f"from {angle[cut].min():.6g} to {angle[cut].max():.6g} deg: at {angle[worst]:.6g} deg the pitch curve bends "
        f"with a radius of {bend:.6g} m; the roller's must be less, or the cam larger",
        cut,
    )
