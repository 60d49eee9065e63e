"""Torque and reactions of every shipped case beside exact arithmetic, and their proven bounds.

Errors are relative to the largest value over the turn, balanced torques to the largest torque of one load alone.
"""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import scale
from support.enclosed import ordinary_angles, worst
from support.every import every
from support.shipped import shipped

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

TURN = np.linspace(0.0, 2 * np.pi, 72, endpoint=False) + 0.01
ERROR, BOUND = 5e-15, 2e-13
PLAIN, TIGHT = 150.0, 20.0
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


VARIANTS = [(case, variant) for case in ks.shipped_cases() for variant in shipped(case).variants]


@pytest.mark.slow
@every("case, variant", VARIANTS)
def test_torque_and_reactions_are_near_the_exact_ones_and_bounded(case, variant):
    s = shipped(case).variants[variant].scene.solve(TURN)
    for name, found in worst(s).items():
        size = max(found.size, scale(s, name)) if name == "balancing_torque" else found.size
        error, bound = STEEP.get((case, variant), {}).get(name, (ERROR, BOUND))
        assert found.error <= error * size, name
        assert found.plain <= bound * size, name


@pytest.mark.slow
@every("case, variant", VARIANTS)
def test_worst_bounds_are_not_much_more_than_worst_errors(case, variant):
    """`ratios_of_bounds.py` prints all."""
    scene = shipped(case).variants[variant].scene
    for name, found in worst(scene.solve(ordinary_angles(scene, 360, 20), on_gap="nan")).items():
        assert found.error <= found.tight <= found.plain * (1.0 + 1e-12), name
        assert found.plain <= PLAIN * found.error, name
        assert found.tight <= TIGHT * found.error, name
