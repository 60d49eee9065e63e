"""Rises from 0 to 1: against accelerations integrated with 25 digits, and published peaks."""

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.machine.laws import curves

RISES = {
    "harmonic": curves.HARMONIC,
    "cycloidal": curves.CYCLOIDAL,
    "modified sine": curves.MODIFIED_SINE,
    "modified trapezoid": curves.MODIFIED_TRAPEZOID,
    "3-4-5": curves.Powers((3, 4, 5)),
    "4-5-6-7": curves.Powers((4, 5, 6, 7)),
}
PUBLISHED = {
    "harmonic": (1.5708, 4.9348, 15.503),
    "cycloidal": (2.0, 6.2832, 39.478),
    "modified sine": (1.7596, 5.5280, 69.466),
    "modified trapezoid": (2.0, 4.8881, 61.426),
    "3-4-5": (1.875, 5.7735, 60.0),
    "4-5-6-7": (2.1875, 7.5132, 52.5),
}
"""Peak velocity, acceleration and jerk (Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 3)."""
PLACES = (0.03, 0.125, 0.2, 0.375, 0.41, 0.5, 0.61, 0.8, 0.97)


def shape(name, u):
    """Acceleration of a rise but for its size, as drawn in the textbooks, and where its pieces meet."""
    pi, sin, cos = mp.pi, mp.sin, mp.cos
    if u > 0.5:
        return -shape(name, 1 - u)
    if name == "harmonic":
        return cos(pi * u)
    if name == "cycloidal":
        return sin(2 * pi * u)
    if name == "modified sine":
        return sin(4 * pi * u) if u < 0.125 else cos(4 * pi / 3 * (u - mp.mpf(1) / 8))
    if name == "modified trapezoid":
        return sin(4 * pi * u) if u < 0.125 else mp.mpf(1) if u < 0.375 else cos(4 * pi * (u - mp.mpf(3) / 8))
    return u * (1 - u) * (1 - 2 * u) if name == "3-4-5" else (u * (1 - u)) ** 2 * (1 - 2 * u)


def integrated(name, u):
    """Position, velocity and acceleration of the rise at u, from its acceleration by quadrature."""
    u = mp.mpf(u)

    def quad(function, end):
        breaks = [mp.mpf(place) / 8 for place in (0, 1, 3, 4, 5, 7)]
        return mp.quad(function, [place for place in breaks if place < end] + [end])

    size = 1 / quad(lambda t: (1 - t) * shape(name, t), mp.mpf(1))
    position = quad(lambda t: (u - t) * shape(name, t), u)
    return [float(size * part) for part in (position, quad(lambda t: shape(name, t), u), shape(name, u))]


@pytest.mark.slow
@pytest.mark.parametrize("name", RISES)
def test_rise_integrates_its_textbook_acceleration(name):
    rise = RISES[name]
    with mp.workdps(25):
        expected = np.array([integrated(name, place) for place in PLACES]).T
    assert_allclose(rise(np.array(PLACES))[:3], expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", RISES)
def test_peaks_are_the_published_ones(name):
    rise = RISES[name]
    assert_allclose(rise.coefficients, PUBLISHED[name], rtol=2e-5)
    found = [np.max(np.abs(part)) for part in rise(np.linspace(0.0, 1.0, 80001))[1:]]
    assert_allclose(found, rise.coefficients, rtol=1e-8)


@pytest.mark.parametrize("name", RISES)
def test_the_end_of_a_rise_is_as_exact_as_its_start(name):
    """Velocity and acceleration vanish at both ends, and close to the end nothing of its rest is lost."""
    rise = RISES[name]
    start, end = rise(np.array([0.0, 1e-6])), rise(np.array([1.0, 1.0 - 1e-6]))
    assert_allclose(end[1], start[1], rtol=1e-9, atol=1e-300)
    assert end[0][0] == 1.0
    assert start[0][0] == 0.0


@pytest.mark.parametrize(
    ("name", "breaks"),
    [
        ("harmonic", (0.0, 1.0)),
        ("cycloidal", (0.0, 0.25, 0.75, 1.0)),
        ("modified sine", (0.0, 0.125, 0.875, 1.0)),
        ("modified trapezoid", (0.0, 0.125, 0.375, 0.625, 0.875, 1.0)),
        ("3-4-5", (0.0, 1.0)),
    ],
)
def test_pieces_meet_where_the_textbooks_say(name, breaks):
    assert RISES[name].breaks == breaks


def test_rest_does_not_move():
    assert not np.any(curves.Rest()(np.linspace(0.0, 1.0, 5)))


@pytest.mark.parametrize("name", RISES)
def test_what_is_no_number_has_no_position(name):
    assert np.isnan(RISES[name](np.array([np.nan, np.nan]))).all()
    assert np.isnan(RISES[name](np.array([0.3, np.nan])).position).tolist() == [False, True]
