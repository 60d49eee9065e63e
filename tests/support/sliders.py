"""A crank-slider, and its solution, with a few values changed."""

import numpy as np

import kinetostatics as ks

TURN = 2 * np.pi * np.arange(72) / 72
LINK = ks.Link(2.0, (0.1, 0.02), 0.05)


def crank_slider(**changes):
    return ks.crank_slider(**{"crank_length": 0.3, "coupler_length": 1.1, "coupler": LINK} | changes)


def solve(mechanism=None, crank_angle=TURN, **changes):
    return ks.solve(mechanism or crank_slider(), crank_angle, **{"crank_speed": 2.0} | changes)
