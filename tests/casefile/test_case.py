"""Case files: what they give, and what is said of every way to get one wrong."""

import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from kinetostatics.numbers.units import to_si
from support.case_files import case_file, problems

PLAIN = """
title = "test"
reference = "plain"
[common]
crank_speed = "320 rpm"
[common.coupler]
mass = "150 kg"
centre = "mid-length"
inertia = "20.5 kg m^2"
[common.slider]
mass = "600 kg"
[variants.plain]
mechanism = "crank-slider"
crank_length = "300 mm"
coupler_length = "2 m"
"""


def test_shipped_sawframe_equals_the_mechanism_built_in_python():
    variant = ks.load_case("sawframe_2r63").solve("cam-circle", angles=90)
    spring = ks.Spring.balancing(600.0, 320 * np.pi / 30, 2.0)
    by_hand = ks.solve(
        ks.cam_crank_slider(
            ks.cams.Circle(0.3, (-0.0219, 0.0)),
            2.0219,
            coupler=ks.Link(150, 2.0219 / 2, 20.5),
            slider=ks.Link(600),
        ),
        2 * np.pi * np.arange(90) / 90,
        crank_speed=320 * np.pi / 30,
        loads=[ks.Gravity(), spring],
    )
    np.testing.assert_allclose(variant.balancing_torque, by_hand.balancing_torque, atol=1e-9)
    np.testing.assert_allclose(variant.cam_force, by_hand.cam_force, rtol=1e-13)


def test_cosine_law_gives_the_coupler_length_left_out_of_the_file():
    mechanism = ks.load_case("sawframe_2r63").variants["cam-cosine"].mechanism
    assert mechanism.groups[-1].coupler_length == pytest.approx(2.02190517686444745, rel=1e-15)


def test_a_path_and_a_shipped_name_read_the_same_case(tmp_path):
    copy = tmp_path / "mine.toml"
    shutil.copy(shipped_cases()["sawframe_2r63"], copy)
    assert list(ks.load_case(copy).variants) == list(ks.load_case("sawframe_2r63").variants)


def test_compare_gives_the_published_rows_beside_ours():
    table = ks.load_case("sawframe_2r63").comparison_table("cam-cosine")
    assert table.loc["mean |balancing torque|", "published"] == "6.77 (ratio)"
    assert table.loc["mean |balancing torque|", "ratio"] == pytest.approx(6.778, abs=5e-4)
    assert (table["published"] != "").sum() == 9


def test_turn_starts_at_zero_and_leaves_its_end_out():
    angle = ks.load_case("sawframe_2r63").solve("plain", angles=4).crank_angle
    np.testing.assert_allclose(np.degrees(angle), [0, 90, 180, 270])


def test_a_variant_overrides_single_keys_of_what_is_common(tmp_path):
    text = PLAIN + '[variants.plain.coupler]\nmass = "100 kg"\n'
    coupler = ks.load_case(case_file(tmp_path, text)).variants["plain"].mechanism.links["coupler"]
    assert (coupler.mass, coupler.inertia, coupler.centre) == (100.0, 20.5, (1.0, 0.0))


def test_sampled_cam_and_process_force_come_from_tables_beside_the_file(tmp_path):
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


def test_every_problem_of_a_file_is_reported_at_once_with_its_key(tmp_path):
    text = """
title = "bad"
reference = "plane"
colour = "red"
[common]
crank_speed = "320 Hz"
[common.coupler]
mass = "-150 kg"
intertia = "20.5 kg m^2"
[variants.plain]
mechanism = "crank-slider"
crank_length = 0.3
coupler_lenght = "2 m"
assembly = 2
[variants.cam]
mechanism = "cam-crank-slider"
coupler_length = "nan m"
cam = { kind = "ellipse", radius = "300 mm" }
process_force = {}
[variants.none]
[variants.typo]
mechanism = "crank-slidr"
crank_length = "300 kg"
"""
    found = problems(tmp_path, text)
    expected = [
        ("reference", "'plain'"),
        ("colour", "is not a key here"),
        ("common.crank_speed", "Hz"),
        ("common.coupler.mass", "at least 0 kg"),
        ("common.coupler.intertia", "did you mean 'inertia'?"),
        ("variants.plain.crank_length", "number and a unit"),
        ("variants.plain.coupler_length", "is missing"),
        ("variants.plain.coupler_lenght", "did you mean 'coupler_length'?"),
        ("variants.plain.assembly", "1 or -1"),
        ("variants.cam.coupler_length", "nan m"),
        ("variants.cam.cam.kind", "'cosine-law'"),
        ("variants.cam.process_force", "needs either force"),
        ("variants.none.mechanism", "is missing"),
        ("variants.typo.mechanism", "did you mean 'crank-slider'?"),
        ("variants.typo.crank_length", '"kg"'),
        ("variants.typo.coupler_length", "is missing"),
    ]
    for key, words in expected:
        assert [line for line in found if line.startswith(key + " ") or line.startswith(key + ":") if words in line], (
            key
        )
    assert len(found) == len(expected)


def test_impossible_geometry_is_reported_with_the_angles_for_every_variant(tmp_path):
    text = PLAIN + '[variants.short]\nmechanism = "crank-slider"\ncrank_length = "300 mm"\ncoupler_length = "200 mm"\n'
    text += '[variants.long]\nmechanism = "crank-slider"\ncrank_length = "3 m"\ncoupler_length = "2 m"\n'
    found = problems(tmp_path, text)
    assert len(found) == 2
    assert found[0].startswith("variants.short: crank-slider cannot be assembled")
    assert "41.8103 .. 138.19 deg, 221.81 .. 318.19 deg" in found[0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            ('crank_speed = "320 rpm"', 'crank_speed = "320"'),
            'common.crank_speed has no unit; write for example "320 r',
        ),
        (('"300 mm"', '"0 mm"'), "variants.plain.crank_length must be greater than 0 m, found '0 mm'"),
        (('"2 m"', '"2 furlog"'), 'variants.plain.coupler_length unit "furlog" is not known'),
        (('"600 kg"', '"6e999 kg"'), "common.slider.mass is too large for double precision"),
        (('"mid-length"', '["1 m"]'), "common.coupler.centre must be a pair"),
        (('reference = "plain"', ""), "reference is missing"),
        (("[variants.plain]", "[variants.plain.crank]"), "variants.plain.mechanism is missing"),
    ],
)
def test_one_wrong_entry_is_named_with_what_was_found_and_what_is_allowed(tmp_path, change, words):
    assert any(line.startswith(words) for line in problems(tmp_path, PLAIN.replace(*change)))


def test_missing_unreadable_and_malformed_files_are_case_errors(tmp_path):
    with pytest.raises(ks.CaseError, match="did you mean 'sawframe_2r63'"):
        ks.load_case("sawframe_2r36")
    with pytest.raises(ks.CaseError, match="cannot be read"):
        ks.load_case(tmp_path)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ks.CaseError, match="not UTF-8"):
        ks.load_case(tmp_path / "binary.toml")
    assert "is not TOML" in problems(tmp_path, 'title = "a\n')[0]


def test_wrong_tables_beside_a_case_are_named_with_file_and_column(tmp_path):
    text = PLAIN.replace('"2 m"', '"2 m"\nprocess_force = { table = "cut.csv" }')
    (tmp_path / "cut.csv").write_text("crank_angle, force [kg]\n0, x\n")
    found = problems(tmp_path, text)
    assert len(found) == 2
    assert all("cut.csv" in line for line in found)


def test_asking_for_a_variant_that_is_not_there_names_those_that_are():
    with pytest.raises(ks.CaseError, match=r"'plain', 'cam-circle', 'cam-cosine'; did you mean 'cam-circle'"):
        ks.load_case("sawframe_2r63").solve("cam-cirle")


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("300 mm", "m", 0.3),
        ("320 rpm", "rad/s", 320 * np.pi / 30),
        ("-90 deg", "rad", -np.pi / 2),
        ("20.5 kg m2", "kg m^2", 20.5),
        ("9.81 m/s2", "m/s^2", 9.81),
        ("650 kN/m", "N/m", 650e3),
        ("5 tf", "N", 49033.25),
        ("1e-3 km", "m", 1.0),
    ],
)
def test_text_with_a_unit_reads_as_si(text, unit, value):
    assert to_si(text, unit) == pytest.approx(value, rel=1e-15)


def test_every_key_of_a_variant_reaches_the_mechanism(tmp_path):
    text = """
title = "all keys"
reference = "a"
[variants.a]
mechanism = "cam-crank-slider"
crank_speed = "-100 rpm"
crank_acceleration = "7 rad/s^2"
guide_angle = "20 deg"
guide_offset = "15 mm"
assembly = -1
coupler_length = "1.4 m"
cam = { kind = "circle", radius = "200 mm", centre = ["-20 mm", "10 mm"] }
crank = { mass = "3 kg", centre = ["80 mm", "5 mm"], inertia = "0.2 kg m^2" }
block = { mass = "2 kg", centre = "-12 mm", inertia = "0.01 kg m^2" }
coupler = { mass = "9 kg", centre = "mid-length", inertia = "1.5 kg m^2" }
slider = { mass = "20 kg", centre = ["30 mm", "-40 mm"] }
gravity = { acceleration = "9.8 m/s^2", direction = "200 deg" }
spring = { stiffness = "4 kN/m", free_position = "-1.2 m" }
process_force = { force = "-250 N" }
[variants.b]
mechanism = "cam-crank-slider"
crank_speed = "100 rpm"
guide_angle = "20 deg"
cam = { kind = "cosine-law", amplitude = "200 mm", mean = "1.4 m" }
slider = { mass = "20 kg" }
spring = { stiffness = "balance the slider", free_position = "1.4 m" }
[variants.c]
mechanism = "crank-slider"
crank_speed = "100 rpm"
guide_through = [["0 m", "50 mm"], ["1 m", "150 mm"]]
crank_length = "200 mm"
coupler_length = "1.4 m"
crank = { mass = "3 kg", centre = "mid-length" }
"""
    case = ks.load_case(case_file(tmp_path, text))
    speed = 100 * np.pi / 30
    turn = 2 * np.pi * np.arange(16) / 16
    a = ks.solve(
        ks.cam_crank_slider(
            ks.cams.Circle(0.2, (-0.02, 0.01)),
            1.4,
            guide_angle=np.radians(20.0),
            guide_offset=0.015,
            assembly=-1,
            crank=ks.Link(3.0, (0.08, 0.005), 0.2),
            block=ks.Link(2.0, -0.012, 0.01),
            coupler=ks.Link(9.0, 0.7, 1.5),
            slider=ks.Link(20.0, (0.03, -0.04)),
        ),
        turn,
        crank_speed=-speed,
        crank_acceleration=7.0,
        loads=[ks.Gravity(9.8, np.radians(200.0)), ks.Spring(4000.0, -1.2), ks.ProcessForce(-250.0)],
    )
    law = ks.cams.CosineLaw(0.2, 1.4, np.radians(20.0))
    b = ks.solve(
        ks.cam_crank_slider(law, law.coupler_length, guide_angle=np.radians(20.0), slider=ks.Link(20.0)),
        turn,
        crank_speed=speed,
        loads=[ks.Spring.balancing(20.0, speed, 1.4)],
    )
    guide = ks.Guide.through((0.0, 0.05), (1.0, 0.15))
    c = ks.solve(ks.crank_slider(0.2, 1.4, guide=guide, crank=ks.Link(3.0, 0.1)), turn, crank_speed=speed)
    for name, expected in {"a": a, "b": b, "c": c}.items():
        found = case.solve(name, angles=16).frame()
        np.testing.assert_allclose(found, expected.frame(), rtol=1e-12, atol=1e-9)


# What is read, and what is doubted


def test_the_name_of_a_shipped_case_means_that_case_whatever_lies_here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sawframe_2r63").write_text(PLAIN, encoding="utf-8")
    with pytest.warns(UserWarning, match=r"read as the shipped case of that name.* write './sawframe_2r63'") as caught:
        assert ks.load_case("sawframe_2r63").title.startswith("Log frame saw")
    assert caught[0].filename == __file__
    for path in ("./sawframe_2r63", Path("sawframe_2r63"), str(tmp_path / "sawframe_2r63")):
        assert ks.load_case(path).title == "test"
    (tmp_path / "sawframe_2r63").rename(tmp_path / "sawframe_2r63.toml")
    assert ks.load_case("sawframe_2r63.toml").title == "test"
    assert ks.load_case("sawframe_2r63").title.startswith("Log frame saw")


def test_a_published_figure_without_a_row_is_refused(tmp_path):
    published = '[published.ratio]\n"mean |balancing torqe|" = "6.77"\n[published.value]\n"largest reaction Q" = "1"\n'
    case = ks.load_case(case_file(tmp_path, PLAIN + published))
    with pytest.raises(ks.CaseError, match=r"row is 'mean .balancing torqe.', .*did you mean 'mean .bal") as caught:
        case.comparison_table("plain")
    assert "'largest reaction Q'" in caught.value.problems[1]


def test_a_published_figure_of_another_variant_is_left_out_of_this_one(tmp_path):
    published = '[published.value]\n"largest cam force" = "1"\n"torque extremum 9" = "1"\n"largest reaction B" = "2"\n'
    table = ks.load_case(case_file(tmp_path, PLAIN + published)).comparison_table("plain")
    assert table["published"][table["published"] != ""].to_dict() == {"largest reaction B": "2 (value)"}


DOUBTFUL = [
    ('"slider.mass" = "normal 600000 kg +- 5 kg"', True),
    ('"slider.mass" = "normal 600 g +- 5 g"', True),
    ('"crank_length" = "299..301 m"', True),
    ('"coupler_length" = "normal 0 mm +- 0.5 mm"', True),
    ('"slider.mass" = "normal 590 kg +- 5 kg"', False),
    ('"slider.mass" = "0..1200 kg"', False),
    ('"slider.centre.along" = "normal 0 mm +- 5 mm"', False),
    ('"slider.centre.across" = "normal 0 mm +- 5 mm"', False),
]


@pytest.mark.parametrize(("spread", "doubted"), DOUBTFUL)
def test_a_tolerance_hundreds_of_times_off_its_parameter_is_doubted(tmp_path, spread, doubted):
    path = case_file(tmp_path, f"{PLAIN}[tolerances]\n{spread}\n")
    if doubted:
        words = r"tolerances: .* but the parameter of .*; is the unit right\?"
        with pytest.warns(ks.HintWarning, match=words) as caught:
            ks.load_case(path)
        assert caught[0].filename == __file__
    else:
        ks.load_case(path)


def test_slips_of_units_in_links_are_hinted_at_where_the_case_is_read(tmp_path):
    """By file and variant, once; and as ever when it is solved."""
    path = case_file(tmp_path, PLAIN.replace('"mid-length"', '"1000 m"').replace("20.5", "0.01"))
    with pytest.warns(ks.HintWarning) as caught:
        case = ks.load_case(path)
    texts = [str(item.message) for item in caught]
    assert len(texts) == 2
    assert all(text.startswith(f"{path}: variants.plain: ") for text in texts)
    assert "is 1000 m from its reference joint" in texts[0]
    assert "the inertia of the coupler" in texts[1]
    assert {item.filename for item in caught} == {__file__}
    with pytest.warns(ks.HintWarning) as caught:
        case.solve("plain", 12)
    assert len(caught) == 2


def test_the_stiffness_of_a_spring_that_balances_is_compared_with_its_number(tmp_path):
    spring = '[variants.plain.spring]\nstiffness = "balance the slider"\nfree_position = "2 m"\n'
    for unit, doubted in (("kN/m", False), ("N/m", True)):
        path = case_file(
            tmp_path, f'{PLAIN}{spring}[tolerances]\n"spring.stiffness" = "normal 674 {unit} +- 7 {unit}"\n'
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ks.load_case(path)
        assert bool(caught) is doubted


def test_a_cam_of_a_kind_that_is_not_there_is_told_the_nearest(tmp_path):
    text = PLAIN + '[variants.cam]\nmechanism = "cam-crank-slider"\ncoupler_length = "2 m"\ncam = { kind = "cirkle" }\n'
    kind, radius = problems(tmp_path, text)
    assert kind.startswith("variants.cam.cam.kind is 'cirkle'")
    assert "did you mean 'circle'?" in kind
    assert radius == "variants.cam.cam.radius is missing"
