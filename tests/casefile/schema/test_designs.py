"""Tables of designs: keys and words of each kind, and what is said of others."""

import pytest
from pydantic import ValidationError

from kinetostatics.casefile.schema.designs import OneDesign, RobustTable
from support.every import every

VARY = {"spring.stiffness": ["600 kN/m", "900 kN/m"]}
SPREADS = {"slider.mass": "normal 0 % +- 1 %"}


def read(**keys):
    return OneDesign.model_validate({"design": keys}).design


def test_texts_with_units_are_read_to_si():
    found = read(
        kind="torque-free-cam",
        ends=["1700 mm", "2.3 m"],
        guide_offset="-20 mm",
        coupler_spring="90 deg",
        counterweight="150000 g",
        cubic=["0 N/m^3", "20 MN/m^3"],
    )
    assert found.ends == pytest.approx((1.7, 2.3))
    assert found.guide_offset == pytest.approx(-0.02)
    assert found.coupler_spring == pytest.approx(1.5707963267948966)
    assert found.counterweight == pytest.approx(150.0)
    assert found.cubic == pytest.approx((0.0, 2e7))


@pytest.mark.slow
def test_a_robust_table_is_the_spread_of_python():
    spread = RobustTable(quantile=0.05, spreads=SPREADS, samples=64, trim=0.03, seed=3).spread
    assert (spread.quantile, spread.samples, spread.trim, spread.seed) == (0.05, 64, 0.03, 3)
    assert dict(spread.spreads) == SPREADS


@every(
    ("keys", "message"),
    [
        ({"kind": "optimum", "vary": VARY, "minimise": "a", "maximise": "b"}, "needs either minimise or maximise"),
        ({"kind": "torque-free-cam", "minimise": "a", "maximise": "b"}, "give one of them, or none"),
        ({"kind": "optimum", "vary": {}, "minimise": "a"}, "at least 1 item"),
        ({"kind": "optimum", "vary": {"a": ["1 m"]}, "minimise": "a"}, "must be a pair of texts with units"),
        ({"kind": "optimum", "vary": {"a": [1, 2]}, "minimise": "a"}, "must be a pair of texts with units"),
        ({"kind": "torque-free-cam", "cosine": True}, "valid integer"),
        ({"kind": "front", "vary": VARY, "minimise": ["a"]}, "at least 2 items"),
        ({"kind": "front", "vary": VARY, "minimise": ["a", "b"], "points": 1}, "greater than or equal to 2"),
        ({"kind": "torque-free-cam", "robust": {"quantile": 0.5, "spreads": {}}}, "is no spread: spreads must be"),
        ({"kind": "torque-free-cam", "robust": {"quantile": 0.5, "spreads": SPREADS, "samples": 3}}, "power of two"),
    ],
)
def test_what_is_wrong_is_said(keys, message):
    with pytest.raises(ValidationError, match=message):
        read(**keys)
