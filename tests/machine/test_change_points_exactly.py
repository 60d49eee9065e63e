"""Change points passed: motion, forces and torque equal a reference of 60 digits on both sides, however near."""

import numpy as np
import pytest

import kinetostatics as ks
from support.change_points import LINKAGES, LINKS, NEAR, SINGLE, SPEED, each, errors, four_bar, reference, solve
from support.enclosed import assert_enclosed


@each
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_motion_forces_and_torque_are_exact_on_both_sides_of_a_change_point_however_near(name, assembly):
    """The change point lies at crank angle 0, near which angles are as fine as they can be."""
    behind = SINGLE.get(name) == "far"
    made = four_bar(name, assembly, (-float(LINKAGES[name][3]), 0.0) if behind else None)
    angles = np.array([*NEAR, 0.7, -2.0, 4.0, 9.0])
    solution = solve(made, angles)
    wrong = {
        (angle, quantity): error
        for place, angle in enumerate(angles.tolist())
        for quantity, error in errors(solution, place, reference(name, assembly, behind, angle)).items()
        if not error < 1e-12
    }
    assert not wrong


@each
def test_torque_and_motion_at_the_exact_angle_are_what_both_sides_tend_to_and_reactions_are_infinite(name, assembly):
    behind = SINGLE.get(name) == "far"
    made = four_bar(name, assembly, (-float(LINKAGES[name][3]), 0.0) if behind else None)
    solution = solve(made, np.array([-1e-10, 0.0, 1e-10]))
    for values in (
        solution.balancing_torque,
        *solution.velocity("B"),
        *solution.acceleration("B"),
        solution.rate("rocker"),
        solution.angular_acceleration("coupler"),
    ):
        assert np.ptp(values) < 1e-6
    with pytest.warns(ks.ConditionWarning, match="B is infinite at crank angle 0 deg, at a change point"):
        force = solution.reaction("B")
    assert np.isinf(np.hypot(*force)[1])
    assert np.isinf(np.hypot(*solution.reaction("O"))[1])


@each
def test_engines_agree(name, assembly, interpreted):
    scene = ks.Scene(four_bar(name, assembly, (1.2, -0.9)) if name == "near" else four_bar(name, assembly), SPEED)
    angles = np.array([0.3, 2.0, 5.0, 8.0, 11.0])
    numpy, compiled = (scene.solve(angles, engine=engine) for engine in ("numpy", "compiled"))
    kernels = numpy.dynamics
    for found in (compiled, kernels):
        np.testing.assert_allclose(found.balancing_torque, numpy.balancing_torque, rtol=1e-13, atol=1e-13)
        np.testing.assert_allclose(found.reaction("O2"), numpy.reaction("O2"), rtol=1e-13, atol=1e-12)


@pytest.mark.parametrize(
    "made",
    [
        four_bar("4/1/3/2", "open"),
        four_bar("deltoid", "crossed"),
        ks.four_bar(2.5, 5.0, 2.5, rocker_pivot=(-3.0, -4.0), assembly="crossed", **LINKS),
        ks.crank_slider(0.5, 0.75, guide_angle=2.5, guide_offset=-0.25, assembly="crossed", slider=LINKS["rocker"]),
        ks.crank_slider(0.5, 0.5, guide_angle=0.4, assembly="open", slider=LINKS["rocker"], coupler=LINKS["coupler"]),
    ],
    ids=lambda made: f"{made.name} {made.groups[0].passage}",
)
def test_enclosures_by_the_kernels_hold_what_other_formulas_give(made):
    assert_enclosed(solve(made, np.array([0.3, 4.0, 9.0])), "B")
