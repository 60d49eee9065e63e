"""Bars of searches: counted steps where one is wanted, nothing else."""

from types import SimpleNamespace

import pytest

import kinetostatics as ks
from kinetostatics.design import progress


def test_a_bar_counts_steps_while_it_is_shown(capsys, monkeypatch):
    monkeypatch.setattr(progress, "SHOWN_AFTER", 0.0)
    problem = SimpleNamespace(stepped=progress.no_bar)
    with progress.moving_bar(problem, label="saw"):
        for _ in range(3):
            problem.stepped(None)
    assert problem.stepped is progress.no_bar
    assert "saw" in capsys.readouterr().err


def test_without_one_nothing_is_shown(capsys):
    problem = SimpleNamespace(stepped=progress.no_bar)
    with progress.moving_bar(problem, wanted=False):
        problem.stepped(None)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("wanted", [True, False])
def test_searches_find_the_same_with_a_bar(capsys, monkeypatch, wanted):
    monkeypatch.setattr(progress, "SHOWN_AFTER", 0.0)
    found = ks.design.optimise(
        ks.load_case("sawframe_2r63"), {"spring.stiffness": (6e5, 9e5)}, "mean_absolute balancing_torque",
        variant="cam-circle", angles=72, progress=wanted,
    )  # fmt: skip
    assert ("steps" in capsys.readouterr().err) is wanted
    assert found.values["spring.stiffness"] == pytest.approx(804e3, rel=0.02)
