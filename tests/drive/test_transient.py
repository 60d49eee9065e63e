"""Starting and coasting: published benchmarks of forward dynamics, energy, and machines that do not start."""

import math

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import shipped
from support.drives import DISC as WHEEL
from support.drives import DISC_MOTOR, MOTOR, PUMP, SAW
from support.every import every

PENDULUM = ks.Scene(ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15, 0.02)), 1.0, loads=ks.Gravity())


@pytest.mark.slow
def test_sundials_slider_crank_swings_as_published():
    """Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*, example 6.1.8, as run by SUNDIALS' IDA.

    Crank 0.5, rod 1, J1 = 1, m2 = 1 at the slider, J2 = 2; spring (1, free at 1) and damper (1) between the middles of
    crank and rod, force 1 on a point of the rod's line one length beyond the slider. Values with 20 digits.
    """
    mechanism = ks.crank_slider(
        0.5, 1.0, crank=ks.Link(0.0, 0.0, 1.0), coupler=ks.Link(0.0, 0.0, 2.0), slider=ks.Link(1.0)
    )
    middles = (("crank", 0.25), ("coupler", 0.5))
    loads = (
        ks.PointSpring(1.0, 1.0, between=middles),
        ks.PointDamper(1.0, between=middles),
        ks.Force(1.0, at=("coupler", 2.0)),
    )
    motion = ks.drive.coast(ks.Scene(mechanism, 1.0, loads=loads), 0.0, math.pi / 2, 0.0, 10.0)
    assert motion.crank_angle[-1] == pytest.approx(1.2756758486502394107, rel=0, abs=1e-11)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    half = np.diff(motion.time)[:, None] / 2
    time = motion.time[:-1, None] + half * (1.0 + nodes)
    energy = motion.at(time.ravel()).kinetic_energy.reshape(time.shape)
    assert (half * weights * energy).sum() == pytest.approx(3.3366067994827844, rel=0, abs=1e-11)


def n_four_bar(windows):
    """Bars of 1 kg and 1 m: uprights that turn about fixed pivots 1 m apart, and between their ends level ones."""
    bar = ks.Link(1.0, 0.5, 1 / 12)
    groups = tuple(
        ks.RockerGroup(
            1.0,
            1.0,
            (float(k), 0.0),
            "open",
            bar,
            bar,
            on=f"B{k - 1}" if k > 1 else "A",
            pin=f"B{k}",
            pivot_name=f"P{k}",
            label=f"_{k}",
        )
        for k in range(1, windows + 1)
    )
    return ks.Scene(ks.Mechanism("N-four-bar", ks.Crank(1.0, bar), groups), 1.0, loads=ks.Gravity())


@pytest.mark.slow
@pytest.mark.parametrize("windows", [2, 40])
def test_iftomm_four_bar_passes_singular_positions(windows):
    """IFToMM library of benchmark problems, A02: B0 starts on top with 1 m/s; compared after 10 s."""
    motion = ks.drive.coast(n_four_bar(windows), 0.0, math.pi / 2, -1.0, 10.0)
    found = motion.crank_angle[-1]
    if windows == 2:
        exact = 0.32845811154081537865, 0.94451853817860096216
        assert (np.cos(found), np.sin(found)) == pytest.approx(exact, rel=0, abs=1e-9)
    assert found == pytest.approx(float(_pendulum(windows)), rel=0, abs=1e-9)
    assert motion.energy_drift < 1e-9
    assert len({math.floor(angle / math.pi) for angle in motion.crank_angle}) == 11


def _pendulum(windows):
    """Crank angle after 10 s by elliptic functions: parallel bars are one pendulum that goes round."""
    with mp.workdps(30):
        n = windows
        inertia = mp.mpf(n + 1) / 3 + n
        rate2 = mp.mpf(9.81) * (mp.mpf(n + 1) / 2 + n) / inertia
        # from the top with speed 1: theta'^2 = 1 + 2 rate2 (1 - cos theta), theta from the top
        swing = 1 + 4 * rate2
        m = 4 * rate2 / swing
        # sigma = (theta - pi) / 2: sigma' = sqrt(swing) / 2 sqrt(1 - m sin^2 sigma)
        start = -mp.ellipk(m)
        u = start + mp.sqrt(swing) / 2 * 10
        periods = mp.floor((u + mp.ellipk(m)) / (2 * mp.ellipk(m)))
        rest = u - 2 * periods * mp.ellipk(m)
        sigma = mp.asin(mp.ellipfun("sn", rest, m=m)) + periods * mp.pi
        return mp.pi / 2 - (2 * sigma + mp.pi)


@pytest.mark.slow
def test_without_loss_energy_is_kept():
    scene = ks.Scene(
        SAW, 1.0, loads=(ks.Gravity(), ks.Spring(2e4, 2.0), ks.PointSpring(300.0, 0.1, between=("A", (0.1, 0.9))))
    )
    motion = ks.drive.coast(scene, 3.0, 0.3, 12.0, 3.0)
    whole = motion.kinetic_energy + motion.solution.potential_energy
    assert np.ptp(whole) < 1e-11 * motion.kinetic_energy.max()
    assert motion.energy_drift < 1e-11 * motion.kinetic_energy.max()


def test_a_damper_takes_what_energy_is_lost():
    scene = ks.Scene(SAW, 1.0, loads=ks.PointDamper(800.0, between=("B", (0.0, 0.3))))
    motion = ks.drive.coast(scene, 3.0, 0.3, 12.0, 1.0)
    assert motion.kinetic_energy[-1] < 0.9 * motion.kinetic_energy[0]
    assert motion.energy_drift < 1e-11 * motion.kinetic_energy[0]


def test_pendulum_reverses_at_its_release_height():
    """Period by the complete elliptic integral."""
    motion = ks.drive.coast(PENDULUM, 0.055, from_angle=-1.0, until=5.0)
    reversals = [event for event in motion.events if event.name == "reversal"]
    amplitude = math.pi / 2 - 1.0
    length = (0.055 + 0.02 + 2.0 * 0.15**2) / (2.0 * 0.15)
    with mp.workdps(20):
        period = float(4 * mp.sqrt(length / 9.81) * mp.ellipk(mp.sin(amplitude / 2) ** 2))
    assert [event.time for event in reversals] == pytest.approx(
        np.arange(1, len(reversals) + 1) * period / 2, rel=1e-11
    )
    assert reversals[0].crank_angle == pytest.approx(-math.pi + 1.0, abs=1e-11)


def test_coasting_until_standstill_ends_there():
    motion = ks.drive.coast(PENDULUM, 0.0, from_angle=-math.pi / 2, from_speed=5.0, until="standstill")
    assert motion.events[-1].name == "standstill"
    assert abs(motion.speed[-1]) < 1e-12
    assert motion.at(7).time.size == 7
    ax = motion.plot()
    assert ax.get_ylabel() == "crank speed [rad/s]"
    assert [line.get_xdata().size for line in ax.get_lines()] == [400, 1]
    assert len(motion.frame()) == motion.time.size


def test_start_ends_in_running_with_the_motors_work():
    scene = ks.Scene(SAW, 1.0, loads=ks.Gravity())
    motion = ks.drive.start(scene, MOTOR, 100.0, from_angle=0.4)
    steady = ks.drive.steady(scene, MOTOR, 100.0)
    assert motion.speed[-1] == pytest.approx(0.99 * steady.mean_speed, rel=1e-12)
    assert motion.events[0].name == "start"
    assert motion.events[-1].name == "end"
    assert motion.energy_drift < 1e-10 * motion.kinetic_energy[-1]
    left = motion.solution.balancing_torque + 100.0 * motion.acceleration - 4.6875 * motion.motor_torque
    assert np.abs(left).max() < 1e-10 * np.abs(motion.solution.balancing_torque).max()


def test_periodic_running_is_kept_over_time():
    scene = ks.Scene(SAW, 1.0, loads=(ks.Gravity(), ks.Torque(-500.0, on="crank")))
    steady = ks.drive.steady(scene, MOTOR, 30.0, angles=[0.0])
    motion = ks.drive.coast(scene, 30.0, 0.0, steady.speed[0], 2.0 * steady.duration, MOTOR)
    speed, acceleration = steady.motion(motion.crank_angle)
    assert motion.crank_angle[-1] == pytest.approx(4.0 * math.pi, rel=1e-12)
    assert motion.speed == pytest.approx(speed, rel=1e-11)
    assert motion.acceleration == pytest.approx(acceleration, abs=1e-10 * np.abs(acceleration).max())


BALANCED = shipped("sawframe_2r63").variants["cam-cosine"].scene


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "words"), [(2.3, "it does not start"), (math.pi / 2, "it starts and stops after")])
def test_balanced_saw_does_not_start_against_springs(angle, words):
    with pytest.raises(ks.DriveError, match=words) as caught:
        ks.drive.start(BALANCED, MOTOR, 1000.0, from_angle=angle)
    assert "What helps: a motor with" in str(caught.value)
    assert caught.value.missing > 0.0
    easy = math.radians(float(str(caught.value).partition("another crank angle, ")[2].partition(" deg")[0]))
    assert ks.drive.start(BALANCED, MOTOR, 1000.0, from_angle=easy).events[-1].name == "end"
    rest = MOTOR.torque_at_crank(0.0)
    held = ks.Scene(BALANCED.mechanism, 1e-9, loads=BALANCED.loads).solve(caught.value.crank_angle)
    if angle == 2.3:
        assert caught.value.missing == pytest.approx(held.load_torque - rest, rel=1e-12)


@every(
    ("call", "words"),
    [
        (lambda: ks.drive.coast(PENDULUM, until=None), "give until, a time in s"),
        (lambda: ks.drive.coast(PENDULUM, until=-1.0), "until must be a time"),
        (lambda: ks.drive.coast(PENDULUM, until="stand"), "until must be a time"),
        (lambda: ks.drive.coast(PENDULUM, until="standstill"), "needs a from_speed"),
        (lambda: ks.drive.coast(PENDULUM, -1.0, math.nan, "fast", 1.0), "from_angle .*from_speed .*flywheel"),
        (lambda: ks.drive.coast(PENDULUM, until=1.0, motor=3.0), "motor must be a Motor"),
        (lambda: ks.drive.start(PENDULUM, None, 1.0), "motor must be a Motor"),
        (lambda: ks.drive.start(PENDULUM, MOTOR, 1.0, until=0.0), "until must be greater than 0"),
        (lambda: ks.drive.coast(PENDULUM, 1.0, until=1.0).at([2.0]), "time must lie between 0 and 1"),
    ],
)
def test_what_cannot_be_followed_is_refused(call, words):
    with pytest.raises(ks.ParameterError, match=words):
        call()


def test_a_motion_into_a_gap_ends_with_the_gap():
    rocking = ks.Scene(ks.four_bar(0.6, 0.8, 0.3, rocker_pivot=(0.7, 0.4), crank=ks.Link(1.0, 0.3)), 1.0)
    angle = next(a for a in np.linspace(0.0, 6.0, 25) if np.all(rocking.solve(a, on_gap="nan").dynamics.closed))
    with pytest.raises((ks.AssemblyError, ks.DriveError)):
        ks.drive.coast(rocking, 0.0, float(angle), 5.0, 10.0)


# Motion over time


DISC = ks.Scene(
    ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=3.0)), ()), 1.0, loads=(ks.Torque(-6.0, on="crank"),)
)


@pytest.fixture(scope="module")
def coasting():
    return ks.drive.coast(DISC, 1.0, from_speed=3.0, until="standstill")


def test_coasting_ends_at_rest_with_energy_spent(coasting):
    last = coasting.events[-1]
    assert (last.name, last.time, last.crank_angle) == ("standstill", pytest.approx(2.0), pytest.approx(3.0))
    assert coasting.kinetic_energy == pytest.approx(2.0 * coasting.speed**2, rel=1e-12)
    assert coasting.energy_drift < 1e-9 * 18.0
    assert "standstill" in repr(coasting)


def test_the_table_has_a_row_for_each_time(coasting):
    table = coasting.at(5).frame()
    assert table["time [s]"].tolist() == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])
    assert table["load_torque [N m]"].tolist() == pytest.approx([6.0] * 5)


# Whether a machine that coasts comes to a standstill at all


RUBS = {"O": ks.PinFriction(0.1, 0.03), "guide": ks.GuideFriction(0.1)}


@pytest.mark.parametrize(
    ("scene", "speed", "motor", "words"),
    [
        (ks.Scene(PUMP, 1.0), 3.0, None, "return all of it"),
        (ks.Scene(PUMP, 1.0, loads=ks.Torque(2.0, on="crank"), friction=RUBS), 9.0, None, "times the kinetic energy"),
        (ks.Scene(PUMP, 1.0), -30.0, ks.drive.Motor.linear(100.0, 50.0, transmission=-2.0), "its motor keeps it"),
        (ks.Scene(PUMP, 1.0, friction=RUBS), 60.0, DISC_MOTOR, "its motor keeps it running"),
        (ks.Scene(PUMP, 1.0, friction=RUBS), 4.0, DISC_MOTOR, "times the kinetic energy"),
    ],
)
def test_a_machine_that_runs_on_never_stands_still(scene, speed, motor, words):
    with pytest.raises(ks.errors.DriveError, match=f"never comes to a standstill: .*{words}"):
        ks.drive.coast(scene, 5.0, from_speed=speed, until="standstill", motor=motor)


def test_a_motor_against_the_motion_stops_it():
    motion = ks.drive.coast(ks.Scene(WHEEL, 1.0), from_speed=-1.0, until="standstill", motor=DISC_MOTOR)
    assert motion.events[-1].name == "standstill"


@pytest.mark.slow
def test_loads_that_cancel_but_for_rounding_are_no_torque():
    """Two saws whose weights balance each other about the crank: 2e-13 N m of 2 kN m are left."""
    twin = ks.load_case("sawframe_2r63_ways").variants["twin"]
    run = ks.drive.start(twin.scene, twin.motor, twin.flywheel)
    assert abs(run.energy_drift) < 1e-11 * 0.5 * twin.flywheel * run.speed[-1] ** 2
