"""Case files of chains and loads: what they give, beside the same scene built in Python."""

import pickle
import shutil
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import case_file, problems

EXAMPLES = Path(__file__).parent / "examples"


def rpm(number):
    return number * np.pi / 30


def v_engine():
    rod = {"coupler_length": 0.15, "slider": ks.Link(0.5)}
    groups = (
        ks.SliderGroup(
            0.15,
            ks.Guide.at(np.pi / 4, 0.002),
            coupler=ks.Link(0.6, 0.075, 0.002),
            slider=ks.Link(0.5, (0.01, 0.001)),
        ),
        ks.SliderGroup(
            guide=ks.Guide.through((0.0, 0.0), (-1.0, 1.0)),
            assembly="open",
            pin="D",
            label="2",
            coupler=ks.Link(0.6, (0.05, -0.001), 0.002),
            **rod,
        ),
    )
    engine = ks.Mechanism("V-90 engine", ks.Crank(0.04, ks.Link(3.0, (-0.008, 0.001), 0.01)), groups)
    forward, back = -200.0 * np.array([30.0, 12.0, 5.0, 2.0]), -200.0 * np.array([10.0, 4.0, 1.5, 1.0])
    gas = ks.Table([0.105, 0.12, 0.15, 0.195], forward, over="travel", back=back)
    return ks.Scene(engine, rpm(1500), loads=(ks.Gravity(9.8), ks.ProcessForce(gas, on="slider2")))


def six_bar():
    groups = (
        ks.RockerGroup(
            0.4,
            0.3,
            (0.35, 0.1),
            "crossed",
            ks.Link(4.0, 0.2, 0.05),
            ks.Link(3.0, 0.15, 0.02),
            pivot_name="Q",
        ),
        ks.Pin(on="coupler", at=(0.2, -0.05), name="C"),
        ks.SliderGroup(
            0.5,
            ks.Guide.at(-np.pi / 2, 0.1),
            coupler=ks.Link(2.0, 0.25, 0.04),
            slider=ks.Link(12.0),
            on="C",
            pin="D",
            label="2",
        ),
    )
    loads = ks.Force(5000.0, at="D", direction=np.pi / 2)
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(90), 2.0, loads)


def shaper():
    groups = (
        ks.LeverGroup((0.0, -0.25), offset=0.005, lever=ks.Link(8.0, 0.3, 0.4), block=ks.Link(1.0)),
        ks.Pin(on="lever", at=(0.6, 0.0), name="C"),
        ks.SliderGroup(0.3, ks.Guide.at(0.0, 0.32), assembly=-1, on="C", slider=ks.Link(20.0)),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(30), loads=ks.ProcessForce(-2000.0))


def oscillating_engine():
    group = ks.CylinderGroup(
        (0.0, -0.4), rod=ks.Link(1.0, 0.1, 0.01), cylinder=ks.Link(5.0, (0.05, 0.01), 0.1), pivot_name="P"
    )
    loads = ks.PointForce(3000.0, between=("A", "P"))
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), (group,)), rpm(120), loads=loads)


def pump():
    guide = ks.Guide.at(np.radians(10.0), -0.003)
    group = ks.YokeGroup(guide, np.radians(80.0), slider=ks.Link(2.0), block=ks.Link(0.3))
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.05), (group,)), rpm(200))


def watt():
    groups = (
        ks.RockerGroup(0.4, 0.3, (0.35, 0.1)),
        ks.Pin(on="coupler", at=(0.2, 0.2), name="E"),
        ks.Pin(on="rocker", at=(0.35, -0.1), name="F"),
        ks.Dyad(
            0.35,
            0.3,
            on=("E", "F"),
            pin="G",
            assembly=-1,
            dyad1=ks.Link(1.0, 0.175),
            dyad2=ks.Link(1.5, 0.15, 0.01),
            label="W",
        ),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.1), groups), rpm(60))


def in_line_engine():
    guide, slider = ks.Guide.at(0.0), ks.Link(0.5)
    groups = (
        ks.SliderGroup(0.15, guide, slider=slider),
        ks.Pin(on="crank", at=(-0.04, 0.0), name="C"),
        ks.SliderGroup(0.15, guide, on="C", pin="D", label="2", slider=slider),
    )
    return ks.Scene(ks.Mechanism("chain", ks.Crank(0.04), groups), rpm(1500))


def cam_chain():
    law, length = ks.cams.CosineLaw(0.3, 2.0, np.radians(20.0)), 2.0219051771
    groups = (
        ks.CamRoller(law, ks.Link(20.0, -0.01)),
        ks.SliderGroup(
            length,
            ks.Guide.at(np.radians(20.0)),
            coupler=ks.Link(150.0, length / 2, 20.5),
            slider=ks.Link(600.0),
        ),
    )
    spring = ks.Spring.balancing(600.0, rpm(320), 2.0)
    return ks.Scene(ks.Mechanism("chain", ks.Crank(None, ks.Link(3.0)), groups), rpm(320), loads=spring)


IN_PYTHON = {
    "slider": v_engine,
    "rocker": six_bar,
    "lever": shaper,
    "cylinder": oscillating_engine,
    "yoke": pump,
    "dyad": watt,
    "pin": in_line_engine,
    "cam_roller": cam_chain,
}


def agree(found, wanted, angles=12):
    """Two scenes have the same parameters and results."""
    for path, number in wanted.parameters.items():
        assert found.parameters[path] == pytest.approx(number, rel=1e-14), path
    table, expected = found.solve(angles).frame(), wanted.solve(angles).frame()
    assert list(table.columns) == list(expected.columns)
    for name, column in expected.items():
        largest = max(
            np.abs(other).max() for key, other in expected.items() if key.split(" [")[1] == name.split(" [")[1]
        )
        np.testing.assert_allclose(table[name], column, rtol=1e-12, atol=1e-12 * largest, err_msg=name)


@pytest.mark.parametrize("name", IN_PYTHON)
def test_a_chain_of_each_kind_of_group_is_the_one_built_in_python(name):
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    variant = case.variant(case.reference)
    agree(variant.scene, IN_PYTHON[name]())
    assert variant.mechanism.name == IN_PYTHON[name]().mechanism.name


@pytest.mark.parametrize("name", IN_PYTHON)
def test_numbers_of_a_chain_are_called_as_in_scenes_and_vary_as_there(name):
    """But for what the file derives of others: centres at mid-length, a spring that balances, a law's guide."""
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    variant = case.variant(case.reference)
    scene, derived = variant.scene, {path for path, value in variant.parameters.items() if not isinstance(value, float)}
    units = variant.units
    absent = {path for path in units if variant.parameters[path] is None} - scene.units.keys()
    assert absent <= {"crank_length"}
    assert {path for path in units if path.rpartition(".")[2] != "centre"} - absent <= scene.units.keys()
    for path in units.keys() - derived - {"crank_length"}:
        assert units[path] == scene.units[path].replace("**", "^").replace("*", " "), path
        assert variant.parameters[path] == scene.parameters[path], path
        follows = path.startswith(("coupler_length", "rocker_length", "dyad")) or path in ("crank_speed", "slider.mass")
        if not follows and not path.startswith("guide"):
            value = variant.parameters[path] * 1.001
            assert variant.varied({path: value}).scene.parameters == scene.varied({path: value}).parameters, path


def test_centres_at_mid_length_follow_lengths_that_vary():
    variant = ks.load_case(EXAMPLES / "dyad.toml").variant("watt")
    lengths = np.array([[0.35], [0.36]])
    varied = variant.varied({"dyad1_lengthW": lengths}).scene.parameters
    np.testing.assert_array_equal(varied["dyad1W.centre.along"], lengths / 2)
    assert varied["dyad2W.centre.along"] == 0.15


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


def test_a_varied_variant_keeps_what_it_read_from_files():
    variant = ks.load_case(EXAMPLES / "slider.toml").variant("plain")
    assert [path.name for path in variant.files] == ["indicator.csv"]
    (before,) = (item for item in variant.loads if isinstance(item, ks.ProcessForce))
    (after,) = (item for item in variant.varied({"slider.mass": 1.0}).loads if isinstance(item, ks.ProcessForce))
    assert after.force is before.force


@pytest.mark.parametrize("name", IN_PYTHON)
def test_a_case_goes_to_other_processes_and_varies_there(name):
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


@pytest.mark.filterwarnings("ignore:sampled cam. 360 points")
def test_the_noise_of_a_measured_cam_is_stated_with_its_unit(tmp_path):
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


def test_a_chain_is_balanced_by_a_counterweight(tmp_path):
    shutil.copy(EXAMPLES / "indicator.csv", tmp_path)
    text = (EXAMPLES / "slider.toml").read_text(encoding="utf-8")
    text += '[variants.balanced.balancing]\nmethod = "optimal"\ncrank = { arm = "-50 mm" }\n'
    case = ks.load_case(case_file(tmp_path, text))
    wanted = ks.balancing.optimal(case.variant("plain").mechanism, crank=ks.balancing.Counterweight(arm=-0.05))
    assert case.variant("balanced").mechanism.links["crank"].mass == wanted.mechanism.links["crank"].mass


def test_content_tells_files_of_other_values_and_is_the_same_in_every_session(tmp_path):
    for name in ("slider.toml", "indicator.csv"):
        shutil.copy(EXAMPLES / name, tmp_path)
    first = ks.load_case(EXAMPLES / "slider.toml").variant("plain").content
    assert ks.load_case(tmp_path / "slider.toml").variant("plain").content == first
    table = tmp_path / "indicator.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("12, 4", "12, 5"), encoding="utf-8")
    assert ks.load_case(tmp_path / "slider.toml").variant("plain").content != first


# Builders


def test_slotted_lever_and_scotch_yoke_have_words_of_their_own(tmp_path):
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
def test_a_parallelogram_stays_one_by_its_assembly_in_words(tmp_path, word):
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


# Loads

FOUR_BAR = """
title = "loads"
reference = "loaded"
[variants.loaded]
mechanism = "four-bar"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
rocker_length = "0.3 m"
rocker_pivot = ["0.35 m", "0.1 m"]
coupler = { mass = "2 kg" }
"""
PUMP = """
title = "loads"
reference = "loaded"
[variants.loaded]
mechanism = "crank-slider"
crank_speed = "60 rpm"
crank_length = "0.1 m"
coupler_length = "0.4 m"
slider = { mass = "2 kg" }
"""
BY_ANGLE = "crank_angle [deg], {}\n0, 1\n90, 3\n180, 2\n270, 0\n"
BY_TRAVEL = "travel [mm], {0}, {1}\n300, 8, 2\n400, 4, 1\n500, 1, 0\n"
ANGLES, TRAVELS = np.radians([0.0, 90.0, 180.0, 270.0]), np.array([0.3, 0.4, 0.5])
LOADS = {
    "force at a joint": (FOUR_BAR, 'kind = "force"\nvalue = "2 kN"\nat = "B"', ks.Force(2000.0, at="B")),
    "force on a link, turning with another": (
        FOUR_BAR,
        'kind = "force"\nvalue = "2 kN"\nat = ["coupler", "50 cm", "-10 mm"]\ndirection = "30 deg"\nalong = "rocker"',
        ks.Force(2000.0, at=("coupler", 0.5, -0.01), direction=np.radians(30.0), along="rocker"),
    ),
    "force along a link": (
        FOUR_BAR,
        'kind = "force"\nvalue = "-9 N"\nat = ["coupler", "50 cm"]',
        ks.Force(-9.0, at=("coupler", 0.5)),
    ),
    "force by a table over the angle": (
        FOUR_BAR,
        'kind = "force"\nvalue = { file = "t.csv", period = "720 deg" }\nat = "B"',
        ks.Force(ks.Table(2 * ANGLES, [1e3, 3e3, 2e3, 0.0], period=4 * np.pi), at="B"),
        BY_ANGLE.format("force [kN]").replace("270", "540").replace("180", "360").replace("90", "180"),
    ),
    "point force": (
        FOUR_BAR,
        'kind = "point force"\nvalue = "5 kN"\nbetween = [["rocker", "0.1 m", "0 m"], ["0 m", "-0.2 m"]]',
        ks.PointForce(5e3, between=(("rocker", 0.1, 0.0), (0.0, -0.2))),
    ),
    "torque": (
        FOUR_BAR,
        'kind = "torque"\nvalue = "5 N m"\non = "rocker"\nagainst = "coupler"',
        ks.Torque(5.0, on="rocker", against="coupler"),
    ),
    "torque by a table": (
        FOUR_BAR,
        'kind = "torque"\nvalue = { file = "t.csv", over = "angle" }\non = "rocker"',
        ks.Torque(ks.Table(ANGLES, [1e3, 3e3, 2e3, 0.0]), on="rocker"),
        BY_ANGLE.format("torque [kN m]"),
    ),
    "point spring": (
        FOUR_BAR,
        'kind = "point spring"\nstiffness = "2 N/mm"\nfree_length = "10 cm"\nbetween = ["B", ["0 m", "0.5 m"]]',
        ks.PointSpring(2e3, 0.1, between=("B", (0.0, 0.5))),
    ),
    "point damper": (
        FOUR_BAR,
        'kind = "point damper"\ncoefficient = "50 N s/m"\nbetween = ["B", "O"]',
        ks.PointDamper(50.0, between=("B", "O")),
    ),
    "torsion spring": (
        FOUR_BAR,
        'kind = "torsion spring"\nstiffness = "40 N m/rad"\nfree_angle = "80 deg"\non = "rocker"\nmoment = "3 N m"',
        ks.TorsionSpring(40.0, np.radians(80.0), on="rocker", moment=3.0),
    ),
    "torsion damper": (
        FOUR_BAR,
        'kind = "torsion damper"\ncoefficient = "0.5 N m s/rad"\non = "crank"',
        ks.TorsionDamper(0.5, on="crank"),
    ),
    "cubic spring": (
        PUMP,
        'kind = "spring"\nstiffness = "2 kN/m"\nfree_position = "0.4 m"\ncubic = "-1e4 N/m^3"',
        ks.Spring(2e3, 0.4, cubic=-1e4),
    ),
    "process force": (PUMP, 'kind = "process force"\nforce = "-2 tf"', ks.ProcessForce(-19613.3)),
    "process force of four strokes": (
        PUMP,
        'kind = "process force"\nforce = { file = "t.csv", area = "10 cm^2", period = "720 deg" }',
        ks.ProcessForce(ks.Table(2 * ANGLES, [1e2, 3e2, 2e2, 0.0], period=4 * np.pi), period=4 * np.pi),
        BY_ANGLE.format("pressure [bar]").replace("270", "540").replace("180", "360").replace("90", "180"),
    ),
    "indicator diagram": (
        PUMP,
        'kind = "process force"\nforce = { file = "t.csv", area = "-10 cm^2", over = "travel" }',
        ks.ProcessForce(ks.Table(TRAVELS, [-8e3, -4e3, -1e3], over="travel", back=[-2e3, -1e3, 0.0])),
        BY_TRAVEL.format("pressure [MPa]", "pressure_back [MPa]"),
    ),
    "force by travel of a slider": (
        PUMP,
        'kind = "force"\nvalue = { file = "t.csv", slider = "slider" }\nat = "B"\ndirection = "180 deg"',
        ks.Force(
            ks.Table(TRAVELS, [8.0, 4.0, 1.0], over="travel", back=[2.0, 1.0, 0.0], slider="slider"),
            at="B",
            direction=np.pi,
        ),
        BY_TRAVEL.format("force [N]", "force_back [N]"),
    ),
}


@pytest.mark.parametrize("name", LOADS)
def test_a_load_of_each_kind_is_the_one_made_in_python(tmp_path, name):
    text, entry, load, *table = LOADS[name]
    if table:
        (tmp_path / "t.csv").write_text(table[0], encoding="utf-8")
    variant = ks.load_case(case_file(tmp_path, f"{text}[[variants.loaded.loads]]\n{entry}\n")).variant("loaded")
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60), loads=load), 9)
    assert variant.scene.period == ks.Scene(variant.mechanism, rpm(60), loads=load).period


def test_loads_of_a_kind_are_numbered_after_those_with_tables_of_their_own(tmp_path):
    springs = '[[variants.loaded.loads]]\nkind = "spring"\nstiffness = "{} N/m"\nfree_position = "0.4 m"\n'
    own = 'spring = { stiffness = "1 N/m", free_position = "0 m" }\n'
    variant = ks.load_case(case_file(tmp_path, PUMP + own + springs.format(2) + springs.format(3))).variant("loaded")
    wanted = {"spring.stiffness": 1.0, "spring2.stiffness": 2.0, "spring3.stiffness": 3.0}
    assert {path: variant.parameters[path] for path in wanted} == wanted
    assert {path: variant.scene.parameters[path] for path in wanted} == wanted


def test_a_process_force_of_its_own_table_takes_an_indicator_diagram(tmp_path):
    (tmp_path / "t.csv").write_text(BY_TRAVEL.format("pressure [MPa]", "pressure_back [MPa]"), encoding="utf-8")
    text = PUMP + 'process_force = { force = { file = "t.csv", area = "-10 cm^2" } }\n'
    variant = ks.load_case(case_file(tmp_path, text)).variant("loaded")
    agree(variant.scene, ks.Scene(variant.mechanism, rpm(60), loads=LOADS["indicator diagram"][2]))


def test_the_loads_of_a_variant_stand_in_place_of_the_common_ones(tmp_path):
    common = '[common]\n[[common.loads]]\nkind = "force"\nat = "B"\nvalue = "1 N"\n'
    text = PUMP + common + '[variants.free]\nmechanism = "crank-slider"\ncrank_speed = "1 rpm"\n'
    text += 'crank_length = "0.1 m"\ncoupler_length = "0.4 m"\nloads = []\n'
    case = ks.load_case(case_file(tmp_path, text))
    assert len(case.variant("loaded").loads) == 1
    assert case.variant("free").loads == ()
