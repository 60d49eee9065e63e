"""The door to all figures: what it names is what the modules behind it draw."""

import inspect

import kinetostatics as ks


def test_every_figure_is_a_function_with_axes_or_a_search_to_draw_and_an_example():
    figures = {name: getattr(ks.plots, name) for name in ks.plots.__all__}
    assert all(">>>" in inspect.getdoc(figure) for figure in figures.values())
    without_axes = {name for name, figure in figures.items() if "ax" not in inspect.signature(figure).parameters}
    assert without_axes == {"before_and_after"}


def test_only_figures_are_listed():
    assert dir(ks.plots) == sorted(ks.plots.__all__)
