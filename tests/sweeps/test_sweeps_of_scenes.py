"""Sweeps and tolerances of scenes by path, and of case files, whose derived numbers follow."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.sweeps.sweeps import FAILED
from support import scenes
from support.case_files import shipped
from support.every import every

sweep = partial(ks.sweep, progress=False, angles=36)
SAW = shipped("sawframe_2r63")


def four_bar(mass=2.0, crank=0.1):
    """A crank-rocker under its weight."""
    links = {"coupler": ks.Link(mass, 0.2, 0.03), "rocker": ks.Link(2.0, 0.1, 0.02)}
    return ks.Scene(ks.four_bar(crank, 0.4, 0.3, rocker_pivot=(0.35, 0.1), **links), 20.0, 0.0, ks.Gravity())


def six_bar(mass=3.0):
    """A four-bar whose rocker pin drives a slider."""
    return ks.Scene(scenes.six_bar(mass), 20.0, 0.0, ks.Gravity())


def shaper(mass=8.0, stiffness=300.0, reach=0.55):
    """A slotted lever, a ram on a pin of it, and a spring from the frame to that pin."""
    groups = (
        ks.LeverGroup((0.0, -0.2), lever=ks.Link(mass, 0.3, 0.4)),
        ks.Pin(on="lever", at=(reach, 0.0), name="C"),
        ks.SliderGroup(0.3, ks.Guide.at(0.0, 0.33), on="C", pin="D", slider=ks.Link(10.0)),
    )
    loads = ks.Gravity(), ks.PointSpring(stiffness, 0.1, between=("C", (0.3, 0.0)))
    return ks.Scene(ks.Mechanism("shaper", ks.Crank(0.1), groups), 6.0, 0.0, loads)


def engine(mass=2.0, force=500.0):
    """A swinging cylinder and a yoke on one crank pin, under pressure, a torque and a damper."""
    cylinder = ks.CylinderGroup((0.1, -0.4), rod=ks.Link(mass, 0.1, 0.02), cylinder=ks.Link(3.0, 0.1, 0.03))
    yoke = ks.YokeGroup(ks.Guide.at(0.0), 1.2, label="2", slider=ks.Link(2.0))
    loads = (
        ks.PointForce(force, between=(("rod", 0.0, 0.0), "O2")),
        ks.Torque(3.0, on="cylinder"),
        ks.PointDamper(9.0, between=("B", (1, 1))),
    )
    return ks.Scene(ks.Mechanism("engine", ks.Crank(0.1), (cylinder, yoke)), 20.0, 0.0, loads)


ROWS = [
    (shaper(), "lever.mass [kg]", [7.0, 9.0], shaper),
    (shaper(), "point_spring.stiffness", [200.0, 400.0], lambda stiffness: shaper(stiffness=stiffness)),
    (shaper(), "pin_C.along", [0.54, 0.56], lambda reach: shaper(reach=reach)),
    (engine(), "point_force.value", [-100.0, 900.0], lambda force: engine(force=force)),
    (engine(), "rod.mass", [1.0, 3.0], engine),
    (six_bar(), "slider2.mass [kg]", [1.0, 3.0, 9.0], six_bar),
    (four_bar(), "coupler.mass [g]", [500.0, 4000.0], lambda mass: four_bar(1e-3 * mass)),
    (four_bar(), "crank_length", [0.05, 0.08], lambda length: four_bar(crank=length)),
]


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize(("scene", "column", "values", "made"), ROWS)
def test_a_scene_is_swept_by_path_and_all_else_stays(scene, column, values, made, engine, interpreted):
    outputs = ["rms balancing_torque", "rms O2"]
    found = sweep(scene, pd.DataFrame({column: values}), outputs, angles=72, engine=engine)
    assert found[FAILED].tolist() == [""] * len(values)
    for row, value in enumerate(values):
        s = made(value).solve(72)
        expected = [np.sqrt((s.balancing_torque**2).mean()), np.sqrt((s.reaction("O2") ** 2).sum(axis=0).mean())]
        assert found.iloc[row, 1:3].tolist() == pytest.approx(expected, rel=1e-12)


def test_output_units_are_the_declared_ones():
    outputs = ["largest guide_moment2", "largest guide_force2", "range slider2_velocity", "largest_at O", "ratio rms O"]
    found = sweep(six_bar(), pd.DataFrame({"slider2.mass": [1.0]}), outputs, reference=six_bar(6.0))
    assert found.columns[1:-1].tolist() == [
        "largest guide_moment2 [N m]",
        "largest guide_force2 [N]",
        "range slider2_velocity [m/s]",
        "largest_at O [rad]",
        "ratio rms O [1]",
    ]
    with pytest.raises(ks.QuantityError, match="did you mean 'guide_force2'"):
        sweep(six_bar(), pd.DataFrame({"slider2.mass": [1.0]}), ["rms guide_force"])


def test_a_crank_alone_is_swept():
    disc = ks.Scene(ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=3.0)), ()), 5.0, 2.0)
    found = sweep(disc, pd.DataFrame({"crank.inertia": [1.0, 3.0]}), "largest balancing_torque")
    assert found.iloc[:, 1].tolist() == [2.0, 6.0]


def test_reference_takes_shared_parameters():
    designs = pd.DataFrame({"slider2.mass": [1.0, 5.0], "crank_speed": [10.0, 30.0]})
    assert sweep(six_bar(), designs, "ratio rms O", reference=six_bar(7.0)).iloc[:, 2].tolist() == [1.0, 1.0]
    found = sweep(six_bar(), designs, "ratio rms O", reference=four_bar())
    expected = [
        ks.sweep(scene, designs[columns], "rms O", progress=False, angles=36).iloc[:, -2].to_numpy()
        for scene, columns in ((four_bar(), ["crank_speed"]), (six_bar(), ["slider2.mass", "crank_speed"]))
    ]
    assert found.iloc[:, 2].to_numpy() == pytest.approx(expected[0] / expected[1], rel=1e-12)


WRONG = [
    (six_bar(), {"slider.mass": [1.0]}, {}, "did you mean 'slider2.mass'"),
    (six_bar(), {"slider2.mass [m]": [1.0]}, {}, '"m" does not measure the same as "kg"'),
    (
        six_bar(),
        {"slider2.mass": [1.0]},
        {"reference": "plain"},
        "reference must be a Scene, like the source, a Scene, got 'plain'",
    ),
    (six_bar(), {"slider2.mass": [1.0]}, {}, "ratios need a reference: a Scene, got None"),
    (3, {"slider2.mass": [1.0]}, {}, "source must be a Case, as from ks.load_case, a Scene or a function"),
    (six_bar().mechanism, {"slider2.mass": [1.0]}, {}, "source must be a Case"),
]


@every(("source", "designs", "options", "message"), WRONG)
def test_what_cannot_be_varied_is_refused(source, designs, options, message):
    with pytest.raises(ks.ParameterError, match=message):
        sweep(source, pd.DataFrame(designs), "ratio rms O", **options)


def test_impossible_scene_designs_have_reasons():
    found = sweep(six_bar(), pd.DataFrame({"slider2.mass": [1.0, -1.0], "coupler_length2": [0.5, 0.5]}), "rms O")
    assert found[FAILED].tolist() == ["", "Link: mass must be at least 0, got -1.0"]


def test_scene_sweep_resumes_in_its_folder(tmp_path):
    designs = pd.DataFrame({"slider2.mass": [1.0, 5.0]})
    first = sweep(six_bar(), designs, "rms O", folder=tmp_path)
    pd.testing.assert_frame_equal(sweep(six_bar(), designs, "rms O", folder=tmp_path), first, check_exact=True)
    with pytest.raises(ks.ParameterError, match="differs in scene;"):
        sweep(six_bar(4.0), designs, "rms O", folder=tmp_path)


def test_scene_tolerances_equal_a_function():
    spreads = {"slider2.mass": "normal 3 kg +- 0.1 kg"}
    options = {"count": 16, "progress": False, "angles": 36}
    found = ks.tolerances(six_bar(), "rms O", spreads, **options)
    made = ks.tolerances(lambda mass: six_bar(mass), "rms O", {"mass": spreads["slider2.mass"]}, **options)
    assert found.outputs == made.outputs == ("rms O [N]",)
    np.testing.assert_allclose(found.table.iloc[:, 1], made.table.iloc[:, 1], rtol=1e-13)
    assert found.share("rms O", above=0.0) == 1.0
    with pytest.raises(ks.ParameterError, match="output is 'rms B'"):
        found.share("rms B")


def test_derived_numbers_follow_in_variants_only():
    """The spring balances the slider, the coupler's centre is at mid-length."""
    variant = SAW.variant("cam-circle")
    assert variant.parameters["spring.stiffness"] == "balance the slider"
    assert variant.units["spring.stiffness"] == "N/m"
    values = {"slider.mass": 700.0, "coupler_length": 2.1}
    varied, scene = variant.varied(values).scene, variant.scene.varied(values)
    before = variant.scene.parameters
    changed = {path for path, value in varied.parameters.items() if value != before[path]}
    assert changed == {*values, "spring.stiffness", "coupler.centre.along"}
    assert varied.parameters["spring.stiffness"] == pytest.approx(before["spring.stiffness"] * 7 / 6, rel=1e-14)
    assert {path for path, value in scene.parameters.items() if value != before[path]} == set(values)


def test_a_variant_is_swept_like_its_case():
    designs = pd.DataFrame({"slider.mass": [500.0, 700.0]})
    of_case = sweep(SAW, designs, "ratio rms O", variant="cam-circle")
    of_variant = sweep(SAW.variant("cam-circle"), designs, "ratio rms O", reference=SAW.variant("plain"))
    pd.testing.assert_frame_equal(of_case, of_variant, check_exact=True)
    kept = sweep(SAW.variant("cam-circle").scene, designs, "rms O").iloc[:, 1]
    followed = sweep(SAW, designs, "rms O", variant="cam-circle").iloc[:, 1]
    assert (abs(kept - followed) > 1e-3 * followed).all()


@pytest.mark.parametrize("rise", [0.0, 1.0])
def test_peak_at_an_undeclared_jump_is_found(rise):
    def press(motion):
        angle = np.degrees(motion.crank_angle % (2 * np.pi))
        if rise:
            return 40e3 * np.clip((angle - 160) / rise, 0, 1) * np.clip((180 + rise - angle) / rise, 0, 1)
        return np.where((angle > 160) & (angle <= 180), 40e3, 0.0)

    scene = ks.Scene(ks.crank_slider(0.08, 0.4, slider=ks.Link(25)), 4 * np.pi, loads=ks.ProcessForce(press))
    table = sweep(scene, pd.DataFrame({"coupler_length": [0.4, 0.5]}), ["largest balancing_torque"], angles=360)
    assert table[FAILED].tolist() == ["", ""]
    assert table.iloc[0, 1] == pytest.approx(ks.extremes(scene.solve(12), "balancing_torque").range[1], rel=1e-7)


@pytest.mark.slow
def test_spreads_and_data_sets_of_new_groups_and_loads(tmp_path):
    spreads = {"point_spring.stiffness": "normal 300 N/m +- 3 N/m", "lever_pivot.y": "-0.201..-0.199 m"}
    found = ks.tolerances(shaper(), "rms O2", spreads, count=16, progress=False, angles=24)
    assert found.table["rms O2 [N]"].std() > 0
    designs = pd.DataFrame({"lever.mass": np.linspace(7.0, 9.0, 5)})
    first, again = (sweep(shaper(), designs, "rms O2", folder=tmp_path) for _ in range(2))
    assert first.equals(again)
    assert first.iloc[:, 1].is_monotonic_increasing


@pytest.mark.slow
def test_case_losses_are_outputs():
    """Up to what even samples make of the jumps of friction between them."""
    case = ks.load_case("sawframe_2r63_friction")
    masses = pd.DataFrame({"slider.mass [kg]": [500.0, 600.0]})
    outputs = ["mean friction_loss", "mean A_friction_loss", "ratio mean friction_loss"]
    table = ks.sweep(case, masses, outputs, variant="plain", angles=3600, progress=False)
    for row, mass in enumerate(masses.iloc[:, 0]):
        losses = case.variant("plain").varied({"slider.mass": mass}).solve(8).losses
        assert table["mean friction_loss [W]"][row] == pytest.approx(losses.total, rel=2e-5)
        assert table["mean A_friction_loss [W]"][row] == pytest.approx(losses.friction["A"], rel=2e-5)
    # a design's pieces are halved for all its outputs together, the reference's for the ratio alone
    assert table["ratio mean friction_loss [1]"].tolist() == pytest.approx([1.0, 1.0], rel=1e-14)
    coefficients = pd.DataFrame({"friction.guide.mu": [0.0, 0.1]})
    lost = ks.sweep(case, coefficients, "mean guide_friction_loss", variant="plain", angles=3600, progress=False).iloc[
        :, 1
    ]
    assert lost[0] == 0.0
    assert lost[1] == pytest.approx(case.solve("plain", 8).losses.friction["guide"], rel=2e-5)
