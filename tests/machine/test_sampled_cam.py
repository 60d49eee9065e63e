"""Cams of samples and of harmonics."""

from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.laws.turn_table import TurnTable
from support.every import every
from support.machines import ANGLES, assert_equal, largest, results


def uneven(count, start=0.3):
    even = 2 * np.pi * np.arange(count) / count
    return start + even + 0.1 * np.sin(even)


def circle_table(count, start=0.3):
    """An eccentric circle as unevenly measured points."""
    circle, angle = ks.cams.Circle(0.3, (0.05, -0.04)), uneven(count, start)
    return circle, angle, circle.radius(angle)[0]


@every("start", [-4.0, 0.3])
def test_sampled_cam_converges_by_spline_order(start):
    """Twice the points: a quintic spline errs 2^6 less in r, 2^5 in r', 2^4 in r''."""
    phi = np.linspace(-7.0, 7.0, 400)
    errors = []
    for count in (32, 64, 128):
        circle, angle, radius = circle_table(count, start)
        sampled = ks.cams.Sampled(angle, radius)
        errors.append([largest(a - b) for a, b in zip(sampled.radius(phi), circle.radius(phi), strict=True)])
    for coarse, fine in pairwise(errors):
        assert_allclose(np.log2(np.divide(coarse, fine)), [6, 5, 4], atol=0.7)


def test_sampled_cam_passes_its_points():
    _, angle, radius = circle_table(40)
    cam = ks.cams.Sampled(angle, radius)
    assert_allclose(cam.radius(angle)[0], radius, rtol=1e-15)
    for near, far in zip(cam.radius(ANGLES), cam.radius(ANGLES - 4 * np.pi), strict=True):
        assert_allclose(far, near, rtol=0, atol=1e-13)


@pytest.mark.slow
def test_sampled_cam_drives_like_its_circle():
    circle, angle, radius = circle_table(360)
    machines = [
        ks.cam_crank_slider(cam, 1.1, coupler=ks.Link(7.0, 0.5, 0.9), slider=ks.Link(11.0))
        for cam in (circle, ks.cams.Sampled(angle, radius))
    ]
    exact, sampled = (results(ks.solve(machine, ANGLES, crank_speed=9.0)) for machine in machines)
    names = [name for name in exact if name != "guide_moment"]
    assert_equal({name: sampled[name] for name in names}, {name: exact[name] for name in names}, tolerance=1e-9)


@every("make", [ks.cams.Sampled, ks.laws.table])
@every("noise", [None, 0.1])
def test_too_few_points_for_harmonics_warn(make, noise):
    angle = 2 * np.pi * np.arange(12) / 12
    with pytest.warns(UserWarning, match="points are too coarse|the noise stated") as caught:
        make(angle, 0.3 + 0.05 * np.cos(4 * angle), noise)
    assert "12 points are too coarse or too noisy" in str(caught[-1].message)
    assert len({(item.filename, item.lineno) for item in caught}) == 1  # the caller's line
    assert caught[-1].filename == __file__


def test_radii_of_a_table_are_its_samples():
    angle = 2 * np.pi * np.arange(360) / 360
    cam = ks.cams.Sampled(angle, 0.3 + 0.01 * np.cos(angle))
    assert cam.samples is cam.values


# What a table's own noise does to the forces


LAW = ks.cams.CosineLaw(0.3, 2.0)
CAMS = {
    "circle": ks.cams.Circle(0.3, (-0.0219, 0.0)),
    "circle off the guide": ks.cams.Circle(0.3, (0.05, -0.04)),
    "nearly centred circle": ks.cams.Circle(0.3, (0.001, 0.0)),
    "cosine law": LAW,
    "second harmonic": ks.cams.Harmonic((0.3, 0.0, 0.02)),
    "fourth harmonic": ks.cams.Harmonic((0.3, 0.0, 0.0, 0.0, 0.005)),
}
FINE = np.linspace(0.0, 2 * np.pi, 3601)
SPEED = 320 * np.pi / 30


def balanced_cam_force(cam):
    """Of the sawframe, whose springs leave a fifth to a half of the inertia force."""
    machine = ks.cam_crank_slider(cam, LAW.coupler_length, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
    spring = ks.Spring.balancing(600.0, SPEED, 2.0)
    return ks.solve(machine, FINE, crank_speed=SPEED, loads=[ks.Gravity(), spring]).cam_force


def rounded(cam, count, step):
    angle = 2 * np.pi * np.arange(count) / count
    return angle, np.round(cam.radius(angle)[0] / step) * step


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:sampled cam")
@every("count, step", [(90, 1e-5), (90, 1e-7), (360, 1e-6), (3600, 1e-5), (3600, 1e-7)])
@every("name", CAMS)
def test_stated_force_error_is_within_ten_times(name, count, step):
    sampled = ks.cams.Sampled(*rounded(CAMS[name], count, step))
    exact = balanced_cam_force(CAMS[name])
    true = largest(balanced_cam_force(sampled) - exact) / largest(exact)
    assert true <= sampled.force_error <= 10 * true
    assert sampled.noise == pytest.approx(step / np.sqrt(12), rel=0.5)
    found = largest(sampled.radius(FINE)[2] - CAMS[name].radius(FINE)[2])
    assert 0.5 * found <= sampled.second_derivative_error <= 2 * found


@pytest.mark.slow
@every("count", [90, 360, 3600])
@every("name", CAMS)
def test_exact_tables_state_their_truncation(name, count):
    angle = 2 * np.pi * np.arange(count) / count
    sampled = ks.cams.Sampled(angle, CAMS[name].radius(angle)[0])
    exact = balanced_cam_force(CAMS[name])
    true = largest(balanced_cam_force(sampled) - exact) / largest(exact)
    assert true <= sampled.force_error <= 10 * true + 1e-9
    assert sampled.force_error < 1e-4


@every("step, warned", [(1e-6, True), (1e-7, True), (1e-8, False)])
def test_a_warning_comes_from_one_per_cent(step, warned):
    """Of the sawframe's circle at every degree: rounded to 1 um the cam force errs by 13 %, to 0.1 um by 2 %."""
    table = rounded(CAMS["circle"], 360, step)
    if warned:
        with pytest.warns(UserWarning, match=r"scatter by [23].* m .* forces by up to .*% where"):
            assert ks.cams.Sampled(*table).force_error >= 0.01
    else:
        assert ks.cams.Sampled(*table).force_error < 0.01


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:sampled cam")
@every("count, step", [(90, 1e-6), (360, 1e-7), (360, 1e-5)])
@every("name", CAMS)
def test_stated_noise_is_smoothed_away(name, count, step):
    """What is stated bounds the error in each, and at every degree smoothing takes nine tenths of it and more."""
    table = rounded(CAMS[name], count, step)
    smooth = ks.cams.Sampled(*table, noise=step / np.sqrt(12))
    exact = balanced_cam_force(CAMS[name])
    true = largest(balanced_cam_force(smooth) - exact) / largest(exact)
    assert true <= smooth.force_error <= 40 * true
    if count == 360:
        rough = largest(balanced_cam_force(ks.cams.Sampled(*table)) - exact) / largest(exact)
        assert true < rough / 10


def test_micrometre_rounding_gives_force_to_1e_3():
    """The sawframe at every degree: 12 per cent without."""
    exact = balanced_cam_force(LAW)
    with pytest.warns(UserWarning, match="state their noise to have them smoothed"):
        rough = ks.cams.Sampled(*rounded(LAW, 360, 1e-6))
    smooth = ks.cams.Sampled(*rounded(LAW, 360, 1e-6), noise=0.29e-6)
    errors = [largest(balanced_cam_force(cam) - exact) / largest(exact) for cam in (rough, smooth)]
    assert errors[0] > 0.1
    assert errors[1] < 1e-3
    assert "forces within 0.0004" in repr(smooth)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:sampled cam. 360 points")
@every("noise, words", [(8e-8, "less than"), (1e-5, "more than")])
def test_noise_unlike_that_of_the_table_is_warned_of(noise, words):
    table = rounded(LAW, 360, 1e-6)
    with pytest.warns(UserWarning, match=f"the noise stated, {noise:.3g} m, is {words} the 2.97e-07 m by which"):
        ks.cams.Sampled(*table, noise=noise)


@pytest.mark.slow
def test_traced_sampled_cam_is_refused(double):
    mechanism = ks.cam_crank_slider(ks.cams.Sampled(*rounded(LAW, 360, 1e-9)), 2.0, slider=ks.Link(600.0))
    with pytest.raises(ks.NotGivenError, match=r"sampled cam.*ks.compile"):
        double.jit(lambda angle: ks.solve(mechanism, angle, crank_speed=3.0, on_gap="nan").balancing_torque)(np.ones(3))


# A value over the turn from a table


def value(angle, order=0):
    """Two harmonics, or a derivative of them."""
    return (
        2.0 * (order == 0)
        + 0.1 * np.cos(angle + order * np.pi / 2)
        + 0.01 * 3**order * np.cos(3 * angle + order * np.pi / 2)
    )


@pytest.mark.filterwarnings("ignore:table. 24 points are too coarse")
def test_second_derivative_is_continuous():
    """The step across a point vanishes in proportion to its width, also where the table ends and begins again."""
    angle = uneven(24)
    second, third = TurnTable(angle, value(angle)).splines[2:]
    for width in (1e-4, 1e-7):
        assert largest(second(angle + width) - second(angle - width)) < 2 * width * largest(third(FINE)) * 1.01


@pytest.mark.filterwarnings("ignore:table. 90 points are too coarse")
def test_noise_stated_too_small_hides_no_error():
    """The spline follows the scatter there is, and errs by it."""
    angle = 2 * np.pi * np.arange(90) / 90
    scattered = value(angle) + np.random.default_rng(0).normal(0.0, 1e-4, angle.size)
    with pytest.warns(UserWarning, match="less than"):
        made = TurnTable(angle, scattered, 1e-9)
    error = largest(made.splines[2](FINE) - value(FINE, 2))
    assert error / 3 <= made.second_derivative_error <= 10 * error


# Harmonic cams

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


@every("cosine, sine", [((0.3,), ()), ((0.3, 0.0), (0.0,)), ([0.3], []), (np.array([0.3]), ())])
def test_mean_radius_alone_is_a_circle(cosine, sine):
    found, circle = (scene(cam).solve(24) for cam in (ks.cams.Harmonic(cosine, sine), ks.cams.Circle(0.3)))
    assert_allclose(found.reaction("O"), circle.reaction("O"), rtol=1e-13, atol=1e-8)
    for name in ("cam_force", "balancing_torque", "pressure_angle"):
        assert_allclose(getattr(found, name), getattr(circle, name), rtol=1e-13, atol=1e-8)


def test_first_harmonics_may_turn_with_the_guide():
    turned = ks.cams.Harmonic((0.3, 0.01 * np.cos(0.7)), (0.01 * np.sin(0.7),))
    for one, other in zip(
        turned.radius(ANGLES), ks.cams.Harmonic((0.3, 0.01), guide_angle=0.7).radius(ANGLES), strict=True
    ):
        assert_allclose(one, other, rtol=0, atol=1e-16)


@pytest.mark.slow
def test_zero_harmonic_costs_nothing():
    few, many = ks.cams.Harmonic((0.3, 0.01)), ks.cams.Harmonic((0.3, 0.01, 0.0, 0.0), (0.0,))
    plain, kept = (ks.compile(scene(cam), "balancing_torque") for cam in (few, many))
    assert plain._program.recording.operations == kept._program.recording.operations
    asked = ks.compile(scene(many), "balancing_torque", parameters=("cam.cosine.3", "cam.sine.1"), engine="numpy")
    values = {"cam.cosine.3": 0.002, "cam.sine.1": -0.003}
    expected = scene(ks.cams.Harmonic((0.3, 0.01, 0.0, 0.002), (-0.003,))).solve(ANGLES).balancing_torque
    assert_allclose(asked(ANGLES, values)["balancing_torque"], expected, rtol=1e-12, atol=1e-9)


@every(
    "cosine, sine, message",
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


@every(
    "old, new, message",
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
