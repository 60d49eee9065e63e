"""Ways to a motion over time: they reach the published ends of benchmarks, or say why they cannot."""

import pytest

import kinetostatics as ks
from kinetostatics.studies.methods import motion

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", motion.BENCHMARKS)
@pytest.mark.parametrize(
    ("method", "setting", "error"),
    [("ours, NumPy", None, 1e-11), ("reduced inertia, RK45", 1e-7, 1e-3), ("reduced inertia, LSODA", 1e-9, 1e-4)],
)
def test_methods_reach_the_published_ends_of_motions(name, method, setting, error):
    problem = motion.BENCHMARKS[name]()
    (found,) = (one for one in motion.METHODS if one.name == method)
    assert abs(found.prepare(problem, "", setting)() - problem.exact) < error


def test_constraint_equations_reach_the_published_end_and_refuse_singular_positions():
    (constraints,) = (one for one in motion.METHODS if one.name.startswith("constraint"))
    problem = motion.slider_crank()
    assert abs(constraints.prepare(problem, "", 1e-5)() - problem.exact) < 1e-6
    with pytest.raises(ks.errors.NotGivenError, match="change points"):
        constraints.prepare(motion.n_four_bar(), "", 1e-5)
