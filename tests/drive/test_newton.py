"""Newton's iteration on the energy: a turn gives back what it began with."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.newton import looked_at, settled
from kinetostatics.drive.operating import operating_speed
from kinetostatics.drive.resolution import resolved
from support.drives import PUMP, driven


def test_running_settles_where_a_turn_gives_back_the_energy_it_began_with():
    item = driven(PUMP, ks.Gravity(), ks.ProcessForce(lambda motion: -300.0))
    speed = operating_speed(item)
    pieces = resolved(item, speed)
    pieces, energy = settled(item, pieces, lambda pieces: 0.5 * item.inertia(pieces.angle) * speed**2)
    state, _, speeds, _ = looked_at(item, pieces, energy)
    net = item.motor_torque(speeds) - state.torque
    assert pieces.total(net) == pytest.approx(0.0, abs=1e-11 * np.abs(net).max())
    start = pieces.evaluate(pieces.series(energy), np.zeros(1))
    assert start + pieces.integrated(net) == pytest.approx(energy, rel=1e-12)
