"""Names in a chain of parts: what is unknown and what two things would have is refused."""

import pytest

import kinetostatics as ks


def test_groups_that_do_not_hang_together_are_refused():
    with pytest.raises(ks.ParameterError, match="SliderGroup hangs on joint 'D'"):
        ks.Mechanism("loose", ks.Crank(0.1), (ks.SliderGroup(0.5, on="D"),))
    with pytest.raises(ks.ParameterError, match="adds joint 'B' a second time"):
        ks.Mechanism("twice", ks.Crank(0.1), (ks.SliderGroup(0.5), ks.SliderGroup(0.5, label="2")))
    with pytest.raises(ks.ParameterError, match="adds joint 'A' a second time"):
        ks.Mechanism("both", ks.Crank(0.1), (ks.CamRoller(ks.cams.Circle(0.1)), ks.SliderGroup(0.5)))
    with pytest.raises(ks.ParameterError, match="direction must have length 1"):
        ks.SliderGroup(0.5, ks.Guide(None, 0.0, (2.0, 0.0)))


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
