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
    own = checks.Usual(1.0, "is it in mm?", 1e-3)
    assert checks.usual_of(checks.Number("m", usual=own)) == own._replace(unit="m")


def test_what_is_beyond_is_asked_about_with_what_it_may_be():
    rule = checks.usual_of(checks.Number("N*m", usual=checks.Usual(10.0, "is it in N mm?", 1e-3, least=0.1)))
    assert checks.unusual("torque", -50.0, rule) == "torque is -50 N m; is it in N mm? That makes -0.05 N m"
    assert checks.unusual("torque", 0.05, rule).startswith("torque is 0.05 N m")
    assert checks.unusual("torque", 0.0, rule) is checks.unusual("torque", 10.0, rule) is None


def test_what_is_beyond_is_taken_all_the_same():
    rule = checks.Number("m", usual=checks.Usual(1.0, "is it in mm?"))
    assert rule.quick(5.0) == 5.0
    assert rule.taken(5.0, "length") == (5.0, None)
