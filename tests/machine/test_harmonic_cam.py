"""Harmonic cams: their radius by independent sums, every engine, their coefficients as parameters."""

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.machines import ANGLES, largest

COSINE, SINE, TURNED = (0.31, 0.004, 0.0, -0.012, 0.0007), (0.002, 0.0, -0.001), 0.3
CAM = ks.cams.Harmonic(COSINE, SINE, TURNED)
LINKS = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0), "block": ks.Link(20.0)}
LOADS = [ks.Gravity(), ks.Spring(7e5, 2.0)]


def saw(cam=CAM):
    return ks.cam_crank_slider(cam, 2.02, guide_angle=0.2, guide_offset=0.02, **LINKS)


def scene(cam=CAM):
    return ks.Scene(saw(cam), 33.5, loads=LOADS)


def series(angle):
    angle = mp.mpf(angle) - mp.mpf(TURNED)
    terms = [mp.mpf(a) * mp.cos(k * angle) for k, a in enumerate(COSINE)]
    return mp.fsum(terms + [mp.mpf(b) * mp.sin(k * angle) for k, b in enumerate(SINE, 1)])


def test_radius_equals_the_series_in_30_digits():
    with mp.workdps(30):
        for order, found in enumerate(CAM.radius(ANGLES)):
            expected = [float(mp.diff(series, float(angle), order)) for angle in ANGLES]
            assert_allclose(found, expected, rtol=0, atol=3e-16)


@pytest.mark.parametrize(("cosine", "sine"), [((0.3,), ()), ((0.3, 0.0), (0.0,)), ([0.3], []), (np.array([0.3]), ())])
def test_mean_radius_alone_is_a_circle(cosine, sine):
    found, circle = scene(ks.cams.Harmonic(cosine, sine)).solve(24), scene(ks.cams.Circle(0.3)).solve(24)
    for name in ("O", "cam_force", "balancing_torque", "pressure_angle"):
        assert_allclose(
            getattr(found, name, None) if name != "O" else found.reaction("O"),
            getattr(circle, name, None) if name != "O" else circle.reaction("O"),
            rtol=1e-13,
            atol=1e-8,
        )


def test_first_harmonics_may_turn_with_the_guide():
    turned = ks.cams.Harmonic((0.3, 0.01 * np.cos(0.7)), (0.01 * np.sin(0.7),))
    for one, other in zip(
        turned.radius(ANGLES), ks.cams.Harmonic((0.3, 0.01), guide_angle=0.7).radius(ANGLES), strict=True
    ):
        assert_allclose(one, other, rtol=0, atol=1e-16)


def test_coefficients_have_exact_derivatives():
    """Against central differences of the solution itself."""
    made = scene()
    program = ks.compile(made, ("balancing_torque", "cam_force"), engine="numpy")
    paths = ["cam.cosine.0", "cam.cosine.1", "cam.cosine.3", "cam.cosine.4", "cam.sine.1", "cam.sine.3"]
    assert [path for path in program.parameters if path.startswith("cam.") and "angle" not in path] == paths
    found = program.derivatives(ANGLES, paths)
    for path in paths:
        step = 1e-6
        low, high = (program(ANGLES, {path: made.parameters[path] + side * step}) for side in (-1, 1))
        for name in found:
            slope = (high[name] - low[name]) / (2 * step)
            assert largest(found[name][path] - slope) < 1e-8 * largest(slope)


def test_zero_harmonic_costs_nothing():
    few, many = ks.cams.Harmonic((0.3, 0.01)), ks.cams.Harmonic((0.3, 0.01, 0.0, 0.0), (0.0,))
    plain, kept = (ks.compile(scene(cam), "balancing_torque") for cam in (few, many))
    assert plain._program.recording.operations == kept._program.recording.operations
    asked = ks.compile(scene(many), "balancing_torque", parameters=("cam.cosine.3", "cam.sine.1"), engine="numpy")
    values = {"cam.cosine.3": 0.002, "cam.sine.1": -0.003}
    expected = scene(ks.cams.Harmonic((0.3, 0.01, 0.0, 0.002), (-0.003,))).solve(ANGLES).balancing_torque
    assert_allclose(asked(ANGLES, values)["balancing_torque"], expected, rtol=1e-12, atol=1e-9)


@pytest.mark.slow
def test_batch_of_coefficients_equals_each_design():
    third = np.array([[0.0], [0.003], [-0.002]])
    found = scene(ks.cams.Harmonic((0.3, 0.01, 0.002, third))).solve(24).balancing_torque
    for row, value in zip(found, third.ravel(), strict=True):
        alone = scene(ks.cams.Harmonic((0.3, 0.01, 0.002, value))).solve(24).balancing_torque
        assert_allclose(row, alone, rtol=1e-11, atol=1e-8)


@pytest.mark.slow
def test_compiled_loop_jax_and_enclosures_agree(numba, double, flint):
    expected = scene().solve(ANGLES).balancing_torque
    assert_allclose(scene().solve(ANGLES, engine="compiled").balancing_torque, expected, rtol=1e-11, atol=1e-8)
    traced = scene().solve(double.numpy.array(ANGLES)).balancing_torque
    assert_allclose(traced, expected, rtol=1e-11, atol=1e-8)
    arb = flint.arb
    cam = ks.cams.Harmonic(tuple(map(arb, COSINE)), tuple(map(arb, SINE)), arb(TURNED))
    enclosed = scene(cam).solve(np.array([arb(angle) for angle in ANGLES])).balancing_torque
    assert_allclose([float(part.mid()) for part in enclosed], expected, rtol=1e-11, atol=1e-8)


@pytest.mark.parametrize(
    ("cosine", "sine", "message"),
    [
        ((), (), r"cosine must be a tuple of numbers \(a0, a1, \.\.\.\), got \(\)"),
        (0.3, (), "cosine must be a tuple of numbers"),
        ("0.3", (), "cosine must be a tuple of numbers"),
        (np.ones((2, 1)), (), "cosine must be a tuple of numbers"),
        ((0.0, 0.1), (), "cosine.0 must be greater than 0, got 0.0"),
        ((-0.3,), (), "cosine.0 must be greater than 0"),
        ((0.3, np.nan), (), "cosine.1 must be finite, got nan"),
        ((0.3, "0.1"), (), "cosine.1 must be a number"),
        ((0.3, True), (), "cosine.1 must be a number .* truth value"),
        ((0.3,), (0.1, np.inf), "sine.2 must be finite, got inf"),
        ((0.3,), 0.1, r"sine must be a tuple of numbers \(b1, b2"),
        ((0.3,), {"1": 0.1}, "sine must be a tuple of numbers"),
        ((0.3, np.ones((2, 1))), (np.ones((3, 1)),), "these shapes do not fit together"),
    ],
)
def test_coefficients_no_cam_can_have_are_refused(cosine, sine, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.cams.Harmonic(cosine, sine)


def test_harmonic_pitch_curve_must_go_around_o():
    with pytest.raises(ks.AssemblyError, match=r"must go around O, but its radius falls to -0\.01 m"):
        scene(ks.cams.Harmonic((0.3, 0.31))).solve(360)


CASE = """
title = "Saw with a harmonic cam"
reference = "saw"
[common]
mechanism = "cam-crank-slider"
crank_speed = "320 rpm"
coupler_length = "2.02 m"
slider = { mass = "600 kg" }
spring = { stiffness = "700 kN/m", free_position = "2 m", cubic = "20 kN/m^3" }
[variants.saw]
guide_angle = "0.2 rad"
cam = { kind = "harmonic", cosine = ["310 mm", "0.4 cm", "0 m", "-12 mm"], sine = ["2 mm"] }
"""


def test_case_harmonic_cam_turns_with_the_guide(tmp_path):
    path = tmp_path / "saw.toml"
    path.write_text(CASE)
    variant = ks.load_case(path).variant("saw")
    cam = variant.mechanism.groups[0].cam
    assert_allclose(cam.cosine, (0.31, 0.004, 0.0, -0.012), rtol=1e-15)
    assert (cam.sine, cam.guide_angle) == ((0.002,), 0.2)
    assert variant.loads[0].cubic == 2e4
    assert variant.parameters["cam.cosine.3"] == variant.scene.parameters["cam.cosine.3"] == -0.012
    assert variant.units["cam.sine.1"] == "m"
    assert variant.varied({"cam.sine.1": 0.003}).mechanism.groups[0].cam.sine == (0.003,)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('cosine = ["310 mm", "0.4 cm", "0 m", "-12 mm"]', 'cosine = "310 mm"', r"cam.cosine must be a list such as"),
        ('"0.4 cm"', '"0.4 kg"', "cam.cosine .*kg"),
        ('sine = ["2 mm"]', 'sine = ["2"]', "cam.sine "),
        ('"310 mm"', '"0 mm"', "cosine.0 must be greater than 0"),
        ("harmonic", "harmonics", "did you mean 'harmonic'"),
    ],
)
def test_wrong_keys_of_a_harmonic_cam_are_told(tmp_path, old, new, message):
    path = tmp_path / "saw.toml"
    path.write_text(CASE.replace(old, new))
    with pytest.raises(ks.errors.CaseError, match=message):
        ks.load_case(path)
