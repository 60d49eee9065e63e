"""Power lost by joint and mechanical efficiency: closed forms, the balance of powers, jumps, what has none."""

import itertools
import pickle

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.losses import losses
from support.every import every
from support.friction_machines import JOINTS, KINDS, RUBBED, Drawn

R, MASS, MU, G, SPEED = 0.1, 3.0, 0.2, 9.81, 6.0
YOKE = ks.scotch_yoke(R, slider=ks.Link(MASS))
"""Its guide carries the weight of the slider alone, so that friction is MU * MASS * G throughout."""
RUBBING = {"guide": ks.GuideFriction(MU)}
LOST = MU * MASS * G * 4.0 * R
"""Lost in a turn, J."""


def resisting(force):
    """A force against the stroke back alone, which takes 2 R times it in a turn; negative: it drives."""
    return ks.ProcessForce(ks.Table([-1.1 * R, 1.1 * R], [0.0, 0.0], over="travel", back=[force, force]))


def yoke(*loads, speed=SPEED, friction=RUBBING):
    return ks.solve(YOKE, 0.0, crank_speed=speed, loads=(ks.Gravity(), *loads), friction=friction)


CAM = ks.cam_crank_slider(ks.cams.Circle(0.1, (-0.01, 0.0)), 0.4, coupler=ks.Link(2.0, 0.2), slider=ks.Link(4.0))
CAM_ALL = JOINTS | {"slot": ks.SlotFriction(0.1), "cam": ks.RollerFriction(0.01, 0.02, 0.04)}


def test_a_machine_without_friction_has_a_table_of_no_losses():
    table = ks.solve(YOKE, 0.0, crank_speed=SPEED, loads=ks.Gravity()).losses.frame()
    assert table.loc["all", ["mean [W]", "largest [W]", "per turn [J]"]].eq(0.0).all()


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
def test_guide_losses_are_closed_form(speed):
    found = yoke(speed=speed).losses
    assert found.friction["guide"] == pytest.approx(LOST * SPEED / (2.0 * np.pi), rel=1e-13)
    assert found.turn_time == pytest.approx(2.0 * np.pi / SPEED, rel=1e-14)
    assert found.drive == pytest.approx(found.total, rel=1e-12)
    peak, angle = found.peaks["guide"]
    assert peak == pytest.approx(MU * MASS * G * R * SPEED, rel=1e-14)
    assert np.cos(angle) == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(
    ("load", "efficiency"),
    [
        ((), 0.0),
        ((resisting(50.0),), 10.0 / (10.0 + LOST)),
        ((resisting(-50.0),), (10.0 - LOST) / 10.0),
        ((resisting(-5.0),), 0.0),
        ((resisting(50.0), ks.Spring(300.0, 0.02)), 10.0 / (10.0 + LOST)),
        ((resisting(50.0), ks.Force(40.0, at="B")), 10.0 / (10.0 + LOST)),
        ((resisting(-50.0), ks.Torque(-1.0, on="crank")), (10.0 - LOST) / 10.0),
        ((resisting(50.0), ks.Torque(1.0, on="crank")), 10.0 / (10.0 + LOST)),
        ((resisting(50.0), ks.TorsionDamper(0.5, on="crank")), 10.0 / (10.0 + LOST + np.pi * SPEED)),
    ],
    ids=["idle", "pump", "engine", "load-too-weak", "spring", "constant-force", "two-take", "two-give", "damper"],
)
def test_efficiency_is_taken_over_given(load, efficiency):
    s = yoke(*load)
    assert s.efficiency == pytest.approx(efficiency, rel=1e-12, abs=1e-15)
    found = s.losses
    assert found.given == pytest.approx(found.taken + found.total, rel=1e-12)


def test_without_friction_nothing_is_lost():
    assert yoke(resisting(50.0), friction=None).efficiency == 1.0
    idle = yoke(friction=None).losses
    assert np.isnan(idle.efficiency)
    assert str(idle) == "no power is taken or lost"
    assert idle.total == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("speed", [30.0, -30.0])
@pytest.mark.parametrize(("mechanism", "friction"), [(RUBBED, JOINTS), (CAM, CAM_ALL)], ids=["slider", "cam"])
def test_what_the_drive_gives_is_taken_or_lost(mechanism, friction, speed):
    loads = (ks.Gravity(), ks.ProcessForce(200.0), ks.Torque(-30.0, on="crank"), ks.Spring(3e3, 0.35))
    found = ks.solve(mechanism, 0.0, crank_speed=speed, loads=loads, friction=friction).losses
    assert found.drive == pytest.approx(sum(found.loads.values()) + found.total, rel=1e-12)
    assert found.loads["Torque on 'crank'"] == pytest.approx(30.0 * speed, rel=1e-12)
    assert found.loads["ProcessForce on 'slider'"] == 0.0
    assert set(found.friction) == set(friction)
    assert min(found.friction.values()) > 0.0


def test_means_are_parted_where_friction_jumps():
    s = ks.solve(RUBBED, 0.0, crank_speed=30.0, loads=ks.Gravity(), friction=JOINTS)
    ends = np.unique(np.concatenate([[0.0, 2 * np.pi], s.sampled.kinks]))
    edges = np.unique(np.concatenate([np.linspace(*pair, 9) for pair in itertools.pairwise(ends)]))
    nodes, weights = np.polynomial.legendre.leggauss(24)
    angle = edges[:-1, None] + np.diff(edges)[:, None] * (nodes + 1) / 2
    at = s.at(angle.ravel())
    for joint in JOINTS:
        power = at.friction_loss_at(joint).reshape(angle.shape)
        mean = np.sum(power @ weights * np.diff(edges)) / (4 * np.pi)
        assert s.losses.friction[joint] == pytest.approx(mean, rel=1e-12), joint


def test_loads_of_one_name_are_told_apart():
    torques = [ks.Torque(-moment, on="crank") for moment in (1.0, 2.0, 3.0)]
    found = yoke(*torques).losses.loads
    assert found == pytest.approx(
        {f"Torque on 'crank'{end}": (n + 1) * SPEED for n, end in enumerate(["", " #2", " #3"])}
    )


def test_a_four_stroke_force_counts_over_both_turns():
    table = ks.Table([0.0, np.pi, 3 * np.pi], [0.0, -40.0, 0.0], over="angle", period=4 * np.pi)
    one, two = yoke(ks.ProcessForce(table, period=4 * np.pi)), yoke(ks.ProcessForce(table, period=4 * np.pi)).losses
    angle = np.linspace(0.0, 4 * np.pi, 40_000, endpoint=False)
    at = one.at(angle)
    assert two.drive == pytest.approx(np.mean(at.balancing_torque) * SPEED, rel=1e-6)
    assert two.turn_time == pytest.approx(2 * np.pi / SPEED, rel=1e-14)


def test_under_a_motor_means_are_those_over_time():
    motor = ks.drive.Motor.linear(100.0, 100.0, transmission=4.0)
    scene = ks.Scene(
        RUBBED, 25.0, loads=(ks.Gravity(), ks.Torque(-20.0, on="crank"), ks.TorsionDamper(0.1, on="coupler"))
    )
    run = ks.drive.steady(scene, motor, flywheel=0.3)
    found = run.solution.losses
    assert run.fluctuation > 0.05
    assert found.drive == pytest.approx(run.mean_power, rel=1e-9)
    assert found.turn_time == pytest.approx(run.duration, rel=1e-9)
    assert found.drive == pytest.approx(found.taken + found.total, rel=1e-9)


@pytest.mark.slow
def test_the_table_has_a_row_for_each_joint_and_all():
    s = ks.solve(
        RUBBED, 0.0, crank_speed=30.0, loads=(ks.Gravity(), ks.TorsionDamper(0.1, on="coupler")), friction=JOINTS
    )
    table = s.losses.frame()
    assert list(table.index) == [*JOINTS, "TorsionDamper on 'coupler'", "all"]
    assert table["mean [W]"].iloc[:-1].sum() == pytest.approx(table.loc["all", "mean [W]"], rel=1e-14)
    assert table["share [%]"].iloc[:-1].sum() == pytest.approx(100.0)
    fine = s.at(np.linspace(0.0, 2 * np.pi, 1000))
    for joint in JOINTS:
        assert table.loc[joint, "largest [W]"] >= fine.friction_loss_at(joint).max() * (1 - 1e-12)
    assert (table["largest [W]"].iloc[-1] >= table["largest [W]"].iloc[:-1]).all()
    assert np.allclose(table["per turn [J]"], table["mean [W]"] * 2 * np.pi / 30.0)


@pytest.mark.slow
def test_comparison_shows_losses_by_joint():
    loads = (ks.Gravity(), ks.ProcessForce(200.0))
    one, other = (
        ks.solve(m, 0.0, crank_speed=30.0, loads=loads, friction=f) for m, f in ((RUBBED, JOINTS), (CAM, CAM_ALL))
    )
    found = ks.compare(one, other)
    assert found.lost_power_ratio == one.losses.total / other.losses.total
    table = found.frame()
    assert table.loc["mean power lost, O"].tolist()[1:3] == [one.losses.friction["O"], other.losses.friction["O"]]
    assert np.isnan(table.loc["mean power lost, cam", "reference"])
    assert table.loc["efficiency", "balanced"] == other.efficiency


@pytest.mark.slow
def test_comparison_without_friction_omits_losses():
    with_, without = (ks.solve(RUBBED, 0.0, crank_speed=30.0, loads=ks.Gravity(), friction=f) for f in (JOINTS, None))
    assert not any("lost" in row.label for row in ks.compare(without, without).rows)
    lost = [row for row in ks.compare(without, with_).rows if "lost" in row.label]
    assert lost[0][:2] == ("mean power lost, O", "W")
    assert ks.compare(without, with_).lost_powers[0] == 0.0


JAMMING = ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0))
GAP = ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0))


@pytest.mark.slow
@every("of", [losses, lambda s: s.efficiency, lambda s: s.losses], ids=["losses", "efficiency", "s.losses"])
@every(
    ("solution", "error", "words"),
    [
        (lambda: yoke(speed=0.0, friction=None), ks.ParameterError, "the crank stands still"),
        (lambda: yoke(speed=np.array([[1.0], [2.0]])), ks.ParameterError, "one design at a time"),
        (
            lambda: ks.solve(JAMMING, 0.3, crank_speed=3.0, friction={"guide": ks.GuideFriction(0.9)}),
            ks.JammingError,
            "losses: crank-slider: friction jams at",
        ),
        (lambda: ks.solve(GAP, 0.1, crank_speed=3.0), ks.ParameterError, "does not close for crank angles"),
        (
            lambda: ks.solve(YOKE, [0.0, 1.0], crank_speed=1.0, loads=ks.Torque(np.array([1.0, 2.0]), on="crank")),
            ks.ParameterError,
            "table over the given crank angles",
        ),
    ],
    ids=["standing", "batch", "jams", "gap", "table"],
)
def test_what_has_no_losses_over_the_turn_says_why(of, solution, error, words):
    with pytest.raises(error, match=words):
        of(solution())


class Brake:
    """A load of the user's own: a constant force against the motion, which jumps at the dead centres."""

    on = "slider"

    def push(self, motion):
        """Force on the slider, N."""
        return -5.0 * np.sign(motion.travel_velocity(self.on))


@pytest.mark.parametrize(
    ("load", "taken"),
    [
        (lambda: Brake(), 5.0 * 4.0 * R),
        (lambda: ks.ProcessForce(lambda motion: -5.0 * np.sign(motion.travel_velocity("slider"))), 5.0 * 4.0 * R),
        (lambda: ks.ProcessForce(lambda motion: -30.0 * motion.travel_velocity("slider")), 30.0 * np.pi * SPEED * R**2),
        (lambda: ks.Torque(lambda motion: -2.0 - np.cos(motion.crank_angle), on="crank"), 4.0 * np.pi),
    ],
    ids=["own class", "function that jumps", "smooth function", "couple"],
)
def test_own_loads_are_counted(load, taken):
    assert yoke(load()).efficiency == pytest.approx(taken / (taken + LOST), rel=1e-9)


def test_losses_go_through_pickle_with_their_solution():
    s = yoke(resisting(50.0))
    found = pickle.loads(pickle.dumps(s.losses))
    assert found.efficiency == s.efficiency
    assert found.peaks == s.losses.peaks


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind not in ("slider", "cam", "coupler point")])
def test_powers_balance_over_the_period(kind):
    scene = Drawn(kind, 5).scene
    found = ks.Scene(scene.mechanism, scene.crank_speed, loads=scene.loads, friction=scene.friction).solve(0.3).losses
    assert found.total > 0.0
    assert found.drive == pytest.approx(sum(found.loads.values()) + found.total, rel=1e-12)


@pytest.mark.parametrize("weight", [0.0, 1e-9, 1e-3, 9.81])
def test_mean_is_right_near_a_vanishing_reaction(weight):
    """Of a slider without load its pin's does twice a turn: friction there has a corner, rounded by a light weight."""
    friction = {"B": ks.PinFriction(0.1, 0.02), "guide": ks.GuideFriction(0.1)}
    pump = ks.crank_slider(R, 4 * R, slider=ks.Link(MASS))
    s = ks.solve(pump, 0.0, crank_speed=20.0, loads=ks.Gravity(weight), friction=friction)
    found, power = s.losses, s.losses.powers["B"]
    even = np.linspace(0.0, 2 * np.pi, 7200, endpoint=False)
    force = np.hypot(*s.at(even).reaction("B"))
    dips = np.flatnonzero((force < np.roll(force, 1)) & (force <= np.roll(force, -1)))
    dips = even[dips[np.argsort(force[dips])[:2]]]
    low, high = dips - 2e-3, dips + 2e-3
    for _ in range(80):  # the dips themselves, by thirds
        inner = low + (high - low) / 3.0, high - (high - low) / 3.0
        falling = np.subtract(*(np.hypot(*s.at(place).reaction("B")) for place in inner)) > 0.0
        low, high = np.where(falling, inner[0], low), np.where(falling, high, inner[1])
    steps = np.concatenate([-(0.5 ** np.arange(3.0, 46.0)), [0.0], 0.5 ** np.arange(3.0, 46.0)])
    edges = [np.linspace(0.0, 2 * np.pi, 200), s.sampled.kinks, np.ravel(low[:, None] + steps)]
    edges = np.unique(np.concatenate(edges))
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(edges)[:, None]
    values = power(s.at((edges[:-1, None] + half * (1.0 + nodes)).ravel())).reshape(half.size, -1)
    mean = (half * weights * values).sum() / (2 * np.pi)
    assert found.friction["B"] == pytest.approx(mean, rel=1e-12)
