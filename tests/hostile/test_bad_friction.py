"""Friction with impossible input, at rest and in driven machines."""

import math
import re

import numpy as np
import pytest
from scipy.integrate import simpson

import kinetostatics as ks
from support.every import every, quick
from support.friction_machines import Drawn
from support.multibody import Body, CrankSlider, pin_on_crank

PUMP = ks.crank_slider(0.1, 0.3, slider=ks.Link(2.0))
CAM = ks.cam_crank_slider(ks.cams.Circle(0.1, (0.01, 0.0)), 0.4, slider=ks.Link(2.0))
ANGLES = np.linspace(0.0, 6.0, 5)
PIN = ks.PinFriction(0.1, 0.02)

WRONG = [
    ({"X": PIN}, "joint is 'X', allowed: 'O', 'A', 'B', 'guide'"),
    ({"gude": ks.GuideFriction(0.1)}, "did you mean 'guide'"),
    ({"slot": ks.SlotFriction(0.1)}, "joint is 'slot', allowed"),
    ({"cam": ks.RollerFriction(0.1, 0.1, 0.2)}, "joint is 'cam', allowed"),
    ({"guide": PIN}, "takes a GuideFriction"),
    ({"guide": ks.SlotFriction(0.1)}, "takes a GuideFriction"),
    ({"O": ks.GuideFriction(0.1)}, "takes a PinFriction"),
    ({"O": 0.1}, "takes a PinFriction, got 0.1"),
    ({"O": None}, "takes a PinFriction, got None"),
    ({"O": ks.PinFriction}, "takes a PinFriction"),
    ({3: PIN}, "joint is 3, allowed"),
    ({None: PIN}, "joint is None, allowed"),
    ({("O",): PIN}, "joint is ('O',), allowed"),
    (0.1, "must be a dict of joint to friction"),
    (0, "must be a dict of joint to friction"),
    ((), "must be a dict of joint to friction"),
    ([PIN], "must be a dict of joint to friction"),
    ("O", "must be a dict of joint to friction"),
    (PIN, "must be a dict of joint to friction"),
]


@every(("friction", "words"), WRONG)
@every("door", ["solve", "scene"])
def test_friction_that_no_joint_has_is_refused(friction, words, door):
    through = {"solve": lambda: ks.solve(PUMP, ANGLES, crank_speed=1.0, friction=friction)}
    through["scene"] = lambda: ks.Scene(PUMP, 1.0, friction=friction)
    with pytest.raises(ks.ParameterError) as caught:
        through[door]()
    assert words in str(caught.value)


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(ks.ParameterError) as caught:
        ks.solve(CAM, ANGLES, crank_speed=1.0, friction={"slot": PIN, "cam": PIN, "Q": PIN})
    assert all(words in str(caught.value) for words in ("SlotFriction", "RollerFriction", "'Q'"))


def test_a_roller_that_would_not_turn_is_refused():
    with pytest.raises(ks.ParameterError, match="the roller would not turn"):
        ks.RollerFriction(0.5, 0.1, 0.04)
    with pytest.raises(ks.ParameterError, match=r"plus rolling_arm, 0\.04 m, must be less than roller_radius, 0\.04 m"):
        ks.RollerFriction(0.1, 0.1, 0.04, rolling_arm=0.03)


@pytest.mark.parametrize("speed", [0.0, 0, np.array([1.0, 0.0, 2.0, 3.0, 4.0])])
def test_resting_machine_without_sense_is_refused(speed):
    with pytest.raises(ks.ParameterError, match="crank_speed and crank_acceleration are both 0"):
        ks.solve(PUMP, ANGLES, crank_speed=speed, friction={"O": PIN})


def test_unknown_paths_and_joints_are_refused():
    scene = ks.Scene(PUMP, 1.0, friction={"O": PIN})
    with pytest.raises(ks.ParameterError, match=r"friction\.O\.mu"):
        scene.varied({"friction.O.my": 0.1})
    with pytest.raises(ks.ParameterError, match="mu must be at least 0"):
        scene.varied({"friction.O.mu": -0.1})
    with pytest.raises(ks.QuantityError, match="joint with friction"):
        scene.solve(4).friction_loss_at("Z")
    with pytest.raises(ks.QuantityError, match="joint"):
        scene.solve(4).pin_load("Z")


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@every("mu", [1e-300, 1e-12, 0.999, 5.0, 1e6, 1e140])
@every("name", ["O", "A", "B", "guide"])
def test_any_coefficient_solves_or_jams(mu, name):
    friction = ks.GuideFriction(mu) if name == "guide" else ks.PinFriction(mu, 0.01)
    try:
        s = ks.solve(PUMP, ANGLES, crank_speed=3.0, loads=ks.Gravity(), friction={name: friction})
    except ks.JammingError:
        return
    assert np.isfinite(s.balancing_torque).all()
    assert (s.friction_loss >= 0.0).all()


def test_an_idle_machine_without_masses_rubs_nowhere():
    s = ks.solve(
        ks.crank_slider(0.1, 0.3), ANGLES, crank_speed=3.0, friction={"A": PIN, "guide": ks.GuideFriction(0.1)}
    )
    assert (s.friction_loss < 1e-100).all()
    assert (np.abs(s.balancing_torque) < 1e-100).all()
    assert s.converged.all()


# Drives with friction against Newton's equations of all bodies, and loads that do or do not depend on the speed

WEIGHT = (9.81, -math.pi / 2)
HEAVY = ks.crank_slider(0.3, 0.5, slider=ks.Link(200.0))
PRESS = ks.crank_slider(0.1, 0.35, slider=ks.Link(5.0))


# friction that has a kink at the acceleration

KINKS = {
    "forwards": (0.1, 1.4, 3.0),
    "backwards": (0.1, 1.4, -3.0),
    "backwards beyond the top": (0.1, 2.0, -3.0),
    "backwards below": (0.1, 4.4, -3.0),
    "backwards with a flywheel": (1.0, 1.4, -3.0),
}


@pytest.mark.slow
@pytest.mark.parametrize(("flywheel", "angle", "speed"), quick(KINKS.values(), 3), ids=KINKS)
def test_friction_with_one_acceleration_does_not_jam(flywheel, angle, speed):
    scene = ks.Scene(HEAVY, 1.0, loads=ks.Gravity(), friction={"guide": ks.GuideFriction(0.8)})
    motion = ks.drive.coast(scene, flywheel, from_angle=angle, from_speed=speed, until=1e-3)
    bodies, friction = {"slider": Body(200.0)}, {"guide": (0.8, None)}
    machine = CrankSlider(pin_on_crank(0.3), False, 0.5, bodies=bodies, gravity=WEIGHT, friction=friction)
    obeys(motion.at(motion.time[:1]), machine.system, flywheel)


@pytest.mark.slow
@pytest.mark.parametrize("step", quick([-4, 0, 1, -1, 4], 3))
def test_acceleration_at_zero_guide_force_is_found(step):
    force = 14078.237116336823 * (1.0 + step * 2.0**-52)
    rod = ks.Link(5.0, 0.2, 0.1)
    machine = ks.crank_slider(0.3, 0.5, coupler=rod, slider=ks.Link(200.0))
    friction = {"guide": ks.GuideFriction(0.4), "O": ks.PinFriction(0.05, 0.02)}
    scene = ks.Scene(machine, 1.0, loads=[ks.Gravity(), ks.ProcessForce(force)], friction=friction)
    motion = ks.drive.coast(scene, 5.0, from_angle=1.427, from_speed=2.96, until=1e-7)
    assert abs(motion.solution.guide_force[0]) < 1e-7 * force
    bodies, friction = (
        {"coupler": Body(5.0, (0.2, 0.0), 0.1), "slider": Body(200.0)},
        {"guide": (0.4, None), "O": 0.001},
    )
    machine = CrankSlider(
        pin_on_crank(0.3), False, 0.5, bodies=bodies, gravity=WEIGHT, push=lambda place: force, friction=friction
    )
    obeys(motion.at(motion.time[:1]), machine.system, 5.0)


@pytest.mark.slow
def test_true_jamming_names_angle_and_flywheel():
    """The pin's lever mu radius, 0.3 m, is longer than the crank: its friction grows faster than inertia frees."""
    crank = ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.1, 0.0))
    scene = ks.Scene(crank, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(1.5, 0.2)})
    words = r"jams at crank angle 57\.2958 deg and 3 rad/s. .* only 0\.021 N m .* flywheel of ([\d.]+) kg m2 or more"
    with pytest.raises(ks.DriveError, match=words) as caught:
        ks.drive.coast(scene, 0.001, from_angle=1.0, from_speed=3.0, until=0.01)
    assert math.degrees(caught.value.crank_angle) == pytest.approx(57.2958, rel=1e-5)
    more = float(re.search(words, str(caught.value))[1])
    assert more == pytest.approx(0.3 * 2.0 * 0.1 - 0.021, rel=1e-2)
    assert ks.drive.coast(scene, 0.001 + 1.1 * more, from_angle=1.0, from_speed=3.0, until=1e-3).acceleration[0] < 0.0


# whether loads depend on the speed

WINDOW = 1e-3


def _steady(value, crank_speed=10.0):
    scene = ks.Scene(PRESS, crank_speed, loads=ks.ProcessForce(value))
    return ks.drive.steady(scene, None, flywheel=50.0, angles=40)


@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_function_of_angle_runs_without_a_motor(speed):
    run = _steady(lambda motion: -100.0 * np.sin(np.mod(motion.crank_angle, 2.0 * np.pi)), speed)
    same = _steady(lambda motion: -1000.0 * motion.position("A")[1], speed)
    assert run.speed == pytest.approx(same.speed, rel=1e-12)
    assert run.energy_per_turn == pytest.approx(same.energy_per_turn, rel=1e-12)


def test_function_of_position_never_stands_still():
    """It gives back in a turn what it takes, which only a load that cannot depend on the speed surely does."""
    scene = ks.Scene(PRESS, 1.0, loads=ks.ProcessForce(lambda motion: np.round(0.0 * motion.slider_position) - 10.0))
    with pytest.raises(ks.DriveError, match="return all of it in a turn"):
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


@every("value", DEPENDENT.values(), ids=DEPENDENT)
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


# motion against Newton's equations of all bodies


def obeys(motion, system, flywheel, torque=lambda speed: 0.0):
    """The motor gives what flywheel and machine take, and friction loses what the bodies' equations say."""
    lost = motion.solution.friction_loss
    for row in zip(motion.crank_angle, motion.speed, motion.acceleration, lost, strict=True):
        angle, speed, acceleration, loss = map(float, row)
        system.speed, system.acceleration = speed, acceleration
        _, taken, _, losses = system.forces(angle)
        size = abs(taken) + abs(flywheel * acceleration)
        assert abs(taken + flywheel * acceleration - torque(speed)) < 1e-10 * size
        assert float(sum(losses.values())) == pytest.approx(loss, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [12.0, -9.0])
@pytest.mark.parametrize("kind", ["slider", "lever", "yoke", "four-bar"])
def test_coasting_obeys_newtons_equations(kind, speed):
    drawn = Drawn(kind, 1)
    motion = ks.drive.coast(drawn.scene, 4.0, 0.7, speed, until=0.1)
    obeys(motion.at(5), drawn.system, 4.0)
    fine = motion.at(2001)
    step = fine.time[1] - fine.time[0]
    assert simpson(fine.acceleration, dx=step) == pytest.approx(fine.speed[-1] - speed, abs=1e-5)
    assert simpson(fine.speed, dx=step) == pytest.approx(fine.crank_angle[-1] - 0.7, abs=1e-7)
    assert simpson(fine.solution.friction_loss, dx=step) == pytest.approx(motion.friction_energy[-1], rel=1e-4)
    assert motion.energy_drift < 1e-9 * motion.kinetic_energy.max()


@pytest.mark.slow
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_running_and_start_obey_newtons_equations(direction):
    drawn, motor = Drawn("slider", 2), ks.drive.Motor.linear(400.0, 30.0, transmission=direction)
    torque = lambda speed: direction * float(motor.torque(direction * speed))  # noqa: E731
    run = ks.drive.steady(drawn.scene, motor, 2.0, angles=np.linspace(0.01, 6.2, 5))
    started = ks.drive.start(drawn.scene, motor, 2.0, from_angle=0.7)
    obeys(run, drawn.system, 2.0, torque)
    obeys(started.at(started.time[1 :: started.time.size // 5]), drawn.system, 2.0, torque)
    assert run.energy_per_turn == pytest.approx(run.load_energy_per_turn + run.friction_energy_per_turn, rel=1e-11)
    assert started.energy_drift < 1e-10 * started.kinetic_energy.max()
    wanted = 0.5 * run.fluctuation
    again = run.with_flywheel(ks.drive.flywheel(drawn.scene, wanted, motor).inertia)
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
