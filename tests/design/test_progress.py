"""Bars of searches: counted steps where one is wanted, nothing else."""

import pytest

import kinetostatics as ks
from kinetostatics.design import progress


@pytest.mark.parametrize("wanted", [True, False])
def test_searches_find_the_same_with_a_bar(capsys, monkeypatch, wanted):
    monkeypatch.setattr(progress, "SHOWN_AFTER", 0.0)
    found = ks.design.optimise(
        ks.load_case("sawframe_2r63"), {"spring.stiffness": (6e5, 9e5)}, "mean_absolute balancing_torque",
        variant="cam-circle", angles=72, progress=wanted,
    )  # fmt: skip
    assert ("steps" in capsys.readouterr().err) is wanted
    assert found.values["spring.stiffness"] == pytest.approx(804e3, rel=0.02)
