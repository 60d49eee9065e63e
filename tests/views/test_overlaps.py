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


@pytest.mark.slow
@every("name", list(shipped_cases()))
def test_no_text_lies_on_another(name):
    case = shipped(name)
    counted = FROM_Y_CLOCKWISE if name == "chain_unit" else FROM_X
    for reference, compared in case.comparisons.items():
        solutions = {other: case.solve(other, 180) for other in (reference, *compared)}
        for figure, draw in figures.figures_of(case, list(solutions)).items():
            with rc_context(figures.FONT):
                made = draw(solutions, counted)
                assert overlaps(made) == [], (reference, figure)
                plt.close(made)
