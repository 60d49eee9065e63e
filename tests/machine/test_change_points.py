"""Change points: both sides are exact, for every crank and throw."""

from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import product

import numpy as np
import pytest

import kinetostatics as ks
from support.change_points import (
    LEVER_LINKS,
    LEVERS,
    LINKAGES,
    LINKS,
    NEAR,
    SIDES,
    SINGLE,
    SPEED,
    at_zero,
    each,
    errors,
    four_bar,
    lever,
    quantities,
    read,
    reference,
    solve,
    turned,
)
from support.enclosed import assert_enclosed
from support.every import every

# What the branches are


def test_parallelogram_stays_a_parallelogram():
    solution = solve(four_bar("parallelogram", "open"), np.linspace(-7.0, 7.0, 99))
    np.testing.assert_allclose(solution.position("B") - solution.position("A"), [[2.0] * 99, [0.0] * 99], atol=1e-15)
    assert not solution.rate("coupler").any()
    assert set(solution.rate("rocker")) == {SPEED}


def test_folded_kite_and_rhombus_rest_the_rocker():
    for name in ("kite", "rhombus"):
        solution = solve(four_bar(name, "crossed"), np.linspace(-7.0, 7.0, 99))
        np.testing.assert_allclose(solution.position("B"), 0.0, atol=1e-15)
        assert not solution.rate("rocker").any()


@each
def test_open_is_left_of_the_line_to_the_pivot(name, assembly):
    solution = solve(four_bar(name, assembly), np.linspace(0.1, 3.0, 9))
    along, reach = (solution.position(joint) - solution.position("A") for joint in ("O2", "B"))
    assert np.all(SIDES[assembly] * (along[0] * reach[1] - along[1] * reach[0]) > -1e-12)


def test_group_on_a_crank_is_checked_as_on_its_own():
    assert ks.check(four_bar("4/1/3/2", "open").groups[0]).ok


@pytest.mark.slow
@each
def test_motion_passes_change_points_and_closes(name, assembly):
    """Positions by cubic interpolation of what is around them: no side is left, and no velocity jumps."""
    made = four_bar(name, assembly, (LINKAGES[name][3] * 0.6, LINKAGES[name][3] * 0.8))
    assert made.turns == (2 if name in SINGLE else 1)
    period = 2 * np.pi * made.turns
    for change in (angle + 2 * np.pi * turn for angle in made.change_points for turn in range(made.turns)):
        solution = solve(made, change + 1e-3 * np.array([-3, -1, 1, 3]))
        for values in (*solution.position("B"), *solution.velocity("B"), *solution.acceleration("B")):
            assert abs(np.diff(values, 3)[0]) < 1e-3
    first, later = (solve(made, np.array([0.2, 1.0, 4.0]) + shift).position("B") for shift in (0.0, period))
    np.testing.assert_allclose(first, later, atol=1e-13)
    if made.turns == 2:
        other = "crossed" if assembly == "open" else "open"
        turned = solve(four_bar(name, other, made.groups[0].pivot), np.array([0.2, 1.0, 4.0]) + 2 * np.pi)
        np.testing.assert_allclose(first, turned.position("B"), atol=1e-13)


def test_pin_close_to_its_pivot_is_warned_of():
    made = ks.four_bar(1.0, 2.0, 2.0 - 2.0**-24, rocker_pivot=(1.0 + 2.0**-24, 0.0), assembly="crossed", **LINKS)
    with pytest.warns(ks.ConditionWarning, match="correct digits"):
        solve(made, np.array([1e-8, 3e-8, 6e-8, 1e-7, 1.0]))


def test_decimal_lengths_count_as_equal():
    for crank, coupler, rocker, ground in (
        (0.1 + 0.2, 0.7, 0.3, 0.7),
        (0.4, 0.7, 0.9, 0.2),
        (0.1, 0.6, 0.5, 0.1 + 0.9),
    ):
        a, b, h, d = map(Fraction, (crank, coupler, rocker, ground))
        apart = min(abs(a + d - b - h), abs(abs(d - a) - abs(b - h)))
        assert 0 <= apart <= 8 * Fraction(float(np.spacing(max(crank, coupler, rocker, ground))))
        made = ks.four_bar(crank, coupler, rocker, rocker_pivot=(ground, 0.0), assembly="open")
        assert made.passes
        assert np.isfinite(solve(made, np.linspace(-6.3, 6.3, 721)).position("B")).all()


def test_lengths_beyond_eight_ulp_are_no_change_point():
    ulp = float(np.spacing(2.0))
    kinds = [ks.four_bar(1.0 + n * ulp, 2.0, 1.0, rocker_pivot=(2.0, 0.0), assembly="open").passes for n in (7, 9)]
    assert kinds == [True, False]


PLAIN = (
    partial(ks.four_bar, 0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)),
    partial(ks.slotted_lever, 0.1, pivot=(0.03, -0.25), offset=0.02, **LEVER_LINKS),
)


@every("assembly", SIDES)
@every("make", PLAIN)
def test_other_machines_keep_their_side_exactly(make, assembly):
    word, number = (make(assembly=way) for way in (assembly, SIDES[assembly]))
    assert (word.turns, word.change_points, word.passes) == (1, (), False)
    angles = np.linspace(0.0, 7.0, 50)
    np.testing.assert_array_equal(solve(word, angles).reaction("A"), solve(number, angles).reaction("A"))


@every(
    "made, words",
    [
        (four_bar("parallelogram", 1), "a kink at 0 deg and a kink at 180 deg"),
        (four_bar("deltoid", 1), "a jump, as A meets"),
        (lever("meeting", 1), "a jump, as A meets the pivot at 0 deg"),
        (lever("outside left", -1), "a kink at 0 deg"),
    ],
)
def test_fixed_side_names_its_kinks_and_jumps(made, words):
    with pytest.warns(ks.ConditionWarning, match=words):
        solve(made, np.array([0.0, 1.0]))


# Sliders


@pytest.mark.filterwarnings("ignore:.*stands still:kinetostatics.errors.HintWarning")
@every("guide_angle", [0.0, 0.7, -2.0])
def test_equal_coupler_takes_slider_through_centre(guide_angle):
    angles = np.linspace(-7.0, 7.0, 41)
    made = {
        way: ks.crank_slider(
            0.5, 0.5, guide_angle=guide_angle, assembly=way, coupler=LINKS["coupler"], slider=ks.Link(3.0)
        )
        for way in SIDES
    }
    along = np.cos(angles - guide_angle)
    np.testing.assert_allclose(solve(made["open"], angles).slider_position, along, atol=1e-15)
    np.testing.assert_allclose(solve(made["open"], angles).rate("coupler"), -SPEED)
    np.testing.assert_allclose(solve(made["crossed"], angles).slider_position, 0.0, atol=1e-15)
    assert {item.turns for item in made.values()} == {1}


def test_offset_slider_passes_in_two_turns():
    made = ks.crank_slider(0.5, 0.75, guide_offset=0.25, assembly="open", coupler=LINKS["coupler"], slider=ks.Link(3.0))
    assert made.turns == 2
    (change,) = made.change_points
    assert change == pytest.approx(1.5 * np.pi)
    solution = solve(made, change + 1e-3 * np.array([-3, -1, 1, 3]))
    for values in (solution.slider_position, solution.slider_velocity, solution.slider_acceleration):
        assert abs(np.diff(values, 3)[0]) < 1e-6
    assert np.ptp(np.sign(solution.slider_velocity)) == 0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_upright_slider_force_is_infinite_across():
    guide = ks.Guide.through((-0.25, 0.0), (-0.25, 1.0))
    made = ks.crank_slider(0.5, 0.75, guide=guide, assembly="open", coupler=LINKS["coupler"], slider=ks.Link(3.0))
    solution = solve(made, np.array([0.0, 1e-10]))
    for name in ("A", "B", "O", "guide"):
        (across, _), (at, near) = solution.reaction(name)
        assert np.isinf(across)
        assert at == pytest.approx(near, rel=1e-8, abs=1e-8)


def test_change_points_just_below_zero_lie_in_the_turn():
    made = ks.four_bar(1.0, 3.0, 2.0, rocker_pivot=(-4.0, 1e-20), assembly="open")
    assert made.change_points == (0.0,)


# What follows from it


@pytest.mark.slow
@each
def test_reactions_alone_warn_at_change_points(name, assembly):
    """Warnings are errors in the tests."""
    solution = ks.Scene(four_bar(name, assembly), SPEED, loads=ks.Gravity()).solve(72)
    assert solution.crank_angle[-1] > 2 * np.pi * (solution.mechanism.turns - 0.1)
    assert np.isfinite(solution.balancing_torque).all()
    assert np.isfinite(solution.acceleration("B")).all()
    assert solution.condition.max() < 1e4
    assert solution.condition_of("balancing_torque").max() < 1e4
    with pytest.warns(ks.ConditionWarning, match="second freedom"):
        solution.reaction("A")


@pytest.mark.slow
@every("name, places", [("parallelogram", "0, 180"), ("4/1/3/2", "180, 540"), ("deltoid", "0, 360")])
def test_torque_extremes_stay_finite(name, places):
    solution = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(12)
    torque = ks.extremes(solution, "balancing_torque")
    fine = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(7200).balancing_torque
    np.testing.assert_allclose(torque.range, [fine.min(), fine.max()], rtol=1e-6)
    with pytest.warns(ks.ConditionWarning, match=f"B grows without bound at {places} deg"):
        found = ks.extremes(solution, "B")
    assert found.range[1] == np.inf
    assert 0 < found.range[0] < 100


def test_unloaded_reactions_stay_finite():
    made = replace(four_bar("parallelogram", "open", crank=LINKS["crank"]))
    solution = solve(made, np.linspace(0.0, 6.0, 13))
    assert not solution.reaction("B").any()
    assert np.isfinite(solution.reaction("O")).all()


def test_torque_does_no_work_over_the_period():
    for name in LINKAGES:
        torque = ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()).solve(360).balancing_torque
        assert abs(torque.mean()) < 1e-9 * abs(torque).max()


# Change points passed


FEW = {
    **dict.fromkeys(("parallelogram", "4/1/3/2", "outside left"), "open"),
    **dict.fromkeys(("kite", "meeting"), "crossed"),
}
"""Which are compared in unit tests; the others differ from them in lengths or in a sign alone."""


def few_quick(*names):
    """Every name and assembly; those that are not of the few are slow tests."""
    pairs = product(names, SIDES)
    rows = [pytest.param(*pair, marks=() if pair in FEW.items() else pytest.mark.slow) for pair in pairs]
    return pytest.mark.parametrize(("name", "assembly"), rows)


@few_quick(*LINKAGES, *LEVERS)
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_both_sides_of_a_change_point_are_exact(name, assembly):
    angles = np.array([*NEAR, 0.7, -2.0, 4.0, 9.0])
    solution = solve(at_zero(name, assembly), angles)
    wrong = {
        (angle, quantity): error
        for place, angle in enumerate(angles.tolist())
        for quantity, error in errors(solution, place, reference(name, assembly, angle)).items()
        if not error < 1e-12
    }
    assert not wrong


@pytest.mark.slow
@every("assembly", SIDES)
@every("name", [name for name in [*LINKAGES, *LEVERS] if name != "grazing"])
def test_exact_angle_takes_the_limit_of_both_sides(name, assembly):
    """But of the lever that spins too fast for a step of 1e-10 rad."""
    solution = solve(at_zero(name, assembly), np.array([-1e-10, 0.0, 1e-10]))
    growing = {("scalar", "slot_force"), *(("reaction", joint) for joint in "ABO"), ("reaction", "O2")}
    for key in {*quantities(name)} - growing - {("position", "B")}:
        values = read(solution, *key)
        assert np.isfinite(values).all()
        assert max(np.ptp(values.real), np.ptp(values.imag)) < 1e-6, key
    joint = "O2" if name in LEVERS else "B"
    with pytest.warns(ks.ConditionWarning, match=f"{joint} is infinite at crank angle 0 deg, at a change point"):
        force = solution.reaction(joint)
    assert not np.isnan(force).any()
    assert np.isinf(np.hypot(*force)[1])
    for joint in ("A", "O") if name in LEVERS else "O":
        assert np.isinf(np.hypot(*solution.reaction(joint))[1])
    if name in LEVERS:
        assert np.isinf(solution.scalar("slot_force")[1])


@few_quick(*LINKAGES, "meeting", "outside left", "inside right")
def test_branch_is_the_same_wherever_the_pivot_stands(name, assembly):
    """The crank angle counts from the direction O -> O2, whose own angle lies between -pi and pi."""
    psi = np.linspace(-7.0, 7.0, 28)
    alike = [key for key in quantities(name) if key[0] not in ("reaction", "direction", "position")]
    expected = {key: read(solve(turned(name, assembly, 0.0), psi, loads=()), *key) for key in alike}
    for start in (-3.1, -1.0, 2.0):
        made = turned(name, assembly, start)
        assert made.passes
        solution, around = solve(made, start + psi, loads=()), np.exp(1j * start)
        for key, values in expected.items():
            right = values * around if np.iscomplexobj(values) else values
            close = (1e-11 if name in LEVERS else 1e-12) * (np.abs(values).max() + 1e-9)
            np.testing.assert_allclose(read(solution, *key), right, rtol=0, atol=close)


@pytest.mark.slow
@each
def test_engines_agree(name, assembly, interpreted):
    scene = ks.Scene(four_bar(name, assembly, (1.2, -0.9)) if name == "near" else four_bar(name, assembly), SPEED)
    angles = np.array([0.3, 2.0, 5.0, 8.0, 11.0])
    numpy, compiled = (scene.solve(angles, engine=engine) for engine in ("numpy", "compiled"))
    kernels = numpy.dynamics
    for found in (compiled, kernels):
        np.testing.assert_allclose(found.balancing_torque, numpy.balancing_torque, rtol=1e-13, atol=1e-13)
        np.testing.assert_allclose(found.reaction("O2"), numpy.reaction("O2"), rtol=1e-13, atol=1e-12)


@pytest.mark.slow
@every(
    "made",
    [
        four_bar("4/1/3/2", "open"),
        four_bar("deltoid", "crossed"),
        ks.four_bar(2.5, 5.0, 2.5, rocker_pivot=(-3.0, -4.0), assembly="crossed", **LINKS),
        ks.crank_slider(0.5, 0.75, guide_angle=2.5, guide_offset=-0.25, assembly="crossed", slider=LINKS["rocker"]),
        ks.crank_slider(0.5, 0.5, guide_angle=0.4, assembly="open", slider=LINKS["rocker"], coupler=LINKS["coupler"]),
        ks.slotted_lever(2.5, pivot=(-1.5, -2.0), assembly="crossed", **LEVER_LINKS),
        ks.slotted_lever(2.5, pivot=(-3.0, 4.0), offset=-2.5, assembly="crossed", **LEVER_LINKS),
        ks.slotted_lever(2.0, pivot=(0.0, -1.0), offset=-1.0, assembly="open", **LEVER_LINKS),
        ks.slotted_lever(2.0, pivot=(0.0, -1.0), offset=0.5, assembly=-1, **LEVER_LINKS),
    ],
    ids=lambda made: f"{made.name} {made.groups[0].passage}",
)
def test_enclosures_contain_other_formulas(made):
    assert_enclosed(solve(made, np.array([0.3, 4.0, 9.0])), "A" if "lever" in made.links else "B")


# Programs, batches, sweeps and case files keep to the kind that the words have chosen


def program(name, quantities="balancing_torque"):
    return ks.compile(ks.Scene(four_bar(name, "open"), SPEED, loads=ks.Gravity()), quantities, engine="numpy")


@every(
    "scene, longer, made",
    [
        (
            ks.Scene(four_bar("parallelogram", "open"), SPEED, loads=ks.Gravity()),
            {"crank_length": 2.0, "rocker_length": 2.0, "coupler_length": 3.0, "rocker_pivot.x": 3.0},
            ks.four_bar(2.0, 3.0, 2.0, rocker_pivot=(3.0, 0.0), assembly="open", **LINKS),
        ),
        (
            ks.Scene(lever("meeting", "open"), SPEED, loads=ks.Gravity()),
            {"crank_length": 2.0, "lever_pivot.x": 2.0},
            ks.slotted_lever(2.0, pivot=(2.0, 0.0), assembly="open", **LEVER_LINKS),
        ),
    ],
)
def test_program_takes_values_that_keep_the_kind(scene, longer, made):
    kept = ks.compile(scene, "balancing_torque", engine="numpy")
    assert kept(0.3, longer)["balancing_torque"] == replace(scene, mechanism=made).solve(0.3).balancing_torque
    assert kept(0.3, {"crank_length": 1.0 + 2.0**-52})["balancing_torque"] > 0


def test_program_refuses_a_new_change_point():
    made = ks.four_bar(1.0, 3.0, 2.5, rocker_pivot=(3.0, 0.0), assembly="open", **LINKS)
    found = ks.compile(ks.Scene(made, SPEED), "balancing_torque", engine="numpy")
    assert found.derivatives(0.3, "crank_length")["balancing_torque"]["crank_length"] != 0
    with pytest.raises(ks.ParameterError, match="another kind"):
        found(0.3, {"rocker_length": 1.0})


@every("path", ["crank_length", "coupler_length", "rocker_length", "rocker_pivot.x"])
def test_only_mass_derivatives_are_given(path):
    found = program("4/1/3/2")
    with pytest.raises(ks.ParameterError, match=f"no derivative by {path}"):
        found.derivatives(0.3, (path, "crank.mass"))
    slopes = found.derivatives(0.3)["balancing_torque"]
    assert path not in slopes
    step = 1e-3
    difference = (
        found(0.3, {"coupler.mass": 1.5 + step})["balancing_torque"]
        - found(0.3, {"coupler.mass": 1.5 - step})["balancing_torque"]
    )
    assert slopes["coupler.mass"] == pytest.approx(difference / (2 * step), rel=1e-9)


def test_sweeps_refuse_means_of_growing_forces():
    import pandas as pd

    scene = ks.Scene(four_bar("4/1/3/2", "open"), SPEED, loads=ks.Gravity())
    designs = pd.DataFrame({"coupler.mass": [1.0, 2.0]})
    with pytest.raises(ks.ParameterError, match="no mean and no largest value"):
        ks.sweep(scene, designs, ["mean B"], progress=False)
    table = ks.sweep(scene, designs, ["largest balancing_torque"], angles=720, progress=False)
    with_mass = scene.varied({"coupler.mass": 2.0})
    largest = ks.extremes(with_mass.solve(12), "balancing_torque").range[1]
    assert table.iloc[1, 1] == pytest.approx(largest, rel=1e-6)


# Change points of groups on a second throw are those on the pin of a crank turned ahead


def thrown(group, at):
    """A group on a pin of the crank, its crank without a mass of its own."""
    return ks.Mechanism("thrown", ks.Crank(0.7), (ks.Pin("crank", at, "C"), group))


def hung(kind, assembly, on):
    if kind == "slider":
        return ks.SliderGroup(0.75, ks.Guide.at(0.4, -0.25), assembly, LINKS["coupler"], LINKS["rocker"], on=on)
    if kind == "lever":
        return ks.LeverGroup((-0.3, -0.4), on, lever=LINKS["rocker"], block=LINKS["coupler"], assembly=assembly)
    _, b, h, d = (0.5 * length for length in LINKAGES[kind])
    return ks.RockerGroup(b, h, (-0.8 * d, 0.6 * d), assembly, LINKS["coupler"], LINKS["rocker"], on=on)


@pytest.mark.slow
@every("assembly", SIDES)
@every("ahead", [(0.0, 0.5), (-0.5, 0.0), (0.3, 0.4), (-0.4, -0.3), (0.5, 0.0)])
@every("kind", [*LINKAGES, "slider", "lever"])
def test_second_throw_equals_a_crank_turned_ahead(kind, ahead, assembly):
    """Both count the crank angle from where the pin points to the pivot, or along the guide's right normal."""
    radius = LINKAGES[kind][0] * 0.5 if kind in LINKAGES else 0.5
    at = tuple(2.0 * radius * part for part in ahead)
    angles = np.array([0.3, 2.0, 5.0, 8.0, 11.0])
    group = hung(kind, assembly, "A")
    x, y = (group.guide.direction[1], -group.guide.direction[0]) if kind == "slider" else group.pivot
    own = ks.Mechanism("own", ks.Crank(radius), (group,))
    turn = np.angle(x + 1j * y) - np.angle((x + 1j * y) / complex(*at))
    made = thrown(hung(kind, assembly, "C"), at)
    assert made.passes
    assert made.turns == own.turns
    expected, found = solve(own, angles + turn), solve(made, angles)
    for values, right in (
        (found.balancing_torque, expected.balancing_torque),
        (found.reaction("C"), expected.reaction("A")),
        *((found.rate(link), expected.rate(link)) for link in made.groups[1].links),
        *((found.acceleration(name), expected.acceleration(name)) for name in list(made.groups[1].joints)[:1]),
    ):
        np.testing.assert_allclose(values, right, rtol=0, atol=1e-11 * (np.abs(right).max() + 1.0))
    both = np.sort((np.array(own.change_points) - turn) % (2 * np.pi))
    np.testing.assert_allclose(made.change_points, both, atol=1e-14)


@pytest.mark.slow
@every("assembly", SIDES)
@every("name", ["parallelogram", "kite", "deltoid", "rhombus", "near"])
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_second_throw_is_as_exact_as_the_first(name, assembly):
    """The whole turned by a quarter: crank angles near the change point stay as fine as they can be."""
    a, b, h, d = map(float, LINKAGES[name])
    links = {link: LINKS[link] for link in ("coupler", "rocker")}
    own = ks.Mechanism("own", ks.Crank(a), (ks.RockerGroup(b, h, (d, 0.0), assembly, **links),))
    made = thrown(ks.RockerGroup(b, h, (0.0, d), assembly, on="C", **links), (0.0, a))
    expected, found = (solve(item, np.array(NEAR), loads=()) for item in (own, made))
    np.testing.assert_allclose(found.balancing_torque, expected.balancing_torque, rtol=1e-12)
    np.testing.assert_allclose(found.angular_acceleration("coupler"), expected.angular_acceleration("coupler"), 1e-12)
    (x, y), (along, across) = expected.reaction("O2"), found.reaction("O2")
    assert np.all(np.maximum(abs(along + y), abs(across - x)) < 1e-12 * np.maximum(abs(x), abs(y)))


def test_program_keeps_the_radius_of_the_pin():
    made = thrown(hung("parallelogram", "open", "C"), (0.4, 0.3))
    found = ks.compile(ks.Scene(made, SPEED, loads=ks.Gravity()), "balancing_torque", engine="numpy")
    with pytest.raises(ks.ParameterError, match="another kind"):
        found(0.3, {"pin_C.along": 0.41})
    with pytest.raises(ks.ParameterError, match=r"no derivative by pin_C.across"):
        found.derivatives(0.3, "pin_C.across")
    assert "pin_C.along" not in found.derivatives(0.3)["balancing_torque"]
    other = thrown(hung("parallelogram", "open", "C"), (0.5, 0.0))
    values = found(0.3, {"pin_C.along": 0.5, "pin_C.across": 0.0})["balancing_torque"]
    np.testing.assert_allclose(values, ks.Scene(other, SPEED, loads=ks.Gravity()).solve(0.3).balancing_torque)


@pytest.mark.slow
@every("at", [(0.0, 0.625), (0.375, 0.5), (-0.625, 0.0)])
def test_second_throw_enclosures_hold(at):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from kinetostatics.studies.methods.high_precision.certified import certified

    rockers = ks.RockerGroup(1.875, 1.25, (-1.5, 2.0), "crossed", LINKS["coupler"], LINKS["rocker"], on="C")
    made = thrown(rockers, at)
    found = certified(solve(made, np.array([0.3, 4.0, 9.0])), "balancing_torque")
    assert found.agreement < 1e-25


@every("at", [(0.0, 0.0), (0.5, 0.0)])
def test_other_pins_have_no_change_points(at):
    if any(at):
        groups = (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ks.Pin("coupler", at), hung("deltoid", "open", "C"))
    else:
        groups = (ks.Pin("crank", at), hung("deltoid", "open", "C"))
    with pytest.raises(ks.ParameterError, match="but it is attached to 'C'; give"):
        ks.Mechanism("chain", ks.Crank(0.1), groups)
