"""Torque-free cams: what they must reach, from where, what gravity forbids, and that the designs are what they say."""

import inspect
from dataclasses import fields

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.casefile.designs import CAM_KEYS
from kinetostatics.design.cam_start import Options, starting_machine
from kinetostatics.design.problem import Problem
from kinetostatics.design.torque_free import least_squares, waviness
from support.case_files import shipped
from support.every import every

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
def test_symmetric_cams_converge_without_weight(harmonics, least):
    found = torque_free(harmonics, gravity=False)
    assert found.report().loc[f"{RATIO} [1]", "after"] >= least
    assert np.isinf(found.bound)
    assert not any(isinstance(load, ks.Gravity) for load in found.scene.loads)


def test_three_cosines_reach_the_symmetric_bound():
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


def test_a_coupler_torsion_spring_carries_its_weight():
    found = torque_free(8, 8, coupler_spring=-1.5, minimise=SQUARES)
    assert reached(found)[0] >= 1e6
    (spring,) = (load for load in found.scene.loads if isinstance(load, ks.TorsionSpring))
    assert (spring.on, spring.against) == ("coupler", "slider")
    assert_allclose(
        spring.couple(found.scene.solve([0.0])), -150.0 * 9.81 * found.values["coupler_length"] / 2, rtol=1e-3
    )
    assert found.report().loc["largest_absolute guide_moment [N m]", "after"] > 1500.0


def test_a_counterweight_carries_it_at_a_price():
    found = torque_free(6, 6, counterweight=150.0, minimise=SQUARES)
    ratio, _, support, *_ = reached(found)
    assert ratio >= 1e6
    assert_allclose(support.range[1], 75.0 * 0.3 * found.scene.crank_speed**2, rtol=0.1)


def test_a_progressive_spring_needs_less_cam_force():
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


def test_ratio_beyond_the_bound_names_remedies():
    with pytest.raises(
        ks.DesignError, match=r">= 200 cannot be kept; .* reaches .* 16\d.* at most.*Give sine"
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


# Least squares of the torque


SAW_CASE = shipped("sawframe_2r63")


def search(cosine, sine):
    start = starting_machine(SAW_CASE.variant("cam-cosine").scene, Options(cosine, sine))
    return start, Problem(start.machine, start.vary, ["balancing_torque", "slider_position"], None, 360)


def squares(problem, values):
    return np.sqrt(np.mean(problem.curves(values)["balancing_torque"].values ** 2))


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [(3, 0), (4, 4), (8, 8)])
def test_least_squares_take_20_evaluations(harmonics):
    start, problem = search(*harmonics)
    assert_allclose(problem.start[: 1 + harmonics[0]][1], -0.0219, atol=3e-3)
    first = squares(problem, problem.start)
    found = least_squares(problem, start, problem.start)
    assert problem.evaluations <= 20
    assert squares(problem, found) < 0.05 * first


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [(4, 4), (8, 8)])
def test_random_starts_reach_the_same_least_squares(harmonics):
    start, problem = search(*harmonics)
    best = squares(problem, least_squares(problem, start, problem.start))
    generator = np.random.default_rng(7)
    starts = [start.random(problem.names, problem.start, generator) for _ in range(6)]
    assert max(abs(values[0] - 0.3) for values in starts) <= 0.03
    ends = [squares(problem, least_squares(problem, start, values)) for values in starts]
    assert np.mean(np.isclose(ends, best, rtol=1e-6)) >= 0.6


@pytest.mark.slow
def test_smooth_cams_come_first():
    """Waves are counted from the second harmonic on."""
    names = ("cam.cosine.0", "cam.cosine.1", "cam.sine.3", "coupler_length")
    assert [waviness(name) for name in names] == [0.0, 0.0, 9.0, 0.0]


# What carries the weight that a symmetric cam cannot


@pytest.mark.slow
def test_ways_to_carry_weight_show_their_prices():
    table = ks.design.weight_options(SAW, 3)
    ratios = table[f"{RATIO} [1]"]
    assert ratios["symmetric"] < table.loc["symmetric", "bound"] < ratios["sine terms"] < ratios["coupler spring"]
    assert table["largest O [N]"].idxmax() == "counterweight"
    assert table["largest_absolute guide_moment [N m]"].idxmax() == "coupler spring"


@pytest.mark.slow
@every("machine", [
    ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), ks.scotch_yoke(0.1), ks.slotted_lever(0.1, pivot=(0.0, -0.2)),
    ks.crank_slider(0.1, 0.4, assembly=-1),
])  # fmt: skip
def test_other_machines_are_refused_in_words(machine):
    with pytest.raises(ks.ParameterError, match="needs a crank-slider, plain or with a cam, whose slider"):
        ks.design.weight_options(ks.Scene(machine, 1.0), 2)


# Where the search for a torque-free cam begins


def test_coupler_keeps_mass_inertia_and_centre_share():
    found = torque_free(2, gravity=False, minimise=SQUARES)
    coupler = found.scene.mechanism.links["coupler"]
    assert (coupler.mass, coupler.inertia) == (150.0, 20.5)
    assert_allclose(coupler.centre[0], found.values["coupler_length"] / 2, rtol=1e-15)


def test_stroke_ends_are_kept_from_a_plain_machine():
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


def test_all_wrong_options_are_listed_at_once():
    wrong = {"cosine": 0, "sine": 100, "gravity": 1, "counterweight": -3.0, "guide_offset": "low"}
    with pytest.raises(ks.ParameterError) as options:
        Options.checked(**wrong)
    with pytest.raises(ks.ParameterError) as found:
        torque_free(**wrong, starts=0)
    for told in map(str, (options.value, found.value)):
        for name in wrong:
            assert f"{name} must be" in told
    assert "starts must be" in str(found.value)


def test_options_of_function_and_case_files_agree():
    function = inspect.signature(ks.design.torque_free_cam).parameters
    for option in fields(Options):
        assert function[option.name].default == option.default
    assert {"cosine", "sine", "ends", "guide_offset", "coupler_spring", "counterweight", "cubic"} == set(CAM_KEYS)
