"""Running found by following a machine in time, where Newton's iteration alone does not find it."""

import math

import numpy as np

from ..errors import DriveError
from .newton import looked_at, settled

FOLLOWED = 1e-6
"""Tolerance to which a machine is followed from above."""
LOOSE, RIGID = 1e-10, 1e6
"""Relative change of the energy of motion over a turn, by its own, of motors that cannot be followed to running."""
TURNS = 100
"""Turns that are followed."""


def from_above(driven, pieces, start):
    """Running found by following the machine from a high speed, where Newton's iteration alone does not find it.

    Motions of one degree of freedom do not cross, so from above the highest periodic running is met, or none exists.
    """
    from scipy.integrate import solve_ivp

    period, direction = driven.period, driven.direction

    def net(angle, energy):
        angle, inertia = float(angle), driven.inertia_here(float(angle))
        return driven.here(angle, direction * math.sqrt(2.0 * max(float(energy[0]), 0.0) / inertia))[2]

    most = 0.5 * driven.inertia(pieces.angle).max() * (2.0 * start) ** 2

    def standstill(angle, energy):
        return energy[0] - 1e-9 * most

    vars(standstill)["terminal"] = True
    energy, ends = most, (0.0, period) if direction > 0 else (period, 0.0)
    for turn in range(TURNS):
        found = solve_ivp(
            net, ends, [energy], "LSODA", rtol=FOLLOWED, atol=1e-10 * most, dense_output=True, events=standstill
        )
        if found.status != 0:
            angle = float(found.t[-1]) % period
            missing = abs(net(angle, np.zeros(1)))
            raise DriveError(
                f"{driven.scene.mechanism.name}: the motor is too weak, so there is no periodic running: followed from "
                f"{2.0 * abs(start):.6g} rad/s, the machine comes to a standstill at crank angle "
                f"{math.degrees(angle):.6g} deg in turn {turn + 1}, where {missing:.6g} N m are missing at the crank; "
                "give a larger flywheel or a stronger motor",
                missing,
                angle,
            )
        last, energy = energy, float(found.y[0, -1])
        if abs(energy - last) < 0.05 * last:
            running = settled(driven, pieces, lambda pieces, path=found.sol: _on_path(pieces, path, 1e-9 * most))
            if running is not None:
                return running
            if abs(energy - last) < 1e-4 * last:
                break
    raise DriveError(
        f"{driven.scene.mechanism.name}: no periodic running was found in {turn + 1} turns from "
        f"{2.0 * abs(start):.6g} rad/s; {_remedy(driven, pieces, start)}"
    )


def _remedy(driven, pieces, start):
    """What keeps running from being found, by how the motor answers to speed."""
    inertia = driven.inertia(pieces.angle)
    *_, growth = looked_at(driven, pieces, 0.5 * inertia * start * start)
    share = float(np.abs(pieces.whole(growth)).sum())
    if share < LOOSE:
        return (
            f"motor and loads hold the speed by {share:.1e} of the energy of motion a turn only, against an inertia of "
            f"{inertia.max():.6g} kg m2 at the crank; give a stronger motor, or less inertia"
        )
    if share > RIGID:
        return (
            f"the motor is so rigid that its torque changes by {share:.1e} times the energy of motion, a turn, with "
            "the speed; give it its true slip, or a larger flywheel"
        )
    return "give a larger flywheel"


def _on_path(pieces, path, least):
    return np.maximum(path(pieces.angle.ravel())[0].reshape(pieces.angle.shape), least)
