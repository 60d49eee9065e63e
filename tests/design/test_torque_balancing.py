"""Torque-balancing cams: what is left of the unevenness, contact all the way, prices, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design import spring_follower
from kinetostatics.errors import ParameterError
from kinetostatics.numbers.panels import Panels
from support.every import every, quick

VARIANTS = ("rho-0.1", "rho-0.5", "free-start")
LOADS = {
    "absent": (),
    "constant": (ks.Torque(20.0, on="rocker"),),
    "switching": (ks.Torque(lambda m: -20.0 * np.sign(m.rate("rocker")), on="rocker"),),
}


def drive(variant="rho-0.1", load="absent", **changes):
    scene = ks.load_case("chain_unit").variants[variant].scene
    given = {"loads": (*scene.loads, *LOADS[load]), **changes}
    return ks.Scene(scene.mechanism, given.pop("crank_speed", scene.crank_speed), **given)


def balanced(scene, mass=0.3, travel=0.012, **others):
    return ks.design.torque_balancing_cam(scene, mass=mass, travel=travel, **others)


@pytest.mark.slow
@pytest.mark.parametrize(("variant", "load"), quick(zip(VARIANTS, LOADS, strict=True), 2))
def test_only_the_mean_torque_remains_with_contact(variant, load):
    scene = drive(variant, load)
    found = balanced(scene, guide_angle=0.4, guide_offset=0.003)
    at = np.linspace(0.01, 6.29, 2000)
    before, after = (machine.solve(at).balancing_torque for machine in (scene, found.scene))
    assert np.mean(np.abs(after - found.mean_torque)) < 1e-10 * np.mean(np.abs(before - found.mean_torque))
    assert found.lifts_off == ()
    assert np.min(found.scene.solve(at).scalar("contact_force_cam")) > 0.9 * found.least_contact_force.value > 0
    assert found.scene.solve(at).rate("rocker") == pytest.approx(scene.solve(at).rate("rocker"), rel=1e-14)


@pytest.mark.slow
def test_the_torque_by_power_agrees():
    s = balanced(drive("rho-0.5", "switching")).scene.solve(97)
    assert_allclose(
        s.balancing_torque, s.balancing_torque_by_power, rtol=0, atol=1e-12 * s.dynamics.largest_torque_term
    )


@pytest.mark.slow
def test_a_load_that_jumps_is_balanced_too():
    def press(motion):
        return np.where(np.cos(motion.crank_angle) > 0, -500.0, 0.0)

    links = {"slider": ks.Link(2.0), "crank": ks.Link(1.0, (0.02, 0.0))}
    scene = ks.Scene(ks.crank_slider(0.05, 0.2, guide_offset=0.01, **links), 40.0, loads=ks.ProcessForce(press))
    found = balanced(scene, 0.2, 0.01)
    assert found.remaining < 1e-9
    assert np.min(np.abs(np.array(found.follower.cam.law.knots) - np.pi / 2)) < 1e-12


@pytest.mark.slow
def test_follower_keeps_travel_and_pressure_angle():
    found = balanced(drive(), pressure_angle=np.radians(25.0), guide_offset=0.002)
    position = found.scene.solve(7200).travel("follower_cam")
    assert_allclose(np.ptp(position), 0.012, rtol=1e-6)
    assert_allclose(found.pressure_angle.value, np.radians(25.0), rtol=1e-5)
    assert_allclose(found.stretch, (0.012, 0.024), rtol=1e-12)
    assert_allclose(found.travel, 0.012, rtol=1e-12)
    assert_allclose(found.spring.stiffness * (0.024**2 - 0.012**2) / 2, found.energy, rtol=1e-10)
    assert_allclose(found.preload, found.spring.stiffness * 0.012, rtol=1e-12)


@pytest.mark.slow
def test_the_weight_of_the_follower_is_counted_in():
    up, level = (balanced(drive(), guide_angle=angle) for angle in (np.pi / 2, 0.0))
    assert_allclose(up.spring.free_position - level.spring.free_position, 0.3 * 9.81 / up.spring.stiffness, rtol=1e-9)


@pytest.mark.slow
def test_another_speed_unbalances_it():
    found = balanced(drive())
    faster = ks.Scene(found.scene.mechanism, 1.1 * found.scene.crank_speed, loads=found.scene.loads)
    torque = faster.solve(360).balancing_torque
    assert np.ptp(torque) > 1e-3 * found.uneven[0]


@pytest.mark.slow
@pytest.mark.parametrize("given", quick([{"mass": 0.1, "stiffness": 12400.0}, {"mass": 1.7}], 1))
def test_contact_is_kept_down_to_the_bound(given):
    """The stiff spring needs hardly any preload."""
    found = balanced(drive(), **given)
    assert found.reserve > 1.0
    assert found.remaining < 1e-9
    assert found.least_contact_force.value > 0
    assert found.preload < 0.25 or "stiffness" not in given


WRONG = {
    "too heavy": ({"mass": 2.0}, r"lift off at 348\.\d+ deg.* 0\.926\d* times .* lighter than 1\.71"),
    "too stiff": ({"stiffness": 13000.0}, r"without preload. Choose less than 12437\.\d N/m"),
    "small base": ({"base_radius": 1e-3}, r"exceeds 30 deg; choose at least 0\.01"),
    "no mass": ({"mass": 0.0}, "mass"),
    "text": ({"travel": "12 mm"}, "travel"),
    "undercut": ({"roller_radius": 0.03}, "roller"),
}


@pytest.mark.parametrize("name", WRONG)
def test_impossible_demands_are_refused_with_numbers(name):
    given, text = WRONG[name]
    with pytest.raises(ks.ParameterError, match=text):
        balanced(drive(), **given)


def test_scenes_that_no_cam_can_balance_are_refused():
    scene = drive()
    still = ks.Scene(ks.crank_slider(0.1, 0.3), 10.0)
    jump = ks.Torque(lambda m: np.where(np.sin(m.crank_angle) > 0, 5.0, -5.0), on="crank")
    cases = {
        "already even": still,
        "jumps across its mean": ks.Scene(still.mechanism, 10.0, loads=jump),
        "one constant speed": ks.Scene(scene.mechanism, 10.0, 1.0),
        "the crank stands": ks.Scene(scene.mechanism, 0.0),
        "takes a Scene": scene.mechanism,
        "friction at O": ks.Scene(scene.mechanism, 10.0, friction={"O": ks.PinFriction(0.1, 0.01)}),
    }
    table = ks.Table([0.0, 3.0, 6.0, 9.0], [0.0, 9.0, 3.0, 1.0], period=4 * np.pi)
    cases["repeat after 2"] = ks.Scene(scene.mechanism, 10.0, loads=ks.Torque(table, on="rocker"))
    for text, item in cases.items():
        with pytest.raises(ks.ParameterError, match=text):
            balanced(item)


# The stretch of a spring that holds a given energy


TURN = 2 * np.pi
ANGLES = np.linspace(0.0, TURN, 1001)


def energy(slope):
    panels = Panels.of(slope, TURN)
    return panels.plus(-panels.mean).integral


def residual(slope, level, mass, stiffness):
    """Mu x'^2 / 2 + k x^2 / 2 + E - C, and the force mu x'' + k x."""
    e = energy(slope)
    x, first, second = spring_follower.spring_stretch(e, level, mass, stiffness).at(ANGLES, 2)
    return mass * first**2 / 2 + stiffness * x**2 / 2 + e(ANGLES) - level, mass * second + stiffness * x


@pytest.mark.slow
@every("mass", [1e-6, 0.1, 1.0])
@every("slope", [np.sin, lambda x: np.sin(x) + 0.8 * np.cos(2 * x), lambda x: np.abs(np.sin(x - 1))])
def test_energy_is_held_and_the_cam_presses(slope, mass):
    missing, force = residual(slope, 8.0, mass, 2.0)
    assert np.max(np.abs(missing)) < 3.0 * spring_follower.SERIES_TOLERANCE * 8.0
    assert np.min(force) > 0.0


def test_massless_stretch_is_the_root_of_energy():
    e = energy(np.sin)
    x = spring_follower.spring_stretch(e, 8.0, 1e-13, 2.0)
    assert_allclose(x(ANGLES), np.sqrt(8.0 - e(ANGLES)), rtol=1e-11)


def test_follower_runs_smoothly_through_a_torque_jump():
    def slope(x):
        return np.sin(x) + 0.3 * (np.sin(x) > 0) * (np.mod(x, TURN) > 2.0)

    kinked = energy(slope)
    x = spring_follower.spring_stretch(kinked, 8.0, 0.1, 2.0)
    before, after = (np.array(x.at(2.0 + side, 1)) for side in (-1e-9, 1e-9))
    assert_allclose(before, after, atol=1e-7)


def test_reserve_is_the_published_formula():
    e = energy(np.sin)  # 0 - cos + 1, least at 0 with E'' = 1
    assert_allclose(spring_follower.reserve(e, 0.0, 8.0, 4.0, 2.0), np.sqrt(2 * 2.0 * 8.0) / (2 * 2.0), rtol=1e-9)


def test_contact_is_lost_where_the_spring_is_weak():
    e = energy(np.sin)
    bound = 2.0 * np.sqrt(2.0)  # (k x)^2 = 4 mu E'' at x^2 = C
    spring_follower.spring_stretch(e, 8.0, 0.98 * bound**2, 2.0)
    with pytest.raises(ParameterError, match="lift off near crank angle"):
        spring_follower.spring_stretch(e, 8.0, 1.1 * bound**2, 2.0)


# What a torque-balancing cam reports


@pytest.fixture(scope="module")
def found():
    return balanced(drive(), guide_offset=0.002, roller_radius=0.005)


@pytest.mark.slow
def test_contact_and_angle_are_extremes_of_the_scene(found):
    s = found.scene.solve(np.linspace(0.001, 6.281, 5000))
    force, angle = s.scalar("contact_force_cam"), np.abs(s.measure("pressure_angle_cam"))
    assert found.least_contact_force.value == pytest.approx(force.min(), rel=1e-5)
    assert found.largest_contact_force.value == pytest.approx(force.max(), rel=1e-5)
    assert found.pressure_angle.value == pytest.approx(angle.max(), rel=1e-5)
    assert found.pressure_angle.value >= angle.max() - 1e-9
    assert found.lifts_off == ()


@pytest.mark.slow
def test_curvature_is_that_of_the_pitch_curve(found):
    centre = found.follower.disk.curve(np.linspace(0, 2 * np.pi, 200_001))[0]
    step = np.diff(centre)
    bend = np.abs(np.angle(step[1:] / step[:-1])) / np.abs(step[1:])
    convex = np.angle(step[1:] / step[:-1]) < 0.0  # the roller runs clockwise
    assert found.curvature_radius.value == pytest.approx(1.0 / bend[convex].max(), rel=1e-3)


@pytest.mark.slow
def test_a_faster_machine_shows_where_it_lifts_off(found):
    scene = found.scene
    faster = ks.Scene(scene.mechanism, 10.0 * scene.crank_speed, loads=scene.loads).solve(360)
    pressing = faster.scalar("contact_force_cam") > 0.0
    inside = np.zeros(360, bool)
    for start, stop in ks.design.lifted(faster, "contact_force_cam"):
        inside |= (np.mod(faster.crank_angle - start, 2 * np.pi)) < stop - start
    assert np.any(inside)
    assert np.array_equal(inside, ~pressing)


@pytest.mark.slow
def test_report_and_table_show_gain_and_cost(found):
    for text in ("N m mean; uneven by", "preload", "positive at all angles", "pressure angle      30 deg at most"):
        assert text in found.report()
    table = found.table()
    assert table.loc["mean |T - mean| [N m]", "after"] < 1e-9
    assert table.loc["largest reaction at O [N]", "after"] > table.loc["largest reaction at O [N]", "before"]
    assert "of the unevenness remains" in repr(found)
