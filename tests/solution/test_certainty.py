"""Uncertainty of results: first and second order, and tables."""

import re
import warnings
from itertools import permutations

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import NotGivenError, ParameterError, QuantityError
from kinetostatics.solution.certainty import find_second_order
from kinetostatics.solution.tables import format_with_uncertainty, largest_with_uncertainty
from support.every import every

TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angles=TURN, machine=SAW, **options):
    return ks.solve(machine, angles, crank_speed=33.5, loads=[ks.Gravity()], **options)


def test_bounds_are_shaped_as_the_quantity_and_locked():
    s = solved()
    assert s.error_bound("balancing_torque").shape == TURN.shape
    assert s.error_bound("O").shape == s.reaction("O").shape
    assert s.error_bound("|O|").shape == TURN.shape
    assert np.ndim(solved(0.5).error_bound("balancing_torque")) == 0
    with pytest.raises(ValueError, match="read-only"):
        s.error_bound("O")[0] = 0.0


def test_magnitude_condition_is_the_vectors():
    s = solved()
    np.testing.assert_array_equal(s.condition_of("|O|"), s.condition_of("O"))
    with pytest.raises(ks.QuantityError, match="only vectors have a magnitude"):
        s.condition_of("|balancing_torque|")


def test_magnitude_bound_covers_its_components():
    s = solved()
    x, y = s.error_bound("O")
    assert np.all(s.error_bound("|O|") >= np.hypot(x, y))
    assert np.all(s.error_bound("|O|") < np.hypot(x, y) + 1e-15 * np.hypot(*s.reaction("O")))


def test_tight_bounds_are_no_larger_than_plain_ones():
    s = solved(np.linspace(0, 6, 7))
    for quantity in ("balancing_torque", "O", "|O|"):
        assert np.all(s.error_bound(quantity, tight=True) <= s.error_bound(quantity) * (1 + 1e-8))


def test_batch_bounds_equal_those_of_each_design():
    masses = np.array([[300.0], [600.0]])
    batch = solved(machine=ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(masses)))
    np.testing.assert_array_equal(batch.error_bound("O")[:, 1], solved().error_bound("O"))


def test_gaps_have_no_bound_as_they_have_no_value():
    s = ks.solve(ks.crank_slider(0.5, 0.4), [0.1, 1.5], crank_speed=1.0, on_gap="nan")
    assert np.isnan(s.error_bound("slider_velocity")).tolist() == [False, True]


NO_NAMES = [None, 3, "ab", [("slider.mass", 1.0)], {3: 1.0}]
REFUSED = [
    *((quantity, {}, "quantity|magnitude") for quantity in ["nothing", "|nothing|", "|balancing_torque|", "||", 3]),
    ("O", {"crank_length": -1.0}, "at least 0"),
    ("O", {"crank_length": np.nan}, "finite"),
    ("O", {"crank": 1.0}, "allowed"),
    ("O", {"crank_length": np.array([[1.0], [2.0]])}, "one number"),
    *(("O", inputs, "inputs must map paths to numbers") for inputs in NO_NAMES),
]


@every("quantity, inputs, message", REFUSED)
def test_wrong_quantities_and_uncertainties_are_refused(quantity, inputs, message):
    with pytest.raises((QuantityError, ParameterError), match=message):
        solved().uncertainty(quantity, inputs)
    if quantity != "O":
        with pytest.raises((QuantityError, ParameterError), match=message):
            solved().error_bound(quantity)


def test_unrecordable_code_has_no_bound():
    pressed = ks.ProcessForce(lambda motion: np.interp(motion.crank_angle, [0, 7], [0, 7]))
    s = ks.solve(SAW, TURN, crank_speed=1.0, loads=[pressed])
    with pytest.raises(NotGivenError, match="its rounding is unknown"):
        s.error_bound("balancing_torque")


@pytest.mark.slow
def test_uncertainty_equals_a_monte_carlo_spread():
    s, spreads = solved(), {"crank_length": 1e-4, "slider.mass": 2.0, "guide_offset": 2e-4}
    found = s.uncertainty("balancing_torque", spreads)
    random = np.random.default_rng(0)
    scene = ks.Scene(SAW, 33.5, loads=(ks.Gravity(),))
    drawn = {
        path: scene_value + spread * random.standard_normal((2000, 1))
        for (path, spread), scene_value in zip(spreads.items(), (0.3, 600.0, 0.0), strict=True)
    }
    values = ks.compile(scene, "balancing_torque", parameters=tuple(spreads))(TURN, drawn)["balancing_torque"]
    np.testing.assert_allclose(values.std(axis=0), found.tolerance, rtol=0.06, atol=0.06 * found.tolerance.max())


def test_uncertainty_adds_rounding_to_root_sum():
    s = solved()
    found = s.uncertainty("|O|", {"crank_length": 1e-5, "slider.mass": 1.0})
    parts = np.array(list(found.inputs.values()))
    np.testing.assert_allclose(found.total, np.sqrt((parts**2).sum(axis=0)) + s.error_bound("|O|"), rtol=1e-14)
    np.testing.assert_array_equal(np.asarray(found), found.total)
    assert "rounding" in repr(found)
    assert repr(found).startswith("largest over the crank angles [N")
    assert np.all(s.uncertainty("O", {}).total == s.error_bound("O"))


def test_vanishing_magnitude_is_as_uncertain_as_vector():
    s = ks.solve(ks.crank_slider(0.3, 2.0), [0.0, 1.0], crank_speed=5.0, loads=[ks.Gravity()])
    found = s.uncertainty("|O|", {"slider.mass": 2.0})
    parts = s.uncertainty("O", {"slider.mass": 2.0}).tolerance
    np.testing.assert_allclose(found.tolerance, np.hypot(*parts), rtol=1e-14)
    assert np.all(found.tolerance > 1.0)


def test_zero_may_be_uncertain_passing_lengths_not():
    s = solved()
    found = s.uncertainty("balancing_torque", {"guide_offset": 1e-3, "coupler.mass": 1.0})
    assert np.all(found.inputs["coupler.mass"] >= 0.0)
    assert found.inputs["guide_offset"].max() > 0.0
    parallelogram = ks.four_bar(0.3, 0.8, 0.3, rocker_pivot=(0.8, 0.0), assembly="open", rocker=ks.Link(20.0, 0.1, 2.0))
    turning = ks.solve(parallelogram, TURN, crank_speed=10.0)
    with pytest.raises(ParameterError, match="change points"):
        turning.uncertainty("balancing_torque", {"crank_length": 1e-5})


@every("tight", ["tight", "x", 1, None])
def test_tight_is_yes_or_no_and_no_other_word(tight):
    s = solved()
    program = ks.compile(ks.Scene(SAW, 5.0), "O", engine="numpy")
    for bound in (lambda: s.error_bound("O", tight), lambda: program.error_bound(0.5, tight=tight)):
        with pytest.raises(ParameterError, match="tight must be True or False, got "):
            bound()
    assert np.array_equal(s.error_bound("O", np.True_), s.error_bound("O", tight=True))


# Where first order says too little of an uncertainty

AROUND = np.linspace(0.0, 2 * np.pi, 120, endpoint=False)
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
    assert told(SAW, AROUND, quantity, inputs) == []


def orders(text):
    """Sizes of both orders in the warning."""
    return tuple(
        float(number) for number in re.search(r"first order (\S+) \S+(?: m)?, second order (\S+),", text).groups()
    )


def test_both_orders_are_named_near_a_toggle():
    """Second difference of sqrt(l^2 - r^2 sin^2) + r cos over r +- u, by hand: half of it is the mean, and a spread."""
    coupler, r, u, angle = 0.3001, 0.3, 6e-5, 1.56
    low, here, high = (np.sqrt(coupler**2 - (x * np.sin(angle)) ** 2) + x * np.cos(angle) for x in (r - u, r, r + u))
    slope = np.cos(angle) - r * np.sin(angle) ** 2 / (here - r * np.cos(angle))
    (text,) = told(FOLDING, angle, "slider_position", {"crank_length": u})
    first, second = orders(text)
    assert first == pytest.approx(u * abs(slope), rel=0.05)
    assert second == pytest.approx(np.sqrt(3.0) * 0.5 * abs(low + high - 2 * here), rel=0.05)
    assert "mostly from crank_length" in text
    assert "vary the inputs there" in text
    assert told(FOLDING, angle, "slider_position", {"crank_length": 0.1 * u}) == []


def test_an_input_that_opens_the_mechanism_is_named():
    (text,) = told(FOLDING, [0.5, np.pi / 2, 2.0], "|O|", {"slider.mass": 0.01, "crank_length": 2e-4})
    assert "at 90 deg with crank_length 0.0002 larger or smaller the quantity has no value" in text


def test_value_without_first_order_is_reported():
    (text,) = told(SAW, 0.0, "slider_position", {"guide_offset": 1e-4})
    assert "1 of 1 crank angles: at 0 deg first order 0 m, second order 4.3e-09" in text


def test_designs_of_a_batch_are_told_together():
    batch = ks.crank_slider(0.3, np.array([[2.0], [0.3001]]), slider=ks.Link(1.0))
    (text,) = told(batch, AROUND, "O", {"crank_length": 1e-5})
    assert "of 240 crank angles" in text


def second_order(compute, paths):
    """Second order of a function of the numbers of a scene, one for each path, all uncertain by 0.5."""

    def change(signs):
        return compute(*(0.5 * signs.get(path, 0.0) for path in paths))

    zero = np.zeros((1, 1))
    return find_second_order(change, np.zeros(1), dict.fromkeys(paths, zero), zero)


@pytest.mark.slow
@every("count", range(2, 9))
@every("signs", [(1.0, 1.0), (1.0, -1.0)])
def test_products_with_common_input_are_all_seen(count, signs):
    """As of a spring's stiffness and the two ends of its elongation, equally uncertain."""
    paths = list("abcdefgh")[:count]
    for one, other, common in permutations(range(count), 3):

        def compute(*given, one=one, other=other, common=common):
            return np.array([[given[common] * (signs[0] * given[one] + signs[1] * given[other])]])

        told = second_order(compute, paths)
        assert paths[common] in told.paths
        assert told.second == pytest.approx(np.sqrt(2.0) * 0.25)


@pytest.mark.slow
@every("count", (4, 5, 7))
def test_products_without_common_input_are_all_seen(count):
    """As the moments of two masses that balance each other, equally uncertain."""
    paths = list("abcdefgh")[:count]
    for one, other, third, fourth in permutations(range(count), 4):
        if one > other or third > fourth:
            continue

        def compute(*given, pairs=((one, other), (third, fourth))):
            first, second = (given[i] * given[j] for i, j in pairs)
            return np.array([[first - second]])

        told = second_order(compute, paths)
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
    assert "mostly from process_force.force and guide_offset together" in text


def test_two_inputs_that_open_together_are_named():
    (text,) = told(FOLDING, 1.5 * np.pi, "|O|", {"crank_length": 6e-5, "guide_offset": 6e-5, "slider.mass": 0.01})
    assert "with crank_length 6e-05 and guide_offset 6e-05 larger the quantity has no value" in text


def test_inputs_leaving_a_table_are_reported():
    pump = ks.crank_slider(0.1, 0.45, slider=ks.Link(mass=120.0))
    whole, longer = (
        ks.Scene(pump, 6.0, loads=[ks.ProcessForce(ks.Table([0.35 - more, 0.55 + more], [0.0, 2e3], over="travel"))])
        for more in (1e-9, 0.01)
    )
    inputs, angles = {"crank_length": 1e-4}, np.linspace(0.0, 6.0, 25)
    with pytest.warns(
        ks.ConditionWarning, match=r"may be larger: with changed inputs, table over travel: the slider goes"
    ):
        found = whole.solve(angles).uncertainty("O", inputs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        longer.solve(angles).uncertainty("O", inputs)
    assert np.all(np.isfinite(found.tolerance))
    assert found.tolerance.max() > 0.0


# Largest values with their uncertainty

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
    assert re.search(r"are of first order in the inputs, and may be larger; the worst is \w+: at ", told)
    assert told.count("vary the inputs there") == 1
