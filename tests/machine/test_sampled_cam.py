"""A cam from a table: its spline, and how far the table can be trusted."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.laws.turn_table import TurnTable
from support.every import every
from support.machines import ANGLES, assert_equal, largest, results


def circle_table(count, start=0.3):
    """An eccentric circle as unevenly measured points."""
    circle = ks.cams.Circle(0.3, (0.05, -0.04))
    even = 2 * np.pi * np.arange(count) / count
    angle = start + even + 0.1 * np.sin(even)
    return circle, angle, circle.radius(angle)[0]


@pytest.mark.parametrize("start", [-4.0, 0.3])
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


def test_sampled_cam_drives_like_its_circle():
    circle, angle, radius = circle_table(360)
    machines = [
        ks.cam_crank_slider(cam, 1.1, coupler=ks.Link(7.0, 0.5, 0.9), slider=ks.Link(11.0))
        for cam in (circle, ks.cams.Sampled(angle, radius))
    ]
    exact, sampled = (results(ks.solve(machine, ANGLES, crank_speed=9.0)) for machine in machines)
    names = [name for name in exact if name != "guide_moment"]
    assert_equal({name: sampled[name] for name in names}, {name: exact[name] for name in names}, tolerance=1e-9)


@pytest.mark.parametrize("digits", [4, 5])
def test_rounding_in_the_second_derivative_warns(digits):
    """A radius read to 0.1 or 0.01 mm at every degree: the error over the step squared is of the size of r."""
    _, angle, radius = circle_table(360)
    with pytest.warns(UserWarning, match=r"360 points are too coarse or too noisy: r'' is uncertain by up to"):
        ks.cams.Sampled(angle, np.round(radius, digits))


def test_too_few_points_for_harmonics_warn():
    angle = 2 * np.pi * np.arange(12) / 12
    with pytest.warns(UserWarning, match="12 points are too coarse"):
        ks.cams.Sampled(angle, 0.3 + 0.05 * np.cos(4 * angle))


# What a table's own noise does to the forces


class Harmonic(ks.cams.Cam):
    def __init__(self, order, amplitude):
        self.order, self.amplitude = order, amplitude

    def polar(self, angle, ray):
        """The radius as a mean and one cosine."""
        k, a = self.order, self.amplitude
        return 0.3 + a * np.cos(k * angle), -k * a * np.sin(k * angle), -k * k * a * np.cos(k * angle)


LAW = ks.cams.CosineLaw(0.3, 2.0)
CAMS = {
    "circle": ks.cams.Circle(0.3, (-0.0219, 0.0)),
    "circle off the guide": ks.cams.Circle(0.3, (0.05, -0.04)),
    "nearly centred circle": ks.cams.Circle(0.3, (0.001, 0.0)),
    "cosine law": LAW,
    "second harmonic": Harmonic(2, 0.02),
    "fourth harmonic": Harmonic(4, 0.005),
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
@every("step", [1e-7, 1e-6, 1e-5])
@every("count", [90, 360, 3600])
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


@pytest.mark.parametrize(("step", "warned"), [(1e-6, True), (1e-7, True), (1e-8, False)])
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
@pytest.mark.parametrize("step", [1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize("count", [90, 360])
@pytest.mark.parametrize("name", CAMS)
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


@pytest.mark.filterwarnings("ignore:sampled cam. 360 points")
@pytest.mark.parametrize(("noise", "words"), [(8e-8, "less than"), (1e-5, "more than")])
def test_noise_unlike_that_of_the_table_is_warned_of(noise, words):
    table = rounded(LAW, 360, 1e-6)
    with pytest.warns(UserWarning, match=f"the noise stated, {noise:.3g} m, is {words} the 2.97e-07 m by which"):
        ks.cams.Sampled(*table, noise=noise)


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


def uneven(count, start=0.3):
    even = 2 * np.pi * np.arange(count) / count
    return start + even + 0.1 * np.sin(even)


def table(angle, values, noise=None):
    return TurnTable.of("table", angle, values, "value", noise)


def test_second_derivative_is_continuous():
    """The step across a point vanishes in proportion to its width, also where the table ends and begins again."""
    angle = uneven(24)
    second, third = table(angle, value(angle)).splines[2:]
    for width in (1e-4, 1e-7):
        assert largest(second(angle + width) - second(angle - width)) < 2 * width * largest(third(FINE)) * 1.01


def test_noise_stated_too_small_hides_no_error():
    """The spline follows the scatter there is, and errs by it."""
    angle = 2 * np.pi * np.arange(90) / 90
    scattered = value(angle) + np.random.default_rng(0).normal(0.0, 1e-4, angle.size)
    with pytest.warns(UserWarning, match="less than"):
        made = table(angle, scattered, 1e-9)
    error = largest(made.splines[2](FINE) - value(FINE, 2))
    assert error / 3 <= made.second_derivative_error <= 10 * error
