"""Mechanisms at and beside every place where digits vanish: a warning each, naming how many are left."""

import re
import warnings

import numpy as np

import kinetostatics as ks
from support.every import every

BODY = ks.Link(3.0, 0.5, 2.0)
ROD = ks.Link(2.0, 0.5, 1.0)
FOLDING = {
    "rhombus": ((1, 1, 1, 1), (0.0, np.pi)),
    "kite, frame as crank": ((1, 2, 2, 1), (0.0,)),
    "kite, coupler as crank": ((1, 1, 2, 2), (np.pi,)),
    "kite, rocker as crank": ((2, 1, 2, 1), (0.0, np.pi)),
    "parallelogram": ((1, 2, 1, 2), (0.0, np.pi)),
    "crank and frame the extremes": ((1, 3, 2, 4), (np.pi,)),
    "frame shortest": ((3, 4, 2, 1), (0.0,)),
    "rocker shortest": ((2, 4, 1, 3), (np.pi,)),
    "coupler shortest": ((3, 1, 2, 4), (0.0,)),
}
DISTANCES = (0.0, 1e-12, 1e-8, 1e-6, 1e-5)


def cases():
    """A mechanism, and a crank angle at which less than four digits are left."""
    for name, ((crank, coupler, rocker, frame), angles) in FOLDING.items():
        for assembly in (1, -1):
            pivot = {"rocker_pivot": (float(frame), 0.0), "assembly": assembly}
            mechanism = ks.four_bar(float(crank), coupler, rocker, **pivot, coupler=BODY, rocker=ROD)
            for angle in angles:
                yield from ((f"{name} {assembly} {angle:.2g}", mechanism, angle, distance) for distance in DISTANCES)
    for tilt in (0.0, 0.7, -2.1):
        for assembly in (1, -1):
            guide = {"guide_angle": tilt, "assembly": assembly, "slider": ROD}
            mechanism = ks.crank_slider(0.3, 0.3, coupler=BODY, **guide)
            name = f"coupler as crank, tilt {tilt} {assembly}"
            yield from ((name, mechanism, np.pi / 2 + tilt, distance) for distance in DISTANCES)


CASES = list(cases())


@every(
    ("mechanism", "angle", "distance"), [case[1:] for case in CASES], ids=[f"{case[0]} {case[3]:g}" for case in CASES]
)
def test_lost_digits_are_warned_of_with_their_number(mechanism, angle, distance):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ks.solve(mechanism, [angle + distance], crank_speed=5.0, loads=ks.Gravity())
    (text,) = (str(item.message) for item in caught if item.category is ks.ConditionWarning)
    assert int(re.search(r"about (\d+) correct digits", text)[1]) < 4
    assert "at crank angle" in text
