"""Slotted levers through change points: motion, forces and torque equal a reference of 60 digits, however near."""

import math
import warnings
from functools import cache
from itertools import product

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from support import multibody
from support.change_points import ACCELERATION, DIGITS, NEAR, SIDES, SPEED, WEIGHT, solve
from support.enclosed import assert_enclosed

DATA = {"crank": (2.0, 0.3, 0.1, 0.2), "lever": (1.5, 0.7, -0.2, 0.1), "block": (3.0, 0.04, 0.25, 0.5)}
LINKS = {name: ks.Link(mass, (along, across), inertia) for name, (mass, along, across, inertia) in DATA.items()}
LEVERS = {
    "meeting": (1.0, 0.0),
    "outside left": (2.0, 1.0),
    "outside right": (2.0, -1.0),
    "inside left": (0.5, 0.5),
    "inside right": (0.5, -0.5),
    "grazing": (1.0 + 2.0**-7, 2.0**-7),
}
"""Distance of the pivot and offset of the slot, for a crank of 1 m."""
every = pytest.mark.parametrize(("name", "assembly"), list(product(LEVERS, SIDES)))
meeting = pytest.mark.parametrize("assembly", SIDES)


def lever(name, assembly, start=0.0, **links):
    distance, offset = LEVERS[name]
    pivot = (distance * np.cos(start), distance * np.sin(start)) if start else (distance, 0.0)
    return ks.slotted_lever(1.0, pivot=pivot, offset=offset, assembly=assembly, **(links or LINKS))


@cache
def reference(name, assembly, angle):
    """By quantity."""
    branch = lambda phi: SIDES[assembly] * mp.sign(mp.sin(phi / 2))  # noqa: E731
    bodies = {link: multibody.Body(mass, (along, across), i) for link, (mass, along, across, i) in DATA.items()}
    with mp.workdps(3 * DIGITS):
        system = multibody.slotted_lever(*LEVERS[name], branch, bodies, SPEED, ACCELERATION, mp.mpc(0, -WEIGHT), DIGITS)
        solved = system.solve(angle)
        direction = system.poses["lever"][1](mp.mpf(angle))
        reach = mp.re(mp.conj(direction) * (mp.expj(angle) - LEVERS[name][0]))
    names = ("balancing_torque", "slot_force", "slot_moment", "A", "O2", "O")
    turning = {"rate": solved["velocity"]["lever", "angle"], "slope": solved["acceleration"]["lever", "angle"]}
    return {name: solved[name] for name in names} | turning | {"reach": reach, "direction": direction}


def found(solution, place):
    """The same quantities, as the library gives them."""
    scalars = {
        "balancing_torque": solution.balancing_torque,
        "rate": solution.rate("lever"),
        "slope": solution.angular_acceleration("lever"),
        "reach": solution.measure("block_position"),
        "slot_force": solution.scalar("slot_force"),
        "slot_moment": solution.scalar("slot_moment"),
    }
    vectors = {joint: solution.reaction(joint) for joint in ("A", "O2", "O")}
    vectors["direction"] = solution.placement.links["lever"].direction
    scalars |= {name: x + 1j * y for name, (x, y) in vectors.items()}
    return {name: np.broadcast_to(values, solution.shape)[place] for name, values in scalars.items()}


@every
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_both_sides_of_a_change_point_are_exact(name, assembly):
    """Relative to the value itself, of vectors to the largest component at the angle."""
    angles = np.array([*NEAR, 0.7, -2.0, 4.0, 9.0])
    solution, wrong = solve(lever(name, assembly), angles), {}
    for place, angle in enumerate(angles.tolist()):
        expected = reference(name, assembly, angle)
        for quantity, value in found(solution, place).items():
            exact, value = mp.mpc(expected[quantity]), mp.mpc(value)
            apart, size = value - exact, max(abs(exact.real), abs(exact.imag))
            error = float(max(abs(apart.real), abs(apart.imag)) / (size if size > 1e-40 else 1))
            if not error < 1e-12:
                wrong[angle, quantity] = error, float(size)
    assert not wrong


@every
def test_exact_angle_takes_the_limit_of_both_sides(name, assembly):
    if name == "grazing":
        pytest.skip("the lever spins too fast there for a step of 1e-10 rad")
    solution = solve(lever(name, assembly), np.array([-1e-10, 0.0, 1e-10]))
    for values in (
        solution.balancing_torque,
        *solution.placement.links["lever"].direction,
        np.broadcast_to(solution.rate("lever"), 3),
        solution.angular_acceleration("lever"),
        solution.measure("block_position"),
    ):
        assert np.isfinite(values).all()
        assert np.ptp(values) < 1e-6
    with pytest.warns(ks.ConditionWarning, match="O2 is infinite at crank angle 0 deg, at a change point"):
        force = solution.reaction("O2")
    assert not np.isnan(force).any()
    assert np.isinf(np.hypot(*force)[1])
    assert all(np.isinf(np.hypot(*solution.reaction(joint))[1]) for joint in ("A", "O"))
    assert np.isinf(solution.scalar("slot_force")[1])
    assert np.isfinite(solution.scalar("slot_moment")).all()


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@pytest.mark.parametrize("ulps", [-6, 6])
def test_nearly_equal_lengths_count_as_equal(ulps):
    """Pivots on the crank circle by decimals: the lever's rate is one half to the last bit."""
    for angle in np.radians([0.0, 20.0, 90.0, 160.0, 180.0, 200.0, 270.0, 340.0]):
        pivot = tuple(0.3 * np.array([np.cos(angle), np.sin(angle)]))
        made = ks.slotted_lever(0.3 + ulps * 2.0**-54, pivot=pivot, assembly="open", **LINKS)
        assert made.passes
        solution = solve(made, np.linspace(-6.3, 6.3, 301))
        assert set(np.broadcast_to(solution.rate("lever"), 301)) == {0.5 * SPEED}
        along = np.array(solution.placement.links["lever"].direction) * solution.measure("block_position")
        np.testing.assert_allclose(solution.position("A"), np.array(pivot)[:, None] + along, rtol=0, atol=2e-15)


@pytest.mark.parametrize("name", ["meeting", "outside left", "inside right"])
@pytest.mark.parametrize("assembly", SIDES)
def test_branch_is_the_same_wherever_the_pivot_stands(name, assembly):
    psi = np.linspace(-7.0, 7.0, 28)
    at_zero = found(solve(lever(name, assembly), psi, loads=()), slice(None))
    for start in (-3.1, -2.0, -1.0, 1.0, 2.0, 3.1):
        made = lever(name, assembly, start)
        assert made.passes
        turned = found(solve(made, start + psi, loads=()), slice(None))
        for quantity in ("reach", "balancing_torque", "rate", "slope", "slot_force"):
            expected = at_zero[quantity]
            np.testing.assert_allclose(turned[quantity], expected, rtol=0, atol=1e-11 * (np.abs(expected).max() + 1e-9))


@every
def test_open_slot_points_to_the_block_first(name, assembly):
    made = lever(name, assembly, 0.4)
    reach = solve(made, 0.4 + np.linspace(0.1, 6.2, 9)).measure("block_position")
    assert np.all(SIDES[assembly] * reach > 0.0)
    later = solve(made, 0.4 + 2 * np.pi + np.linspace(0.1, 6.2, 9)).measure("block_position")
    np.testing.assert_allclose(later, -reach, rtol=0, atol=1e-13)


@every
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


@pytest.mark.parametrize("offset", [0.0, 0.03])
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
            for side, link in ((1, LINKS["lever"]), (-1, turned))
        )
        first, second = (found(solve(made, angles), slice(None)) for made in (plain, back))
        for quantity in ("balancing_torque", "rate", "A", "O2"):
            np.testing.assert_allclose(first[quantity], second[quantity], rtol=1e-13)
        np.testing.assert_allclose(first["slot_force"], -second["slot_force"], rtol=1e-13)


@pytest.mark.parametrize("assembly", SIDES)
def test_other_levers_keep_their_side_exactly(assembly):
    word, number = (
        ks.slotted_lever(0.1, pivot=(0.03, -0.25), offset=0.02, assembly=way, **LINKS)
        for way in (assembly, SIDES[assembly])
    )
    assert (word.turns, word.change_points, word.passes) == (1, (), False)
    angles = np.linspace(0.0, 7.0, 50)
    np.testing.assert_array_equal(solve(word, angles).reaction("A"), solve(number, angles).reaction("A"))


@pytest.mark.parametrize("assembly", [1, -1, "open", "crossed"])
@pytest.mark.parametrize("offset", [0.0, 0.05])
def test_groups_of_every_assembly_balance(assembly, offset):
    links = {name: LINKS[name] for name in ("lever", "block")}
    assert ks.check(ks.LeverGroup((0.1, -0.3), offset=offset, assembly=assembly, **links)).ok
    assert ks.check(lever("outside left", "open").groups[0]).ok


def test_fixed_side_names_its_jump_and_its_kink():
    with pytest.warns(ks.ConditionWarning, match="a jump, as A meets the pivot at 0 deg"):
        solve(lever("meeting", 1), np.array([0.0, 1.0]))
    with pytest.warns(ks.ConditionWarning, match="a kink at 0 deg"):
        solve(lever("outside left", -1), np.array([0.0, 1.0]))


# What follows from it


@pytest.mark.parametrize(
    "made",
    [
        ks.slotted_lever(2.5, pivot=(-1.5, -2.0), assembly="crossed", **LINKS),
        ks.slotted_lever(2.5, pivot=(-3.0, 4.0), offset=-2.5, assembly="crossed", **LINKS),
        ks.slotted_lever(2.0, pivot=(0.0, -1.0), offset=-1.0, assembly="open", **LINKS),
        ks.slotted_lever(2.0, pivot=(0.0, -1.0), offset=0.5, assembly=-1, **LINKS),
    ],
    ids=lambda made: f"{made.groups[0].assembly} {made.groups[0].passage}",
)
def test_enclosures_contain_other_formulas(made):
    assert_enclosed(solve(made, np.array([0.3, 4.0, 9.0])), "A")


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


def test_batches_must_be_of_one_kind():
    scale = np.array([[1.0], [2.5], [0.3]])
    made = ks.slotted_lever(scale, pivot=(0.6 * scale, -0.8 * scale), assembly="open", **LINKS)
    assert made.turns == 2
    assert solve(made, np.linspace(0.0, 12.0, 9)).rate("lever").shape == (3, 9)
    with pytest.raises(
        ks.ParameterError, match="must be of one kind, but these have change points none; a = d"
    ) as error:
        ks.slotted_lever(scale, pivot=(1.0, 0.0), assembly="open")
    assert error.value.designs.tolist() == [True, False, False]


# What is refused


def program(name):
    return ks.compile(ks.Scene(lever(name, "open"), SPEED, loads=ks.Gravity()), "balancing_torque", engine="numpy")


def test_program_takes_values_that_keep_the_kind():
    found = program("meeting")(0.3, {"crank_length": 2.0, "lever_pivot.x": 2.0})["balancing_torque"]
    made = ks.slotted_lever(2.0, pivot=(2.0, 0.0), assembly="open", **LINKS)
    assert found == ks.Scene(made, SPEED, loads=ks.Gravity()).solve(0.3).balancing_torque


def test_program_keeps_a_zero_slot_offset():
    scene = ks.Scene(lever("meeting", "open"), SPEED)
    kept = ks.compile(scene, "balancing_torque", parameters=("slot_offset",), engine="numpy")
    assert kept(0.3)["balancing_torque"] == scene.solve(0.3).balancing_torque
    with pytest.raises(ks.ParameterError, match="another kind"):
        kept(0.3, {"slot_offset": 1e-3})


@pytest.mark.parametrize("excess", [1e-2, 1e-5, 1e-8])
@pytest.mark.parametrize("pivot", [(0.5, 0.49), (-0.5, 0.49), (0.7, 0.0)])
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
