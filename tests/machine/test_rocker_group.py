"""Four-bars: motion and forces equal an independent full system, laws, and accuracy near a toggle."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_array_equal

import kinetostatics as ks
from support import multibody
from support.every import every
from support.machines import ANGLES, FourBar, assert_equal, bar_results, largest, motions, planar, turning
from support.multibody import Body
from support.strategies import dimension

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""

EPSILON = 2.0**-53


# Random four-bars


# Laws


def scaled(bar, length, mass):
    """Lengths and masses changed at the same speed, accelerations growing with lengths."""
    return replace(
        bar,
        crank=length * bar.crank,
        coupler=length * bar.coupler,
        rocker=length * bar.rocker,
        pivot=length * bar.pivot,
        links={
            name: Body(mass * own.mass, tuple(length * part for part in own.centre), mass * length**2 * own.inertia)
            for name, own in bar.links.items()
        },
        gravity=(length * bar.gravity[0], bar.gravity[1]),
    )


@every("power", [-200, -100, -12, 12, 100, 200])
def test_no_absolute_number_hides_in_the_rocker_group(power):
    """Scaling by powers of two, from 1e-60 to 1e60 m, is exact in binary arithmetic, so every bit must agree."""
    length, mass = 2.0**power, 2.0**-15
    expected = bar_results(FourBar().solve())
    for name, values in bar_results(scaled(FourBar(), length, mass).solve()).items():
        assert_array_equal(values, mass * length ** dimension(name) * expected[name], err_msg=name)


@every("assembly", [1, -1])
@every("turn", [0.7, np.pi / 2, -2.9])
def test_turning_everything_turns_vectors_only(turn, assembly):
    """Pivot, gravity and the zero of the crank angle together."""
    around = np.exp(1j * turn)
    bar = FourBar(assembly=assembly)
    turned = replace(bar, pivot=around * bar.pivot, gravity=(bar.gravity[0], bar.gravity[1] + turn))
    before, after = bar.solve(), turned.solve(ANGLES + turn)
    expected = {
        name: values * (around if np.iscomplexobj(values) else 1) for name, values in bar_results(before).items()
    }
    assert_equal(bar_results(after), expected)
    assert_equal(motions(after), {name: around * values for name, values in motions(before).items()})


@every("radius", [1e2, 1e4, 1e6])
def test_long_rocker_makes_a_crank_slider(radius):
    """Its pin runs on an arc that leaves the straight guide as 1 / radius; here the guide is +x through O."""
    link = ks.Link(2.0, (0.3, 0.1), 0.5)
    bar = ks.four_bar(0.3, 1.1, radius, rocker_pivot=(1.1, radius), assembly=-1, coupler=link)
    slider = ks.crank_slider(0.3, 1.1, coupler=link)
    found, expected = (ks.solve(mechanism, ANGLES, crank_speed=5.0) for mechanism in (bar, slider))
    assert largest(found.balancing_torque - expected.balancing_torque) < 10 / radius
    assert largest(found.reaction("A") - expected.reaction("A")) < 30 / radius


# Near a toggle


def quantities(bar, angle):
    """Position of the pin, rates, accelerations at crank speed 1, with 50 digits."""
    found = multibody.four_bar(replace(bar, speed=1.0, acceleration=0.0)).motion(angle)
    B, turned = found["position"]["B"], [("coupler", "angle"), ("rocker", "angle")]
    return [B.real, B.imag, *(found[order][link] for order in ("velocity", "acceleration") for link in turned)]


def with_condition(bar, angle):
    """The quantities, and how much each changes, by rule of sums, for a relative change of lengths, pivot and angle."""
    with mp.workdps(50):
        step, at = mp.mpf("1e-25"), quantities(bar, angle)
        more, x, y = 1 + step, mp.mpf(bar.pivot.real), mp.mpf(bar.pivot.imag)
        changes = (
            {"crank": bar.crank * more},
            {"coupler": bar.coupler * more},
            {"rocker": bar.rocker * more},
            {"pivot": mp.mpc(x * more, y)},
            {"pivot": mp.mpc(x, y * more)},
        )
        changed = [quantities(replace(bar, **change), angle) for change in changes] + [quantities(bar, angle * more)]
        slopes = [[abs(after - before) / step for before, after in zip(at, row, strict=True)] for row in changed]
        return np.array(at, dtype=float), np.array([sum(slope) for slope in zip(*slopes, strict=True)], dtype=float)


def near_toggle(kind, margin):
    """A crank-rocker that comes near a toggle, and the crank angle of that."""
    r, b = 0.3, 1.0
    if kind == "stretched":
        return FourBar(r, 0.6, (b + r) * (1 + margin) - 0.6, b + 0j), np.pi
    shorter, longer = 0.9, 0.9 + (b - r) * (1 - margin)
    return FourBar(r, *((shorter, longer) if kind == "folded" else (longer, shorter)), b + 0j), 0.0


def assert_error_is_that_of_rounded_lengths(bar, angles):
    """Errors below ten times the condition, the sum over lengths, pivot and crank angle of |x df/dx|, times rounding.

    Rounding the inputs alone makes errors a tenth as large. And the pin is on the chosen side.
    """
    for angle in angles:
        s = bar.solve(angle, crank_speed=1.0, crank_acceleration=0.0, on_gap="nan")
        rates = [rate(link) for rate in (s.rate, s.angular_acceleration) for link in ("coupler", "rocker")]
        expected, condition = with_condition(bar, angle)
        assert np.all(np.abs([*s.position("B"), *rates] - expected) < 10 * EPSILON * condition)
        A, B = planar(s.position("A")), planar(s.position("B"))
        assert bar.assembly * turning(bar.pivot - A, B - A) > 0


@pytest.mark.slow
@every("kind", ["stretched", "folded", "folded, long coupler"])
@every("power, assembly", [(2, 1), (10, 1), (14, -1)])
def test_error_near_a_toggle_is_of_rounded_lengths(kind, power, assembly):
    """A closing margin of 1e-14 leaves a sine of the transmission angle of 1e-7.

    The condition grows as 1 / sine for positions, 1 / sine^2 for rates and 1 / sine^3 for accelerations.
    """
    margin = 10.0**-power
    bar, toggle = near_toggle(kind, margin)
    angles = toggle + np.sqrt(margin) * np.array([0.0, 0.3, -1.0, 5.0])
    assert_error_is_that_of_rounded_lengths(replace(bar, assembly=assembly), angles)


@pytest.mark.slow
@every("longer, assembly", [(1e2, 1), (1e4, -1), (1e6, 1)])
def test_error_with_a_long_link_is_of_rounded_lengths(longer, assembly):
    """Differences of squares would cost twice as many digits as the long link has more than the short one."""
    for coupler, rocker in ((1.0, longer), (longer, 1.0)):
        bar = FourBar(0.5, coupler, rocker, 0.8 + 1j * longer, assembly)
        assert_error_is_that_of_rounded_lengths(bar, ANGLES[::12])
