"""Hostile input to the drive: every wrong value gets an error of the library, at once, and nothing is computed."""

import math

import numpy as np
import pytest

import kinetostatics as ks
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
