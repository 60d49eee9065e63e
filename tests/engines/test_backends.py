"""What runs programs: shapes and types of what comes of it, and copies of it."""

import pickle

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.backends import Backend
from kinetostatics.engines.program import program_of
from support.every import every

PUMP = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))


def state(angles):
    return ks.solve(PUMP, angles, crank_speed=100.0).dynamics


@every("precision, dtype", [("double", np.float64), ("single", np.float32)])
@every("angles", [0.3, [0.1, 0.2], np.linspace(0, 6, 40), np.zeros((2, 1, 5))], ids=np.shape)
def test_results_and_bounds_have_the_shape_of_the_angles(precision, dtype, angles):
    backend = Backend("numpy", precision)
    made, leaves = program_of(state(angles), ("O",))
    found, bounds = backend.run(made, state(angles), leaves), backend.bounds(made, state(angles), leaves)
    assert found.shape == bounds.shape == (2, *np.shape(angles))
    assert (found.dtype, bounds.dtype) == (dtype, float)


def test_in_double_precision_it_is_the_program_itself_with_the_bounds_of_a_solution():
    solution = ks.solve(PUMP, [0.1, 0.2], crank_speed=100.0)
    made, leaves = program_of(solution.dynamics, ("O",))
    backend = Backend("numpy")
    assert backend.is_own
    assert not Backend("numpy", "single").is_own
    assert not Backend("jax").is_own
    assert np.array_equal(backend.run(made, solution.dynamics, leaves), solution.reaction("O"))
    assert np.array_equal(backend.bounds(made, solution.dynamics, leaves), solution.error_bound("O"))


def test_beyond_the_largest_input_there_is_no_bound():
    solution = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1e31)), [0.1], crank_speed=1.0)
    made, leaves = program_of(solution.dynamics, ("O",))
    assert np.isinf(Backend("numpy").bounds(made, solution.dynamics, leaves)).all()


def test_copies_are_equal():
    backend = Backend("jax", "single", "cpu")
    assert pickle.loads(pickle.dumps(backend)) == backend
