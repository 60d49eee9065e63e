"""Numbers in two parts beside exact fractions and enclosures, and their bounds."""

from fractions import Fraction

import numpy as np

from kinetostatics.numbers.elementary import UNIT
from kinetostatics.numbers.twofold import FARTHEST, Twofold, sine_and_cosine
from support.every import every

COUNT = 300


def exact(found, place):
    """Both parts of one of the numbers together."""
    rest = 0.0 if found.rest is None else np.broadcast_to(found.rest, np.shape(found.value))[place]
    return Fraction(float(found.value[place])) + Fraction(float(rest))


def random(seed, bounded=True):
    rng = np.random.default_rng(seed)
    value = rng.uniform(0.1, 3.0, COUNT) * rng.choice((-1.0, 1.0), COUNT) * 10.0 ** rng.uniform(-5, 5, COUNT)
    return Twofold(value, value * rng.uniform(-1, 1, COUNT) * UNIT, np.zeros(COUNT) if bounded else None)


OPERATIONS = {
    "sum": lambda a, b: a + b,
    "difference": lambda a, b: a - b,
    "what cancels": lambda a, b: (a + b) - a,
    "product": lambda a, b: a * b,
    "quotient": lambda a, b: a / b,
    "plain numbers on the left": lambda a, b: 3 - (2 + a) * 7 * b,
    "magnitude": lambda a, b: abs(a) - -b,
}


@every("name", OPERATIONS)
def test_results_are_within_their_bounds_of_exact_fractions_and_these_are_small(name):
    compute, a, b = OPERATIONS[name], random(1), random(2)
    found = compute(a, b)
    for place in range(COUNT):
        truth = compute(exact(a, place), exact(b, place))
        assert abs(exact(found, place) - truth) <= Fraction(float(found.error[place]))
        size = max(abs(truth), abs(exact(a, place)), 1)
        assert found.error[place] < 100 * UNIT * UNIT * size


@every("name", OPERATIONS)
def test_without_bounds_the_parts_are_the_same(name):
    bounded, plain = (OPERATIONS[name](random(1, way), random(2, way)) for way in (True, False))
    assert plain.error is None
    np.testing.assert_array_equal(plain.value, bounded.value)
    np.testing.assert_array_equal(plain.rest, bounded.rest)


def test_a_root_squared_is_the_number():
    number = abs(random(3))
    root = number.sqrt()
    for place in range(COUNT):
        most = Fraction(float(root.error[place]))
        low, high = exact(root, place) - most, exact(root, place) + most
        assert low * low <= exact(number, place) <= high * high
        assert most < 100 * UNIT * UNIT * exact(root, place)


def test_nothing_is_known_of_roots_and_quotients_of_what_may_be_zero():
    near = Twofold(np.array([1e-20, 1.0]), np.zeros(2), np.array([1e-19, 0.0]))
    assert np.isfinite(near.sqrt().error).tolist() == [False, True]
    assert np.isfinite((Twofold(np.ones(2), None, 0.0) / near).error).tolist() == [False, True]
    assert near.sign().error.tolist() == [np.inf, 0.0]
    assert near.kept_off_zero(1e-3).error.tolist() == [np.inf, 0.0]


def test_sines_and_cosines_are_within_their_bounds_of_enclosures(flint):
    rng = np.random.default_rng(4)
    value = np.concatenate([rng.uniform(-7, 7, 200), np.arange(-40, 40) * np.pi / 16, rng.uniform(-1e5, 1e5, 40)])
    rest = value * rng.uniform(-1, 1, value.size) * UNIT
    number = np.frompyfunc(flint.arb, 1, 1)
    for angle in (Twofold(value, None, 0.0), Twofold(value, rest, 0.0)):
        exact = number(value) + number(0.0 if angle.rest is None else rest)
        for found, truth in zip(sine_and_cosine(angle), (np.sin(exact), np.cos(exact)), strict=True):
            off = np.abs(number(found.value) + number(found.rest) - truth)
            assert np.all(off < number(found.error))
            assert found.error[:200].max() < 2.0**-62
            assert found.error.max() < 2.0**-59


def test_beyond_many_turns_nothing_is_known():
    for found in sine_and_cosine(Twofold(np.array([1.0, 2 * FARTHEST, np.nan]), None, 0.0)):
        assert np.isfinite(found.error).tolist() == [True, False, False]
        assert np.isfinite(found.rest).tolist() == [True, False, False]
