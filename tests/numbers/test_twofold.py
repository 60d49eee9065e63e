"""Numbers in two parts beside exact fractions and enclosures."""

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


def random(seed):
    rng = np.random.default_rng(seed)
    value = rng.uniform(0.1, 3.0, COUNT) * rng.choice((-1.0, 1.0), COUNT) * 10.0 ** rng.uniform(-5, 5, COUNT)
    return Twofold(value, value * rng.uniform(-1, 1, COUNT) * UNIT)


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
def test_results_are_as_near_to_exact_fractions_as_twice_the_digits_allow(name):
    compute, a, b = OPERATIONS[name], random(1), random(2)
    found = compute(a, b)
    for place in range(COUNT):
        truth = compute(exact(a, place), exact(b, place))
        size = max(abs(truth), abs(exact(a, place)), 1)
        assert abs(exact(found, place) - truth) < 32 * UNIT * UNIT * size


def test_a_root_squared_is_the_number():
    number = abs(random(3))
    root = number.sqrt()
    for place in range(COUNT):
        most = Fraction(8 * UNIT * UNIT) * exact(root, place)
        low, high = exact(root, place) - most, exact(root, place) + most
        assert low * low <= exact(number, place) <= high * high


def test_nothing_is_known_of_what_is_to_be_more_than_a_unit_and_is_not():
    near = Twofold(np.array([1e-20, 1.0]), np.zeros(2))
    assert np.isfinite(near.kept_off_zero(1e-3).value).tolist() == [False, True]
    assert Twofold(np.array([-3.0, 2.0]), np.zeros(2)).sign().value.tolist() == [-1.0, 1.0]


def test_sines_and_cosines_are_near_those_of_enclosures(flint):
    """By what bounds on numbers of more digits take them for."""
    rng = np.random.default_rng(4)
    value = np.concatenate([rng.uniform(-7, 7, 400), np.arange(-40, 40) * np.pi / 16, rng.uniform(-1e5, 1e5, 40)])
    number = np.frompyfunc(flint.arb, 1, 1)
    for rest in (None, value * rng.uniform(-1, 1, value.size) * UNIT):
        exact = number(value) + number(0.0 if rest is None else rest)
        most = number(2.0**-63 + (0.0 if rest is None else 2.0**-22 * np.abs(rest)))
        for found, truth in zip(sine_and_cosine(Twofold(value, rest)), (np.sin(exact), np.cos(exact)), strict=True):
            assert np.all(np.abs(number(found.value) + number(found.rest) - truth) < most)


def test_beyond_many_turns_nothing_is_known():
    for found in sine_and_cosine(Twofold(np.array([1.0, 2 * FARTHEST, np.nan]))):
        assert np.isfinite(found.rest).tolist() == [True, False, False]
