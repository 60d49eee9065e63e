"""A mechanism: which of several sliders is meant, and what tells its parts apart."""

import numpy as np
import pytest

import kinetostatics as ks


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


@pytest.mark.parametrize(("labels", "meant"), [(("2",), "slider2"), (("", "2"), "slider"), (("2", ""), "slider")])
def test_the_only_slider_and_the_one_without_a_label_need_no_name(labels, meant):
    s = two_sliders(*labels)
    assert np.array_equal(s.slider_position, s.travel(meant))
    assert np.array_equal(s.slider_velocity, s.travel_velocity(meant))
    assert np.array_equal(s.slider_acceleration, s.travel_acceleration(meant))
    assert np.array_equal(s.elongation(0.2), s.elongation(0.2, meant))


def test_which_of_several_sliders_is_meant_must_be_said():
    with pytest.raises(
        ks.QuantityError, match=r'engine has 2 sliders, slider1, slider2; say which, .*travel\("slider1"\)'
    ):
        two_sliders("1", "2").slider_position  # noqa: B018
    with pytest.raises(ks.QuantityError, match="four-bar has no slider"):
        ks.solve(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), 0.1, crank_speed=1.0).slider_velocity  # noqa: B018
