"""Hand calculations asked for in ways that make no sense, or of odd names: one error that tells, or a right answer."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from support.retold import largest_error
from tests.support.every import every

PUMP = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0), coupler=ks.Link(0.5, (0.1, 0.0), 0.01))
SOLVED = ks.solve(PUMP, [0.1, 0.2], crank_speed=9.0)


@every("quantity", ["", " ", "guide-force", "__class__", "x" * 10_000, 3, 0.5, (), {}, b"O", object(), max, "closure"])
def test_no_quantity(quantity):
    with pytest.raises(ks.QuantityError) as error:
        SOLVED.explain(quantity, 0.7)
    assert "balancing_torque" in str(error.value)


@every("angle", [math.inf, -math.inf, math.nan, None, "pi", [], [0.1, 0.2], np.zeros((2, 2)), object(), 1j, True])
def test_no_angle(angle):
    with pytest.raises(ks.ParameterError):
        SOLVED.explain("O", angle)


@every("design", [0, -1, (0,), "first", 1.5, (0, 0)])
def test_no_designs_to_choose_of(design):
    with pytest.raises(ks.ParameterError, match="is not among the designs"):
        SOLVED.explain("O", 0.7, design)


@pytest.mark.slow
@every("angle", [0.0, math.pi / 2, math.pi, 3 * math.pi / 2, -1e-300, 1e-9, 12345.0, [0.7], np.array([[0.7]])])
def test_angles_where_much_vanishes(angle):
    told = SOLVED.explain("balancing_torque", angle)
    assert largest_error(told, chained=True) < 1e-14


@pytest.mark.slow
@every(
    "names",
    [("A", "B"), ("phi", "x"), ("x_A", "w"), ("sqrt", "sin"), ("pin of the rod", "a-b"), ("ф", "θ'"), ("1", "2")],
)
def test_odd_names_of_pins(names):
    pin, end = names
    parts = (ks.Pin(on="crank", at=(0.05, 0.0), name=pin),) if pin != "A" else ()
    rod = ks.SliderGroup(0.2, on=pin, pin=end, coupler=ks.Link(0.5, 0.1, 0.01), slider=ks.Link(1.0))
    crank = ks.Crank(0.05) if pin == "A" else ks.Crank(None)
    solution = ks.solve(ks.Mechanism("odd", crank, (*parts, rod)), 0.7, crank_speed=9.0, loads=ks.Gravity())
    told = solution.explain("balancing_torque", 0.7)
    assert len({step.symbol for step in told.steps}) == len(told.steps)
    assert told.text
    assert told.html
    assert told.latex


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@every("size", [1e-9, 1e-3, 1e3, 1e6])
def test_machines_of_any_size(size):
    pump = ks.crank_slider(0.05 * size, 0.2 * size, slider=ks.Link(1.0))
    told = ks.solve(pump, 0.7, crank_speed=9.0).explain("balancing_torque", 0.7)
    assert largest_error(told, chained=True) < 1e-14


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("angle", [0.0, math.pi / 2])
def test_rounding_over_rounding_is_not_zero(angle):
    link = ks.Link(2.0, 0.05, 0.01)
    folding = ks.crank_slider(0.3, 0.3, coupler=link, slider=link, assembly="open")
    bar = ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0), coupler=link, rocker=link, assembly="open")
    for machine in (folding, bar):
        solution = ks.solve(machine, 0.1, crank_speed=7.0, loads=ks.Gravity())
        for quantity in ("B", "balancing_torque"):
            told = solution.explain(quantity, angle)
            shown = np.array([float(step.shown) for step in told.results])
            np.testing.assert_allclose(shown, np.ravel(told.value), rtol=1e-5, atol=1e-9)
