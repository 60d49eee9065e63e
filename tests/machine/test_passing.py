"""Slotted levers that pass their change points: sides of the slot, and what follows from them."""

import math
import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from support.change_points import BALANCE, LEVER_LINKS, SIDES, SPEED, each_lever, lever, read, solve
from support.every import every

meeting = every("assembly", SIDES)


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("ulps", [-6, 6])
def test_nearly_equal_lengths_count_as_equal(ulps):
    """Pivots on the crank circle by decimals: the lever's rate is one half to the last bit."""
    for angle in np.radians([0.0, 20.0, 90.0, 160.0, 180.0, 200.0, 270.0, 340.0]):
        pivot = tuple(0.3 * np.array([np.cos(angle), np.sin(angle)]))
        made = ks.slotted_lever(0.3 + ulps * 2.0**-54, pivot=pivot, assembly="open", **LEVER_LINKS)
        assert made.passes
        solution = solve(made, np.linspace(-6.3, 6.3, 301))
        assert set(np.broadcast_to(solution.rate("lever"), 301)) == {0.5 * SPEED}
        along = np.array(solution.placement.links["lever"].direction) * solution.measure("block_position")
        np.testing.assert_allclose(solution.position("A"), np.array(pivot)[:, None] + along, rtol=0, atol=2e-15)


@each_lever
def test_open_slot_points_to_the_block_first(name, assembly):
    made = lever(name, assembly, 0.4)
    reach = solve(made, 0.4 + np.linspace(0.1, 6.2, 9)).measure("block_position")
    assert np.all(SIDES[assembly] * reach > 0.0)
    later = solve(made, 0.4 + 2 * np.pi + np.linspace(0.1, 6.2, 9)).measure("block_position")
    np.testing.assert_allclose(later, -reach, rtol=0, atol=1e-13)


@each_lever
def test_motion_passes_the_change_point_and_closes(name, assembly):
    made, other = lever(name, assembly, 0.9), lever(name, "crossed" if assembly == "open" else "open", 0.9)
    assert made.turns == 2
    np.testing.assert_allclose(made.change_points, [0.9], atol=1e-15)
    angles = np.array([1.1, 2.0, 5.0])
    first = solve(made, angles).balancing_torque
    np.testing.assert_allclose(solve(made, angles + 4 * np.pi).balancing_torque, first, rtol=1e-11)
    np.testing.assert_allclose(solve(other, angles + 2 * np.pi).balancing_torque, first, rtol=1e-11)
    angles = np.linspace(0.0, 4 * np.pi, 2001)
    x, y = solve(made, angles).placement.links["lever"].direction
    assert np.abs(np.diff(np.unwrap(np.arctan2(y, x)))).max() < (2.0 if name == "grazing" else 0.05)


# Sides


@every("offset", [0.0, 0.03])
def test_other_side_turns_the_slot_away(offset):
    """With masses turned likewise, and without an offset, all forces are the same."""
    angles = np.linspace(0.0, 6.0, 13)
    one, other = (
        solve(ks.slotted_lever(0.1, pivot=(0.03, -0.25), offset=offset, assembly=side), angles) for side in (1, -1)
    )
    np.testing.assert_array_equal(other.measure("block_position"), -one.measure("block_position"))
    away = np.array(other.placement.links["lever"].direction)
    place = np.array([[0.03], [-0.25]]) + away * other.measure("block_position")
    np.testing.assert_allclose(place + offset * np.array([-away[1], away[0]]), other.position("A"), atol=1e-15)
    if not offset:
        turned = ks.Link(1.5, (-0.7, 0.2), 0.1)
        plain, back = (
            ks.slotted_lever(0.1, pivot=(0.03, -0.25), assembly=side, lever=link)
            for side, link in ((1, LEVER_LINKS["lever"]), (-1, turned))
        )
        first, second = (solve(made, angles) for made in (plain, back))
        for key in (BALANCE, ("rate", "lever"), ("reaction", "A"), ("reaction", "O2")):
            np.testing.assert_allclose(read(first, *key), read(second, *key), rtol=1e-13)
        np.testing.assert_allclose(first.scalar("slot_force"), -second.scalar("slot_force"), rtol=1e-13)


@pytest.mark.slow
@every("assembly", [1, -1, "open", "crossed"])
@every("offset", [0.0, 0.05])
def test_groups_of_every_assembly_balance(assembly, offset):
    links = {name: LEVER_LINKS[name] for name in ("lever", "block")}
    assert ks.check(ks.LeverGroup((0.1, -0.3), offset=offset, assembly=assembly, **links)).ok
    assert ks.check(lever("outside left", "open").groups[0]).ok


# What follows from it


@pytest.mark.slow
@meeting
def test_torque_extremes_stay_finite(assembly):
    scene = ks.Scene(lever("meeting", assembly), SPEED, loads=ks.Gravity())
    torque, fine = ks.extremes(scene.solve(12), "balancing_torque"), scene.solve(7200).balancing_torque
    np.testing.assert_allclose(torque.range, [fine.min(), fine.max()], rtol=1e-6)
    for name in ("O2", "slot_force"):
        with pytest.warns(ks.ConditionWarning, match=f"{name} grows without bound at 0, 360 deg"):
            assert np.inf in np.abs(ks.extremes(scene.solve(12), name).range)
    moment, fine = ks.extremes(scene.solve(12), "slot_moment"), scene.solve(7200).scalar("slot_moment")
    np.testing.assert_allclose(moment.range, [fine.min(), fine.max()], rtol=1e-6)


@meeting
def test_slot_is_drawn_on_both_sides_of_the_pivot(assembly):
    from kinetostatics.views.strokes import Shape

    made = lever("meeting", assembly)
    shape = Shape(ks.Scene(made, SPEED).solve(24).dynamics)
    ((_, ends),) = shape.slots
    along = np.sort(ends[0])
    assert along[0] < -1.99
    assert along[1] > 1.99
    strokes = [stroke for stroke in shape.strokes(shape.turn) if stroke.kind == "slot"]
    (line,) = (stroke.points for stroke in strokes)
    (x1, y1), (x2, y2) = (line[:, end] for end in range(2))
    x, y = shape.turn.position("A")
    between = (x - x1) * (x2 - x1) + (y - y1) * (y2 - y1), (x2 - x1) ** 2 + (y2 - y1) ** 2
    assert np.all((between[0] > 0.0) & (between[0] < between[1]))


# What is refused


def test_program_keeps_a_zero_slot_offset():
    scene = ks.Scene(lever("meeting", "open"), SPEED)
    kept = ks.compile(scene, "balancing_torque", parameters=("slot_offset",), engine="numpy")
    assert kept(0.3)["balancing_torque"] == scene.solve(0.3).balancing_torque
    with pytest.raises(ks.ParameterError, match="another kind"):
        kept(0.3, {"slot_offset": 1e-3})


@pytest.mark.slow
@every("excess", [1e-2, 1e-5, 1e-8])
@every("pivot", [(0.5, 0.49), (-0.5, 0.49), (0.7, 0.0)])
def test_inclined_branch_keeps_its_digits(flint, pivot, excess):
    crank, ground = 0.2, math.hypot(*pivot)
    coupler = ground * (1.0 - excess)
    bodies = {"coupler": ks.Link(4.0, 0.1, 0.05), "rocker": ks.Link(3.0, 0.1, 0.03)}
    bars = ks.four_bar(crank, coupler, crank + ground - coupler, rocker_pivot=pivot, assembly="open", **bodies)
    steps = np.concatenate([np.linspace(0.01, 1.2, 9), math.pi + 1e-3 * np.linspace(-1.0, 1.0, 6)])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.ConditionWarning)
        s = ks.solve(bars, math.atan2(pivot[1], pivot[0]) + steps, crank_speed=9.0, loads=ks.Gravity())
    assert bars.groups[0].passage.startswith("far")
    for quantity in ("balancing_torque_by_power", "rocker_angular_acceleration"):
        exact = enclosure(s, quantity, digits=20)
        moved = relative_errors(enclosure(s.at(np.nextafter(s.crank_angle, 9.0)), quantity, digits=20).exact, exact)
        assert relative_errors(components(s, quantity), exact).max() <= 30 * (UNIT_ROUNDOFF + moved.max())
