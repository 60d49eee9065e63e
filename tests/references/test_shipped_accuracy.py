"""Torque and reactions of every shipped case beside exact arithmetic, and their proven bounds.

Errors are relative to the largest value over the turn, balanced torques to the largest torque of one load alone, and a
reaction that vanishes, being less than a hundredth of the largest load, to that load.
"""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import NUMPY
from kinetostatics.mechanics.quantities import components, scale
from kinetostatics.studies.methods.enclosures import on_arb
from support.every import every
from support.shipped import shipped

flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

TURN = np.linspace(0.0, 2 * np.pi, 72, endpoint=False) + 0.01
ERROR, BOUND = 5e-15, 2e-13
VANISHING = 0.01
"""So is O of the two saws that are balanced by design, 0.3 and 0.9 % of their springs' force: one rounding of r' of the
cam makes 4e-15 of it.
"""
STEEP = {
    ("shaper", "cutting"): dict.fromkeys(("balancing_torque", "O", "A", "C", "D", "O2"), (4e-14, 7e-13)),
    ("toggle_press", "coining"): dict.fromkeys(
        ("balancing_torque", "O", "A", "B", "guide2", "B2", "C", "O2"), (3e-14, 5e-13)
    ),
    ("sawframe_2r63_optimal", "cam-robust"): {"A": (1.2e-14, BOUND)},
}
"""What cannot be so near, with the least it keeps, and what one rounding makes where most are found.

The shaper cuts with 4 kN that begin within 2 mm, 2e6 N/m, where joint C is 0.2 m from O2 along the guide: one rounding
of that, 1.4e-17 m, makes 7e-15 of the cutting force; its place has six, from the root of A's distance from O2 on. The
press coins with 400 kN that begin within 3 mm, 1.3e8 N/m: one rounding of the rocker's direction, 1e-16 rad, makes
2e-15 of the ram's force, 5e-15 of the rod's; a four-bar has some thirty. The spring of the robust saw takes 331 kN, by
the cube of its elongation; A bears 20 kN of that: one rounding of the elongation makes 5e-15 of A.
"""


@pytest.mark.slow
@every("case, variant", [(case, variant) for case in ks.shipped_cases() for variant in shipped(case).variants])
def test_torque_and_reactions_are_near_the_exact_ones_and_bounded(case, variant):
    s = shipped(case).variants[variant].scene.solve(TURN)
    names = ("balancing_torque", *s.reactions)
    found, bounds = NUMPY.with_bounds(s.dynamics, names)
    with flint.ctx.workprec(200):
        exact = on_arb(flint.arb, s)
        for name in names:
            pairs = zip(_rows(found[name]), components(exact, name), strict=True)
            error = _length([_differences(*pair) for pair in pairs])
            size = np.nanmax(_length(_rows(found[name])))
            largest = scale(s, name)
            if name == "balancing_torque" or size < VANISHING * largest:
                size = max(size, largest)
            most = STEEP.get((case, variant), {}).get(name, (ERROR, BOUND))
            assert np.nanmax(error) <= most[0] * size, name
            assert np.nanmax(_length(_rows(bounds[name]))) <= most[1] * size, name


def _rows(values):
    return np.atleast_2d(values)


def _length(rows):
    return np.sqrt(np.sum(np.square(rows), axis=0))


def _differences(values, truth):
    truth = np.broadcast_to(np.asarray(truth, dtype=object), values.shape)
    return [float(flint.arb(float(value)) - part) for value, part in zip(values, truth, strict=True)]
