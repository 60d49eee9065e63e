"""Torque and reactions of every shipped case beside exact arithmetic, and their proven bounds.

Errors are relative to the largest value over the turn, balanced torques to the largest torque of one load alone, and a
reaction that vanishes, being less than a hundredth of the largest load, to that load. Where springs work against each
other, errors are relative to the force of one.
"""

import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import largest_term
from support.case_files import shipped, variant_names
from support.enclosed import ordinary_angles, worst
from support.every import every
from support.kept import has_table_loads

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

ERROR, BOUND = 5e-15, 2e-13
ERROR_OF_TABLES, BOUND_OF_TABLES = 1e-13, 1e-12
"""With table loads, whose flanks magnify a rounding of the travel; their rows have four digits."""
VANISHING = 0.01
"""So is O of the two saws that are balanced by design, 0.3 and 0.9 % of their springs' force: one rounding of r' of the
cam makes 4e-15 of it.
"""
EVEN, BETWEEN = 720, 100
"""Crank angles a turn, and between two kinks of a table, as `ordinary_angles` has them."""
PLAIN, TIGHT, TIGHT_OF_TABLES = 100.0, 20.0, 50.0


CASES = [case for case in ks.shipped_cases() if case != "sawframe_2r63_cutting"]
"""But that of a cut, whose stroke exact arithmetic does not find; `tests/machine/loads/test_work.py` has its force."""
VARIANTS = [(case, variant) for case in CASES for variant in variant_names(case)]


def opposed(scene):
    """Largest force, N, of springs that work against each other, or of a long spring at the length it is free."""
    gas = [item.pressure * item.area for item in scene.loads if isinstance(item, ks.GasSpring)]
    return max(
        [*gas, *(item.stiffness * item.free_length for item in scene.loads if isinstance(item, ks.PointSpring))],
        default=0.0,
    )


@pytest.mark.slow
@every("case, variant", VARIANTS)
def test_shipped_results_are_near_exact_and_their_bounds_near(case, variant):
    """`ratios_of_bounds.py` prints the ratios of worst bounds to worst errors."""
    scene = shipped(case).variants[variant].scene
    s, tabled = scene.solve(ordinary_angles(scene, EVEN, BETWEEN)), has_table_loads(scene)
    most, tight = ((ERROR_OF_TABLES, BOUND_OF_TABLES), TIGHT_OF_TABLES) if tabled else ((ERROR, BOUND), TIGHT)
    for name, found in worst(s).items():
        size, largest = found.size, largest_term(s, name)
        if name == "balancing_torque" or size < VANISHING * largest:
            size = max(size, largest)
        size = max(size, opposed(scene))
        assert found.error <= most[0] * size, name
        assert found.plain <= most[1] * size, name
        assert found.error <= found.tight <= found.plain * (1.0 + 1e-12), name
        assert found.plain <= PLAIN * found.error, name
        assert found.tight <= tight * found.error, name
