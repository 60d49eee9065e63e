"""Laws of the whole turn: a cosine, segments that are joined or do not join, tables."""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks

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


@pytest.mark.parametrize("name", SMOOTH)
def test_rise_dwell_return_runs_through_its_segments_and_repeats(name):
    law = rise_dwell_return(name)
    assert_allclose(law([0.0, 1.0, 2.2, 3.75, 5.5]).position, [1.7, 2.0, 2.3, 2.0, 1.7], rtol=1e-15)
    phi = np.linspace(0.0, TURN, 77)
    assert_allclose(law(phi + 2 * TURN), law(phi), rtol=0, atol=2e-13)
    assert law(1.0).velocity.shape == ()


@pytest.mark.parametrize("name", SMOOTH)
def test_position_velocity_and_acceleration_are_continuous_where_segments_meet(name):
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


def test_a_measured_law_smoothed_by_its_noise_tells_forces_a_hundred_times_better():
    angle = np.linspace(0.0, TURN, 360, endpoint=False)
    exact = laws.cosine(0.3, 2.0)
    rounded = np.round(exact(angle).position, 6)
    with pytest.warns(UserWarning, match="table of a law: 360 points are too coarse or too noisy: x'' is uncertain"):
        rough = laws.table(angle, rounded)
    smooth = laws.table(angle, rounded, noise=1e-6 / np.sqrt(12))
    phi = np.linspace(0.0, TURN, 1000)
    errors = [np.max(np.abs(law(phi).acceleration - exact(phi).acceleration)) / 0.3 for law in (rough, smooth)]
    assert errors[1] < errors[0] / 100
    assert all(error < law.force_error for error, law in zip(errors, (rough, smooth), strict=True))
    assert smooth.shifted(0.1).force_error == smooth.force_error < 0.01


@pytest.mark.parametrize(
    ("segments", "message"),
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
def test_segments_that_do_not_join_are_refused_with_the_place_and_both_numbers(segments, message):
    with pytest.raises(ks.ParameterError, match=message):
        laws.joined(*segments)


def test_a_jump_of_the_acceleration_is_taken_where_it_is_allowed():
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
