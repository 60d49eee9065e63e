"""No text of a figure lies on another: all figures of the shipped cases, and the drawings of the documents."""

import matplotlib.pyplot as plt
import pytest
from matplotlib import rc_context

from kinetostatics.casefile.case import shipped_cases
from kinetostatics.views import figures
from kinetostatics.views.canvas import FROM_X, FROM_Y_CLOCKWISE
from support.case_files import shipped
from support.every import every
from support.overlaps import overlaps


def test_texts_on_each_other_are_found():
    figure, ax = plt.subplots()
    for x, text in ((0.5, "one"), (0.505, "two"), (0.8, "far")):
        ax.text(x, 0.5, text)
    assert overlaps(figure) == [("one", "two")]
    plt.close(figure)


LIKE = {"sawframe_2r63": ("optimal", "cutting", "friction"), "mower_drive": ("optimal",)}
"""Endings of cases with the machines of another one: figures that it has are not drawn again."""


@pytest.mark.slow
@every("name", list(shipped_cases()))
def test_no_text_lies_on_another(name):
    case = shipped(name)
    counted = FROM_Y_CLOCKWISE if name == "chain_unit" else FROM_X
    base = next((base for base, endings in LIKE.items() for ending in endings if name == f"{base}_{ending}"), None)
    drawn = set(figures.figures_of(shipped(base))) - {"overview"} if base else set()
    for reference, compared in case.comparisons.items():
        solutions = {other: case.solve(other, 180) for other in (reference, *compared)}
        for figure, draw in figures.figures_of(case, list(solutions)).items():
            if figure in drawn:
                continue
            with rc_context(figures.FONT):
                made = draw(solutions, counted)
                assert overlaps(made) == [], (reference, figure)
                plt.close(made)
        if name == "sawframe_2r63_ways":  # the upright machines are those of sawframe_2r63
            break
