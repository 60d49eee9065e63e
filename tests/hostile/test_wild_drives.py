"""Drives with impossible input: each is refused with its reason or answered."""

import math
import re

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive import stick_slip
from support.every import every

SCENE = ks.Scene(ks.crank_slider(0.05, 0.2, crank=ks.Link(1.0, 0.0, 0.1), slider=ks.Link(1.0)), 100.0)
MOTOR = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
NO_NUMBERS = [
    "1",
    None,
    True,
    math.nan,
    math.inf,
    -math.inf,
    1j,
    [1.0, 2.0],
    np.array([[1.0], [2.0]]),
    {},
    object(),
    1e200,
]
CALLS = {
    "flywheel of steady": lambda value: ks.drive.steady(SCENE, MOTOR, value),
    "flywheel of coast": lambda value: ks.drive.coast(SCENE, value, until=0.01),
    "from_angle": lambda value: ks.drive.coast(SCENE, 1.0, from_angle=value, until=0.01),
    "from_speed": lambda value: ks.drive.coast(SCENE, 1.0, from_speed=value, until=0.01),
    "until": lambda value: ks.drive.coast(SCENE, 1.0, until=value),
    "until of start": lambda value: ks.drive.start(SCENE, MOTOR, 1.0, until=value if value is not None else "None"),
    "fluctuation": lambda value: ks.drive.flywheel(SCENE, value),
    "power": lambda value: ks.drive.Motor.kloss(value, 99.0, synchronous_speed=104.7, overload=2.5),
    "overload": lambda value: ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=value),
    "synchronous_speed": lambda value: ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=value, overload=2.5),
    "transmission": lambda value: ks.drive.Motor.constant(1.0, transmission=value),
    "inertia": lambda value: ks.drive.Motor.linear(1.0, 1.0, inertia=value),
}


@every("call", CALLS.values(), ids=CALLS)
@every("value", NO_NUMBERS, ids=[str(value)[:20] for value in NO_NUMBERS])
def test_what_is_no_plain_number_is_refused(call, value):
    with pytest.raises(ks.ParameterError):
        call(value)


NO_SCENES = [None, 3.0, "saw", SCENE.mechanism, ks.Scene, [SCENE]]


@every("scene", NO_SCENES, ids=[str(scene)[:20] for scene in NO_SCENES])
@every(
    "call",
    [
        lambda scene: ks.drive.steady(scene, MOTOR, 1.0),
        lambda scene: ks.drive.steady(scene, None, 1.0),
        lambda scene: ks.drive.flywheel(scene, 0.1),
        lambda scene: ks.drive.flywheel(scene, 0.1, MOTOR),
        lambda scene: ks.drive.start(scene, MOTOR, 1.0),
        lambda scene: ks.drive.coast(scene, 1.0, until=1.0),
    ],
)
def test_what_is_no_scene_is_refused(call, scene):
    with pytest.raises(ks.ParameterError, match="scene must be a Scene"):
        call(scene)


NO_MOTORS = [3.0, "kloss", ks.drive.Motor, SCENE, [MOTOR]]


@every("motor", NO_MOTORS, ids=[str(motor)[:20] for motor in NO_MOTORS])
@every(
    "call",
    [
        lambda motor: ks.drive.steady(SCENE, motor, 1.0),
        lambda motor: ks.drive.flywheel(SCENE, 0.1, motor),
        lambda motor: ks.drive.start(SCENE, motor, 1.0),
        lambda motor: ks.drive.coast(SCENE, 1.0, until=1.0, motor=motor),
    ],
)
def test_what_is_no_motor_is_refused(call, motor):
    with pytest.raises(ks.ParameterError, match="motor must be a Motor"):
        call(motor)


@every("angles", [0, -3, True, 1.5e300, math.nan, [], [math.inf], "720", 10**12, None])
def test_crank_angles_that_are_none_are_refused(angles):
    with pytest.raises(ks.ParameterError):
        _ = ks.drive.steady(SCENE, MOTOR, 1.0, angles=angles).speed


@pytest.mark.parametrize("engine", ["fast", 3, "Numpy"])
def test_an_unknown_engine_is_refused(engine):
    with pytest.raises(ks.ParameterError, match="engine"):
        ks.drive.steady(SCENE, MOTOR, 1.0, engine=engine)


@pytest.mark.parametrize("flywheel", [1e-12, 1e-6, 1e12, 1e100])
def test_flywheels_of_any_size_run_or_are_refused(flywheel):
    try:
        run = ks.drive.steady(SCENE, MOTOR, flywheel)
    except ks.DriveError:
        return
    assert run.mean_speed == pytest.approx(104.7, rel=0.05)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_load_that_is_no_number_somewhere_is_refused(value):
    def torque(motion):
        return np.where(np.cos(motion.crank_angle) > 0.9, value, 1.0)

    with pytest.raises((ks.ParameterError, ks.DriveError)):
        ks.drive.steady(ks.Scene(SCENE.mechanism, 1.0, loads=ks.Torque(torque, on="crank")), MOTOR, 1.0)


# Machines that no motor can run, and drives beyond all sizes

Motor, steady, start, coast = ks.drive.Motor, ks.drive.steady, ks.drive.start, ks.drive.coast
PUMP = ks.crank_slider(0.05, 0.2, crank=ks.Link(1.0, 0.0, 0.1), slider=ks.Link(1.0))
LIGHT, MASSLESS = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), ks.crank_slider(0.05, 0.2)
ROCKING = ks.four_bar(0.4, 0.5, 0.3, rocker_pivot=(0.6, 0.0))
TABLE = Motor.table([0.0, 50.0, 99.0, 104.7], [8.0, 12.0, 7.5, 0.0])
LATE_TABLE = Motor.table([50.0, 99.0, 110.0], [8.0, 7.5, 0.0])


def kloss(power=750.0, speed=99.0, synchronous_speed=104.7, overload=2.5, **other):
    return Motor.kloss(power, speed, synchronous_speed=synchronous_speed, overload=overload, **other)


def scene(*loads, of=PUMP, speed=100.0):
    return ks.Scene(of, speed, loads=loads)


def torque(value):
    return ks.Torque(value, on="crank")


RUNNING = {
    "no inertia": (MASSLESS, (), kloss(), 0.0, "all inertia vanishes at crank angle"),
    "inertia that vanishes at dead points": (LIGHT, (), kloss(), 0.0, "all inertia vanishes at crank angle 180 deg"),
    "too weak": (
        PUMP,
        (torque(-30.0),),
        kloss(),
        1.0,
        r"11\.0607 N m are missing, .*Give a motor 1\.585 times as strong",
    ),
    "hardly too weak": (PUMP, (torque(-18.95),), kloss(), 1.0, r"Give a motor 1\.001 times as strong"),
    "weak line": (PUMP, (torque(-11.0),), Motor.linear(10.0, 100.0), 1.0, "1 N m are missing"),
    "weak table": (PUMP, (torque(-13.0),), TABLE, 1.0, "1 N m are missing"),
    "a motor that brakes": (PUMP, (ks.TorsionDamper(0.1, on="crank"),), Motor.constant(-5.0), 1.0, "that drives"),
    "a spring that stops it": (PUMP, (ks.Spring(1e9, 0.25),), kloss(), 1.0, "comes to a standstill at crank angle"),
    "runaway": (PUMP, (torque(30.0),), kloss(), 1.0, "runs away: .*Give more load, a motor that brakes"),
    "beyond a table": (PUMP, (torque(2.0),), TABLE, 1.0, "runs away: .*more rows to its table"),
    "below a table's end": (PUMP, (), TABLE, 1.0, "its table covers only 0 to 104.7 rad/s; give more rows"),
    "nothing holds it": (PUMP, (), Motor.constant(5.0), 1.0, r"nothing stabilises the speed.*a turn leaves 31\.4159 J"),
    "in balance at any speed": (PUMP, (torque(-5.0),), Motor.constant(5.0), 1.0, "nothing stabilises the speed"),
    "tiny transmission": (PUMP, (), kloss(transmission=1e-12), 1.0, "Give a stronger motor, or less inertia"),
    "huge transmission": (PUMP, (), kloss(transmission=1e12), 1.0, "so rigid .*give it its true slip"),
    "huge rotor": (PUMP, (), kloss(inertia=1e50), 1.0, r"an inertia of 1e\+50 kg m2 at the crank"),
    "tiny motor": (PUMP, (), kloss(power=1e-12), 1.0, "Give a stronger motor, or less inertia"),
    "tiny slip": (PUMP, (), kloss(speed=104.7 * (1.0 - 1e-12)), 1.0, "so rigid .*give it its true slip"),
    "huge motor": (PUMP, (), kloss(power=1e12), 1.0, "so rigid .*give it its true slip"),
    "load without bound": (
        PUMP,
        (torque(lambda motion: 1e-6 / (np.mod(motion.crank_angle, 2.0 * np.pi) - 2.0) ** 2),),
        kloss(),
        1.0,
        r"cannot be resolved near crank angle 114\.59",
    ),
}


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:lsoda")
@every(("of", "loads", "motor", "flywheel", "words"), RUNNING.values(), ids=RUNNING)
def test_no_running_is_told_with_what_is_missing(of, loads, motor, flywheel, words):
    with pytest.raises(ks.DriveError, match=words):
        steady(scene(*loads, of=of), motor, flywheel)


def test_the_missing_torque_is_a_number():
    with pytest.raises(ks.DriveError) as caught:
        steady(scene(torque(-30.0)), kloss(), 1.0)
    stronger = float(re.search(r"Give a motor ([\d.]+) times", str(caught.value))[1])
    assert caught.value.missing == pytest.approx(30.0 - 2.5 * 750.0 / 99.0, rel=1e-3)
    assert steady(scene(torque(-30.0)), kloss(power=750.0 * 1.01 * stronger), 1.0).mean_speed > 70.0


OTHERS = {
    "rocking crank": (lambda: steady(scene(of=ROCKING), kloss(), 1.0), ks.AssemblyError, "104.478 .. 255.522 deg"),
    "rocking crank started": (lambda: start(scene(of=ROCKING), kloss(), 1.0, until=1.0), ks.AssemblyError, "104.478"),
    "several designs": (
        lambda: steady(scene(of=ks.crank_slider(0.05, 0.2, slider=ks.Link(np.array([[1.0], [2.0]])))), kloss(), 1.0),
        ks.ParameterError,
        "works on one design at a time",
    ),
    "load by the crank angles given": (
        lambda: steady(scene(torque(np.linspace(0.0, 1.0, 7))), kloss(), 1.0),
        ks.ParameterError,
        "without values between them",
    ),
    "function of another shape": (
        lambda: steady(scene(torque(lambda motion: np.zeros(3))), kloss(), 1.0),
        ks.ParameterError,
        "one for each crank angle, got shape",
    ),
    "function of the acceleration": (
        lambda: steady(scene(torque(lambda motion: 0.01 * motion.crank_acceleration)), kloss(), 1.0),
        ks.ParameterError,
        "depends on the crank acceleration",
    ),
    "function that is noise": (
        lambda: steady(scene(torque(lambda motion: np.random.default_rng().random(motion.shape))), kloss(), 1.0),
        ks.ParameterError,
        "It must be pure, a function of the motion alone",
    ),
    "function that tells nothing": (
        lambda: steady(scene(torque(lambda motion: None)), kloss(), 1.0),
        ks.ParameterError,
        "got None",
    ),
    "textbook at rest": (lambda: steady(scene(speed=0.0), None, 1.0), ks.ParameterError, "must not be 0"),
    "textbook with loads by speed": (
        lambda: steady(scene(ks.TorsionDamper(0.1, on="crank")), None, 1.0),
        ks.DriveError,
        "the constant torque is unknown; give a motor",
    ),
    "textbook of several speeds": (
        lambda: steady(ks.Scene(PUMP, np.linspace(1.0, 2.0, 5)), None, 1.0),
        ks.ParameterError,
        "crank_speed of the scene must be a number",
    ),
    "textbook without inertia": (lambda: steady(scene(of=MASSLESS), None), ks.DriveError, "all inertia vanishes"),
    "as even as no flywheel makes it": (
        lambda: ks.drive.flywheel(scene(), 1e-15, kloss()),
        ks.DriveError,
        "Give a stronger motor, or less inertia",
    ),
    "flywheel for a weak motor": (
        lambda: ks.drive.flywheel(scene(torque(-30.0)), 0.01, kloss()),
        ks.DriveError,
        "11.0607 N m are missing",
    ),
    "start without inertia": (lambda: start(scene(of=LIGHT), kloss(), 0.0, until=1.0), ks.DriveError, "no inertia at"),
    "start against a load": (
        lambda: start(scene(torque(-20.0)), kloss(), 1.0, until=1.0),
        ks.DriveError,
        "the loads take 20 N m at rest",
    ),
    "start with a brake": (
        lambda: start(scene(), Motor.constant(-5.0), 1.0, until=1.0),
        ks.DriveError,
        "the motor gives -5 N m, 5 N m are missing",
    ),
    "start where a table tells nothing": (
        lambda: start(scene(), LATE_TABLE, 1.0, until=0.1),
        ks.DriveError,
        "the motor runs at 0 to .* but its table covers only 50 to 110 rad/s",
    ),
    "coast where a table tells nothing": (
        lambda: coast(scene(), 1.0, 0.0, 49.0, 0.1, LATE_TABLE),
        ks.DriveError,
        "its table covers only 50 to 110 rad/s",
    ),
    "coast without inertia": (
        lambda: coast(scene(of=MASSLESS), 0.0, 0.0, 1.0, 1.0),
        ks.DriveError,
        "no inertia at crank angle 0 deg",
    ),
    "coast for ever": (
        lambda: coast(scene(), 1.0, 0.0, 10.0, "standstill"),
        ks.DriveError,
        "never comes to a standstill: of .* J kinetic energy",
    ),
    "coast from an angle without digits": (
        lambda: coast(scene(), 1.0, 1e15, 1.0, 0.1),
        ks.ParameterError,
        r"from_angle must be at most 1e\+06 rad in size",
    ),
    "coast from an angle without digits and a speed in words": (
        lambda: coast(scene(), 1.0, 1e15, "fast", 0.1),
        ks.ParameterError,
        r"from_angle must be at most 1e\+06 rad in size.*from_speed must be a number",
    ),
    "a negative flywheel later": (
        lambda: steady(scene(), kloss(), 1.0).with_flywheel(-1.0),
        ks.ParameterError,
        "flywheel must be at least 0",
    ),
    "no number of fluctuation": (
        lambda: steady(scene(), kloss(), 1.0).flywheel_for(math.nan),
        ks.ParameterError,
        "fluctuation must be finite",
    ),
    "energy of a part that is not there": (
        lambda: steady(scene(), kloss(), 1.0).energy_flow["rotor"],
        ks.QuantityError,
        "allowed: 'through the air gap', 'rotor, by slip'",
    ),
    "energy through no air gap": (
        lambda: steady(scene(torque(-1.0)), Motor.linear(10.0, 100.0), 1.0).rotor_loss_per_turn,
        ks.DriveError,
        "only an induction motor",
    ),
}


@pytest.mark.slow
@every(("call", "kind", "words"), OTHERS.values(), ids=OTHERS)
def test_what_cannot_be_driven_says_why(call, kind, words):
    with pytest.raises(kind, match=words):
        call()


@pytest.mark.slow
def test_endless_motion_is_given_up_with_progress(monkeypatch):
    monkeypatch.setattr(stick_slip, "MAX_PARTS", 200)
    damped = scene(ks.TorsionDamper(1e-9, on="crank"))
    with pytest.raises(
        ks.DriveError, match=r"the motion is too long: .* needed 200 parts of the period; give an earlier time"
    ):
        coast(damped, 1.0, 0.0, 10.0, 1e9)
    with pytest.raises(ks.DriveError, match="never comes to a standstill"):
        coast(damped, 1.0, 0.0, 10.0, "standstill")


def test_waiting_for_a_standstill_is_no_fault():
    hill = scene(ks.Gravity(), of=ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15, 0.02)))
    assert coast(hill, 0.0, -math.pi / 2, 5.0, "standstill").events[-1].name == "standstill"
    assert coast(hill, 0.0, -math.pi / 2, -5.0, "standstill").events[-1].name == "standstill"
    with pytest.raises(ks.DriveError, match="never comes to a standstill"):
        coast(hill, 0.0, -math.pi / 2, 50.0, "standstill")


EXTREME = {
    "at its breakdown torque": (torque(-18.9), kloss(), 79.1),
    "driven beyond its synchronous speed": (torque(10.0), kloss(), 112.5),
    "overload hardly above 1": (torque(-1.0), kloss(overload=1.0000001), 104.32),
    "overload without end": (torque(-1.0), kloss(overload=1e9), 103.95),
    "against a heavy damper": (ks.TorsionDamper(1.0, on="crank"), kloss(), 10.1),
    "constant torque against a damper": (ks.TorsionDamper(0.05, on="crank"), Motor.constant(5.0), 100.0),
    "a function that returns one number": (torque(lambda motion: -3.0), kloss(), 102.5),
    "a function of the speed's sign": (torque(lambda motion: -5.0 * np.sign(motion.crank_speed)), kloss(), 101.0),
}


@pytest.mark.slow
@every(("load", "motor", "speed"), EXTREME.values(), ids=EXTREME)
def test_what_is_extreme_but_possible_runs(load, motor, speed):
    run = steady(scene(load), motor, 1.0)
    assert run.mean_speed == pytest.approx(speed, rel=2e-3)
    assert run.energy_flow.residual < 1e-12
