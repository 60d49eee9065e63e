"""Mechanisms to be balanced: mowers, skew and inclined crank-sliders, a four-bar, a cam."""

import functools

import numpy as np

import kinetostatics as ks
from kinetostatics.design.balancing import Counterweight

TURN = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
ROUNDING = 1e-13
CRANK, COUPLER = ks.Link(3.0, (0.1, 0.04), 0.2), ks.Link(7.0, (0.4, -0.06), 0.9)
SKEW_LINKS = {"crank": CRANK, "coupler": COUPLER, "slider": ks.Link(11.0, (-0.05, 0.08), 0.3)}
LINKS = SKEW_LINKS | {"coupler": ks.Link(7.0, 0.4, 0.9)}
GUIDE = {"guide_angle": 0.4, "guide_offset": 0.07}
SKEW = ks.crank_slider(0.3, 0.8, **GUIDE, **SKEW_LINKS)
INCLINED, BEHIND = (ks.crank_slider(0.3, 0.8, assembly=sign, **GUIDE, **LINKS) for sign in (1, -1))
ROCKER = ks.Link(5.0, (0.2, 0.1), 0.4)
FOUR_BAR = ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.1), crank=CRANK, coupler=COUPLER, rocker=ROCKER)
CAM = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.05, 0.03)), 0.8, **SKEW_LINKS)
HEAVY = Counterweight(mass=5.0)


@functools.cache
def mower(offset=-0.02):
    links = {"crank": ks.Link(1.0, 0.019), "coupler": ks.Link(2.0, 0.1), "slider": ks.Link(5.0)}
    return ks.crank_slider(0.038, 0.3, guide_offset=offset, **links)


def solved(mechanism, speed=10.0, acceleration=0.0):
    return ks.solve(mechanism, TURN, crank_speed=speed, crank_acceleration=acceleration)


def along_and_across(s):
    """Parts of the shaking force along the guide and to its left."""
    x, y = next((g.guide.direction for g in s.mechanism.groups if isinstance(g, ks.SliderGroup)), (1.0, 0.0))
    force = s.shaking_force
    return x * force[0] + y * force[1], x * force[1] - y * force[0]


def unbalance(balanced, link="crank"):
    mass, place = balanced.counterweights[link]
    return mass * np.array(place)
