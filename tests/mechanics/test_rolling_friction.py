"""Arm of rolling friction of cam rollers: moments about the roller, losses, every engine, case files, drive."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from support import followers
from support.case_files import shipped
from support.every import every

SAW = shipped("sawframe_2r63_friction").variants["cam-cosine"].scene
ARM = "friction.cam.rolling_arm"
ROLLING = SAW.varied({ARM: 5e-4})
TURN = np.linspace(0.0, 2 * np.pi, 48, endpoint=False) + 0.03


def rolling_follower(speed=12.0, mu=0.1, arm=1e-3, kind="roller, offset"):
    scene = followers.scene(followers.KINDS[kind](), speed)
    contact = next(name for name in scene.mechanism.pairs if name.startswith("contact"))
    made = ks.RollerFriction(mu, 0.004, 0.012, arm)
    return ks.Scene(scene.mechanism, speed, scene.crank_acceleration, scene.loads, {contact: made}), contact


@pytest.mark.slow
@every("mu", [0.0, 0.003, 0.2])
@every("speed", [33.5, -33.5])
def test_moments_about_the_roller_are_in_balance(mu, speed):
    s = SAW.varied({ARM: 2e-3, "friction.cam.mu": mu, "crank_speed": speed}).solve(TURN)
    along, across = np.abs(s.friction_at("cam")), np.abs(s.cam_force)
    assert np.allclose(0.1 * along, 2e-3 * across + mu * 0.06 * np.hypot(across, along), rtol=1e-14)
    assert (np.sign(s.friction_at("cam")) == -np.sign(speed)).all()
    assert s.power_residual < 1e-14


def test_arm_of_zero_changes_no_bit():
    plain = SAW.solve(TURN)
    none = dict(SAW.friction) | {"cam": ks.RollerFriction(0.003, 0.06, 0.1, rolling_arm=0)}
    s = ks.Scene(SAW.mechanism, SAW.crank_speed, 0.0, SAW.loads, none).solve(TURN)
    for read in (lambda s: s.balancing_torque, lambda s: s.reaction("O"), lambda s: s.friction_at("cam")):
        assert np.array_equal(read(s), read(plain))


@pytest.mark.slow
@every("kind", ["roller, offset", "swinging, other side"])
@every("speed", [12.0, -12.0])
def test_rolling_alone_loses_its_moment_times_the_spin(kind, speed):
    """Without friction in the pin e N brakes the roller's spin against the cam, the way along it over its radius."""
    s = rolling_follower(speed, 0.0, 1e-3, kind)[0].solve(TURN)
    place, first, _ = s.placement.joints["R"]
    spin = np.hypot(first[0] + place[1], first[1] - place[0]) / 0.012
    lost = 1e-3 * np.abs(s.scalar("contact_force_1")) * spin * abs(speed)
    assert np.allclose(s.friction_loss, lost, rtol=1e-13)
    assert s.power_residual < 1e-13


def test_arm_changes_the_torque_of_the_saw():
    """By up to 3.1 % of its largest value with rollers of 50 mm radius, half of that with 100 mm."""
    for radius, change in ((0.05, 0.031), (0.1, 0.0155)):
        at = {"friction.cam.roller_radius": radius, "friction.cam.pin_radius": 0.04}
        plain, s = (SAW.varied(at | {ARM: arm}).solve(360).balancing_torque for arm in (0.0, 5e-4))
        assert np.abs(s - plain).max() / np.abs(plain).max() == pytest.approx(change, abs=2e-4)


# Every engine


@pytest.mark.parametrize(
    ("engine", "follower"), [("numpy", False), ("numpy", True), pytest.param("compiled", False, marks=pytest.mark.slow)]
)
def test_programs_and_derivatives(engine, follower):
    scene, contact = rolling_follower() if follower else (ROLLING, "cam")
    path = f"friction.{contact}.rolling_arm"
    program = ks.compile(scene, ("balancing_torque", "friction_loss", "O"), parameters=(path,), engine=engine)
    s = scene.solve(TURN)
    expected = {"balancing_torque": s.balancing_torque, "friction_loss": s.friction_loss, "O": s.reaction("O")}
    for name, value in program(TURN).items():
        assert np.allclose(value, expected[name], rtol=0, atol=1e-13 * np.abs(value).max())
    slope = program.derivatives(TURN, by=path)["balancing_torque"][path]
    step = 1e-6
    more, less = (scene.varied({path: program.parameters[path] + way * step}).solve(TURN) for way in (1, -1))
    plain = (more.balancing_torque - less.balancing_torque) / (2 * step)
    assert np.allclose(slope, plain, rtol=0, atol=1e-8 * np.abs(plain).max())


def test_zero_arm_is_a_parameter_where_it_is_asked():
    program = ks.compile(SAW, "friction_loss", parameters=(ARM,), engine="numpy")
    assert np.allclose(program(TURN, {ARM: 5e-4})["friction_loss"], ROLLING.solve(TURN).friction_loss, rtol=1e-13)


@pytest.mark.slow
def test_bounds_cover_the_rounding(flint):
    for scene in (ROLLING, rolling_follower()[0]):
        s = scene.solve(TURN[:5])
        bound = s.error_bound("balancing_torque")
        assert (bound > 0.0).all()
        assert (bound < 1e-10 * np.abs(s.balancing_torque).max()).all()


@pytest.mark.slow
def test_explanation_names_the_arm():
    assert "rolling_arm" in ROLLING.solve(1.0).explain("friction_loss", 1.0).text


# Sweeps, losses, drive, ground


@pytest.mark.slow
def test_sweep_of_arms():
    table = ks.sweep(SAW, pd.DataFrame({ARM: [0.0, 5e-4]}), "mean cam_friction_loss", angles=360, progress=False)
    lost = table["mean cam_friction_loss [W]"]
    assert lost[1] == pytest.approx(ROLLING.solve(8).losses.friction["cam"], rel=1e-4)
    assert lost[1] > 2.0 * lost[0]


@pytest.mark.slow
def test_steady_running_pays_for_the_rolling():
    motor = ks.drive.Motor.linear(2000.0, 34.0)
    without, rolls = (
        ks.drive.steady(scene, motor, flywheel=500.0) for scene in (rolling_follower(arm=0.0)[0], rolling_follower()[0])
    )
    assert rolls.mean_speed < without.mean_speed


# Case files


CASE = """
title = "Saw"
reference = "cam"
[variants.cam]
mechanism = "cam-crank-slider"
crank_speed = "320 rpm"
cam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }
slider = { mass = "600 kg" }
friction.cam = { mu = 0.003, pin_radius = "60 mm", roller_radius = "100 mm", rolling_arm = "ARM" }
"""


def test_case_file_has_the_arm(tmp_path):
    path = tmp_path / "saw.toml"
    path.write_text(CASE.replace("ARM", "0.5 mm"))
    assert ks.load_case(path).variants["cam"].scene.friction["cam"].rolling_arm == 5e-4


@every(
    "arm, words",
    [
        ("-1 mm", "must be at least 0 m"),
        ("nan mm", "rolling_arm"),
        ("1 kg", "rolling_arm"),
        ("0.1 m", "plus rolling_arm"),
    ],
)
def test_wrong_arms_in_case_files(tmp_path, arm, words):
    path = tmp_path / "saw.toml"
    path.write_text(CASE.replace("ARM", arm))
    with pytest.raises(ks.CaseError, match=words):
        ks.load_case(path)


def test_roller_larger_than_its_path_is_refused():
    scene, contact = rolling_follower()
    with pytest.raises(ks.ParameterError, match="less than the smallest radius of curvature of its path"):
        ks.Scene(scene.mechanism, 1.0, friction={contact: ks.RollerFriction(0.01, 0.01, 0.2)})
