"""What is reported: from a case, a name, scenes; and what cannot be."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.report.report import subject_of
from support.case_files import shipped
from support.every import every
from support.reports import plain, subject


def test_reference_machine_comes_first():
    found = subject("mower_drive")
    assert list(found.machines) == ["unbalanced", "full", "partial-1", "partial-2", "partial-3", "optimal"]
    assert found.reference.name == shipped("mower_drive").reference
    assert found.title == shipped("mower_drive").title


@pytest.mark.slow
def test_single_variant_stands_beside_reference():
    assert list(subject("mower_drive", "full").machines) == ["unbalanced", "full"]
    assert list(subject("mower_drive", "unbalanced").machines) == ["unbalanced"]


def test_angles_are_whole_degrees():
    found = subject("v_twin")
    assert [machine.solution.crank_angle.size for machine in found.machines.values()] == [360, 360, 720]
    np.testing.assert_allclose(np.degrees(found.machines["firing"].solution.crank_angle), np.arange(720), atol=1e-12)


def test_a_long_period_has_a_longer_step_common_to_all():
    angle = np.linspace(0.0, 20 * np.pi, 21)
    slow = plain(
        loads=ks.ProcessForce(ks.Table(angle, np.cos(angle / 10), over="angle", period=20 * np.pi), period=20 * np.pi)
    )
    found = subject_of({"slow": slow, "plain": plain()})
    assert found.machines["slow"].step == found.machines["plain"].step == 3
    assert [machine.solution.crank_angle.size for machine in found.machines.values()] == [1200, 120]


def test_words_of_the_case_become_numbers():
    given = subject("sawframe_2r63").machines["cam-cosine"].given
    assert given["spring.stiffness"] == (pytest.approx(673764.99), "N/m")
    assert given["coupler_length"] == (pytest.approx(2.02190518), "m")


@pytest.mark.slow
def test_scenes_have_their_labels_and_units():
    found = subject_of({"light": plain(), "heavy": plain().varied({"slider.mass": 80.0})})
    assert found.title == "crank-slider"
    assert found.machines["heavy"].given["slider.mass"] == (80.0, "kg")
    assert found.files == []
    assert found.text == ""
    table, bounds = found.comparison(found.machines["heavy"])
    assert table.loc["largest reaction B", "ratio"] < 1.0
    assert 0.0 < bounds.loc["largest reaction B", "ratio"] < 1e-13


def test_files_are_told_with_what_tells_their_content():
    names = [name for name, mark in subject("pumpjack").files if len(mark) == 64]
    assert names == ["pumpjack.toml", "pumpjack_well.csv"]


@every("what, options, message", [
    ({}, {}, "there are no scenes"),
    ({"a": 3}, {}, "'a' must be a Scene, got a int"),
    ({"a": plain()}, {"variant": "b"}, "variant chooses one of a case file"),
    ("sawframe_2r63", {"variant": "cam-cirle"}, "cam-cirle"),
    ("sawframe_2r36", {}, "no such file"),
    ({"a": plain().varied({"slider.mass": np.array([[1.0], [2.0]])})}, {}, "a holds arrays, several designs or values"),
    ({1: plain(), "1": plain()}, {}, "'1' labels several scenes"),
])  # fmt: skip
def test_what_cannot_be_reported_is_said(what, options, message):
    with pytest.raises(ks.KinetostaticsError, match=message):
        subject_of(what, **options)
