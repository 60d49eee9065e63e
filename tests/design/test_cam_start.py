"""Where the search for a torque-free cam begins: from any machine with a slider, its coupler and stroke kept."""

import inspect
from dataclasses import fields

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.casefile.designs import CAM
from kinetostatics.design.cam_start import Options
from support.case_files import shipped

SAW, MOWER = shipped("sawframe_2r63"), shipped("mower_drive")
RATIO = "ratio mean_absolute balancing_torque"
PEAK, SQUARES = "largest_absolute balancing_torque", "rms balancing_torque"


def torque_free(*harmonics, variant="cam-cosine", **options):
    return ks.design.torque_free_cam(SAW, *harmonics, variant=variant, **options)


def test_coupler_keeps_mass_inertia_and_the_share_of_its_mass_centre():
    found = torque_free(2, gravity=False, minimise=SQUARES)
    coupler = found.scene.mechanism.links["coupler"]
    assert (coupler.mass, coupler.inertia) == (150.0, 20.5)
    assert_allclose(coupler.centre[0], found.values["coupler_length"] / 2, rtol=1e-15)


def test_the_study_s_ends_are_kept_from_a_plain_machine_as_well():
    """A scene of Python, of which a plain crank-slider is the reference too."""
    plain = SAW.variant("plain").scene
    found = ks.design.torque_free_cam(plain, 3, reference=plain, minimise=SQUARES, gravity=False)
    assert_allclose(ks.extremes(found.scene.solve(90), "slider_position").range, (1.7, 2.3), rtol=1e-9)
    assert found.report().loc[f"{RATIO} [1]", "before"] == 1.0


def test_a_turned_machine_has_the_turned_design():
    """Guide and gravity turned together by 0.4 rad: the same harmonics."""
    plain = SAW.variant("plain").scene
    parts = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}
    turned = ks.Scene(
        ks.crank_slider(0.3, 2.0, guide_angle=0.4, **parts), plain.crank_speed, loads=ks.Gravity(9.81, 0.4 - np.pi / 2)
    )
    one, other = (ks.design.torque_free_cam(scene, 2, 2, minimise=SQUARES) for scene in (plain, turned))
    assert_allclose(list(other.values.values()), list(one.values.values()), rtol=1e-5, atol=1e-7)


def test_all_that_is_wrong_with_options_is_told_at_once_wherever_they_come_from():
    wrong = {"cosine": 0, "sine": 100, "gravity": 1, "counterweight": -3.0, "guide_offset": "low"}
    with pytest.raises(ks.ParameterError) as options:
        Options.checked(**wrong)
    with pytest.raises(ks.ParameterError) as found:
        torque_free(**wrong, starts=0)
    for told in map(str, (options.value, found.value)):
        for name in wrong:
            assert f"{name} must be" in told
    assert "starts must be" in str(found.value)


def test_options_are_those_of_the_function_and_of_case_files():
    function = inspect.signature(ks.design.torque_free_cam).parameters
    for option in fields(Options):
        assert function[option.name].default == option.default
    assert {"cosine", "sine", "ends", "guide_offset", "coupler_spring", "counterweight", "cubic"} == set(CAM)
