"""Scenes and methods for tests of studies."""

from functools import cache

import numpy as np

import kinetostatics as ks
from kinetostatics.mechanics.quantities import components
from kinetostatics.studies import precision
from kinetostatics.studies.precision import METHODS

FEW = [
    method
    for method in METHODS
    if method.name
    in (
        "ours, NumPy",
        "ours, torque by powers",
        "differences, 2nd order",
        "differences, 4th order",
        "spectral differentiation",
        "harmonic series",
        "two-mass coupler",
    )
]


@cache
def torque_study():
    """The study of one case, the plain sawframe."""
    return precision.study(ks.load_case("sawframe_2r63").solve("plain", 48), methods=FEW, repeats=1)


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


def error(solution, name, found):
    """Largest error of components of a quantity, relative to its largest value."""
    exact = components(solution, name)
    assert [np.shape(part) for part in found] == [np.shape(part) for part in exact]
    return float(np.max(np.abs(np.subtract(found, exact))) / (np.max(np.abs(exact)) or 1.0))


def alone(needs):
    return {made.name: made for made in needs.alone}
