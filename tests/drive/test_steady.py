"""Steady running."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import kinetostatics as ks
from kinetostatics.drive.savings import running_table, speed_hint
from support.drives import CUT, DISC_MOTOR, FAN, MOTOR, PUMP, REFERENCE, SAW, TURN, saw


@pytest.mark.slow
def test_speed_and_time_are_integrals():
    run = ks.drive.steady(saw(FAN), MOTOR, 100.0, angles=[0.4, 2.9])
    change = quad(lambda angle: float(np.divide(*run.motion(np.array(angle))[::-1])), 0.4, 2.9, epsrel=1e-13)[0]
    assert change == pytest.approx(run.speed[1] - run.speed[0], rel=1e-11)
    time = quad(lambda angle: 1.0 / float(run.motion(np.array(angle))[0]), 0.4, 2.9, epsrel=1e-13)[0]
    assert time == pytest.approx(run.time[1] - run.time[0], rel=1e-12)


def test_running_works_as_any_solution():
    run = ks.drive.steady(saw(CUT), MOTOR, 1000.0)
    other = ks.drive.steady(saw(CUT), MOTOR, 50.0)
    found = ks.extremes(run.solution, "balancing_torque")
    assert found.range[1] >= run.solution.balancing_torque.max() - 1e-9
    assert ks.compare(run.solution, other.solution).mean_torque_ratio > 1.0
    assert len(run.frame()) == 720
    assert len(run.solution.frame()) == 720


# Powers and energies of a machine in periodic running, against sums over many crank angles


def test_rotor_loss_is_slip_times_air_gap_power():
    run = ks.drive.steady(saw(CUT, FAN), MOTOR, 100.0, angles=4096)
    weight = 1.0 / np.abs(run.speed)
    slip = 1.0 - run.motor_speed / 157.0
    loss = TURN * np.mean(slip * run.motor_torque * 157.0 * weight)
    assert run.rotor_loss_per_turn == pytest.approx(loss, rel=1e-4)
    assert run.peak_power >= np.abs(run.motor_power).max()
    assert run.mean_power == pytest.approx(np.sum(run.motor_power * weight) / np.sum(weight), rel=1e-4)


# The solution of a machine in periodic running


RUN = ks.drive.steady(ks.Scene(SAW, 1.0, loads=ks.Gravity()), MOTOR, 30.0)
FEW = np.array([0.1, 2.0, 9.0])


def test_running_has_its_speed_at_other_angles():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    assert np.array_equal(there.crank_speed, speed)
    assert np.array_equal(there.crank_acceleration, acceleration)
    plain = ks.Scene(SAW, speed, acceleration, ks.Gravity()).solve(FEW)
    assert np.array_equal(there.balancing_torque, plain.balancing_torque)
    one = RUN.solution.at(2.0)
    assert one.balancing_torque == pytest.approx(there.balancing_torque[1], rel=1e-13)


def test_motor_torque_holds_between_the_angles():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    given = MOTOR.torque_at_crank(speed) - 30.0 * acceleration
    assert there.balancing_torque == pytest.approx(given, rel=1e-12, abs=1e-12 * np.abs(given).max())


def test_running_repeats_and_prints_its_mean_speed():
    assert RUN.solution.period == RUN.period
    assert repr(RUN.solution).startswith("<RunningSolution")
    assert repr(RUN.solution).endswith(f"mean speed {RUN.mean_speed:.9g} rad/s>")


# What running comes to


KLOSS = ks.drive.Motor.kloss(5e3, 150.0, synchronous_speed=157.0, overload=2.5, transmission=5.0)


def test_machines_stand_side_by_side_with_units():
    scene = ks.Scene(PUMP, 1.0, loads=(ks.Gravity(), ks.Torque(-40.0, on="crank")))
    runs = {"line": ks.drive.steady(scene, DISC_MOTOR, 5.0), "Kloss": ks.drive.steady(scene, KLOSS, 5.0)}
    table = running_table(runs, {"line": None, "Kloss": ks.drive.start(scene, KLOSS, 5.0)})
    assert list(table) == ["unit", "line", "Kloss"]
    for name, run in runs.items():
        assert table.loc["mean speed of the crank", name] == run.mean_speed
        assert table.loc["energy per turn, at the shaft", name] == pytest.approx(2 * math.pi * 40.0, rel=1e-9)
    assert table.loc["mean motor power", "unit"] == "W"
    for row in ("lost in the rotor by slip, mean", "start-up time from crank angle 0 deg"):
        assert math.isnan(table.loc[row, "line"])
        assert table.loc[row, "Kloss"] > 0.0


@pytest.mark.slow
def test_a_motor_without_its_transmission_is_told():
    """At 157 rad/s on the crank of a scene that says 1; with the transmission there is nothing to say."""
    for transmission, told in ((1.0, True), (150.0, False)):
        motor = ks.drive.Motor.kloss(5e3, 150.0, synchronous_speed=157.0, overload=2.5, transmission=transmission)
        scene = ks.Scene(PUMP, 1.0, loads=(ks.Torque(-4.0, on="crank"),))
        found = speed_hint(ks.drive.steady(scene, motor, 50.0), scene)
        assert (found is not None and "transmission of the motor, 1, right?" in found) == told


# Periodic running

CAM = ks.cams.CosineLaw(0.3, 2.0)
DAMPER = ks.PointDamper(150.0, between=("A", (0.5, 1.0)))


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["numpy", "compiled"])
def test_the_plain_sawframe_runs_as_30_digits_say(engine):
    if engine == "compiled":
        pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    motor = ks.drive.Motor.kloss(**REFERENCE["motor"])
    scene = ks.load_case("sawframe_2r63").variants["plain"].scene
    run = ks.drive.steady(scene, motor, 1000.0, angles=np.radians(REFERENCE["angle [deg]"]), engine=engine)
    for name in ("speed", "acceleration", "motor_torque"):
        exact = np.array(REFERENCE[name], dtype=float)
        assert np.abs(getattr(run, name) - exact).max() < 1e-11 * np.abs(exact).max(), name
    for name in ("mean_speed", "fluctuation", "fluctuation_arithmetic"):
        assert getattr(run, name) == pytest.approx(float(REFERENCE[name]), rel=1e-12), name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mechanism", "loads", "flywheel"),
    [
        (SAW, (ks.Gravity(), CUT), 1000.0),
        (SAW, (ks.Gravity(), DAMPER, FAN), 30.0),
        (SAW, (ks.Gravity(),), 0.0),
        (
            ks.cam_crank_slider(CAM, CAM.coupler_length, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0)),
            (ks.Gravity(), ks.Spring(6.7e5, 2.0)),
            100.0,
        ),
        (
            ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.4), rocker=ks.Link(50.0, (0.3, 0.1), 4.0)),
            (ks.Gravity(), ks.Torque(-400.0, on="rocker")),
            5.0,
        ),
    ],
    ids=["table", "dampers", "no flywheel", "cam", "four-bar"],
)
def test_true_motion_balances_motor_and_flywheel(mechanism, loads, flywheel):
    run = ks.drive.steady(ks.Scene(mechanism, 1.0, loads=loads), MOTOR, flywheel)
    drive = MOTOR.transmission * run.motor_torque
    left = run.solution.balancing_torque + flywheel * run.acceleration - drive
    scale = max(np.abs(drive).max(), np.abs(flywheel * run.acceleration).max(), run.solution.largest_torque_term)
    assert np.abs(left).max() < 1e-12 * scale
    # work of the loads in a turn, by quadrature of their torque between the crank angles of tables
    whole = run.solution.at(np.linspace(0.0, TURN, 40 * 64, endpoint=False) + TURN / 5120)
    work = TURN * np.mean(whole.load_torque)
    assert run.energy_per_turn == pytest.approx(work, rel=2e-4, abs=1e-11 * TURN * scale)


def test_motor_line_in_speed_squared_is_closed_form():
    """T = a - b omega^2, here as constant torque and a fan: U follows by two quadratures."""
    torque, fan, flywheel = 1600.0, 2.0, 50.0
    scene = saw(FAN)
    run = ks.drive.steady(scene, ks.drive.Motor.constant(torque), flywheel, angles=[0.0])
    plain = saw()

    def inertia(angle):
        return flywheel + plain.solve(angle).reduced_inertia

    nodes, weights = np.polynomial.legendre.leggauss(12)
    edges = np.linspace(0.0, TURN, 41)
    half = np.diff(edges)[:, None] / 2
    at = edges[:-1, None] + half * (1.0 + nodes)
    rate = 2.0 * fan / inertia(at.ravel()).reshape(at.shape)
    whole = np.concatenate([[0.0], np.cumsum((half * weights * rate).sum(axis=1))])
    inner = at[..., None] * 0.0 + (edges[:-1, None, None] + (at - edges[:-1, None])[..., None] * (1.0 + nodes) / 2)
    inner_rate = 2.0 * fan / inertia(inner.ravel()).reshape(inner.shape)
    raised = whole[:-1, None] + ((at - edges[:-1, None])[..., None] / 2 * weights * inner_rate).sum(axis=-1)
    load = plain.solve(at.ravel()).load_torque.reshape(at.shape)
    gained = (half * weights * np.exp(raised) * (torque - load)).sum()
    energy = math.exp(-whole[-1]) * gained / -math.expm1(-whole[-1])
    assert run.speed[0] == pytest.approx(math.sqrt(2.0 * energy / inertia(0.0)), rel=1e-13)


def test_great_flywheel_runs_at_mean_torque_speed():
    run = ks.drive.steady(saw(CUT, FAN), MOTOR, 1e9)
    assert run.fluctuation < 1e-6
    even = ks.Scene(SAW, run.mean_speed, loads=(ks.Gravity(), CUT, FAN)).solve(40 * 36)
    assert MOTOR.torque_at_crank(run.mean_speed) == pytest.approx(even.balancing_torque.mean(), rel=1e-6)


def test_reversed_motor_runs_the_mirror_image():
    back = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=-4.6875)
    scene = ks.Scene(SAW, 1.0, loads=(ks.Torque(-300.0, on="crank"),))
    mirrored = ks.Scene(SAW, 1.0, loads=(ks.Torque(300.0, on="crank"),))
    one, other = ks.drive.steady(scene, MOTOR, 200.0), ks.drive.steady(mirrored, back, 200.0)
    assert other.mean_speed == pytest.approx(-one.mean_speed, rel=1e-13)
    assert other.speed[1:] == pytest.approx(-one.speed[:0:-1], rel=1e-12)
    assert other.energy_per_turn == pytest.approx(one.energy_per_turn, rel=1e-11)


def test_of_several_speeds_the_stable_one_is_found():
    """A constant load crosses Kloss's curve twice; below the breakdown torque running is not stable."""
    scene = ks.Scene(SAW, 1.0, loads=(ks.Torque(-2500.0, on="crank"),))
    run = ks.drive.steady(scene, MOTOR, 1e4)
    slow = 157.0 * (1.0 - MOTOR.breakdown_slip) / 4.6875
    assert run.speed_range[0] > slow
    assert MOTOR.torque_at_crank(slow / 3.0) < 2500.0 < MOTOR.torque_at_crank(slow)


def test_a_load_of_two_turns_runs_over_two_turns():
    angle = np.linspace(0.0, 2 * TURN, 81)[:-1]
    gas = ks.ProcessForce(ks.Table(angle, -3e4 * np.exp(-((angle - 6.0) ** 2)), period=2 * TURN), period=2 * TURN)
    run = ks.drive.steady(saw(gas), MOTOR, 300.0)
    assert run.turns == 2
    assert run.period == pytest.approx(2 * TURN)
    assert run.mean_speed == pytest.approx(2 * TURN / run.duration)
    assert abs(run.motion(np.array(0.1))[0] - run.motion(np.array(0.1 + TURN))[0]) > 1e-3
    assert run.solution.period == run.period


def test_two_turn_branch_runs_over_two_turns():
    deltoid = ks.four_bar(0.3, 0.8, 0.8, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(20.0, 0.5, 2.0))
    run = ks.drive.steady(ks.Scene(deltoid, 1.0, loads=(ks.Gravity(), ks.Torque(-300.0, on="crank"))), MOTOR, 20.0)
    assert run.turns == 2
    assert run.energy_per_turn == pytest.approx(300.0 * TURN, rel=1e-12)
    left = run.solution.balancing_torque + 20.0 * run.acceleration - MOTOR.transmission * run.motor_torque
    assert np.abs(left).max() < 1e-13 * np.abs(MOTOR.transmission * run.motor_torque).max()


def test_table_with_return_stroke_does_exact_work():
    cut = ks.Table([1.6, 1.9, 2.4], [3e3, 3e3, 5e3], over="travel", back=[0.0, 0.0, 0.0])
    run = ks.drive.steady(saw(ks.ProcessForce(cut)), MOTOR, 20.0)
    assert run.energy_per_turn == pytest.approx(-(0.2 * 3e3 + 0.4 * 3.8e3), rel=1e-12)


def test_an_undeclared_jump_is_resolved():
    jump = 1.2345
    pushed = ks.Torque(lambda motion: np.where(np.mod(motion.crank_angle, TURN) < jump, -800.0, 0.0), on="crank")
    run = ks.drive.steady(saw(pushed), MOTOR, 100.0)
    assert run.energy_per_turn == pytest.approx(800.0 * jump, rel=1e-11)


def test_constant_torque_keeps_the_scenes_mean_speed():
    run = ks.drive.steady(saw(CUT), None, 500.0)
    assert run.mean_speed == pytest.approx(33.0, rel=1e-13)
    assert np.ptp(run.motor_torque) == 0.0
    left = run.solution.balancing_torque + 500.0 * run.acceleration - run.motor_torque
    assert np.abs(left).max() < 1e-11 * run.solution.largest_torque_term


# Where there is none


def test_weak_motor_names_the_missing_torque():
    load = 5000.0
    with pytest.raises(ks.DriveError, match="the motor is too weak") as caught:
        ks.drive.steady(ks.Scene(SAW, 1.0, loads=(ks.Torque(-load, on="crank"),)), MOTOR, 1000.0)
    most = MOTOR.transmission * MOTOR.breakdown_torque
    assert caught.value.missing == pytest.approx(load - most, rel=1e-3)
    assert "N m at the crank" in str(caught.value)


@pytest.mark.slow
def test_weak_motor_without_flywheel_stalls():
    peak = ks.Torque(lambda motion: -8000.0 * (0.5 - 0.5 * np.cos(motion.crank_angle)), on="crank")
    small = ks.Scene(ks.crank_slider(0.3, 2.0, crank=ks.Link(0.0, 0.0, 3.0)), 1.0, loads=(peak,))
    motor = ks.drive.Motor.kloss(9e4, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
    assert ks.drive.steady(small, motor, 4e3)
    with pytest.raises(ks.DriveError, match="comes to a standstill at crank angle") as caught:
        ks.drive.steady(small, motor, 0.0)
    assert 1.5 < caught.value.crank_angle < math.pi


def test_rocking_crank_is_refused_with_its_gaps():
    rocking = ks.Scene(ks.four_bar(0.6, 0.8, 0.3, rocker_pivot=(0.7, 0.4), rocker=ks.Link(5.0)), 1.0)
    with pytest.raises(ks.AssemblyError) as caught:
        ks.drive.steady(rocking, MOTOR, 1.0)
    assert caught.value.intervals
    assert str(caught.value).endswith(". Change the lengths: a drive turns the crank all round")
