"""Labels that keep clear of each other and of what is drawn."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.path import Path

from kinetostatics.views import labels
from kinetostatics.views.labels import Labels, label


@pytest.fixture
def axes():
    figure, ax = plt.subplots()
    ax.plot([0.0, 1.0], [0.5, 0.5])
    yield ax
    plt.close(figure)


def boxes(ax, texts):
    ax.figure.canvas.draw()
    return [text.get_window_extent() for text in texts]


def test_labels_of_one_point_do_not_overlap(axes):
    found = boxes(axes, [label(axes, f"label {place}", (0.5, 0.5)) for place in range(4)])
    assert not any(one.overlaps(other) for place, one in enumerate(found) for other in found[:place])


def test_a_label_leaves_the_curve_beneath_it(axes):
    (box,) = boxes(axes, [label(axes, "here", (0.5, 0.5))])
    assert not box.contains(*axes.transData.transform((0.5, 0.5)))
    height = axes.transData.transform((0.5, 0.5))[1]
    assert box.y0 > height or box.y1 < height


@pytest.mark.slow
def test_lines_that_lead_to_labels_cross_neither_each_other_nor_labels(monkeypatch):
    """Points in heaps, from which labels must be led away."""
    count = 0
    drawn = SimpleNamespace(draw=lambda renderer: None)
    for seed in range(12):
        lines: list[Path] = []
        monkeypatch.setattr(
            labels, "Line2D", lambda x, y, to=lines, **style: to.append(Path(np.array([x, y]).T)) or drawn
        )
        figure, ax = plt.subplots()
        spots = 0.5 + 0.006 * np.random.default_rng(seed).normal(size=(12, 2))
        found = boxes(ax, [label(ax, f"{20 * place}°", spot) for place, spot in enumerate(spots)])
        plt.close(figure)
        assert not any(one.intersects_path(other, False) for place, one in enumerate(lines) for other in lines[:place])
        assert not any(line.intersects_bbox(box.padded(-1.0), filled=False) for line in lines for box in found)
        count += len(lines)
    assert count


def test_all_labels_of_axes_have_one_keeper_that_draws_nothing(axes):
    texts = [label(axes, "a", (0.1, 0.1)), label(axes, "b", (0.2, 0.2))]
    (keeper,) = (item for item in axes.artists if isinstance(item, Labels))
    assert keeper.texts == texts
