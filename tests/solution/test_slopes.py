"""Derivatives by path of what a program computes: as differences tell, NaN where there is no value."""

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.jax_backend import Backend
from kinetostatics.engines.program import program_of
from kinetostatics.solution.parameters import leaves_of
from kinetostatics.solution.slopes import slopes

SCENE = ks.Scene(ks.crank_slider(0.3, 0.32, guide_offset=0.1, slider=ks.Link(600.0)), 30.0)
TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


def test_slopes_stand_by_quantity_and_path_and_are_missing_in_gaps():
    state = SCENE.unsolved(TURN).dynamics
    program, leaves = program_of(state, ("balancing_torque", "O"))
    places = leaves_of(SCENE.places, state)
    found = slopes(
        program, {path: places[path] for path in ("crank_length", "slider.mass")}, state, leaves, Backend("numpy")
    )
    assert found["O"]["slider.mass"].shape == (2, 24)
    gaps = np.isnan(SCENE.solve(TURN, on_gap="nan").balancing_torque)
    assert gaps.any()
    assert not gaps.all()
    np.testing.assert_array_equal(np.isnan(found["balancing_torque"]["crank_length"]), gaps)
    high, low = (SCENE.varied({"slider.mass": 600.0 + by}).solve(TURN, on_gap="nan") for by in (1.0, -1.0))
    difference = (high.balancing_torque - low.balancing_torque) / 2.0
    np.testing.assert_allclose(found["balancing_torque"]["slider.mass"], difference, rtol=1e-9)
