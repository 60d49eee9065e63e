"""Laws that hold for every mechanism: scale, frame, mirror, superposition, balance, limits, batches."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinetostatics as ks
from support.machines import (
    ANGLES,
    CLOSE,
    VECTORS,
    Machine,
    assert_close,
    assert_equal,
    every_kind,
    largest,
    motions,
    planar,
    results,
)
from support.strategies import dimension

# Scale, frame, mirror


def scaled(machine, length, mass):
    """Lengths and masses changed at the same speed, accelerations growing with lengths."""
    return replace(
        machine,
        size=length * machine.size,
        mean=length * machine.mean,
        centre=tuple(length * part for part in machine.centre),
        coupler_length=length * machine.coupler_length,
        guide_offset=length * machine.guide_offset,
        links={
            name: (mass * m, (length * along, length * across), mass * length**2 * inertia)
            for name, (m, (along, across), inertia) in machine.links.items()
        },
        gravity=(length * machine.gravity[0], machine.gravity[1]),
        spring=(mass * machine.spring[0], length * machine.spring[1]),
        process=mass * length * machine.process,
    )


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@every_kind
@pytest.mark.parametrize(("length", "mass"), [(1e-3, 5.3), (0.37, 1e3), (1e3, 1e-3)])
def test_forces_scale_with_mass_and_length(kind, length, mass):
    machine = Machine(kind)
    expected = results(machine.solve())
    expected = {name: mass * length ** dimension(name) * values for name, values in expected.items()}
    assert_equal(results(scaled(machine, length, mass).solve()), expected)


@every_kind
def test_no_absolute_number_hides_in_the_library(kind):
    """Scaling by powers of two is exact in binary arithmetic, so every bit must agree."""
    machine, length, mass = Machine(kind), 2.0**-12, 2.0**15
    expected = results(machine.solve())
    for name, values in results(scaled(machine, length, mass).solve()).items():
        assert_array_equal(values, mass * length ** dimension(name) * expected[name], err_msg=name)


@every_kind
@pytest.mark.parametrize("turn", [0.7, np.pi / 2, 2.9, -1.3])
def test_turning_everything_turns_vectors_only(kind, turn):
    """Guide, cam, gravity and the zero of the crank angle together."""
    machine = Machine(kind)
    around = np.exp(1j * turn)
    centre = around * complex(*machine.centre)
    turned = replace(
        machine,
        guide_angle=machine.guide_angle + turn,
        gravity=(machine.gravity[0], machine.gravity[1] + turn),
        centre=(centre.real, centre.imag),
    )
    before, after = machine.solve(), turned.solve(ANGLES + turn)
    expected = {name: values * (around if name in VECTORS else 1) for name, values in results(before).items()}
    assert_equal(results(after), expected)
    assert_equal(motions(after), {name: around * values for name, values in motions(before).items()})


def test_other_assembly_is_the_reversed_guide():
    """Behind along the guide is ahead along the guide turned by half a turn, which also flips its left normal."""
    machine = Machine("plain", assembly=-1, spring=(0.0, 0.0))
    links = dict(machine.links)
    mass, (along, across), inertia = links["slider"]
    links["slider"] = (mass, (-along, -across), inertia)
    reversed_ = replace(
        machine,
        assembly=1,
        guide_angle=machine.guide_angle + np.pi,
        guide_offset=-machine.guide_offset,
        links=links,
        process=-machine.process,
    )
    expected = results(machine.solve())
    expected["guide_force"] = -expected["guide_force"]
    assert_equal(results(reversed_.solve()), expected)


@pytest.mark.parametrize(
    ("W1", "W2"), [((-1.0, 0.3), (2.0, 0.9)), ((0.5, 0.5), (0.5, -1.0)), ((3.0, -0.2), (-1.0, -0.2))]
)
def test_guide_through_two_points_holds_the_slider(W1, W2):
    W1, W2 = complex(*W1), complex(*W2)
    guide = ks.Guide.through((W1.real, W1.imag), (W2.real, W2.imag))
    along = (W2 - W1) / abs(W2 - W1)
    s = ks.solve(ks.crank_slider(0.3, 1.5, guide=guide), ANGLES, crank_speed=1.0)
    place = (planar(s.position("B")) - W1) / along
    assert largest(place.imag) < 4e-15
    assert np.all(((planar(s.position("B")) - planar(s.position("A"))) / along).real > 0)
    assert guide.guide_angle == pytest.approx(np.angle(along), rel=1e-15)
    assert guide.guide_offset == pytest.approx((W1 / along).imag, rel=1e-15)


# Superposition and balance


@pytest.mark.slow
@every_kind
def test_forces_superpose(kind):
    """Each load at rest, and inertia without loads, add up to all together."""
    machine = Machine(kind)
    parts = [machine.solve(loads=())]
    parts += [machine.solve(loads=load, crank_speed=0.0, crank_acceleration=0.0) for load in machine.loads]
    parts = [results(part) for part in parts]
    names = [name for name in parts[0] if not name.startswith("shaking")]
    together = results(machine.solve())
    assert_equal({name: sum(part[name] for part in parts) for name in names}, {name: together[name] for name in names})


@every_kind
def test_inertia_forces_grow_with_the_square_of_speed(kind):
    """Twice the speed and four times the crank acceleration is exact in binary arithmetic."""
    machine = Machine(kind)
    once = results(machine.solve(loads=()))
    twice = results(machine.solve(loads=(), crank_speed=2 * machine.speed, crank_acceleration=4 * machine.acceleration))
    for name, values in once.items():
        assert_array_equal(twice[name], 4 * values, err_msg=name)


@every_kind
def test_reversing_the_crank_leaves_inertia_forces(kind):
    machine = Machine(kind)
    forward, backward = results(machine.solve()), results(machine.solve(crank_speed=-machine.speed))
    for name, values in forward.items():
        assert_array_equal(backward[name], values, err_msg=name)


@every_kind
@pytest.mark.parametrize("assembly", [1, -1])
def test_ground_reactions_balance_all_other_forces(kind, assembly):
    """Of the whole mechanism, force and moment about O; joint forces inside it do not appear."""
    machine = Machine(kind, assembly=assembly)
    s = machine.solve()
    along = np.exp(1j * machine.guide_angle)
    on_slider = planar(s.reaction("guide")) + along * (
        machine.process - machine.spring[0] * (s.slider_position - machine.spring[1])
    )
    at = [(0.0, planar(s.reaction("O"))), (planar(s.position("B")), on_slider)]
    for name, link in s.mechanism.links.items():
        at.append((planar(s.position(name)), link.mass * machine.gravity[0] * np.exp(1j * machine.gravity[1])))
    if kind != "plain":
        inward = -np.exp(1j * (s.crank_angle - s.pressure_angle))
        at.append((planar(s.position("A")), s.cam_force * inward))
    force = sum(force for _, force in at) + planar(s.shaking_force)
    moment = sum((np.conj(arm) * force).imag for arm, force in at) + s.shaking_moment
    moment += s.balancing_torque + s.guide_moment
    assert largest(force) < CLOSE * max(largest(force) for _, force in at)
    assert largest(moment) < CLOSE * max(largest(np.conj(arm) * force) for arm, force in at)


# Motion


@every_kind
@pytest.mark.parametrize("assembly", [1, -1])
def test_derivatives_are_slopes_of_positions(kind, assembly):
    """By complex steps, exact to rounding: f(x + ih) = f(x) + ih f'(x), with h so small that nothing is subtracted."""
    step = 1e-30
    mechanism = Machine(kind, assembly=assembly).mechanism
    placement, beside = mechanism.place(ANGLES), mechanism.place(ANGLES + 1j * step)

    def slope(value):
        return np.imag(value) / step

    for name in ("A", "B"):
        joint, moved = placement.joints[name], beside.joints[name]
        assert_close(joint.first, [slope(part) for part in moved.position])
        assert_close(joint.second, [slope(part) for part in moved.first])
    coupler, moved = placement.links["coupler"], beside.links["coupler"]
    turning = [slope(part) for part in moved.direction]
    assert_close(coupler.ratio, coupler.direction[0] * turning[1] - coupler.direction[1] * turning[0])
    assert_close(coupler.ratio_slope, slope(moved.ratio))


@every_kind
def test_speed_tables_act_at_their_own_angle(kind):
    machine = Machine(kind)
    speeds, accelerations = np.linspace(-3.0, 20.0, ANGLES.size), np.linspace(40.0, -5.0, ANGLES.size)
    table = results(machine.solve(crank_speed=speeds, crank_acceleration=accelerations))
    for i in (0, 7, 30):
        one = results(machine.solve(crank_speed=float(speeds[i]), crank_acceleration=float(accelerations[i])))
        assert_equal({name: values[i] for name, values in table.items()}, {name: one[name][i] for name in one})


def test_function_force_equals_its_table():
    """Here a drag that also depends on crank angle."""
    machine = Machine("plain")
    bare = machine.solve(loads=())
    drag = -3.0 * bare.slider_velocity * np.abs(np.sin(ANGLES))
    by_function = ks.ProcessForce(lambda motion: -3.0 * motion.slider_velocity * np.abs(np.sin(motion.crank_angle)))
    assert_equal(results(machine.solve(loads=by_function)), results(machine.solve(loads=ks.ProcessForce(drag))))


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
@pytest.mark.parametrize("ratio", [1e-2, 1e-4, 1e-8, 1e-12])
def test_long_coupler_makes_a_scotch_yoke(ratio):
    """Slider acceleration -(cos + ratio cos 2) r omega^2, the rest of order ratio^3; torque m r^2 omega^2 sin cos."""
    s = ks.solve(ks.crank_slider(1.0, 1.0 / ratio, slider=ks.Link(1.0)), ANGLES, crank_speed=1.0)
    harmonic = -np.cos(ANGLES) - ratio * np.cos(2 * ANGLES)
    assert largest(s.slider_acceleration - harmonic) < ratio**3 + 1e-15
    assert largest(s.balancing_torque - np.sin(ANGLES) * np.cos(ANGLES)) < 2 * ratio + 1e-15
    assert largest(s.guide_force) < 2 * ratio


def test_equal_crank_and_coupler_give_a_double_stroke():
    """Cardan: x_B = 2 r cos exactly while the slider is ahead of A.

    At 1.5 rad the coupler is 4 degrees from its limit position; rounding grows by 1 / cos^2 = 200 for each derivative.
    """
    angle = np.linspace(-1.5, 1.5, 13)
    s = ks.solve(ks.crank_slider(0.3, 0.3), angle, crank_speed=2.0)
    assert_allclose(s.slider_position, 0.6 * np.cos(angle), rtol=1e-14)
    assert_allclose(s.slider_velocity, -1.2 * np.sin(angle), rtol=1e-13, atol=1e-15)
    assert_allclose(s.slider_acceleration, -2.4 * np.cos(angle), rtol=1e-11)


# Batches and sweeps


def test_batch_equals_the_loop_over_designs():
    lengths, masses = np.array([[0.2], [0.3], [0.37]]), np.array([[4.0], [0.5], [9.0]])
    stiffness, offsets = np.array([[0.0], [300.0], [50.0]]), np.array([[-0.05], [0.0], [0.11]])

    def solved(length, mass, stiffness, offset):
        mechanism = ks.crank_slider(
            length,
            3 * length,
            guide_angle=0.3,
            guide_offset=offset,
            crank=ks.Link(2.0, (length / 2, 0.01), 0.1),
            coupler=ks.Link(mass, (length, -offset), mass * length**2),
            slider=ks.Link(2 * mass, (0.1, length)),
        )
        loads = [ks.Gravity(), ks.Spring(stiffness, 2 * length), ks.ProcessForce(10.0 * mass)]
        return ks.solve(mechanism, ANGLES, crank_speed=9.0, crank_acceleration=2.0, loads=loads)

    batch = solved(lengths, masses, stiffness, offsets)
    assert batch.balancing_torque.shape == (3, ANGLES.size)
    assert batch.reaction("O").shape == (2, 3, ANGLES.size)
    for i, design in enumerate(zip(lengths[:, 0], masses[:, 0], stiffness[:, 0], offsets[:, 0], strict=True)):
        single = solved(*(float(value) for value in design))
        expected = results(single) | motions(single)
        found = {name: values[i] for name, values in (results(batch) | motions(batch)).items()}
        assert_equal(found, expected, tolerance=1e-15)


@every_kind
def test_sweep_equals_the_loop_of_scalars(kind):
    machine = Machine(kind)
    sweep = machine.solve()
    for i in (0, 5, 17):
        one = machine.solve(float(ANGLES[i]))
        assert one.balancing_torque.shape == ()
        found, expected = results(one) | motions(one), results(sweep) | motions(sweep)
        for name, values in expected.items():
            assert abs(found[name] - values[i]) < 1e-14 * largest(values), name
