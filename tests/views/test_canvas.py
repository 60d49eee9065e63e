"""What every figure shares."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.views import canvas

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
PUMP = ks.solve(ks.crank_slider(0.1, 0.5), TURN, crank_speed=1.0)


@pytest.mark.parametrize(
    ("unit", "largest", "expected"),
    [("N", 9e3, (1.0, "N")), ("N", -2e4, (1e-3, "kN")), ("N m", 1e4, (1e-3, "kN m")), ("m", 1e5, (1.0, "m"))],
)
def test_large_forces_read_in_kilonewtons(unit, largest, expected):
    assert canvas.display(unit, [np.array([0.0, np.nan, largest])]) == expected


def test_angles_read_in_degrees():
    assert canvas.display("rad", [np.ones(1)]) == (180 / np.pi, "deg")


def test_axes_given_are_those_drawn_on():
    figure, ax = plt.subplots()
    assert canvas.axes(ax) is ax
    plt.close(figure)
    with pytest.raises(ks.ParameterError, match="ax must be matplotlib Axes"):
        canvas.axes(3)


def test_a_solution_by_itself_is_labelled_by_the_quantity_and_lines_differ():
    (label,) = canvas.labelled(PUMP, "balancing_torque")
    assert "torque" in label
    named = canvas.labelled({"a": PUMP, "b": PUMP}, "balancing_torque")
    assert [style for *_, style in canvas.styled(named)] == list(canvas.STYLES[:2])
    assert canvas.single(PUMP) is PUMP


def test_a_curve_over_the_turn_is_closed():
    assert canvas.closed(np.array([[1, 2, 3], [4, 5, 6]])).tolist() == [[1, 2, 3, 1], [4, 5, 6, 4]]


def test_missing_columns_and_rows_are_named():
    with pytest.raises(ks.ParameterError, match="no column 'b'; it has a"):
        canvas.require_columns("plots", pd.DataFrame({"a": [1]}), ["a", "b"])
    with pytest.raises(ks.ParameterError, match="no rows"):
        canvas.require_columns("plots", pd.DataFrame({"a": []}), ["a"])
