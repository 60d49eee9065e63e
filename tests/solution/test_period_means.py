"""Exact means over the period: mean torque and power of the drive, energy per turn."""

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

TURN = 2 * np.pi
RAMP = 1e-12
"""Width of a jump in a table over the travel, m."""


class Step:
    """Torque against the crank, N m: 10 up to a crank angle, then 90; it declares the jump."""

    def __init__(self, angle):
        self.angle = angle

    def __call__(self, motion):
        """Torque, N m."""
        return np.where(np.mod(motion.crank_angle, TURN) < self.angle, -10.0, -90.0)

    def kinks(self, motion):
        """No kinks, two jumps."""
        return np.empty(0), np.array([0.0, self.angle])


def press(speed=33.5, **change):
    """A press whose force jumps from 100 N to 900 N halfway down its stroke of 0.6 m, nothing on the way back."""
    table = ks.Table([1.6, 2.0, 2.0 + RAMP, 2.4], [-100.0, -100.0, -900.0, -900.0], over="travel", back=[0.0] * 4)
    machine = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    return ks.Scene(machine, speed, loads=[ks.Gravity(), ks.ProcessForce(table)], **change)


def braked(value, speed=5.0):
    return ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(2.0)), speed, loads=[ks.Torque(value, on="crank")])


PRESS_WORK = 100.0 * 0.3 + 900.0 * 0.3 - 400.0 * RAMP
TWO_TURNS = ks.Table([0.0, TURN, 1.5 * TURN], [-5.0, -5.0, -25.0], over="angle", period=2 * TURN)


@pytest.mark.slow
@every(
    "scene, work",
    [
        (press(), PRESS_WORK),
        (press(-33.5), PRESS_WORK),
        (press(0.0, sense=1.0), PRESS_WORK),
        (press(friction={"O": ks.PinFriction(0.0, 0.1)}), PRESS_WORK),
        (braked(Step(1.2345)), 10.0 * 1.2345 + 90.0 * (TURN - 1.2345)),
        (braked(TWO_TURNS), 10.0 * TURN),
        (braked(4.0), -4.0 * TURN),
        (braked(4.0, -5.0), 4.0 * TURN),
        (ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, loads=[ks.Gravity()]), 0.0),
    ],
)
def test_mean_torque_times_the_angle_is_the_work(scene, work):
    """Exact means by hand, whatever the number of crank angles that are solved."""
    s, speed = scene.solve(3), scene.crank_speed
    assert s.energy_per_turn == pytest.approx(work, rel=1e-12, abs=1e-300)
    assert s.mean_torque * TURN * s.crank_sense == pytest.approx(work, rel=1e-12, abs=1e-300)
    assert s.mean_power == pytest.approx(abs(speed) * work / TURN, rel=1e-12, abs=1e-300)
    if speed:
        assert s.mean_power == pytest.approx(s.losses.drive, rel=1e-12)


def test_the_mean_of_samples_is_another():
    s = press().solve(360)
    assert abs(s.balancing_torque.mean() / s.mean_torque - 1.0) > 2e-3


def test_each_design_has_its_means():
    """A design that does not close has none; the others have those that they have alone."""
    lengths, speeds = np.array([[0.3], [2.5], [0.2]]), np.array([[[10.0]], [[-20.0]]])
    work = ks.ProcessForce(ks.Table([-5.0, 5.0], [-100.0, -100.0], over="travel", back=[0.0, 0.0]))
    s = ks.solve(ks.crank_slider(lengths, 2.0), 0.5, crank_speed=speeds, loads=work, on_gap="nan")
    energy = np.array([60.0, np.nan, 40.0])
    for found, expected in (
        (s.energy_per_turn, energy * np.ones((2, 1))),
        (s.mean_torque, energy / TURN * [[1.0], [-1.0]]),
        (s.mean_power, energy / TURN * [[10.0], [20.0]]),
    ):
        assert found.shape == (2, 3)
        np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_a_design_that_jams_has_no_mean():
    friction = {"guide": ks.GuideFriction(np.array([[0.1], [0.9]]))}
    crank = ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0))
    s = ks.solve(crank, 0.3, crank_speed=3.0, friction=friction, on_gap="nan")
    assert np.isnan(s.mean_torque).tolist() == [False, True]


@pytest.mark.parametrize("name", ["mean_torque", "mean_power", "energy_per_turn"])
def test_a_gap_leaves_no_mean(name):
    s = ks.solve(ks.crank_slider(0.3, 0.2), 0.0, crank_speed=1.0, on_gap="nan")
    with pytest.raises(ks.ParameterError, match="mean torque: crank-slider does not close for crank angles"):
        getattr(s, name)


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_an_uneven_load_is_warned_of_where_the_mean_is_read():
    s = braked(lambda q: -10.0 + np.sin(1e5 * np.sin(q.crank_angle) ** 2)).solve(3)
    with pytest.warns(ks.ConditionWarning, match="accurate only to .* N m of") as caught:
        assert s.mean_torque == pytest.approx(10.0, rel=0.05)
    assert __file__ in [warning.filename for warning in caught]


def test_running_has_the_means_of_its_drive():
    """At a speed that varies, the mean power is that over time."""
    load = ks.Table([0.0, 2.0, 4.0, TURN], [5.0, 5.0, 105.0, 5.0], over="angle")
    run = ks.drive.steady(braked(load, -5.0), None, flywheel=3.0)
    s, mean = run.solution, -(5.0 + 0.5 * 100.0 * (TURN - 2.0) / TURN)
    assert run.fluctuation > 0.01
    assert (s.mean_torque, run.mean_torque) == pytest.approx((mean, mean), rel=1e-10)
    assert (s.energy_per_turn, run.energy_per_turn) == pytest.approx((-mean * TURN, -mean * TURN), rel=1e-10)
    assert s.mean_power == pytest.approx(run.mean_power, rel=1e-10)
    assert s.mean_power == pytest.approx(s.losses.drive, rel=1e-10)


@pytest.mark.slow
def test_comparison_has_mean_torque_and_power_of_machines_that_take_work():
    found = ks.compare(*(braked(-4.0, speed).solve(9) for speed in (5.0, 10.0)))
    row = found.frame().loc["mean drive power"]
    assert found.mean_powers == (row["reference"], row["balanced"])
    assert row["ratio"] == pytest.approx(0.5, rel=1e-12)
    assert found.frame().loc["mean balancing torque", "balanced"] == found.balanced.mean_torque
    assert "mean drive power" not in ks.compare(*[braked(0.0).solve(9)] * 2).frame().index
