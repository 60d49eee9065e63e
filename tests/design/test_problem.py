"""Outputs as functions of the numbers that vary, with their derivatives."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design import measures
from kinetostatics.design.constraints import parse_output
from kinetostatics.design.problem import Problem, true_value
from kinetostatics.results.reductions import parsed
from support.case_files import PLAIN, case_file
from support.improved_saws import CIRCLE


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
        ks.ParameterError, match=r"roller\.cam_youngs_modulus is not told in the source, .*; give it a value"
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


def test_an_unresolved_output_is_refused():
    """A pump with a rubbing guide, whose load ripples by 2e-4 sixteen thousand times a turn."""

    def push(motion):
        return -1e3 * (1.0 + 2e-4 * np.sin(1e5 * motion.crank_angle))

    made = ks.crank_slider(0.05, 0.2, slider=ks.Link(2.0))
    scene = ks.Scene(made, 30.0, loads=ks.ProcessForce(push), friction={"guide": ks.GuideFriction(0.1)})
    with pytest.raises(ks.DesignError, match="largest B of crank-slider is not resolved, however fine the pieces"):
        true_value(parsed("largest B"), scene)
