"""Motion and all forces of random mechanisms equal an independent Newton-Euler system of all bodies at once."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kinetostatics as ks
from support.machines import planar
from support.strategies import cases, columns, errors, reproducible

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")]
"""Bodies drawn at random have any inertia."""

CLOSE = 1e-13
"""Error allowed relative to the largest of a kind; cos of the coupler stays above 0.49, so rounding grows little."""
KINDS = ("plain", "circle", "cosine law")


def motion_errors(scene, solution, reference):
    points, found = ("A", "B", *scene.bodies), {}
    for order in ("position", "velocity", "acceleration"):
        expected = columns([table[order] for table in reference], points)
        found[order] = errors({point: planar(getattr(solution, order)(point)) for point in points}, expected)
    for order, rate in (("velocity", solution.rate), ("acceleration", solution.angular_acceleration)):
        links = {name: [table[order][name, "angle"] for table in reference] for name in scene.bodies}
        found["angular " + order] = errors({name: rate(name) for name in links}, links)
    return {(order, name): error for order, table in found.items() for name, error in table.items()}


def force_errors(scene, solution, reference):
    """Forces relative to the largest force; moments to that times the coupler length."""
    scalars = ("guide_force", *(("cam_force", "slot_force") if scene.has_cam else ()))
    forces = {joint: planar(solution.reaction(joint)) for joint in "OAB"}
    forces |= {"shaking_force": planar(solution.shaking_force)} | {name: getattr(solution, name) for name in scalars}
    expected = columns(reference, forces)
    moments = ("guide_moment", "balancing_torque", "shaking_moment")
    found = {name: getattr(solution, name) for name in (*moments, "balancing_torque_by_power")}
    torques = columns(reference, moments)
    torques["balancing_torque_by_power"] = torques["balancing_torque"]
    arm = scene.coupler_length * max(np.max(np.abs(values)) for values in expected.values())
    return errors(forces, expected) | errors(found, torques, arm)


def exact(scene, solution):
    """The reference at the crank angles of a solution."""
    return [scene.solve(angle) for angle in solution.crank_angle]


def wrong(errors):
    return {name: error for name, error in errors.items() if not error < CLOSE}


@pytest.mark.parametrize("kind", KINDS)
@reproducible
@given(data=st.data())
def test_motion_and_forces_equal_newton_euler(kind, data):
    """Positions, velocities, accelerations and angular rates, of which the reference differences positions with 80
    digits; joint, guide, cam and slot forces, guide moment, both torques, shaking force and moment. The two torques
    share no force: one follows equilibrium link by link, one the powers of all loads.
    """
    scene, solution = data.draw(cases(kind))
    reference = exact(scene, solution)
    assert wrong(motion_errors(scene, solution, reference)) == {}
    assert wrong(force_errors(scene, solution, reference)) == {}
    assert solution.power_residual < 1e-14
    normal = 1j * np.exp(1j * scene.guide_angle)
    np.testing.assert_allclose(planar(solution.reaction("guide")), solution.guide_force * normal, rtol=1e-14)


@pytest.mark.parametrize("kind", KINDS)
@settings(reproducible, max_examples=10)
@given(data=st.data())
def test_forces_at_rest_equal_newton_euler(kind, data):
    """Statics is no special case."""
    scene, moving = data.draw(cases(kind))
    solution = ks.solve(moving.mechanism, moving.crank_angle, crank_speed=0.0, loads=moving.loads)
    resting = replace(scene, speed=0.0, acceleration=0.0)
    assert wrong(force_errors(resting, solution, exact(resting, solution))) == {}
