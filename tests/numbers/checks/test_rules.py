"""What each rule keeps of a value, quickly and thoroughly alike, and what it says of a value that is wrong."""

import numpy as np
import pytest

from kinetostatics.numbers import checks
from kinetostatics.numbers.checks.rules import UNSURE

RULES = {
    "number": (checks.Number("m"), (1.5, -0.0, 3, np.float64(2.0)), ("1", None, np.nan, np.inf, 1e200)),
    "positive": (checks.Number("m", low=0.0, strict=True), (1.5, 3), (0.0, -1.0, True)),
    "pair": (checks.Pair("m"), ((1.0, 2.0), (0, 1)), ((1.0,), (1.0, np.nan), 1.0)),
    "centre": (checks.Pair("m", lone=True), (0.5, (0.5, 0.1)), ("x", (1.0, 2.0, 3.0))),
    "optional": (checks.Optional(checks.Number("m")), (None, 1.0), ("x",)),
    "sign": (checks.Sign(("open",)), (1, -1, "open"), (0, 2, "closed", True)),
    "name": (checks.Name(), ("A",), ("", "a\nb", 3)),
}


@pytest.mark.parametrize("name", RULES)
def test_good_values_are_kept_alike_by_a_quick_and_a_thorough_look(name):
    rule, good, _ = RULES[name]
    for value in good:
        kept, problem = rule.taken(value, "it")
        assert problem is None
        quick = rule.quick(value)
        assert quick is UNSURE or quick == kept


@pytest.mark.parametrize("name", RULES)
def test_wrong_values_are_never_kept_quickly_and_told_by_name(name):
    rule, _, wrong = RULES[name]
    for value in wrong:
        assert rule.quick(value) is UNSURE, value
        _, problem = rule.taken(value, "it")
        assert problem is not None, value
        assert "it" in problem, value


@pytest.mark.parametrize("name", [name for name, (rule, *_) in RULES.items() if hasattr(rule, "plainly")])
def test_the_written_condition_holds_for_nothing_that_a_quick_look_would_change_or_doubt(name):
    rule, good, wrong = RULES[name]
    condition, objects = rule.plainly("it")
    for value in (*good, *wrong):
        if eval(condition, {**objects, "it": value}):
            assert rule.quick(value) is value or rule.quick(value) == value, value
            assert value in good
