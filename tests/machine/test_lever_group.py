"""Lever and cylinder groups."""

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import AssemblyError, ConditionWarning, ParameterError
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.methods.high_precision.certified import enclosure, relative_errors
from support.every import every

R = 0.1
SHAPER, WHITWORTH = (0.03, -0.25), (0.02, -0.05)
EPSILON = 2.0**-53


def exact(angle, pivot, offset=0.0, crank=R):
    """Angle of the lever, coordinate of the block, and two derivatives of each by the crank angle."""

    def distance(turned):
        return crank * mp.expj(turned) - mp.mpc(*pivot)

    def lean(turned):
        d = distance(turned)
        return mp.arg(d / distance(angle)) - mp.asin(offset / abs(d))

    def reach(turned):
        return mp.sqrt(abs(distance(turned)) ** 2 - mp.mpf(offset) ** 2)

    with mp.workdps(60):
        angle, crank, offset = mp.mpf(angle), mp.mpf(crank), mp.mpf(offset)
        lever = mp.expj(mp.arg(distance(angle)) + lean(angle))
        return complex(lever), *(float(mp.diff(lean, angle, n)) for n in (1, 2)), float(reach(angle))


def solve(pivot, angles, offset=0.0, crank=R, **options):
    made = ks.slotted_lever(crank, pivot=pivot, offset=offset)
    return ks.solve(made, np.asarray(angles), crank_speed=1.0, **options)


def dead_centres(pivot):
    """Crank angles, crank at right angles to the lever: it stands still there."""
    towards, opening = np.angle(complex(*pivot)), np.arccos(R / abs(complex(*pivot)))
    return np.array([towards - opening, towards + opening])


@pytest.mark.slow
@every("offset", [0.0, 0.03, -0.02])
@every("pivot", [SHAPER, WHITWORTH, (0.0, 0.0)])
def test_motion_is_that_of_the_angles_to_rounding(pivot, offset):
    angles = np.linspace(0.05, 6.2, 9)
    if offset == 0.0 and pivot == SHAPER:
        angles = np.append(angles, dead_centres(pivot))
    s = solve(pivot, angles, offset)
    rows = [exact(angle, pivot, offset) for angle in angles]
    direction = np.array(s.placement.links["lever"].direction)
    found = (
        direction[0] + 1j * direction[1],
        s.rate("lever"),
        s.angular_acceleration("lever"),
        s.measure("block_position"),
    )
    for name, own, expected in zip(
        ("direction", "rate", "slope", "reach"), found, zip(*rows, strict=True), strict=True
    ):
        assert np.max(np.abs(own - np.array(expected))) < 1e-14 * max(np.max(np.abs(expected)), 1.0), name


def test_lever_rests_at_dead_centres():
    angles = dead_centres(SHAPER)
    s = solve(SHAPER, angles)
    assert np.max(np.abs(s.rate("lever"))) < 4 * EPSILON
    expected = [exact(angle, SHAPER)[2] for angle in angles]
    assert np.max(np.abs(s.angular_acceleration("lever") - expected)) < 4 * EPSILON


def test_inner_pivot_lets_the_lever_turn_fully():
    angles = np.linspace(0.0, 2 * np.pi, 256, endpoint=False)
    inside, outside = (solve(pivot, angles).rate("lever") for pivot in (WHITWORTH, SHAPER))
    assert np.all(inside > 0.0)
    assert np.mean(inside) == pytest.approx(1.0, abs=1e-14)
    assert np.mean(outside) == pytest.approx(0.0, abs=1e-14)


def test_a_pivot_at_o_turns_with_the_crank():
    s = solve((0.0, 0.0), np.linspace(0.0, 6.0, 7), offset=0.06)
    assert np.max(np.abs(s.rate("lever") - 1.0)) < 4 * EPSILON
    assert np.max(np.abs(s.angular_acceleration("lever"))) < 4 * EPSILON
    assert np.max(np.abs(s.measure("block_position") - 0.08)) < EPSILON


def test_slot_lies_left_of_the_pivot():
    s = solve(SHAPER, np.linspace(0.0, 6.0, 7), offset=0.04)
    x, y = np.array(s.placement.links["lever"].direction)
    across = x * (s.position("A")[1] - SHAPER[1]) - y * (s.position("A")[0] - SHAPER[0])
    assert np.max(np.abs(across - 0.04)) < 1e-16


@every("gap", [1e-2, 1e-4, 1e-6])
def test_lever_near_its_pivot_keeps_its_condition(gap):
    """Crank as long as the pivot's distance but for a gap: the lever turns over within a small angle."""
    pivot, angles = (0.0, -R * (1.0 + gap)), -np.pi / 2 + np.array([-2.0, -0.5, 0.0, 0.3, 1.0]) * gap
    s = solve(pivot, angles)
    for row, angle in enumerate(angles):
        _, rate, slope, _ = exact(angle, pivot)
        allowed = 4 * EPSILON * s.condition[row]
        assert abs(s.rate("lever")[row] - rate) <= allowed * max(abs(rate), 1.0)
        assert abs(s.angular_acceleration("lever")[row] - slope) <= allowed * max(abs(slope), 1.0 / gap**2)


def test_lever_forces_are_those_of_moments():
    """A lever with weight only, at rest: the slot bears its moment about the pivot."""
    lever = ks.Link(4.0, (0.3, 0.05), 0.2)
    made = ks.slotted_lever(R, pivot=SHAPER, lever=lever)
    s = ks.solve(made, 0.4, crank_speed=0.0, loads=[ks.Gravity(10.0)])
    direction = complex(*s.placement.links["lever"].direction)
    arm = (0.3 + 0.05j) * direction
    slot = -40.0 * arm.real / s.measure("block_position")
    assert s.scalar("slot_force") == pytest.approx(slot, rel=1e-14)
    assert complex(*s.reaction("O2")) == pytest.approx(40.0j + 1j * slot * direction, rel=1e-14)
    assert complex(*s.reaction("A")) == pytest.approx(-1j * slot * direction, rel=1e-14)
    assert s.scalar("slot_moment") == 0.0


# Where it does not close


def test_offset_beyond_the_pin_is_refused():
    with pytest.raises(AssemblyError) as refused:
        solve((0.0, -0.2), np.linspace(0.0, 6.0, 20), offset=0.15)
    words = str(refused.value)
    assert "the distance from A to O2" in words
    assert "must be greater than the slot's offset, 0.15 m" in words
    (low, high) = refused.value.intervals[0]
    for angle in (low, high):
        assert abs(R * np.exp(1j * angle) + 0.2j) == pytest.approx(0.15, abs=1e-9)
    s = solve((0.0, -0.2), np.array([1.0, 1.5 * np.pi]), offset=0.15, on_gap="nan")
    assert np.isnan(s.rate("lever")[1])
    assert np.isfinite(s.rate("lever")[0])


def test_pin_meeting_the_pivot_warns():
    with pytest.warns(ConditionWarning, match="at crank angle 0 deg .* near a limit position"):
        s = solve((R, 0.0), np.array([0.0, 1.0]))
    with pytest.warns(ConditionWarning, match="at crank angle 0 deg .* near a limit position"):
        solve_engine(ks.CylinderGroup((CRANK, 0.0)), angles=np.array([0.0, 1.0]))
    assert s.condition[0] > 1e8
    assert s.rate("lever")[1] == pytest.approx(0.5, abs=1e-15)


# What is refused


@every(
    "kind, fields, words",
    [
        (ks.LeverGroup, {"pivot": 0.2}, "lever pivot must be a pair"),
        (ks.LeverGroup, {"pivot": (0.2, np.nan)}, "lever pivot y must be finite"),
        (ks.LeverGroup, {"pivot": (0.2, 0.1, 0.3)}, "lever pivot must be a pair"),
        (ks.LeverGroup, {"offset": np.inf}, "slot offset must be finite"),
        (ks.LeverGroup, {"offset": "0.1"}, "slot offset must be a number"),
        (ks.LeverGroup, {"offset": None}, "slot offset must be a number"),
        (ks.LeverGroup, {"lever": 3.0}, "lever must be a Link"),
        (ks.LeverGroup, {"block": None}, "block must be a Link"),
        (ks.LeverGroup, {"on": ""}, "on must be a name"),
        (ks.LeverGroup, {"pivot_name": 2}, "pivot_name must be a name"),
        (ks.CylinderGroup, {"pivot": "O2"}, "cylinder pivot must be a pair"),
        (ks.CylinderGroup, {"pivot": (np.inf, 0.0)}, "cylinder pivot x must be finite"),
        (ks.CylinderGroup, {"rod": 1.0}, "rod must be a Link"),
        (ks.CylinderGroup, {"cylinder": 1.0}, "cylinder must be a Link"),
        (ks.CylinderGroup, {"on": None}, "on must be a name"),
        (ks.CylinderGroup, {"label": 2}, "label must be a name"),
    ],
)
def test_what_no_group_can_have_is_refused(kind, fields, words):
    with pytest.raises(ParameterError, match=f"{kind.RULES.owner}: {words}"):
        kind(**{"pivot": (0.0, -0.2)} | fields)


def test_a_lever_on_the_block_of_a_cam_needs_a_label():
    with pytest.raises(
        ParameterError, match=r"adds link 'block' a second time.*adds quantity 'slot_force' a second time"
    ):
        ks.Mechanism("chain", ks.Crank(), (ks.CamRoller(ks.cams.Circle(0.3, (0.05, 0.0))), ks.LeverGroup((0.0, -0.6))))


def test_block_position_belongs_to_its_label():
    groups = ks.LeverGroup(SHAPER), ks.LeverGroup((0.4, 0.1), pivot_name="O3", label="2")
    s = ks.solve(ks.Mechanism("two levers", ks.Crank(R), groups), 0.3, crank_speed=1.0)
    for name, pivot in (("block_position", SHAPER), ("block2_position", (0.4, 0.1))):
        assert s.measure(name) == pytest.approx(abs(R * np.exp(0.3j) - complex(*pivot)), rel=1e-15)


# Swinging cylinders

CRANK, PIVOT = 0.1, (0.05, -0.35)
ANGLES = np.linspace(0.1, 6.2, 9)
ROD, CYLINDER = ks.Link(1.5, (0.15, 0.01), 0.05), ks.Link(3.0, (0.1, -0.02), 0.04)
LOADS = [ks.Gravity(9.81, -1.2)]


def solve_engine(*parts, angles=ANGLES, **options):
    made = ks.Mechanism("oscillating engine", ks.Crank(CRANK), parts)
    return ks.solve(made, angles, **{"crank_speed": 20.0, "crank_acceleration": 5.0, "loads": LOADS} | options)


def test_cylinder_moves_as_a_slotted_lever():
    cylinder, lever = solve_engine(ks.CylinderGroup(PIVOT)), solve_engine(ks.LeverGroup(PIVOT))
    for link in ("rod", "cylinder"):
        assert np.array_equal(cylinder.rate(link), lever.rate("lever"))
        assert np.array_equal(cylinder.angular_acceleration(link), lever.angular_acceleration("lever"))
    rod, bore = (np.array(cylinder.placement.links[name].direction) for name in ("rod", "cylinder"))
    assert np.array_equal(rod, -bore)
    tip = cylinder.position("A") + cylinder.measure("cylinder_length") * rod
    assert np.max(np.abs(tip - np.array(PIVOT)[:, None])) < 1e-16


def test_its_length_is_by_the_law_of_cosines():
    d, lean = np.hypot(*PIVOT), np.arctan2(PIVOT[1], PIVOT[0])
    expected = np.sqrt(CRANK**2 + d**2 - 2 * CRANK * d * np.cos(ANGLES - lean))
    assert np.max(np.abs(solve_engine(ks.CylinderGroup(PIVOT)).measure("cylinder_length") - expected)) < 1e-15


def test_a_cylinder_of_no_mass_bears_no_couple():
    s = solve_engine(ks.CylinderGroup(PIVOT, rod=ROD))
    assert np.all(s.scalar("cylinder_moment") == 0.0)
    assert np.max(np.abs(s.scalar("cylinder_force"))) > 1.0


def test_requirement_tells_the_distances():
    group = ks.CylinderGroup(PIVOT)
    placement = ks.Mechanism("engine", ks.Crank(CRANK), (group,)).place(ANGLES)
    words = group.requirement(placement)
    assert words.startswith("the distance from A to O2, 0.2")
    assert words.endswith("must be greater than zero")


@every("margin", [1e-3, 1e-6, 1e-9])
def test_pin_clearing_the_pivot_keeps_its_digits(flint, margin):
    reach = 0.3125
    group = ks.CylinderGroup((reach, 0.0), rod=ROD, cylinder=CYLINDER)
    engine = ks.Mechanism("engine", ks.Crank(reach * (1.0 - margin)), (group,))
    s = ks.solve(engine, margin * np.linspace(-2.0, 2.0, 21), crank_speed=20.0, loads=LOADS)
    for quantity in ("cylinder_rate", "O"):
        exact = enclosure(s, quantity, digits=20)
        moved = relative_errors(enclosure(s.at(np.nextafter(s.crank_angle, 9.0)), quantity, digits=20).exact, exact)
        assert relative_errors(components(s, quantity), exact).max() <= 5.0 * (UNIT_ROUNDOFF + moved.max())
