"""Chains of groups that a user builds, as a six-bar: loads on its parts, and what is said of parts that do not fit."""

import numpy as np
import pytest

import kinetostatics as ks
from support.machines import ANGLES, assert_close, largest
from support.scenes import six_bar

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""


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
        ({"on": "Q", "pin": "C", "label": "2"}, "is attached to joint 'Q'"),
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
