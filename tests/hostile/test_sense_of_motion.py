"""The sense of rotation at and around standstill: every load and joint reads the same one."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every, quick
from support.mirror import mirrored
from support.turning_machines import ANGLES, turning_scene

PRESS = ks.crank_slider(0.1, 0.35, crank=ks.Link(2.0, 0.03, 0.02), slider=ks.Link(4.0))
INDICATOR = ks.Table([0.2, 0.5], [-100.0, -100.0], over="travel", back=[0.0, 0.0])
"""A force against the outward stroke alone; the mirrored machine has the same."""
FAINT = ks.TorsionDamper(1e-12, on="crank")
STROKES = {
    "table": ks.Table([0.2, 0.5], [-1600.0, -1600.0], over="travel", back=[0.0, 0.0]),
    "comparison": lambda q: -1600.0 * (q.slider_velocity > 0.0),
    "sign": lambda q: -800.0 * (1.0 + np.sign(q.slider_velocity)),
    "sense": lambda q: -800.0 * (1.0 + np.sign(q.crank_sense * -np.sin(q.crank_angle))),
}
"""Laws of one force: 1600 N against the outward stroke of `PRESS`; the last knows its stroke by the crank's sense."""


def press(loads, speed=1.0):
    return ks.Scene(PRESS, speed, loads=loads)


def motor(transmission):
    return ks.drive.Motor.kloss(5000.0, 99.0, synchronous_speed=104.7, overload=2.5, transmission=transmission)


# Coasting


@pytest.mark.parametrize(("sense", "others"), [(1.0, ()), pytest.param(-1.0, (FAINT,), marks=pytest.mark.slow)])
def test_coasting_reads_the_stroke_by_its_motion(sense, others):
    scene = press([ks.ProcessForce(INDICATOR), *others])
    motion = ks.drive.coast(scene, 1.0, from_angle=-sense * 0.7, from_speed=sense * 8.0, until=1.0)
    assert motion.crank_angle[-1] == pytest.approx(sense * 6.20897, abs=1e-4)
    assert motion.energy_drift < 1e-11


@pytest.mark.slow
def test_energy_drift_uses_the_solved_loads():
    """It shares nothing with the integration but the motion: a motion under another load does not balance."""
    scene = press(ks.ProcessForce(INDICATOR))
    motion = ks.drive.coast(scene, 1.0, from_angle=0.7, from_speed=-8.0, until=1.0)
    power = motion.at(4001)
    torque = power.solution.load_torque
    work = np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(power.crank_angle))
    lost = power.kinetic_energy[0] - power.kinetic_energy[-1]
    assert lost == pytest.approx(work, abs=0.01)
    assert lost > 10.0


@pytest.mark.slow
def test_rocking_back_reads_the_other_stroke():
    """Thrown up against gravity, the machine comes back; the force takes energy on outward strokes alone."""
    hung = ks.crank_slider(0.1, 0.35, crank=ks.Link(6.0, 0.09, 0.02), slider=ks.Link(1.0))
    weak = ks.Table([0.2, 0.5], [-5.0, -5.0], over="travel", back=[0.0, 0.0])
    scene = ks.Scene(hung, 1.0, loads=[ks.Gravity(), ks.ProcessForce(weak)])
    motion = ks.drive.coast(scene, 0.05, from_angle=-np.pi / 2, from_speed=5.0, until=3.0)
    assert sum(event.name == "reversal" for event in motion.events) >= 3
    fine = motion.at(20001)
    outward = fine.solution.slider_velocity > 0.0
    moving = np.abs(fine.speed) > 1e-3
    torque = fine.solution.load_torque - ks.Scene(hung, 1.0, loads=ks.Gravity()).solve(fine.crank_angle).load_torque
    assert np.all(np.abs(torque[moving & ~outward]) < 1e-9)
    assert np.max(np.abs(torque[moving & outward])) > 0.4
    assert motion.energy_drift < 1e-10


@pytest.mark.parametrize("law", STROKES)
def test_a_force_against_motion_lets_a_machine_stick(law):
    """Coulomb's law as a table, or as functions: 1600 N either way hold a slider against 200 N."""
    both = {
        "table": ks.Table([0.2, 0.5], [-1600.0, -1600.0], over="travel", back=[1600.0, 1600.0]),
        "comparison": lambda q: -1600.0 * (q.slider_velocity > 0.0) + 1600.0 * (q.slider_velocity < 0.0),
        "sign": lambda q: -1600.0 * np.sign(q.slider_velocity),
        "sense": lambda q: -1600.0 * np.sign(q.crank_sense * -np.sin(q.crank_angle)),
    }[law]
    scene = press([ks.ProcessForce(both), ks.ProcessForce(200.0)])
    motion = ks.drive.coast(scene, 0.1, from_angle=1.0, from_speed=10.0, until=5.0)
    assert motion.events[-1].name == "standstill"
    table = ks.ProcessForce(ks.Table([0.2, 0.5], [-1600.0] * 2, over="travel", back=[1600.0] * 2))
    loads = [table, ks.ProcessForce(200.0)]
    expected = ks.drive.coast(press(loads), 0.1, from_angle=1.0, from_speed=10.0, until=5.0)
    assert motion.crank_angle[-1] == pytest.approx(expected.crank_angle[-1], abs=1e-7)


def test_ambiguous_start_asks_for_a_direction():
    pushing = ks.Table([0.2, 0.5], [100.0, 100.0], over="travel", back=[-100.0, -100.0])
    with pytest.raises(
        ks.DriveError, match=r"at rest at crank angle 57\.2958 deg it may start either way: .* from_speed"
    ):
        ks.drive.coast(press(ks.ProcessForce(pushing)), 1.0, from_angle=1.0, until=1.0)


# Starting


@pytest.mark.parametrize(
    ("law", "ratio", "others"),
    [
        *((law, (-1) ** place * 10.0, ()) for place, law in enumerate(STROKES)),
        ("sign", -10.0, ()),
        ("sign", -10.0, (ks.TorsionDamper(1e-3, on="crank"),)),
    ],
)
def test_starts_ask_for_the_stroke_that_begins(law, ratio, others):
    """At 1 rad the crank that turns counter-clockwise draws the slider in: no force; the other way it must push."""
    scene = press([ks.ProcessForce(STROKES[law]), *others])
    motion = ks.drive.start(scene, motor(ratio), 1.0, from_angle=1.0, until=0.004)
    free = ks.drive.start(press(others), motor(ratio), 1.0, from_angle=1.0, until=0.004)
    slower = abs(free.speed[-1]) - abs(motion.speed[-1])
    assert slower == pytest.approx(0.0, abs=1e-12) if ratio > 0.0 else slower > 0.3


@every("law", STROKES)
@every("sense", [1.0, -1.0])
def test_weak_motor_names_one_torque_for_all_laws(law, sense):
    scene = press(ks.ProcessForce(STROKES[law]))
    weak = ks.drive.Motor.constant(20.0, transmission=sense)
    with pytest.raises(ks.DriveError, match=r"the loads take 166\.426 N m at rest, the motor gives 20 N m") as told:
        ks.drive.start(scene, weak, 1.0, from_angle=-sense * 1.3, until=0.02)
    assert told.value.missing == pytest.approx(torque_of_1600_newton(1.3) - 20.0, rel=1e-9)


def torque_of_1600_newton(angle):
    """Torque of 1600 N on the slider of `PRESS` by virtual work, N m."""
    height, rod = 0.1 * np.sin(angle), 0.35
    return 1600.0 * height * (1.0 + 0.1 * np.cos(angle) / np.sqrt(rod**2 - height**2))


@pytest.mark.parametrize("ratio", [10.0, -10.0])
@pytest.mark.parametrize("sense", [1, -1])
def test_running_takes_its_sense_from_the_motor(ratio, sense):
    loads = ks.ProcessForce(INDICATOR)
    resting = ks.drive.steady(ks.Scene(PRESS, 0.0, loads=loads, sense=sense), motor(ratio), 5.0)
    moving = ks.drive.steady(press(loads), motor(ratio), 5.0)
    assert np.array_equal(resting.solution.balancing_torque, moving.solution.balancing_torque)
    assert resting.energy_flow.frame().equals(moving.energy_flow.frame())


# Design


@pytest.mark.parametrize("speed", [-10.0, 10.0])
def test_starting_torque_follows_the_rotation(speed):
    machine = ks.crank_slider(0.1, 0.35, guide_offset=np.copysign(0.03, -speed), slider=ks.Link(4.0))
    table = ks.Table([0.2, 0.34, 0.46], [-100.0, -100.0, -3000.0], over="travel", back=[-50.0, -2000.0, -50.0])
    loads = [ks.ProcessForce(table), ks.Gravity(direction=np.pi)]
    found = ks.design.starting_torque(ks.solve(machine, 0.5, crank_speed=speed, loads=loads))
    assert found.value == pytest.approx(213.54, abs=0.005)
    assert np.cos(found.angle) == pytest.approx(np.cos(4.859), abs=1e-3)
    assert np.sin(found.angle) == pytest.approx(np.copysign(np.sin(4.859), speed), abs=1e-3)


@pytest.mark.parametrize(("law", "speed"), [("comparison", -10.0), ("sign", 10.0), ("sense", -10.0), ("sense", 10.0)])
def test_function_and_table_start_alike(law, speed):
    expected = ks.design.starting_torque(
        ks.solve(PRESS, 0.5, crank_speed=speed, loads=ks.ProcessForce(STROKES["table"]))
    )
    found = ks.design.starting_torque(ks.solve(PRESS, 0.5, crank_speed=speed, loads=ks.ProcessForce(STROKES[law])))
    assert found.value == pytest.approx(expected.value, rel=1e-12)


def test_resting_solution_passes_on_its_sense():
    at_rest = ks.solve(PRESS, 0.5, crank_speed=0.0, sense=-1, loads=ks.ProcessForce(STROKES["table"]))
    turning = ks.solve(PRESS, 0.5, crank_speed=-1.0, loads=ks.ProcessForce(STROKES["table"]))
    assert ks.design.starting_torque(at_rest) == ks.design.starting_torque(turning)


# The scene at rest

CASE_AT_REST = """
title = "A crank at rest"
reference = "forward"

[variants.forward]
mechanism = "crank-slider"
crank_length = "100 mm"
coupler_length = "350 mm"
crank_speed = "0 rpm"
sense = 1
friction.guide = { mu = 0.1 }
slider = { mass = "4 kg" }
gravity = {}

[variants.backward]
mechanism = "crank-slider"
crank_length = "100 mm"
coupler_length = "350 mm"
crank_speed = "0 rpm"
sense = -1
friction.guide = { mu = 0.1 }
slider = { mass = "4 kg" }
gravity = {}"""


@every("law", STROKES)
@every("drive", [{"sense": -1}, {"crank_acceleration": -3.0}, {"crank_acceleration": [3.0, -3.0, 3.0]}])
def test_functions_know_the_motion_as_tables_do(law, drive):
    """By the velocity, and of the acceleration's sense where the scene has none."""
    angle, speed = [1.0, 2.0, 4.0], np.zeros(3) if np.ndim(drive.get("crank_acceleration", 0.0)) else 0.0
    own, table = (
        ks.solve(PRESS, angle, crank_speed=speed, loads=ks.ProcessForce(STROKES[name]), **drive).load_torque
        for name in (law, "table")
    )
    assert np.any(table)
    assert own == pytest.approx(table, rel=1e-12)


@pytest.mark.parametrize("sense", [1, -1])
def test_sense_at_rest_is_given_or_by_acceleration(sense):
    drive = {"friction": {"O": ks.PinFriction(0.1, 0.02)}, "loads": ks.ProcessForce(STROKES["table"])}
    angle = np.linspace(0.1, 6.2, 9)
    given = ks.solve(PRESS, angle, crank_speed=0.0, sense=sense, **drive)
    begun = ks.solve(PRESS, angle, crank_speed=0.0, crank_acceleration=sense * 1e-12, **drive)
    creeping = ks.solve(PRESS, angle, crank_speed=sense * 1e-12, **drive)
    assert given.balancing_torque == pytest.approx(begun.balancing_torque, abs=1e-9)
    assert given.balancing_torque == pytest.approx(creeping.balancing_torque, abs=1e-9)
    program = ks.compile(ks.Scene(PRESS, 0.0, sense=sense, **drive), "balancing_torque", engine="numpy")
    assert program(angle)["balancing_torque"] == pytest.approx(given.balancing_torque, abs=1e-12)
    other = program(angle, {"sense": -float(sense)})["balancing_torque"]
    opposite = ks.solve(PRESS, angle, crank_speed=0.0, sense=-sense, **drive)
    assert other == pytest.approx(opposite.balancing_torque, abs=1e-12)


REFUSED = {
    "neither way": ({"crank_speed": 0.0}, r"values for the stroke back, .* both 0: give sense=\+1 or sense=-1"),
    "no sign": ({"crank_speed": 0.0, "sense": 0}, r"sense must be \+1 or -1, .*, got 0"),
    "a speed": ({"crank_speed": 0.0, "sense": -8.0}, r"sense must be \+1 or -1, .*, got -8"),
    "a word": ({"crank_speed": 0.0, "sense": "clockwise"}, "sense must be a number"),
    "against the speed": ({"crank_speed": 3.0, "sense": -1}, "sense is for a crank at rest: -1 contradicts .* 3"),
}


@every(("drive", "words"), REFUSED.values(), ids=REFUSED)
def test_a_sense_that_cannot_be_is_refused(drive, words):
    with pytest.raises(ks.ParameterError, match=words):
        _ = ks.solve(PRESS, 0.5, loads=ks.ProcessForce(INDICATOR), **drive).balancing_torque


@pytest.mark.slow_start
def test_case_file_gives_the_sense_at_rest(tmp_path):
    path = tmp_path / "rest.toml"
    path.write_text(CASE_AT_REST, encoding="utf-8")
    case = ks.load_case(path)
    for name, sense in {"forward": 1, "backward": -1}.items():
        scene = case.variants[name].scene
        moving = ks.solve(scene.mechanism, 1.0, crank_speed=sense * 1e-9, loads=scene.loads, friction=scene.friction)
        assert scene.solve(1.0).balancing_torque == pytest.approx(moving.balancing_torque, rel=1e-9)


@pytest.mark.slow
def test_a_sense_may_be_traced():
    jax = pytest.importorskip("jax")

    def torque(sense):
        return ks.solve(PRESS, 1.0, crank_speed=0.0, sense=sense, loads=ks.ProcessForce(INDICATOR)).balancing_torque

    traced = [float(jax.jit(torque)(sense)) for sense in (1.0, -1.0)]
    assert traced == pytest.approx([torque(1), torque(-1)], rel=1e-6)


def test_a_zero_has_no_sense():
    signs = [ks.solve(PRESS, 0.5, crank_speed=speed).crank_sense for speed in (0.0, -0.0)]
    assert signs == [1.0, 1.0]


@pytest.mark.parametrize("sense", ["true", "0", "2", '"clockwise"', "0.5"])
def test_a_case_file_refuses_what_is_no_sense(tmp_path, sense):
    path = tmp_path / "rest.toml"
    path.write_text(CASE_AT_REST.replace("sense = -1", f"sense = {sense}"), encoding="utf-8")
    with pytest.raises(ks.CaseError, match=r"variants\.backward\.sense"):
        ks.load_case(path)


def test_function_cannot_read_the_sense_at_rest():
    loads = ks.Torque(lambda q: -5.0 * q.crank_sense, on="crank")
    with pytest.raises(ks.ParameterError, match=r"uses crank_sense, but .* both 0: give sense=\+1 or sense=-1"):
        _ = ks.solve(PRESS, 0.5, crank_speed=0.0, loads=loads).balancing_torque
    assert ks.solve(PRESS, 0.5, crank_speed=0.0, sense=-1, loads=loads).balancing_torque == pytest.approx(-5.0)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: ks.Force(5.0), "at must be a joint"),
        (lambda: ks.balancing.optimal(press(())), "mechanism must be a Mechanism"),
        (lambda: ks.balancing.full(press(()), crank=0.1, coupler=0.1), "mechanism must be a Mechanism"),
        (lambda: ks.drive.coast(press(()), 1.0, from_speed=1.0), 'give until, a time in s, or "standstill"'),
    ],
)
def test_what_is_left_out_or_mistaken_is_named(call, words):
    with pytest.raises(ks.ParameterError, match=words):
        call()


def test_power_balance_at_rest_scales_with_friction():
    machine = ks.crank_slider(0.1, 0.35, guide_offset=0.02, slider=ks.Link(4.0))
    friction = {"guide": ks.GuideFriction(0.2), "O": ks.PinFriction(0.1, 0.02)}
    angle = np.linspace(0.0, 6.0, 13)
    at_rest = ks.solve(machine, angle, crank_speed=0.0, sense=1, loads=ks.Gravity(), friction=friction)
    assert at_rest.power_residual < 1e-14


# Motions that come to rest under loads which ask for the sense of rotation, and what may follow from that sense

RUBS = {"guide": ks.GuideFriction(0.1)}
OPPOSED = {
    "table": ks.ProcessForce(ks.Table([0.2, 0.5], [-300.0] * 2, over="travel", back=[300.0] * 2)),
    "sign": ks.ProcessForce(lambda q: -300.0 * np.sign(q.slider_velocity)),
    "sense": ks.ProcessForce(lambda q: 300.0 * np.sign(q.crank_sense * np.sin(q.crank_angle))),
}
"""Laws of one force: 300 N against the motion of the slider."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "sense", "until", "friction"),
    [
        *((law, 1.0, "standstill", {}) for law in OPPOSED),
        *((law, -1.0, 0.2, RUBS) for law in OPPOSED),
        ("table", 1.0, "standstill", RUBS),
        ("table", -1.0, 0.2, {}),
    ],
)
def test_machine_stops_against_opposing_loads(law, sense, until, friction):
    """Steps of the integration end beyond the standstill; the loads may take no speed against the sense for it."""
    scene = ks.Scene(PRESS, 1.0, loads=OPPOSED[law], friction=friction)
    motion = ks.drive.coast(scene, 0.1, from_angle=sense * 0.7, from_speed=sense * 6.0, until=until)
    assert motion.events[-1].name == "standstill"
    assert sense * motion.crank_angle[-1] == pytest.approx(0.804471 if friction else 0.806150, abs=2e-6)
    assert motion.energy_drift < 1e-12


# What a program is told of the sense

WORK = ks.ProcessForce(ks.Table([0.2, 0.5], [-100.0] * 2, over="travel", back=[30.0, 0.0]))


@pytest.mark.slow
@pytest.mark.parametrize(("drive", "friction"), [("crank_speed", RUBS), ("crank_acceleration", {})])
def test_jax_differentiates_with_a_given_sense(drive, friction):
    """While JAX traces a speed its value is not known, so nothing is said of rest."""
    jax = pytest.importorskip("jax")

    def torque(value, angle):
        motion = {"crank_speed": 2.0, "crank_acceleration": 1.0, drive: value}
        return ks.solve(PRESS, angle, loads=WORK, friction=friction, **motion).balancing_torque.sum()

    with jax.enable_x64(True):
        slope = jax.grad(torque)(2.0, jax.numpy.array([0.5]))
    between = (torque(2.001, np.array([0.5])) - torque(1.999, np.array([0.5]))) / 0.002
    assert float(slope) == pytest.approx(between, rel=1e-8)


@pytest.mark.slow
def test_a_speed_of_jax_that_is_known_is_looked_at():
    jax = pytest.importorskip("jax")
    with pytest.raises(ks.ParameterError, match=r"give sense=\+1 or sense=-1"):
        _ = ks.solve(PRESS, jax.numpy.array([0.5]), crank_speed=jax.numpy.array(0.0), loads=WORK).balancing_torque
    with pytest.raises(ks.ParameterError, match="sense is for a crank at rest"):
        ks.solve(PRESS, jax.numpy.array([0.5]), crank_speed=jax.numpy.array(3.0), sense=-1, loads=WORK)


DERIVED = {
    "uncertainty": lambda scene: scene.solve(9).uncertainty("balancing_torque", {"sense": 0.1}),
    "program": lambda scene: ks.compile(scene, "balancing_torque", engine="numpy").derivatives(0.5, "sense"),
}


@pytest.mark.parametrize("name", DERIVED)
def test_nothing_is_derived_by_the_sense(name):
    """It is one of two; a slope between them was told: 0.29 N m a unit of it."""
    scene = ks.Scene(PRESS, 0.0, loads=WORK, friction=RUBS, sense=-1)
    with pytest.raises(ks.ParameterError, match=r"no derivative by sense: it is either \+1 or -1"):
        DERIVED[name](scene)
    slopes = ks.compile(scene, "balancing_torque", engine="numpy").derivatives(0.5)["balancing_torque"]
    assert "slider.mass" in slopes
    assert "sense" not in slopes


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "sense"), quick([("crank slider", 1), ("lever", -1), ("roller follower", 1), ("two sliders", -1)], 2)
)
def test_machine_at_rest_equals_one_that_creeps(kind, sense):
    turning = turning_scene(kind, 60, friction=True)
    rest = ks.Scene(turning.mechanism, 0.0, 0.0, turning.loads, turning.friction, sense=sense)
    creeping = ks.Scene(turning.mechanism, sense * 1e-12, 0.0, turning.loads, turning.friction)
    torque = rest.solve(ANGLES).balancing_torque
    close = 1e-9 * np.abs(torque).max()
    assert creeping.solve(ANGLES).balancing_torque == pytest.approx(torque, abs=close)
    assert mirrored(rest).solve(-ANGLES).balancing_torque == pytest.approx(-torque, abs=close)


@pytest.mark.parametrize("loads", [(), (ks.ProcessForce(ks.Table([0.2, 0.5], [-100.0] * 2, "travel", [100.0] * 2)),)])
def test_machine_at_rest_from_the_start_is_solved(loads):
    scene = ks.Scene(PRESS, 1.0, loads=[ks.Gravity(), *loads], friction={"O": ks.PinFriction(0.5, 0.3)})
    motion = ks.drive.coast(scene, 0.06, from_angle=1.4, until=2.0)
    assert motion.events[-1].name == "standstill"
    assert np.all(np.abs(motion.solution.crank_sense) == 1.0)
    assert np.isfinite(motion.solution.balancing_torque).all()
    assert motion.energy_drift == 0.0
