"""Names in a chain of parts: what is unknown and what two things would have is refused."""

import pytest

import kinetostatics as ks


def test_a_repeated_group_is_told_briefly():
    """Links that two groups share are named; what follows from their names is not told too, and the remedy once."""
    with pytest.raises(ks.ParameterError) as told:
        ks.Mechanism("twice", ks.Crank(0.1), (ks.SliderGroup(0.5), ks.SliderGroup(0.5, on="A", pin="D")))
    text = str(told.value)
    assert "adds link 'coupler' a second time" in text
    assert "coupler_rate" not in text
    assert "slider_position" not in text
    assert text.count("give the second group another pin, pivot_name or label") == 1
    assert text.endswith("label")
