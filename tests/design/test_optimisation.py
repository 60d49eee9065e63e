"""Optimisation under limits: optima known otherwise, limits at true extremes, prices, refusals."""

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design.demands import demand
from kinetostatics.design.problem import Problem

SAW = ks.load_case("sawframe_2r63")
CIRCLE = SAW.variant("cam-circle")
ENDS = ("smallest slider_position = 1.7 m", "largest slider_position = 2.3 m")
SPRING = {"spring.stiffness": ("500 kN/m", "900 kN/m")}
CAM = SPRING | {
    "cam.centre.x": ("-30 mm", "-10 mm"),
    "cam.radius": (0.2, 0.4),
    "coupler_length": (1.9, 2.1),
    "spring.free_position": (1.9, 2.1),
}
RATIO, TORQUE = "ratio mean_absolute balancing_torque", "mean_absolute balancing_torque"


@pytest.fixture(scope="module")
def bound():
    return ks.design.optimise(
        SAW, CAM, "largest_absolute cam_force", [*ENDS, f"{RATIO} >= 50", "largest O <= 15 kN"], variant="cam-circle"
    )


def test_one_number_is_best_where_a_search_by_values_alone_finds_it():
    from scipy.optimize import minimize_scalar

    def torque(stiffness):
        return float(np.mean(np.abs(CIRCLE.varied({"spring.stiffness": stiffness}).solve(720).balancing_torque)))

    found = ks.design.optimise(SAW, SPRING, TORQUE, variant="cam-circle")
    other = minimize_scalar(torque, bounds=(5e5, 9e5), method="bounded", options={"xatol": 1.0})
    assert_allclose(dict(found.values)["spring.stiffness"], other.x, rtol=1e-4)
    assert found.active == ()


def test_counterweight_that_makes_the_largest_shaking_force_least_is_the_one_of_balancing():
    """The mower's optimal variant, found by another search, by its unbalance along the crank and across."""
    mower = ks.load_case("mower_drive").variant("unbalanced")
    balanced = ks.load_case("mower_drive").variant("optimal").balanced.mechanism
    vary = {"crank.centre.along": (-0.3, 0.3), "crank.centre.across": (-0.1, 0.1)}
    found = ks.design.optimise(mower.scene, vary, "largest shaking_force")
    force = ks.extremes(found.scene.solve(90), "shaking_force").range[1]
    assert_allclose(
        force, ks.extremes(ks.solve(balanced, 0.0, crank_speed=mower.crank_speed), "shaking_force").range[1], rtol=1e-6
    )


def test_limits_hold_at_true_extremes_to_a_billionth(bound):
    solution = bound.scene.solve(90)
    low, high = ks.extremes(solution, "slider_position").range
    assert_allclose([low, high], [1.7, 2.3], rtol=1e-9)
    assert ks.extremes(solution, "O").range[1] <= 15e3 * (1 + 1e-9)
    assert bound.report().loc[f"{RATIO} [1]", "after"] >= 50 * (1 - 1e-8)


def test_what_is_derived_in_the_file_follows(bound):
    numbers = bound.scene.parameters
    assert_allclose(numbers["coupler.centre.along"], numbers["coupler_length"] / 2, rtol=1e-15)


def test_report_shows_before_and_after_and_what_binds(bound):
    table = bound.report()
    assert_allclose(
        table.loc[f"{RATIO} [1]", "before"], SAW.compare("plain", "cam-circle").frame().iloc[0]["ratio"], rtol=1e-6
    )
    assert (
        table.loc["largest_absolute cam_force [N]", "after"]
        < 0.31 * table.loc["largest_absolute cam_force [N]", "before"]
    )
    assert table["binds"].to_list() == [False, True, True, True, False]
    assert set(bound.active) == {*ENDS, f"{RATIO} >= 50"}
    assert isinstance(bound.numbers(), pd.DataFrame)


def test_price_of_a_limit_is_what_giving_way_gains(bound):
    eased = ks.design.optimise(
        SAW, CAM, "largest_absolute cam_force", [*ENDS, f"{RATIO} >= 49.9"], variant="cam-circle", begin=bound.values
    )
    row = "largest_absolute cam_force [N]"
    gained = bound.report().loc[row, "after"] - eased.report().loc[row, "after"]
    assert_allclose(bound.prices[f"{RATIO} >= 50"], gained / 0.1, rtol=0.02)


def test_price_of_a_bound_is_the_slope_there():
    found = ks.design.optimise(SAW, {"spring.stiffness": (5e5, 6e5)}, TORQUE, variant="cam-circle")
    assert dict(found.values) == {"spring.stiffness": 6e5}
    assert found.active == ("spring.stiffness",)
    program = ks.compile(CIRCLE.scene, "balancing_torque", engine="numpy")
    angle = np.linspace(0, 2 * np.pi, 1440, endpoint=False)
    torque = program(angle, {"spring.stiffness": 6e5})["balancing_torque"]
    slope = program.derivatives(angle, "spring.stiffness", {"spring.stiffness": 6e5})["balancing_torque"]
    expected = -np.mean(np.sign(torque) * slope["spring.stiffness"])
    assert_allclose(found.prices["spring.stiffness"], expected, rtol=1e-3)


def test_several_starts_reach_the_same_design_and_the_seed_repeats_them():
    one, other = (
        ks.design.optimise(SAW, SPRING, TORQUE, variant="cam-circle", starts=4, seed=3, angles=360) for _ in range(2)
    )
    assert one.starts == other.starts
    assert_allclose(one.starts, one.starts[0], rtol=1e-6)


def test_what_starts_came_to_is_told_as_asked():
    found = ks.design.optimise(SAW, SPRING, maximise=RATIO, variant="cam-circle", angles=360)
    assert_allclose(found.starts, [found.report().loc[f"{RATIO} [1]", "after"]], rtol=1e-5)


def test_the_same_optimum_under_an_independent_solution(bound):
    compared = ks.compare(SAW.solve("plain"), bound.scene.solve(720)).frame()
    assert_allclose(compared.iloc[0]["ratio"], bound.report().loc[f"{RATIO} [1]", "after"], rtol=1e-6)


def test_any_machine_can_be_improved():
    """A four-bar's rocker is given the pivot that makes its largest reaction least, its swing kept."""
    bars = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(20.0, 0.15, 0.2))
    scene = ks.Scene(bars, 10.0, loads=ks.Gravity())
    vary = {"rocker_pivot.x": (0.3, 0.4), "rocker_pivot.y": (0.0, 0.2), "coupler_length": (0.35, 0.5)}
    found = ks.design.optimise(scene, vary, "largest O", limits="largest_absolute balancing_torque <= 12 N m")
    table = found.report()["after"]
    assert table["largest O [N]"] < 0.8 * found.report()["before"]["largest O [N]"]
    assert table["largest_absolute balancing_torque [N m]"] <= 12.0 * (1 + 1e-9)


def test_losses_and_pressure_angle_are_outputs_too():
    """No design of a grid that keeps the limit loses less."""
    friction = {"O": ks.PinFriction(0.1, 0.1), "guide": ks.GuideFriction(0.1)}
    scene = ks.Scene(CIRCLE.mechanism, CIRCLE.crank_speed, loads=CIRCLE.loads, friction=friction)
    vary = {"spring.stiffness": (6e5, 9e5), "cam.centre.x": (-0.03, -0.01)}
    found = ks.design.optimise(
        scene, vary, "mean friction_loss", "largest_absolute pressure_angle <= 3.7 deg", angles=180
    )
    after = found.report()["after"]
    assert after["largest_absolute pressure_angle [rad]"] <= np.radians(3.7) * (1 + 1e-9)
    for stiffness in np.linspace(6e5, 9e5, 5):
        for centre in np.linspace(-0.03, -0.01, 5):
            other = scene.varied({"spring.stiffness": stiffness, "cam.centre.x": centre}).solve(180)
            if np.abs(other.pressure_angle).max() <= np.radians(3.7):
                assert np.mean(other.friction_loss) >= after["mean friction_loss [W]"] * (1 - 1e-6)


def test_demands_end_with_how_near_the_best_comes():
    with pytest.raises(ks.DesignError, match=r"nearest misses ratio .* >= 100, where it comes to 52\.8") as error:
        ks.design.optimise(SAW, SPRING, TORQUE, limits=f"{RATIO} >= 100", variant="cam-circle", angles=180)
    assert set(error.value.values) == {"spring.stiffness"}


def test_a_machine_that_cannot_be_built_within_the_bounds_is_said():
    pump = ks.Scene(ks.crank_slider(0.1, 0.3, slider=ks.Link(1.0)), 10.0)
    with pytest.raises(ks.DesignError, match="no design that can be built"):
        ks.design.optimise(pump, {"coupler_length": (0.05, 0.09)}, "largest O", angles=90)


def test_derivatives_of_a_design_are_those_of_small_changes():
    problem = Problem(CIRCLE, {"coupler_length": (1.9, 2.1), "slider.mass": (500, 700)}, ["O", "balancing_torque"])
    start = problem.start
    for name in ("O", "balancing_torque"):
        for place, step in enumerate((1e-6, 1e-2)):
            move = step * np.eye(2)[place]
            high, low = (problem.curves(start + side * move)[name][0] for side in (1, -1))
            slopes = problem.curves(start)[name].slopes[place]
            assert np.abs((high - low) / (2 * step) - slopes).max() < 1e-6 * np.abs(slopes).max()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("largest O <= 0.75 kN", ("<=", 750.0)),
        ("largest O ≤ 750 N", ("<=", 750.0)),
        ("  smallest cam_force >= -2 kN ", (">=", -2000.0)),
        ("largest slider_position == 2300 mm", ("=", 2.3)),
        ("largest_absolute pressure_angle <= 30 deg", ("<=", np.pi / 6)),
        (f"{RATIO} >= 50", (">=", 50.0)),
    ],
)
def test_limits_are_read_with_their_units(text, expected):
    found = demand(text, CIRCLE.scene)
    assert (found.relation, found.value) == (expected[0], pytest.approx(expected[1], rel=1e-15))
