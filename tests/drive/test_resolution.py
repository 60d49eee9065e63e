"""Pieces of a turn in which a machine is resolved: smooth parts to rounding, jumps at their edges."""

import pytest

import kinetostatics as ks
from kinetostatics.drive.resolution import require_inertia, resolved
from support.drives import driven


def test_a_machine_without_inertia_somewhere_is_refused_with_the_crank_angle():
    motor = ks.drive.Motor.linear(100.0, 50.0)
    machine = driven(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), motor=motor, flywheel=0.0)
    with pytest.raises(ks.errors.DriveError, match="all inertia vanishes at crank angle"):
        require_inertia(machine, resolved(machine, 3.0))
    require_inertia(driven(), resolved(driven(), 3.0))
