"""Pieces of a turn in which a machine is resolved: smooth parts to rounding, jumps at their edges."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.pieces import TAIL
from kinetostatics.drive.resolution import require_inertia, resolved
from support.drives import DISC, PUMP, driven

JUMP = 2.0


def test_inertia_and_torque_have_no_tail_in_any_piece():
    machine = driven(PUMP, ks.Gravity())
    pieces = resolved(machine, 3.0)
    state = machine.at(pieces.angle)
    assert (pieces.edges[0], pieces.edges[-1]) == (0.0, machine.period)
    assert max(pieces.tail(state.inertia).max(), pieces.tail(state.torque).max()) <= TAIL


def test_a_jump_that_nobody_told_lies_at_an_edge():
    push = ks.Torque(lambda motion: np.where(np.mod(motion.crank_angle, 2 * np.pi) < JUMP, -5.0, -9.0), on="crank")
    assert np.abs(resolved(driven(DISC, push), 3.0).edges - JUMP).min() < 1e-12


def test_a_machine_without_inertia_somewhere_is_refused_with_the_crank_angle():
    motor = ks.drive.Motor.linear(100.0, 50.0)
    machine = driven(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), motor=motor, flywheel=0.0)
    with pytest.raises(ks.errors.DriveError, match="all inertia vanishes at crank angle"):
        require_inertia(machine, resolved(machine, 3.0))
    require_inertia(driven(), resolved(driven(), 3.0))
