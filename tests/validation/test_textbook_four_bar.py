"""A four-bar worked in a public reference set: rates and accelerations of coupler and rocker at two crank angles.

The teaching four-bar of a public package for planar mechanisms: crank A-B, coupler B-C, rocker D-C, with A = (0, 0),
B = (1.52, 0), C = (4.23, 3.029), D = (4.572, 0) as first drawn, the crank turning counter-clockwise at 10.31 rpm. Row
0 of its stored results is the drawn position, row 90 the crank a quarter turn on. In the library's names A is O, B is
A, C is B and D is O2.
"""

import numpy as np
import pytest

import kinetostatics as ks

B, C, D = 1.52 + 0.0j, 4.23 + 3.029j, 4.572 + 0.0j
EXACT = 1e-14
ROWS = {
    0: {
        "coupler": (-0.537707806825430, -0.0981933666211512),
        "rocker": (-0.537707806825430, 0.778081940185145),
    },
    90: {
        "coupler": (-0.102232102356830, 0.231680861727353),
        "rocker": (0.506736383917586, 0.192595295526762),
    },
}


def solution(degrees, assembly=1):
    mechanism = ks.four_bar(abs(B), abs(C - B), abs(C - D), rocker_pivot=(D.real, D.imag), assembly=assembly)
    return ks.solve(mechanism, np.radians(degrees), crank_speed=10.31 * 2 * np.pi / 60)


def test_drawn_position_has_the_pin_on_the_left():
    assert solution(0).position("B") == pytest.approx([C.real, C.imag], rel=EXACT)
    assert abs(complex(*solution(0, assembly=-1).position("B")) - C) > 1


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("link", ["coupler", "rocker"])
def test_rates_equal_the_reference_set(row, link):
    s = solution(row)
    found = float(s.rate(link)), float(s.angular_acceleration(link))
    assert found == pytest.approx(ROWS[row][link], rel=EXACT)
