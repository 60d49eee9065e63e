"""Drives with friction against an oracle of their own, and loads of which it is decided whether the speed matters."""

import math
import re

import numpy as np
import pytest

import kinetostatics as ks
from support import friction_motion as oracle

CRANK, ROD = (1.5, 0.03, 0.01), (2.0, 0.12, 0.02)
HEAVY = ks.crank_slider(0.3, 0.5, slider=ks.Link(200.0))
PUMP = ks.crank_slider(0.1, 0.35, slider=ks.Link(5.0))


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads scipy before the clock of any test runs."""
    ks.drive.coast(ks.Scene(PUMP, 1.0, friction={"guide": ks.GuideFriction(0.1)}), 1.0, 0.3, 1.0, until=1e-3)
    ks.drive.steady(ks.Scene(PUMP, 1.0), None, 1.0)


# friction that has a kink at the acceleration

KINKS = {
    "forwards": (0.1, 1.4, 3.0),
    "backwards": (0.1, 1.4, -3.0),
    "backwards beyond the top": (0.1, 2.0, -3.0),
    "backwards below": (0.1, 4.4, -3.0),
    "backwards with a flywheel": (1.0, 1.4, -3.0),
}


@pytest.mark.parametrize(("flywheel", "angle", "speed"), KINKS.values(), ids=KINKS)
def test_friction_with_one_acceleration_does_not_jam(flywheel, angle, speed):
    scene = ks.Scene(HEAVY, 1.0, loads=ks.Gravity(), friction={"guide": ks.GuideFriction(0.8)})
    motion = ks.drive.coast(scene, flywheel, from_angle=angle, from_speed=speed, until=1e-3)
    rest = (0.0, 0.0, 0.0)
    machine = oracle.crank_slider(0.3, 0.5, rest, rest, (200.0, 0.0, 0.0), {"guide": (0.8, None)}, flywheel=flywheel)
    exact, _ = oracle.forces(machine(angle, speed), speed)
    assert motion.acceleration[0] == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("step", [-4, -1, 0, 1, 4])
def test_an_acceleration_is_found_where_the_guide_carries_nothing(step):
    force = 14078.237116336823 * (1.0 + step * 2.0**-52)
    rod = ks.Link(5.0, 0.2, 0.1)
    machine = ks.crank_slider(0.3, 0.5, coupler=rod, slider=ks.Link(200.0))
    friction = {"guide": ks.GuideFriction(0.4), "O": ks.PinFriction(0.05, 0.02)}
    scene = ks.Scene(machine, 1.0, loads=[ks.Gravity(), ks.ProcessForce(force)], friction=friction)
    motion = ks.drive.coast(scene, 5.0, from_angle=1.427, from_speed=2.96, until=1e-7)
    assert abs(motion.solution.guide_force[0]) < 1e-7 * force
    links = (0.0, 0.0, 0.0), (5.0, 0.2, 0.1), (200.0, 0.0, 0.0)
    own = {"guide": (0.4, None), "O": 0.001}
    known = oracle.crank_slider(0.3, 0.5, *links, own, push=lambda place: force, flywheel=5.0)
    exact, _ = oracle.forces(known(1.427, 2.96), 2.96)
    assert motion.acceleration[0] == pytest.approx(exact, rel=1e-12)


def test_friction_that_truly_jams_says_where_and_which_flywheel_helps():
    """The pin's lever mu radius, 0.3 m, is longer than the crank: its friction grows faster than inertia frees."""
    crank = ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.1, 0.0))
    scene = ks.Scene(crank, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(1.5, 0.2)})
    words = r"jams at crank angle 57\.2958 deg and 3 rad/s: .* only 0\.021 N m .* flywheel of ([\d.]+) kg m2 or more"
    with pytest.raises(ks.DriveError, match=words) as caught:
        ks.drive.coast(scene, 0.001, from_angle=1.0, from_speed=3.0, until=0.01)
    assert math.degrees(caught.value.crank_angle) == pytest.approx(57.2958, rel=1e-5)
    more = float(re.search(words, str(caught.value))[1])
    assert more == pytest.approx(0.3 * 2.0 * 0.1 - 0.021, rel=1e-2)
    assert ks.drive.coast(scene, 0.001 + 1.1 * more, from_angle=1.0, from_speed=3.0, until=1e-3).acceleration[0] < 0.0


# whether loads depend on the speed

WINDOW = 1e-3


def _steady(value, crank_speed=10.0):
    scene = ks.Scene(PUMP, crank_speed, loads=ks.ProcessForce(value))
    return ks.drive.steady(scene, None, flywheel=50.0, angles=40)


@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_a_function_of_the_crank_angle_alone_runs_without_a_motor(speed):
    run = _steady(lambda motion: -100.0 * np.sin(np.mod(motion.crank_angle, 2.0 * np.pi)), speed)
    same = _steady(lambda motion: -1000.0 * motion.position("A")[1], speed)
    assert run.speed == pytest.approx(same.speed, rel=1e-12)
    assert run.energy_per_turn == pytest.approx(same.energy_per_turn, rel=1e-12)


def test_a_function_of_the_position_alone_comes_to_no_standstill():
    """It gives back in a turn what it takes, which only a load that cannot depend on the speed surely does."""
    scene = ks.Scene(PUMP, 1.0, loads=ks.ProcessForce(lambda motion: np.round(0.0 * motion.slider_position) - 10.0))
    with pytest.raises(ks.DriveError, match="give back all that they take in a turn"):
        ks.drive.coast(scene, 1.0, from_angle=0.3, from_speed=20.0, until="standstill")


DEPENDENT = {
    "sign of a velocity": lambda motion: -100.0 * np.sign(motion.slider_velocity),
    "steep": lambda motion: -100.0 * np.tanh(motion.slider_velocity / 1e-9),
    "from a speed on": lambda motion: np.where(abs(motion.crank_speed) > 37.123, -10.0, 0.0 * motion.crank_angle),
    "in one direction": lambda motion: np.where(motion.crank_speed > 0.0, -10.0, 0.0 * motion.crank_angle),
    "rate of a link": lambda motion: np.floor(motion.rate("coupler")),
    "in a narrow window": lambda motion: np.where(
        abs(motion.crank_angle - 3.0) < WINDOW, -motion.velocity("B")[0], 0.0
    ),
    "arithmetic": lambda motion: -5.0 * motion.slider_velocity,
}


@pytest.mark.parametrize("value", DEPENDENT.values(), ids=DEPENDENT)
def test_a_function_of_the_speed_is_known_as_one(value):
    with pytest.raises(ks.DriveError, match="loads depend on the speed"):
        _steady(value)


HASTY = {
    "from an acceleration on": lambda motion: np.where(abs(motion.crank_acceleration) > 1e7, -10.0, 0.0),
    "in a narrow window": lambda motion: np.where(
        abs(motion.crank_angle - 3.0) < WINDOW, motion.acceleration("B")[0], 0.0
    ),
}


@pytest.mark.parametrize("value", HASTY.values(), ids=HASTY)
def test_a_function_of_the_acceleration_is_refused(value):
    with pytest.raises(ks.ParameterError, match="depends on the crank acceleration"):
        _steady(value)


# motion against the oracle

COASTING = {
    "forwards": (0.35, 0.0, 0.1, None, 12.0, 0.4),
    "backwards": (0.35, 0.03, 0.1, 0.02, -12.0, 0.4),
    "short shoe": (0.25, -0.03, 0.2, 0.02, 9.0, 4.0),
    "steep rod backwards": (0.2, 0.0, 0.3, 0.1, -9.0, 2.0),
}


def _pump(length, offset, mu, half, speed):
    """Mechanism with its friction, and what the oracle knows of it."""
    links = {"crank": ks.Link(*CRANK), "coupler": ks.Link(*ROD), "slider": ks.Link(8.0)}
    mechanism = ks.crank_slider(0.1, length, guide_offset=offset, **links)
    friction = {"guide": ks.GuideFriction(mu, half), **{name: ks.PinFriction(mu, 0.02) for name in "OAB"}}
    loads = [ks.Gravity(), ks.ProcessForce(lambda motion: -60.0 * np.sin(20.0 * motion.slider_position))]
    own = {"guide": (mu, half), **dict.fromkeys("OAB", 0.02 * mu)}

    def known(flywheel, torque=None):
        def push(place):
            return -60.0 * math.sin(20.0 * place)

        slider = (8.0, 0.0, 0.0)
        return oracle.crank_slider(0.1, length, CRANK, ROD, slider, own, push, offset, torque, flywheel)

    return ks.Scene(mechanism, speed, loads=loads, friction=friction), known


def _agrees(motion, known, angle, speed):
    times = np.linspace(0.0, motion.time[-1], 5)
    angles, speeds, lost = oracle.moved(known, angle, speed, times)
    found = motion.at(times)
    assert found.crank_angle == pytest.approx(angles, abs=1e-8)
    assert found.speed == pytest.approx(speeds, abs=1e-7)
    assert found.friction_energy[-1] == pytest.approx(lost[-1], rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize(("length", "offset", "mu", "half", "speed", "angle"), COASTING.values(), ids=COASTING)
def test_coasting_with_pins_and_guide_is_that_of_newtons_equations(length, offset, mu, half, speed, angle):
    scene, known = _pump(length, offset, mu, half, speed)
    _agrees(ks.drive.coast(scene, 0.4, angle, speed, until=0.1), known(0.4), angle, speed)


@pytest.mark.slow
@pytest.mark.parametrize(("half", "speed"), [(None, 9.0), (0.02, -9.0), (0.1, 7.0)])
def test_coasting_with_a_slot_is_that_of_newtons_equations(half, speed):
    lever = (4.0, 0.3, 0.2)
    mechanism = ks.slotted_lever(0.15, pivot=(0.0, -0.3), crank=ks.Link(*CRANK), lever=ks.Link(*lever))
    friction = {"slot": ks.SlotFriction(0.15, half), **{name: ks.PinFriction(0.1, 0.02) for name in ("O", "A", "O2")}}
    scene = ks.Scene(mechanism, 1.0, loads=[ks.Gravity(), ks.Torque(-6.0, on="lever")], friction=friction)
    own = {"slot": (0.15, half), **dict.fromkeys(("O", "A", "pivot"), 0.002)}
    known = oracle.slotted_lever(0.15, (0.0, -0.3), CRANK, lever, own, torque=-6.0, flywheel=0.3)
    _agrees(ks.drive.coast(scene, 0.3, 0.7, speed, until=0.1), known, 0.7, speed)


@pytest.mark.slow
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_running_and_start_under_a_motor_obey_newtons_equations(way):
    scene, known = _pump(0.35, 0.03, 0.1, 0.05, way)
    motor = ks.drive.Motor.linear(200.0, 30.0, transmission=way)
    machine = known(2.0, lambda speed: way * float(motor.torque(way * speed)))
    run = ks.drive.steady(scene, motor, 2.0, angles=np.linspace(0.01, 6.2, 30))
    started = ks.drive.start(scene, motor, 2.0, from_angle=0.7)
    for motion, some in ((run, slice(None)), (started, slice(1, None, 9))):
        rows = zip(motion.crank_angle[some].tolist(), motion.speed[some].tolist(), strict=True)
        exact = np.array([oracle.forces(machine(*row), row[1])[0] for row in rows])
        assert np.abs(motion.acceleration[some] - exact).max() < 1e-10 * np.abs(exact).max()
    assert run.energy_per_turn == pytest.approx(run.load_energy_per_turn + run.friction_energy_per_turn, rel=1e-11)
    assert started.energy_drift < 1e-10 * started.kinetic_energy.max()
    wanted = 0.5 * run.fluctuation
    again = run.with_flywheel(ks.drive.flywheel(scene, wanted, motor).inertia)
    assert again.fluctuation == pytest.approx(wanted, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [8.0, -8.0])
def test_a_rubbing_roller_loses_what_energy_is_missing(speed):
    cam = ks.cams.Circle(0.1, (0.02, 0.0))
    mechanism = ks.cam_crank_slider(cam, 0.4, slider=ks.Link(10.0), coupler=ks.Link(2.0, 0.2, 0.03))
    friction = {
        "cam": ks.RollerFriction(0.05, 0.02, 0.04),
        "slot": ks.SlotFriction(0.1),
        "guide": ks.GuideFriction(0.1),
    }
    scene = ks.Scene(mechanism, 1.0, loads=ks.Gravity(), friction=friction)
    motion = ks.drive.coast(scene, 1.0, 0.3, speed, until=0.3)
    spent = motion.kinetic_energy + motion.solution.potential_energy + motion.friction_energy
    assert np.abs(spent - spent[0]).max() < 1e-11 * spent[0]
    fine = motion.at(4001)
    loss = np.trapezoid(fine.solution.friction_loss, fine.time)
    assert loss == pytest.approx(motion.friction_energy[-1], rel=1e-4)
