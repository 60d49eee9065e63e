"""Figures: they draw on the axes given, return them, and name every axis with its unit."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.animation import FuncAnimation, PillowWriter

import kinetostatics as ks

PLOTS = {
    "torque": ks.plots.torque,
    "cam_force": ks.plots.cam_force,
    "pressure_angle": ks.plots.pressure_angle,
    "acceleration_error": ks.plots.acceleration_error,
    "hodograph": ks.plots.hodograph,
    "shaking": lambda s, ax: ks.plots.hodograph(s, "shaking_force", ax=ax),
    "mechanism": ks.plots.mechanism,
}


@pytest.fixture(scope="module")
def saw():
    case = ks.load_case("sawframe_2r63")
    return {name: case.solve(name, angles=360) for name in case.variants}


@pytest.fixture
def axes():
    figure, ax = plt.subplots()
    yield ax
    plt.close(figure)


@pytest.mark.parametrize("name", PLOTS)
def test_plot_returns_the_axes_given_with_units_on_both(name, saw, axes):
    open_figures = plt.get_fignums()
    assert PLOTS[name](saw["cam-circle"], ax=axes) is axes
    assert plt.get_fignums() == open_figures
    assert all("[" in label for label in (axes.get_xlabel(), axes.get_ylabel()))
    axes.figure.canvas.draw()


def test_torque_curves_hold_the_numbers_of_the_solutions(saw, axes):
    ks.plots.torque({name: saw[name] for name in ("plain", "cam-cosine")}, ax=axes)
    curves = {line.get_label(): line.get_ydata() for line in axes.lines if not line.get_label().startswith("_")}
    assert axes.get_ylabel() == "balancing torque [kN m]"
    for name, curve in curves.items():
        np.testing.assert_allclose(1000 * curve, saw[name].balancing_torque)
    assert len(curves) == 2


def test_acceleration_error_is_nil_for_the_exact_law_and_2_percent_for_the_circle(saw, axes):
    ks.plots.acceleration_error({name: saw[name] for name in ("cam-cosine", "cam-circle")}, ax=axes)
    exact, circle = (np.abs(line.get_ydata()).max() for line in axes.lines[:2])
    assert exact < 1e-11
    assert 2.0 < circle < 2.2


def test_hodograph_has_equal_scales_is_closed_and_marks_the_crank_angle(saw, axes):
    ks.plots.hodograph(saw["plain"], "O", ax=axes, marks=90)
    x, _ = axes.lines[0].get_data()
    assert axes.get_aspect() == 1
    assert x[0] == x[-1]
    assert np.max(np.abs(x)) == pytest.approx(286.77, abs=0.01)
    assert {text.get_text() for text in axes.texts} == {"0°", "90°", "180°", "270°"}


def test_mechanism_is_drawn_where_the_solution_puts_it(saw, axes):
    ks.plots.mechanism(saw["plain"], angles=(30,), ax=axes)
    ends = saw["plain"].at(np.radians([30.0])).position("B")
    assert any(np.allclose(line.get_xydata()[-1], ends[:, 0]) for line in axes.lines if len(line.get_xdata()) == 2)


def test_animation_moves_bars_and_force_arrows_and_saves_as_gif(saw, axes, tmp_path):
    film = ks.plots.animation(saw["cam-circle"], joints=("O", "A", "guide"), frames=4, ax=axes)
    assert isinstance(film, FuncAnimation)
    film.save(tmp_path / "saw.gif", writer=PillowWriter(fps=10))
    assert (tmp_path / "saw.gif").read_bytes().startswith(b"GIF8")


def test_a_quantity_the_mechanism_lacks_is_refused_by_name(saw, axes):
    with pytest.raises(ks.QuantityError, match="cam_force"):
        ks.plots.cam_force(saw["plain"], ax=axes)
