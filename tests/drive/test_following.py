"""Running met by following a machine from above: the same as Newton's, or a standstill that is told."""

import pytest

import kinetostatics as ks
from kinetostatics.drive.following import from_above
from kinetostatics.drive.newton import settled
from kinetostatics.drive.operating import operating_speed
from kinetostatics.drive.resolution import resolved
from support.drives import DISC, PUMP, driven


def test_from_above_the_running_is_met_that_newton_settles_on():
    machine = driven(PUMP, ks.Gravity(), ks.Torque(-40.0, on="crank"), flywheel=2.0)
    speed = operating_speed(machine)
    pieces, energy = from_above(machine, resolved(machine, speed), speed)
    own, expected = settled(
        machine, resolved(machine, speed), lambda pieces: 0.5 * machine.inertia(pieces.angle) * speed**2
    )
    at = own.angle % machine.period
    assert pieces.evaluate(pieces.series(energy), at) == pytest.approx(expected, rel=1e-11)


def test_a_machine_that_comes_to_a_standstill_says_where_and_what_is_missing():
    machine = driven(DISC, ks.Torque(-1e3, on="crank"))
    with pytest.raises(ks.errors.DriveError, match="comes to a standstill at crank angle") as caught:
        from_above(machine, resolved(machine, 10.0), 10.0)
    assert caught.value.missing == pytest.approx(1e3 - float(machine.motor_torque(0.0)), rel=1e-6)
