"""Whether a machine that coasts comes to a standstill at all."""

import pytest

import kinetostatics as ks
from support.drives import DISC, DISC_MOTOR, PUMP

RUBS = {"O": ks.PinFriction(0.1, 0.03), "guide": ks.GuideFriction(0.1)}


@pytest.mark.parametrize(
    ("scene", "speed", "motor", "words"),
    [
        (ks.Scene(PUMP, 1.0), 3.0, None, "give back all that they take"),
        (ks.Scene(PUMP, 1.0, loads=ks.Torque(2.0, on="crank"), friction=RUBS), 9.0, None, "times the kinetic energy"),
        (ks.Scene(PUMP, 1.0), -30.0, ks.drive.Motor.linear(100.0, 50.0, transmission=-2.0), "its motor keeps it"),
        (ks.Scene(PUMP, 1.0, friction=RUBS), 60.0, DISC_MOTOR, "its motor keeps it running"),
        (ks.Scene(PUMP, 1.0, friction=RUBS), 4.0, DISC_MOTOR, "times the kinetic energy"),
    ],
)
def test_a_machine_that_runs_on_is_not_followed_to_its_standstill(scene, speed, motor, words):
    with pytest.raises(ks.errors.DriveError, match=f"never comes to a standstill: .*{words}"):
        ks.drive.coast(scene, 5.0, from_speed=speed, until="standstill", motor=motor)


@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_a_disc_whose_weight_rubs_stops_when_its_momentum_is_used_up(speed):
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(50.0, 0.0, 3.0)), ())
    scene = ks.Scene(disc, 1.0, loads=ks.Gravity(10.0), friction={"O": ks.PinFriction(0.1, 0.03)})
    motion = ks.drive.coast(scene, 1.0, from_speed=speed, until="standstill")
    assert motion.time[-1] == pytest.approx(4.0 * 2.0 / (0.1 * 0.03 * 500.0), rel=1e-12)
    assert motion.friction_energy[-1] == pytest.approx(0.5 * 4.0 * speed**2, rel=1e-12)


def test_a_motor_against_the_motion_stops_it():
    motion = ks.drive.coast(ks.Scene(DISC, 1.0), from_speed=-1.0, until="standstill", motor=DISC_MOTOR)
    assert motion.events[-1].name == "standstill"
