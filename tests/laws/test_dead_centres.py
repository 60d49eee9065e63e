"""Slider position at and around dead centres, against the exact geometry of the same floats with 50 digits.

Guides of any inclination, origin and offset, in both assemblies; and the function of the mower study (A. V. Kotov,
Tractors and Agricultural Machinery 2024, 91(2), 167-180, figure 3), which lands on the wrong side there.
"""

import math
from typing import NamedTuple

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.studies.methods.papers import slider_by_double_cross

DIGITS = 50
ULPS = 4
"""Largest error of the slider position, in units in the last place of the coupler length."""
GUIDES = ("through O", "nearly through O", "offset", "level", "by angle")
COUNT = 4
"""Mechanisms for each kind of guide; each with two assemblies, two dead centres and 39 crank angles."""
each_assembly = pytest.mark.parametrize("assembly", [1, -1])


class Drive(NamedTuple):
    """A crank-slider in floats; its guide also by two points (if so given) and by exact direction and offset."""

    crank_length: float
    coupler_length: float
    guide: ks.Guide
    points: tuple
    direction: tuple
    offset: mp.mpf

    def solve(self, angle, assembly):
        """By the library."""
        mechanism = ks.crank_slider(self.crank_length, self.coupler_length, guide=self.guide, assembly=assembly)
        return ks.solve(mechanism, angle, crank_speed=1.0)

    def by_double_cross(self, pin, assembly):
        """By the function of the study, which takes the end of the guide that the slider lies toward."""
        W1, W2 = self.points
        return slider_by_double_cross(pin, self.coupler_length, W1, W2, W2 if assembly > 0 else W1)

    def exact(self, angle, assembly):
        """Travel along the guide and position of B, from the float inputs."""
        (x, y), r, length = self.direction, self.crank_length, mp.mpf(self.coupler_length)
        pin = (r * mp.cos(angle), r * mp.sin(angle))
        across = self.offset - (x * pin[1] - y * pin[0])
        travel = x * pin[0] + y * pin[1] + assembly * mp.sqrt(length**2 - across**2)
        return travel, travel * x - self.offset * y, travel * y + self.offset * x

    def dead_centres(self, assembly):
        """Crank angles where crank and coupler are in line, stretched and folded, as floats."""
        r, length, offset = self.crank_length, self.coupler_length, float(self.offset)
        stretched, folded = math.asin(offset / (length + r)), math.pi + math.asin(offset / (length - r))
        places = (stretched, folded) if assembly > 0 else (math.pi - stretched, math.pi - folded)
        return [math.atan2(float(self.direction[1]), float(self.direction[0])) + place for place in places]


def drives(kind, count=COUNT):
    """Random mechanisms whose crank turns round; points of the guide up to ten coupler lengths away from O.

    Kind "mower" has the lengths of the study, its guide runs through O at the middle between W1 and W2.
    """
    random = np.random.default_rng(40)
    for _ in range(count):
        length = 0.3 if kind == "mower" else random.uniform(0.1, 10.0)
        crank = 0.038 if kind == "mower" else length * random.uniform(0.02, 0.8)
        offset = random.uniform(-0.8, 0.8) * (length - crank)
        inclination = 0.0 if kind == "level" else random.uniform(-np.pi, np.pi)
        first, last = length * random.uniform(-1, 1, 2) * 10.0 ** random.uniform(-1, 1)
        if kind == "by angle":
            yield Drive(crank, length, ks.Guide.at(inclination, offset), (), *at(inclination, offset))
            continue
        across = 1j * offset if kind in ("offset", "level") else 0.0
        W1, W2 = (np.exp(1j * inclination) * (place + across) for place in (first, last))
        if kind in ("through O", "mower"):
            W1 = (-1.0 if kind == "mower" else random.choice([0.0, -1.0, 0.5, -2.0])) * W2
        points = (float(W1.real), float(W1.imag)), (float(W2.real), float(W2.imag))
        yield Drive(crank, length, ks.Guide.through(*points), points, *line(*points))


@mp.workdps(DIGITS)
def at(angle, offset):
    """Exact direction and offset of the line at an angle."""
    return (mp.cos(angle), mp.sin(angle)), mp.mpf(offset)


@mp.workdps(DIGITS)
def line(W1, W2):
    """Exact direction and offset of the line through two points."""
    x, y = (mp.mpf(end) - mp.mpf(start) for start, end in zip(W1, W2, strict=True))
    direction = (x / mp.hypot(x, y), y / mp.hypot(x, y))
    return direction, direction[0] * W1[1] - direction[1] * W1[0]


def around(angle, random):
    """The float angle, its neighbours, and angles 1e-17 .. 1e-2 rad off on both sides."""
    steps = random.uniform(1, 10, 32) * 10.0 ** np.repeat(np.arange(-17, -1), 2) / 10 * np.tile([1, -1], 16)
    steps[-2:] = 1e-2, -1e-2
    return np.concatenate([angle + np.arange(-3, 4) * np.spacing(angle), angle + steps])


@pytest.mark.parametrize("kind", GUIDES)
@each_assembly
def test_slider_position_is_within_4_ulp(kind, assembly):
    """Both the vector to B and its coordinate along the guide."""
    random, errors = np.random.default_rng(7), []
    for drive in drives(kind):
        for dead_centre in drive.dead_centres(assembly):
            angles = around(dead_centre, random)
            s = drive.solve(angles, assembly)
            found = zip(angles, s.travel(), *s.position("B"), strict=True)
            for angle, *place in found:
                with mp.workdps(DIGITS):
                    expected = drive.exact(mp.mpf(float(angle)), assembly)
                    travel, *pin = (mp.mpf(float(f)) - e for f, e in zip(place, expected, strict=True))
                    error = max(abs(travel), mp.hypot(*pin)) / math.ulp(drive.coupler_length)
                errors.append((float(error), float(angle), drive))
    assert len(errors) == COUNT * 2 * 39
    worst = max(errors, key=lambda row: row[0])
    assert worst[0] <= ULPS, worst


@each_assembly
def test_dead_centre_is_exact_in_the_crank_angle(assembly):
    """So that the angles tried lie where they should: the slider turns back between the neighbours of the float."""
    for drive in drives("offset"):
        for angle in drive.dead_centres(assembly):
            with mp.workdps(DIGITS):
                places = [drive.exact(angle + step * mp.mpf("1e-14"), assembly)[0] for step in (-1, 0, 1)]
            assert (places[1] - places[0]) * (places[2] - places[1]) < 0


# The function of the study


def misses(kind, reach, count=10):
    """Errors of both, in coupler lengths, from a thousandth of `reach` to `reach` (rad) off the dead centres."""
    random, theirs, ours = np.random.default_rng(3), [], []
    for drive in drives(kind, count):
        for assembly in (1, -1):
            for dead_centre in drive.dead_centres(assembly):
                angles = dead_centre + reach * random.choice([-1, 1], 40) * 10.0 ** random.uniform(-3, 0, 40)
                s = drive.solve(angles, assembly)
                with mp.workdps(DIGITS):
                    rows = [drive.exact(mp.mpf(float(angle)), assembly)[1:] for angle in angles]
                exact = np.array(rows, dtype=float).T
                for found, pin in ((theirs, drive.by_double_cross(s.position("A"), assembly)), (ours, s.position("B"))):
                    found.extend(np.hypot(*(pin - exact)) / drive.coupler_length)
    return np.array(theirs), np.array(ours)


@pytest.mark.slow
def test_study_function_fails_near_dead_centres():
    """It lands two coupler lengths away on the wrong side, or square off the guide where the sign is 0.

    Some 0.3 per cent of all and 7 per cent: rounding decides how many, so only that there are some is proved.
    """
    theirs, ours = misses("mower", 1e-14, 60)
    assert np.max(ours) < 1e-15
    failed = theirs[theirs > 1e-14]
    wrong_side, square_off = (np.abs(failed - far) < 1e-14 for far in (2, np.sqrt(2)))
    assert np.all(wrong_side | square_off)
    assert 0 < np.sum(wrong_side) < 0.05 * theirs.size
    assert 0 < np.sum(square_off) < 0.4 * theirs.size


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "reach"), [("mower", 1e-2), ("offset", 1e-14), ("level", 1e-14)])
def test_study_function_agrees_elsewhere(kind, reach):
    """Away from the dead centres, and at those of offset and of level guides."""
    for errors in misses(kind, reach):
        assert np.max(errors) < 1e-14


@each_assembly
def test_study_function_agrees_over_the_turn(assembly):
    for drive in drives("offset"):
        s = drive.solve(np.linspace(0.05, 6.2, 40), assembly)
        error = np.hypot(*(drive.by_double_cross(s.position("A"), assembly) - s.position("B")))
        assert np.max(error) < 1e-14 * drive.coupler_length


def test_study_function_is_nan_out_of_reach():
    pin = np.array([[0.0, 0.0], [0.5, 0.1]])
    x, y = slider_by_double_cross(pin, 0.3, (0.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    np.testing.assert_array_equal(np.isnan([x, y]), [[True, False]] * 2)
    np.testing.assert_allclose([x[1], y[1]], [np.sqrt(0.08), 0.0], atol=1e-16)
