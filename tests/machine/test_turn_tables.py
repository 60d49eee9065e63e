"""A value over the turn from a table: its periodic spline, its noise, and how far the second derivative is wrong."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.machine.turn_tables import TurnTable
from support.machines import largest

FINE = np.linspace(0.0, 2 * np.pi, 3601)


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


def test_the_spline_and_its_derivatives_repeat_after_a_turn_and_pass_through_every_point():
    made = table(uneven(180), value(uneven(180)))
    assert_allclose(made.splines[0](made.angle), made.values, rtol=1e-15)
    for order, (spline, allowed) in enumerate(zip(made.splines, (1e-9, 1e-7, 1e-5, 1e-3), strict=True)):
        assert_allclose(spline(FINE), value(FINE, order), rtol=0, atol=allowed)
        assert_allclose(spline(FINE - 4 * np.pi), spline(FINE), rtol=0, atol=1e-10)


def test_the_second_derivative_is_continuous_at_the_points_and_across_the_seam():
    """The step across a point vanishes in proportion to its width, also where the table ends and begins again."""
    angle = uneven(24)
    second, third = table(angle, value(angle)).splines[2:]
    for width in (1e-4, 1e-7):
        assert largest(second(angle + width) - second(angle - width)) < 2 * width * largest(third(FINE)) * 1.01


@pytest.mark.parametrize(("count", "step"), [(90, 1e-6), (360, 1e-6), (24, 0.0)])
def test_the_error_stated_is_that_of_the_second_derivative(count, step):
    """By rounding to a step, or by few points."""
    angle = 2 * np.pi * np.arange(count) / count
    made = table(angle, np.round(value(angle) / step) * step if step else value(angle))
    true = largest(made.splines[2](FINE) - value(FINE, 2))
    assert 0.5 * true <= made.second_derivative_error <= 10 * true
    assert made.force_error(0.1) == pytest.approx(70.0 * made.second_derivative_error)
    assert made.force_error(0.0) == np.inf


def test_noise_stated_too_small_hides_no_error():
    """The spline follows the scatter there is, and errs by it."""
    angle = 2 * np.pi * np.arange(90) / 90
    scattered = value(angle) + np.random.default_rng(0).normal(0.0, 1e-4, angle.size)
    with pytest.warns(UserWarning, match="less than"):
        made = table(angle, scattered, 1e-9)
    error = largest(made.splines[2](FINE) - value(FINE, 2))
    assert error / 3 <= made.second_derivative_error <= 10 * error
