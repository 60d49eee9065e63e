"""Bounds and uncertainties as a solution gives them: shapes, magnitudes, refusals, and against Monte Carlo."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import NotGivenError, ParameterError, QuantityError
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
    with pytest.raises(ks.QuantityError, match="only of a vector there is a magnitude"):
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


@every("quantity", ["nothing", "|nothing|", "|balancing_torque|", "||", 3])
def test_what_is_no_quantity_is_refused(quantity):
    with pytest.raises((QuantityError, ParameterError)):
        solved().error_bound(quantity)


def test_unrecordable_code_has_no_bound():
    pressed = ks.ProcessForce(lambda motion: np.interp(motion.crank_angle, [0, 7], [0, 7]))
    s = ks.solve(SAW, TURN, crank_speed=1.0, loads=[pressed])
    with pytest.raises(NotGivenError, match="its own rounding is not known"):
        s.error_bound("balancing_torque")


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


@every(
    "inputs, message",
    [
        ({"crank_length": -1.0}, "at least 0"),
        ({"crank_length": np.nan}, "finite"),
        ({"crank": 1.0}, "allowed"),
        ({"crank_length": np.array([[1.0], [2.0]])}, "one number"),
    ],
)
def test_wrong_uncertainties_are_refused(inputs, message):
    with pytest.raises(ParameterError, match=message):
        solved().uncertainty("O", inputs)


@every("inputs", [None, 3, "ab", [("slider.mass", 1.0)], {3: 1.0}])
def test_what_names_no_inputs_is_refused(inputs):
    with pytest.raises(ks.ParameterError, match="inputs must map paths to numbers"):
        ks.solve(ks.crank_slider(0.1, 0.4), 0.5, crank_speed=5.0).uncertainty("O", inputs)


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
