"""Torque and reactions of every shipped case beside exact arithmetic, and their proven bounds.

Errors are relative to the largest value over the turn, balanced torques to the largest torque of one load alone, and a
reaction that vanishes, being less than a hundredth of the largest load, to that load.
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
VANISHING = 0.01
"""So is O of the two saws that are balanced by design, 0.3 and 0.9 % of their springs' force: one rounding of r' of the
cam makes 4e-15 of it.
"""
PLAIN, TIGHT = 150.0, 20.0
STIFF = {("sawframe_2r63_optimal", "cam-robust"): {"A": (1.2e-14, 4e-13)}}
"""What cannot be so near, with the least it keeps, and what one rounding makes where most are found.

The spring of the robust saw takes 331 kN, by the cube of its elongation; A bears 20 kN of that: one rounding of the
elongation makes 5e-15 of A. Its elongation has three, 1.1e-14; the second derivative of its travel makes 4e-15, the law
of the spring 3e-15.

On 100 angles between two kinks of its table the coining press is at 9e-15 in its rod and knuckle, which the cutting
shaper is not (2e-15): their forces go with the knuckle's angle, 0.016, which the rocker's direction has of parts of
0.5, and one rounding of 1e-16 makes 7e-15.
"""


VARIANTS = [(case, variant) for case in ks.shipped_cases() for variant in shipped(case).variants]


@pytest.mark.slow
@every("case, variant", VARIANTS)
def test_torque_and_reactions_are_near_the_exact_ones_and_bounded(case, variant):
    s = shipped(case).variants[variant].scene.solve(TURN)
    for name, found in worst(s).items():
        size, largest = found.size, scale(s, name)
        if name == "balancing_torque" or size < VANISHING * largest:
            size = max(size, largest)
        error, bound = STIFF.get((case, variant), {}).get(name, (ERROR, BOUND))
        assert found.error <= error * size, name
        assert found.plain <= bound * size, name


@pytest.mark.slow
@every("case, variant", VARIANTS)
def test_worst_bounds_are_not_much_more_than_worst_errors(case, variant):
    """`ratios_of_bounds.py` prints all."""
    scene = shipped(case).variants[variant].scene
    for name, found in worst(scene.solve(ordinary_angles(scene, 3600, 40), on_gap="nan")).items():
        assert found.error <= found.tight <= found.plain * (1.0 + 1e-12), name
        assert found.plain <= PLAIN * found.error, name
        assert found.tight <= TIGHT * found.error, name
