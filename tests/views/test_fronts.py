"""A front as a figure."""

import numpy as np
import pytest

import kinetostatics as ks
from support.improved_saws import front


def test_a_front_is_drawn_with_the_source_beside_it():
    import matplotlib.pyplot as plt

    ax = ks.plots.front(front())
    line, mark = ax.get_lines()
    np.testing.assert_allclose(line.get_xdata(), front().table.iloc[:, 1])
    np.testing.assert_allclose(line.get_ydata(), front().table.iloc[:, 0] / 1e3)
    assert mark.get_xdata()[0] == pytest.approx(6.08, abs=0.01)
    assert (ax.get_ylabel(), ax.get_xlabel()) == (
        "largest absolute cam force [kN]",
        "ratio of mean absolute balancing torque, reference / design [1]",
    )
    plt.close(ax.figure)
