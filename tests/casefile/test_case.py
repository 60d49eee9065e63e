"""Case files: what they give, and what is said of every way to get one wrong."""

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import PLAIN, case_file, problems, shipped


def test_sawframe_case_equals_its_python_mechanism():
    variant = shipped("sawframe_2r63").solve("cam-circle", angles=90)
    spring = ks.Spring.balancing(600.0, 320 * np.pi / 30, 2.0)
    by_hand = ks.solve(
        ks.cam_crank_slider(
            ks.cams.Circle(0.3, (-0.0219, 0.0)), 2.0219, coupler=ks.Link(150, 2.0219 / 2, 20.5), slider=ks.Link(600)
        ),
        2 * np.pi * np.arange(90) / 90,
        crank_speed=320 * np.pi / 30,
        loads=[ks.Gravity(), spring],
    )
    np.testing.assert_allclose(variant.balancing_torque, by_hand.balancing_torque, atol=1e-9)
    np.testing.assert_allclose(variant.cam_force, by_hand.cam_force, rtol=1e-13)


def test_cosine_law_gives_the_coupler_length():
    mechanism = shipped("sawframe_2r63").variants["cam-cosine"].mechanism
    assert mechanism.groups[-1].coupler_length == pytest.approx(2.02190517686444745, rel=1e-15)


@pytest.mark.slow
def test_compare_gives_the_published_rows_beside_ours():
    table = shipped("sawframe_2r63").comparison_table("cam-cosine")
    assert table.loc["mean |balancing torque|", "published"] == "6.77 (ratio)"
    assert table.loc["mean |balancing torque|", "ratio"] == pytest.approx(6.778, abs=5e-4)
    assert (table["published"] != "").sum() == 9


def test_a_variant_overrides_common_keys(tmp_path):
    text = PLAIN + '[variants.plain.coupler]\nmass = "100 kg"\n'
    coupler = ks.load_case(case_file(tmp_path, text)).variants["plain"].mechanism.links["coupler"]
    assert (coupler.mass, coupler.inertia, coupler.centre) == (100.0, 20.5, (1.0, 0.0))


def test_sampled_cam_and_force_come_from_tables(tmp_path):
    degrees = np.arange(0, 360, 5)
    radius = ks.cams.Circle(0.3, (-0.0219, 0.0)).radius(np.radians(degrees))[0]
    rows = "\n".join(f"{a},{1000 * r!r}" for a, r in zip(degrees.tolist(), radius.tolist(), strict=True))
    (tmp_path / "cam.csv").write_text(f"angle [deg], radius [mm]\n{rows}\n")
    (tmp_path / "cut.csv").write_text("crank_angle [deg], force [kN]\n0, -2\n90, -1\n180, 0\n270, -1\n")
    text = """
title = "test"
reference = "cam"
[variants.cam]
mechanism = "cam-crank-slider"
crank_speed = "320 rpm"
coupler_length = "2.0219 m"
slider = { mass = "600 kg" }
cam = { kind = "sampled", table = "cam.csv" }
process_force = { table = "cut.csv" }
"""
    solution = ks.load_case(case_file(tmp_path, text)).solve("cam", angles=8)
    circle = ks.solve(
        ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.0219, 0.0)), 2.0219, slider=ks.Link(600)),
        solution.crank_angle,
        crank_speed=320 * np.pi / 30,
        loads=[ks.ProcessForce(np.array([-2000, -1500, -1000, -500, 0, -500, -1000, -1500.0]))],
    )
    np.testing.assert_allclose(solution.balancing_torque, circle.balancing_torque, atol=0.05)


def test_impossible_geometry_reports_angles_by_variant(tmp_path):
    text = PLAIN + '[variants.short]\nmechanism = "crank-slider"\ncrank_length = "300 mm"\ncoupler_length = "200 mm"\n'
    text += '[variants.long]\nmechanism = "crank-slider"\ncrank_length = "3 m"\ncoupler_length = "2 m"\n'
    found = problems(tmp_path, text)
    assert len(found) == 2
    assert found[0].startswith("variants.short: crank-slider cannot be assembled")
    assert "41.8103 .. 138.19 deg, 221.81 .. 318.19 deg" in found[0]


def test_wrong_tables_are_named_with_file_and_column(tmp_path):
    text = PLAIN.replace('"2 m"', '"2 m"\nprocess_force = { table = "cut.csv" }')
    (tmp_path / "cut.csv").write_text("crank_angle, force [kg]\n0, x\n")
    found = problems(tmp_path, text)
    assert len(found) == 2
    assert all("cut.csv" in line for line in found)


def test_unknown_variant_lists_the_known_ones():
    with pytest.raises(ks.CaseError, match=r"'plain', 'cam-circle', 'cam-cosine', .*; did you mean 'cam-circle'"):
        shipped("sawframe_2r63").solve("cam-cirle")


@pytest.mark.slow
def test_a_published_figure_without_a_row_is_refused(tmp_path):
    published = '[published.ratio]\n"mean |balancing torqe|" = "6.77"\n[published.value]\n"largest reaction Q" = "1"\n'
    case = ks.load_case(case_file(tmp_path, PLAIN + published))
    with pytest.raises(ks.CaseError, match=r"row is 'mean .balancing torqe.', .*did you mean 'mean .bal") as caught:
        case.comparison_table("plain")
    assert "'largest reaction Q'" in caught.value.problems[1]


def test_published_figures_belong_to_one_variant(tmp_path):
    published = '[published.value]\n"largest cam force" = "1"\n"torque extremum 9" = "1"\n"largest reaction B" = "2"\n'
    table = ks.load_case(case_file(tmp_path, PLAIN + published)).comparison_table("plain")
    assert table["published"][table["published"] != ""].to_dict() == {"largest reaction B": "2 (value)"}
