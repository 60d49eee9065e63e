"""Laws of motion and the curves of their segments."""

import warnings
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.laws.law import Law, breakpoints_of
from support.every import every

laws = ks.laws
TURN = 2 * np.pi
SEGMENTS = {
    "harmonic": laws.harmonic,
    "cycloidal": laws.cycloidal,
    "modified sine": laws.modified_sine,
    "modified trapezoid": laws.modified_trapezoid,
    "3-4-5": laws.polynomial,
    "4-5-6-7": lambda *args: laws.polynomial(*args, powers="4-5-6-7"),
}
SMOOTH = [name for name in SEGMENTS if name != "harmonic"]


def test_a_cosine_is_one_smooth_law_of_the_turn():
    phi = np.linspace(-7.0, 7.0, 57)
    found = laws.cosine(0.3, 2.0, phase=0.2)(phi)
    psi = phi - 0.2
    expected = (2 + 0.3 * np.cos(psi), -0.3 * np.sin(psi), -0.3 * np.cos(psi), 0.3 * np.sin(psi))
    assert_allclose(found, expected, rtol=0, atol=1e-15)


def test_two_harmonic_halves_are_the_cosine():
    law = laws.joined(laws.harmonic(2.3, 1.7, np.pi), laws.harmonic(1.7, 2.3, np.pi))
    phi = np.linspace(0.0, TURN, 50)[:-1]
    assert_allclose(law(phi), laws.cosine(0.3, 2.0)(phi), rtol=0, atol=1e-14)


def rise_dwell_return(name="cycloidal", **options):
    segment = SEGMENTS[name]
    return laws.joined(
        segment(1.7, 2.3, 2.0), laws.dwell(2.3, 0.5), segment(2.3, 1.7, 2.5), laws.dwell(1.7, TURN - 5.0), **options
    )


@every("name", SMOOTH)
def test_rise_dwell_return_runs_and_repeats(name):
    law = rise_dwell_return(name)
    assert_allclose(law([0.0, 1.0, 2.2, 3.75, 5.5]).position, [1.7, 2.0, 2.3, 2.0, 1.7], rtol=1e-15)
    phi = np.linspace(0.0, TURN, 77)
    assert_allclose(law(phi + 2 * TURN), law(phi), rtol=0, atol=2e-13)
    assert law(1.0).velocity.shape == ()


@every("name", SMOOTH)
def test_motion_is_continuous_between_segments(name):
    law = rise_dwell_return(name)
    knots = np.unique(law.knots)
    before, after = law(knots - 1e-9), law(knots + 1e-9)
    assert_allclose(before[:3], after[:3], rtol=0, atol=1e-6)


def test_a_table_gives_the_law_that_it_was_taken_from():
    angle = np.linspace(0.0, TURN, 180, endpoint=False)
    law = laws.table(angle, laws.cosine(0.3, 2.0)(angle).position)
    phi = np.linspace(-5.0, 5.0, 63)
    for order, (found, expected) in enumerate(zip(law(phi), laws.cosine(0.3, 2.0)(phi), strict=True)):
        assert_allclose(found, expected, rtol=0, atol=10.0 ** (2 * order - 12))


def test_smoothed_law_gives_better_forces():
    angle = np.linspace(0.0, TURN, 360, endpoint=False)
    exact = laws.cosine(0.3, 2.0)
    rounded = np.round(exact(angle).position, 6)
    with pytest.warns(UserWarning, match="table of a law: 360 points are too coarse or too noisy. x'' is uncertain"):
        rough = laws.table(angle, rounded)
    smooth = laws.table(angle, rounded, noise=1e-6 / np.sqrt(12))
    phi = np.linspace(0.0, TURN, 1000)
    errors = [np.max(np.abs(law(phi).acceleration - exact(phi).acceleration)) / 0.3 for law in (rough, smooth)]
    assert errors[1] < errors[0] / 100
    assert all(error < law.force_error for error, law in zip(errors, (rough, smooth), strict=True))
    assert smooth.shifted(0.1).force_error == smooth.force_error < 0.01


@every(
    "segments, message",
    [
        (
            [laws.cycloidal(1, 2, 3.0)],
            r"must fill a turn of 6.28\S+ rad, but take 3 .*; a dwell of 3.283\S+ rad is missing",
        ),
        ([laws.cycloidal(1, 2, 3.0)] * 3, "but take 9 .*shorten them"),
        ([laws.cycloidal(1, 2, np.pi)] * 2, "the position jumps at 180 deg, from 2 to 1 m, behind segment 1 of 2"),
        (
            [laws.harmonic(1, 2, np.pi), laws.dwell(2, 1.0), laws.harmonic(2, 1, np.pi - 1.0)],
            "the acceleration jumps at 180 deg, from -0.5 to 0 m/rad2, behind segment 1 of 3; take a cycloidal",
        ),
        ([1.0], "segment 1 must be made by ks.laws, got 1.0"),
        ([], "no segments"),
    ],
)
def test_open_segments_are_refused_with_the_place(segments, message):
    with pytest.raises(ks.ParameterError, match=message):
        laws.joined(*segments)


def test_allowed_acceleration_jump_is_taken():
    law = rise_dwell_return("harmonic", smooth="velocity")
    assert law(2.0 - 1e-9).acceleration == pytest.approx(-0.5 * 0.6 * (np.pi / 2) ** 2, rel=1e-6)
    assert law(2.0 + 1e-9).acceleration == 0.0


def test_laws_are_silent_and_leave_plain_arrays():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in SEGMENTS:
            for part in rise_dwell_return(name, smooth="velocity")(np.linspace(0.0, TURN, 721)):
                assert part.dtype == float
                assert np.isfinite(part).all()


# What a law of motion is


LAW = rise_dwell_return()


def test_a_law_comes_later_by_a_phase():
    assert_allclose(LAW.shifted(0.4)(1.3), LAW(0.9), rtol=0, atol=1e-15)
    assert_allclose(LAW.shifted(0.4).knots, np.add(LAW.knots, 0.4))
    assert_allclose(LAW.shifted(0.4).shifted(-0.4)(1.3), LAW(1.3), rtol=1e-14)


def test_what_is_only_called_has_no_knots_and_no_error():
    class Own(Law):
        def __call__(self, phi):
            return ks.laws.cosine(0.3, 2.0)(phi)

    assert Own().knots == ()
    assert Own().shifted(0.1).force_error is None
    assert_allclose(Own().shifted(0.1)(0.5), Own()(0.4), rtol=0, atol=1e-15)


def test_law_without_values_cannot_be_called():
    class Empty(Law):
        pass

    with pytest.raises(TypeError, match="Empty must define __call__"):
        Empty()(0.0)


def test_knots_mark_jumps_of_acceleration_or_jerk():
    rise, back = ks.laws.harmonic(0.05, 0.07, 2.0), ks.laws.cycloidal(0.07, 0.05, 2.0)
    rest = 2 * np.pi - 5.0
    law = ks.laws.joined(rise, ks.laws.dwell(0.07, 1.0), back, ks.laws.dwell(0.05, rest), smooth="velocity")
    found = breakpoints_of(law)
    assert [round(knot.angle, 12) for knot in found if knot.jumps] == [0.0, 2.0]
    assert [round(knot.angle, 12) for knot in found if not knot.jumps] == [3.0, 5.0]
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    assert breakpoints_of(ks.laws.table(angle, 0.05 + 0.01 * np.cos(angle))) == ()
    assert breakpoints_of(ks.laws.cosine(0.01, 0.05)) == ()


# Segments of a turn


CURVES = SEGMENTS | {"powers of one's own": lambda *args: laws.polynomial(*args, powers=[3, 5, 8])}


@every("name", CURVES)
def test_every_derivative_is_that_of_the_one_before(name):
    """By the interpolating polynomial between the knots, whose derivative is exact to rounding."""
    segment = CURVES[name](0.2, -0.3, 1.7)
    for low, high in pairwise(segment.knots):
        motion = np.polynomial.Chebyshev.interpolate(lambda x: segment(x).position, 24, [low, high])
        inner = np.linspace(low, high, 9)[1:-1]
        for order, part in enumerate(segment(inner)):
            assert_allclose(
                part, motion.deriv(order)(inner) if order else motion(inner), rtol=0, atol=10.0 ** (3 * order - 13)
            )


@every("name", CURVES)
def test_peaks_scale_with_stroke_and_angle(name):
    """Velocity by stroke / angle, acceleration by stroke / angle^2, jerk by stroke / angle^3."""
    segment = CURVES[name](2.0, 1.5, 0.8)
    found = [np.abs(part).max() for part in segment(np.linspace(0.0, 0.8, 80_001))[1:]]
    assert_allclose(found, np.array(segment.coefficients) * 0.5 / 0.8 ** np.arange(1, 4), rtol=1e-8)


def test_a_dwell_rests():
    assert_allclose(laws.dwell(0.1, 1.0)([0.0, 0.4, 1.0]), [[0.1] * 3, [0.0] * 3, [0.0] * 3, [0.0] * 3])


def test_angle_beyond_a_segment_is_refused():
    segment = laws.cycloidal(0.0, 1.0, 1.0)
    assert segment(1.0 + 1e-13).position == 1.0
    with pytest.raises(ks.ParameterError, match=r"segment: angles must lie from 0 to its 1 rad, got -0\.1 to 0\.5"):
        segment([-0.1, 0.5])


# Rises from 0 to 1

RISES = {name: segment(0.0, 1.0, 1.0).rise for name, segment in SEGMENTS.items()}
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
@every("name", RISES)
def test_rise_integrates_its_textbook_acceleration(name):
    rise = RISES[name]
    with mp.workdps(25):
        expected = np.array([integrated(name, place) for place in PLACES]).T
    assert_allclose(rise(np.array(PLACES))[:3], expected, rtol=0, atol=1e-13)


@every("name", RISES)
def test_peaks_are_the_published_ones(name):
    assert_allclose(RISES[name].coefficients, PUBLISHED[name], rtol=2e-5)


@every("name", RISES)
def test_the_end_of_a_rise_is_as_exact_as_its_start(name):
    """Velocity and acceleration vanish at both ends, and close to the end nothing of its rest is lost."""
    rise = RISES[name]
    start, end = rise(np.array([0.0, 1e-6])), rise(np.array([1.0, 1.0 - 1e-6]))
    assert_allclose(end[1], start[1], rtol=1e-9, atol=1e-300)
    assert end[0][0] == 1.0
    assert start[0][0] == 0.0


@every(
    "name, breaks",
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


@every("name", RISES)
def test_what_is_no_number_has_no_position(name):
    assert np.isnan(RISES[name](np.array([np.nan, np.nan]))).all()
    assert np.isnan(RISES[name](np.array([0.3, np.nan])).position).tolist() == [False, True]
