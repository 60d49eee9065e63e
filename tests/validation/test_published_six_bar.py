"""A Stephenson III six-bar of a public reference set: masses, gravity and a force on a link, two of its stored rows.

The teaching six-bar of a public package for planar mechanisms. Joints as first drawn, m: A (7, 4), B (5, 16),
C (25, 25), D (23, 10), E (18, 35), F (43, 32), G (45, 17); links AB, BCE (ternary), CD, EF, FG; A, D and G on the
ground. Mass centres lie at the mean of each link's joints; (50, 0) N acts on FG in the middle. AB is the crank here and
A its pivot O, BCE the coupler, CD the rocker, E a pin on the coupler, EF and FG the second coupler and rocker.
"""

import numpy as np
import pytest

import kinetostatics as ks

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""The set's inertias are those of much shorter links, as the library rightly hints."""

A, B, C, D, E, F, G = (complex(*at) for at in [(7, 4), (5, 16), (25, 25), (23, 10), (18, 35), (43, 32), (45, 17)])
MASS = {"crank": 5.0, "coupler": 10.0, "rocker": 5.0, "coupler2": 10.0, "rocker2": 5.0}
INERTIA = {"crank": 0.1, "coupler": 0.2, "rocker": 0.1, "coupler2": 0.2, "rocker2": 0.1}
SPEED = 10 * 2 * np.pi / 60
FIRST, SECOND = 1.7359450042095235, 1.6137719565699202
"""Angles of AB, rad: as drawn, turning counter-clockwise, and a little on, clockwise."""
TORQUE = {
    (FIRST, SPEED, 0.0): -117.62764152614557,
    (FIRST, SPEED, 9.81): -243.85439295323431,
    (SECOND, -SPEED, 0.0): -418.60474810230016,
    (SECOND, -SPEED, 9.81): -78.18458165328309,
}
GROUND = {
    (FIRST, SPEED): {
        "O2": (-3.4333084385343184, -35.076623528920507),
        "O22": (-18.446342964345817, -33.697807972189956),
    },
    (SECOND, -SPEED): {
        "O2": (-9.7958987538778697, -35.553696791487383),
        "O22": (-23.776437795346268, -35.626214695962823),
    },
}
"""Forces at D and G with gravity, N."""


def place(joint, start, end):
    """A point of a link from start to end, along it and across."""
    found = (joint - start) * abs(end - start) / (end - start)
    return found.real, found.imag


def six_bar():
    def link(name, *joints):
        return ks.Link(MASS[name], place(sum(joints) / len(joints), *joints[:2]), INERTIA[name])

    def pivot(joint):
        return (joint - A).real, (joint - A).imag

    first = ks.RockerGroup(
        abs(C - B), abs(C - D), pivot(D), side(B, C, D), link("coupler", B, C, E), link("rocker", D, C), pin="C"
    )
    second = ks.RockerGroup(
        abs(F - E),
        abs(F - G),
        pivot(G),
        side(E, F, G),
        link("coupler2", E, F),
        link("rocker2", G, F),
        on="E",
        pin="F",
        pivot_name="O22",
        label="2",
    )
    ternary = ks.Pin(on="coupler", at=place(E, B, C), name="E")
    return ks.Mechanism("Stephenson III", ks.Crank(abs(B - A), link("crank", A, B)), (first, ternary, second))


def side(inner, pin, pivot):
    """Assembly as drawn: whether the pin is to the left of the way from the inner joint to the pivot."""
    return 1 if ((pin - inner) * (pivot - inner).conjugate()).imag > 0 else -1


def solution(angle, speed, gravity):
    loads = [ks.Force(50.0, at=("rocker2", abs(F - G) / 2, 0.0))] + [ks.Gravity(gravity)] * (gravity > 0)
    return ks.solve(six_bar(), angle, crank_speed=speed, loads=loads)


def test_the_drawn_position_is_that_of_the_mechanism():
    s = solution(FIRST, SPEED, 0.0)
    for name, joint in {"A": B, "C": C, "E": E, "F": F}.items():
        assert complex(*s.position(name)) == pytest.approx(joint - A, rel=1e-14)


@pytest.mark.parametrize(("angle", "speed", "gravity"), TORQUE)
def test_the_input_torque_is_the_published_one(angle, speed, gravity):
    s = solution(angle, speed, gravity)
    assert float(s.balancing_torque) == pytest.approx(TORQUE[angle, speed, gravity], rel=1e-9)
    assert s.power_residual < 1e-13


@pytest.mark.parametrize(("angle", "speed"), GROUND)
@pytest.mark.parametrize("joint", ["O2", "O22"])
def test_ground_reactions_are_the_published_ones(angle, speed, joint):
    s = solution(angle, speed, 9.81)
    assert s.reaction(joint) == pytest.approx(GROUND[angle, speed][joint], rel=1e-9)
