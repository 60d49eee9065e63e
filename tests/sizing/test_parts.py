"""Parts by name: in case files, as outputs of sweeps and tolerance studies, as goals and limits of searches."""

import json

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.designs import write_found
from support.case_files import case_file, problems
from support.every import every

SCENE = ks.Scene(ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0)), 33.5)
PIN = ks.sizing.Part("pin_B", "pin", {"joint": "B", "diameter": 0.08, "width": 0.1})
BLOCK = ks.sizing.Part("block", "mount", {"mass": 30e3, "stiffness": 1e7, "damping": 0.1})
CASE = """
title = "Saw"
reference = "plain"
[common]
mechanism = "crank-slider"
crank_length = "300 mm"
coupler_length = "2 m"
crank_speed = "320 rpm"
coupler = { mass = "150 kg", centre = "mid-length", inertia = "20.5 kg m^2" }
[variants.plain]
slider = { mass = "600 kg" }
[variants.light]
slider = { mass = "400 kg" }
[sizing.pin_B]
kind = "pin"
joint = "B"
diameter = "80 mm"
width = "100 mm"
[sizing.block]
kind = "mount"
mass = "30 t"
inertia = "20000 kg m^2"
stiffness = ["10 MN/m", "12 MN/m", "5 MN m/rad"]
damping = [0.1, 0.1, 0.2]
centre = ["0 mm", "-500 mm"]
[sizing.rod]
kind = "bar"
link = "coupler"
area = "60 cm^2"
modulus = "300 cm^3"
masses = [["1 m", "88.5 kg"]]
second_moment = "8000 cm^4"
youngs_modulus = "206 GPa"
ultimate = "600 MPa"
endurance = "200 MPa"
yield_strength = "355 MPa"
"""


@pytest.fixture
def case(tmp_path):
    return ks.load_case(case_file(tmp_path, CASE))


def shear_stress(mass):
    """By the largest reaction at B, which is at dead centre: two planes of a pin of 80 mm."""
    saw = SCENE.varied({"slider.mass": mass}).solve(4)
    return ks.extremes(saw, "B").largest / (2.0 * np.pi / 4.0 * 0.08**2)


def test_a_sweep_has_a_column_of_the_number_of_a_part():
    designs = ks.designs.grid({"slider.mass": "400..600 kg:3"})
    outputs = ["largest O", PIN.number("shear_stress"), "rms balancing_torque"]
    table = ks.sweep(SCENE, designs, outputs, progress=False)
    assert list(table)[1:-1] == ["largest O [N]", "pin_B.shear_stress [Pa]", "rms balancing_torque [N m]"]
    assert np.allclose(table["pin_B.shear_stress [Pa]"], [*map(shear_stress, (400.0, 500.0, 600.0))], rtol=1e-12)
    plain = ks.sweep(SCENE, designs, outputs[::2], progress=False)
    assert (plain == table[list(plain)]).all(axis=None)


def test_a_ratio_is_of_the_references_number():
    designs = ks.designs.grid({"slider.mass": "400..600 kg:2"})
    table = ks.sweep(SCENE, designs, [PIN.number("largest_load", ratio=True)], reference=SCENE, progress=False)
    assert table.columns[1] == "ratio pin_B.largest_load [1]"
    assert np.allclose(table.iloc[:, 1], 1.0, rtol=1e-12)  # the reference varies too


def test_a_design_that_cannot_be_built_has_a_reason_and_the_others_numbers():
    designs = ks.designs.grid({"coupler_length": "0.2..2 m:2"})
    table = ks.sweep(SCENE, designs, [PIN.number("shear_stress")], progress=False)
    assert "cannot be assembled" in table["failed"][0]
    assert np.isnan(table.iloc[0, 1])
    assert table["failed"][1] == ""
    assert np.isfinite(table.iloc[1, 1])


def test_an_error_of_the_part_is_raised_before_the_sweep():
    wrong = ks.sizing.Part("pin", "pin", {"joint": "Z", "diameter": 0.08, "width": 0.1})
    with pytest.raises(ks.QuantityError, match="Z"):
        ks.sweep(SCENE, ks.designs.grid({"slider.mass": "400..600 kg:2"}), [wrong.number("shear_stress")])


@pytest.mark.slow
def test_processes_and_a_folder_give_the_same(tmp_path):
    designs = ks.designs.grid({"slider.mass": "400..600 kg:4"})
    outputs = [PIN.number("shear_stress"), BLOCK.number("v_rms")]
    here = ks.sweep(SCENE, designs, outputs, progress=False)
    there = ks.sweep(SCENE, designs, outputs, workers=2, chunk=2, folder=tmp_path / "kept", progress=False)
    assert (here == there).all(axis=None)
    other = ks.sizing.Part("pin_B", "pin", {"joint": "A", "diameter": 0.08, "width": 0.1})
    with pytest.raises(ks.ParameterError, match="another sweep"):
        ks.sweep(SCENE, designs, [other.number("shear_stress"), outputs[1]], chunk=2, folder=tmp_path / "kept")


@pytest.mark.slow
def test_a_tolerance_study_spreads_the_number_of_a_part():
    output = PIN.number("shear_stress")
    found = ks.tolerances(SCENE, [output], {"slider.mass": "500..600 kg"}, count=8, progress=False)
    stress = found.table["pin_B.shear_stress [Pa]"]
    assert np.allclose(stress, [*map(shear_stress, found.table["slider.mass [kg]"])], rtol=1e-12)
    assert found.share(output, above=0.0) == 1.0


def test_a_search_keeps_a_limit_of_a_part_and_finds_the_best():
    limit = PIN.limit("shear_stress <= 20 MPa")
    found = ks.design.optimise(SCENE, {"slider.mass": (400.0, 600.0)}, maximise="largest O", limits=[limit])
    assert np.isclose(shear_stress(found.values["slider.mass"]), 20e6, rtol=1e-8)
    assert "pin_B.shear_stress [Pa]" in found.report().index


def test_a_search_makes_the_number_of_a_part_least():
    output = PIN.number("shear_stress")
    found = ks.design.optimise(SCENE, {"crank_speed": (30.0, 33.0)}, output)
    assert np.isclose(found.values["crank_speed"], 30.0)


def test_robust_searches_refuse_numbers_of_parts():
    spread = ks.design.Spread(0.9, {"slider.mass": "normal 0 % +- 1 %"})
    with pytest.raises(ks.ParameterError, match="has no quantile; use it as a limit"):
        ks.design.optimise(SCENE, {"slider.mass": (400.0, 600.0)}, PIN.number("shear_stress"), robust=spread)


@pytest.mark.slow
def test_a_case_has_the_parts_of_its_file(case):
    table = case.sizing_table()
    assert np.isclose(table.loc[("pin_B", "shear_stress"), "plain"], shear_stress_at_320(case), rtol=1e-12)
    assert table.loc[("block", "mass"), "light"] == 30e3
    assert table.loc[("rod", "slenderness"), "unit"] == "1"
    direct = case.sizing["block"].of(case.solve("plain"))
    assert table.loc[("block", "v_rms_turn"), "plain"] == direct.v_rms_turn


def shear_stress_at_320(case):
    return ks.extremes(case.solve("plain"), "B").largest / (2.0 * np.pi / 4.0 * 0.08**2)


@pytest.mark.slow
def test_a_part_that_fails_with_a_variant_leaves_the_others(tmp_path):
    text = CASE.replace('masses = [["1 m", "88.5 kg"]]', 'masses = [["1 m", "150 kg"]]')
    table = ks.load_case(case_file(tmp_path, text)).sizing_table(["plain"])
    assert np.isnan(table.loc[("rod", "largest_stress"), "plain"])
    assert np.isfinite(table.loc[("pin_B", "shear_stress"), "plain"])
    assert any(note.startswith("plain: ") and "inertia" in note for note in table.attrs["notes"]["rod"])


@pytest.mark.slow
def test_a_limit_in_hours_is_kept_in_hours():
    bearing = ks.sizing.Part("main", "bearing", {"joint": "O", "capacity": 1e6, "static_capacity": 1e6})
    assert bearing.limit("life_hours >= 20000 h").value == 20000.0
    assert bearing.limit("life_hours >= 1 day").value == 24.0
    assert str(bearing.limit("life_hours >= 20000 h")) == "main.life_hours >= 20000 h"
    vary = {"slider.mass": (400.0, 600.0)}
    with pytest.warns(ks.HintWarning):
        hours = bearing.of(SCENE.varied({"slider.mass": 500.0}).solve(4)).life_hours
    found = ks.design.optimise(SCENE, vary, maximise="largest O", limits=[bearing.limit(f"life_hours >= {hours!r} h")])
    assert np.isclose(found.values["slider.mass"], 500.0, rtol=1e-6)


def test_earles_and_wus_rate_is_limited_by_a_plain_number():
    play = ks.sizing.Part("play", "play", {"joint": "B", "clearance": 1e-4})
    assert play.limit("earles_wu <= 5").value == 5.0


@pytest.mark.slow
def test_the_command_line_sweeps_numbers_of_parts(tmp_path, capsys):
    from kinetostatics.cli import main

    path = str(case_file(tmp_path, CASE))
    main(["sweep", path, "--vary", "slider.mass=400..600 kg:2", "--output", "pin_B.shear_stress", "--csv"])
    header, *rows = capsys.readouterr().out.splitlines()
    assert header == "slider.mass [kg],pin_B.shear_stress [Pa],failed"
    assert len(rows) == 2
    main(["sweep", path, "--vary", "slider.mass=400..600 kg:2", "--output", "pinB.shear_stress"])
    assert "part is 'pinB'" in capsys.readouterr().err


@pytest.mark.slow
def test_designs_of_a_case_may_limit_its_parts(tmp_path):
    design = """
[design.best]
kind = "optimum"
variant = "plain"
vary = { "slider.mass" = ["400 kg", "600 kg"] }
maximise = "largest O"
limits = ["pin_B.shear_stress <= 20 MPa"]
"""
    case = ks.load_case(case_file(tmp_path, CASE + design))
    found = case.designs["best"].find()
    assert np.isclose(PIN.of(found.scene.solve(4)).shear_stress, 20e6, rtol=1e-8)
    written = ks.load_case(write_found(tmp_path / "found.toml", case, {"best": found}))
    assert written.sizing == case.sizing
    assert np.isclose(written.sizing_table(["best"]).loc[("pin_B", "shear_stress"), "best"], 20e6, rtol=1e-8)


def test_the_roller_of_a_cam_is_a_bearing_of_a_case(tmp_path):
    text = CASE.replace("crank-slider", "cam-crank-slider").replace(
        'crank_length = "300 mm"', 'cam = { kind = "circle", radius = "300 mm" }'
    )
    text = text[: text.index("[sizing.pin_B]")]
    roller = '[sizing.roller]\nkind = "bearing"\njoint = "roller"\ncapacity = "1 MN"\nstatic_capacity = "1 MN"\n'
    assert ks.load_case(case_file(tmp_path, text + roller)).sizing["roller"].options["joint"] == "roller"
    (problem,) = problems(tmp_path, text + roller.replace('joint = "roller"', 'joint = "rollers"'))
    assert "did you mean 'roller'" in problem


WRONG = {
    "no kind": ('kind = "pin"', "", "sizing.pin_B.kind is missing; allowed: "),
    "unknown kind": ('kind = "pin"', 'kind = "pinn"', "sizing.pin_B.kind is 'pinn'"),
    "list of kinds": ('kind = "pin"', 'kind = ["pin"]', "sizing.pin_B.kind is ['pin'], allowed: 'bearing'"),
    "unknown key": ('width = "100 mm"', 'width = "100 mm"\nwide = "1 m"', "sizing.pin_B: option is 'wide'"),
    "missing key": ('width = "100 mm"', "", "sizing.pin_B: width is missing"),
    "no unit": ('width = "100 mm"', "width = 100", "sizing.pin_B.width must be a text with a unit"),
    "other unit": ('width = "100 mm"', 'width = "100 kg"', "sizing.pin_B.width"),
    "unit in a list": ('"12 MN/m"', '"12 MN"', "sizing.block.stiffness"),
    "unknown joint": ('joint = "B"', 'joint = "Q"', "sizing.pin_B.joint is 'Q'"),
    "unknown link": ('link = "coupler"', 'link = "rocker"', "sizing.rod.link is 'rocker'"),
    "negative": ('area = "60 cm^2"', 'area = "-60 cm^2"', "sizing.rod.area must be greater than 0, got -0.006"),
    "negative in a list": ('"12 MN/m"', '"-12 MN/m"', "sizing.block.stiffness must be greater than 0"),
    "too many numbers": ('"5 MN m/rad"]', '"5 MN m/rad", "5 MN m/rad"]', "at most 3 numbers, found 4"),
    "text in place of a ratio": ("damping = [0.1, 0.1, 0.2]", 'damping = "0.1 1"', "sizing.block.damping"),
    "unit of a point mass": ('"88.5 kg"', '"88.5 m"', "sizing.rod.masses"),
}


@pytest.mark.slow
@every("name", WRONG)
def test_a_wrong_table_is_named_with_its_key(name, tmp_path):
    before, after, told = WRONG[name]
    assert before in CASE
    (problem,) = problems(tmp_path, CASE.replace(before, after, 1))
    assert told in problem


BAD = {
    "kind": (("pin", "screw", {}), "kind is 'screw'"),
    "option": (("pin", "pin", {"joint": "B", "diameter": 0.1, "width": 0.1, "colour": 1}), "option is 'colour'"),
    "options": (("pin", "pin", None), "options must be a dict"),
    "missing": (("pin", "pin", {"joint": "B"}), "diameter is missing\n  width is missing"),
}


@every("name", BAD)
def test_a_wrong_part_is_refused(name):
    given, told = BAD[name]
    with pytest.raises(ks.ParameterError) as caught:
        ks.sizing.Part(*given)
    assert all(line.strip() in str(caught.value) for line in told.split("\n"))


def test_a_part_has_no_other_numbers():
    with pytest.raises(ks.ParameterError, match="shear_stress"):
        PIN.number("shear")
    with pytest.raises(ks.ParameterError, match="number is 'hours'"):
        PIN.limit("hours >= 10 h")


@pytest.mark.slow
def test_run_prints_the_parts(tmp_path, capsys):
    from kinetostatics.cli import main

    path = str(case_file(tmp_path, CASE))
    main(["run", path])
    printed = capsys.readouterr().out
    assert "pin_B: pin" in printed
    assert "shear_stress" in printed
    main(["run", path, "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["sizing"]["plain"]["block"]["mass"] == {"value": 30e3, "unit": "kg"}


@pytest.mark.slow
def test_a_report_has_the_parts(tmp_path):
    pytest.importorskip("jinja2")
    path = ks.report(case_file(tmp_path, CASE), tmp_path / "saw.html")
    text = path.read_text(encoding="utf-8")
    assert "From forces to parts" in text
    assert "pin_B: pin" in text
