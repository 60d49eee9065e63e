"""A chunk of designs: what fails is set apart with its reason, and the others go on."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.case_files import shipped
from support.every import every
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, sweep


def test_failing_rows_keep_their_reasons():
    designs = pd.DataFrame(
        {
            "coupler_length [m]": [2.0, -1.0, 0.25, 2.0, 2.0, 2.0, 0.31],
            "slider.mass [kg]": [600.0, 600.0, 600.0, -5.0, np.nan, 600.0, 600.0],
            "crank_speed": [33.0, 33.0, 33.0, 33.0, 33.0, np.nan, 33.0],
        }
    )
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=36)
    assert found[FAILED].tolist() == [
        "",
        "slider group: coupler length must be greater than 0, got -1.0",
        "crank-slider cannot be assembled at 66 of 180 crank angles; change the lengths",
        "Link: mass must be at least 0, got -5.0",
        "Link: mass must be finite, got nan",
        "scene: crank_speed must be finite, got nan",
        "",
    ]
    assert np.isnan(found.iloc[:, 3:5]).all(axis=1).tolist() == [False, True, True, True, True, True, False]
    good = sweep(SAW, designs.iloc[[0, 6]], OUTPUTS, variant="plain", angles=36)
    assert_equal(found.iloc[[0, 6]], good)


def test_reasons_of_cams_tell_the_numbers_of_their_row():
    designs = pd.DataFrame({"cam.mean [m]": [2.0, 0.2, 0.1], "cam.amplitude [m]": [0.3, 0.3, 0.15]})
    found = sweep(SAW, designs, OUTPUTS, variant="cam-cosine", angles=36)[FAILED].tolist()
    assert found[0] == ""
    assert "got mean 0.2 m and amplitude 0.3 m" in found[1]
    assert "got mean 0.1 m and amplitude 0.15 m" in found[2]
    found = sweep(SAW, pd.DataFrame({"cam.centre.x": [0.0, 0.4]}), OUTPUTS, variant="cam-circle", angles=36)[FAILED]
    assert found[0] == ""
    assert "its centre is 0.4 m from O and its radius 0.3 m" in found[1]


def test_a_failing_reference_is_told_apart():
    reference = ks.Scene(ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0)), 1.0, 0.0, ())
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[-1, 1]), ["rms O", "ratio rms O"], reference=reference)
    assert found[FAILED][0] == "Link: mass must be at least 0, got -1.0"
    assert found[FAILED][1].startswith("reference: crank-slider cannot be assembled at 134 of 360")
    assert found.iloc[:, 2:4].isna().all(axis=None)


def test_a_ratio_of_nothing_to_nothing_is_told():
    found = sweep(factories.pump, DESIGNS[:2].assign(mass=[0, 1]), ["ratio rms B"], reference=factories.pump(0.1, 0.0))
    assert found[FAILED].tolist() == ["ratio rms B is no number, such as 0 / 0", ""]
    assert found.iloc[1, 2] == 0.0


def test_errors_of_a_function_stay_with_their_rows():
    designs = DESIGNS.assign(mass=DESIGNS["mass"].to_numpy()[::-1])
    found = sweep(factories.picky, designs, OUTPUTS, angles=36)
    wrong = (designs["crank [mm]"] < 300) & (designs["mass"] > 5)
    assert (found[FAILED] != "").tolist() == wrong.tolist()
    assert found[FAILED][3] == "a crank of 0.13 m does not carry 8.4 kg"
    assert_equal(found[~wrong], sweep(factories.pump, designs[~wrong], OUTPUTS, angles=36))


def test_when_all_designs_fail_all_say_why():
    found = sweep(factories.pump, DESIGNS.assign(mass=-1.0), OUTPUTS, angles=36)
    assert found[FAILED].eq("Link: mass must be at least 0, got -1.0").all()
    assert found.iloc[:, 2:4].isna().all(axis=None)


def test_the_hundredth_design_impossible_among_many():
    designs = ks.designs.random({"coupler_length": "1.8..2.2 m", "slider.mass": "500..700 kg"}, 5000)
    designs.loc[::100, "slider.mass [kg]"] = -1.0
    designs.loc[1::100, "coupler_length [m]"] = 0.25
    found = sweep(SAW, designs, OUTPUTS, variant="plain", angles=12)
    assert found[FAILED].ne("").sum() == 100
    assert found.loc[::100, FAILED].str.startswith("Link: mass").all()
    assert found.loc[1::100, FAILED].str.startswith("crank-slider cannot be assembled").all()


@pytest.mark.slow
@every("case, variant", [("shaper", "idle"), ("mower_drive_optimal", "cam-robust"), ("sawframe_2r63", "cam-circle")])
@every("angles", [13, 72, 180])
def test_few_angles_give_right_numbers(case, variant, angles):
    """Each output alone: what one needs in crank angles helps the others."""
    scene = shipped(case).variant(variant).scene
    designs = pd.DataFrame({"crank_speed": [scene.parameters["crank_speed"]]})
    for reduction in ("largest", "smallest", "range", "mean_absolute", "rms"):
        for name in ("balancing_torque", "O" if case != "shaper" else "A"):
            fine, few = (sweep(scene, designs, [f"{reduction} {name}"], angles=count) for count in (5760, angles))
            assert few.iloc[0, 1] == pytest.approx(fine.iloc[0, 1], rel=1e-3), (reduction, name)


def rippled(crank):
    """A pump with a rubbing guide, whose load ripples by 2e-4 sixteen thousand times a turn."""
    made = ks.crank_slider(crank, 0.2, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))
    push = ks.ProcessForce(lambda motion: 1e3 * (1.0 + 2e-4 * np.sin(1e5 * motion.crank_angle)))
    return ks.Scene(made, 30.0, loads=push, friction={"guide": ks.GuideFriction(0.2)})


@pytest.mark.slow
def test_unresolved_pieces_are_reported():
    """Both are halved to the same pieces, so that they agree tells nothing."""
    found = sweep(rippled, pd.DataFrame({"crank": [0.05, 0.06]}), ["largest B", "mean B"])
    assert found[FAILED].str.startswith("largest B is not resolved by").all()


def balanced(crank, mass, offset):
    """A crank whose counterweight balances the coupler's mass at its pin, but for rounding."""
    own, coupler = ks.Link(2.0, -0.5 * crank * mass, 0.01), ks.Link(mass, 0.0, 0.0)
    return ks.Scene(
        ks.crank_slider(crank, 0.2, guide_offset=offset, crank=own, coupler=coupler), 30.0, 0.0, ks.Gravity()
    )


def of_nothing(count=40):
    rng = np.random.default_rng(0)
    ranges = {"crank": (0.02, 0.08), "mass": (0.5, 3.0), "offset": (-0.05, 0.05)}
    return pd.DataFrame({name: rng.uniform(*ends, count) for name, ends in ranges.items()})


@every("reduction", ["range", "mean", "rms", "swing", "harmonic_2", "largest_at"])
def test_no_design_fails_by_rounding_of_what_is_zero(reduction):
    designs = of_nothing()
    size = sweep(balanced, designs, ["largest A"])["largest A [N]"]
    found = sweep(balanced, designs, [f"{reduction} balancing_torque", "largest A"])
    assert (found[FAILED] == "").all()
    if reduction != "largest_at":
        assert (found.iloc[:, 3].abs() < 1e-13 * size).all()
    np.testing.assert_array_equal(found["largest A [N]"], size)


def test_functions_may_change_their_arrays():
    def changing(crank, mass):
        crank *= 2.0
        return factories.pump(crank, mass)

    outputs = ["largest O", "harmonic_2 O"]
    doubled = DESIGNS.assign(**{"crank [mm]": 2.0 * DESIGNS["crank [mm]"]})
    found, expected = sweep(changing, DESIGNS, outputs), sweep(factories.pump, doubled, outputs)
    pd.testing.assert_frame_equal(found.iloc[:, 2:], expected.iloc[:, 2:], rtol=1e-12)


def test_sweep_over_nothing_has_one_design():
    found = sweep(SAW, pd.DataFrame(index=range(3)), OUTPUTS, variant="plain", angles=180)
    alone = sweep(SAW, pd.DataFrame({"crank_length": [0.3]}), OUTPUTS, variant="plain", angles=180)
    assert_equal(found, pd.concat([alone.iloc[:, 1:]] * 3, ignore_index=True))
