"""Largest values with their uncertainty: by hand where the formula is known."""

import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.solution.uncertainty_table import format_with_uncertainty, largest_with_uncertainty
from support.every import every

YOKE = ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 0.0, crank_speed=10.0)


def test_extremum_uncertainty_is_its_formula():
    """The torque is m r^2 omega^2 sin 2 phi / 2 at most: 1.5 N m, so 1 % of r makes 2 %, 1 % of m makes 1 %."""
    table = largest_with_uncertainty(YOKE, {"crank_length": 0.001, "slider.mass": 0.03})
    row = table.loc["balancing torque"]
    assert abs(row["largest"]) == pytest.approx(1.5, rel=1e-12)
    assert row["tolerance"] == pytest.approx(1.5 * np.hypot(0.02, 0.01), rel=1e-9)
    assert (row["most from"], row["share [%]"]) == ("crank_length", pytest.approx(80.0))
    assert 0.0 < row["rounding"] < 1e-14


@pytest.mark.slow
def test_peak_at_a_table_row_moves_with_inputs():
    """The torque on a yoke without mass is F sqrt(r^2 - x^2) where the row stands, however steep it is beside."""
    work = ks.Table([-0.2, 0.0599, 0.06, 0.0601, 0.2], [0.0, 0.0, 1000.0, 0.0, 0.0], over="travel")
    s = ks.solve(ks.scotch_yoke(0.1), 0.0, crank_speed=10.0, loads=ks.ProcessForce(work))
    row = largest_with_uncertainty(s, {"crank_length": 1e-5}).loc["balancing torque"]
    assert abs(row["largest"]) == pytest.approx(80.0, rel=1e-9)
    assert row["tolerance"] == pytest.approx(1000.0 * 0.1 / 0.08 * 1e-5, rel=1e-3)


RUBBING = ks.solve(
    ks.crank_slider(0.1, 0.4, crank=ks.Link(5.0, 0.01), slider=ks.Link(3.0)),
    0.0,
    crank_speed=10.0,
    loads=ks.ProcessForce(ks.Table([0.2, 0.6], [-500.0, -500.0], over="travel", back=[0.0, 0.0])),
    friction={"guide": ks.GuideFriction(0.1)},
)


@pytest.mark.slow
def test_motion_at_a_jump_keeps_its_uncertainty():
    """The slider is r + l from O at the outer dead centre, where friction and the load jump."""
    table = largest_with_uncertainty(RUBBING, {"crank_length": 1e-4, "coupler_length": 1e-4})
    row = table.loc["slider position"]
    assert row["tolerance"] == pytest.approx(1e-4 * np.sqrt(2.0), rel=1e-12)
    assert row["share [%]"] == pytest.approx(50.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = largest_with_uncertainty(RUBBING, {"crank.mass": 6.0, "slider.centre.along": 1e-3})
    assert set(table.index[table["tolerance"] > 0.0]) == {"reaction O", "shaking force"}


def test_without_uncertain_numbers_rounding_is_all():
    table = largest_with_uncertainty(YOKE, {})
    assert (table["tolerance"] == 0.0).all()
    assert set(table["most from"]) == {""}
    assert (table["rounding"] > 0.0).all()


def test_constant_and_repeated_rows_are_left_out():
    table = largest_with_uncertainty(YOKE, {"slider.mass": 0.1})
    assert "guide force" not in table.index
    assert "balancing torque by power" not in table.index
    assert "reaction O" in table.index


@every("value, uncertainty, text", [
    (40578.94, 3.0, "40578.9 +- 3"), (40578.94, 31.2, "40579 +- 32"), (5578.43, 318.0, "5580 +- 320"),
    (-10.16, 0.074, "-10.16 +- 0.074"), (2.3, 0.25, "2.3 +- 0.25"), (1.0, 20.0, "0 +- 20"), (0.0, 2.0, "0 +- 2"),
    (7.0, 20.0, "7 +- 20"), (0.36, 1e-4 + 3e-16, "0.36 +- 0.0001"), (0.36, 1.01e-4, "0.36 +- 0.00011"),
])  # fmt: skip
def test_value_is_printed_to_two_uncertain_digits(value, uncertainty, text):
    assert format_with_uncertainty(value, uncertainty) == text


def test_a_doubt_is_told_once_and_names_the_quantities():
    """Half of a crank's length more makes a fourth more of the square that a force grows by, beyond first order."""
    with pytest.warns(ks.ConditionWarning) as caught:
        largest_with_uncertainty(YOKE, {"crank_length": 0.05})
    (told,) = [str(item.message) for item in caught]
    assert told.startswith("Scotch yoke: the uncertainties of balancing_torque")
    assert "are of first order in the inputs, and may be more; that of balancing_torque most: at " in told
    assert told.count("vary the inputs there") == 1
