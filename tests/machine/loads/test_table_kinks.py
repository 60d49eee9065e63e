"""Tables of loads: kinks, the angles at which rows are crossed, and rounding."""

from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.links import Joint
from kinetostatics.machine.loads import table_pieces
from kinetostatics.machine.loads.table_pieces import KINK_TOLERANCE, STOP_SAMPLES, TURN, kink_rows, stops_and_crossings
from kinetostatics.numbers.sign_changes import SAMPLE_OFFSET
from kinetostatics.studies.methods.high_precision.enclosures import enclosure
from support.every import every

FULL_TURN = 2 * np.pi
FINE = np.linspace(0.1, 0.3, 1101)
UNEVEN = 0.1 + 5.0 * (FINE - 0.1) ** 2


def gas(x):
    return -4e3 * (0.03 / (x - 0.07)) ** 1.3


def along(x, y, back=None):
    return ks.Table(x, y, over="travel", back=back)


def waves(count, start=0.0):
    x = start + np.linspace(0.0, FULL_TURN, count, endpoint=False)
    return x, 2e3 * np.exp(np.cos(x - 0.7)) + 300.0 * np.sin(3.0 * x)


SMOOTH = {
    "along": along(FINE, gas(FINE)),
    "around": ks.Table(*waves(1100)),
    "uneven": along(UNEVEN, gas(UNEVEN)),
    "rounded": along(FINE, np.round(gas(FINE), 2)),
    "line": along([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]),
    "line with rows close together": along([0.1, 0.2, 0.2 + 1e-7, 0.2 + 2e-7, 0.3], np.full(5, 7.0)),
    "nothing": along(FINE, 0.0 * FINE),
    "two turns": ks.Table(2.0 * waves(2200)[0], waves(2200)[1], period=2 * FULL_TURN),
}


@every("name", SMOOTH)
def test_fine_rows_of_a_smooth_curve_bend_nothing(name):
    assert not SMOOTH[name].is_bent(KINK_TOLERANCE)
    assert SMOOTH[name].is_bent(0.0)


SHARP = {
    "kink": (np.abs(FINE - 0.2) * 1e4, [550]),
    "jump": (gas(FINE) + 1e3 * (FINE > 0.2), [550, 551]),
    "spike of a row": (gas(FINE) + 1e3 * (np.arange(1101) == 300), [299, 300, 301]),
    "small spike": (gas(FINE) + 1.0 * (np.arange(1101) == 300), [299, 300, 301]),
    "kink near an end": (gas(FINE) + 1e6 * np.maximum(0.0, 0.101 - FINE), [5, 6]),
}


@every("name", SHARP)
def test_kinks_jumps_and_spikes_among_fine_rows_stay(name):
    y, expected = SHARP[name]
    found = kink_rows(along(FINE, y))
    assert found.size <= 5
    assert all(np.abs(found - row).min() <= 1 for row in expected), found
    assert np.array_equal(found, kink_rows(along(FINE, 0.0 * FINE + 1.0, y)))  # also where the other stroke is smooth


@every("width", [1e-9, 1e-6, 1e-3])
@every("height", [1.0, 0.01])
def test_no_spike_of_three_rows_passes_as_a_parabola(width, height):
    x = np.sort(np.append(np.linspace(0.1, 0.3, 4), [0.2, 0.2 + width, 0.2 + 2 * width]))
    y = 1.0 + height * (x == 0.2 + width)
    assert kink_rows(along(x, y)).tolist() == [2, 3, 4]


def test_a_narrow_smooth_bump_is_split():
    x = np.linspace(0.1, 0.3, 20_001)
    found = x[kink_rows(along(x, np.exp(-(((x - 0.2) / 3e-3) ** 2))))]
    assert 4 < found.size < 20
    assert np.abs(found - 0.2).max() < 0.015


@pytest.mark.slow
@every("seed", range(4))
def test_between_bends_a_table_is_polynomial(seed):
    rng = np.random.default_rng(seed)
    x = np.sort(np.append(rng.uniform(0.1, 0.3, 400), [0.1, 0.3]))
    y = gas(x) + 10.0 ** rng.uniform(-1, 3) * np.cumsum(rng.standard_normal(x.size) * (rng.random(x.size) < 0.05))
    kept = [0, *kink_rows(along(x, y)), x.size - 1]
    for low, high in pairwise(kept):
        if x[high] - x[low] < 0.2 / 32:  # longer ones may be several polynomials
            at = np.linspace(x[low], x[high], 300)
            fit = np.polynomial.Chebyshev.fit(at, np.interp(at, x, y), 7)
            assert np.abs(fit(at) - np.interp(at, x, y)).max() < 2 * KINK_TOLERANCE * np.abs(y).max()


# Where sliders stand still and pass places


def motion(crank=0.05, offset=0.01):
    return ks.solve(ks.crank_slider(crank, 0.19, guide_offset=offset), np.zeros(1), crank_speed=1.0, on_gap="nan")


def travel(solved, angle):
    return solved.mechanism.place(angle).travels["slider"]


def test_levels_are_passed_twice_a_turn():
    solved, levels = motion(), np.linspace(0.15, 0.22, 7)
    stops, passed = stops_and_crossings(solved, "slider", levels)
    assert stops.shape == (1, 2)
    assert passed.shape == (1, 14)
    assert np.abs(travel(solved, stops).first).max() < 1e-15
    np.testing.assert_allclose(np.sort(travel(solved, passed).position[0]), np.repeat(levels, 2), rtol=0, atol=1e-15)


def test_level_near_a_stop_is_passed_to_and_fro():
    solved = motion()
    stops, _ = stops_and_crossings(solved, "slider", np.array([0.2]))
    farthest = travel(solved, stops).position.max()
    for depth in (1e-5, 1e-9, 1e-13):
        _, passed = stops_and_crossings(solved, "slider", np.array([farthest - depth]))
        assert passed.shape == (1, 2)
        np.testing.assert_allclose(travel(solved, passed).position, farthest - depth, rtol=0, atol=1e-16)


def test_designs_pass_the_levels_in_their_stroke():
    crank = np.array([[0.01], [0.03], [0.05]])
    levels = np.linspace(0.14, 0.24, 11)
    stops, passed = stops_and_crossings(motion(crank), "slider", levels)
    assert stops.shape == (3, 2)
    for row, length in enumerate(crank[:, 0]):
        alone = np.sort(stops_and_crossings(motion(length), "slider", levels)[1][0])
        np.testing.assert_allclose(np.sort(passed[row])[: alone.size], alone, rtol=0, atol=1e-14)
        assert np.isnan(np.sort(passed[row])[alone.size :]).all()


@every("way", [1, -1])
def test_stop_exactly_at_a_sample_is_found(way):
    stop = (SAMPLE_OFFSET + np.linspace(0.0, TURN, STOP_SAMPLES + 1))[100]

    def place(angle):
        cosine, sine = (way * part(angle - stop) for part in (np.cos, np.sin))
        return SimpleNamespace(travels={"slider": Joint(cosine, -sine, -cosine)})

    stops, _ = stops_and_crossings(
        SimpleNamespace(mechanism=SimpleNamespace(turns=1, place=place)), "slider", np.zeros(1)
    )
    np.testing.assert_allclose(np.sort(stops[0]), np.sort(np.mod([stop, stop + np.pi], TURN)), rtol=0, atol=1e-12)


def test_what_does_not_close_passes_nothing_there():
    stops, passed = stops_and_crossings(motion(0.25, 0.0), "slider", np.array([0.3]))
    assert np.isfinite(passed).sum() == 2
    assert np.isfinite(stops).sum() <= 2


# Rounding, kinks and jumps of tables, as bounds need them


def test_a_steep_last_piece_is_within_its_rounding():
    """Where the first row is not at 0, the end of the last piece is rounded."""
    first, last = 0.1, 6.37
    table = ks.Table([first, 1.0, last], [0.0, 500.0, 1000.0])
    angles = np.linspace(last, first + 2 * np.pi, 9)[1:-1]
    motion = ks.solve(ks.crank_slider(0.05, 0.2), angles, crank_speed=100.0, loads=ks.ProcessForce(table))
    end = Fraction(first) + Fraction(2 * np.pi)
    share = [(Fraction(angle) - Fraction(last)) / (end - Fraction(last)) for angle in motion.crank_angle]
    error = [
        abs(float(Fraction(float(value)) - 1000 * (1 - part))) for value, part in zip(table(motion), share, strict=True)
    ]
    assert np.all(error <= table_pieces.rounding_bound(table, motion))


def exactly(table, angle):
    """Value of a table by angle, in rational numbers."""
    x, y, period = [*map(Fraction, table.x)], [*map(Fraction, table.y)], Fraction(table.period)
    x, y, place = [*x, x[0] + period], [*y, y[0]], Fraction(angle)
    place -= (place - x[0]) // period * period
    row = max(row for row in range(len(x) - 1) if x[row] <= place)
    return y[row] + (y[row + 1] - y[row]) / (x[row + 1] - x[row]) * (place - x[row])


@pytest.mark.slow
@every("first, turns", [(0.0, 1), (0.1, 2), (-2.7, 1), (-777.3, 2)])
def test_values_by_angle_lie_within_their_rounding(first, turns):
    rng, period = np.random.default_rng(7), 2 * np.pi * turns
    for _ in range(8):
        x = first + period / 20 * (np.arange(20) + rng.uniform(0.0, 0.9, 20) * (np.arange(20) > 0))
        table = ks.Table(x, rng.choice([-1e3, 0.0, 700.0, *rng.uniform(-5, 5, 3)], 20), period=period)
        angles = np.concatenate([rng.uniform(first, first + period, 40), rng.uniform(-50, 50, 20), x, x - period])
        force = ks.ProcessForce(table, period=period)
        motion = ks.solve(ks.crank_slider(0.05, 0.2), angles, crank_speed=100.0, loads=force)
        bound = table_pieces.rounding_bound(table, motion)
        for angle, value, most in zip(angles, table(motion), bound, strict=True):
            assert abs(Fraction(float(value)) - exactly(table, angle)) <= Fraction(most)


def test_pieces_of_a_table_are_exact_in_exact_numbers():
    """Slopes among them, so that an enclosure holds what the rows say."""
    number = np.frompyfunc(Fraction, 1, 1)
    by_angle = ks.Table([0.1, 0.7, 3.0, 4.0], [0.1, 0.7, -0.3, 1e-3])
    rows = [0.14, 0.19, 0.26], [0.1, 0.7, -0.3]
    by_travel = ks.Table(*rows, over="travel", back=[0.3, 0.1, 0.9], slider="slider")
    motion = ks.solve(ks.crank_slider(0.05, 0.2), [0.3, 2.0, 3.5, 6.0, -20.0], crank_speed=1.0)
    start, value, slope = by_angle.pieces(motion, number)
    found = value + slope * (number(motion.crank_angle) - start)
    assert found.tolist() == [exactly(by_angle, angle) for angle in motion.crank_angle]
    start, value, slope = by_travel.pieces(motion, number)
    for column, back in enumerate(by_travel.returns(motion)):
        y = [*map(Fraction, by_travel.back if back else by_travel.y)]
        row = [*map(Fraction, by_travel.x)].index(start[column])
        assert value[column] == y[row]
        assert slope[column] == (y[row + 1] - y[row]) / (Fraction(rows[0][row + 1]) - Fraction(rows[0][row]))


def test_on_level_pieces_of_a_table_nothing_is_rounded():
    table = ks.Table([0.0, 1.0, 3.0, 4.0], [0.3, 0.3, 0.7, 0.7])
    motion = ks.solve(ks.crank_slider(0.05, 0.2), [0.5, 2.0, 3.5], crank_speed=1.0, loads=ks.ProcessForce(table))
    level, rising, other = table_pieces.rounding_bound(table, motion)
    assert 0.0 < max(level, other) < 1e-290
    assert 1e-16 < rising < 6e-16


def test_kinks_and_jumps_stand_at_rows_and_ends_only():
    pump = ks.crank_slider(0.05, 0.2)
    table = ks.Table([0.15, 0.2, 0.25], [-900.0, -500.0, -100.0], over="travel", back=[0.0, 0.0, 0.0], slider="slider")
    s = ks.solve(pump, [0.0, 1.0, np.pi], crank_speed=100.0, loads=ks.ProcessForce(table))
    kinks, jumps, near, distance = table_pieces.kink_bounds(table, s)
    assert np.flatnonzero(jumps).tolist() == [0, 2]
    assert kinks[1] == 0.0
    assert 0.0 < near < 1e-6
    np.testing.assert_allclose(distance, np.min(np.abs(s.slider_position - table.x[:, None]), axis=0), atol=1e-16)


def test_beside_a_row_the_next_slope_counts(flint):
    """Where the travel rounded lies before a kink, and the exact one behind it, or the other way round."""
    pump, angle = ks.crank_slider(0.05, 0.2), 1.1
    row = float(ks.solve(pump, angle, crank_speed=1.0).slider_position)
    force = ks.ProcessForce(ks.Table([0.14, row, 0.26], [0.0, 0.0, 7e4], over="travel"))
    near = angle + np.spacing(angle) * np.arange(-20, 21)
    s = ks.solve(pump, np.append(near, angle + 1e-12), crank_speed=1.0, loads=force)
    (travel,) = enclosure(s, "slider_position").exact
    exact = [max(0.0, 7e4 * float(part - row) / (0.26 - row)) for part in travel]
    error, bound = np.abs(np.abs(s.reaction("B")[0]) - exact), s.error_bound("B")[0]
    assert np.all(error <= bound)
    assert np.max(error) > 1e-12
    assert bound[-1] < 1e-200


@every("beside", [0.0, 5e-8, -5e-8])
def test_at_the_end_of_a_stroke_a_table_jumps(beside):
    """At the inner end both ways are 0; the outer end is a row at which they differ by a peak, or lies just beside."""
    pump = ks.crank_slider(0.05, 0.2)
    x = [0.14, 0.16, 0.24, 0.25 + beside, 0.26, 0.3]
    table = ks.Table(x, [0.0, 0.0, 0.0, -700.0, 0.0, -9e5], over="travel", back=np.zeros(6))
    s = ks.solve(pump, [0.0, np.pi], crank_speed=100.0, loads=ks.ProcessForce(table))
    (outer, inner) = table_pieces.kink_bounds(table, s)[1]
    assert 700.0 <= outer <= 701.0
    assert inner < 1e-8
    assert s.error_bound("B")[0, 1] < 1e-6
