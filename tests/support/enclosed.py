"""Enclosures by the kernels, held against formulas of their own and the values in double precision."""

import numpy as np
import pytest


def assert_enclosed(solution, joint):
    """Torque and the reaction at a joint lie where arb enclosures and mpmath, which agree, say."""
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    from kinetostatics.studies.methods.certified import certified

    for quantity, values in (("balancing_torque", solution.balancing_torque[None]), (joint, solution.reaction(joint))):
        found = certified(solution, quantity)
        assert found.agreement < 1e-25
        np.testing.assert_allclose(values, found.middle, rtol=0, atol=1e-14 * found.largest)
