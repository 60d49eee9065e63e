"""The operating speed: where motor and loads agree in the mean, and where they never do."""

import math

import pytest

import kinetostatics as ks
from kinetostatics.drive.operating import operating_speed
from support.drives import DISC, driven


def test_a_motor_too_weak_and_a_machine_that_nothing_holds_are_told():
    with pytest.raises(ks.errors.DriveError, match="too weak"):
        operating_speed(driven(DISC, ks.Torque(-1e4, on="crank")))
    with pytest.raises(ks.errors.DriveError, match="nothing holds the speed"):
        operating_speed(driven(motor=ks.drive.Motor.constant(5.0)))


@pytest.mark.parametrize("torque", [1e-3, 2.0, 5e4])
def test_a_constant_torque_runs_as_fast_as_friction_of_an_unbalanced_disc_lets_it(torque):
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(5.0, 0.02, 3.0)), ())
    scene = ks.Scene(disc, 1.0, friction={"O": ks.PinFriction(0.1, 0.03)})
    run = ks.drive.steady(scene, ks.drive.Motor.constant(torque), angles=5)
    assert run.mean_speed == pytest.approx(math.sqrt(torque / (0.1 * 0.03 * 5.0 * 0.02)), rel=1e-12)


def test_a_motor_told_to_be_so_many_times_as_strong_carries_the_load():
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
