"""Motion with friction over time, stretch by stretch: by hand, by energy, by many digits; what sticks and starts."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.one_dof import driven_machine
from kinetostatics.drive.stick_slip import integrate_motion, sense_from_rest
from support.drives import FRICTION_PUMP, FRICTION_REFERENCE, RUBBING, SMALL

PENDULUM = ks.Scene(
    ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15, 0.02)),
    1.0,
    loads=ks.Gravity(),
    friction={"O": ks.PinFriction(0.1, 0.05)},
)


def test_a_wheel_on_a_rubbing_pin_stops_as_by_hand():
    """Constant torque of friction: mu radius times the weight; no mass but a centred crank of 2 kg."""
    wheel = ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.0, 0.5))
    scene = ks.Scene(wheel, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(0.2, 0.05)})
    motion = ks.drive.coast(scene, 0.0, 0.3, -4.0, "standstill")
    slowing = 0.2 * 0.05 * 2.0 * 9.81 / 0.5
    assert motion.time[-1] == pytest.approx(4.0 / slowing, rel=1e-13)
    assert motion.crank_angle[-1] == pytest.approx(0.3 - 8.0 / slowing, rel=1e-13)
    assert motion.friction_energy[-1] == pytest.approx(4.0, rel=1e-12)


def test_pendulum_with_friction_slows_and_sticks():
    motion = ks.drive.coast(PENDULUM, 0.06, -1.0, 0.0, 60.0)
    names = [event.name for event in motion.events]
    assert names[0] == "start"
    assert names[-1] == "standstill"
    assert set(names[1:-1]) == {"reversal"}
    swings = np.abs([event.crank_angle + math.pi / 2 for event in motion.events])
    assert (np.diff(swings) < 0.0).all()
    weight, arm = 2.0 * 9.81, 0.15
    assert weight * arm * math.sin(swings[-1]) < 0.1 * 0.05 * weight < weight * arm * math.sin(swings[-2])
    assert motion.energy_drift < 1e-13
    spent = motion.friction_energy[-1]
    fallen = weight * arm * (math.sin(-1.0) - math.sin(motion.crank_angle[-1]))
    assert spent == pytest.approx(fallen, rel=1e-12)
    there = motion.at(np.array([motion.time[-1]]))
    assert there.solution.friction_at("O") == pytest.approx(motion.solution.friction_at("O")[-1], rel=1e-12)
    fine = motion.at(200)
    torque = fine.flywheel * fine.acceleration + fine.solution.balancing_torque
    assert np.abs(torque).max() < 1e-13


def test_what_sticks_does_not_move():
    motion = ks.drive.coast(PENDULUM, 0.06, -math.pi / 2 + 0.01, 0.0, 5.0)
    assert [event.name for event in motion.events] == ["start", "standstill"]
    assert motion.time.tolist() == [0.0]


def test_saw_with_friction_coasts_as_reference_says():
    given = FRICTION_REFERENCE["coasting"]
    motion = ks.drive.coast(RUBBING, given["flywheel"], given["from_angle"], given["from_speed"], "standstill")
    assert motion.crank_angle[-1] == pytest.approx(float(given["angle"]), rel=1e-14)
    assert motion.time[-1] == pytest.approx(float(given["time"]), rel=1e-14)


@pytest.mark.slow
def test_coasting_saw_gives_its_energy_to_friction():
    motion = ks.drive.coast(RUBBING, 20.0, 1.0, 8.0, "standstill")
    s = motion.solution
    given = motion.kinetic_energy[0] + s.potential_energy[0] - motion.kinetic_energy[-1] - s.potential_energy[-1]
    assert motion.friction_energy[-1] == pytest.approx(given, rel=1e-11)
    assert motion.energy_drift < 1e-11 * given
    balance = motion.flywheel * motion.acceleration + s.balancing_torque
    assert np.abs(balance).max() < 1e-12 * np.abs(s.balancing_torque).max()


def test_start_with_friction_takes_longer():
    free = ks.Scene(FRICTION_PUMP.mechanism, 20.0, loads=FRICTION_PUMP.loads)
    slow, fast = (ks.drive.start(scene, SMALL, 0.3, 0.4) for scene in (FRICTION_PUMP, free))
    assert slow.time[-1] > fast.time[-1]
    assert slow.speed[-1] == pytest.approx(0.99 * ks.drive.steady(FRICTION_PUMP, SMALL, 0.3).mean_speed, rel=1e-12)


def test_held_machine_names_the_missing_torque():
    friction = {"guide": ks.GuideFriction(0.3), "O": ks.PinFriction(0.3, 0.05)}
    scene = ks.Scene(FRICTION_PUMP.mechanism, 20.0, loads=(ks.Gravity(), ks.ProcessForce(-2000.0)), friction=friction)
    weak = ks.drive.Motor.constant(30.0)
    with pytest.raises(ks.DriveError, match=r"does not start: .* of them to overcome friction") as caught:
        ks.drive.start(scene, weak, 0.3, -math.pi / 2, until=1.0)
    still = ks.solve(
        scene.mechanism,
        -math.pi / 2,
        crank_speed=0.0,
        crank_acceleration=1e-30,
        loads=scene.loads,
        friction=friction,
    )
    assert caught.value.missing == pytest.approx(float(still.balancing_torque) - 30.0, rel=1e-12)


def test_start_from_an_unloaded_dead_centre_goes_on():
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))
    scene = ks.Scene(pump, 100.0, friction={"guide": ks.GuideFriction(0.1), "O": ks.PinFriction(0.05, 0.01)})
    motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    motion = ks.drive.start(scene, motor, 0.05, until=0.1)
    assert motion.time[-1] == pytest.approx(0.1, rel=1e-15)
    assert motion.energy_drift < 1e-12 * motion.kinetic_energy[-1]


def test_steep_machines_start_and_flat_ones_stay():
    """Gravity has an arm of 0.15 m on the crank of 2 kg, friction one of 0.1 times 0.05 m."""
    hung = driven_machine("test", PENDULUM, None, 0.06)
    assert [sense_from_rest(hung, angle) for angle in (-1.0, -math.pi + 1.0, -math.pi / 2 + 0.01)] == [-1.0, 1.0, 0.0]


def test_motion_ends_at_its_target_speed():
    hung = driven_machine("test", PENDULUM, None, 0.06)
    found = integrate_motion(hung, -1.0, 0.0, 5.0, target=-0.5)
    assert found.end == "ready"
    assert found.rows[1, -1] == pytest.approx(-0.5, rel=1e-12)
    assert found.path(found.time)[:2] == pytest.approx(found.rows[:2], rel=1e-10, abs=1e-12)
