"""Stretches of a motion with friction, and standstill."""

import math
import sys

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive import resolution
from kinetostatics.drive.one_dof import DrivenMachine
from kinetostatics.drive.savings import running_table
from kinetostatics.drive.stick_slip import integrate_motion, sense_from_rest
from support.case_files import shipped
from support.drives import FRICTION_PUMP, FRICTION_REFERENCE, MOTOR, RUBBING, SAW, SMALL

PENDULUM = ks.Scene(
    ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15, 0.02)),
    1.0,
    loads=ks.Gravity(),
    friction={"O": ks.PinFriction(0.1, 0.05)},
)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_wheel_on_a_rubbing_pin_stops_as_by_hand(way):
    """Constant torque of friction: mu radius times the weight; no mass but a centred crank of 2 kg."""
    wheel = ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.0, 0.5))
    scene = ks.Scene(wheel, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(0.2, 0.05)})
    motion = ks.drive.coast(scene, 0.0, 0.3, 4.0 * way, "standstill")
    slowing = 0.2 * 0.05 * 2.0 * 9.81 / 0.5
    assert motion.time[-1] == pytest.approx(4.0 / slowing, rel=1e-13)
    assert motion.crank_angle[-1] == pytest.approx(0.3 + way * 8.0 / slowing, rel=1e-13)
    assert motion.friction_energy[-1] == pytest.approx(4.0, rel=1e-12)


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_only_whole_periods_serve_the_next_ones(monkeypatch, way):
    """A motion begins within its first period, between crank angle 0 and a kink of friction."""
    kept, keep = [], resolution.PastPeriods.keep

    def seen(self, *solved):
        keep(self, *solved)
        kept.extend((part.edges[0], part.edges[-1]) for part, *_ in self.past)

    monkeypatch.setattr(resolution.PastPeriods, "keep", seen)
    saw = shipped("sawframe_2r63_friction").variants["cam-circle"].scene
    ks.drive.coast(saw, 1000.0, 0.4 * way, 33.5 * way, 2.0)
    assert kept
    np.testing.assert_allclose(kept, [(0.0, 2.0 * math.pi)] * len(kept), atol=1e-9)


def test_what_sticks_does_not_move():
    motion = ks.drive.coast(PENDULUM, 0.06, -math.pi / 2 + 0.01, 0.0, 5.0)
    assert [event.name for event in motion.events] == ["start", "standstill"]
    assert motion.time.tolist() == [0.0]


@pytest.mark.slow
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


@pytest.mark.slow
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
    still = ks.Scene(scene.mechanism, 0.0, 1e-30, scene.loads, friction).solve(-math.pi / 2)
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
    hung = DrivenMachine("test", PENDULUM, None, 0.06)
    assert [sense_from_rest(hung, angle) for angle in (-1.0, -math.pi + 1.0, -math.pi / 2 + 0.01)] == [-1.0, 1.0, 0.0]


def test_motion_ends_at_its_target_speed():
    hung = DrivenMachine("test", PENDULUM, None, 0.06)
    found = integrate_motion(hung, -1.0, 0.0, 5.0, target=-0.5)
    assert found.end == "ready"
    assert found.rows[1, -1] == pytest.approx(-0.5, rel=1e-12)
    assert found.path(found.time)[:2] == pytest.approx(found.rows[:2], rel=1e-10, abs=1e-12)


# Machines that rub in periodic running

CAM = ks.Scene(
    ks.cam_crank_slider(ks.cams.Circle(0.1, (0.02, 0.0)), 0.4, slider=ks.Link(10.0), coupler=ks.Link(2.0, 0.2, 0.03)),
    1.0,
    loads=ks.Gravity(),
    friction={
        "O": ks.PinFriction(0.05, 0.02),
        "slot": ks.SlotFriction(0.1),
        "cam": ks.RollerFriction(0.003, 0.02, 0.04),
        "guide": ks.GuideFriction(0.1),
    },
)
MACHINES = {"saw": (RUBBING, MOTOR, 1000.0), "pump": (FRICTION_PUMP, SMALL, 0.3), "cam": (CAM, SMALL, 1.0)}


@pytest.fixture(scope="module", params=MACHINES)
def run(request):
    scene, motor, flywheel = MACHINES[request.param]
    return ks.drive.steady(scene, motor, flywheel)


@pytest.mark.slow
def test_motor_drives_at_the_true_acceleration(run):
    torque = run.motor.transmission * run.motor_torque - run.flywheel * run.acceleration
    assert np.abs(torque - run.crank_torque).max() < 1e-13 * np.abs(run.crank_torque).max()
    assert run.solution.friction_loss.min() >= 0.0


@pytest.mark.slow
def test_motor_gives_what_loads_and_friction_take(run):
    lost = sum(run.friction_energy_per_turn_at(joint) for joint in run.scene.friction)
    flowing = run.energy_per_turn
    assert flowing == pytest.approx(run.load_energy_per_turn + lost, rel=1e-12, abs=1e-12 * lost)
    assert run.mean_power == pytest.approx(run.mean_friction_loss + run.load_energy_per_turn / run.duration, rel=1e-12)
    assert run.friction_energy_per_turn == pytest.approx(lost, rel=1e-15)


def test_energy_changes_by_the_work_of_torques(run):
    """Motor, loads and friction by the tables of the run, integrated apart from its own series."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    edges = np.union1d(run._pieces.edges, np.linspace(0.0, run.period, 41))
    half, middle = np.diff(edges)[:, None] / 2, (edges[1:] + edges[:-1])[:, None] / 2
    angle = middle + half * nodes
    speed, acceleration = (part.ravel() for part in run.motion(angle))
    moving = ks.Scene(run.scene.mechanism, speed, acceleration, run.scene.loads, run.scene.friction)
    s = moving.solve(angle.ravel())
    drive = run.motor.transmission * run.motor.torque(run.motor.transmission * speed)
    net = drive - s.load_torque - s.friction_torque
    gained = np.cumsum((half * weights * net.reshape(angle.shape)).sum(axis=1))
    ends = run.motion(edges)[0]
    inertia = run.flywheel + run.scene.solve(edges, on_gap="nan").reduced_inertia
    energy = 0.5 * inertia * ends**2
    assert np.abs(energy[1:] - energy[0] - gained).max() < 1e-12 * energy.max()


@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_constant_torque_carries_the_losses(speed):
    scene = ks.Scene(SAW, speed, loads=ks.Gravity(), friction=RUBBING.friction)
    run = ks.drive.steady(scene, None, 1000.0)
    assert run.mean_speed == pytest.approx(speed, rel=1e-14)
    assert run.energy_per_turn == pytest.approx(run.friction_energy_per_turn, rel=1e-12)
    balance = run.motor_torque - run.flywheel * run.acceleration - run.crank_torque
    assert np.abs(balance).max() < 1e-13 * np.abs(run.crank_torque).max()
    step, angle = 1e-5, np.linspace(0.5, 6.0, 9)
    after, before = (run.motion(angle + way * step)[0] for way in (1, -1))
    rate, acceleration = (after - before) / (2 * step), run.motion(angle)[1]
    assert rate * run.motion(angle)[0] == pytest.approx(acceleration, rel=1e-6, abs=1e-6)


def test_flywheel_for_a_fluctuation_runs_with_it():
    textbook = ks.drive.flywheel(FRICTION_PUMP, 0.02)
    s = FRICTION_PUMP.solve(7200)
    spare = np.cumsum(s.balancing_torque.mean() - s.balancing_torque) * 2 * np.pi / 7200
    assert textbook.energy == pytest.approx(np.ptp(spare), rel=1e-3)


def test_friction_that_vanishes_changes_nothing():
    free = ks.Scene(SAW, 1.0, loads=ks.Gravity())
    none = ks.Scene(SAW, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(0.0, 0.1)})
    one, other = (ks.drive.steady(scene, MOTOR, 1000.0) for scene in (free, none))
    assert np.array_equal(one.speed, other.speed)
    slight = ks.Scene(SAW, 1.0, loads=ks.Gravity(), friction={"O": ks.PinFriction(1e-12, 0.06)})
    assert ks.drive.steady(slight, MOTOR, 1000.0).speed == pytest.approx(one.speed, rel=1e-11)


@pytest.mark.parametrize("engine", ["numpy", pytest.param("compiled", marks=pytest.mark.slow)])
def test_the_rubbing_saw_runs_as_many_digits_say(engine):
    if engine == "compiled":
        pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    angles = np.radians(FRICTION_REFERENCE["angle [deg]"])
    run = ks.drive.steady(RUBBING, MOTOR, 1000.0, angles=angles, engine=engine)
    for name in ("speed", "acceleration", "motor_torque"):
        exact = np.array(FRICTION_REFERENCE[name], dtype=float)
        assert np.abs(getattr(run, name) - exact).max() < 1e-12 * np.abs(exact).max(), name
    assert run.mean_speed == pytest.approx(float(FRICTION_REFERENCE["mean_speed"]), rel=1e-14)
    assert run.friction_energy_per_turn == pytest.approx(float(FRICTION_REFERENCE["friction_energy"]), rel=1e-12)


@pytest.mark.slow
def test_friction_that_jams_is_refused_with_its_angles():
    steep = ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0))
    scene = ks.Scene(steep, 1.0, loads=ks.Gravity(), friction={"guide": ks.GuideFriction(1.2)})
    for drive in (lambda: ks.drive.steady(scene, SMALL, 1.0), lambda: ks.drive.coast(scene, 1.0, 0.0, 5.0, 1.0)):
        with pytest.raises(ks.JammingError, match=r"friction jams at .* or steepen the links$"):
            drive()


def test_the_summary_tells_the_power_lost_by_joint(run):
    table = running_table({"machine": run}, {"machine": None})["machine"]
    assert table["lost by friction, mean"] == run.mean_friction_loss
    assert table["lost by friction at guide, mean"] == run.mean_friction_loss_at("guide")


@pytest.mark.slow
def test_friction_and_table_work_without_numba(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    work = ks.ProcessForce(ks.Table([0.19, 0.3, 0.33], [0.0, 0.0, -6e3], over="travel", back=[0.0, 0.0, 0.0]))
    press = ks.crank_slider(0.06, 0.26, slider=ks.Link(22.0))
    scene = ks.Scene(press, 12.0, loads=work, friction={"O": ks.PinFriction(0.05, 0.025)})
    motion = ks.drive.start(scene, SMALL, 3.0, until=0.5)
    assert motion.energy_drift < 1e-12 * motion.kinetic_energy[-1]


@pytest.mark.slow
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_periods_solved_together_are_those_one_by_one(monkeypatch, way):
    motion = ks.drive.coast(FRICTION_PUMP, 2.0, 0.3, way * 30.0, until=4.0)
    monkeypatch.setattr(resolution, "MAX_PERIODS", 1)
    alone = ks.drive.coast(FRICTION_PUMP, 2.0, 0.3, way * 30.0, until=4.0)
    assert abs(motion.crank_angle[-1] - 0.3) > 10.0 * 2.0 * math.pi
    assert motion.crank_angle[-1] == pytest.approx(alone.crank_angle[-1], rel=1e-13)
    assert motion.speed[-1] == pytest.approx(alone.speed[-1], rel=1e-12)


@pytest.mark.slow
def test_forces_that_vanish_have_no_kinks():
    """Nothing but rounding acts in the slot of a crank without mass or flywheel."""
    scene = shipped("sawframe_2r63_friction").variants["cam-cosine-rolling"].scene
    motion = ks.drive.coast(scene, 0.0, 0.0, 33.5, "standstill")
    assert motion.time.size < 1000
    assert motion.energy_drift < 1e-12 * motion.kinetic_energy.max()
