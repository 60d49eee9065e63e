"""Flywheels: worked examples of a textbook, and flywheels truly found under a motor.

Khurmi and Gupta, *Theory of Machines*, chapter 16, examples 16.7, 16.12 and 16.13. The exact values follow from the
diagrams by hand; printed ones are quoted from memory, not checked against the book, and serve as a rough check alone.
Of 16.12 the 1204.08 J so quoted lie 7e-5 below the exact 14450 / 12 = 1204.1667 J, as a calculation by hand may.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.running import MIN_FLYWHEEL_RATIO, find_flywheel
from kinetostatics.errors import DriveError
from support.drives import MOTOR, SAW, TURN

RPM = TURN / 60


def engine(torque, speed):
    """A crank that a torque drives, a function of the crank angle; what it drives takes the mean."""
    turned = ks.Torque(lambda motion: torque(motion.crank_angle), on="crank")
    return ks.Scene(ks.crank_slider(0.1, 0.4), speed, loads=turned)


def shaft_and_machine(speed):
    """16.12: the engine gives 5000 + 600 sin 2 theta, the machine takes 5000 + 500 sin theta, N m."""
    return engine(lambda angle: 600.0 * np.sin(2.0 * angle) - 500.0 * np.sin(angle), speed)


def test_khurmi_gupta_16_12_fluctuation():
    """500 kg at 0.4 m, 150 rpm: 1204.08 J printed, exactly 14450 / 12; 6.1 per cent."""
    speed = 150.0 * RPM
    found = ks.drive.flywheel(shaft_and_machine(speed), 0.061)
    assert found.energy == pytest.approx(14450.0 / 12.0, rel=1e-13)
    assert found.energy == pytest.approx(1204.08, rel=1e-4)
    assert found.energy / (500.0 * 0.4**2 * speed**2) == pytest.approx(0.0610038, abs=5e-8)
    run = ks.drive.steady(shaft_and_machine(speed), None, 80.0)
    assert run.fluctuation == pytest.approx(0.0616123, abs=5e-8)
    low, high = run.speed_range
    assert high**2 - low**2 == pytest.approx(2.0 * found.energy / 80.0, rel=1e-13)


def test_khurmi_gupta_16_7_two_harmonics_flywheel():
    """20 000 + 9500 sin 2 theta - 5700 cos 2 theta, 180 rpm, 1 per cent: 11 078 J and 3121 kg m2 printed."""
    speed = 180.0 * RPM
    scene = engine(lambda angle: 9500.0 * np.sin(2.0 * angle) - 5700.0 * np.cos(2.0 * angle), speed)
    found = ks.drive.flywheel(scene, 0.01)
    assert found.energy == pytest.approx(math.hypot(9500.0, 5700.0), rel=1e-13)
    assert found.energy == pytest.approx(11078.0, rel=1e-4)
    assert found.inertia == pytest.approx(3121.0, rel=2e-3)
    even = ks.drive.steady(scene, None, found.inertia, angles=[math.pi / 4])
    assert even.acceleration[0] == pytest.approx(9500.0 / found.inertia, rel=1e-12)
    assert even.acceleration[0] == pytest.approx(3.044, rel=2e-3)


def test_khurmi_gupta_16_13_three_cranks():
    """5000 + 1500 sin 3 theta, 1000 kg m2, 300 rpm: 1000 J, 0.1 per cent."""
    speed = 300.0 * RPM
    scene = engine(lambda angle: 1500.0 * np.sin(3.0 * angle), speed)
    found = ks.drive.flywheel(scene, 0.001)
    assert found.energy == pytest.approx(1000.0, rel=1e-13)
    assert found.energy / (1000.0 * speed**2) == pytest.approx(0.00101321, abs=5e-9)
    run = ks.drive.steady(scene, None, 1000.0)
    low, high = run.speed_range
    assert high**2 - low**2 == pytest.approx(2.0, rel=1e-11)
    assert run.fluctuation_arithmetic == pytest.approx(0.00101321, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("wanted", [0.3, 0.03, 0.002])
def test_flywheel_under_a_motor_has_the_fluctuation(wanted):
    scene = ks.Scene(SAW, 1.0, loads=(ks.Gravity(), ks.Torque(-700.0, on="crank")))
    found = ks.drive.flywheel(scene, wanted, MOTOR)
    assert ks.drive.steady(scene, MOTOR, found.inertia).fluctuation == pytest.approx(wanted, rel=1e-11)
    assert found.fluctuation == pytest.approx(wanted, rel=1e-11)


@pytest.mark.slow
def test_textbook_and_true_flywheel_agree_when_small():
    scene = ks.Scene(SAW, 33.0, loads=ks.Gravity())
    run = ks.drive.flywheel(scene, 1e-4, MOTOR)
    even = ks.Scene(SAW, run.running.mean_speed, loads=ks.Gravity())
    assert run.inertia == pytest.approx(ks.drive.flywheel(even, 1e-4).inertia, rel=2e-3)


def test_textbook_energy_is_between_mean_crossings():
    angle = np.linspace(0.0, TURN, 61)[:-1]
    scene = ks.Scene(SAW, 33.0, loads=(ks.Gravity(), ks.ProcessForce(ks.Table(angle, 5e3 * np.cos(angle) ** 2))))
    found = ks.drive.flywheel(scene, 0.02)
    fine = np.linspace(0.0, TURN, 60 * 400, endpoint=False) + TURN / 48000
    torque = scene.solve(fine).balancing_torque
    gained = np.cumsum(torque.mean() - torque) * TURN / fine.size
    assert found.energy == pytest.approx(np.ptp(gained), rel=1e-5)
    assert found.inertia == pytest.approx(found.energy / (0.02 * 33.0**2), rel=1e-14)


def test_an_even_machine_needs_no_flywheel():
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, crank=ks.Link(0.0, 0.0, 500.0), slider=ks.Link(0.1)), 33.0)
    assert ks.drive.flywheel(scene, 0.1, MOTOR).inertia == 0.0


def test_a_light_machine_gets_a_flywheel():
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), 33.0)
    motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    found = ks.drive.flywheel(scene, 0.05, motor)
    assert found.inertia > 0.0
    assert found.running.fluctuation == pytest.approx(0.05, rel=1e-11)


@pytest.mark.parametrize("wanted", [0.0, -0.1, 2.0, math.nan, "3 %", [0.1, 0.2]])
def test_impossible_fluctuation_is_refused(wanted):
    with pytest.raises(ks.ParameterError, match="flywheel: fluctuation must be"):
        ks.drive.flywheel(ks.Scene(SAW, 33.0), wanted)


def test_weak_motor_is_reported_with_any_flywheel():
    with pytest.raises(ks.DriveError, match="the motor is too weak"):
        ks.drive.flywheel(ks.Scene(SAW, 33.0, loads=ks.Torque(-9e3, on="crank")), 0.01, MOTOR)


@pytest.mark.parametrize("turns", [1, 2])
def test_torque_swing_is_the_textbook_energy(turns):
    """Whatever the period: the crank's inertia is in the torque, whose mean the motor gives."""
    force = ks.Table(
        np.linspace(0, turns * TURN, 24, endpoint=False), np.cos(np.arange(24.0) ** 2), period=turns * TURN
    )
    scene = ks.Scene(SAW, 20.0, loads=[ks.ProcessForce(force, period=turns * TURN), ks.Gravity()])
    table = ks.sweep(
        scene, ks.designs.grid({"crank_speed": "10..20 rad/s:2"}), ["swing balancing_torque"], progress=False
    )
    for speed, found in table.to_numpy(dtype=object)[:, :2]:
        energy = ks.drive.flywheel(scene.varied({"crank_speed": speed}), 0.01).energy
        assert found == pytest.approx(energy, rel=1e-6)


@pytest.mark.slow
def test_flywheel_by_swing_is_off_by_the_fluctuation():
    """Swing / (delta omega^2) takes the speed as constant: it is off by a share that falls with delta."""
    pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 110.0, loads=ks.ProcessForce(-200.0))
    motor = ks.drive.Motor.linear(50.0, 110.0)
    off = []
    for wanted in (0.02, 0.005):
        true = ks.drive.flywheel(pump, wanted, motor)
        speed = true.running.mean_speed
        energy = ks.drive.flywheel(pump.varied({"crank_speed": speed}), wanted).energy
        off.append(abs(energy / (wanted * speed**2) / true.inertia - 1.0))
    assert off[0] < 0.1 * 0.02
    assert off[1] < off[0] / 3.5


# Search for a flywheel


def machine(least=0.0, own=0.5, floor=0.0):
    """Running whose fluctuation is 1 / (own + flywheel), and which needs some flywheel to run at all."""

    def running_with(inertia):
        if inertia < least:
            raise DriveError("it stalls")
        return SimpleNamespace(fluctuation=max(1.0 / (own + inertia), floor))

    return running_with


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("least", [0.0, 3.0])
def test_flywheel_found_from_any_starting_value(unit, least):
    inertia, running = find_flywheel(0.02, machine(least), unit)
    assert inertia == pytest.approx(49.5, rel=1e-12)
    assert running.fluctuation == pytest.approx(0.02, rel=1e-12)


def test_lightest_sufficient_flywheel_is_given():
    inertia, running = find_flywheel(0.5, machine(least=3.0, own=60.0), 8.0)
    assert inertia == pytest.approx(3.0, rel=1e-12)
    assert running.fluctuation < 0.5
    tiny, _ = find_flywheel(0.5, machine(least=1e-9, own=60.0), 8.0)
    assert tiny < 2 * MIN_FLYWHEEL_RATIO * 8.0


def test_unreachable_fluctuation_is_refused():
    with pytest.raises(DriveError, match=r"flywheel: even \S+ kg m2 do not bring the fluctuation to 0\.02"):
        find_flywheel(0.02, machine(floor=0.1), 1.0)
