"""The operating speed: where motor and loads agree in the mean, and where they never do."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.resolution import require_inertia, resolved
from kinetostatics.drive.steady import operating_speed, settle_by_integration
from support.drives import DISC, DISC_MOTOR, driven


def test_weak_motor_and_runaway_are_reported():
    with pytest.raises(ks.errors.DriveError, match="too weak"):
        operating_speed(driven(DISC, ks.Torque(-1e4, on="crank")))
    with pytest.raises(ks.errors.DriveError, match="nothing holds the speed"):
        operating_speed(driven(motor=ks.drive.Motor.constant(5.0)))


@pytest.mark.parametrize("torque", [1e-3, 2.0, 5e4])
def test_constant_torque_runs_to_the_friction_limit(torque):
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(5.0, 0.02, 3.0)), ())
    scene = ks.Scene(disc, 1.0, friction={"O": ks.PinFriction(0.1, 0.03)})
    run = ks.drive.steady(scene, ks.drive.Motor.constant(torque), angles=5)
    assert run.mean_speed == pytest.approx(math.sqrt(torque / (0.1 * 0.03 * 5.0 * 0.02)), rel=1e-12)


def test_stronger_motor_carries_the_load_as_advised():
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(10.0, 0.1, 3.0)), ())
    scene = ks.Scene(disc, 1.0, loads=ks.Torque(-20.0, on="crank"), friction={"O": ks.PinFriction(0.5, 0.1)})

    def steady(times):
        motor = ks.drive.Motor.table([0.0, 20.0, 40.0, 60.0], [times * 12.0, times * 10.0, times * 30.0, 0.0])
        return ks.drive.steady(scene, motor, 1.0)

    with pytest.raises(ks.errors.DriveError, match="too weak") as caught:
        steady(1.0)  # the load is least at rest, 20 N m, where the motor does not give its most
    times = float(str(caught.value).partition("give a motor ")[2].partition(" times")[0])
    assert 1.6 < times <= 1.667
    assert steady(1.001 * times).mean_speed < 2.0


# A scene as one degree of freedom


class Speedy:
    """A torque on the crank by its speed, which declares where it jumps."""

    def __call__(self, motion):
        """Torque, N m."""
        return np.where(np.mod(motion.crank_angle, 2 * np.pi) < 2.0, -0.1, -0.05) * motion.crank_speed

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return [], [0.0, 2.0]


def test_declared_kinks_may_depend_on_speed():
    found = driven(DISC, ks.Torque(Speedy(), on="crank"))
    assert found.kinks.tolist() == [2.0]
    assert found.loads_by_speed
    left = [found.balance(0.3, speed)[2] - float(DISC_MOTOR.torque_at_crank(speed)) for speed in (5.0, 10.0)]
    assert left == pytest.approx([-0.5, -1.0], rel=1e-12)
    assert not driven(DISC, ks.Torque(ks.Table([0.0, 2.0, 4.0], [-1.0, -2.0, -1.5]), on="crank")).loads_by_speed


# Running met by following a machine from above


def test_standstill_names_angle_and_missing_torque():
    machine = driven(DISC, ks.Torque(-1e3, on="crank"))
    with pytest.raises(ks.errors.DriveError, match="comes to a standstill at crank angle") as caught:
        settle_by_integration(machine, resolved(machine, 10.0), 10.0)
    assert caught.value.missing == pytest.approx(1e3 - float(machine.motor_torque(0.0)), rel=1e-6)


# Pieces of a turn in which a machine is resolved


def test_vanishing_inertia_is_refused_with_its_angle():
    motor = ks.drive.Motor.linear(100.0, 50.0)
    machine = driven(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), motor=motor, flywheel=0.0)
    with pytest.raises(ks.errors.DriveError, match="all inertia vanishes at crank angle"):
        require_inertia(machine, resolved(machine, 3.0))
    require_inertia(driven(), resolved(driven(), 3.0))
