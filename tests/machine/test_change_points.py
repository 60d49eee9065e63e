"""Change points passed: which branch a word chooses, and what follows from it."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import kinetostatics as ks
from support.change_points import LINKAGES, LINKS, SIDES, SINGLE, SPEED, each, four_bar, solve

# What the branches are


def test_parallelogram_stays_a_parallelogram():
    solution = solve(four_bar("parallelogram", "open"), np.linspace(-7.0, 7.0, 99))
    np.testing.assert_allclose(solution.position("B") - solution.position("A"), [[2.0] * 99, [0.0] * 99], atol=1e-15)
    assert not solution.rate("coupler").any()
    assert set(solution.rate("rocker")) == {SPEED}


def test_folded_kite_and_folded_rhombus_leave_the_rocker_at_rest():
    for name in ("kite", "rhombus"):
        solution = solve(four_bar(name, "crossed"), np.linspace(-7.0, 7.0, 99))
        np.testing.assert_allclose(solution.position("B"), 0.0, atol=1e-15)
        assert not solution.rate("rocker").any()


@each
def test_open_is_left_of_the_line_from_the_crank_pin_to_the_pivot_in_the_first_half_turn(name, assembly):
    solution = solve(four_bar(name, assembly), np.linspace(0.1, 3.0, 9))
    along, reach = (solution.position(joint) - solution.position("A") for joint in ("O2", "B"))
    assert np.all(SIDES[assembly] * (along[0] * reach[1] - along[1] * reach[0]) > -1e-12)


@each
def test_branch_is_the_same_wherever_the_pivot_stands(name, assembly):
    """The crank angle counts from the direction O -> O2, whose own angle lies between -pi and pi."""
    psi, ground = np.linspace(-7.0, 7.0, 29), LINKAGES[name][3]
    x, y = solve(four_bar(name, assembly), psi, loads=()).acceleration("B")
    for start in (-3.1, -2.0, -1.0, 1.0, 2.0, 3.1):
        cosine, sine = np.cos(start), np.sin(start)
        made = four_bar(name, assembly, (ground * cosine, ground * sine))
        found = solve(made, start + psi, loads=()).acceleration("B")
        expected = cosine * x - sine * y, sine * x + cosine * y
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs([x, y]).max())


def test_group_on_a_crank_is_checked_as_on_its_own():
    assert ks.check(four_bar("4/1/3/2", "open").groups[0]).ok


@each
def test_motion_goes_on_through_every_change_point_and_closes_after_its_turns(name, assembly):
    """Positions by cubic interpolation of what is around them: no side is left, and no velocity jumps."""
    made = four_bar(name, assembly, (LINKAGES[name][3] * 0.6, LINKAGES[name][3] * 0.8))
    assert made.turns == (2 if name in SINGLE else 1)
    period = 2 * np.pi * made.turns
    for change in (angle + 2 * np.pi * turn for angle in made.change_points for turn in range(made.turns)):
        solution = solve(made, change + 1e-3 * np.array([-3, -1, 1, 3]))
        for values in (*solution.position("B"), *solution.velocity("B"), *solution.acceleration("B")):
            assert abs(np.diff(values, 3)[0]) < 1e-3
    first, later = (solve(made, np.array([0.2, 1.0, 4.0]) + shift).position("B") for shift in (0.0, period))
    np.testing.assert_allclose(first, later, atol=1e-13)
    if made.turns == 2:
        other = "crossed" if assembly == "open" else "open"
        turned = solve(four_bar(name, other, made.groups[0].pivot), np.array([0.2, 1.0, 4.0]) + 2 * np.pi)
        np.testing.assert_allclose(first, turned.position("B"), atol=1e-13)


def test_pin_that_passes_close_by_the_pivot_is_warned_of():
    made = ks.four_bar(1.0, 2.0, 2.0 - 2.0**-24, rocker_pivot=(1.0 + 2.0**-24, 0.0), assembly="crossed", **LINKS)
    with pytest.warns(ks.ConditionWarning, match="correct digits"):
        solve(made, np.array([1e-8, 3e-8, 6e-8, 1e-7, 1.0]))


@pytest.mark.parametrize("assembly", SIDES)
def test_linkages_without_change_points_keep_their_side_to_the_last_bit(assembly):
    word, number = (
        ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), assembly=way) for way in (assembly, SIDES[assembly])
    )
    assert word.turns == 1
    assert word.change_points == ()
    assert not word.passes
    angles = np.linspace(0.0, 7.0, 50)
    np.testing.assert_array_equal(solve(word, angles).acceleration("B"), solve(number, angles).acceleration("B"))


def test_lengths_in_decimals_count_as_equal_and_close_everywhere():
    for crank, coupler, rocker, ground in (
        (0.1 + 0.2, 0.7, 0.3, 0.7),
        (0.4, 0.7, 0.9, 0.2),
        (0.1, 0.6, 0.5, 0.1 + 0.9),
    ):
        a, b, h, d = map(Fraction, (crank, coupler, rocker, ground))
        apart = min(abs(a + d - b - h), abs(abs(d - a) - abs(b - h)))
        assert 0 <= apart <= 8 * Fraction(float(np.spacing(max(crank, coupler, rocker, ground))))
        made = ks.four_bar(crank, coupler, rocker, rocker_pivot=(ground, 0.0), assembly="open")
        assert made.passes
        assert np.isfinite(solve(made, np.linspace(-6.3, 6.3, 721)).position("B")).all()


def test_lengths_beyond_eight_ulp_are_no_change_point():
    ulp = float(np.spacing(2.0))
    kinds = [ks.four_bar(1.0 + n * ulp, 2.0, 1.0, rocker_pivot=(2.0, 0.0), assembly="open").passes for n in (7, 9)]
    assert kinds == [True, False]


# Sliders


@pytest.mark.filterwarnings("ignore:.*stands still:kinetostatics.errors.HintWarning")
@pytest.mark.parametrize("guide_angle", [0.0, 0.7, -2.0])
def test_coupler_as_long_as_the_crank_carries_the_slider_through_the_centre(guide_angle):
    angles = np.linspace(-7.0, 7.0, 41)
    made = {
        way: ks.crank_slider(
            0.5, 0.5, guide_angle=guide_angle, assembly=way, coupler=LINKS["coupler"], slider=ks.Link(3.0)
        )
        for way in SIDES
    }
    along = np.cos(angles - guide_angle)
    np.testing.assert_allclose(solve(made["open"], angles).slider_position, along, atol=1e-15)
    np.testing.assert_allclose(solve(made["open"], angles).rate("coupler"), -SPEED)
    np.testing.assert_allclose(solve(made["crossed"], angles).slider_position, 0.0, atol=1e-15)
    assert {item.turns for item in made.values()} == {1}


def test_slider_with_an_offset_passes_its_only_change_point_in_two_turns():
    made = ks.crank_slider(0.5, 0.75, guide_offset=0.25, assembly="open", coupler=LINKS["coupler"], slider=ks.Link(3.0))
    assert made.turns == 2
    (change,) = made.change_points
    assert change == pytest.approx(1.5 * np.pi)
    solution = solve(made, change + 1e-3 * np.array([-3, -1, 1, 3]))
    for values in (solution.slider_position, solution.slider_velocity, solution.slider_acceleration):
        assert abs(np.diff(values, 3)[0]) < 1e-6
    assert np.ptp(np.sign(solution.slider_velocity)) == 0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_forces_of_an_upright_slider_at_the_exact_angle_are_infinite_across_the_guide_and_finite_along_it():
    guide = ks.Guide.through((-0.25, 0.0), (-0.25, 1.0))
    made = ks.crank_slider(0.5, 0.75, guide=guide, assembly="open", coupler=LINKS["coupler"], slider=ks.Link(3.0))
    solution = solve(made, np.array([0.0, 1e-10]))
    for name in ("A", "B", "O", "guide"):
        (across, _), (at, near) = solution.reaction(name)
        assert np.isinf(across)
        assert at == pytest.approx(near, rel=1e-8, abs=1e-8)


def test_change_points_just_below_zero_lie_in_the_turn():
    made = ks.four_bar(1.0, 3.0, 2.0, rocker_pivot=(-4.0, 1e-20), assembly="open")
    assert made.change_points == (0.0,)


# What follows from it


@each
def test_a_turn_is_solved_without_a_warning_until_reactions_are_read(name, assembly):
    """Warnings are errors in the tests."""
    solution = ks.Scene(four_bar(name, assembly), SPEED, loads=ks.Gravity()).solve(72)
    assert solution.crank_angle[-1] > 2 * np.pi * (solution.mechanism.turns - 0.1)
    assert np.isfinite(solution.balancing_torque).all()
    assert np.isfinite(solution.acceleration("B")).all()
    assert solution.condition.max() < 1e4
    assert solution.condition_of("balancing_torque").max() < 1e4
    with pytest.warns(ks.ConditionWarning, match="second freedom"):
        solution.reaction("A")


@pytest.mark.parametrize(
    ("name", "places"), [("parallelogram", "0, 180"), ("4/1/3/2", "180, 540"), ("deltoid", "0, 360")]
)
def test_extremes_of_torque_are_ordinary_and_those_of_reactions_infinite_at_change_points(name, places):
    solution = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(12)
    torque = ks.extremes(solution, "balancing_torque")
    fine = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(7200).balancing_torque
    np.testing.assert_allclose(torque.range, [fine.min(), fine.max()], rtol=1e-6)
    with pytest.warns(ks.ConditionWarning, match=f"B grows without bound at {places} deg"):
        found = ks.extremes(solution, "B")
    assert found.range[1] == np.inf
    assert 0 < found.range[0] < 100


def test_reactions_that_no_load_makes_grow_stay_what_they_are():
    made = replace(four_bar("parallelogram", "open", crank=LINKS["crank"]))
    solution = solve(made, np.linspace(0.0, 6.0, 13))
    assert not solution.reaction("B").any()
    assert np.isfinite(solution.reaction("O")).all()


def test_work_of_the_torque_over_the_period_is_zero_without_friction():
    for name in LINKAGES:
        torque = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(360).balancing_torque
        assert abs(torque.mean()) < 1e-9 * abs(torque).max()


def test_fixed_side_names_its_kinks_and_jumps():
    for name, words in (("parallelogram", "a kink at 0 deg and a kink at 180 deg"), ("deltoid", "a jump, as A meets")):
        with pytest.warns(ks.ConditionWarning, match=words):
            solve(four_bar(name, 1), np.array([0.0, 1.0]))
