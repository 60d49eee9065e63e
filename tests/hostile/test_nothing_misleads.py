"""What looks right and is wrong is refused, warned of or mended: states of groups, hints, designs, sweeps, loads."""

import warnings
from dataclasses import fields

import numpy as np
import pytest

import kinetostatics as ks

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


@pytest.mark.parametrize(("kind", "table", "name", "state", "flipped"), WRONG)
def test_check_refuses_each_wrong_state_of_a_link_or_joint(kind, table, name, state, flipped):
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

    assert ks.check(group).ok
    report = ks.check(own(group, place=place))
    assert not report.ok
    assert any(name in problem for problem in report.problems)


@pytest.mark.parametrize("kind", ["slider", "lever", "cylinder", "yoke", "cam"])
def test_check_refuses_a_sliding_pair_whose_friction_would_drive_it(kind):
    group = GROUPS[kind]

    def sliding(self, name, placement):
        found = type(group).sliding(self, name, placement)
        return found._replace(rate=-found.rate)

    assert "rate of sliding" in ks.check(own(group, sliding=sliding)).problems[0]


def test_check_refuses_a_link_that_turns_consistently_but_not_with_its_bar():
    """Directions and rates of twice the angle agree with each other, but the bar's end is no place of such a link."""

    def place(self, placement):
        ks.RockerGroup.place(self, placement)
        motion = placement.links["coupler"]
        x, y = motion.direction
        twice = {"direction": (x * x - y * y, 2 * x * y), "ratio": 2 * motion.ratio}
        placement.links["coupler"] = motion._replace(**twice, ratio_slope=2 * motion.ratio_slope)

    report = ks.check(own(GROUPS["rocker"], place=place))
    assert any("place of B in the axes of coupler" in problem for problem in report.problems)


def test_check_refuses_a_group_that_places_its_links_elsewhere_when_asked_again():
    count = iter(range(1, 10**6))

    def place(self, placement):
        ks.SliderGroup.place(self, placement)
        joint = placement.joints["B"]
        x, y = joint.position
        placement.joints["B"] = joint._replace(position=(x + 1e-3 * next(count), y))

    assert any("place called twice" in problem for problem in ks.check(own(GROUPS["slider"], place=place)).problems)


# Hints: what looks like degrees, or like another unit

SCENE = ks.Scene(
    ks.crank_slider(0.1, 0.4, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0)), 5.0, 0.0, ks.Gravity()
)
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
    "solution at a count": (lambda: SCENE.solve(36).at(360), "360 is taken as one crank angle"),
    "running at degrees": (lambda: running().at(DEGREES), "from 0 to 350 by 10 look like degrees"),
    "running at a count": (lambda: running().at(360), "360 is taken as one crank angle"),
    "program at degrees": (lambda: program()(DEGREES), "from 0 to 350 by 10 look like degrees"),
    "program at 90.0": (lambda: program()(90.0), "the crank angle 90 looks like degrees"),
    "program at a count": (lambda: program()(360), "360 is taken as one crank angle"),
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


@pytest.mark.parametrize("name", HINTS)
def test_a_slip_is_hinted_at_once_where_the_user_made_it(name):
    ask, words = HINTS[name]
    with pytest.warns(ks.HintWarning, match=words) as caught:
        ask()
    assert [item.filename for item in caught if item.category is ks.HintWarning] == [__file__]


@pytest.mark.parametrize(("area", "hinted"), [(-78.5, True), (7850.0, True), (-78.5e-4, False), (0.785, False)])
def test_an_area_in_square_centimetres_is_hinted_at_whatever_its_sign(tmp_path, area, hinted):
    path = tmp_path / "pressure.csv"
    path.write_text("crank_angle [deg],pressure [bar]\n0,1\n90,5\n180,2\n270,1\n", encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ks.Table.from_csv(path, area=area)
    assert [str(item.message) for item in caught] == [f"table: area is {area:g} m2; is it in cm2, or in mm2?"] * hinted


def test_angles_of_several_turns_in_radians_are_not_hinted_at():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution, made = SCENE.solve(36), program()
        for angles in (40.5, 39.0, np.linspace(0.0, 40.0 * np.pi, 721), np.linspace(-30.0, 30.0, 11)):
            solution.at(angles)
            made(angles)
        solution.explain("O", 40.5)
        with_inertia(2.9)
