"""Knuckles: which rockers are some, and how far off their pins are from the line of the slider."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers.parameter_tree import replace_unchecked
from kinetostatics.studies.methods.high_precision.enclosures import on_arb
from support.enclosed import differences
from support.every import every

CRANK, COUPLER, ROCKER = 0.085, 0.512, 0.3
AWAY, BESIDE = 0.6, 0.35
TURN = np.linspace(0.0, 2 * np.pi, 240, endpoint=False) + 0.007
SIDES = {"right": (1, 1), "left": (-1, 1), "right, upside down": (1, -1), "left, upside down": (-1, -1)}


def press(away=AWAY, beside=BESIDE, coupler=COUPLER, way=(1, 1), axis=0, off=0.0, guide=None, on="B"):
    """A toggle press whose toggle is so far from O along an axis, the ram moving along the other one toward it."""
    (x, y), turn = way, (lambda pair: pair[::-1] if axis else pair)
    pivot = turn((x * away, y * beside))
    through = [turn((x * away + off, y * beside)), turn((x * away + off, y * (beside - 0.6)))]
    rocker = ks.RockerGroup(coupler, ROCKER, pivot, -1 if (x * y > 0) is (axis == 0) else 1)
    ram = ks.SliderGroup(0.3, guide or ks.Guide.through(*through), on=on, pin="C", label="2", slider=ks.Link(150.0))
    return ks.Mechanism("press", ks.Crank(CRANK), (rocker, ram))


def plainly(mechanism):
    """The same by the formulas of other rockers."""
    rocker, ram = mechanism.groups
    return replace_unchecked(mechanism, groups=(replace_unchecked(rocker, toggle=""), ram))


def directions(mechanism):
    return ks.Scene(mechanism, 6.0).solve(TURN).dynamics.placement.links["rocker"].direction


@pytest.mark.slow
@every("side, axis", [(side, axis) for side in SIDES for axis in (0, 1)])
def test_toggle_pin_is_off_its_line_by_lengths(side, axis, flint):
    mechanism = press(way=SIDES[side], axis=axis)
    assert mechanism.groups[0].toggle == "xy"[axis]
    exact = on_arb(flint.arb, ks.Scene(mechanism, 6.0).solve(TURN)).placement.links["rocker"].direction[axis]
    straight = np.abs(exact.astype(float)) < 0.1
    known, plain = (
        np.max(np.abs(differences(directions(made)[axis], [exact])[0])[straight])
        for made in (mechanism, plainly(mechanism))
    )
    assert known < 1.2e-16 < 2e-16 < plain


OTHERS = {
    "guide beside the pivot": press(off=0.02),
    "inclined guide": press(guide=ks.Guide.at(-1.5, 0.62)),
    "guide given by its angle": press(guide=ks.Guide.at(-np.pi / 2, 0.6)),
    "coupler that may lean": press(away=0.45),
    "long coupler": press(away=0.88, coupler=0.8),
    "slider on the crank": press(on="A"),
}


@every("name", OTHERS)
def test_other_rockers_are_none(name):
    assert OTHERS[name].groups[0].toggle == ""


def test_a_batch_is_one_if_all_its_designs_are():
    guide = ks.Guide.through((0.6, 0.35), (0.6, -0.25))
    for pivots, toggle in (([[0.6], [0.602]], "x"), ([[0.6], [0.62]], "")):
        rocker = ks.RockerGroup(COUPLER, ROCKER, (np.array(pivots), BESIDE), -1)
        chain = rocker, ks.SliderGroup(0.3, guide, on="B", pin="C", label="2")
        assert ks.Mechanism("presses", ks.Crank(CRANK), chain).groups[0].toggle == toggle


def test_coupler_may_point_to_either_side():
    """As in a program, whose lengths may become others after it was recorded."""
    bars = ks.Mechanism("double crank", ks.Crank(0.4), (ks.RockerGroup(0.3, 0.35, (0.1, 0.02)),))
    for toggle, axis in (("x", 0), ("y", 1)):
        known = replace_unchecked(bars, groups=(replace_unchecked(bars.groups[0], toggle=toggle),))
        one, other = (directions(made)[axis] for made in (known, bars))
        assert np.min(other) < -0.9 < 0.9 < np.max(other)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=3e-15)
