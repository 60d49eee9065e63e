"""Planes along the crankshaft: rocking moment, reactions of two bearings, torque between throws, two counterweights."""

from dataclasses import replace
from textwrap import dedent

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.design.case_text import write_case
from kinetostatics.errors import ConditionWarning, KinetostaticsError
from support.case_files import shipped
from support.every import every

SPEED = 2000 * np.pi / 30
FOUR = np.radians([0.0, 180.0, 270.0, 90.0])


def in_line(angles=FOUR, pitch=0.2, shift=0.0, crank=ks.Crank(None), radius=0.05, rod=0.2, **links):
    """Cylinders in line along x, the first with the smallest z, the middle of all at `shift`."""
    parts = []
    for number, angle in enumerate(angles):
        at, plane = (radius * np.cos(angle), radius * np.sin(angle)), shift + (number - (len(angles) - 1) / 2) * pitch
        parts.append(ks.Pin(on="crank", at=at, name=f"P{number}", plane=plane))
        rods = {"on": f"P{number}", "pin": f"B{number}", "label": str(number), **links}
        parts.append(ks.SliderGroup(rod, **{"slider": ks.Link(2.0)} | rods))
    return ks.Mechanism("in line", crank, tuple(parts))


def mixed(bearings=(-0.45, 0.5)):
    """One group of each kind in its own plane, a dyad and a slider on others, a crank of two planes."""
    link = ks.Link(1.5, (0.06, 0.01), 0.02)
    return ks.Mechanism(
        "mixed",
        ks.Crank(0.05, ks.Rotor(4.0, (0.01, -0.02), 0.03, plane=0.05, couple_unbalance=(0.02, -0.01)), bearings),
        (
            ks.SliderGroup(0.2, ks.Guide.at(0.3, 0.01), coupler=link, slider=link, plane=-0.3),
            ks.Pin(on="coupler", at=(0.1, 0.03), name="E"),
            ks.RockerGroup(0.2, 0.15, (0.2, -0.1), coupler=link, rocker=link, pin="F", label="2", plane=0.3),
            ks.SliderGroup(0.4, ks.Guide.at(1.5), slider=link, on="F", pin="G", label="3"),
            ks.Pin(on="crank", at=(-0.02, 0.04), name="C", plane=0.15),
            ks.LeverGroup((0.02, -0.25), on="C", lever=link, block=link, pivot_name="O4", label="4"),
            ks.YokeGroup(ks.Guide.at(-0.4), slider=link, block=link, pin="H", label="5", plane=-0.1),
            ks.RollerFollower(ks.laws.cosine(0.02, 0.1), follower=link, label="6", plane=0.4),
        ),
    )


LOADS = (ks.Gravity(), ks.Spring(3e5, 0.1, on="slider", mass=0.8), ks.Force(300.0, at="G"), ks.Torque(7.0, on="crank"))
MIXED = ks.Scene(mixed(), 90.0, 40.0, LOADS).solve(24)


def turned(vector):
    """The vector after a quarter turn: k x vector."""
    return np.array([-vector[1], vector[0]])


def harmonic(values, order):
    return 2 * abs(np.fft.rfft(values)[order]) / values.size


def plain_saw():
    return shipped("sawframe_2r63").variant("plain")


# Published and known numbers


def test_couples_of_four_in_line():
    s = ks.Scene(in_line(), SPEED).solve(360)
    unit = 2.0 * 0.05 * SPEED**2
    assert harmonic(s.rocking_moment[1], 1) == pytest.approx(unit * abs(-0.3 + 0.1 - 0.1j + 0.3j), rel=1e-12)
    assert harmonic(s.rocking_moment[1], 1) == pytest.approx(1240.69, abs=0.005)
    assert harmonic(s.rocking_moment[1], 2) == pytest.approx(891.42, abs=0.005)
    assert unit * 0.25 * abs(-0.3 - 0.1 - 0.1 - 0.3) == pytest.approx(877.3, abs=0.05)  # the usual series
    assert harmonic(s.shaking_force[0], 4) == pytest.approx(71.9, abs=0.05)
    assert ks.extremes(s, "rocking_moment").largest == pytest.approx(1855, abs=0.5)
    assert ks.extremes(s, "shaking_force").largest < 72.0


def test_couple_of_the_opposed_twin_saw():
    case = plain_saw()
    (rod,) = case.mechanism.groups
    opposite = ks.SliderGroup(
        rod.coupler_length, ks.Guide.at(np.pi), coupler=rod.coupler, slider=rod.slider, on="C", pin="D", label="2"
    )
    first = ks.SliderGroup(rod.coupler_length, coupler=rod.coupler, slider=rod.slider, plane=-0.15)
    pin = ks.Pin(on="crank", at=(-case.mechanism.crank.length, 0.0), name="C", plane=0.15)
    twin = ks.Mechanism("twin saw", ks.Crank(case.mechanism.crank.length), (first, pin, opposite))
    s = ks.Scene(twin, case.crank_speed).solve(360)
    assert ks.extremes(s, "shaking_force").largest < 1e-9
    assert ks.extremes(s, "rocking_moment").largest == pytest.approx(86e3, rel=1e-3)


def test_six_in_line_are_balanced():
    """Cranks 0, 120, 240, 240, 120, 0 deg: no couple of any order, by symmetry about the middle."""
    s = ks.Scene(in_line(np.radians([0, 120, 240, 240, 120, 0])), SPEED).solve(90)
    assert abs(s.rocking_moment).max() < 1e-11 * abs(s.inertia_force("slider0")).max()


# Laws


def test_rocking_moment_is_the_sum_of_mass_times_acceleration_in_planes():
    made = MIXED.mechanism
    total = np.zeros((2, 24))
    for name, link in made.links.items():
        total -= made.planes[name] * turned(link.mass * MIXED.acceleration(name))
    total -= made.planes["slider"] * turned(0.4 * MIXED.acceleration("B"))  # half of the spring
    total += turned(couple_of_crank(MIXED))
    np.testing.assert_allclose(MIXED.rocking_moment, total, rtol=0, atol=1e-12 * abs(total).max())


def test_groups_on_groups_lie_in_their_plane():
    assert MIXED.mechanism.planes == {
        "crank": 0.05,
        **{"coupler": -0.3, "slider": -0.3, "coupler2": 0.3, "rocker2": 0.3, "coupler3": 0.3, "slider3": 0.3},
        **{"lever4": 0.15, "block4": 0.15, "block5": -0.1, "slider5": -0.1, "follower6": 0.4},
    }


PINS = {"A": (-0.3, "A"), "A2": (0.3, "A"), "C4": (0.15, "C"), "A5": (-0.1, "A")}
"""Plane and pin of the groups of `mixed` on pins of the crank, by their reaction."""


def couple_of_crank(s):
    """First moment along the shaft of the inertia of the crank, beyond that of its mass centre."""
    along = np.array([np.cos(s.crank_angle), np.sin(s.crank_angle)])
    d = 0.02 * along - 0.01 * turned(along)
    return s.crank_speed**2 * d - s.crank_acceleration * turned(d)


def loads_on_crank(s):
    """Plane, force on the crank and moment about O: of the crank itself, of groups on its pins, the rest of the cam."""
    body, point = s.mechanism.links["crank"], s.position("crank")
    force = body.mass * (np.array([[0.0], [-9.81]]) - s.acceleration("crank"))
    found = [(0.05, force, cross(point, force) - body.inertia * s.crank_acceleration + 7.0)]
    for name, (plane, pin) in PINS.items():
        found.append((plane, -s.reaction(name), cross(s.position(pin), -s.reaction(name))))
    rest = -s.reaction("O") - sum(force for _, force, _ in found)
    return [*found, (0.4, rest, -s.balancing_torque - sum(moment for *_, moment in found))]


def cross(arm, force):
    return arm[0] * force[1] - arm[1] * force[0]


@pytest.mark.slow
def test_bearings_carry_the_reaction_and_its_moment():
    left, right = (MIXED.reaction("O", at=side) for side in ("left", "right"))
    scale = abs(MIXED.reaction("O")).max()
    np.testing.assert_allclose(left + right, MIXED.reaction("O"), rtol=0, atol=1e-14 * scale)
    moment = sum(plane * force for plane, force, _ in loads_on_crank(MIXED)) + couple_of_crank(MIXED)
    np.testing.assert_allclose(-0.45 * left + 0.5 * right, -moment, rtol=0, atol=1e-13 * scale)


@pytest.mark.slow
def test_torque_in_the_shaft_moves_the_throws_beyond():
    planes = {"coupler": -0.3, "block5": -0.1, "lever4": 0.15, "coupler2": 0.3, "follower6": 0.4}
    assert set(MIXED.mechanism.on_shaft) == planes.keys()
    near = {"rtol": 0, "atol": 1e-12 * abs(MIXED.balancing_torque).max()}
    loads = loads_on_crank(MIXED)
    for name, plane in planes.items():
        right, left = (MIXED.shaft_torque(name, drive=drive) for drive in ("right", "left"))
        np.testing.assert_allclose(right, -sum(moment for z, _, moment in loads if z <= plane), **near)
        np.testing.assert_allclose(left, -sum(moment for z, _, moment in loads if z >= plane), **near)
    np.testing.assert_allclose(MIXED.shaft_torque("follower6"), MIXED.balancing_torque, **near)


def test_mirrored_and_shifted_planes():
    here, mirrored, moved = (
        ks.Scene(made, SPEED).solve(36) for made in (in_line(), in_line(pitch=-0.2), in_line(FOUR[:3], shift=0.7))
    )
    scale = abs(here.rocking_moment).max()
    np.testing.assert_allclose(mirrored.rocking_moment, -here.rocking_moment, rtol=0, atol=1e-13 * scale)
    middle = ks.Scene(in_line(FOUR[:3]), SPEED).solve(36)
    expected = middle.rocking_moment + 0.7 * turned(middle.shaking_force)
    np.testing.assert_allclose(moved.rocking_moment, expected, rtol=0, atol=1e-12 * scale)


def test_both_senses_of_rotation_have_the_same_couple():
    forth, back = (ks.Scene(in_line(), speed).solve(36).rocking_moment for speed in (SPEED, -SPEED))
    np.testing.assert_array_equal(forth, back)


@pytest.mark.slow
def test_planes_change_nothing_else():
    groups = tuple(replace(part, plane=None) for part in mixed().groups)
    flat = ks.Mechanism("flat", ks.Crank(0.05, ks.Link(4.0, (0.01, -0.02), 0.03)), groups)
    s = ks.Scene(flat, 90.0, 40.0, LOADS).solve(24)
    for name in (*s.reactions, *s.scalars, "shaking_force", "shaking_moment", "kinetic_energy"):
        read = ks.extremes(s, name).value, ks.extremes(MIXED, name).value
        np.testing.assert_array_equal(*read)
    assert not {"rocking_moment", "O left"} & set(s.frame().columns.str.partition(" [")[0])


@pytest.mark.slow
def test_friction_stays_in_the_sum():
    s = MIXED.mechanism
    friction = {"O": ks.PinFriction(0.1, 0.02), "A": ks.PinFriction(0.1, 0.02), "guide": ks.GuideFriction(0.1)}
    rubbing = ks.solve(s, MIXED.crank_angle, crank_speed=90.0, loads=LOADS, friction=friction)
    total = rubbing.reaction("O", at="left") + rubbing.reaction("O", at="right")
    np.testing.assert_allclose(total, rubbing.reaction("O"), rtol=0, atol=1e-13 * abs(total).max())
    lost = rubbing.balancing_torque - rubbing.shaft_torque("follower6")  # what the main bearings take
    np.testing.assert_allclose(abs(lost), abs(rubbing.friction_at("O")), rtol=1e-9)


@pytest.mark.slow
@every("quantity", ["rocking_moment", "O left", "shaft_torque lever4"])
def test_shares_add_up(quantity):
    shares = MIXED.shares(quantity)
    assert abs(shares.rest) < 1e-9 * shares.total.peak


# Two counterweights


def two(arm=0.04, reciprocating=0.0, planes=(-0.35, 0.4), **made):
    left, right = (ks.Counterweight(arm=arm, plane=plane) for plane in planes)
    return ks.balancing.in_two_planes(in_line(**made), left=left, right=right, reciprocating=reciprocating)


@pytest.mark.slow
@every("angles", [FOUR, FOUR[:3], FOUR[:1]])
def test_two_counterweights_balance_rotating_masses(angles):
    rotating = {"coupler": ks.Link(1.3), "slider": ks.Link()}  # all mass on the crank pins
    crank = ks.Crank(None, ks.Rotor(3.0, (0.01, 0.02), 0.1, 0.1, (0.02, 0.03)), (-0.5, 0.6))
    before = ks.Scene(in_line(angles, crank=crank, **rotating), SPEED, 100.0).solve(16)
    found = two(angles=angles, crank=crank, **rotating)
    s = ks.Scene(found.mechanism, SPEED, 100.0).solve(16)
    for read in ("shaking_force", "rocking_moment"):
        assert abs(getattr(s, read)).max() < 1e-12 * max(1e3, abs(getattr(before, read)).max())
    assert abs(s.reaction("O", at="left")).max() < 1e-12 * abs(before.reaction("O", at="left")).max()
    assert found.added_mass == pytest.approx(sum(mass for _, mass, _ in found.in_planes))


def test_half_of_the_reciprocating_masses_halves_the_primary_couple():
    s = ks.Scene(two(reciprocating=0.5).mechanism, SPEED).solve(64)
    x, y = (np.fft.rfft(part)[1] / 32 for part in s.rocking_moment)
    assert abs(y) == pytest.approx(1240.69 / 2, abs=0.005)
    assert abs(x) == pytest.approx(1240.69 / 2, abs=0.005)


def test_the_rotating_part_of_a_coupler_with_its_mass_aside():
    """The first harmonic that turns with the crank is gone, the rest of B's is only along the guide."""
    coupler = ks.Link(1.5, (0.06, 0.03))
    made = in_line(FOUR[:1], coupler=coupler, rod=20.0)  # so long that B moves as A does along x, and hardly turns
    weights = {name: ks.Counterweight(mass=1.0, plane=z) for name, z in (("left", -0.1), ("right", 0.1))}
    s = ks.Scene(ks.balancing.in_two_planes(made, **weights).mechanism, SPEED).solve(64)
    across = abs(s.shaking_force[1]).max()
    assert across < 0.01 * 1.5 * 0.05 * SPEED**2


# Quantities


@pytest.mark.slow
def test_extremes_sweeps_programs_and_cases(tmp_path):
    text = """
        title = "pump of two throws"
        reference = "pump"
        [variants.pump]
        mechanism = "chain"
        crank_speed = "1000 rpm"
        crank_length = "50 mm"
        crank = {mass = "3 kg", plane = "20 mm", couple_unbalance = ["0.1 kg m^2", "0 kg m^2"]}
        bearings = ["-200 mm", "200 mm"]
        groups = [
            {kind = "slider", coupler_length = "200 mm", plane = "-100 mm", slider = {mass = "2 kg"}},
            {kind = "pin", on = "crank", at = ["-50 mm", "0 mm"], name = "C", plane = "0.1 m"},
            {kind = "slider", coupler_length = "200 mm", slider = {mass = "2 kg"}, on = "C", pin = "D", label = "2"},
        ]
    """
    (tmp_path / "pump.toml").write_text(dedent(text), encoding="utf-8")
    case = ks.load_case(tmp_path / "pump.toml")
    variant = case.variant("pump")
    assert variant.mechanism.crank.bearings == (-0.2, 0.2)
    assert variant.mechanism.crank.link.couple_unbalance == (0.1, 0.0)
    paths = {"pin_plane_C", "coupler_plane", "bearings.left", "crank.plane", "crank.couple_unbalance.along"}
    assert paths <= variant.units.keys()
    outputs = ("largest rocking_moment", "largest O left", "largest shaft_torque coupler2")
    designs = pd.DataFrame({"pin_plane_C [mm]": [100.0, 150.0], "crank.couple_unbalance.along [kg*m**2]": [0.1, 0.0]})
    swept = ks.sweep(case, designs, outputs, variant="pump", progress=False)
    for row in range(2):
        moved = variant.scene.varied({"pin_plane_C": [0.1, 0.15][row], "crank.couple_unbalance.along": [0.1, 0.0][row]})
        s = moved.solve(360)
        for output in outputs:
            column = next(name for name in swept if name.startswith(output))
            expected = abs(ks.extremes(s, output.removeprefix("largest ")).largest)
            assert swept[column][row] == pytest.approx(expected, rel=1e-9)
    program = ks.compile(variant.scene, ("rocking_moment", "O left"))
    s = variant.scene.solve(np.array([0.3]))
    np.testing.assert_allclose(program(0.3)["rocking_moment"], s.rocking_moment[:, 0], rtol=1e-14)
    slope = program.derivatives(0.3, by=("pin_plane_C",))["rocking_moment"]["pin_plane_C"]
    np.testing.assert_allclose(slope, turned(s.inertia_force("slider2"))[:, 0], rtol=1e-12)
    assert np.all(s.error_bound("rocking_moment") < 1e-9)
    assert "rocking" in s.explain("rocking_moment", 0.3).text


@pytest.mark.slow
def test_hodograph_of_the_couple_has_its_largest_value():
    s = ks.Scene(in_line(), SPEED).solve(36)
    ax = ks.plots.rocking_moment(s)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("rocking moment about x [N m]", "rocking moment about y [N m]")
    drawn = np.hypot(*ax.lines[0].get_data())
    assert drawn.max() == pytest.approx(ks.extremes(s, "rocking_moment").largest)
    with pytest.raises(KinetostaticsError):
        ks.plots.rocking_moment(PLAIN)


def test_batches_of_planes_and_bearings():
    planes = np.array([[0.1], [0.2], [-0.3]])
    rod = ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=planes)
    crank = ks.Crank(0.05, bearings=(-0.4, np.array([[0.4], [0.5], [0.6]])))
    s = ks.Scene(ks.Mechanism("batch", crank, (rod,)), SPEED).solve(8)
    assert s.rocking_moment.shape == s.reaction("O", at="right").shape == (2, 3, 8)
    share = (planes + 0.4) / (np.array([[0.4], [0.5], [0.6]]) + 0.4)
    np.testing.assert_allclose(s.reaction("O", at="right"), s.reaction("O") * share, rtol=1e-12, atol=1e-9)


def test_reactions_of_bearings_grow_where_that_of_o_does():
    made = ks.Mechanism(
        "folding", ks.Crank(0.1, bearings=(-1.0, 1.0)), (ks.SliderGroup(0.1, assembly="open", slider=ks.Link(1.0)),)
    )
    s = ks.Scene(made, 10.0, loads=[ks.Gravity(), ks.ProcessForce(10.0)]).solve([1.0, np.pi / 2])
    with pytest.warns(ConditionWarning):
        s.reaction("O", at="left")


# Hostile


@every("slip", [{"pin": 100.0}, {"rod": 100.0}, {"bearings": (-200.0, 200.0)}, {"crank": ks.Rotor(1.0, plane=20.0)}])
def test_millimetres_along_the_shaft_are_asked_about(slip):
    pin = ks.Pin(on="crank", at=(0.05, 0.0), name="C", plane=slip.get("pin"))
    rod = ks.SliderGroup(0.2, slider=ks.Link(2.0), on="C", plane=slip.get("rod"))
    made = ks.Mechanism("slip", ks.Crank(None, slip.get("crank", ks.Link()), slip.get("bearings")), (pin, rod))
    with pytest.warns(ks.HintWarning, match="is it in mm"):
        ks.Scene(made, 10.0).solve(8)


ROD = {"slider": ks.Link(2.0)}
PLAIN = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(2.0)), 10.0).solve(8)
FLAT = ks.Scene(ks.Mechanism("flat", ks.Crank(0.05, bearings=(-1, 1)), (ks.SliderGroup(0.2, **ROD),)), 10.0).solve(8)
WEIGHTS = {name: ks.Counterweight(arm=0.1, plane=plane) for name, plane in (("left", -0.1), ("right", 0.1))}


def pair(pin, first, second, on="C"):
    """Planes of the pin C of the crank, of a group on it, and of another on C or on the joint B of the first."""
    parts = [ks.Pin(on="crank", at=(0.1, 0.0), name="C", plane=pin), ks.SliderGroup(0.3, on="C", plane=first)]
    parts.append(ks.SliderGroup(0.3, on=on, pin="D", label="2", plane=second))
    return ks.Mechanism("pair", ks.Crank(0.05), tuple(parts))


def cam_saw():
    return shipped("sawframe_2r63").variant("cam-circle").mechanism


@every(
    "make, message",
    [
        (lambda: ks.SliderGroup(0.2, plane=np.nan), "plane must be finite"),
        (lambda: ks.Pin(on="crank", at=(0, 0), plane="0.1"), "plane must be a number"),
        (lambda: ks.YokeGroup(plane=np.array([0.1, 0.2])), "plane must be a number or an array"),
        (lambda: ks.Rotor(1.0, plane=np.inf), "plane must be finite"),
        (lambda: ks.Rotor(1.0, couple_unbalance=0.1), "couple_unbalance must be a pair"),
        (lambda: ks.SliderGroup(0.2, slider=ks.Rotor(1.0)), "slider must be a Link: a Rotor is for the crank"),
        (lambda: ks.CamRoller(ks.cams.Circle(0.1), block=ks.Rotor(1.0)), "block must be a Link"),
        (lambda: ks.Crank(0.1, bearings=(0.4, 0.4)), "bearings must be (left, right) with left < right"),
        (lambda: ks.Crank(0.1, bearings=(0.4, -0.4)), "bearings must be (left, right) with left < right"),
        (lambda: ks.Crank(0.1, bearings=(np.array([[0.0], [1.0]]), 0.5)), "left < right"),
        (lambda: ks.Crank(0.1, bearings=0.4), "bearings must be a pair (left, right)"),
        (lambda: ks.Crank(0.1, bearings=(0.4,)), "bearings must be a pair (left, right)"),
        (lambda: ks.Crank(0.1, bearings=(0.4, np.nan)), "bearings right must be finite"),
        (lambda: pair(0.2, 0.1, None), "coupler has plane 0.1 m, but the part that carries it has plane 0.2 m"),
        (
            lambda: pair(None, 0.1, 0.2, on="B"),
            "coupler2 has plane 0.2 m, but the part that carries it has plane 0.1 m",
        ),
        (lambda: pair(None, None, 0.2, on="B"), "the part that carries it has plane 0.0 m"),
        (lambda: PLAIN.rocking_moment, "no part has a plane"),
        (lambda: FLAT.rocking_moment, "no part has a plane"),
        (lambda: ks.extremes(PLAIN, "rocking_moment"), "rocking_moment"),
        (lambda: PLAIN.shaft_torque("coupler"), "no part has a plane"),
        (lambda: MIXED.shaft_torque("slider"), "'slider'"),
        (lambda: MIXED.shaft_torque("coupler", drive="top"), "'top'"),
        (lambda: MIXED.shaft_torque("coupler", drive=np.array(["left", "right"])), "drive is array"),
        (lambda: PLAIN.reaction("O", at="left"), "the crank has no bearings"),
        (lambda: FLAT.reaction("O", at="middle"), "'middle'"),
        (lambda: FLAT.reaction("A", at="left"), "joint with main bearings"),
        (lambda: ks.Counterweight(arm=0.1, plane=np.nan), "plane must be finite"),
        (lambda: ks.balancing.counterweight(PLAIN.mechanism, "slider", 0.1, WEIGHTS["left"]), "a plane is for"),
        (lambda: ks.balancing.in_two_planes(in_line(), left=1.0, right=None), "left must be a Counterweight"),
        (lambda: two(planes=(0.1, 0.1)), "left and right have the same plane, 0.1 m"),
        (lambda: two(planes=(0.1, None)), "right needs a plane: Counterweight(..., plane=0.3)"),
        (lambda: two(reciprocating=1.5), "reciprocating must lie between 0 and 1"),
        (lambda: two(reciprocating=np.nan), "reciprocating must be finite"),
        (lambda: two(slider=ks.Link()), "has no mass"),
        (lambda: ks.balancing.in_two_planes(cam_saw(), **WEIGHTS), "varying distance"),
    ],
)
def test_bad_input_is_named(make, message):
    with pytest.raises(KinetostaticsError) as caught:
        make()
    assert message in str(caught.value)


def test_planes_and_bearings_are_written_into_case_files(tmp_path):
    pins = tuple(ks.Pin(on="crank", at=(x, 0.0), name=f"P{k}", plane=z) for k, (x, z) in enumerate(PINS_AT))
    groups = tuple(ks.SliderGroup(0.2, slider=ks.Link(2.0), on=f"P{k}", pin=f"B{k}", label=str(k)) for k in (0, 1))
    rotor = ks.Rotor(4.0, 0.01, 0.02, plane=0.05, couple_unbalance=(0.01, 0.0))
    twin = ks.Mechanism("twin", ks.Crank(None, rotor, bearings=(-0.3, 0.3)), pins + groups)
    single = ks.Mechanism("single", ks.Crank(0.05, bearings=(-0.1, 0.2)), (ks.SliderGroup(0.2, plane=0.1),))
    scenes = {"twin": ks.Scene(twin, 100.0), "single": ks.Scene(single, 100.0)}
    case = ks.load_case(write_case(tmp_path / "written.toml", "Twin", scenes))
    for name, scene in scenes.items():
        own, read = scene.solve(9), case.solve(name, 9)
        assert np.array_equal(own.reaction("O", at="left"), read.reaction("O", at="left"))
        assert np.array_equal(own.rocking_moment, read.rocking_moment)


PINS_AT = (0.05, -0.1), (-0.05, 0.1)
"""Place along the crank and plane of two pins, m."""
