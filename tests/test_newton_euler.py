"""Motion and all forces of random mechanisms equal an independent Newton-Euler system of all bodies at once."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from newton_euler import Body, Scene, pin_by_cosine_law, pin_on_circle, pin_on_crank, solve

import kinetostatics as ks

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""

CLOSE = 1e-13
"""Error allowed relative to the largest of a kind; cos of the coupler stays above 0.49, so rounding grows little."""
KINDS = ("plain", "circle", "cosine law")
reproducible = settings(
    derandomize=True, database=None, deadline=None, max_examples=40, phases=[Phase.explicit, Phase.generate]
)


def number(low, high):
    return st.floats(low, high, allow_nan=False)


def either_sign(low, high):
    return st.builds(lambda sign, size: sign * size, st.sampled_from((-1, 1)), number(low, high))


def body(size):
    offset = either_sign(0.01 * size, size)
    return st.builds(Body, number(0.1, 100.0), st.tuples(offset, offset), number(0.01, 10.0))


@st.composite
def cases(draw, kind):
    """A scene, and the same thing solved by the package at three crank angles."""
    size, guide_angle, guide_offset, assembly = draw(number(0.1, 1.0)), draw(number(-3.1, 3.1)), 0.0, 1
    if kind == "cosine law":
        driver = ks.cams.CosineLaw(size, size * draw(number(1.2, 8.0)), guide_angle)
        pin, coupler_length = pin_by_cosine_law(driver.amplitude, driver.mean, guide_angle), driver.coupler_length
    else:
        guide_offset, assembly = size * draw(either_sign(0.01, 1.5)), draw(st.sampled_from((-1, 1)))
        if kind == "circle":
            centre = tuple(size * draw(either_sign(0.01, 0.4)) for _ in "xy")
            driver, pin, reach = ks.cams.Circle(size, centre), pin_on_circle(size, centre), size + np.hypot(*centre)
        else:
            driver, pin, reach = size, pin_on_crank(size), size
        coupler_length = (reach + abs(guide_offset)) * draw(number(1.15, 5.0))
    names = ["crank", "coupler", "slider"] + (["block"] if kind != "plain" else [])
    stiffness, free, process = draw(number(1.0, 1e4)), draw(number(-2.0, 2.0)), draw(either_sign(1.0, 1e3))
    scene = Scene(
        pin=pin,
        has_cam=kind != "plain",
        coupler_length=coupler_length,
        guide_angle=guide_angle,
        guide_offset=guide_offset,
        assembly=assembly,
        bodies={name: draw(body(size)) for name in names},
        speed=draw(either_sign(0.1, 50.0)),
        acceleration=draw(either_sign(0.1, 500.0)),
        gravity=(draw(number(1.0, 20.0)), draw(number(-3.1, 3.1))),
        push=lambda coordinate: process - stiffness * (coordinate - free),
    )
    solution = ks.solve(
        (ks.crank_slider if kind == "plain" else ks.cam_crank_slider)(
            driver,
            coupler_length,
            guide_angle=guide_angle,
            guide_offset=guide_offset,
            assembly=assembly,
            **{name: ks.Link(b.mass, b.centre, b.inertia) for name, b in scene.bodies.items()},
        ),
        np.array([draw(number(0.0, 6.28)) for _ in range(3)]),
        crank_speed=scene.speed,
        crank_acceleration=scene.acceleration,
        loads=[ks.Gravity(*scene.gravity), ks.Spring(stiffness, free), ks.ProcessForce(process)],
    )
    return scene, solution


def planar(vector):
    return vector[0] + 1j * vector[1]


def errors(found, expected, scale=None):
    """Error of each quantity by name, relative to the largest of all or to a given scale."""
    scale = max(np.max(np.abs(values)) for values in expected.values()) if scale is None else scale
    return {name: float(np.max(np.abs(found[name] - expected[name])) / scale) for name in expected}


def columns(tables, names):
    return {name: np.array([table[name] for table in tables]) for name in names}


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
    return [solve(scene, angle) for angle in solution.crank_angle]


def wrong(errors):
    return {name: error for name, error in errors.items() if not error < CLOSE}


@pytest.mark.parametrize("kind", KINDS)
@reproducible
@given(data=st.data())
def test_motion_equals_differences_of_angle_formulas_forces_newton_euler_and_powers_balance(kind, data):
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
