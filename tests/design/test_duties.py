"""Duties: one machine in several scenes, weighted by their shares of the time."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.cycle.reductions import SolutionNumber
from kinetostatics.design.constraints import parse_output
from kinetostatics.design.duties import DutyProblem, read_duties
from kinetostatics.design.problem import true_value
from support.every import every

SPRING = ks.Spring(600e3, free_position=2.0)
IDLE = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[SPRING])
WORK = ks.ProcessForce(ks.Table([1.6, 2.4], [0.0, 0.0], over="travel", back=[50e3, 50e3]))
CUT = replace(IDLE, loads=(SPRING, WORK))
DUTIES = {"idle": (IDLE, 0.3), "cut": (CUT, 0.7)}
VARY = {"spring.stiffness": (300e3, 900e3), "spring.free_position": (1.9, 2.1)}
RMS = "rms balancing_torque"
SPREAD = ks.design.Spread(0.9, {"slider.mass": "normal 0 % +- 2 %"}, samples=32)


def mean_of(goal, values, duties=None):
    """Mean of an output over duties by the scenes themselves."""
    pairs = (duties or DUTIES).values()
    return sum(share * true_value(parse_output(goal, scene), scene.varied(values)) for scene, share in pairs)


@cache
def found(goal=RMS, limits=()):
    return ks.design.optimise(DUTIES, VARY, goal, limits, angles=90)


@pytest.mark.slow
@pytest.mark.parametrize("goal", [RMS, "largest_absolute balancing_torque", "largest O", "swing balancing_torque"])
def test_weighted_optimum_beats_its_neighbours(goal):
    """Peaks of both duties compete: by a scan around the optimum in the scenes themselves."""
    design = found(goal)
    best = mean_of(goal, design.values)
    assert design.report().iloc[0]["after"] == pytest.approx(best, rel=1e-9)
    for step in (1e-3, 3e-2):
        for angle in np.linspace(0.0, 2 * np.pi, 12, endpoint=False):
            ends = dict(zip(VARY, step * np.array([6e5 * np.cos(angle), 0.2 * np.sin(angle)]), strict=True))
            moved = {path: design.values[path] + change for path, change in ends.items()}
            assert mean_of(goal, moved) >= best * (1 - 1e-9)


@pytest.mark.parametrize("goal", [RMS, "largest O"])
def test_equal_duties_are_one_scene(goal):
    """Values, prices and active limits are those of the scene alone."""
    limits = ["largest slider_position <= 2.31 m"]
    one = ks.design.optimise(IDLE, {"crank_length": (0.2, 0.4)} | VARY, maximise=goal, limits=limits, angles=90)
    duties = {"a": (IDLE, 0.25), "b": (IDLE, 0.75)}
    two = ks.design.optimise(duties, {"crank_length": (0.2, 0.4)} | VARY, maximise=goal, limits=limits, angles=90)
    assert_allclose(list(two.values.values()), list(one.values.values()), rtol=1e-6)
    assert two.report().loc[f"mean: {one.outputs[0].column}", "after"] == pytest.approx(one.report().iloc[0]["after"])
    price = {name: value for name, value in one.prices.items() if "slider_position" in name}
    twice = sum(value for name, value in two.prices.items() if "slider_position" in name)
    assert twice == pytest.approx(sum(price.values()), rel=1e-5)


@pytest.mark.slow
def test_derivatives_of_a_weighted_output_equal_small_changes():
    problem = DutyProblem(
        read_duties(DUTIES, None, None), VARY, {name: ["O", "balancing_torque"] for name in DUTIES}, 90, "numpy"
    )
    for text in (RMS, "largest O"):
        output = parse_output(text, IDLE)
        value, slopes = problem.output(output, problem.start)
        assert value == pytest.approx(mean_of(text, problem.numbers(problem.start)), rel=1e-6)
        for place, step in enumerate((10.0, 1e-6)):
            move = step * np.eye(2)[place]
            high, low = (problem.output(output, problem.start + side * move)[0] for side in (1, -1))
            assert slopes[place] == pytest.approx((high - low) / (2 * step), rel=1e-5, abs=1e-9)


@pytest.mark.slow
@every(
    ("limit", "held", "free"),
    [
        ("cut: largest_absolute balancing_torque <= 9.5 kN m", ["cut"], ["idle"]),
        ("idle: largest_absolute balancing_torque <= 4 kN m", ["idle"], ["cut"]),
        ("largest_absolute balancing_torque <= 9.2 kN m", ["idle", "cut"], []),
    ],
)
def test_limits_hold_in_their_duties(limit, held, free):
    design = ks.design.optimise(DUTIES, VARY, RMS, limit, angles=90)
    row = "largest_absolute balancing_torque [N m]"
    value = float(limit.split()[-3]) * 1e3
    table = design.report()
    for name in held:
        assert table.loc[f"{name}: {row}", "after"] <= value * (1 + 1e-9)
        assert table.loc[f"{name}: {row}", "limit"].startswith("<= ")
    for name in free:
        assert f"{name}: {row}" not in table.index
        assert design.duty(name).report().loc[row, "limit"] == ""
    assert table["binds"].sum() >= 1


@pytest.mark.slow
def test_a_limit_of_the_mean_and_its_price():
    """Eased by a little, the goal gains as the price says."""
    at, step = 6500.0, 1.0
    tight, eased = (found("largest O", (f"mean: {RMS} <= {value} N m",)) for value in (at, at + step))
    row = f"mean: {RMS} [N m]"
    assert tight.report().loc[row, "after"] == pytest.approx(at, rel=1e-8)
    assert mean_of(RMS, tight.values) == pytest.approx(at, rel=1e-8)
    gain = mean_of("largest O", tight.values) - mean_of("largest O", eased.values)
    assert gain == pytest.approx(step * tight.report().loc[row, "price"], rel=0.02)


@pytest.mark.slow
def test_ratios_have_a_reference_in_each_duty():
    """One for both, or each its own; the mean of ratios is that of the duties."""
    plain = {"idle": replace(IDLE, loads=()), "cut": replace(CUT, loads=(WORK,))}
    design = ks.design.optimise(
        DUTIES, VARY, maximise=f"ratio {RMS}", limits="cut: ratio largest O >= 1.5", reference=plain, angles=90
    )
    table, goal = design.report()["after"], parse_output(RMS, IDLE)
    ratios = {name: true_value(goal, plain[name]) / true_value(goal, design.scene[name]) for name in DUTIES}
    assert table[f"mean: ratio {RMS} [1]"] == pytest.approx(0.3 * ratios["idle"] + 0.7 * ratios["cut"], rel=1e-9)
    assert table[f"cut: ratio {RMS} [1]"] == pytest.approx(ratios["cut"], rel=1e-9)
    assert table["cut: ratio largest O [1]"] >= 1.5 * (1 - 1e-8)
    shared = ks.design.optimise(DUTIES, VARY, maximise=f"ratio {RMS}", reference=plain["idle"], angles=90)
    assert set(shared.reference.values()) == {plain["idle"]}


@pytest.mark.slow
def test_a_function_of_the_solution_is_a_goal_as_its_text_is():
    """The largest torque at the scene's angles, as a limit of one duty; derivatives are central differences."""
    own = SolutionNumber("mean square", lambda s: float(np.mean(s.balancing_torque**2)), "N**2*m**2")
    vary = {"spring.stiffness": (300e3, 900e3)}
    by_text = ks.design.optimise({"only": (IDLE, 1.0)}, vary, RMS, angles=90)
    design = ks.design.optimise({"only": (IDLE, 1.0)}, vary, "mean square", numbers=[own])
    assert_allclose(list(design.values.values()), list(by_text.values.values()), rtol=1e-5)
    assert design.report().loc["only: mean square [N**2*m**2]", "after"] == pytest.approx(
        by_text.report().loc[f"only: {RMS} [N m]", "after"] ** 2, rel=1e-6
    )
    peak = SolutionNumber("peak", lambda s: float(np.max(np.abs(s.balancing_torque))), "N*m")
    limited = ks.design.optimise(DUTIES, vary, RMS, "cut: peak <= 16 kN m", numbers=[peak], angles=90)
    assert np.abs(limited.scene["cut"].solve(360).balancing_torque).max() <= 16e3 * (1 + 1e-7)


@pytest.mark.slow
def test_a_front_over_duties_weighs_means():
    front = ks.design.pareto(DUTIES, VARY, ("largest O", RMS), points=3, angles=90)
    for design, row in zip(front.designs, front.table.to_numpy(), strict=True):
        assert_allclose(row[:2], [mean_of("largest O", design.values), mean_of(RMS, design.values)], rtol=1e-8)
    assert np.all(np.diff(front.table.to_numpy()[:, 0]) > 0)
    assert np.all(np.diff(front.table.to_numpy()[:, 1]) < 0)
    assert_allclose(front.before, [mean_of("largest O", {}), mean_of(RMS, {})], rtol=1e-9)


@pytest.mark.slow
def test_a_robust_design_has_the_least_quantile_of_the_weighted_output():
    """Each machine has the same mass in both duties."""
    vary = {"spring.stiffness": (300e3, 900e3)}
    design = ks.design.optimise(DUTIES, vary, RMS, robust=SPREAD, angles=90)

    def quantile(stiffness):
        duties = {
            name: (scene.varied({"spring.stiffness": stiffness}), share) for name, (scene, share) in DUTIES.items()
        }
        sampled = ks.design.over_spread(duties, RMS, SPREAD, samples=32)
        alone = [ks.design.over_spread(scene, RMS, SPREAD, samples=32) for scene, _ in duties.values()]
        assert_allclose(sampled, 0.3 * alone[0] + 0.7 * alone[1], rtol=1e-12)
        return np.quantile(sampled, 0.9)

    best = design.values["spring.stiffness"]
    assert quantile(best) <= min(map(quantile, (0.95 * best, 1.05 * best)))
    table = design.report()
    assert table.index[0] == f"0.9 quantile of {RMS} [N m]"
    assert table.iloc[0]["after"] == pytest.approx(quantile(best), rel=0.01)


@pytest.mark.slow
def test_one_duty_alone_and_the_case_file(tmp_path):
    design = found()
    alone = design.duty("cut")
    assert alone.scene is design.scene["cut"]
    assert list(alone.report().index) == [f"{RMS} [N m]"]
    case = ks.load_case(design.case(tmp_path / "found.toml"))
    assert list(case.variants) == ["before-idle", "before-cut", "optimal-idle", "optimal-cut"]
    torque = case.solve("optimal-cut", 90).balancing_torque
    assert_allclose(torque, design.scene["cut"].solve(90).balancing_torque, rtol=1e-12, atol=1e-6)
    assert "2 numbers of crank-slider varied" in repr(design)


HEAVY = {"idle": (IDLE, 0.3), "cut": (replace(CUT, loads=(SPRING, WORK, ks.Gravity())), 0.7)}
OTHER = ks.Scene(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), 10.0)


@every(
    ("duties", "given", "message"),
    [
        ({}, {}, "give at least one duty"),
        ({"idle": (IDLE, 0.5), "cut": (CUT, 0.6)}, {}, r"shares must sum to 1, got 1\.1: idle 0\.5, cut 0\.6"),
        (
            {"idle": (IDLE, -0.5), "cut": (CUT, 0.0)},
            {},
            "share of idle must be greater than 0.*share of cut must be gr",
        ),
        ({"idle": (IDLE, np.nan), "cut": (CUT, "half")}, {}, "share of idle must be finite.*share of cut must be"),
        ({"idle": IDLE, "cut": (CUT, 1.0)}, {}, r"idle must be a pair \(scene, share\)"),
        ({"mean": (IDLE, 0.5), "a: b": (CUT, 0.5)}, {}, r'not "mean" and without a colon, got .mean.; .*a: b'),
        ({"idle": (3, 0.5), "cut": (CUT, 0.5)}, {}, "idle must be a Scene, got 3"),
        ({"idle": (IDLE, 0.5), "cut": (OTHER, 0.5)}, {}, "one machine, but .* of cut, a four-bar, differ from .* idle"),
        (DUTIES, {"variant": "plain"}, "variant is for cases"),
        (DUTIES, {"reference": {"idel": IDLE}}, "duty of reference is 'idel', allowed: .* did you mean 'idle'"),
        (DUTIES, {"reference": 3}, "reference of idle must be a Scene, got 3; reference of cut must be a Scene"),
        (DUTIES, {"minimise": f"ratio {RMS}"}, "idle, cut: 'ratio rms balancing_torque' needs a reference"),
        (DUTIES, {"limits": [None, 3]}, "idle, cut: limit None must be an output, .* limit 3 must be"),
        (DUTIES, {"limits": ["ct: largest O <= 1 kN"]}, "duty is 'ct', allowed: .* did you mean 'cut'"),
        (DUTIES, {"limits": ["cut: larges O <= 1 kN", "largest Q <= 1 N"]}, "(?s)idle: .*'Q'.*cut: .*'larges O'.*'Q'"),
        (HEAVY, {"vary": {"gravity.acceleration": (1, 2)}}, "design: idle: parameter is 'gravity.acceleration'"),
        (
            {"idle": (IDLE.varied({"spring.stiffness": 5e5}), 0.5), "cut": (CUT, 0.5)},
            {},
            "500000 in idle, 600000 in cut",
        ),
        (DUTIES, {"numbers": ["O"]}, "numbers must be SolutionNumbers, got 'O'"),
        (DUTIES, {"numbers": 3}, "numbers must be SolutionNumbers, got 3"),
    ],
)
def test_wrong_duties_are_refused_with_all_problems(duties, given, message):
    arguments = {"vary": VARY, "minimise": RMS, "angles": 24} | given
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.optimise(duties, **arguments)


@pytest.mark.slow
def test_a_limit_that_cannot_hold_names_its_duty():
    with pytest.raises(ks.DesignError, match="nearest misses cut: largest O <= 20000 N, where it is 1"):
        ks.design.optimise(DUTIES, VARY, RMS, ["cut: largest O <= 20 kN"], angles=24)
    with pytest.raises(ks.ParameterError, match="duty is 'saw', allowed: 'idle', 'cut'"):
        found().duty("saw")
