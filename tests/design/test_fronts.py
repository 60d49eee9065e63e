"""Fronts of two outputs: ends are the best of each alone, between them none is better in both."""

import numpy as np
import pytest

import kinetostatics as ks

SAW = ks.load_case("sawframe_2r63")
VARY = {"spring.stiffness": (6e5, 9e5), "cam.centre.x": (-0.03, -0.01)}
FORCE, RATIO = "largest_absolute cam_force", "ratio mean_absolute balancing_torque"


@pytest.fixture(scope="module")
def front():
    return ks.design.pareto(SAW, VARY, (FORCE, f"-{RATIO}"), variant="cam-circle", points=4, angles=180)


def test_no_design_of_a_front_is_better_in_both(front):
    force, ratio = (front.table[f"{name} [{unit}]"].to_numpy() for name, unit in ((FORCE, "N"), (RATIO, "1")))
    assert np.all(np.diff(force) > 0)
    assert np.all(np.diff(ratio) > 0)


def test_ends_are_the_best_of_each_output_alone(front):
    least = ks.design.optimise(SAW, VARY, FORCE, variant="cam-circle", angles=180)
    greatest = ks.design.optimise(SAW, VARY, maximise=RATIO, variant="cam-circle", angles=180)
    assert front.table.iloc[0, 0] == pytest.approx(least.report().iloc[0]["after"], rel=1e-6)
    assert front.table.iloc[-1, 1] == pytest.approx(greatest.report().iloc[0]["after"], rel=1e-6)


def test_a_front_is_drawn_with_the_source_beside_it(front):
    import matplotlib.pyplot as plt

    ax = ks.plots.front(front)
    line, mark = ax.get_lines()
    np.testing.assert_allclose(line.get_xdata(), front.table.iloc[:, 1])
    np.testing.assert_allclose(line.get_ydata(), front.table.iloc[:, 0] / 1e3)
    assert mark.get_xdata()[0] == pytest.approx(6.08, abs=0.01)
    assert (ax.get_ylabel(), ax.get_xlabel()) == (
        "largest absolute cam force [kN]",
        "ratio mean absolute balancing torque",
    )
    plt.close(ax.figure)


@pytest.mark.parametrize(
    ("minimise", "points", "message"),
    [
        ((FORCE,), 3, "must be two outputs"),
        ((FORCE, RATIO, FORCE), 3, "must be two outputs"),
        ((FORCE, RATIO), 1, "points must be at least 2"),
        ((FORCE, "torque"), 3, "must be a reduction and a quantity"),
    ],
)
def test_fronts_of_another_kind_are_refused(minimise, points, message):
    with pytest.raises(ks.ParameterError, match=message):
        ks.design.pareto(SAW, VARY, minimise, variant="cam-circle", points=points)
