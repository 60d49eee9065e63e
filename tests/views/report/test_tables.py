"""Tables as text."""

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.views.report.tables import of_frame, times, with_published

FRAME = pd.DataFrame(
    {
        "unit": ["N m", "1"],
        "plain": [286771.94, 3.16347e-16],
        "ratio": [6.080751, np.nan],
        "largest at [deg]": [1e-13, 39.2871],
    },
    index=pd.Index(["torque", "power residual"], name="quantity"),
)


def test_a_frame_becomes_text_with_readable_units_and_no_more_digits_than_wanted():
    found = of_frame(FRAME, "caption", "note")
    assert found.columns == ["quantity", "unit", "plain", "ratio", "largest at [deg]"]
    assert found.rows == [["torque", "N·m", "286772", "6.081", "0"], ["power residual", "", "3.2e-16", "", "39.287"]]
    assert (found.words, found.caption, found.note) == (2, "caption", "note")


def test_published_figures_stand_in_brackets_behind_ours():
    found = with_published(FRAME, {"torque": {"plain": "about 287 kN m"}}, "x.toml", "")
    assert found.rows[0][2] == "286772 (about 287 kN m)"


def test_published_figures_without_a_row_or_column_are_refused_all_at_once():
    published = {"torqe": {"plain": "1"}, "torque": {"plan": "1"}}
    with pytest.raises(ks.CaseError, match=r"2 problems[\s\S]*row is 'torqe'[\s\S]*column of 'torque' is 'plan'"):
        with_published(FRAME, published, "x.toml", "")


def test_a_ratio_says_how_many_times():
    assert [times(ratio) for ratio in (6.0807, np.nan, np.inf)] == ["6.081 ×", "", "∞ ×"]
