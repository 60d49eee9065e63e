"""Torque-free cams: what they must reach, from where, what gravity forbids, and that the designs are what they say."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.case_files import shipped

pytestmark = pytest.mark.slow

SAW, MOWER = shipped("sawframe_2r63"), shipped("mower_drive")
RATIO = "ratio mean_absolute balancing_torque"
PEAK, SQUARES = "largest_absolute balancing_torque", "rms balancing_torque"


def reached(found):
    """Ratio, peak torque, reaction O and cam force by an independent solution and its true extremes."""
    solution = found.scene.solve(2880)
    plain = found.reference.solve(2880)
    ratio = ks.compare(plain, solution).frame().iloc[0]["ratio"]
    names = ("balancing_torque", "O", "cam_force", "slider_position")
    return ratio, *(ks.extremes(solution, name) for name in names)


def torque_free(*harmonics, variant="cam-cosine", **options):
    return ks.design.torque_free_cam(SAW, *harmonics, variant=variant, **options)


@pytest.mark.parametrize(("harmonics", "least"), [(1, 55.6), (2, 463), (3, 4570), (4, 5e4), (8, 3e9)])
def test_without_weight_symmetric_cams_converge_geometrically(harmonics, least):
    found = torque_free(harmonics, gravity=False)
    assert found.report().loc[f"{RATIO} [1]", "after"] >= least
    assert np.isinf(found.bound)
    assert not any(isinstance(load, ks.Gravity) for load in found.scene.loads)


def test_three_cosines_reach_the_bound_of_symmetric_cams_with_peak_and_reaction_in_one_design():
    found = torque_free(3, limits=[f"{PEAK} <= 239 N m", "largest O <= 0.75 kN"], minimise=SQUARES)
    ratio, torque, support, _, position = reached(found)
    assert ratio >= 166
    assert ratio <= found.bound
    assert max(map(abs, torque.range)) <= 239.0 * (1 + 1e-9)
    assert support.range[1] <= 750.0 * (1 + 1e-9)
    assert_allclose(position.range, (1.7, 2.3), rtol=1e-9)


@pytest.mark.parametrize(("harmonics", "least", "evaluations"), [(2, 264, 150), (4, 411, 150), (8, 670, 250)])
def test_sine_terms_break_the_symmetry(harmonics, least, evaluations):
    found = torque_free(harmonics, harmonics, limits="largest_absolute cam_force <= 18 kN")
    ratio, _, _, force, position = reached(found)
    assert ratio >= least
    assert max(map(abs, force.range)) <= 18e3 * (1 + 1e-9)
    assert_allclose(position.range, (1.7, 2.3), rtol=1e-9)
    assert found.evaluations <= evaluations


def test_a_torsion_spring_on_the_coupler_carries_its_weight():
    found = torque_free(8, 8, coupler_spring=-1.5, minimise=SQUARES)
    assert reached(found)[0] >= 1e6
    (spring,) = (load for load in found.scene.loads if isinstance(load, ks.TorsionSpring))
    assert (spring.on, spring.against) == ("coupler", "slider")
    assert_allclose(
        spring.couple(found.scene.solve([0.0])), -150.0 * 9.81 * found.values["coupler_length"] / 2, rtol=1e-3
    )
    assert found.report().loc["largest_absolute guide_moment [N m]", "after"] > 1500.0


def test_a_counterweight_carries_it_too_at_the_price_of_its_centrifugal_force():
    found = torque_free(6, 6, counterweight=150.0, minimise=SQUARES)
    ratio, _, support, *_ = reached(found)
    assert ratio >= 1e6
    assert_allclose(support.range[1], 75.0 * 0.3 * found.scene.crank_speed**2, rtol=0.1)


def test_a_progressive_spring_takes_a_cam_of_less_force():
    limit = f"{RATIO} >= 50"
    found = torque_free(6, 6, cubic=(0, 2e7), minimise="largest_absolute cam_force", limits=limit)
    ratio, _, _, force, position = reached(found)
    assert ratio >= 50 * (1 - 1e-6)
    assert max(map(abs, force.range)) <= 12.3e3
    assert_allclose(position.range, (1.7, 2.3), rtol=1e-9)


def test_the_mower_too_as_a_cam_balanced_machine():
    given = {"variant": "unbalanced", "reference": "unbalanced"}
    ends = ks.extremes(MOWER.solve("unbalanced"), "slider_position").range
    for harmonics, offset, least in [((4, 0), 0.0, 1e5), ((8, 8), None, 400)]:
        found = ks.design.torque_free_cam(MOWER, *harmonics, guide_offset=offset, **given)
        ratio, *_, position = reached(found)
        assert ratio >= least
        assert_allclose(position.range, ends, rtol=1e-9)
        assert found.scene.parameters["guide_offset"] == (-0.02 if offset is None else offset)


def test_a_ratio_beyond_the_bound_ends_with_the_bound_and_what_may_help():
    with pytest.raises(
        ks.DesignError, match=r">= 200 cannot be kept; .* reaches .* 16\d.* at most .*: give sine"
    ) as error:
        torque_free(3, limits=f"{RATIO} >= 200", minimise=SQUARES)
    assert "coupler_length" in error.value.values


def test_bound_is_what_the_weight_alone_asks():
    """Mean magnitude of the torque of the coupler's weight on a massless machine with the same cam."""
    found = torque_free(3, minimise=SQUARES)
    numbers = found.values
    still = ks.Scene(found.scene.mechanism, 1e-6, loads=ks.Gravity())
    torque = np.mean(np.abs(still.solve(2880).balancing_torque))
    plain = np.mean(np.abs(found.reference.solve(2880).balancing_torque))
    assert_allclose(found.bound, plain / torque, rtol=1e-3)
    assert numbers["coupler_length"] > 2.0
