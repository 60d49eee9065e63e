"""Where first order says too little of an uncertainty: told with the numbers, and nowhere else."""

import re
import warnings
from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.solution.certainty import SecondOrderTerms, find_second_order
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


def orders(text):
    """What both orders make, as told."""
    return tuple(float(number) for number in re.search(r"makes (\S+) \S+(?: m)?, the second (\S+),", text).groups())


def test_both_orders_are_named_near_a_toggle():
    """Second difference of sqrt(l^2 - r^2 sin^2) + r cos over r +- u, by hand: half of it is the mean, and a spread."""
    coupler, r, u, angle = 0.3001, 0.3, 6e-5, 1.56
    low, here, high = (np.sqrt(coupler**2 - (x * np.sin(angle)) ** 2) + x * np.cos(angle) for x in (r - u, r, r + u))
    slope = np.cos(angle) - r * np.sin(angle) ** 2 / (here - r * np.cos(angle))
    (text,) = told(FOLDING, angle, "slider_position", {"crank_length": u})
    first, second = orders(text)
    assert first == pytest.approx(u * abs(slope), rel=0.05)
    assert second == pytest.approx(np.sqrt(3.0) * 0.5 * abs(low + high - 2 * here), rel=0.05)
    assert "most of it of crank_length" in text
    assert "vary the inputs there" in text
    assert told(FOLDING, angle, "slider_position", {"crank_length": 0.1 * u}) == []


def test_an_input_that_opens_the_mechanism_is_named():
    (text,) = told(FOLDING, [0.5, np.pi / 2, 2.0], "|O|", {"slider.mass": 0.01, "crank_length": 2e-4})
    assert "at 90 deg with crank_length 0.0002 larger or smaller there is no value" in text


def test_value_without_first_order_is_reported():
    (text,) = told(SAW, 0.0, "slider_position", {"guide_offset": 1e-4})
    assert "1 of 1 crank angles: at 0 deg the first makes 0 m, the second 4.3e-09" in text


def test_designs_of_a_batch_are_told_together():
    batch = ks.crank_slider(0.3, np.array([[2.0], [0.3001]]), slider=ks.Link(1.0))
    (text,) = told(batch, TURN, "O", {"crank_length": 1e-5})
    assert "of 240 crank angles" in text


def terms_of(compute, deviations, numbers=(0.0,) * 9):
    """Terms of a function of the numbers of a scene, one for each path that is given."""
    leaves = SimpleNamespace(numbers=list(numbers), with_numbers=lambda moved: SimpleNamespace(numbers=moved))
    places = {path: place for place, path in enumerate(deviations)}
    return SecondOrderTerms(lambda moved: compute(*moved.numbers), compute(*numbers), leaves, places, deviations)


@pytest.mark.slow
@every("count", range(2, 9))
@every("signs", [(1.0, 1.0), (1.0, -1.0)])
def test_products_with_common_input_are_all_seen(count, signs):
    """As of a spring's stiffness and the two ends of its elongation, equally uncertain."""
    paths = list("abcdefgh")[:count]
    for one, other, common in permutations(range(count), 3):

        def compute(*given, one=one, other=other, common=common):
            return np.array([[given[common] * (signs[0] * given[one] + signs[1] * given[other])]])

        terms = terms_of(compute, dict.fromkeys(paths, 0.5))
        told = find_second_order(terms, count, np.zeros(1), dict.fromkeys(paths, np.zeros((1, 1))), np.zeros((1, 1)))
        assert paths[common] in told.paths
        assert told.second == pytest.approx(np.sqrt(2.0) * 0.25)


@every("count", range(4, 9))
def test_products_without_common_input_are_all_seen(count):
    """As the moments of two masses that balance each other, equally uncertain."""
    paths = list("abcdefgh")[:count]
    for one, other, third, fourth in permutations(range(count), 4):
        if one > other or third > fourth:
            continue

        def compute(*given, pairs=((one, other), (third, fourth))):
            first, second = (given[i] * given[j] for i, j in pairs)
            return np.array([[first - second]])

        terms = terms_of(compute, dict.fromkeys(paths, 0.5))
        told = find_second_order(terms, count, np.zeros(1), dict.fromkeys(paths, np.zeros((1, 1))), np.zeros((1, 1)))
        assert set(told.paths) in ({paths[one], paths[other]}, {paths[third], paths[fourth]})
        assert told.second == pytest.approx(np.sqrt(2.0) * 0.25)


def test_product_of_two_inputs_equals_monte_carlo():
    """At a dead centre the guide's offset alone moves the slider, and a force has a torque by that: T = F r e / l."""
    inputs, random = {"process_force.force": 300.0, "guide_offset": 2e-4}, np.random.default_rng(4)
    s = ks.solve(SAW, 0.0, crank_speed=0.0, loads=ks.ProcessForce(0.0))
    with pytest.warns(ks.ConditionWarning, match="together") as caught:
        linear = s.uncertainty("balancing_torque", inputs)
    text = str(caught[0].message)
    first, second = orders(text)
    force, offset = (random.normal(0.0, size, (20_000, 1)) for size in inputs.values())
    moved = ks.crank_slider(0.3, 2.0, guide_offset=offset)
    torque = ks.solve(moved, 0.0, crank_speed=0.0, loads=ks.ProcessForce(force)).balancing_torque
    assert first == float(linear.tolerance) == 0.0
    assert second == pytest.approx(np.sqrt(np.mean(torque**2)), rel=0.03)
    assert second == pytest.approx(300.0 * 2e-4 * 0.3 / 2.0, rel=0.03)
    assert "most of it of process_force.force and guide_offset together" in text


def test_two_inputs_that_open_together_are_named():
    (text,) = told(FOLDING, 1.5 * np.pi, "|O|", {"crank_length": 6e-5, "guide_offset": 6e-5, "slider.mass": 0.01})
    assert "with crank_length 6e-05 and guide_offset 6e-05 larger there is no value" in text


def test_inputs_leaving_a_table_are_reported():
    pump = ks.crank_slider(0.1, 0.45, slider=ks.Link(mass=120.0))
    whole, longer = (
        ks.Scene(pump, 6.0, loads=[ks.ProcessForce(ks.Table([0.35 - more, 0.55 + more], [0.0, 2e3], over="travel"))])
        for more in (1e-9, 0.01)
    )
    inputs, angles = {"crank_length": 1e-4}, np.linspace(0.0, 6.0, 25)
    with pytest.warns(ks.ConditionWarning, match=r"may be more: with them moved, table over travel: the slider goes"):
        found = whole.solve(angles).uncertainty("O", inputs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        longer.solve(angles).uncertainty("O", inputs)
    assert np.all(np.isfinite(found.tolerance))
    assert found.tolerance.max() > 0.0
