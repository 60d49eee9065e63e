"""Rules of fields: what they take, as what, and what they refuse."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers import checks


@dataclass(frozen=True)
class Box(checks.Checked):
    """Something with rules."""

    width: Any
    corner: Any = (0.0, 0.0)
    lid: Any = None

    def _not_flat(self):
        if np.any(self.width == 7.0):
            yield "seven is flat"

    RULES = checks.Rules(
        "box",
        _not_flat,
        width=checks.Number("m", low=0.0, strict=True),
        corner=checks.Pair("m"),
        lid=checks.Optional(checks.Number("m", low=0.0)),
    )


def test_whole_numbers_become_floats_and_arrays_locked_copies():
    widths = np.array([[1], [2]])
    box = Box(widths, [1, 2])
    widths[0] = 9
    assert box.width.tolist() == [[1.0], [2.0]]
    assert not box.width.flags.writeable
    assert (box.corner, box.lid) == ((1.0, 2.0), None)
    assert type(Box(3).width) is float


def test_all_fields_that_are_wrong_are_told_at_once():
    with pytest.raises(ks.ParameterError) as caught:
        Box(0.0, (1.0, np.nan), -1.0)
    for words in ("box: ", "width must be greater than 0", "corner", "lid must be at least 0"):
        assert words in str(caught.value)


def test_what_fields_are_only_together_is_looked_at_after_them():
    with pytest.raises(ks.ParameterError, match="seven is flat"):
        Box(7.0)
