"""Inclined twins of the places of the stability study: guides, pivots and pins of the crank that lie on no axis.

Of a triangle with sides 3, 4 and 5 each length is exact, so that linkages whose links are to fall in one line do.
Elsewhere a length is rounded toward the side on which the linkage closes, from one found with 50 digits.
"""

import math
from functools import partial

import mpmath as mp
import numpy as np

import kinetostatics as ks
from kinetostatics.machine.builders import cam_crank_slider, slotted_lever
from kinetostatics.studies import stability
from kinetostatics.studies.stability import DISTANCES, Place

AHEAD = math.atan2(4.0, 3.0)
"""Direction of the long pivots, rad."""
SIDE = 1.0
"""Direction of the guides, rad."""
PIVOT = 0.5, 0.49
BODY = ks.Link(3.0, 0.2, 5e-2)


def _around(angles, distance):
    steps = distance * np.linspace(0.5, 1.0, 10)
    return np.concatenate([angle + sign * steps for angle in angles for sign in (-1.0, 1.0)])


def _exact(crank, coupler, rocker, ground):
    """Four-bar of lengths in 5/64 m, its ground inclined."""
    lengths = (5.0 * length / 64.0 for length in (crank, coupler, rocker))
    return stability._chain_unit(*lengths, (3.0 * ground / 64.0, 4.0 * ground / 64.0))


def _folding(lengths, angles, distance):
    return stability._solution(_exact(*lengths), AHEAD + _around(angles, distance))


def _ground(x, y):
    return mp.sqrt(mp.mpf(x) ** 2 + mp.mpf(y) ** 2)


def _rounded(exact, way):
    """The nearest double beyond a number of more digits, upward (1) or downward (-1)."""
    found = float(exact)
    while way * (mp.mpf(found) - exact) <= 0:
        found = math.nextafter(found, way * math.inf)
    return found


def _toggle(distance):
    crank, coupler, rocker = 0.3, 0.4, 0.2
    with mp.workdps(50):
        ground, reach = _ground(*PIVOT), mp.mpf(coupler) + mp.mpf(rocker)
        angle = mp.atan2(PIVOT[1], PIVOT[0]) + mp.acos(
            (mp.mpf(crank) ** 2 + ground**2 - reach**2) / (2 * crank * ground)
        )
    angles = float(angle) - distance * np.linspace(0.5, 1.0, 20)
    return stability._solution(stability._chain_unit(crank, coupler, rocker * (1.0 + 2.0**-50), PIVOT), angles)


def _just_turning(distance, aside=0.0):
    """Crank and ground in one line are a little shorter than coupler and rocker; with the pin beside the crank ray."""
    crank, coupler = 0.3, 0.45
    with mp.workdps(50):
        least = _ground(crank, aside) + _ground(*PIVOT) - mp.mpf(coupler)
        rocker = _rounded(least * (1 + mp.mpf(distance)), 1)
    four_bar = stability._chain_unit(crank, coupler, rocker, PIVOT)
    opposite = math.atan2(PIVOT[1], PIVOT[0]) + math.pi
    if aside:
        group = ks.RockerGroup(coupler, rocker, PIVOT, coupler=BODY, rocker=BODY, on="C")
        pin = ks.Pin(on="crank", at=(crank, aside), name="C")
        four_bar = ks.Mechanism("on a pin beside the ray", ks.Crank(0.1), (pin, group))
        opposite -= math.atan2(aside, crank)
    return stability._solution(four_bar, opposite + math.sqrt(distance) * np.linspace(-2.0, 2.0, 21))


def _just_sliding(distance):
    pivot, crank = (0.15, 0.13), 0.1
    with mp.workdps(50):
        offset = _rounded((_ground(*pivot) - mp.mpf(crank)) * (1 - mp.mpf(distance)), -1)
    lever = slotted_lever(crank, pivot=pivot, offset=offset, lever=BODY, block=ks.Link(1.0))
    return stability._solution(lever, math.atan2(*pivot[::-1]) + math.sqrt(distance) * np.linspace(-2.0, 2.0, 22))


def _meeting(distance):
    """The block of a slotted lever passes by its pivot."""
    lever = slotted_lever(5.0 / 16.0, pivot=(3.0 / 16.0, 4.0 / 16.0), lever=BODY, block=ks.Link(1.0))
    return stability._solution(lever, AHEAD + _around([0.0], distance))


def _limit_position(distance):
    angle = math.radians(40.0)
    saw = stability._saw(crank_length=2.0, coupler_length=math.nextafter(2.0 * math.sin(angle), 3.0), guide_angle=SIDE)
    return stability._solution(saw, SIDE + angle - 2.0**-51 - distance * np.linspace(0.5, 1.0, 20))


def _barely_long_enough(distance):
    saw = stability._saw(coupler_length=0.5 * (1.0 + distance), guide_offset=0.2, guide_angle=SIDE)
    return stability._solution(saw, SIDE + 1.5 * math.pi + np.linspace(-0.5, 0.5, 21))


def _equal_links(distance):
    saw = stability._saw(coupler_length=0.3, guide_angle=SIDE)
    return stability._solution(saw, SIDE + _around([0.5 * math.pi], distance))


def _cam(cam, length, **options):
    return cam_crank_slider(cam, length, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0), **options)


def _pressure_angle(distance):
    cam = ks.cams.Circle(0.5, (-0.3 * (1.0 - distance), -0.4 * (1.0 - distance)))
    return stability._solution(_cam(cam, 2.0), AHEAD + 0.5 * math.pi + np.linspace(-0.01, 0.01, 21))


def _singular_angle(distance):
    cam = ks.cams.CosineLaw(0.3, 2.0, SIDE)
    angles = SIDE + float(cam.singular_angle) + distance * np.linspace(-1.0, 1.0, 21)
    spring = ks.Spring.balancing(600.0, stability.CRANK_SPEED, 2.0)
    mechanism = _cam(cam, cam.coupler_length, guide_angle=SIDE)
    return stability._solution(mechanism, angles, [ks.Gravity(), spring])


def _size(size):
    lengths = (size * length for length in (0.1, 0.4, 0.3))
    return stability._solution(
        stability._chain_unit(*lengths, (0.35 * size, 0.1 * size)), np.linspace(0.0, 6.2, 40), ()
    )


OPEN, OPPOSITE = 0.0, math.pi
TWINS = {
    "limit position": (_limit_position, "O"),
    "coupler barely long enough": (_barely_long_enough, "O"),
    "singular angle of the cosine cam": (_singular_angle, "cam_force"),
    "pressure angle toward 90 deg": (_pressure_angle, "cam_force"),
    "four-bar toggle": (_toggle, "O"),
    "four-bar change point": (partial(_folding, (13, 32, 13, 32), [OPEN]), "O"),
    "four-bar that only just turns": (_just_turning, "O"),
    "four-bar that only just turns, on a pin beside the crank ray": (partial(_just_turning, aside=0.1), "O"),
    "slotted lever that only just turns": (_just_sliding, "O"),
    "slotted lever, A passing O2": (_meeting, "O"),
    "rhombus": (partial(_folding, (19, 19, 19, 19), [OPEN, OPPOSITE]), "O"),
    "kite": (partial(_folding, (13, 13, 32, 32), [OPPOSITE]), "O"),
    "kite, A passing O2": (partial(_folding, (13, 32, 32, 13), [OPEN]), "O"),
    "parallelogram, folded": (partial(_folding, (13, 32, 13, 32), [OPPOSITE]), "O"),
    "coupler as long as the crank": (_equal_links, "O"),
    "size": (_size, "O"),
}
"""Scene by number and quantity of each twin."""
INCLINED = tuple(
    Place(f"{name}, inclined", "as of its twin [1]", DISTANCES[2:], scene, quantity)
    for name, (scene, quantity) in TWINS.items()
)
