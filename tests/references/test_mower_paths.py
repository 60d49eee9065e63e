"""Paths of the common mass centre S of the mower: what the study says of an offset of 0, and of 20 mm."""

from functools import cache

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

LINKS = {"crank": ks.Link(1.0, 0.019), "coupler": ks.Link(2.0, 0.1), "slider": ks.Link(5.0)}
CASES = {1: ("across", -0.020), 2: ("along", -0.040), 3: ("overall", -0.035)}
"""Ratio and arm, m, of the crank with its counterweight by case of partial balancing (table 1)."""


@cache
def solution(offset, case=None):
    """Solution at 600 rpm; the guide runs `offset` below O, mm; without a case unbalanced."""
    mechanism = ks.crank_slider(0.038, 0.3, guide_offset=-offset / 1000, **LINKS)
    if case is not None:
        ratio, arm = CASES[case]
        mechanism = ks.balancing.partial(mechanism, ratio, crank=ks.Counterweight(arm=arm, whole_link=True)).mechanism
    return ks.Scene(mechanism, crank_speed=20 * np.pi).solve(360)


def ranges(offset, case):
    """Smallest and largest coordinate x, and y, of S, mm."""
    points = ks.principal_points(solution(offset, case).mechanism)

    def of(axis):
        return ks.extremes(solution(offset, case), lambda s: 1000 * points.mass_centre(s)[axis]).range

    return of(0), of(1)


@pytest.mark.slow
@every(
    ("offset", "case", "along", "across"),
    [
        (0, 1, "45.1748", "0.0000"),  # keeps S on the guide
        (0, 2, "1.0031", "31.5507"),  # height and chord of an arc about O
        (0, 3, "18.6860", "18.6860"),
        (20, 1, "45.2772", "0.0000"),
        (20, 2, "2.3497", "31.5507"),
        (20, 3, "18.8631", "18.6860"),
    ],
)
def test_extent_of_the_path_in_mm(offset, case, along, across):
    found = [f"{high - low:.4f}" for low, high in ranges(offset, case)]
    assert found == [along, across]


@pytest.mark.slow
def test_case_1_moves_along_a_line_parallel_to_the_guide():
    """By similar triangles S divides the way from O to B: its line is h1 / L_OA times as far below O as the guide."""
    for offset in (0, 20):
        _, (low, high) = ranges(offset, 1)
        share = ks.principal_points(solution(offset, 1).mechanism).moduli["crank"] / 0.038
        assert low == pytest.approx(-share * offset, abs=1e-12)
        assert high == pytest.approx(-share * offset, abs=1e-12)


def test_case_2_moves_on_an_arc_about_the_pivot():
    """Its radius is h2; with no offset its ends lie one above the other, at the same x."""
    s = solution(0, 2)
    points = ks.principal_points(s.mechanism)
    radius = np.hypot(*points.mass_centre(s))
    assert f"{1000 * points.moduli['coupler']:.2f}" == "124.54"
    np.testing.assert_allclose(radius, points.moduli["coupler"], rtol=1e-15)
    low, high = points.mass_centre(s.at(np.radians([90.0, 270.0]))).T
    assert low[0] == pytest.approx(high[0], abs=1e-16)
    assert f"{1000 * abs(high[1] - low[1]):.2f}" == "31.55"


def test_case_3_fills_a_square_of_twice_h1_without_offset_only():
    for offset, inside in ((0, True), (20, False)):
        side = 2000 * ks.principal_points(solution(offset, 3).mechanism).moduli["crank"]
        (left, right), (low, high) = ranges(offset, 3)
        assert high - low == pytest.approx(side, rel=1e-13)
        assert (right - left == pytest.approx(side, rel=1e-13)) == inside


def test_paths_without_offset_are_symmetric_about_the_guide():
    turn = np.radians(np.arange(0.0, 360.0, 5.0))
    for case in CASES:
        points = ks.principal_points(solution(0, case).mechanism)
        up, down = (points.mass_centre(solution(0, case).at(angle)) for angle in (turn, -turn))
        np.testing.assert_allclose(up, [down[0], -down[1]], rtol=0, atol=1e-16)
    points = ks.principal_points(solution(20, 3).mechanism)
    up, down = (points.mass_centre(solution(20, 3).at(angle)) for angle in (turn, -turn))
    assert np.abs(up[0] - down[0]).max() > 1e-3


def test_offset_gives_a_little_stroke_and_speed():
    strokes = {offset: np.ptp(ks.extremes(solution(offset), "slider_position").range) for offset in (0, 20)}
    speeds = {offset: abs(ks.extremes(solution(offset), "slider_velocity").largest) for offset in (0, 20)}
    assert [f"{1000 * stroke:.3f}" for stroke in strokes.values()] == ["76.000", "76.172"]
    assert [f"{speed:.3f}" for speed in speeds.values()] == ["2.407", "2.432"]
    assert f"{100 * (strokes[20] / strokes[0] - 1):.2f}" == "0.23"
    assert f"{100 * (speeds[20] / speeds[0] - 1):.1f}" == "1.1"
