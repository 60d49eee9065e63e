"""Bearings of pins: published numbers, dense sums over turning links, laws, refusals, and the figure."""

import math
import warnings
from dataclasses import replace
from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from support import change_points, followers, mirror, pages
from support.case_files import shipped
from support.every import every
from support.units import UNITS

TURN = 2.0 * np.pi
RATED = {"capacity": 600e3, "static_capacity": 1e6}
STEEL = (210e9, 0.3)
pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")


@cache
def saw(variant, radius=None):
    """The saw of the case, its cam roller of a radius."""
    s = shipped("sawframe_2r63").solve(variant, 8)
    if radius is None:
        return s
    roller, *others = s.mechanism.groups
    groups = (replace(roller, roller=ks.Roller(radius, 0.04, *STEEL)), *others)
    return replace(ks.Scene.of(s), mechanism=replace(s.mechanism, groups=groups)).solve(8)


def pump(speed=20.0, loads=(), **links):
    links = {"slider": ks.Link(1.5)} | links
    return ks.solve(ks.crank_slider(0.05, 0.16, **links), 0.0, crank_speed=speed, loads=loads)


def follower(speed=12.0, pressed=True):
    """A roller follower on a four-bar."""
    roller = ks.Roller(0.01, 0.02, *STEEL) if pressed else None
    group = replace(followers.KINDS["swinging"](), roller=roller)
    return followers.scene(group, speed, 0.0).solve(8)


def by_ratings(s, joint, **more):
    return ks.sizing.bearing(s, joint, **{**RATED, **more})


# Published numbers


@every(
    "loads, shares, exponent, expected, digits",
    [([650, 750, 250], [30, 10, 20], 3, 597, 0), ([3.0, 2.0, 1.0, 0.0], [10, 20, 30, 40], 3, 1.663, 3)],
)
def test_loads_in_steps(loads, shares, exponent, expected, digits):
    assert round(ks.sizing.equivalent_load(loads, shares, exponent), digits) == expected


def test_a_load_that_rises_in_proportion():
    """0.630 of the largest, exactly 4^(-1/3); catalogues take 2/3."""

    def rising(q):
        return 900.0 * np.mod(q.crank_angle, TURN) / TURN

    rising.kinks = lambda motion: ((), np.zeros(1))
    s = ks.solve(ks.scotch_yoke(0.05), 0.0, crank_speed=10.0, loads=ks.ProcessForce(rising))
    found = by_ratings(s, "A", exponent=3)
    assert found.equivalent_load == pytest.approx(900.0 * 0.25 ** (1 / 3), rel=1e-12)
    assert round(found.equivalent_load / found.largest_load, 3) == 0.630
    assert found.relative_turns == pytest.approx(1.0, rel=1e-12)


def test_bearings_of_the_saw():
    """Life in turns of the bearing grows by (P/P')^p; at B the shorter way of the balanced saw adds 1 %."""
    plain, balanced = ({joint: by_ratings(saw(name), joint) for joint in "OAB"} for name in ("plain", "cam-circle"))
    loads = [round(found[joint].equivalent_load / 1e3, 2) for joint in "OA" for found in (plain, balanced)]
    assert loads == [196.04, 15.54, 198.35, 38.82]
    gains = {joint: balanced[joint].life_turns / plain[joint].life_turns for joint in "OAB"}
    assert (round(gains["O"]), round(gains["A"])) == (4675, 230)
    travelled = gains["B"] * balanced["B"].relative_turns / plain["B"].relative_turns
    assert (round(travelled, -2), round(gains["B"], -2)) == (35400, 35800)
    assert round(np.degrees(plain["B"].oscillation), 1) == 8.6
    assert balanced["O"].smallest_load == 0.0  # four times a turn, with a massless crank


def test_pin_of_the_cam_roller_carries_the_cam_force():
    """Not the load of A, where the coupler turns; the way of the roller as of the cam's contact."""
    s = saw("cam-circle", 0.05)
    found = by_ratings(s, "roller")
    assert round(found.largest_load / 1e3, 1) == 49.9
    contact = ks.design.contact(s, load_rating=600e3).roller
    assert found.equivalent_load == pytest.approx(contact.equivalent_load(s), rel=1e-10)
    assert found.life_hours == pytest.approx(contact.life(s), rel=1e-10)
    assert found.point_share == 0.0


# An independent computation: dense sums, rotation by differences of angles


DENSE = np.linspace(0.0, TURN, 20001)


def angle_of(s, link):
    """Angle of a link over a turn, from places of two of its points."""
    if link == "frame":
        return np.zeros(s.crank_angle.shape)
    one, other = s.position((link, 0.0, 0.0)), s.position((link, 1.0, 0.0))
    return np.unwrap(np.arctan2(*(other - one)[::-1]))


def summed(force, turned, power):
    """Equivalent load and turns from loads at even crank angles and the angle turned between the rings."""
    way = np.abs(np.diff(turned))
    middle = 0.5 * (force[1:] + force[:-1])
    return (np.sum(middle**power * way) / way.sum()) ** (1.0 / power), way.sum() / TURN


FOUR_BAR = {"O": ("crank", "frame"), "A": ("coupler", "crank"), "B": ("rocker", "coupler"), "O2": ("rocker", "frame")}


@cache
def dense():
    return follower().at(DENSE)


@pytest.mark.slow
@every("joint, power", [(joint, power) for joint in FOUR_BAR for power in (3.0, 10 / 3)])
def test_dense_sums_of_a_four_bar(joint, power):
    s = dense()
    pair = FOUR_BAR[joint]
    turned = angle_of(s, pair[0]) - angle_of(s, pair[1])
    load, turns = summed(np.hypot(*s.reaction(joint)), turned, power)
    found = by_ratings(s, joint, exponent=power)
    assert set(found.pin.rings) == set(pair)
    assert (found.equivalent_load, found.relative_turns) == pytest.approx((load, turns), rel=1e-6)
    swings = abs(turned[-1] - turned[0]) < 1e-9
    assert found.oscillation == pytest.approx(np.ptp(turned) / 2 if swings else np.inf, rel=1e-6)
    assert found.life_turns == pytest.approx(1e6 * (600e3 / load) ** power / turns, rel=1e-5)


def test_dense_sums_of_a_roller_on_a_disk_cam():
    """Its centre as seen from the crank; the roller turns by the length of its path over its radius."""
    s = dense()
    x, y = s.position("R")
    path = (x + 1j * y) * np.exp(-1j * DENSE)
    force = s.scalar("contact_force")
    step = np.where(force[1:] > 0, -1, 1) * np.abs(np.diff(path)) / 0.01
    rolled = np.concatenate([[0.0], np.cumsum(step)])
    load, turns = summed(np.abs(force), DENSE + rolled - angle_of(s, "arm"), 10 / 3)
    found = by_ratings(s, "roller")
    assert (found.equivalent_load, found.relative_turns) == pytest.approx((load, turns), rel=1e-5)


# Laws


NUMBERS = tuple(ks.sizing.bearing(saw("plain"), "A", **RATED).ROWS)


def assert_alike(one, other):
    values = ([getattr(found, name) for name in NUMBERS] for found in (one, other))
    assert next(values) == pytest.approx(next(values), rel=1e-9, abs=1e-9)


@pytest.mark.slow
@every("joint", ["O", "A", "B"])
def test_both_senses_of_rotation_wear_alike(joint):
    assert_alike(by_ratings(pump(20.0), joint), by_ratings(pump(-20.0), joint))


@pytest.mark.slow
@every("joint", ["O", "A", "B", "roller"])
def test_the_mirror_image_wears_alike(joint):
    scene = ks.Scene.of(follower())
    assert_alike(by_ratings(scene.solve(8), joint), by_ratings(mirror.mirrored(scene).solve(8), joint))


@pytest.mark.slow
@every("exponent", [1.0, 3.0, 10 / 3])
def test_speed_and_ratings(exponent):
    """Loads of inertia grow with the square of the speed, life with the power of the rating over them."""
    one = by_ratings(pump(), "A", exponent=exponent)
    fast = by_ratings(pump(40.0), "A", exponent=exponent, capacity=2.4e6)
    assert fast.equivalent_load == pytest.approx(4.0 * one.equivalent_load, rel=1e-12)
    assert (fast.life_turns, fast.life_hours) == pytest.approx((one.life_turns, 0.5 * one.life_hours), rel=1e-12)
    assert fast.static_safety == pytest.approx(0.25 * one.static_safety, rel=1e-12)
    least = 0.02 if exponent > 3 else 0.01
    assert fast.needed_load == least * 2.4e6


def test_steps_in_small_parts_are_the_same():
    whole = ks.sizing.equivalent_load([5.0, 2.0], [0.3, 0.7])
    assert ks.sizing.equivalent_load([5.0, 2.0, 5.0, 2.0], [1.0, 3.5, 2.0, 3.5]) == pytest.approx(whole, rel=1e-14)
    assert ks.sizing.equivalent_load([7.0] * 3, [1, 0, 2]) == pytest.approx(7.0, rel=1e-14)
    assert ks.sizing.equivalent_load([0.0, 0.0], [1, 1]) == 0.0


@every("speed, rings", [(14.0, ("circumferential or indeterminate", "point")), (14.02, ("point", "circumferential"))])
def test_the_larger_of_a_fixed_and_a_turning_load_decides_the_rings(speed, rings):
    """A crank whose weight m g stays and whose inertia force m e omega^2 turns with it: equal at 14.007 rad/s."""
    s = pump(speed, ks.Gravity(), crank=ks.Link(8.0, 0.05), slider=ks.Link(0.0))
    found = by_ratings(s, "O")
    assert all(found.ring_loads[ring].startswith(word) for ring, word in zip(("crank", "frame"), rings, strict=True))
    turning = 0.05 * speed**2
    assert found.largest_load == pytest.approx(8.0 * (turning + 9.81), rel=1e-3)


def test_loads_in_the_axes_of_the_rings():
    """The frame pulls an unbalanced crank inward; a ring cam pushes roller and block so."""
    s = pump(30.0, crank=ks.Link(8.0, 0.05), slider=ks.Link(0.0)).at([0.0, 2.0])
    on_crank, on_frame = by_ratings(s, "O").pin.in_rings(s)
    assert np.allclose(on_crank, [[-360.0, -360.0], [0.0, 0.0]])
    assert np.allclose(on_frame, 360.0 * np.array([[1.0, np.cos(2.0)], [0.0, np.sin(2.0)]]))
    s = saw("cam-circle", 0.05).at([0.0, 2.0])
    on_roller, on_block = by_ratings(s, "roller").pin.in_rings(s)
    assert np.isnan(on_roller).all()
    assert np.allclose(on_block[0], -s.cam_force * np.cos(s.pressure_angle))
    assert s.cam_force[0] > 0


def test_plain_bearing_under_a_turning_load():
    """An unbalanced crank: all is constant."""
    s = pump(30.0, crank=ks.Link(8.0, 0.05), slider=ks.Link(0.0))
    found = ks.sizing.plain_bearing(s, "O", diameter=0.04, width=0.05)
    pressure, speed = 8.0 * 0.05 * 900.0 / 0.002, 30.0 * 0.02
    numbers = found.largest_pressure, found.largest_speed, found.largest_pv, found.mean_pv
    assert numbers == pytest.approx((pressure, speed, pressure * speed, pressure * speed), rel=1e-12)
    rolling = by_ratings(s, "O")
    assert rolling.ring_loads == {"crank": "point", "frame": "circumferential or indeterminate"}
    assert (rolling.point_share, rolling.equivalent_load) == pytest.approx((1.0, 360.0), rel=1e-12)


def test_mean_pv_of_a_plain_bearing_is_the_heat_of_its_friction():
    """To first order in the coefficient."""
    s = pump(loads=ks.Gravity())
    found = ks.sizing.plain_bearing(s, "B", diameter=0.02, width=0.03)
    rubbing = ks.Scene(s.mechanism, 20.0, loads=s.loads, friction={"B": ks.PinFriction(1e-6, 0.01)}).solve(8)
    assert found.mean_pv * 0.02 * 0.03 * 1e-6 == pytest.approx(rubbing.losses.friction["B"], rel=1e-5)
    at = s.at(DENSE)
    pv = np.hypot(*at.reaction("B")) / (0.02 * 0.03) * np.abs(at.rate("coupler")) * 0.01
    assert (found.largest_pv, found.mean_pv) == pytest.approx((pv.max(), pv[:-1].mean()), rel=1e-6)


def test_quantities_with_units_are_converted():
    found = by_ratings(pump(), "A", capacity=UNITS("600 kN"), static_capacity=UNITS("1 MN"))
    assert_alike(found, by_ratings(pump(), "A"))
    one = ks.sizing.equivalent_load(UNITS.Quantity([1.0, 2.0], "kN"), [1, 1])
    assert one == pytest.approx(ks.sizing.equivalent_load([1e3, 2e3], [1, 1]), rel=1e-14)


# What is doubtful or refused


@pytest.mark.filterwarnings("default::kinetostatics.HintWarning")
@every(
    "joint, rating, static, words",
    [
        ("B", 200e3, 1e6, r"B swings by \+-8.63 deg: with fewer than 42 rolling elements .* false brinelling"),
        ("A", 900e3, 1e6, r"the load at A falls to 13620 N, below the 18000 N that rolling elements need"),
        ("A", 600e3, 286e3, r"the load at A exceeds C0 or its equivalent C/2"),
        ("A", 390e3, 1e6, r"the load at A exceeds C0 or its equivalent C/2"),
    ],
)
def test_notes_are_hints(joint, rating, static, words):
    with pytest.warns(ks.HintWarning, match=words):
        found = ks.sizing.bearing(saw("plain"), joint, capacity=rating, static_capacity=static)
    assert found.table().attrs["notes"] == list(found.notes) != []


def test_a_pin_without_load_lives_on():
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        found = by_ratings(pump(slider=ks.Link(0.0)), "A")
    assert (found.equivalent_load, found.life_turns, found.static_safety) == (0.0, np.inf, np.inf)
    assert math.isnan(found.point_share)
    assert found.ring_loads == {}


@pytest.mark.slow
def test_a_pin_that_never_turns():
    """Two bars on pins of one link turn with it: as a plain bearing it has pressure, but no pv."""
    parts = ks.Pin(on="crank", at=(0.02, 0.1), name="C"), ks.Dyad(0.3, 0.4, on=("A", "C"), dyad1=ks.Link(1.0, 0.1))
    s = ks.solve(ks.Mechanism("rigid", ks.Crank(0.1), parts), 0.0, crank_speed=10.0)
    with pytest.raises(ks.ParameterError, match="bearing: at dyad1_A dyad1 and crank turn together, without relative"):
        by_ratings(s, "dyad1_A")
    found = ks.sizing.plain_bearing(s, "dyad1_A", diameter=0.02, width=0.05)
    assert found.largest_pressure * 0.001 == pytest.approx(np.hypot(*s.reaction("dyad1_A")), rel=1e-9)
    assert (found.largest_speed, found.largest_pv, found.mean_pv) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


REFUSED = [
    ({"capacity": 0.0}, "capacity must be greater than 0"),
    ({"capacity": math.nan}, "capacity must be finite"),
    ({"static_capacity": -1.0}, "static_capacity must be greater than 0"),
    ({"exponent": 0.5}, "exponent must be at least 1"),
    ({"capacity": np.array([[1e5], [2e5]])}, "capacity must be one number"),
    ({"capacity": None, "static_capacity": 0.0}, "capacity must be a number.*; static_capacity must be"),
    ({"joint": "guide"}, "pin joint is 'guide', allowed: 'O', 'A', 'B'"),
    ({"joint": "slider", "capacity": 0.0}, "capacity must be.*; pin joint is 'slider'"),
    ({"joint": 3}, "pin joint is 3"),
]


@every("wrong, message", REFUSED)
def test_wrong_numbers_and_names_are_refused(wrong, message):
    given = {"joint": "A", **RATED, **wrong}
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.bearing(pump(), given.pop("joint"), **given)


PASSING = change_points.four_bar("parallelogram", "open")
MACHINES = [
    (lambda: "pump", "A", "solution must be a Solution"),
    (lambda: ks.solve(ks.crank_slider(0.05, 0.16), 0.0, crank_speed=0.0, sense=1), "A", "the crank is at rest"),
    (lambda: pump(np.array([[20.0], [30.0]])), "A", "works on one design at a time"),
    (lambda: ks.solve(ks.crank_slider(0.05, 0.04), 0.0, crank_speed=1.0), "A", "does not close for crank angles 53.1"),
    (lambda: saw("cam-circle"), "roller", "the rotation of roller follows from its radius; give"),
    (lambda: follower(pressed=False), "roller", "the rotation of roller follows from its radius; give"),
    (lambda: ks.solve(PASSING, 0.3, crank_speed=1.0), "A", "the load at A grows without bound"),
]


@every("machine, joint, message", MACHINES)
def test_machines_without_bearing_loads_are_refused(machine, joint, message):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        s = machine()
        with pytest.raises(ks.ParameterError, match=message):
            by_ratings(s, joint)
        with pytest.raises(ks.ParameterError, match=message):
            ks.sizing.plain_bearing(s, joint, diameter=0.1, width=0.1)


@every(
    "sizes, message",
    [
        ({"diameter": 0.0, "width": -1.0}, "diameter must be greater than 0.*; width must be greater than 0"),
        ({"diameter": math.inf, "width": 0.1}, "diameter must be finite"),
    ],
)
def test_plain_bearing_refuses(sizes, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.plain_bearing(pump(), "A", **sizes)


@every(
    "loads, shares, message",
    [
        ([1.0], [1.0, 2.0], "shares and loads must be equal in number"),
        ([1.0, 2.0], [0.0, 0.0], "with a share greater than 0"),
        ([-1.0, 2.0], [1.0, 2.0], "loads must not be negative, got -1"),
        ([1.0, math.nan], [1.0, -2.0], "loads.* must be finite.*; shares must not be negative"),
        ([], [], "with a share greater than 0"),
        (3.0, [1.0], "loads must be a tuple of numbers"),
    ],
)
def test_steps_are_refused(loads, shares, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.sizing.equivalent_load(loads, shares)


def test_figure_has_hodographs_in_both_rings_and_the_load():
    figure = ks.plots.bearing(by_ratings(saw("plain"), "A"))
    assert [ax.get_xlabel() for ax in figure.axes[:2]] == ["along the coupler [kN]", "along the crank [kN]"]
    level = figure.axes[2].lines[1].get_ydata()
    assert level[0] == pytest.approx(198.35, abs=0.01)
    assert len(ks.plots.bearing(by_ratings(saw("cam-circle", 0.05), "roller")).axes) == 2
    with pytest.raises(ks.ParameterError, match="found must be a Bearing"):
        ks.plots.bearing(3)
    plt.close("all")


@pages.needed
@pytest.mark.slow
def test_numbers_of_the_page_are_those_of_the_library():
    names: dict = {}
    for code in pages.cells("parts/bearings.md"):
        exec(code, names)
    assert names["found"].pin.name == "A"
    plt.close("all")
