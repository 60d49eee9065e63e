"""Integration over the turn: its error falls with its tolerance, and what it cannot follow is refused."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from kinetostatics.studies.methods import integration
from kinetostatics.studies.methods.method import NotGivenError
from support.constrained import TURN, error, solved
from support.machines import CLOSE

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("method", integration.METHODS, ids=lambda method: method.name.split()[-1])
@pytest.mark.parametrize("name", ["plain", "cosine law", "six-bar"])
def test_error_of_integration_falls_with_its_tolerance(name, method):
    s = solved(name, acceleration=0.0)
    limits = (
        {1e-4: 0.1, 1e-8: 1e-4, 1e-12: 1e-8} if "Baumgarte" in method.name else {1e-4: 1e-4, 1e-8: 1e-11, 1e-12: CLOSE}
    )
    for wanted in ("A", "coupler_rate", "balancing_torque"):
        errors = [error(s, wanted, method.prepare(s, wanted, tolerance)()) for tolerance in limits]
        assert all(found < limit for found, limit in zip(errors, limits.values(), strict=True)), (wanted, errors)
        assert all(after < 0.01 * before + CLOSE for before, after in pairwise(errors)), errors


@pytest.mark.parametrize("method", integration.METHODS, ids=lambda method: method.name.split()[-1])
def test_integration_refuses_all_but_constant_speed_and_angles_that_rise_within_a_turn(method):
    s = solved("plain", acceleration=0.0)
    for change in (
        {"crank_acceleration": 1.0},
        {"crank_speed": np.full(TURN.size, 12.0)},
        {"crank_angle": TURN[::-1]},
        {"crank_angle": 1.1 * TURN},
        {"crank_angle": TURN[:1]},
    ):
        with pytest.raises(NotGivenError, match="integration runs"):
            method.prepare(replace(s, **change), "O", 1e-6)
