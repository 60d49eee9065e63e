"""Readings of a report and the machines that it compares."""

import warnings

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cycle.rounding import FLOOR
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.views.report import tables
from kinetostatics.views.report.report import subject_of
from kinetostatics.views.report.tables import decimals, ratio_text, readings, table_of_frame, texts_of, with_published
from support.case_files import shipped
from support.every import every
from support.reports import near_change_points, plain, series, subject


def of(case):
    machines = subject(case).machines
    return {"quantities": readings(machines), "counts": [m.solution.crank_angle.size for m in machines.values()]}


@pytest.mark.slow
def test_readings_are_the_solutions_values():
    for case in ("sawframe_2r63", "v_twin"):
        found = of(case)
        for row, machine in enumerate(subject(case).machines.values()):
            solution = machine.solution
            largest = max(solution.largest_torque_term, solution.largest_force_term)
            for name, item in found["quantities"].items():
                if item["values"][row] is None:
                    assert name not in of_scene(solution)
                    continue
                wanted = np.stack([np.broadcast_to(part, solution.shape) for part in components(solution, name)])
                difference = series(found, name, row) / item["factor"] - wanted
                assert (np.abs(difference) <= 2 * FLOOR * largest + 1e-15 * np.abs(wanted)).all(), name


def test_a_joint_of_machines_of_several_kinds_names_the_bodies_of_all():
    scenes = {"slider": ks.Scene(ks.crank_slider(0.1, 0.4), 1.0), "yoke": ks.Scene(ks.scotch_yoke(0.1), 1.0)}
    found = readings(subject_of(scenes).machines)
    assert found["A"]["text"] == "on the coupler, from what carries A; on the block, from what carries A"
    assert found["O"]["text"] == "ground on crank"


@pytest.mark.slow
def test_extremes_stand_between_the_angles():
    for case in ("sawframe_2r63", "compressor"):
        found = of(case)["quantities"]
        for row, machine in enumerate(subject(case).machines.values()):
            for name, item in found.items():
                if item["values"][row] is not None and name in machine.extremes:
                    parts = [
                        item[key][row].reshape(2 if item["vector"] else 1, -1) / item["factor"]
                        for key in ("values", "between")
                    ]
                    parts = np.concatenate(parts, axis=1)
                    size = np.hypot(*parts) if item["vector"] else parts[0]
                    low, _, high, _ = machine.extremes[name].ends
                    assert [size.min(), size.max()] == pytest.approx([low, high], rel=1e-9, abs=1e-9 * max(high, -low))


@pytest.mark.slow
def test_a_quantity_that_a_machine_lacks_stands_empty():
    values = of("sawframe_2r63")["quantities"]["cam_force"]["values"]
    assert values[0] is None
    assert values[1] is not None


@pytest.mark.slow
def test_units_are_the_same_for_all_machines():
    found = of("sawframe_2r63")["quantities"]
    assert (found["balancing_torque"]["unit"], found["O"]["unit"]) == ("kN·m", "kN")
    assert found["pressure_angle"]["unit"] == "°"
    assert (found["slider_acceleration"]["unit"], found["slider_acceleration"]["factor"]) == ("m/s²", 1.0)
    assert found["O"]["vector"]
    assert found["O"]["text"] == "ground on crank"


@pytest.mark.slow
def test_forces_precede_motion():
    names = list(of("sawframe_2r63")["quantities"])
    assert names[0] == "balancing_torque"
    assert names.index("O") < names.index("slider_position")
    assert "slider_rate" not in names


@every(
    "largest, count",
    [(40.58, 4), (0.0, 0), (123456.0, 0), (1e9, 0), (0.00123, 8), (1e-30, 12), (9.9999, 5), (float("nan"), 0)],
)
def test_decimals_give_the_largest_value_six_digits(largest, count):
    assert decimals(largest) == count


@pytest.mark.slow
def test_reaction_near_change_point_sets_no_scale():
    with warnings.catch_warnings(action="ignore"):
        found = readings(subject_of({"a": near_change_points()}).machines)
    assert (found["O"]["unit"], found["O"]["factor"], found["O"]["decimals"]) == ("N", 1.0, 4)
    assert 30.0 < found["O"]["sight"] < 300.0
    assert found["balancing_torque"]["sight"] is None


# Tables as text


FRAME = pd.DataFrame(
    {
        "unit": ["N m", "1"],
        "plain": [286771.94, 3.16347e-16],
        "ratio": [6.080751, np.nan],
        "largest at [deg]": [1e-13, 39.2871],
    },
    index=pd.Index(["torque", "power residual"], name="quantity"),
)


def test_frame_becomes_text_with_wanted_digits():
    found = table_of_frame(FRAME, "caption", "note")
    assert found.columns == ["quantity", "unit", "plain", "ratio", "largest at [°]"]
    assert found.rows == [["torque", "N·m", "286772", "6.081", "0"], ["power residual", "", "3.2e-16", "", "39.287"]]
    assert (found.words, found.caption, found.note) == (2, "caption", "note")


def test_published_figures_stand_in_brackets():
    found = with_published(texts_of(FRAME), {"torque": {"plain": "about 287 kN m"}}, "x.toml")
    assert found.loc["torque", "plain"] == "286772 (about 287 kN m)"


def test_misplaced_published_figures_are_refused():
    published = {"torqe": {"plain": "1"}, "torque": {"plan": "1"}}
    with pytest.raises(ks.CaseError, match=r"2 problems[\s\S]*row is 'torqe'[\s\S]*column of 'torque' is 'plan'"):
        with_published(texts_of(FRAME), published, "x.toml")


def test_a_ratio_says_how_many_times():
    assert [ratio_text(ratio) for ratio in (6.0807, np.nan, np.inf)] == ["6.081 ×", "", "∞ ×"]


# What is reported


@pytest.mark.slow
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
    (table,) = tables.comparisons(found)
    (row,) = (row for row in table.rows if row[0] == "largest reaction B")
    unit, light, (heavy, ratio) = row[1:4]
    assert unit == "N"
    assert float(heavy) * float(ratio.strip("× ()")) == pytest.approx(float(light), rel=1e-3)


def test_files_are_told_with_what_tells_their_content():
    names = [name for name, mark in subject("pumpjack").files if len(mark) == 64]
    assert names == ["pumpjack.toml", "pumpjack_well.csv"]


@every("what, options, message", [
    ({}, {}, "there are no scenes"),
    ({"a": 3}, {}, "'a' must be a Scene, got a int"),
    ({"a": plain()}, {"variant": "b"}, "variant is for case files"),
    ("sawframe_2r63", {"variant": "cam-cirle"}, "cam-cirle"),
    ("sawframe_2r36", {}, "there is no file"),
    ({"a": plain().varied({"slider.mass": np.array([[1.0], [2.0]])})}, {}, "a has arrays, several designs or values"),
    ({1: plain(), "1": plain()}, {}, "'1' labels several scenes"),
])  # fmt: skip
def test_what_cannot_be_reported_is_said(what, options, message):
    with pytest.raises(ks.KinetostaticsError, match=message):
        subject_of(what, **options)
