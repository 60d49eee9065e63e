"""Rounding, kinks and jumps of tables, as bounds need them."""

from fractions import Fraction

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.loads import table_pieces
from kinetostatics.studies.methods.high_precision.enclosures import enclosure


def test_a_steep_last_piece_of_a_table_by_angle_is_off_by_no_more_than_its_rounding():
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


@pytest.mark.parametrize("turns", [1, 2])
@pytest.mark.parametrize("first", [0.0, 0.1, -2.7, -777.3])
def test_no_value_by_angle_is_off_by_more_than_its_rounding(first, turns):
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


def test_kinks_and_jumps_are_told_beside_rows_and_ends_of_strokes_only():
    pump = ks.crank_slider(0.05, 0.2)
    table = ks.Table([0.15, 0.2, 0.25], [-900.0, -500.0, -100.0], over="travel", back=[0.0, 0.0, 0.0], slider="slider")
    s = ks.solve(pump, [0.0, 1.0, np.pi], crank_speed=100.0, loads=ks.ProcessForce(table))
    kinks, jumps, near, distance = table_pieces.kink_bounds(table, s)
    assert np.flatnonzero(jumps).tolist() == [0, 2]
    assert kinks[1] == 0.0
    assert 0.0 < near < 1e-6
    np.testing.assert_allclose(distance, np.min(np.abs(s.slider_position - table.x[:, None]), axis=0), atol=1e-16)


def test_beside_a_row_the_slope_beyond_counts_as_far_as_rounding_reaches(flint):
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


@pytest.mark.parametrize("beside", [0.0, 5e-8, -5e-8])
def test_at_the_end_of_a_stroke_a_table_jumps_by_what_its_ways_differ_there_not_elsewhere(beside):
    """At the inner end both ways are 0; the outer end is a row at which they differ by a peak, or lies just beside."""
    pump = ks.crank_slider(0.05, 0.2)
    x = [0.14, 0.16, 0.24, 0.25 + beside, 0.26, 0.3]
    table = ks.Table(x, [0.0, 0.0, 0.0, -700.0, 0.0, -9e5], over="travel", back=np.zeros(6))
    s = ks.solve(pump, [0.0, np.pi], crank_speed=100.0, loads=ks.ProcessForce(table))
    (outer, inner) = table_pieces.kink_bounds(table, s)[1]
    assert 700.0 <= outer <= 701.0
    assert inner < 1e-8
    assert s.error_bound("B")[0, 1] < 1e-6
