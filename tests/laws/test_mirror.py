"""A machine mirrored in the x axis, y -> -y, gives mirrored results: whatever is computed, for random machines.

Forces are mirrored, torques change their sign, powers and energies stay. `support.mirror` makes the mirror image
and compares. What one machine and its image are both refused counts as agreement.
"""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from support import mirror as laws
from support.mirror import mirrored
from support.turning_machines import KINDS, LOADS, SPEED_LOADS, random_machine

pytestmark = [
    pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning"),
    pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning"),
    pytest.mark.filterwarnings("ignore:sampled cam"),
]
CLOSE, ANGLE = 1e-13, 1e-7
CLEAR = np.array([-1.7, -0.9, 1.1, 1.9])
"""Crank angles clear of change points."""
SPLINE = 1e-12
"""Rounding of a cam from a table: the second derivative of a spline through 60 points loses a digit."""
MOTION, STEEP = 1e-12, 1e-11
"""Motions: dozens of steps, each integrated to 3e-14, add up; a motor near its mean speed multiplies that by ten."""
WITHOUT_SPEED = tuple(kind for kind in LOADS if kind not in SPEED_LOADS)
MOTORS = {
    "kloss": ks.drive.Motor.kloss(3000.0, 95.0, synchronous_speed=104.7, overload=2.5, transmission=5.0, inertia=0.01),
    "linear": ks.drive.Motor.linear(80.0, 60.0, transmission=-3.0, inertia=0.005),
    "table": ks.drive.Motor.table([0.0, 100.0, 150.0, 160.0], [60.0, 100.0, 40.0, -5.0], transmission=6.0),
}


def assert_mirrored(errors, kind="", close=CLOSE):
    """Every error below its limit; the message lists those that are not."""
    close = max(close, SPLINE) if kind == "sampled cam" else close
    limits = {name: ANGLE if name.endswith(" at") or "_at " in name else close for name in errors}
    assert {name: error for name, error in errors.items() if not error <= limits[name]} == {}


def agreed(law, scene):
    """Errors of a law, none where friction jams the machine and its image alike."""
    try:
        return law(scene)
    except ks.JammingError:
        with pytest.raises(ks.JammingError):
            law(mirrored(scene))
        return {}


# Solutions


SHORT = ("crank slider", "four-bar", "lever", "swinging follower")
"""Kinds that are solved fast; all others are slow tests."""
AT_REST = [
    {"loads": ("gravity", "spring", "table over travel"), "speed": 0.0, "acceleration": way, "friction": way < 0.0}
    for way in (40.0, -40.0)
]
"""Machines that begin to move."""
FAST = [
    *((kind, 0, {}) for kind in SHORT),
    ("lever", 1, {"friction": True}),
    *(("crank slider", 3, {"loads": LOADS[first::4]}) for first in range(4)),
    ("four-bar", 3, {"loads": ("torsion spring",)}),
    ("crank slider", 5, {"loads": ("table with back",), "speed": 0.0, "acceleration": -40.0}),
]
SLOW = [
    *((kind, 0, {}) for kind in KINDS if kind not in SHORT),
    *((kind, 1, {"friction": True}) for kind in ("crank slider", "circle cam")),
    *((kind, 5, options) for kind in ("crank slider", "two sliders") for options in AT_REST),
]


@pytest.mark.parametrize(
    ("kind", "seed", "options"), [*FAST, *(pytest.param(*row, marks=pytest.mark.slow) for row in SLOW)]
)
def test_every_quantity_of_a_solution(kind, seed, options):
    scene = random_machine(kind, seed, **options)
    assert scene.loads
    assert_mirrored(agreed(laws.solved, scene), kind)


CHANGE_POINTS = {
    "parallelogram": ks.RockerGroup(0.35, 0.1, (0.28, 0.21), "open"),
    "antiparallelogram": ks.RockerGroup(0.35, 0.1, (0.28, 0.21), "crossed"),
    "kite": ks.RockerGroup(0.3, 0.3, (0.08, 0.06), "open"),
    "crank as long as the coupler": ks.SliderGroup(0.1, ks.Guide.at(0.4), "open"),
    "lever that passes its pivot": ks.LeverGroup((0.08, 0.06), assembly="open"),
}


@pytest.mark.parametrize("name", CHANGE_POINTS)
def test_machines_that_pass_change_points(name):
    """Their assembly is named for a half turn, in which the mirrored machine stands as the machine in the other one."""
    group = CHANGE_POINTS[name]
    body = ks.Link(2.0, (0.05, 0.01), 0.02)
    group = replace(group, **dict.fromkeys(group.links, body))
    machine = ks.Mechanism(name, ks.Crank(0.1, body), (group,))
    scene = ks.Scene(machine, 8.0, 20.0, ks.Gravity(direction=-2.0))
    assert_mirrored(laws.solved(scene, CLEAR))


# Over the turn


OVER_TURN = [
    (laws.extremes, "lever", 0),
    (laws.means, "four-bar", 0),
    (laws.swept, "four-bar", 1),
    *(pytest.param(laws.extremes, kind, 0, marks=pytest.mark.slow) for kind in ("drag link", "roller follower")),
]


@pytest.mark.parametrize(("law", "kind", "seed"), OVER_TURN)
def test_results_over_the_turn(law, kind, seed):
    assert_mirrored(law(random_machine(kind, seed)), kind)


@pytest.mark.slow
def test_extremes_at_the_jumps_of_friction():
    """At one dead centre two joints turn about, and between two floating-point numbers only one has done so."""
    assert_mirrored(laws.extremes(random_machine("yoke", 1, friction=True)))


DWELL = np.pi / 4
"""Length of the dwell below, rad."""


def test_level_stretch_has_its_extremum_in_the_middle():
    """In a dwell the force of a spring is level: the extremum stood anywhere in it, by rounding."""
    rise, back = ks.laws.cycloidal(0.1, 0.12, 2.0), ks.laws.cycloidal(0.12, 0.1, 2.0)
    rest = ks.laws.dwell(0.1, 2 * np.pi - 4.0 - DWELL)
    law = ks.laws.joined(rise, ks.laws.dwell(0.12, DWELL), back, rest)
    machine = ks.Mechanism("cam drive", ks.Crank(None), (ks.FlatFollower(law, follower=ks.Link(2.0)),))
    solution = ks.solve(machine, 0.0, crank_speed=0.0, loads=ks.Spring(3e3, 0.0, on="follower"))
    found = ks.extremes(solution, "contact_force")
    np.testing.assert_allclose(found.angle, [2.0 + DWELL / 2, 4.0 + DWELL + rest.angle / 2], atol=ANGLE)
    np.testing.assert_allclose(found.value, [3e3 * 0.12, 3e3 * 0.1], rtol=1e-13)


DWELLING = ("roller follower", "flat follower", "swinging follower")
"""Kinds whose laws have dwells."""


LAWS = (laws.extremes, laws.means, laws.swept)
MANY = [(kind, law, (one + other) % 2 == 1) for one, kind in enumerate(KINDS) for other, law in enumerate(LAWS)]
"""Every law of every kind; with friction every other one."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "law", "friction"), MANY)
def test_many_machines(kind, law, friction):
    """Sweeps, and means with friction, resolve a turn with kinks to 1e-8 of the largest value: no better than that.

    At the ends of a dwell friction jumps while the follower stands: rounding decides which of the values between those
    before and behind are listed as extrema, so of such machines the largest and the smallest are compared.
    """
    if law is laws.extremes and friction and kind in DWELLING:
        law = laws.largest
    resolved = (law in (laws.means, laws.swept) and friction) or (law is laws.swept and kind == "flat follower")
    errors = agreed(law, random_machine(kind, 10, friction=friction))
    if resolved:  # a place in a level stretch is as uncertain as the root of the value
        errors = {name: error for name, error in errors.items() if "_at " not in name}
    assert_mirrored(errors, kind, 1e-9 if resolved else CLOSE)


# Drives

AROUND = np.linspace(0.1, 6.1, 7)


def steady(scene, motor, flywheel, angles):
    return ks.drive.steady(scene, motor, flywheel, angles=angles)


@pytest.mark.parametrize("motor", MOTORS)
def test_steady_running(motor):
    """Among it the time, which counts from crank angle 0 on in the direction in which the crank turns."""
    scene, motor = random_machine("crank slider", 0, loads=("gravity", "process")), MOTORS[motor]
    one = ks.drive.steady(scene, motor, 20.0, angles=AROUND)
    other = ks.drive.steady(mirrored(scene), mirrored(motor), 20.0, angles=-AROUND)
    assert_mirrored(laws.running(one, other))


def test_clockwise_time_counts_forward():
    pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), -100.0, loads=ks.Gravity())
    run = ks.drive.steady(pump, None, 0.05, angles=[0.0, -0.5, -3.0, -6.0])
    assert run.time[0] == 0.0
    assert np.all(np.diff(run.time) > 0.0)
    assert run.time[1] == pytest.approx(0.5 / 100.0, rel=0.2)


def test_flywheels():
    scene = random_machine("crank slider", 2, loads=("process", "table with back"), acceleration=0.0)
    one, other = (ks.drive.flywheel(item, 0.02) for item in (scene, mirrored(scene)))
    assert other.inertia == pytest.approx(one.inertia, rel=1e-12)
    assert other.energy == pytest.approx(one.energy, rel=1e-12)


COASTS = {
    "from a speed": (("spring", "gravity"), 8.0, {"until": 0.4}),
    "from a negative speed": (("spring", "gravity"), -8.0, {"until": 0.4}),
    "rocking": (("gravity", "spring"), 0.4, {"until": 0.4}),
    "under a motor": (("process", "gravity"), 2.0, {"until": 0.4, "motor": MOTORS["linear"]}),
    "against a motor": (("process", "gravity"), 8.0, {"until": 0.4, "motor": MOTORS["linear"]}),
}
SLOW_COASTS = {
    **{f"two strokes, {speed}": (("table with back",), speed, {"until": 0.4}) for speed in (8.0, -8.0, 0.4)},
    **{f"to standstill, {speed}": (("gravity",), speed, {"until": "standstill"}) for speed in (6.0, -6.0)},
}


@pytest.mark.parametrize("name", [*COASTS, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW_COASTS)])
def test_coasting(name):
    loads, speed, options = (COASTS | SLOW_COASTS)[name]
    rubs = options["until"] == "standstill"
    scene, flywheel = random_machine("crank slider", 4, loads=loads, friction=rubs), 0.05 if rubs else 1.0
    image = {"motor": mirrored(options["motor"])} if "motor" in options else {}
    one = ks.drive.coast(scene, flywheel, 0.7, speed, **options)
    other = ks.drive.coast(mirrored(scene), flywheel, -0.7, -speed, **options | image)
    assert_mirrored(laws.moving(one, other), close=MOTION)


STARTS = [
    ("kloss", ("gravity", "spring"), {}, MOTION),
    ("linear", ("gravity", "spring"), {}, MOTION),
    pytest.param("kloss", ("table with back", "torsion damper"), {"until": 0.2}, STEEP, marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("motor", "loads", "options", "close"), STARTS)
def test_starting(motor, loads, options, close):
    """Near its mean speed the motor's torque is steep."""
    scene, motor = random_machine("crank slider", 4, loads=loads), MOTORS[motor]
    one = ks.drive.start(scene, motor, 1.0, from_angle=0.7, **options)
    other = ks.drive.start(mirrored(scene), mirrored(motor), 1.0, from_angle=-0.7, **options)
    assert_mirrored(laws.moving(one, other), close=close)


# Designs


def pump(speed=10.0, acceleration=0.0, friction=None, loads=()):
    links = {"crank": ks.Link(2.0, (0.03, 0.01), 0.02), "coupler": ks.Link(1.0, (0.1, 0.01), 0.01)}
    machine = ks.crank_slider(0.1, 0.35, guide_offset=0.03, guide_angle=0.2, slider=ks.Link(4.0), **links)
    springs = ks.Spring(500.0, 0.35, mass=0.05), ks.GasSpring(1e-3, 4e-4, 2e5, at=0.35, side=-1)
    springs = *springs, ks.BalanceShaft(0.01, -2, 0.6, (0.1, -0.05), 0.01, mass=1.0)
    own = (ks.Gravity(direction=-2.0), *springs, *loads)
    return ks.Scene(machine, speed, acceleration, own, friction or {})


def cam_saw(speed=10.0):
    roller = ks.Roller(0.02, 0.02, 210e9, 0.3)
    cam = ks.cams.Circle(0.1, (0.01, 0.005))
    machine = ks.cam_crank_slider(cam, 0.4, block=ks.Link(1.0), slider=ks.Link(4.0), roller=roller)
    return ks.Scene(machine, speed, loads=ks.Spring(5000.0, 0.1))


def cam_drive(speed=10.0):
    law = ks.laws.cosine(0.01, 0.05, 0.4)
    follower = ks.RollerFollower(law, ks.Guide.at(0.3, 0.004), ks.Link(2.0))
    machine = ks.Mechanism("cam drive", ks.Crank(None, ks.Link(1.0, 0.01, 0.01)), (follower,))
    return ks.Scene(machine, speed, loads=ks.Spring(5e3, 0.03, on="follower"))


def bars(speed=10.0):
    links = {"crank": ks.Link(1.0, 0.05, 0.01), "coupler": ks.Link(2.0, 0.2, 0.02), "rocker": ks.Link(2.0, 0.15, 0.02)}
    return ks.Scene(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), **links), speed, loads=ks.Gravity())


def light_saw(speed=10.0):
    """A crank-slider for which a torque-free cam is sought."""
    machine = ks.crank_slider(0.1, 0.5, coupler=ks.Link(1.0, 0.2, 0.01), slider=ks.Link(4.0))
    return ks.Scene(machine, speed, loads=ks.Gravity())


def both(function, scene):
    return function(scene), function(mirrored(scene))


@pytest.mark.slow
def test_contact():
    one, other = both(lambda scene: ks.design.contact(scene.solve(36), load_rating=1e4), cam_saw())
    assert one.sides == other.sides
    for name in ("largest_pressure", "largest_pin_load", "largest_pressure_angle"):
        here, there = getattr(one, name), getattr(other, name)
        assert there.value == pytest.approx(here.value, rel=1e-12), name
    assert repr(one).count("exceeded") == repr(other).count("exceeded")


def test_lift_off():
    one, other = both(lambda scene: ks.design.lift_off_speed(scene.solve(4), "contact_force"), cam_drive())
    assert other == pytest.approx(one, rel=1e-9)
    ((start, stop),), ((start_there, stop_there),) = both(
        lambda scene: ks.design.lifted(scene.solve(4), "contact_force"), cam_drive(120.0)
    )
    assert laws.apart(-stop_there, start) < ANGLE
    assert laws.apart(-start_there, stop) < ANGLE


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "speed"), [({}, 10.0), ({"guide": ks.GuideFriction(0.1), "O": ks.PinFriction(0.1, 0.01)}, -10.0)]
)
def test_starting_torque(friction, speed):
    one, other = both(lambda scene: ks.design.starting_torque(scene.solve(4)), pump(speed, friction=friction))
    assert other.value == pytest.approx(one.value, rel=1e-12)
    assert laws.apart(-other.angle, one.angle) < ANGLE


@pytest.mark.slow
def test_least_shaking():
    def shaking(scene):
        weight = {"crank": ks.Counterweight(arm=0.05)}
        balanced = ks.balancing.optimal(scene.mechanism, "largest", phase=True, angles=60, **weight).mechanism
        return ks.extremes(ks.Scene(balanced, 10.0).solve(4), "shaking_force").largest

    one, other = both(shaking, pump())
    assert other == pytest.approx(one, rel=1e-9)


@pytest.mark.slow
def test_optimisation():
    def best(scene, sign):
        bounds = {"spring.stiffness": (100.0, 3000.0), "guide_offset": tuple(sorted((0.0, sign * 0.05)))}
        return ks.design.optimise(scene, bounds, minimise="rms balancing_torque", limits=["largest O <= 240 N"])

    one, other = best(pump(), 1.0), best(mirrored(pump()), -1.0)
    assert sorted(one.active) == sorted(other.active)
    measures = one.report()["after"].to_numpy(), other.report()["after"].to_numpy()
    np.testing.assert_allclose(measures[1], measures[0], rtol=1e-9)


@pytest.mark.slow
def test_torque_free_cams():
    one, other = both(lambda scene: ks.design.torque_free_cam(scene, cosine=2, sine=2), light_saw())
    np.testing.assert_allclose(other.report()["after"], one.report()["after"], rtol=1e-9, atol=1e-12)
    values, image = dict(one.values), dict(other.values)
    for path, value in values.items():
        sign = -1.0 if path.startswith("cam.sine") else 1.0
        assert image[path] == pytest.approx(sign * value, rel=1e-7, abs=1e-9), path


@pytest.mark.slow
def test_torque_balancing_cams():
    def made(scene, angle):
        return ks.design.torque_balancing_cam(scene, mass=0.3, travel=0.01, guide_angle=angle)

    one, other = made(bars(), 0.3), made(mirrored(bars()), -0.3)
    assert other.remaining == pytest.approx(one.remaining, abs=1e-12)
    assert len(one.lifts_off) == len(other.lifts_off)


# Both senses of rotation, and rest

MOTOR = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5, transmission=5.0)
LIMITS = {"lift_off_speed": 5.0, "starting_torque": 3.0, "life": 10.0}
ROUND = {"guide": ks.GuideFriction(0.1)}
STANDS = "solve: friction acts against motion, but crank_speed and crank_acceleration are both 0"
FREE = "without masses or at rest the machine already needs no torque"
CALLS = {
    "contact": (lambda w: ks.design.contact(cam_saw(w).solve(12)).largest_pressure.value, None),
    "life of a roller": (
        lambda w: len(ks.design.contact(cam_saw(w).solve(12), load_rating=1e4, limits=LIMITS).exceeded),
        "a machine that stands wears no bearing",
    ),
    "lift_off_speed": (lambda w: ks.design.lift_off_speed(cam_drive(w).solve(4), "contact_force"), None),
    "lifted": (lambda w: len(ks.design.lifted(cam_drive(w).solve(4), "contact_force")), None),
    "starting_torque": (lambda w: ks.design.starting_torque(pump(w).solve(4)).value, None),
    "starting_torque with friction": (
        lambda w: ks.design.starting_torque(pump(w, friction=ROUND).solve(4)).value,
        STANDS,
    ),
    "spring_surge": (lambda w: ks.design.spring_surge(pump(w).solve(4), 0.5).natural_frequency, None),
    "optimise": (
        lambda w: dict(
            ks.design.optimise(pump(w), {"spring.stiffness": (100.0, 3000.0)}, minimise="rms balancing_torque").values
        )["spring.stiffness"],
        None,
    ),
    "torque_free_cam": (lambda w: len(dict(ks.design.torque_free_cam(light_saw(w), cosine=1).values)), FREE),
    "weight_options": (lambda w: len(ks.design.weight_options(light_saw(w), cosine=1)), FREE),
    "torque_balancing_cam": (
        lambda w: len(ks.design.torque_balancing_cam(bars(w), mass=0.3, travel=0.01).lifts_off),
        "the crank stands; give it its design speed",
    ),
    "steady without motor": (
        lambda w: abs(ks.drive.steady(pump(w), None, 1.0).mean_speed),
        "crank_speed of the scene must not be 0",
    ),
    "steady": (lambda w: ks.drive.steady(pump(w), MOTOR, 1.0).mean_speed, None),
    "flywheel without motor": (
        lambda w: ks.drive.flywheel(pump(w), 0.05).inertia,
        "crank_speed of the scene must not be 0",
    ),
    "flywheel": (lambda w: ks.drive.flywheel(pump(w), 0.05, MOTOR).inertia, None),
    "start": (lambda w: ks.drive.start(pump(w), MOTOR, 1.0).time[-1], None),
    "coast": (lambda w: ks.drive.coast(pump(w), 1.0, 0.0, 8.0, until=0.1).crank_angle[-1], None),
}
"""By name: a call with the crank speed of its scene, and what a machine that stands is told; None: it is answered."""
BY_SENSE = ("starting_torque with friction",)
"""Those whose answer depends on the sense of rotation."""


LONG_CALLS = ("torque_free_cam", "weight_options", "optimise", "contact", "life of a roller")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] if name in LONG_CALLS else []) for name in CALLS]
)
def test_drives_take_both_senses_of_rotation(name):
    """Without friction and loads by stroke a machine takes as much whichever way it turns."""
    call, _ = CALLS[name]
    one, other = call(10.0), call(-10.0)
    assert np.isfinite([one, other]).all()
    assert name in BY_SENSE or other == pytest.approx(one, rel=1e-9)


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] if n == "optimise" else []) for n in CALLS])
def test_standing_machines_answer_or_say_why(name):
    call, refused = CALLS[name]
    if refused is None:
        assert np.isfinite(call(0.0))
        return
    with pytest.raises(ks.KinetostaticsError, match=refused):
        call(0.0)


def test_springs_of_a_standing_machine_swing():
    """Not as often as at 1 rad/s."""
    surge = ks.design.spring_surge(pump(0.0).solve(4), 0.5)
    assert surge.order == np.inf
    assert surge.excitation == 0.0


@pytest.mark.parametrize("acceleration", [5.0, pytest.param(-5.0, marks=pytest.mark.slow)])
def test_starting_torque_is_of_the_coming_motion(acceleration):
    moving = ks.design.starting_torque(pump(np.sign(acceleration), friction=ROUND).solve(4))
    starting = ks.design.starting_torque(pump(0.0, acceleration, friction=ROUND).solve(4))
    assert starting.value == pytest.approx(moving.value, rel=1e-9)


@pytest.mark.slow
def test_sweeps_keep_the_sense_of_each_design():
    speeds = pd.DataFrame({"crank_speed": [-12.0, -4.0, 4.0, 12.0]})
    table = ks.sweep(pump(friction=ROUND), speeds, ["mean balancing_torque"], progress=False)
    for speed, mean in zip(speeds["crank_speed"], table["mean balancing_torque [N m]"], strict=True):
        turn = pump(speed, friction=ROUND).solve(4).energy_per_turn
        assert np.sign(speed) * mean * 2 * np.pi == pytest.approx(turn, rel=1e-12)
