"""How each kind of stroke is drawn."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from kinetostatics.views.shape import Stroke
from kinetostatics.views.strokes import LINES, PLATES, artist, put


def test_every_kind_is_a_line_or_a_filled_shape_that_takes_its_points():
    figure, ax = plt.subplots()
    corners = np.array([[0.0, 1.0, 1.0], [0.0, 0.0, 2.0]])
    for kind in (*LINES, *PLATES):
        made = artist(ax, Stroke(kind, corners[..., None]), 0.5)
        put(made, corners)
        assert isinstance(made, Line2D) == (kind in LINES)
        shown = made.get_xydata() if kind in LINES else made.get_xy()[:3]
        assert np.array_equal(shown, corners.T)
    plt.close(figure)
