"""Optimisation problems, their measures and optima."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.cycle.reductions import parsed
from kinetostatics.design import measures
from kinetostatics.design.constraints import parse_output
from kinetostatics.design.problem import Problem, true_value
from support.case_files import PLAIN, case_file, shipped
from support.improved_saws import CIRCLE, RATIO, SAW, SPRING, TORQUE, bound


def test_optimum_of_one_number_equals_a_scan():
    from scipy.optimize import minimize_scalar

    def torque(stiffness):
        return float(np.mean(np.abs(CIRCLE.varied({"spring.stiffness": stiffness}).solve(720).balancing_torque)))

    found = ks.design.optimise(SAW, SPRING, TORQUE, variant="cam-circle")
    other = minimize_scalar(torque, bounds=(5e5, 9e5), method="bounded", options={"xatol": 1.0})
    assert_allclose(dict(found.values)["spring.stiffness"], other.x, rtol=1e-4)
    assert found.active == ()


def test_counterweight_optimum_equals_balancing():
    """The mower's optimal variant, found by another search, by its unbalance along the crank and across."""
    mower = shipped("mower_drive").variant("unbalanced")
    balanced = shipped("mower_drive").variant("optimal").balanced.mechanism
    vary = {"crank.centre.along": (-0.3, 0.3), "crank.centre.across": (-0.1, 0.1)}
    found = ks.design.optimise(mower.scene, vary, "largest shaking_force")
    force = ks.extremes(found.scene.solve(90), "shaking_force").range[1]
    assert_allclose(
        force, ks.extremes(ks.solve(balanced, 0.0, crank_speed=mower.crank_speed), "shaking_force").range[1], rtol=1e-6
    )


@pytest.mark.slow
def test_limits_hold_at_true_extremes_to_a_billionth():
    solution = bound().scene.solve(90)
    low, high = ks.extremes(solution, "slider_position").range
    assert_allclose([low, high], [1.7, 2.3], rtol=1e-9)
    assert ks.extremes(solution, "O").range[1] <= 15e3 * (1 + 1e-9)
    assert bound().report().loc[f"{RATIO} [1]", "after"] >= 50 * (1 - 1e-8)


def test_a_limit_of_a_ratio_holds_where_the_speed_varies():
    """The reference runs at the design's speed, so its output is no constant."""
    vary = SPRING | {"crank_speed": (33.0, 34.0)}
    found = ks.design.optimise(SAW, vary, maximise=RATIO, limits=f"{RATIO} <= 5", variant="cam-circle", angles=180)
    assert found.report().loc[f"{RATIO} [1]", "after"] == pytest.approx(5.0, rel=1e-2)


@pytest.mark.slow
def test_optimum_holds_in_an_independent_solution():
    compared = ks.compare(SAW.solve("plain"), bound().scene.solve(720)).frame()
    assert_allclose(compared.iloc[0]["ratio"], bound().report().loc[f"{RATIO} [1]", "after"], rtol=1e-6)


def test_each_step_of_a_search_can_be_followed():
    steps, limit = [], "largest O <= 20 kN"
    found = ks.design.optimise(SAW, SPRING, TORQUE, limit, variant="cam-circle", angles=90, progress=steps.append)
    assert [step.values.keys() for step in steps] == [SPRING.keys()] * len(steps)
    last = min(steps, key=lambda step: (step.missed > 1e-9, step.goal))
    assert last.values == pytest.approx(found.values, rel=1e-4)
    assert last.goal == pytest.approx(found.report().loc[f"{TORQUE} [N m]", "after"], rel=1e-3)
    low = SAW.variant("cam-circle").scene.varied(steps[0].values).solve(90)
    assert steps[0].goal == pytest.approx(np.abs(low.balancing_torque).mean(), rel=1e-2)
    excess = np.hypot(*low.reaction("O")).max() / 20e3 - 1.0
    assert steps[0].missed == pytest.approx(max(excess, 0.0), abs=1e-2)


@pytest.mark.slow
def test_any_machine_can_be_improved():
    """A four-bar's rocker is given the pivot that makes its largest reaction least, its swing kept."""
    bars = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), rocker=ks.Link(20.0, 0.15, 0.2))
    scene = ks.Scene(bars, 10.0, loads=ks.Gravity())
    vary = {"rocker_pivot.x": (0.3, 0.4), "rocker_pivot.y": (0.0, 0.2), "coupler_length": (0.35, 0.5)}
    found = ks.design.optimise(scene, vary, "largest O", limits="largest_absolute balancing_torque <= 12 N m")
    table = found.report()["after"]
    assert table["largest O [N]"] < 0.8 * found.report()["before"]["largest O [N]"]
    assert table["largest_absolute balancing_torque [N m]"] <= 12.0 * (1 + 1e-9)


@pytest.mark.slow
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


@pytest.mark.slow
def test_many_angles_take_linear_memory():
    """Of 60 000 crank angles that would be 29 GB."""
    vary = {"spring.stiffness": (6e5, 9e5)}
    found = ks.design.optimise(
        ks.load_case("sawframe_2r63"), vary, "mean_absolute balancing_torque", variant="cam-circle", angles=60_000
    )
    assert abs(found.values["spring.stiffness"] / 804e3 - 1) < 0.02


ROLLED = ks.Scene(
    ks.Mechanism(
        "saw with a roller",
        CIRCLE.scene.mechanism.crank,
        (
            ks.CamRoller(ks.cams.Harmonic((0.3, -0.0219, 0.001)), roller=ks.Roller(0.05, 0.06, 210e9, 0.3)),
            CIRCLE.scene.mechanism.groups[1],
        ),
    ),
    CIRCLE.crank_speed,
    loads=CIRCLE.loads,
)


@pytest.mark.slow
def test_least_swing_saw_keeps_its_contact_pressure():
    """A flywheel 14 times lighter, and no roller pressed harder than it may be; by the true running of each."""
    vary = {
        "cam.cosine.0": ("250 mm", "350 mm"),
        "cam.cosine.1": ("-50 mm", "50 mm"),
        "cam.cosine.2": ("-5 mm", "5 mm"),
        "coupler_length": ("1.9 m", "2.1 m"),
        "spring.stiffness": ("600 kN/m", "900 kN/m"),
        "spring.free_position": ("1.9 m", "2.1 m"),
    }
    ends = ["largest slider_position = 2.3 m", "smallest slider_position = 1.7 m"]
    goal, pressed = "swing balancing_torque", "largest contact_pressure <= 400 MPa"
    free, held = (ks.design.optimise(ROLLED, vary, goal, limits=[*ends, *more]) for more in ([], [pressed]))
    energy = {found: ks.drive.flywheel(found.scene, 0.01).energy for found in (free, held)}
    peak = {found: ks.extremes(found.scene.solve(12), "contact_pressure").largest for found in (free, held)}
    assert peak[free] > 4.2e8
    assert peak[held] <= 4e8 * (1 + 1e-9)
    assert "largest contact_pressure <= 400000000 Pa" in held.active
    assert energy[free] < energy[held] < ks.drive.flywheel(ROLLED, 0.01).energy / 14
    assert_allclose(held.report().loc["swing balancing_torque [J]", "after"], energy[held], rtol=1e-9)
    price = held.prices["largest contact_pressure <= 400000000 Pa"]
    eased = ks.design.optimise(ROLLED, vary, goal, limits=[*ends, "largest contact_pressure <= 400.01 MPa"])
    saved = energy[held] - ks.drive.flywheel(eased.scene, 0.01).energy
    assert_allclose(saved, 1e4 * price, rtol=0.02)  # two pairs of extremes compete, and both count


# Outputs as functions of the numbers that vary, with their derivatives


def test_design_derivatives_equal_small_changes():
    problem = Problem(CIRCLE, {"coupler_length": (1.9, 2.1), "slider.mass": (500, 700)}, ["O", "balancing_torque"])
    start = problem.start
    for name in ("O", "balancing_torque"):
        for place, step in enumerate((1e-6, 1e-2)):
            move = step * np.eye(2)[place]
            high, low = (problem.curves(start + side * move)[name][0] for side in (1, -1))
            slopes = problem.curves(start)[name].slopes[place]
            assert np.abs((high - low) / (2 * step) - slopes).max() < 1e-6 * np.abs(slopes).max()


FOUR_STROKE = ks.Scene(
    ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)),
    100.0,
    loads=ks.ProcessForce(lambda motion: 300.0 * np.cos(1.5 * motion.crank_angle), period=4 * np.pi),
)


@pytest.mark.parametrize("name", ["harmonic_1", "harmonic_2", "swing", "largest", "rms"])
def test_outputs_over_two_turns_are_those_of_sweeps(name):
    """Harmonics are those of the crank angle, and energy is gained over the whole period."""
    text = f"{name} balancing_torque"
    table = ks.sweep(FOUR_STROKE, ks.designs.grid({"slider.mass": "1..2 kg:2"}), [text], progress=False)
    problem = Problem(FOUR_STROKE, {"slider.mass": (0.5, 3.0)}, ["balancing_torque"])
    for mass, expected in table.to_numpy(dtype=object)[:, :2]:
        output = parse_output(text, FOUR_STROKE)
        assert problem.output(output, np.array([mass]))[0] == pytest.approx(expected, rel=1e-7)
        assert true_value(output, FOUR_STROKE.varied({"slider.mass": mass})) == pytest.approx(expected, rel=1e-7)


def test_unknown_number_is_refused_derived_is_not(tmp_path):
    text = (
        PLAIN
        + """[variants.cam]
mechanism = "cam-crank-slider"
cam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }
roller = { radius = "50 mm", width = "60 mm", youngs_modulus = "210 GPa", poissons_ratio = 0.3 }
"""
    )
    variant = ks.load_case(case_file(tmp_path, text)).variant("cam")
    vary = {"roller.cam_youngs_modulus": ("100 GPa", "200 GPa"), "coupler_length": ("2 m", "2.1 m")}
    with pytest.raises(
        ks.ParameterError,
        match=r"roller\.cam_youngs_modulus is neither in the source nor in its scene; give it a start value",
    ):
        Problem(variant, vary, ["contact_pressure"])
    told = ks.load_case(
        case_file(tmp_path, text.replace("poissons", 'cam_youngs_modulus = "150 GPa", poissons'))
    ).variant("cam")
    problem = Problem(told, vary, ["contact_pressure"])
    assert problem.start == pytest.approx([150e9, told.scene.parameters["coupler_length"]])
    value, slopes = problem.output(parse_output("largest contact_pressure", told), problem.start)
    assert value > 0
    assert slopes[0] > 0  # a stiffer cam is pressed harder


def spiky(width=2e-5):
    """A pump on which a force acts on less than a thousandth of the turn, between even samples."""
    table = ks.Table([0.1, 0.2, 0.2 + width, 0.2 + 2 * width, 0.3], [0.0, 0.0, 3e3, 0.0, 0.0], over="travel")
    made = ks.crank_slider(0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))
    return ks.Scene(made, 30.0, loads=[ks.Gravity(), ks.ProcessForce(table)])


def test_search_sees_a_peak_beside_a_kink():
    output, scene = parsed("largest balancing_torque"), spiky()
    problem = Problem(scene, {"slider.mass": (1.0, 3.0)}, ["balancing_torque"])
    truth = ks.extremes(scene.solve(4), "balancing_torque").range[1]
    even = measures.reduced("largest", problem.curves(problem.start)["balancing_torque"])[0]
    assert even < 0.7 * truth
    assert problem.output(output, problem.start)[0] == pytest.approx(truth, rel=1e-9)
    assert true_value(output, scene) == pytest.approx(truth, rel=1e-9)


@pytest.mark.slow
def test_a_search_keeps_a_limit_beside_a_kink():
    """Heavier, the slider meets the force with more of its own: the peak of the torque grows with its mass."""
    scene = spiky()
    before = true_value(parsed("largest O"), scene)
    found = ks.design.optimise(
        scene,
        {"slider.mass": (1.0, 6.0)},
        maximise="mean_absolute balancing_torque",
        limits=[f"largest O <= {1.02 * before} N"],
        progress=False,
    )
    assert true_value(parsed("largest O"), found.scene) <= 1.02 * before * (1 + 1e-6)


def rippling(order):
    """A pump with a rubbing guide, whose load ripples by 2e-4."""

    def push(motion):
        return -1e3 * (1.0 + 2e-4 * np.sin(order * motion.crank_angle))

    made = ks.crank_slider(0.05, 0.2, slider=ks.Link(2.0))
    return ks.Scene(made, 30.0, loads=ks.ProcessForce(push), friction={"guide": ks.GuideFriction(0.1)})


@pytest.mark.slow
def test_fine_ripples_are_resolved():
    scene = rippling(1e5)
    dense = np.linspace(0.0, 2.0 * np.pi, 2_000_001)[5::10]  # crests and troughs of the ripples
    truth = np.hypot(*scene.solve(dense).reaction("B")).max()
    assert true_value(parsed("largest B"), scene) == pytest.approx(truth, rel=1e-9)


@pytest.mark.slow
def test_an_unresolved_output_is_refused():
    scene = rippling(1e6)
    with pytest.raises(ks.DesignError, match="largest B of crank-slider is not resolved even by the finest pieces"):
        true_value(parsed("largest B"), scene)


def test_a_function_without_derivatives_is_refused():
    work = ks.ProcessForce(lambda q: np.where(np.cos(q.crank_angle) > 0.0, -9.0, 0.0))
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0)), 30.0, loads=work)
    with pytest.raises(ks.NotGivenError, match="needs derivatives, but ProcessForce on 'slider' does more than"):
        ks.design.optimise(scene, {"slider.mass": (1.0, 2.0)}, minimise="rms balancing_torque")


# Outputs with their derivatives

COUNT = 180
ANGLE = 2 * np.pi * np.arange(COUNT) / COUNT
WAVES = np.array([np.ones(COUNT), np.cos(ANGLE), np.sin(2 * ANGLE), np.cos(3 * ANGLE + 0.4), np.sin(5 * ANGLE)])
POINT = np.array([0.3, 1.0, -0.7, 0.4, 0.2])


def curve(point):
    return measures.Curve(point @ WAVES, WAVES, turns=2)


def test_swing_is_the_largest_of_its_parts():
    whole, rises = measures.reduced("swing", curve(POINT))
    values, slopes = measures.bounded("swing", curve(POINT))
    assert_allclose(values.max(), whole, rtol=1e-12)
    assert_allclose(slopes[:, values.argmax()], rises, rtol=1e-12)
    step = 1e-6
    for place in range(POINT.size):
        move = step * np.eye(POINT.size)[place]
        high, low = (measures.bounded("swing", curve(POINT + side * move))[0] for side in (1, -1))
        assert_allclose(slopes[place], (high - low) / (2 * step), rtol=0, atol=2e-7)


def test_a_range_with_a_smallest_value_of_0_is_minimised():
    corner = np.radians(40.0)
    force = ks.Table([0.0, corner, corner + 0.02, corner + 0.3, corner + 0.32, 2.0 * np.pi], [0, 0, -800, -300, 0, 0])
    loads = [ks.ProcessForce(force), ks.Spring(2000.0, 1.0)]
    scene = ks.Scene(ks.crank_slider(0.3, 1.1, slider=ks.Link(10.0)), 30.0, loads=loads)
    found = ks.design.optimise(scene, {"slider.mass": (5.0, 20.0)}, minimise="range O")
    assert found.values["slider.mass"] == pytest.approx(5.0, rel=1e-9)
    ranges = [ks.extremes(scene.varied({"slider.mass": mass}).solve(1), "O").range for mass in (5.0, 5.1, 20.0)]
    assert [low for low, _ in ranges] == pytest.approx([0.0] * 3, abs=1e-6)
    assert ranges[0][1] < ranges[1][1] < ranges[2][1]
