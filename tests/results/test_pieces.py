"""Reductions by polynomials between bends: as exact integrals and peaks have them."""

import numpy as np
import pytest

from kinetostatics.results.pieces import Pieces
from kinetostatics.results.reductions import parsed

TURN = 2 * np.pi
BENDS = np.array([[1.0, 1.002, 4.0, np.nan], [2.0, 2.001, 2.002, 5.0]])


def found(text, function, bends=BENDS, angles=192, period=TURN, vector=False):
    output = parsed(text)
    pieces = Pieces.of(bends, period, angles, output.order or 0)
    numbers, rough = pieces.estimated(output, function(pieces.angle), vector)
    assert not rough.any(), text
    return numbers


def spike(angle):
    """A triangle of height 10 between 1 and 1.002 of the first design, 2 and 2.002 of the second; the rest is 0."""
    start = np.array([[1.0], [2.0]])
    top = np.array([[1.002], [2.001]])  # the first falls at once
    rise = np.interp((angle - start) / (top - start), [0.0, 1.0], [0.0, 10.0], left=0.0, right=0.0)
    fall = np.where(start == 2.0, np.interp(angle, [2.001, 2.002], [10.0, 0.0], left=0.0, right=0.0), 0.0)
    return np.where(angle < top, rise, fall)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("largest O", [10.0, 10.0]),
        ("smallest O", [0.0, 0.0]),
        ("range O", [10.0, 10.0]),
        ("largest_absolute O", [10.0, 10.0]),
        ("largest_at O", [1.002, 2.001]),
        ("mean O", [0.01 / TURN, 0.01 / TURN]),
        ("mean_absolute O", [0.01 / TURN, 0.01 / TURN]),
        ("rms O", np.sqrt([100 * 0.002 / 3 / TURN] * 2)),
    ],
)
def test_a_spike_between_two_bends_is_seen_whole(text, expected):
    np.testing.assert_allclose(found(text, spike), expected, rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("largest O", 1.5),
        ("smallest_at O", np.pi),
        ("mean O", 0.5),
        ("mean_absolute O", 1 / 6 + np.sqrt(3) / np.pi),
        ("rms O", np.sqrt(0.75)),
        ("harmonic_1 O", 1.0),
        ("harmonic_0 O", 0.5),
        ("swing balancing_torque", 2.0),
    ],
)
def test_a_wave_has_its_numbers_wherever_it_is_parted(text, expected):
    np.testing.assert_allclose(found(text, lambda angle: 0.5 + np.cos(angle)), expected, rtol=1e-9)


def test_harmonics_are_as_high_as_they_are_asked_for():
    wave = found("harmonic_90 O", lambda angle: np.cos(90 * angle) + np.cos(angle))
    np.testing.assert_allclose(wave, 1.0, rtol=1e-6)


def test_two_turns_are_reduced_over_both():
    bends = np.array([[1.0, 7.0, 9.0]])
    second = lambda angle: np.where((angle > 7.0) & (angle < 9.0), 3.0, 0.0)  # noqa: E731
    assert found("mean O", second, bends, 384, 2 * TURN) == pytest.approx(3.0 / TURN, rel=1e-12)
    assert 7.0 <= found("largest_at O", second, bends, 384, 2 * TURN)[0] <= 9.0


def test_the_magnitude_of_a_vector_that_passes_zero_is_known_there():
    near = lambda angle: np.hypot(np.sin(angle - 2.3456), 1e-4)  # noqa: E731
    assert found("smallest O", near, np.array([[1.0]]), vector=True) == pytest.approx(1e-4, rel=1e-3)


def test_values_that_go_on_otherwise_in_the_next_piece_are_told():
    """A kink between the last node of a piece and its end is seen by none of them."""
    pieces = Pieces.of(np.array([[1.0]]), TURN, 192)
    for beside, doubted in ((-0.002, True), (0.002, True), (0.0, False)):
        values = np.abs(pieces.angle - pieces.start[0, 7] - beside)
        wrap = np.abs(values[0, 0] - values[0, -1])
        kinked = pieces.of_peaks(values, (1.0, -1.0), False)[0, 6:8]
        assert wrap > 1.0
        assert (kinked.max() > 1e-4) == doubted, (beside, kinked)


def test_a_kink_just_before_a_bend_is_told_by_the_step_there():
    """No node lies between a kink and a bend that is near; what jumps there is no sign of it."""
    kink = lambda angle: np.abs(angle - 0.9999) + np.where(angle > 1.0, -2.0 * (angle - 1.0), 0.0)  # noqa: E731
    for jump in (False, True):
        pieces = Pieces.of(np.array([[0.0, 1.0]]), TURN, 192, jumps=np.array([[True, jump]]))
        values = kink(pieces.angle) + np.where(pieces.angle > 1.0, float(jump), 0.0)
        at = np.flatnonzero(pieces.start[0] == 1.0)[0]
        doubts = pieces.of_integrals(values)[0] / pieces.width[0].clip(1e-9) * TURN
        assert (doubts[at - 1] > 1e-4) != jump


def test_nothing_is_joined_at_bends_nor_at_edges_that_rounding_sets_apart_from_them():
    place = np.linspace(0.0, TURN, 25)[3]
    pieces = Pieces.of(np.array([[place + 1e-14, 0.0], [4.0, np.nan]]), TURN, 192)
    real = pieces.width > 0.0
    apart = [start[~joined & real] for start, joined, real in zip(pieces.start, pieces.joined, real, strict=True)]
    np.testing.assert_allclose(apart[0], [0.0, place], rtol=0, atol=1e-12)
    assert apart[1].tolist() == [4.0]


def test_values_that_are_no_polynomial_between_bends_are_told():
    pieces = Pieces.of(np.array([[1.0]]), TURN, 192)
    middle = np.pi / 24  # of the first piece
    for place in (middle, middle + 0.02, 3.0):
        values = np.where(np.abs(pieces.angle - place) < 0.05, 1.0, 0.0)
        for text in ("largest O", "range O", "mean O"):
            assert pieces.estimated(parsed(text), values)[1].all(), (place, text)


def test_a_design_with_what_is_no_number_spoils_no_other():
    pieces = Pieces.of(BENDS, TURN, 192)
    values = np.cos(pieces.angle)
    values[0, 5] = np.nan
    for text in ("largest O", "range O", "mean_absolute O", "swing balancing_torque"):
        numbers, _ = pieces.estimated(parsed(text), values)
        assert np.isnan(numbers[0])
        assert np.isfinite(numbers[1])


def test_a_jump_between_a_bend_and_an_even_edge_that_rounding_sets_apart_is_no_peak():
    place = np.linspace(0.0, TURN, 25)[3]
    step = lambda angle: np.where(angle > place, 3.0, 1.0)  # noqa: E731
    for beside in (np.nextafter(place, 9.0), place + 1e-14):
        bends = np.array([[beside, 4.0, 0.0], [beside, np.nan, TURN]])
        for text, expected in {"largest O": 3.0, "smallest O": 1.0, "range O": 2.0}.items():
            assert found(text, step, bends) == pytest.approx(expected, rel=1e-14), text
            assert found(text, step, bends, vector=True) == pytest.approx(expected, rel=1e-14), text


def test_no_value_is_taken_at_a_bend_nor_where_a_design_has_fewer():
    pieces = Pieces.of(np.array([[1.0, 1.0, 4.0], [2.0, np.nan, np.nan]]), TURN, 192)
    assert not np.isin(pieces.angle, [0.0, 1.0, 2.0, 4.0, *np.linspace(0.0, TURN, 25)]).any()
    np.testing.assert_allclose(pieces.width.sum(axis=1), TURN, rtol=1e-15)
