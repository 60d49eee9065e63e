"""Torque and reactions of every shipped case beside exact arithmetic, and their proven bounds.

Errors are relative to the largest value over the turn, balanced torques to the largest torque of one load alone.
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
BALANCED = {"B": (7e-15, BOUND)}
"""Of cams that a spring balances: what is left of forces thirteen times as large."""
STEEP = {
    ("sawframe_2r63", "cam-circle"): BALANCED,
    ("sawframe_2r63", "cam-cosine"): BALANCED,
    ("sawframe_2r63_friction", "cam-circle"): BALANCED,
    ("sawframe_2r63_friction", "cam-cosine"): BALANCED,
    ("sawframe_2r63_friction", "cam-cosine-rolling"): BALANCED,
    ("sawframe_2r63_optimal", "cam-cosine"): BALANCED,
    ("sawframe_2r63_optimal", "cam-optimal"): {"O": (8e-14, 2e-12)},
    ("sawframe_2r63_optimal", "cam-robust"): {"O": (4e-14, 1e-12), "A": (2e-14, BOUND)},
    ("compressor", "loaded"): dict.fromkeys("OAB", (1e-14, BOUND)),
    ("shaper", "cutting"): dict.fromkeys(("balancing_torque", "O", "A", "C", "D", "O2"), (4e-14, 2e-12)),
    ("toggle_press", "coining"): dict.fromkeys(
        ("balancing_torque", "O", "A", "B", "guide2", "B2", "C", "O2"), (2e-13, 5e-12)
    ),
}
"""What cannot be so near, with the least it keeps: small remainders of large forces, and tables over travel whose
values change by more than their size within a part of 1e-3 of the travel.
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
            if name == "balancing_torque":
                size = max(size, scale(s, name))
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
