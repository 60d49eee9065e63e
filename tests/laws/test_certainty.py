"""Condition, warning and proven bound tell the same of every machine: none is sure where another is not."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import NotGivenError
from kinetostatics.machine.friction import NO_FRICTION
from kinetostatics.mechanics.assembly import HALF_DIGITS_CONDITION, NO_DIGITS_CONDITION
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from support.bounded import FAMILIES, solution
from support.case_files import shipped, unlike_variants
from support.every import every

LOOSE = 1000.0
"""How many times more than condition times rounding a bound may be: it has every operation on its worst side."""


def size(parts):
    return np.abs(parts[0]) if len(parts) == 1 else np.hypot(*parts)


def looked_at(made):
    """Error bound, relative to the largest value, and condition of each force at the angles where any digit is left."""
    for quantity in made.mechanism.outputs:
        with np.errstate(all="ignore"):
            largest = np.nanmax(size(components(made, quantity)))
            bound = size(np.atleast_2d(made.error_bound(quantity))) / largest
            condition = made.condition_of(quantity)
        left = (condition < NO_DIGITS_CONDITION) & np.isfinite(bound)
        if largest > 0 and left.any():
            yield quantity, bound[left], condition[left]


def warned(made):
    """Whether solving again warns of lost digits."""
    with warnings.catch_warnings(record=True) as caught, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        given = {"crank_speed": made.crank_speed, "crank_acceleration": made.crank_acceleration}
        ks.solve(made.mechanism, made.crank_angle, **given, on_gap="nan")
    return any("correct digits" in str(warning.message) for warning in caught)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("family", FAMILIES)
@every("seed", range(1))
def test_where_a_bound_is_wide_the_condition_is_large(family, seed):
    made = solution(family, seed)
    for _, bound, condition in looked_at(made) if made is not None else ():
        assert np.all(bound <= LOOSE * UNIT_ROUNDOFF * condition)


def without_bound(made):
    """Condition of each force at the angles where it has a value and no bound."""
    for quantity in made.mechanism.outputs:
        with np.errstate(all="ignore"):
            bound, condition = np.atleast_2d(made.error_bound(quantity)), made.condition_of(quantity)
            values = size(components(made, quantity))
        yield condition[np.isfinite(values) & ~np.isfinite(bound).all(axis=0)]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("family", FAMILIES)
def test_bounds_exist_unless_half_the_digits_are_lost(family):
    made = solution(family, 1000)
    for condition in without_bound(made) if made is not None else ():
        assert np.all(condition > HALF_DIGITS_CONDITION)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("case", ks.shipped_cases())
def test_condition_claims_no_unproven_digits(case):
    for variant in unlike_variants(case):
        made = shipped(case).variants[variant].scene.solve(np.linspace(0.01, 6.27, 40), on_gap="nan")
        for quantity, bound, condition in looked_at(made):
            assert np.all(bound <= LOOSE * UNIT_ROUNDOFF * condition), quantity
        assert all(np.all(condition > HALF_DIGITS_CONDITION) for condition in without_bound(made))


@pytest.mark.slow
@every("family", ("chain", "plain", "four-bar", "place"))
@every("seed", range(8))
def test_warnings_match_large_conditions(family, seed):
    made = solution(family, seed)
    if made is not None:
        with np.errstate(all="ignore"):
            condition = replace(made, loads=(), friction=NO_FRICTION).condition
        assert warned(made) == bool(np.any(condition > HALF_DIGITS_CONDITION))


@pytest.mark.slow
@every("family", ("plain", "four-bar", "place", "cam"))
@every("seed", range(2))
def test_errors_stay_below_condition_times_rounding(flint, family, seed):
    made = solution(family, seed)
    for quantity, _, condition in looked_at(made) if made is not None else ():
        try:
            reference = ks.precision.enclosure(made, quantity, digits=20)
        except NotGivenError:  # a table in double precision, or a quantity that is zero
            continue
        error = ks.precision.relative_errors(components(made, quantity), reference)
        assert np.nanmax(error) <= UNIT_ROUNDOFF * np.max(condition)
