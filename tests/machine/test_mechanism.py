"""A mechanism: names of its parts, and cranks of a class of one's own."""

from dataclasses import dataclass

import numpy as np
import pytest

import kinetostatics as ks


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


@pytest.mark.parametrize(("labels", "meant"), [(("2",), "slider2"), (("", "2"), "slider"), (("2", ""), "slider")])
def test_single_or_unlabelled_slider_needs_no_name(labels, meant):
    s = two_sliders(*labels)
    assert np.array_equal(s.slider_position, s.travel(meant))
    assert np.array_equal(s.slider_velocity, s.travel_velocity(meant))
    assert np.array_equal(s.slider_acceleration, s.travel_acceleration(meant))
    assert np.array_equal(s.elongation(0.2), s.elongation(0.2, meant))


def test_one_of_several_sliders_must_be_named():
    with pytest.raises(
        ks.QuantityError, match=r'engine has 2 sliders, slider1, slider2; say which, .*travel\("slider1"\)'
    ):
        two_sliders("1", "2").slider_position  # noqa: B018
    with pytest.raises(ks.QuantityError, match="four-bar has no slider"):
        ks.solve(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), 0.1, crank_speed=1.0).slider_velocity  # noqa: B018


# Names in a chain of parts


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


# The crank, and what is derived from it


@dataclass(frozen=True, eq=False)
class Forgetful(ks.Crank):
    """A crank that leaves out the torque it declares."""

    def resolve(self, placement, loads, along):
        """All but the torque."""
        return super().resolve(placement, loads, along)._replace(scalars={})


def test_derived_crank_is_checked():
    groups = (ks.SliderGroup(2.0, slider=ks.Link(600.0)),)
    assert ks.Mechanism("own", ks.Crank(0.3), groups).trusted
    own = ks.Mechanism("own", Forgetful(0.3), groups)
    assert not own.trusted
    with pytest.raises(ks.ParameterError, match=r"Forgetful declares .*'balancing_torque', but does not resolve it"):
        ks.solve(own, np.linspace(0.0, 6.0, 8), crank_speed=30.0).balancing_torque  # noqa: B018
