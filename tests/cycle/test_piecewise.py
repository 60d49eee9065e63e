"""Smooth pieces of a turn between kinks and jumps."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.kinks import design_kinks, has_kinks
from kinetostatics.cycle.piecewise import MAX_UNRESOLVED, Pieces
from kinetostatics.cycle.piecewise_reductions import MAX_OUTPUT_ERROR, averaged, estimated, resolved, values_key
from kinetostatics.cycle.reductions import parsed
from support.every import every

TURN = 2 * np.pi
BREAKS = np.array([[1.0, 1.002, 4.0, np.nan], [2.0, 2.001, 2.002, 5.0]])


WIDTH = TURN / 24


def on_pieces(output, function, breaks, width=WIDTH, period=TURN, vector=False):
    """Numbers of an output, and whether they are uncertain, on pieces between breaks that are not halved."""
    pieces = Pieces.between(breaks, period, min(width, TURN / (2 * (output.order or 0) or 1)), 10)
    values = function(pieces.check_angles, pieces.owner)
    return estimated(pieces, output, values**2 if values_key(output, {output.quantity: vector})[1] else values, vector)


def found(text, function, breaks=BREAKS, period=TURN, vector=False):
    numbers, rough = on_pieces(parsed(text), function, breaks, period=period, vector=vector)
    assert not rough.any(), text
    return numbers


def spike(angle, design):
    """A triangle of height 10 between 1 and 1.002 of the first design, 2 and 2.002 of the second; the rest is 0."""
    start = np.array([[1.0], [2.0]])[design]
    top = np.array([[1.002], [2.001]])[design]  # the first falls at once
    rise = np.interp((angle - start) / (top - start), [0.0, 1.0], [0.0, 10.0], left=0.0, right=0.0)
    fall = np.where(start == 2.0, np.interp(angle, [2.001, 2.002], [10.0, 0.0], left=0.0, right=0.0), 0.0)
    return np.where(angle < top, rise, fall)


@every(
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
def test_a_spike_between_two_breaks_is_seen_whole(text, expected):
    np.testing.assert_allclose(found(text, spike), expected, rtol=1e-12, atol=1e-11)


@every(
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
    np.testing.assert_allclose(found(text, lambda angle, _: 0.5 + np.cos(angle)), expected, rtol=1e-9)


def test_harmonics_are_as_high_as_they_are_asked_for():
    wave = found("harmonic_90 O", lambda angle, _: np.cos(90 * angle) + np.cos(angle))
    np.testing.assert_allclose(wave, 1.0, rtol=1e-6)


def test_two_turns_are_reduced_over_both():
    breaks = np.array([[1.0, 7.0, 9.0]])
    second = lambda angle, _: np.where((angle > 7.0) & (angle < 9.0), 3.0, 0.0)  # noqa: E731
    assert found("mean O", second, breaks, 2 * TURN) == pytest.approx(3.0 / TURN, rel=1e-12)
    assert 7.0 <= found("largest_at O", second, breaks, 2 * TURN)[0] <= 9.0


def test_vector_magnitude_near_zero_is_right():
    near = lambda angle, _: np.hypot(np.sin(angle - 2.3456), 1e-4)  # noqa: E731
    assert found("smallest O", near, np.array([[1.0]]), vector=True) == pytest.approx(1e-4, rel=1e-3)


def test_a_kink_beyond_the_last_point_of_a_piece_is_reported():
    pieces = Pieces.between(np.array([[1.0]]), TURN, WIDTH, 10)
    for beside, doubted in ((-0.0002, True), (0.0002, True), (0.0, False)):
        values = np.abs(pieces.check_angles - pieces.low[7] - beside)
        assert (pieces.errors(values)[6:8].max() > 1e-5) == doubted, beside


def test_a_kink_just_before_a_break_is_found():
    """No point lies between the two; what jumps at the break is no sign of it."""
    kink = lambda angle: np.abs(angle - 0.9999) + np.where(angle > 1.0, -2.0 * (angle - 1.0), 0.0)  # noqa: E731
    for jump in (False, True):
        pieces = Pieces.between(np.array([[1.0]]), TURN, WIDTH, 10)
        values = kink(pieces.check_angles) + np.where(pieces.check_angles > 1.0, float(jump), 0.0)
        at = np.flatnonzero(pieces.low == 1.0)[0]
        assert pieces.errors(values)[at - 1] > 1e-5
        assert pieces.errors(values)[at] < 1e-14


def test_pieces_without_a_polynomial_are_reported():
    for place in (np.pi / 24, np.pi / 24 + 0.02, 3.0):  # first in the middle of the first piece
        pulse = lambda angle, _, place=place: np.where(np.abs(angle - place) < 0.05, 1.0, 0.0)  # noqa: E731
        for text in ("largest O", "range O", "mean O"):
            assert on_pieces(parsed(text), pulse, np.array([[1.0]]))[1].all(), (place, text)


@every("count", [8, 11, 12, 16])
def test_size_of_a_function_that_is_zero_at_the_ends_of_pieces_is_right(count):
    for number in range(2, 24):  # rounding gives the value at an end either sign, or 0
        pieces = Pieces(np.linspace(0.0, TURN, number + 1), count)
        place, factor = (pieces.angle - pieces.middle[:, None]) / pieces.half, np.cbrt(np.arange(1.0, number + 1.0))
        values = factor[:, None] * (1.0 - place**2) * (place + 0.3)
        size = averaged(pieces, parsed("mean_absolute O"), values)[0]
        assert size == pytest.approx(factor.mean() * 0.58865 / 2.0, rel=1e-12)


def test_nan_in_one_design_spoils_no_other():
    def waves(angle, design):
        values = np.cos(angle)
        values[0, 5] = np.nan
        return values

    for text in ("largest O", "range O", "mean_absolute O", "swing balancing_torque"):
        numbers, _ = on_pieces(parsed(text), waves, BREAKS)
        assert np.isnan(numbers[0])
        assert np.isfinite(numbers[1])


def test_jump_between_bend_and_edge_is_no_peak():
    place = np.linspace(0.0, TURN, 25)[3]
    step = lambda angle, _: np.where(angle > place, 3.0, 1.0)  # noqa: E731
    for beside in (np.nextafter(place, 9.0), place + 1e-14):
        breaks = np.array([[beside, 4.0, 0.0], [beside, np.nan, TURN]])
        for text, expected in {"largest O": 3.0, "smallest O": 1.0, "range O": 2.0}.items():
            assert found(text, step, breaks) == pytest.approx(expected, rel=1e-14), text
            assert found(text, step, breaks, vector=True) == pytest.approx(expected, rel=1e-14), text


# Pieces halved until they tell an output


PLACE = np.array([[1.2345], [3.2109], [5.0]])


def run(text, function, count=3, vector=False, goal=MAX_OUTPUT_ERROR):
    """Numbers of designs, whether they are rough, and how many pieces each has."""
    output = parsed(text)
    pieces = Pieces.between(np.full((count, 1), np.nan), TURN, WIDTH, 10)
    evaluate = lambda angle, designs: {output.quantity: function(angle, designs)}  # noqa: E731
    pieces, values = resolved(pieces, [output], {output.quantity: vector}, evaluate, goal)
    return *estimated(pieces, output, *values.values(), vector), pieces.sums(np.ones(len(pieces.half)))


def hyperbola(width):
    """What friction does where a reaction passes near zero: a size that turns about within so wide an angle."""
    return lambda angle, designs: 1.0 + np.hypot(2.0 * np.sin(0.5 * (angle - PLACE[designs])), width)


@pytest.mark.slow
@every("width", [0.0, 1e-9, 1e-6, 1e-4, 1e-2])
@every("text", ["smallest O", "largest O", "mean O", "smallest_at O", "rms O", "range O"])
def test_size_passing_near_zero_is_found(text, width):
    numbers, rough, pieces = run(text, hyperbola(width))
    high, angle = np.hypot(2.0, width), np.linspace(0.0, TURN, 7)
    fine = np.sort(np.concatenate([[0.0], np.ravel([TURN * 2.0**-k for k in range(45)]), angle[1:-1]]))
    share, weights = np.polynomial.legendre.leggauss(40)
    nodes = fine[:-1, None] + 0.5 * np.diff(fine)[:, None] * (1.0 + share)
    values = 1.0 + np.hypot(2.0 * np.sin(0.5 * nodes), width)
    mean, square = (0.5 * np.sum(np.diff(fine) * (part @ weights)) / TURN for part in (values, values**2))
    truth = {
        "smallest O": 1.0 + width,
        "largest O": 1.0 + high,
        "mean O": mean,
        "rms O": np.sqrt(square),
        "range O": high - width,
        "smallest_at O": PLACE[:, 0],
    }[text]
    assert not rough.any()
    np.testing.assert_allclose(numbers, truth, rtol=0, atol=(1e-6 if text.endswith("_at") else 1e-7))
    assert pieces.max() < 150


def test_undeclared_jump_is_seen_from_both_sides():
    step = lambda angle, designs: np.where((angle > 1.0) & (angle < PLACE[designs]), 2.0, 0.5)  # noqa: E731
    for text, truth in {"largest O": 2.0, "smallest O": 0.5, "range O": 1.5}.items():
        numbers, rough, _ = run(text, step)
        assert not rough.any()
        np.testing.assert_allclose(numbers, truth, rtol=2e-14)
    numbers, rough, _ = run("mean O", step)
    assert not rough.any()
    np.testing.assert_allclose(numbers, 0.5 + 1.5 * (PLACE[:, 0] - 1.0) / TURN, rtol=0, atol=1e-8)


def test_where_everything_breaks_it_is_said():
    rough_one = lambda angle, designs: np.sin(3e5 * angle) + 0.0 * PLACE[designs]  # noqa: E731
    _, rough, pieces = run("mean_absolute O", rough_one)
    _, peak, _ = run("largest O", rough_one)
    assert rough.all()
    assert peak.all()
    assert pieces.max() <= 48 + 2 * MAX_UNRESOLVED


# Where loads and friction of designs bend


def solved(loads=(), friction=None, crank=0.05, offset=0.01):
    pump = ks.crank_slider(crank, 0.19, guide_offset=offset, slider=ks.Link(1.0))
    return ks.solve(pump, np.zeros(1), crank_speed=30.0, loads=loads, friction=friction)


@pytest.mark.slow
def test_smooth_rows_bend_only_at_fine_tolerance():
    x = np.linspace(0.1, 0.3, 1100)
    one, other = (ks.ProcessForce(ks.Table(x, np.sin(20.0 * x), over="travel", back=back)) for back in (None, -x))
    assert not has_kinks(solved([one]), "O")
    assert has_kinks(solved([one]), "O", 1e-9)
    assert design_kinks(solved([one]), 1e-9)[0].shape[1] > 500
    assert design_kinks(solved([one, other]))[0].shape[1] == 2  # where strokes that differ may jump


def test_angle_table_breaks_in_every_turn():
    x = np.arange(0.0, 6.1, 0.5)
    twice = ks.Torque(ks.Table(x, np.interp(x, [0.0, 1.0, 2.0, 6.0], [0.0, 1.0, 0.0, 0.0])), on="crank")
    four = ks.ProcessForce(ks.Table(np.linspace(0, 4 * np.pi, 9), np.zeros(9), period=4 * np.pi), period=4 * np.pi)
    at = np.unique(design_kinks(solved([twice, four]))[0])
    assert {0.0, 1.0, 2.0, 2 * np.pi, 1.0 + 2 * np.pi, 2.0 + 2 * np.pi} <= set(at)


def test_no_bend_lies_beyond_thirteen_turns():
    once = ks.Torque(ks.Table([0.0, 1.0, 2.0, 6.0], [0.0, 1.0, 0.0, 0.0]), on="crank")
    long = ks.ProcessForce(ks.Table(np.linspace(0, 26 * np.pi, 9), np.zeros(9), period=26 * np.pi), period=26 * np.pi)
    s = solved([once, long])
    at = design_kinks(s)[0]
    assert np.nanmax(at) < s.period
    assert np.sum(np.isclose(at % (2 * np.pi), 1.0)) == 13


def test_friction_of_designs_breaks_as_alone():
    friction, crank = {"guide": ks.GuideFriction(0.1), "B": ks.PinFriction(0.1, 0.02)}, np.array([[0.03], [0.05]])
    both = np.sort(design_kinks(solved((), friction, crank))[0], axis=1)
    for row, length in zip(both, crank[:, 0], strict=True):
        alone = np.sort(design_kinks(solved((), friction, float(length)))[0][0])
        np.testing.assert_allclose(row[: alone.size], alone, rtol=0, atol=1e-12)
