"""What steel of a hardness bears: the standard's line, both ways, within its range."""

import pytest

import kinetostatics as ks
from kinetostatics.design.hardness import hardness_from_pressure, pressure_from_hardness


@pytest.mark.parametrize("brinell", [180.0, 250.0, 400.0])
def test_there_and_back_is_the_same_hardness(brinell):
    assert hardness_from_pressure(pressure_from_hardness(brinell)) == pytest.approx(brinell, rel=1e-14)


@pytest.mark.parametrize("brinell", [179.0, 401.0, 0.0, "300"])
def test_what_the_standard_does_not_tell_is_refused(brinell):
    with pytest.raises(ks.ParameterError, match="pressure_from_hardness"):
        pressure_from_hardness(brinell)


@pytest.mark.parametrize(("pressure", "brinell"), [(0.0, 180.0), (2e8, 180.0), (5.996e8, 180.0), (1.31e9, 500.0)])
def test_soft_steel_is_as_soft_as_the_standard_tells(pressure, brinell):
    assert hardness_from_pressure(pressure) == pytest.approx(brinell)


@pytest.mark.parametrize("pressure", [-1.0, float("nan"), "1 GPa", None])
def test_what_is_no_pressure_is_refused(pressure):
    with pytest.raises(ks.ParameterError, match="hardness_from_pressure"):
        hardness_from_pressure(pressure)
