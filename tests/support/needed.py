"""Scenes whose needs are looked for, and what a simplification changes in them."""

import numpy as np

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components

TURN = np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
SPEED = 30.0
COUPLER = ks.Link(4.0, (0.5, 0.06), 0.3)


def cranked(**options):
    links = {"crank": ks.Link(2.0, 0.1, 0.02), "coupler": COUPLER, "slider": ks.Link(5.0, (0.02, 0.01), 0.1)}
    return ks.crank_slider(0.2, 1.3, **links | options)


MECHANISMS = {
    "crank-slider": cranked(guide_angle=0.3, guide_offset=0.05),
    "cam": ks.cam_crank_slider(
        ks.cams.Circle(0.2, (-0.02, 0.01)), 1.3, block=ks.Link(1.0), coupler=COUPLER, slider=ks.Link(5.0)
    ),
    "four-bar": ks.four_bar(
        0.2, 1.3, 0.7, rocker_pivot=(1.2, 0.2), coupler=COUPLER, rocker=ks.Link(3.0, (0.3, 0.02), 0.2)
    ),
}


def solved(mechanism, loads=(ks.Gravity(),), angle=TURN, **options):
    return ks.solve(mechanism, angle, crank_speed=SPEED, loads=loads, **options)


def change(solution, full, quantity):
    """Largest difference of a quantity, relative to its largest value in the full scene."""
    found, exact = (np.array(components(s, quantity)) for s in (solution, full))
    return np.max(np.linalg.norm(found - exact, axis=0)) / np.max(np.linalg.norm(exact, axis=0))


def alone(needs):
    return {made.name: made for made in needs.alone}
