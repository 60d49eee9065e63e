"""What looks right and is wrong is refused, warned of or mended: states of groups, hints, designs, sweeps, loads."""

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
