"""What is usual of a number by its rule, or by its unit."""

import math

from kinetostatics.numbers import checks


def test_angles_are_within_a_turn_and_lengths_are_those_of_the_machine():
    angle, length = (checks.usual_of(checks.Number(unit)) for unit in ("rad", "m"))
    assert not angle.in_links
    assert 2.0 * math.pi <= angle.most < 6.2832
    assert length.in_links
    assert checks.usual_of(checks.Number("kg")) is None


def test_a_rule_of_its_own_comes_before_that_of_the_unit():
    own = checks.Usual(1.0, "is it in mm?")
    assert checks.usual_of(checks.Number("m", usual=own)) is own


def test_what_is_beyond_is_taken_all_the_same():
    rule = checks.Number("m", usual=checks.Usual(1.0, "is it in mm?"))
    assert rule.quick(5.0) == 5.0
    assert rule.taken(5.0, "length") == (5.0, None)
