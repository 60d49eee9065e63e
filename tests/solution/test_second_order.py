"""Where first order says too little of an uncertainty: told with the numbers, and nowhere else."""

import re
import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.solution.second_order import beyond, seconds
from support.every import every

TURN = np.linspace(0.0, 2 * np.pi, 120, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
FOLDING = ks.crank_slider(0.3, 0.3001, slider=ks.Link(1.0))


def told(machine, angles, quantity, inputs):
    """What is warned of."""
    s = ks.solve(machine, angles, crank_speed=33.5, loads=ks.Gravity())
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        s.uncertainty(quantity, inputs)
    assert all(item.category is ks.ConditionWarning and item.filename == __file__ for item in found)
    return [str(item.message) for item in found]


@every("quantity", ["balancing_torque", "O", "|O|", "slider_position", "guide_force"])
@every("inputs", [{"crank_length": 1e-4, "slider.mass": 2.0, "guide_offset": 1e-4}, {"guide_offset": 1e-4}, {}])
def test_ordinary_machines_are_of_first_order(quantity, inputs):
    """Also where the first order vanishes at some angle, as of the guide's offset at the dead centres."""
    assert told(SAW, TURN, quantity, inputs) == []


def test_close_to_a_toggle_both_orders_are_told_with_their_numbers():
    """Half of the second difference of sqrt(l^2 - r^2 sin^2) + r cos over r +- u, by hand."""
    coupler, r, u, angle = 0.3001, 0.3, 6e-5, 1.56
    low, here, high = (np.sqrt(coupler**2 - (x * np.sin(angle)) ** 2) + x * np.cos(angle) for x in (r - u, r, r + u))
    slope = np.cos(angle) - r * np.sin(angle) ** 2 / (here - r * np.cos(angle))
    (text,) = told(FOLDING, angle, "slider_position", {"crank_length": u})
    first, second = (float(number) for number in re.search(r"makes (\S+) m, the second (\S+),", text).groups())
    assert first == pytest.approx(u * abs(slope), rel=0.05)
    assert second == pytest.approx(0.5 * abs(low + high - 2 * here), rel=0.05)
    assert "most of it of crank_length" in text
    assert "vary the inputs there" in text
    assert told(FOLDING, angle, "slider_position", {"crank_length": 0.1 * u}) == []


def test_an_input_that_opens_the_mechanism_is_named():
    (text,) = told(FOLDING, [0.5, np.pi / 2, 2.0], "|O|", {"slider.mass": 0.01, "crank_length": 2e-4})
    assert "at 90 deg with crank_length 0.0002 larger or smaller there is no value" in text


def test_a_value_that_no_input_moves_to_first_order_is_told():
    (text,) = told(SAW, 0.0, "slider_position", {"guide_offset": 1e-4})
    assert "1 of 1 crank angles: at 0 deg the first makes 0 m, the second 2.5e-09" in text


def test_designs_of_a_batch_are_told_together():
    batch = ks.crank_slider(0.3, np.array([[2.0], [0.3001]]), slider=ks.Link(1.0))
    (text,) = told(batch, TURN, "O", {"crank_length": 1e-5})
    assert "of 240 crank angles" in text


@every("sizes", [0.0, 1e-9])
def test_differences_within_rounding_are_no_second_order(sizes):
    first, second = {"a": np.full((1, 3), 1e-12)}, {"a": np.full((1, 3), sizes)}
    assert beyond(np.zeros(3), first, second, np.full((1, 3), 1e-9)) is None


def test_second_differences_are_exact_for_squares():
    leaves = ks.solve(SAW, 0.0, crank_speed=1.0).apart[1]
    found = seconds(lambda leaves: np.array([[leaves.numbers[0] ** 2]]), leaves, {"x": 0}, {"x": 0.5})
    assert found["x"] == pytest.approx(0.25)
