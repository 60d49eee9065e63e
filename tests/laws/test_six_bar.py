"""Chains of groups that a user builds: a six-bar, a V engine, and more, all forces re-summed body by body."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kinetostatics as ks
from support.machines import ANGLES, assert_close, largest, planar, turning
from support.scenes import six_bar
from support.strategies import body, either_sign, number, reproducible

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""

CLOSE = 1e-13
"""Error allowed relative to the largest force; chains of three dyads leave some digits at either end of a stroke."""


# Random chains


def rocker_group(draw, reach, size, **names):
    """A rocker group that closes wherever in a circle of radius `reach` about O it hangs, and how far its pin gets."""
    away = reach * draw(number(1.5, 3.0))
    pivot = away * np.exp(1j * draw(number(-3.1, 3.1)))
    coupler_length = (away + reach) * draw(number(1.0, 1.5))
    rocker_length = coupler_length + (away - reach) * draw(number(-0.8, 0.8))
    group = ks.RockerGroup(
        coupler_length,
        rocker_length,
        (pivot.real, pivot.imag),
        draw(st.sampled_from((-1, 1))),
        coupler=link(draw(body(size))),
        rocker=link(draw(body(size))),
        **names,
    )
    return group, away + rocker_length


def slider_group(draw, reach, size, **names):
    """The same of a slider group."""
    offset = reach * draw(either_sign(0.01, 0.5))
    coupler_length = (reach + abs(offset)) * draw(number(1.15, 3.0))
    group = ks.SliderGroup(
        coupler_length,
        ks.Guide.at(draw(number(-3.1, 3.1)), offset),
        draw(st.sampled_from((-1, 1))),
        coupler=link(draw(body(size))),
        slider=link(draw(body(size))),
        **names,
    )
    return group, reach + coupler_length


def link(plain):
    return ks.Link(plain.mass, plain.centre, plain.inertia)


SCHEMES = {
    "four-bar driving a slider": ((rocker_group, {}), (slider_group, {"on": "B", "pin": "C", "label": "2"})),
    "four-bar driving a second rocker": (
        (rocker_group, {}),
        (rocker_group, {"on": "B", "pin": "C", "label": "2", "pivot_name": "O3"}),
    ),
    "V engine": ((slider_group, {}), (slider_group, {"pin": "C", "label": "2"})),
    "slider and rocker on one pin": ((slider_group, {}), (rocker_group, {"pin": "C", "label": "2"})),
    "slider driving a slider": ((slider_group, {}), (slider_group, {"on": "B", "pin": "C", "label": "2"})),
    "slider driving a rocker": ((slider_group, {}), (rocker_group, {"on": "B", "pin": "C", "label": "2"})),
    "three groups in a row": (
        (rocker_group, {}),
        (slider_group, {"on": "B", "pin": "C", "label": "2"}),
        (rocker_group, {"on": "C", "pin": "D", "label": "3", "pivot_name": "O3"}),
    ),
}
every_scheme = pytest.mark.parametrize("scheme", SCHEMES)


@st.composite
def chains(draw, scheme):
    """Solution of a random chain with mass everywhere, under gravity and a spring and a force on every slider."""
    size = draw(number(0.1, 1.0))
    reach, groups, loads = {"A": size}, [], [ks.Gravity(draw(number(1.0, 20.0)), draw(number(-3.1, 3.1)))]
    for make, names in SCHEMES[scheme]:
        group, reach[names.get("pin", "B")] = make(draw, reach[names.get("on", "A")], size, **names)
        groups.append(group)
        for name in group.links:
            if name.startswith("slider"):
                loads.append(ks.Spring(draw(number(1.0, 1e3)), draw(number(-2.0, 2.0)), on=name))
                loads.append(ks.ProcessForce(draw(either_sign(1.0, 1e3)), on=name))
    return ks.solve(
        ks.Mechanism(scheme, ks.Crank(size, link(draw(body(size)))), tuple(groups)),
        ANGLES,
        crank_speed=draw(either_sign(0.1, 50.0)),
        crank_acceleration=draw(either_sign(0.1, 500.0)),
        loads=loads,
    )


# Newton's laws, body by body


def joints(groups):
    """By reaction: the link it acts on, the link it comes from (None: ground), and the joint it acts at."""
    table, carrier = {"O": ("crank", None, "O")}, {"A": "crank"}
    for group in groups:
        coupler, end = group.links
        table[group.on + group.label] = (coupler, carrier[group.on], group.on)
        table[group.pin] = (end, coupler, group.pin)
        ground, at = ("guide" + group.label, group.pin) if end.startswith("slider") else 2 * (group.pivot_name,)
        table[ground] = (end, None, at)
        carrier[group.pin] = end
    return table


def unbalanced(s):
    """What is missing in Newton's laws for each link, relative to the largest force, and moment, on any of them."""
    wrenches = {name: [] for name in s.mechanism.links}
    couples = {"crank": s.balancing_torque}
    for name, (on, by, joint) in joints(s.mechanism.groups).items():
        force, at = planar(s.reaction(name)), planar(s.position(joint))
        wrenches[on].append((force, at))
        if by:
            wrenches[by].append((-force, at))
    for group in s.mechanism.groups:
        _, end = group.links
        if end.startswith("slider"):
            pushes = sum(load.push(s) for load in s.loads if getattr(load, "on", "") == end)
            wrenches[end].append((pushes * complex(*group.guide.direction), planar(s.position(group.pin))))
            couples[end] = s.scalar("guide_moment" + group.label)
    gravity = s.loads[0].acceleration * np.exp(1j * s.loads[0].direction)
    forces, moments, lack = [], [], {}
    for name, own in s.mechanism.links.items():
        centre = planar(s.position(name))
        inertia = own.mass * (planar(s.acceleration(name)) - gravity)
        turned = [turning(at - centre, force) for force, at in wrenches[name]] + [couples.get(name, 0.0)]
        forces += [largest(force) for force, _ in wrenches[name]]
        moments += [largest(moment) for moment in turned]
        lack[name, "force"] = largest(sum(force for force, _ in wrenches[name]) - inertia)
        lack[name, "moment"] = largest(sum(turned) - own.inertia * s.angular_acceleration(name))
    scale = {"force": max(forces), "moment": max(moments)}
    return {key: float(value / scale[key[1]]) for key, value in lack.items()}


@pytest.mark.slow
@every_scheme
@settings(reproducible, max_examples=10)
@given(data=st.data())
def test_bodies_obey_newton_and_powers_balance(scheme, data):
    """Joint forces, weight, loads and couples make mass times acceleration and inertia times angular acceleration."""
    s = data.draw(chains(scheme))
    assert s.power_residual < 1e-14
    assert set(joints(s.mechanism.groups)) == set(s.reactions)
    assert {key: error for key, error in unbalanced(s).items() if not error < CLOSE} == {}


def whole(parts):
    """Components as one array, though one may be a plain number."""
    return np.array(np.broadcast_arrays(*parts))


@pytest.mark.slow
@every_scheme
@settings(reproducible, max_examples=5)
@given(data=st.data())
def test_motion_is_the_slope_of_positions(scheme, data):
    """By complex steps, exact to rounding; so accelerations in Newton's laws are those of the positions."""
    s = data.draw(chains(scheme))
    placement, beside = s.placement, s.mechanism.place(ANGLES + 1e-30j)
    for group in s.mechanism.groups:
        joint, moved = placement.joints[group.pin], beside.joints[group.pin]
        assert_close(whole(joint.first), np.imag(whole(moved.position)) / 1e-30, CLOSE)
        assert_close(whole(joint.second), np.imag(whole(moved.first)) / 1e-30, CLOSE)
    for name, found in placement.links.items():
        if found.ratio_slope is not None:
            error = found.ratio_slope - np.imag(beside.links[name].ratio) / 1e-30
            assert largest(error) < CLOSE * max(1.0, largest(found.ratio_slope)), name
    parts = [link.mass * planar(s.acceleration(name)) for name, link in s.mechanism.links.items()]
    assert largest(planar(s.shaking_force) + sum(parts)) < 1e-13 * max(map(largest, parts))


# What a user sees


def test_short_six_bar_balances_its_powers():
    loads = [ks.Gravity(), ks.Spring(100.0, 0.5, on="slider2"), ks.ProcessForce(30.0, on="slider2")]
    s = ks.solve(six_bar(), ANGLES, crank_speed=20.0, crank_acceleration=5.0, loads=loads)
    assert s.power_residual < 1e-14
    assert set(s.reactions) == {"O", "A", "B", "O2", "B2", "C", "guide2"}
    assert list(s.mechanism.links) == ["crank", "coupler", "rocker", "coupler2", "slider2"]
    assert_close(s.travel("slider2"), s.position("C")[0])
    assert {"C_x [m]", "reaction_B2_y [N]", "coupler2_rate [rad/s]"} <= set(s.frame().columns)
    assert ks.extremes(s, "C").range[1] >= largest(np.hypot(*s.reaction("C")))


def test_massless_chain_leaves_the_four_bar():
    chain = six_bar()
    for name in ("coupler2", "slider2"):
        chain = chain.with_link(name, ks.Link())
    alone = ks.Mechanism("four-bar", chain.crank, chain.groups[:1])
    with_chain, without = (ks.solve(m, ANGLES, crank_speed=20.0, loads=ks.Gravity()) for m in (chain, alone))
    for name in without.reactions:
        assert_close(with_chain.reaction(name), without.reaction(name))
    assert largest(with_chain.reaction("C")) == 0


def test_load_on_an_absent_slider_names_the_present():
    with pytest.raises(ks.ParameterError, match=r"'slider', allowed: 'slider2'"):
        ks.solve(six_bar(), ANGLES, crank_speed=1.0, loads=ks.ProcessForce(30.0))


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ({"on": "Q", "pin": "C", "label": "2"}, "hangs on joint 'Q'"),
        ({"on": "B", "pin": "C"}, "'coupler' a second time"),
    ],
)
def test_group_on_an_absent_joint_is_refused(names, words):
    chain = six_bar()
    with pytest.raises(ks.ParameterError, match=words):
        ks.Mechanism("six-bar", chain.crank, (chain.groups[0], ks.SliderGroup(0.5, **names)))


def test_open_second_group_names_its_own_lengths():
    chain = six_bar()
    short = ks.SliderGroup(0.3, on="B", pin="C", label="2")
    with pytest.raises(ks.AssemblyError, match=r"six-bar .*distance from B to the guide.*coupler2 length, 0\.3 m"):
        ks.solve(ks.Mechanism("six-bar", chain.crank, (chain.groups[0], short)), ANGLES, crank_speed=1.0)


def test_cam_driven_four_bar_balances_its_powers():
    """The block that a cam guides drives a coupler and rocker as well as a slider."""
    link = ks.Link(2.0, (0.1, 0.03), 0.1)
    mechanism = ks.Mechanism(
        "cam-driven four-bar",
        ks.Crank(None, link),
        (ks.CamRoller(ks.cams.Circle(0.3, (-0.05, 0.03)), link), ks.RockerGroup(0.8, 0.6, (0.7, 0.4), 1, link, link)),
    )
    s = ks.solve(mechanism, ANGLES, crank_speed=12.0, crank_acceleration=-30.0, loads=ks.Gravity())
    assert s.power_residual < 1e-14
    assert largest(s.cam_force) > 0
