"""Slips that were answered with nothing, with nonsense or with a foreign error are told plainly, with what to write."""

import os
import subprocess
import sys
import unicodedata
import warnings
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.every import every

SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
CAM = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.02, slider=ks.Link(600.0))
BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
OPEN = ks.crank_slider(0.3, 0.2, coupler=ks.Link(1.0, 0.1, 0.1), slider=ks.Link(6.0))
"""Closes on two arcs, about crank angles 0 and 180 degrees."""
FOUR_STROKES = ks.Table([0.0, 6.0, 11.0], [1.0, 2.0, 1.0], period=4 * np.pi)


def spring(free_angle, **against):
    """Torque of a scene with a torsion spring on a coupler that closes on two arcs."""
    held = ks.TorsionSpring(4.0, free_angle, on="coupler", **against)
    return ks.Scene(OPEN, 3.0, loads=[held]).solve(np.linspace(-0.2, 0.2, 9)).balancing_torque


REFUSED = {
    "force as motion": (
        lambda: at_rest(SAW).measure("guide_force"),
        r'not a quantity of motion; .* solution.scalar\("gu',
    ),
    "reaction as motion": (lambda: at_rest(SAW).measure("O"), r'not a quantity of motion; .* solution.reaction\("O"\)'),
    "travel as motion": (
        lambda: at_rest(SAW).measure("slider_velocity"),
        r'is not a quantity of motion; read it by solution.travel_velocity\("slider"\)',
    ),
    "whole as motion": (lambda: at_rest(SAW).measure("shaking_force"), "read it by solution.shaking_force$"),
    "motion that is not there": (lambda: at_rest(SAW).measure("presure"), "quantity is 'presure', allowed: 'bal"),
    "a Geneva drive": (lambda: ks.Geneva, "no attribute 'Geneva'; machines are cam_crank_slider, .* four_bar, .*Yoke"),
    "gears": (lambda: ks.gears, "machines are .* and a Mechanism of CamRoller"),
    "a crank-rocker": (lambda: ks.crank_rocker, "'crank_rocker'; did you mean 'four_bar'"),
    "a slip of the finger": (lambda: ks.sovle, "did you mean 'solve'"),
    "American": (lambda: ks.design.optimize, "did you mean 'optimise'"),
    "components of a force": (
        lambda: ks.Force((0.0, -100.0), at="B"),
        r"components \(0.0, -100.0\) write Force\(100, direction=-1.5708, ...\)",
    ),
    "components in a list": (lambda: ks.Force([3, 4], at="B"), r"write Force\(5, direction=0.927295, ...\)"),
    "nested lists": (
        lambda: ks.crank_slider([[0.1], [0.2]], 0.4),
        r"a list; for a batch of designs write np.array\(\[\[0.1\], \[0.2\]\]\)$",
    ),
    "a list": (lambda: ks.crank_slider(0.1, [0.3, 0.4]), r"write np.array\(\[0.3, 0.4\]\)\[:, None\]"),
    "tuples": (lambda: ks.Link(((1.0,), (2.0,))), r"a tuple; for a batch .* write np.array\(\(\(1.0,\), \(2.0,\)\)\)"),
    "a list for one number": (lambda: ks.drive.Motor.linear([1.0, 2.0], 3.0), r"must be one number, got \[1.0, 2.0\]"),
    "another period than of the table": (
        lambda: ks.ProcessForce(FOUR_STROKES, period=2 * np.pi),
        "the period is 6.28.*, but that of its force 12.56.*; leave it out",
    ),
    "a spring over half a turn on arcs": (lambda: spring(3.0), "give a free angle nearer to it, such as 0.0"),
    "a spring between links on arcs": (lambda: spring(0.0, against="crank"), "give a free angle nearer to it"),
}


def at_rest(mechanism):
    return ks.solve(mechanism, 0.1, crank_speed=3.0)


@every("name", REFUSED)
def test_a_slip_is_refused_with_what_to_write(name):
    act, message = REFUSED[name]
    with pytest.raises((ks.KinetostaticsError, AttributeError), match=message) as caught:
        act()
    assert "None" not in str(caught.value).replace("[:, None]", "")
    assert "full turns" not in str(caught.value)


def test_what_a_message_says_to_write_is_taken():
    solution = at_rest(CAM)
    assert solution.measure("cam_radius") == pytest.approx(np.hypot(*solution.position("A")), rel=1e-15)
    assert solution.scalar("guide_force") == solution.guide_force
    assert np.isfinite(spring(0.0)).all()
    force = ks.Force(100, direction=-1.5708, at="B")
    assert np.isfinite(ks.Scene(BAR, 3.0, loads=[force]).solve(4).balancing_torque).all()


# Loads and their periods


def test_a_process_force_has_the_period_of_its_table():
    assert ks.ProcessForce(FOUR_STROKES).period == 4 * np.pi
    assert ks.ProcessForce(FOUR_STROKES, period=4 * np.pi).period == 4 * np.pi
    assert ks.ProcessForce(5.0).period == 2 * np.pi
    assert ks.ProcessForce(5.0, period=4 * np.pi).period == 4 * np.pi
    assert ks.Scene(SAW, 3.0, loads=[ks.ProcessForce(FOUR_STROKES)]).period == 4 * np.pi


CYLINDER = ks.Mechanism(
    "oscillating engine",
    ks.Crank(0.040, ks.Link(3.0)),
    (ks.CylinderGroup((0.0, -0.220), rod=ks.Link(0.5, 0.08, 0.001), cylinder=ks.Link(2.0, 0.06, 0.008)),),
)


def pin_load(load):
    return np.hypot(*ks.Scene(CYLINDER, 20.0, loads=[load]).solve(72).reaction("A")).max()


@every("between", [("A", "O2"), ("O2", "A"), ("A", ("cylinder", 0.01, 0.0))])
@every("kind", [ks.PointForce, lambda size, between: ks.PointSpring(size, 0.0, between=between), ks.PointDamper])
def test_load_beside_a_cylinder_rod_is_questioned(between, kind):
    load = kind(1500.0, between=between)
    with pytest.warns(ks.HintWarning, match=r"on 'A', a joint of the crank, so the rod does not carry it. .*\"rod\""):
        assert pin_load(load) < 50.0


@every("between", [(("rod", 0.0, 0.0), "O2"), ("O2", ("rod", 0.15, 0.0)), (("rod", 0.1), ("cylinder", 0.01))])
def test_load_from_rod_to_cylinder_acts_on_the_pin(between):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert pin_load(ks.PointForce(1500.0, between=between)) > 1400.0


# Searches and cams


@pytest.mark.slow
@pytest.mark.parametrize("angle", [np.pi / 2, -np.pi / 2])
def test_weight_along_the_guide_sets_no_bound(angle):
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600), guide=ks.Guide.at(angle))
    scene = ks.Scene(saw, 33.5, loads=[ks.Gravity()])
    found = ks.design.torque_free_cam(scene, cosine=2, reference=scene)
    assert found.bound == np.inf


@pytest.mark.slow
def test_ratio_beyond_the_bound_names_the_bound():
    saw = ks.load_case("sawframe_2r63")
    limit = "ratio mean_absolute balancing_torque >= 1000"
    with pytest.raises(ks.DesignError, match=r"a ratio of mean torques of about \d+ at most, within some"):
        ks.design.torque_free_cam(saw, cosine=2, limits=[limit])


@pytest.mark.slow
def test_limits_and_reports_know_the_cam_radius():
    saw = ks.load_case("sawframe_2r63")
    limit = "smallest cam_radius >= 290 mm"
    found = ks.design.torque_free_cam(saw, cosine=4, gravity=False, limits=[limit], shaft_radius=0.3)
    smallest = ks.extremes(found.scene.solve(360), "cam_radius").range[0]
    assert smallest == pytest.approx(0.29, rel=1e-6)
    with pytest.warns(ks.HintWarning, match="cuts into the shaft: .* 290 mm from O, .* 300 mm; require"):
        report = found.report()
    assert report.loc["smallest cam_radius [m]", "after"] == pytest.approx(smallest, rel=1e-9)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ks.design.torque_free_cam(saw, cosine=4, gravity=False, shaft_radius=0.1).report()


@pytest.mark.slow
def test_torque_cam_keeps_clear_of_the_shaft():
    drive = ks.load_case("chain_unit").variants["rho-0.1"].scene
    given = {"mass": 0.3, "travel": 0.01, "shaft_radius": 0.2}
    clear = ks.design.torque_balancing_cam(drive, roller_radius=0.01, **given)
    assert clear.cam_radius.value == pytest.approx(0.21, rel=1e-9)
    assert "smallest distance from O 210 mm" in clear.report()
    assert "cuts into" not in clear.report()
    near = ks.design.torque_balancing_cam(drive, base_radius=0.1, **given)
    assert "the cam cuts into the shaft: the roller centre is at 100 mm from O" in near.report()


# Files and names

ROWS = "0, 1\n120, 2\n240, 3\n"


@every(
    "heading",
    [
        "Crank_Angle [deg], Force [kN]",
        "crank_angle (deg), force (kN)",
        "crank-angle [deg], force[kN]",
        "Crank angle (deg), FORCE [kN]",
        "  CRANK ANGLE  [ deg ] ,  force ( kN )",
    ],
)
def test_headings_that_differ_harmlessly_are_read(heading, tmp_path):
    path = tmp_path / "force.csv"
    path.write_text(f"{heading}\n{ROWS}")
    table = ks.Table.from_csv(path)
    assert list(table.y) == [1000.0, 2000.0, 3000.0]
    assert table.x == pytest.approx(np.radians([0.0, 120.0, 240.0]))


HEADINGS = {
    "angle [deg], force [kN]": "no column 'crank_angle'; .*; if 'angle' is meant, head it 'crank_angle \\[deg\\]'",
    "crank_angle [deg], forces (N)": "no column 'force'; .*; if 'forces' is meant, head it 'force \\[N\\]'",
    "crank_angle [deg], forces": "if 'forces' is meant, head it 'force \\[N\\]'",
    "crank_angle [deg], Force": "column 'Force': has no unit; head it for example \"force \\[N\\]\"",
    "crank_angle [deg], force (upward)": "column 'force \\(upward\\)': .*upward",
    "crank_angle [deg], Force [N], force (kN)": "fields|2 columns are 'force'",
}


@every("heading", HEADINGS)
def test_other_headings_are_refused_with_what_to_write(heading, tmp_path):
    path = tmp_path / "force.csv"
    path.write_text(f"{heading}\n{ROWS if heading.count(',') < 2 else ROWS.replace(chr(10), ', 1' + chr(10))}")
    with pytest.raises(ks.CaseError, match=HEADINGS[heading]):
        ks.Table.from_csv(path)


FORMS = ["NFC", "NFD"]
CASE = """
title = "saw"
reference = "plain"
[common]
crank_speed = "60 rpm"
coupler_length = "2 m"
slider = { mass = "600 kg" }
[variants.plain]
mechanism = "crank-slider"
crank_length = "0.3 m"
[variants."schwerer Käfig"]
mechanism = "crank-slider"
crank_length = "0.3 m"
process_force = { table = "Kräfte.csv" }
"""


@pytest.fixture
def cage(tmp_path):
    """Function that writes a case and its table, each in a Unicode form; of the case's path in another form."""

    def written(form, of_files, asked):
        folder = tmp_path / (form + of_files + asked)
        folder.mkdir()
        (folder / unicodedata.normalize(of_files, "Käfig.toml")).write_text(unicodedata.normalize(form, CASE), "utf-8")
        (folder / unicodedata.normalize(of_files, "Kräfte.csv")).write_text("crank_angle [deg], force [N]\n" + ROWS)
        return folder / unicodedata.normalize(asked, "Käfig.toml"), unicodedata.normalize(asked, "schwerer Käfig")

    return written


@every("form", FORMS)
@every("of_files", FORMS)
@every("asked", FORMS)
def test_names_are_found_in_every_unicode_form(cage, form, of_files, asked):
    path, name = cage(form, of_files, asked)
    case = ks.load_case(path)
    assert name in case.variants
    assert case.variant(name) is case.variants[name]
    assert case.solve(name, 4).shape == (4,)
    assert len(case.files) == 2
    assert all(file.is_file() for file in case.files)


def test_a_command_finds_names_in_another_unicode_form(cage, capsys):
    path, name = cage("NFC", "NFC", "NFD")
    assert main(["explain", str(path), "--variant", name, "--angle", "0 deg"]) == 0
    assert "saw: variant schwerer K\u00e4fig" in capsys.readouterr().out


def test_names_that_are_not_there_are_still_refused(cage):
    with pytest.raises(ks.CaseError, match="variant is 'schwerer Kafig'"):
        ks.load_case(cage("NFC", "NFC", "NFC")[0]).variant("schwerer Kafig")


full = pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")


@pytest.mark.slow
@full
@every(
    "arguments",
    [
        ["run", "compressor", "--variant", "unloaded", "--angles", "8", "--csv", "/dev/full"],
        ["explain", "compressor", "--angle", "0 deg", "--out", "{}/full.txt"],
    ],
    ids=" ".join,
)
def test_a_full_disk_is_told_with_the_file(arguments, tmp_path, capsys):
    if not (tmp_path / "full.txt").is_symlink():
        (tmp_path / "full.txt").symlink_to("/dev/full")
    arguments = [text.format(tmp_path) for text in arguments]
    assert main(arguments) == 2
    assert capsys.readouterr().err == f"kinetostatics: {arguments[-1]} cannot be written: No space left on device\n"


@full
def test_full_disk_names_the_file_in_python(tmp_path):
    (tmp_path / "cam.svg").symlink_to("/dev/full")
    with pytest.raises(ks.FileError, match=r"cam.svg cannot be written: No space left on device"):
        CAM.groups[0].cam.export(tmp_path / "cam.svg", roller_radius=0.05)


@full
@pytest.mark.slow
def test_a_full_standard_output_is_told():
    command = [sys.executable, "-m", "kinetostatics", "list"]
    with open("/dev/full", "w") as stream:  # noqa: PTH123
        done = subprocess.run(command, stdout=stream, stderr=subprocess.PIPE, text=True, check=False, env=os.environ)
    assert (done.returncode, done.stderr) == (2, "kinetostatics: standard output: No space left on device\n")
