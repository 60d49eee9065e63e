"""Torque-balancing cams: what is left of the unevenness, contact all the way, prices, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks

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


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("variant", VARIANTS)
def test_the_mean_torque_alone_is_left_with_contact_all_the_way(variant, load):
    scene = drive(variant, load)
    found = balanced(scene, guide_angle=0.4, guide_offset=0.003)
    at = np.linspace(0.01, 6.29, 2000)
    before, after = (machine.solve(at).balancing_torque for machine in (scene, found.scene))
    assert np.mean(np.abs(after - found.mean_torque)) < 1e-10 * np.mean(np.abs(before - found.mean_torque))
    assert found.lifts_off == ()
    assert np.min(found.scene.solve(at).scalar("contact_force_cam")) > 0.9 * found.least_contact_force.value > 0
    assert found.scene.solve(at).rate("rocker") == pytest.approx(scene.solve(at).rate("rocker"), rel=1e-14)


def test_the_torque_by_power_agrees():
    s = balanced(drive("rho-0.5", "switching")).scene.solve(97)
    assert_allclose(
        s.balancing_torque, s.balancing_torque_by_power, rtol=0, atol=1e-12 * s.dynamics.largest_torque_term
    )


def test_a_load_that_jumps_within_a_stroke_is_balanced_too():
    def press(motion):
        return np.where(np.cos(motion.crank_angle) > 0, -500.0, 0.0)

    links = {"slider": ks.Link(2.0), "crank": ks.Link(1.0, (0.02, 0.0))}
    scene = ks.Scene(ks.crank_slider(0.05, 0.2, guide_offset=0.01, **links), 40.0, loads=ks.ProcessForce(press))
    found = balanced(scene, 0.2, 0.01)
    assert found.remaining < 1e-9
    assert np.min(np.abs(np.array(found.follower.cam.law.knots) - np.pi / 2)) < 1e-12


def test_the_follower_keeps_to_its_travel_and_pressure_angle():
    found = balanced(drive(), pressure_angle=np.radians(25.0), guide_offset=0.002)
    position = found.scene.solve(7200).travel("follower_cam")
    assert_allclose(np.ptp(position), 0.012, rtol=1e-6)
    assert_allclose(found.pressure_angle.value, np.radians(25.0), rtol=1e-5)
    assert_allclose(found.stretch, (0.012, 0.024), rtol=1e-12)
    assert_allclose(found.preload, found.spring.stiffness * 0.012, rtol=1e-12)


def test_the_weight_of_the_follower_is_counted_in():
    up, level = (balanced(drive(), guide_angle=angle) for angle in (np.pi / 2, 0.0))
    assert_allclose(up.spring.free_position - level.spring.free_position, 0.3 * 9.81 / up.spring.stiffness, rtol=1e-9)


def test_another_speed_unbalances_it():
    found = balanced(drive())
    faster = ks.Scene(found.scene.mechanism, 1.1 * found.scene.crank_speed, loads=found.scene.loads)
    torque = faster.solve(360).balancing_torque
    assert np.ptp(torque) > 1e-3 * found.uneven[0]


@pytest.mark.parametrize("mass", [0.05, 1.7])
def test_contact_is_kept_down_to_the_bound(mass):
    found = balanced(drive(), mass)
    assert found.reserve > 1.0
    assert found.remaining < 1e-9
    assert found.least_contact_force.value > 0


def test_stiff_springs_need_hardly_any_preload():
    found = balanced(drive(), 0.1, stiffness=12400.0)
    assert found.preload < 0.25
    assert found.remaining < 1e-9


WRONG = {
    "too heavy": ({"mass": 2.0}, r"lift off at 348\.\d+ deg.* 0\.926\d* times .* lighter than 1\.71"),
    "too stiff": ({"stiffness": 13000.0}, r"without any preload; take less than 12437\.\d N/m"),
    "small base": ({"base_radius": 1e-3}, r"exceeds 30 deg; take at least 0\.01"),
    "no mass": ({"mass": 0.0}, "mass"),
    "text": ({"travel": "12 mm"}, "travel"),
}


@pytest.mark.parametrize("name", WRONG)
def test_impossible_demands_are_refused_with_numbers(name):
    given, text = WRONG[name]
    with pytest.raises(ks.ParameterError, match=text):
        balanced(drive(), **given)


def test_a_roller_that_undercuts_is_refused():
    balanced(drive(), roller_radius=0.01)
    with pytest.raises(ks.ParameterError, match="roller"):
        balanced(drive(), roller_radius=0.03)


def test_scenes_that_no_cam_can_balance_are_refused():
    scene = drive()
    still = ks.Scene(ks.crank_slider(0.1, 0.3), 10.0)
    jump = ks.Torque(lambda m: np.where(np.sin(m.crank_angle) > 0, 5.0, -5.0), on="crank")
    cases = {
        "even as it is": still,
        "jumps across its mean": ks.Scene(still.mechanism, 10.0, loads=jump),
        "one constant speed": ks.Scene(scene.mechanism, 10.0, 1.0),
        "the crank stands": ks.Scene(scene.mechanism, 0.0),
        "takes a Scene": scene.mechanism,
        "friction at O": ks.Scene(scene.mechanism, 10.0, friction={"O": ks.PinFriction(0.1, 0.01)}),
    }
    table = ks.Table([0.0, 3.0, 6.0, 9.0], [0.0, 9.0, 3.0, 1.0], period=4 * np.pi)
    cases["after a turn, but do after 2"] = ks.Scene(scene.mechanism, 10.0, loads=ks.Torque(table, on="rocker"))
    for text, item in cases.items():
        with pytest.raises(ks.ParameterError, match=text):
            balanced(item)
