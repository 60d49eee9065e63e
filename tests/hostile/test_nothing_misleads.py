"""What looks right and is wrong is refused, warned of or mended: states of groups, hints, designs, sweeps, loads."""

import itertools
import time
import warnings
from dataclasses import fields

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

ROD, BODY = ks.Link(2.0, (0.1, 0.03), 0.02), ks.Link(3.0, (0.1, 0.03), 0.02)

# Groups of one's own: each state of each link and joint

GROUPS = {
    "slider": ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1), -1, ROD, BODY),
    "rocker": ks.RockerGroup(0.4, 0.3, (0.35, 0.1), 1, ROD, BODY),
    "lever": ks.LeverGroup((0.1, -0.3), offset=0.05, lever=ROD, block=BODY),
    "cylinder": ks.CylinderGroup((0.3, -0.4), rod=ROD, cylinder=BODY),
    "yoke": ks.YokeGroup(ks.Guide.at(0.4, 0.03), 1.2, slider=ROD, block=BODY),
    "dyad": ks.Dyad(0.5, 0.45, ("C", "E"), "D", 1, ROD, BODY),
    "cam": ks.CamRoller(ks.cams.Circle(0.3, (0.05, 0.1)), ROD),
    "pin": ks.Pin(on="coupler", at=(0.1, 0.2), name="C"),
}
OF_LINKS = ("joint.position", "joint.first", "joint.second", "direction", "ratio", "ratio_slope")
OF_JOINTS = ("position", "first", "second")
FREE = {("lever", "block"), ("cylinder", "rod"), ("cylinder", "cylinder"), ("yoke", "block"), ("cam", "block")}
"""Links whose axis may point either way along a slot: no joint shows which."""
STATES = [
    (kind, table, name, state)
    for kind, group in GROUPS.items()
    for table, names, states in (
        ("links", group.links, OF_LINKS),
        ("joints", group.joints, OF_JOINTS),
        ("travels", group.guides, OF_JOINTS),
    )
    for name in names
    for state in states
]


def own(group, **methods):
    """The group as one of a class of the user's own with other methods."""
    kind = type("Own", (type(group),), methods)
    return kind(**{item.name: getattr(group, item.name) for item in fields(group) if item.init})


def spoiled(value, flipped):
    """A wrong value in place of a number, a vector or None, which stands for zero."""
    if value is None or (np.ndim(value) == 0 and not isinstance(value, tuple) and value == 0):
        return None
    if isinstance(value, tuple):
        return tuple(-part if flipped else 1.01 * part + 0.003 for part in value)
    return -value if flipped else 1.01 * value + 0.003


WRONG = [
    (*state, flipped)
    for state in STATES
    for flipped in (True, False)
    if not (flipped and state[-1] == "direction" and (state[0], state[2]) in FREE)
]


@every("kind", GROUPS)
def test_groups_as_they_are_pass_the_check(kind):
    assert ks.check(GROUPS[kind]).ok


@pytest.mark.slow
@every(("kind", "table", "name", "state", "flipped"), WRONG)
def test_check_finds_each_wrong_state(kind, table, name, state, flipped):
    group = GROUPS[kind]

    def place(self, placement):
        type(group).place(self, placement)
        found = getattr(placement, table)
        whole, of_joint, field = found[name], state.startswith("joint."), state.removeprefix("joint.")
        part = whole.joint if of_joint else whole
        value = getattr(part, field)
        zero = 0.01 if field.startswith("ratio") else (0.003, 0.001)
        part = part._replace(**{field: zero if value is None else spoiled(value, flipped)})
        found[name] = whole._replace(joint=part) if of_joint else part

    report = ks.check(own(group, place=place))
    assert not report.ok
    assert any(name in problem for problem in report.problems)


@every("kind", ["slider", "lever", "cylinder", "yoke", "cam"])
def test_check_finds_friction_that_drives(kind):
    group = GROUPS[kind]

    def sliding(self, name, placement):
        found = type(group).sliding(self, name, placement)
        return found._replace(rate=-found.rate)

    assert "rate of sliding" in ks.check(own(group, sliding=sliding)).problems[0]


def test_check_finds_a_link_unlike_its_bar():
    """Directions and rates of twice the angle agree with each other, but the bar's end is no place of such a link."""

    def place(self, placement):
        ks.RockerGroup.place(self, placement)
        motion = placement.links["coupler"]
        x, y = motion.direction
        twice = {"direction": (x * x - y * y, 2 * x * y), "ratio": 2 * motion.ratio}
        placement.links["coupler"] = motion._replace(**twice, ratio_slope=2 * motion.ratio_slope)

    report = ks.check(own(GROUPS["rocker"], place=place))
    assert any("place of B in the axes of coupler" in problem for problem in report.problems)


def test_check_finds_unrepeatable_places():
    count = iter(range(1, 10**6))

    def place(self, placement):
        ks.SliderGroup.place(self, placement)
        joint = placement.joints["B"]
        x, y = joint.position
        placement.joints["B"] = joint._replace(position=(x + 1e-3 * next(count), y))

    assert any("place called twice" in problem for problem in ks.check(own(GROUPS["slider"], place=place)).problems)


# Hints: what looks like degrees, or like another unit

MACHINE = ks.crank_slider(0.1, 0.4, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0))
SCENE = ks.Scene(MACHINE, 5.0, loads=ks.Gravity())
DEGREES = np.arange(0.0, 360.0, 10.0)


def program():
    return ks.compile(SCENE, ("balancing_torque", "O"), engine="numpy")


def running():
    return ks.drive.steady(SCENE, None, flywheel=50.0).solution


def with_inertia(times):
    """A solution with a coupler of so many times mass times length squared."""
    rod = ks.Link(2.0, 0.2, times * 2.0 * 0.4**2)
    return ks.solve(ks.crank_slider(0.1, 0.4, coupler=rod, slider=ks.Link(3.0)), 0.5, crank_speed=5.0)


HINTS = {
    "solution at degrees": (lambda: SCENE.solve(36).at(DEGREES), "from 0 to 350 by 10 look like degrees"),
    "solution at a list": (lambda: SCENE.solve(36).at([0, 90, 180, 270]), "from 0 to 270 by 90 look like degrees"),
    "solution at 90.0": (lambda: SCENE.solve(36).at(90.0), "the crank angle 90 looks like degrees"),
    "solution at a count": (lambda: SCENE.solve(36).at(360), "360 is used as one crank angle"),
    "running at degrees": (lambda: running().at(DEGREES), "from 0 to 350 by 10 look like degrees"),
    "running at a count": (lambda: running().at(360), "360 is used as one crank angle"),
    "program at degrees": (lambda: program()(DEGREES), "from 0 to 350 by 10 look like degrees"),
    "program at 90.0": (lambda: program()(90.0), "the crank angle 90 looks like degrees"),
    "program at a count": (lambda: program()(360), "360 is used as one crank angle"),
    "derivatives at degrees": (lambda: program().derivatives(DEGREES), "look like degrees"),
    "bounds at degrees": (lambda: program().error_bound(DEGREES), "look like degrees"),
    "explained at 39": (lambda: SCENE.solve(36).explain("O", 39), "39 looks like degrees.*39 rad.*np.radians"),
    "explained at 39.0": (lambda: SCENE.solve(36).explain("O", 39.0), "39 looks like degrees"),
    "explained at -45": (lambda: SCENE.solve(36).explain("O", [-45]), "-45 looks like degrees"),
    "coast from 39": (
        lambda: ks.drive.coast(SCENE, 1.0, from_angle=39, from_speed=3.0, until=0.01),
        "coast: the crank angle 39 looks like degrees",
    ),
    "cam profile": (lambda: ks.cams.Circle(0.3, (0.05, 0.1)).profile(0.02, DEGREES), "look like degrees"),
    "inertia in kg cm2": (lambda: with_inertia(1e4 / 12), r"inertia of the coupler.*1e\+04 times.*kg cm2.*0.02667 kg"),
    "inertia in kg mm2": (lambda: with_inertia(1e6 / 12), r"inertia of the coupler.*1e\+06 times.*kg mm2.*0.02667 kg"),
    "inertia of 3.5 m l2": (lambda: with_inertia(3.5), "inertia of the coupler.*42 times.*about the mass centre"),
    "batch of inertias": (lambda: with_inertia(np.array([[1 / 12], [1e4 / 12]])), "kg cm2.*0.02667 kg m2"),
}


@pytest.mark.slow
@every("name", HINTS)
def test_slips_are_hinted_at_the_callers_line(name):
    ask, words = HINTS[name]
    with pytest.warns(ks.HintWarning, match=words) as caught:
        ask()
    assert [item.filename for item in caught if item.category is ks.HintWarning] == [__file__]


@pytest.mark.parametrize(("area", "hinted"), [(-78.5, True), (7850.0, True), (-78.5e-4, False), (0.785, False)])
def test_area_in_square_centimetres_is_hinted(tmp_path, area, hinted):
    path = tmp_path / "pressure.csv"
    path.write_text("crank_angle [deg],pressure [bar]\n0,1\n90,5\n180,2\n270,1\n", encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ks.Table.from_csv(path, area=area)
    assert [str(item.message) for item in caught] == [f"table: area is {area:g} m2; is it in cm2, or in mm2?"] * hinted


def test_radians_of_several_turns_are_not_hinted():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution, made = SCENE.solve(36), program()
        for angles in (40.5, 39.0, np.linspace(0.0, 40.0 * np.pi, 721), np.linspace(-30.0, 30.0, 11)):
            solution.at(angles)
            made(angles)
        solution.explain("O", 40.5)
        with_inertia(2.9)


# Balancing: gaps, ratios, springs of no stiffness

WEIGHT = ks.Counterweight(arm=0.05)
OPEN = {
    "crank-slider": ks.crank_slider(0.3, 0.25, crank=ks.Link(1.0, 0.1), coupler=ROD, slider=BODY),
    "four-bar": ks.four_bar(0.4, 0.3, 0.4, rocker_pivot=(0.5, 0.0), crank=ks.Link(1.0, 0.1), coupler=ROD, rocker=BODY),
}
INTERVALS = {"crank-slider": [(56.4427, 123.557), (236.443, 303.557)], "four-bar": [(101.537, 258.463)]}


@pytest.mark.slow_start
@every("norm", ["largest", "mean", "weighted"])
@every("name", OPEN)
def test_gaps_leave_no_optimal_counterweight(name, norm):
    with pytest.raises(ks.AssemblyError, match="so that the crank turns all round") as caught:
        ks.balancing.optimal(OPEN[name], norm, crank=WEIGHT)
    assert np.degrees(caught.value.intervals) == pytest.approx(np.array(INTERVALS[name]), rel=1e-5)


@pytest.mark.slow_start
@pytest.mark.parametrize("name", OPEN)
def test_machines_with_gaps_have_no_quantile(name):
    spread = ks.design.Spread(0.9, {"coupler.mass": "normal 0 % +- 1 %"})
    with pytest.raises(ks.AssemblyError, match="so that the crank turns all round"):
        ks.design.over_spread(ks.Scene(OPEN[name], 5.0), "largest O", spread, samples=16)


@pytest.mark.slow_start
def test_spreads_that_reach_gaps_are_refused():
    spread = ks.design.Spread(0.9, {"coupler_length": "normal 0 % +- 5 %"})
    scene = ks.Scene(ks.crank_slider(0.3, 0.31, coupler=ROD, slider=BODY), 5.0)
    with pytest.raises(
        ks.ParameterError, match=r"over_spread: \d+ of 64 machines .* do not close .*; use narrower spr"
    ):
        ks.design.over_spread(scene, "mean_absolute balancing_torque", spread, samples=64)


@pytest.mark.parametrize("ratio", [-5, -0.1, 1.1, 5.0])
def test_ratio_beyond_both_ends_is_refused(ratio):
    with pytest.raises(ks.ParameterError, match=f"ratio must be from 0 .* to 1 .*, got {ratio:g}: beyond them"):
        ks.balancing.partial(MACHINE, ratio, crank=ks.Counterweight(arm=-0.05))


MOWER = """
title = "Mower"
[variants.mower]
mechanism = "crank-slider"
crank_speed = "600 rpm"
crank_length = "38 mm"
coupler_length = "300 mm"
coupler = { mass = "2 kg", centre = "100 mm" }
slider.mass = "5 kg"
balancing = { method = "partial", ratio = RATIO, crank = { arm = "-20 mm" } }
"""
SAW = """
title = "Saw"
[variants.saw]
mechanism = "cam-crank-slider"
crank_speed = "SPEED"
coupler_length = "2.0219 m"
slider.mass = "MASS"
cam = { kind = "circle", radius = "0.3 m", centre = ["-0.0219 m", "0 m"] }
spring = { stiffness = "balance the slider", free_position = "2 m" }
"""
CASES = {
    "ratio of -5": (MOWER, {"RATIO": "-5"}, r"mower\.balancing\.ratio must be from 0 .* got -5"),
    "ratio of 1.5": (MOWER, {"RATIO": "1.5"}, r"mower\.balancing\.ratio must be from 0 .* got 1\.5"),
    "no speed": (
        SAW,
        {"SPEED": "0 rpm", "MASS": "600 kg"},
        r"saw: spring\.stiffness: .*the crank speed is 0, so .* the stiffness would be 0; give",
    ),
    "no mass": (SAW, {"SPEED": "320 rpm", "MASS": "0 kg"}, r"saw: spring\.stiffness: .*the mass is 0, so"),
}


@pytest.mark.slow_start
@pytest.mark.parametrize("name", CASES)
def test_case_without_balance_is_refused_by_key(tmp_path, name):
    text, values, words = CASES[name]
    path = tmp_path / "case.toml"
    for word, value in values.items():
        text = text.replace(word, value)
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ks.CaseError, match=words):
        ks.load_case(path)


@pytest.mark.parametrize(
    ("mass", "speed", "words"),
    [
        (600.0, 0.0, "the crank speed is 0, so"),
        (0.0, 33.5, "the mass is 0, so"),
        (0.0, 0.0, "the mass is 0 and the crank speed is 0"),
        (np.array([[600.0], [0.0]]), 33.5, "the mass is 0, so"),
    ],
)
def test_a_spring_that_balances_nothing_is_refused(mass, speed, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.Spring.balancing(mass, speed, free_position=2.0)


# Designs and sweeps

SPREADS = {"slider.mass": "500..700 kg", "spring.stiffness": "normal 712 kN/m +- 5 kN/m"}


@every(
    ("uniform", "words"),
    [
        ([[2.0, 0.5]], "must be from 0 to 1 .* but 1 of 2 are not, 2 for instance"),
        ([[0.5, -0.1], [0.5, 0.5]], "but 1 of 4 are not, -0.1 for instance"),
        ([[np.nan, 0.5]], "but 1 of 2 are not, nan for instance"),
        (lambda size: np.full((3, size), 600.0), "but 6 of 6 are not, 600 for instance"),
        ([[0.5, 0.0]], "spring.stiffness is infinite where its number is 0 or 1"),
        ([[0.5, 1.0]], "spring.stiffness is infinite where its number is 0 or 1"),
    ],
)
def test_samples_outside_0_to_1_are_refused(uniform, words):
    with pytest.raises(ks.ParameterError, match=words):
        ks.designs.sample(SPREADS, uniform)


def test_the_ends_of_a_uniform_spread_are_in_it():
    table = ks.designs.sample({"slider.mass": "500..700 kg"}, [[0.0], [1.0]])
    assert table["slider.mass [kg]"].tolist() == [500.0, 700.0]


def made_of(mass):
    return ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(mass)), 33.5)


DESIGNS = {"slider.mass": "500..700 kg:3"}
ASKED = {
    "variant, function": (lambda: (made_of, {"mass": "5..7 kg:3"}), {"variant": "x"}, "a function has none, got 'x'"),
    "variant, scene": (lambda: (made_of(600.0), DESIGNS), {"variant": "x"}, "a Scene has none, got 'x'"),
    "reference, function": (
        lambda: (made_of, {"mass": "5..7 kg:3"}),
        {"reference": "cam"},
        "reference must be a Scene, like the source, a function, got 'cam'",
    ),
    "reference, scene": (
        lambda: (made_of(600.0), DESIGNS),
        {"reference": "cam"},
        "like the source, a Scene, got 'cam'",
    ),
    "no folder": (
        lambda: (made_of(600.0), DESIGNS),
        {"folder": ""},
        "folder must name a place for the results, got ''",
    ),
    "number": (lambda: (made_of(600.0), DESIGNS), {"folder": 3}, "folder must be a path, got 3"),
}


@pytest.mark.slow_start
@pytest.mark.parametrize("name", ASKED)
def test_ignored_sweep_options_are_refused(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked, options, words = ASKED[name]
    source, spreads = asked()
    with pytest.raises(ks.ParameterError, match=words):
        ks.sweep(source, ks.designs.grid(spreads), ["largest O"], progress=False, **options)
    given = {key: text.removesuffix(":3") for key, text in spreads.items()}
    with pytest.raises(ks.ParameterError, match=words):
        ks.tolerances(source, ["largest O"], given, count=8, progress=False, **options)
    assert not list(tmp_path.iterdir())


# Angles of links that turn fully

DOUBLE_CRANK = ks.four_bar(0.5, 0.45, 0.4, rocker_pivot=(0.2, 0.0), coupler=ROD, rocker=BODY)
KITE = ks.four_bar(0.2, 0.5, 0.5, rocker_pivot=(0.2, 0.0), coupler=ROD, rocker=BODY, assembly="open")


@pytest.mark.parametrize(("mechanism", "turns"), [(DOUBLE_CRANK, 1), (KITE, 2)])
def test_angle_of_a_turning_rocker_is_continuous(mechanism, turns):
    s = ks.solve(mechanism, np.linspace(-7.0, 40.0, 4001), crank_speed=3.0)
    angle, rate = ks.linkage.rocker_angle(s), -s.rate("rocker") / 3.0
    assert np.max(np.abs(np.gradient(angle, s.crank_angle) - rate)[2:-2]) < 1e-3
    later = ks.linkage.rocker_angle(s.at(s.crank_angle + 2 * np.pi * turns))
    assert np.allclose(np.abs(later - angle), 2 * np.pi, rtol=0.0, atol=1e-9)
    assert ks.linkage.rocker_angle(s.at(8.0)) == pytest.approx(np.interp(8.0, s.crank_angle, angle), abs=1e-3)


@pytest.mark.parametrize(
    ("mechanism", "function", "growth"),
    [
        (DOUBLE_CRANK, ks.linkage.rocker_angle, "-6.28319 in each period of 6.28319 rad"),
        (KITE, ks.linkage.rocker_angle, "-6.28319 in each period of 12.5664 rad"),
        (MACHINE, lambda s: s.crank_angle, "6.28319 in each period of 6.28319 rad"),
    ],
)
def test_what_grows_each_turn_has_no_extremes(mechanism, function, growth):
    s = ks.solve(mechanism, 0.5, crank_speed=3.0)
    with pytest.raises(ks.ParameterError, match=f"grows by {growth}. It has no extremes, like the angle of a link"):
        ks.extremes(s, function)


def test_periodic_functions_have_extremes():
    s = ks.solve(MACHINE, 0.5, crank_speed=3.0)
    assert ks.extremes(s, lambda s: np.where(s.crank_angle < np.pi, 1.0, 2.0) * s.slider_velocity).range[1] > 0.0
    swings = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), 0.0, crank_speed=1.0)
    assert np.degrees(ks.extremes(swings, ks.linkage.rocker_angle).range) == pytest.approx([-10.957, 12.117], abs=1e-3)


# Functions of loads must be pure


class Counting:
    """A load of the user's own that is larger each time."""

    on = "slider"

    def __init__(self):
        self.count = itertools.count(1)

    def push(self, motion):
        """The count, N."""
        return next(self.count) + 0.0 * motion.slider_velocity

    __call__ = push


def counting():
    count = itertools.count(1)
    return lambda motion: next(count) + 0.0 * motion.crank_angle


GENERATOR = np.random.default_rng(0)
IMPURE = {
    "counter": (lambda: ks.ProcessForce(counting()), "ProcessForce on 'slider': its function gives 1 N and then 2 N"),
    "counter of a torque": (lambda: ks.Torque(counting(), on="crank"), "gives 1 N m and then 2 N m"),
    "counter at a point": (lambda: ks.Force(counting(), at="B"), "gives 1 N and then 2 N"),
    "counter of an object": (lambda: ks.ProcessForce(Counting()), "gives 1 N and then 2 N"),
    "load of one's own": (Counting, "Counting on 'slider': its function gives 1 N and then 2 N"),
    "random numbers": (
        lambda: ks.ProcessForce(lambda q: GENERATOR.normal(size=np.shape(q.crank_angle))),
        "use no counter, random number or clock in it",
    ),
    "clock": (
        lambda: ks.ProcessForce(lambda q: time.perf_counter()),
        "It must be pure, a function of the motion alone",
    ),
}
WAYS = {
    "solve": lambda load: ks.solve(MACHINE, DEGREES / 60, crank_speed=5.0, loads=load),
    "one angle": lambda load: ks.solve(MACHINE, 0.5, crank_speed=5.0, loads=load),
    "scene": lambda load: ks.Scene(MACHINE, 5.0, loads=load).solve(12),
    "speeds": lambda load: ks.solve(MACHINE, DEGREES / 60, crank_speed=DEGREES / 60 + 1.0, loads=load),
    "program": lambda load: ks.compile(ks.Scene(MACHINE, 5.0, loads=load), "O", engine="numpy"),
    "steady": lambda load: ks.drive.steady(ks.Scene(MACHINE, 5.0, loads=load), None, flywheel=50.0),
    "coast": lambda load: ks.drive.coast(ks.Scene(MACHINE, 5.0, loads=load), 9.0, from_speed=5.0, until=0.1),
}


@every("way", WAYS)
@every("name", IMPURE)
def test_impure_load_functions_are_refused(name, way):
    make, words = IMPURE[name]
    with pytest.raises(ks.ParameterError, match=words):
        WAYS[way](make())


@pytest.mark.slow
def test_torque_free_cam_leaves_out_friction():
    saw = ks.load_case("sawframe_2r63").variants["cam-cosine"].scene
    rough = ks.Scene(
        saw.mechanism,
        saw.crank_speed,
        5.0,
        loads=saw.loads,
        friction={"guide": ks.GuideFriction(0.1), "O": ks.PinFriction(0.01, 0.1)},
    )
    with pytest.warns(ks.HintWarning, match="leaves out friction at guide, O and the crank acceleration of"):
        found = ks.design.torque_free_cam(rough, cosine=2, gravity=False)
    smooth = ks.design.torque_free_cam(saw, cosine=2, gravity=False)
    assert found.values == pytest.approx(smooth.values, rel=1e-9)
