"""Case files of chains and loads: what they give, beside the same scene built in Python."""

import pickle
import shutil

import numpy as np
import pytest

import kinetostatics as ks
from support.case_chains import BY_TRAVEL, EXAMPLES, IN_PYTHON, LOADS, PUMP, agree, rpm
from support.case_files import case_file, problems
from support.every import every


@pytest.mark.slow
@pytest.mark.parametrize("name", IN_PYTHON)
def test_chains_of_each_group_equal_python(name):
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    variant = case.variant(case.reference)
    agree(variant.scene, IN_PYTHON[name]())
    assert variant.mechanism.name == IN_PYTHON[name]().mechanism.name


def test_a_chain_is_swept_and_its_tolerances_are_read(tmp_path):
    shutil.copy(EXAMPLES / "rocker.toml", tmp_path)
    path = tmp_path / "rocker.toml"
    spreads = '[tolerances]\n"coupler_length2" = "normal 500 mm +- 1 mm"\n"force.value" = "4.9..5.1 kN"\n'
    path.write_text(path.read_text(encoding="utf-8") + spreads, encoding="utf-8")
    case = ks.load_case(path)
    designs = ks.designs.grid({"force.value": "1..10 kN:3", "pin_C.along": "0.19..0.21 m:2"})
    found = ks.sweep(case, designs, ["largest D"], angles=24)
    wanted = ks.sweep(case.variant("press").scene, designs, ["largest D"], angles=24)
    np.testing.assert_array_equal(found["largest D [N]"], wanted["largest D [N]"])
    assert len(set(found["largest D [N]"])) == 6


@pytest.mark.slow
@every("name", IN_PYTHON)
def test_a_case_varies_in_other_processes(name):
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    sent, variant = pickle.loads(pickle.dumps(case)).variant(case.reference), case.variant(case.reference)
    values = {"crank_speed": 2.0, "gravity.acceleration": 9.0} if variant.table.gravity else {"crank_speed": 2.0}
    assert sent.varied(values).scene.parameters == variant.varied(values).scene.parameters
    assert sent.content == variant.content


def test_a_sampled_cam_stands_in_a_chain(tmp_path):
    degrees = np.arange(0, 360, 5)
    radius = ks.cams.Circle(0.3, (-0.02, 0.0)).radius(np.radians(degrees))[0]
    rows = "\n".join(f"{a},{1000 * r!r}" for a, r in zip(degrees.tolist(), radius.tolist(), strict=True))
    (tmp_path / "cam.csv").write_text(f"angle [deg], radius [mm]\n{rows}\n", encoding="utf-8")
    text = (EXAMPLES / "cam_roller.toml").read_text(encoding="utf-8")
    text = text.replace(
        '{ kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }', '{ kind = "sampled", table = "CAM" }'
    )
    variant = ks.load_case(case_file(tmp_path, text.replace("CAM", "cam.csv"))).variant("cam")
    assert variant.files == [tmp_path / "cam.csv"]
    cam = ks.cams.Sampled(np.radians(degrees), radius)
    np.testing.assert_allclose(variant.mechanism.groups[0].cam.polar(1.0, (1.0, 0.0)), cam.polar(1.0, (1.0, 0.0)))
    (found,) = problems(tmp_path, text.replace("CAM", "none.csv"))
    assert found.startswith(f"variants.cam.groups[1].cam: {tmp_path / 'none.csv'}: cannot be read")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:sampled cam. 360 points")
def test_noise_of_a_measured_cam_has_a_unit(tmp_path):
    degrees = np.arange(360)
    radius = np.round(ks.cams.Circle(0.3, (-0.02, 0.0)).radius(np.radians(degrees))[0], 6)
    rows = "\n".join(f"{a},{1000 * r!r}" for a, r in zip(degrees.tolist(), radius.tolist(), strict=True))
    (tmp_path / "cam.csv").write_text(f"angle [deg], radius [mm]\n{rows}\n", encoding="utf-8")
    text = (EXAMPLES / "cam_roller.toml").read_text(encoding="utf-8")
    law = '{ kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }'
    measured = '{ kind = "sampled", table = "cam.csv", noise = "0.29 um" }'
    variant = ks.load_case(case_file(tmp_path, text.replace(law, measured))).variant("cam")
    assert variant.mechanism.groups[0].cam.smoothing == pytest.approx(0.29e-6)
    assert variant.mechanism.groups[0].cam.force_error < 1e-3
    (found,) = problems(tmp_path, text.replace(law, measured.replace("0.29 um", "0 um")))
    assert "noise" in found
    assert "must be greater than 0" in found
    with pytest.warns(UserWarning, match=r"less than the 2\.75e-07 m by which the radius values scatter"):
        ks.load_case(case_file(tmp_path, text.replace(law, measured.replace("0.29", "0.09")))).variant("cam")


@pytest.mark.slow
def test_a_chain_is_balanced_by_a_counterweight(tmp_path):
    shutil.copy(EXAMPLES / "indicator.csv", tmp_path)
    text = (EXAMPLES / "slider.toml").read_text(encoding="utf-8")
    text += '[variants.balanced.balancing]\nmethod = "optimal"\ncrank = { arm = "-50 mm" }\n'
    case = ks.load_case(case_file(tmp_path, text))
    wanted = ks.balancing.optimal(case.variant("plain").mechanism, crank=ks.balancing.Counterweight(arm=-0.05))
    assert case.variant("balanced").mechanism.links["crank"].mass == wanted.mechanism.links["crank"].mass


def test_content_key_is_stable_and_sees_file_changes(tmp_path):
    for name in ("slider.toml", "indicator.csv"):
        shutil.copy(EXAMPLES / name, tmp_path)
    first = ks.load_case(EXAMPLES / "slider.toml").variant("plain").content
    assert ks.load_case(tmp_path / "slider.toml").variant("plain").content == first
    table = tmp_path / "indicator.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("12, 4", "12, 5"), encoding="utf-8")
    assert ks.load_case(tmp_path / "slider.toml").variant("plain").content != first


# Builders


@pytest.mark.slow
def test_slotted_lever_and_scotch_yoke_have_own_keys(tmp_path):
    text = """
title = "words"
reference = "lever"
[common]
crank_speed = "60 rpm"
crank_length = "0.1 m"
crank = { mass = "1 kg", centre = "mid-length" }
[variants.lever]
mechanism = "slotted-lever"
lever_pivot = ["0 m", "-0.2 m"]
slot_offset = "10 mm"
lever = { mass = "8 kg", centre = "0.3 m", inertia = "0.4 kg m^2" }
block = { mass = "1 kg" }
[[variants.lever.loads]]
kind = "torque"
value = "-30 N m"
on = "lever"
[variants.yoke]
mechanism = "scotch-yoke"
guide_angle = "30 deg"
slot_angle = "70 deg"
slider = { mass = "2 kg" }
block = { mass = "0.5 kg" }
process_force = { force = "-100 N" }
"""
    case, crank = ks.load_case(case_file(tmp_path, text)), ks.Link(1.0, 0.05)
    lever, block = ks.Link(8.0, 0.3, 0.4), ks.Link(1.0)
    shaper = ks.slotted_lever(0.1, pivot=(0.0, -0.2), offset=0.01, crank=crank, lever=lever, block=block)
    agree(case.variant("lever").scene, ks.Scene(shaper, rpm(60), loads=ks.Torque(-30.0, on="lever")))
    angles = {"guide_angle": np.radians(30.0), "slot_angle": np.radians(70.0)}
    yoke = ks.scotch_yoke(0.1, **angles, crank=crank, slider=ks.Link(2.0), block=ks.Link(0.5))
    agree(case.variant("yoke").scene, ks.Scene(yoke, rpm(60), loads=ks.ProcessForce(-100.0)))
    assert {"lever_pivot.y", "slot_offset", "torque.value"} <= case.variant("lever").units.keys()


@pytest.mark.parametrize("word", ["open", "crossed"])
def test_assembly_words_keep_a_parallelogram(tmp_path, word):
    text = f"""
title = "parallelogram"
reference = "bars"
[variants.bars]
mechanism = "four-bar"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
rocker_length = "0.1 m"
rocker_pivot = ["0.4 m", "0 m"]
assembly = "{word}"
coupler = {{ mass = "2 kg", centre = "mid-length" }}
"""
    found = ks.load_case(case_file(tmp_path, text)).variant("bars").scene
    bars = ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0.0), assembly=word, coupler=ks.Link(2.0, 0.2))
    assert found.mechanism.change_points == bars.change_points
    turn = np.linspace(0.1, 3.0, 7)
    np.testing.assert_array_equal(found.solve(turn).position("B"), ks.solve(bars, turn, crank_speed=1.0).position("B"))


def test_process_force_table_takes_indicator_diagram(tmp_path):
    (tmp_path / "t.csv").write_text(BY_TRAVEL.format("pressure [MPa]", "pressure_back [MPa]"), encoding="utf-8")
    text = PUMP + 'process_force = { force = { file = "t.csv", area = "-10 cm^2" } }\n'
    variant = ks.load_case(case_file(tmp_path, text)).variant("loaded")
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60), loads=LOADS["indicator diagram"][2]))


AFTER_TDC = "crank_angle [deg], pressure [bar]\n0, 20\n15, 40\n90, 5\n180, 0\n270, 2\n"


@pytest.mark.slow
@every(
    ("keys", "options"),
    [
        ('zero = "TDC"', {"zero": "TDC"}),
        ('zero = "TDC", sense = -1', {"zero": "TDC", "sense": -1}),
        ('zero = "BDC", slider = "slider"', {"zero": "BDC", "slider": "slider"}),
        ('zero = "90 deg", sense = 1', {"zero": np.pi / 2}),
    ],
)
def test_the_table_of_a_process_force_has_a_zero_and_a_sense(tmp_path, keys, options):
    angles, pressures = np.radians([0.0, 15.0, 90.0, 180.0, 270.0]), np.array([20.0, 40.0, 5.0, 0.0, 2.0])
    (tmp_path / "t.csv").write_text(AFTER_TDC, encoding="utf-8")
    text = PUMP + f'process_force = {{ force = {{ file = "t.csv", area = "-10 cm^2", {keys} }} }}\n'
    text = text.replace("60 rpm", f"{60 * options.get('sense', 1)} rpm")
    variant = ks.load_case(case_file(tmp_path, text)).variant("loaded")
    gas = ks.ProcessForce(ks.Table(angles, -100.0 * pressures, **options))
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60 * options.get("sense", 1)), loads=gas))


@every(
    ("keys", "message"),
    [
        ('zero = "OT"', "zero must be text of a number and a unit"),
        ('zero = "OT"', 'or write "TDC" or "BDC"'),
        ("sense = 2", "sense must be 1 or -1, found 2"),
    ],
)
def test_what_is_no_zero_or_sense_is_named(tmp_path, keys, message):
    (tmp_path / "t.csv").write_text(AFTER_TDC, encoding="utf-8")
    text = PUMP + f'process_force = {{ force = {{ file = "t.csv", area = "-10 cm^2", {keys} }} }}\n'
    (problem,) = problems(tmp_path, text)
    assert problem.startswith("variants.loaded.process_force.force.")
    assert message in problem


@pytest.mark.parametrize(
    "text",
    [
        'process_force = { force = "-2 kN", reaction = "frame" }',
        '[[variants.loaded.loads]]\nkind = "process force"\nforce = "-2 kN"\nreaction = "frame"',
    ],
)
def test_the_frame_takes_a_process_force(tmp_path, text):
    found = ks.load_case(case_file(tmp_path, PUMP + text)).variant("loaded").scene
    assert found.loads[-1].reaction == "frame"
    force = found.solve(4).ground["process_force"].force
    along = found.mechanism.guides["slider"].direction
    np.testing.assert_allclose(force, np.outer(along, np.full(4, 2e3)), atol=1e-10)
    key = "variants.loaded.process_force.reaction" if "[[" not in text else "variants.loaded.loads[1].reaction"
    (problem,) = problems(tmp_path, PUMP + text.replace('"frame"', '"fram"'))
    assert problem.startswith(key)
    assert "allowed: 'outside', 'frame'; did you mean 'frame'?" in problem


def test_loads_of_a_variant_replace_common_ones(tmp_path):
    common = '[common]\n[[common.loads]]\nkind = "force"\nat = "B"\nvalue = "1 N"\n'
    text = PUMP + common + '[variants.free]\nmechanism = "crank-slider"\ncrank_speed = "1 rpm"\n'
    text += 'crank_length = "0.1 m"\ncoupler_length = "0.4 m"\nloads = []\n'
    case = ks.load_case(case_file(tmp_path, text))
    assert len(case.variant("loaded").loads) == 1
    assert case.variant("free").loads == ()
