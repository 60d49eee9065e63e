"""Reading a case file: every problem at once, each with its key, what was found and what is allowed."""

import shutil
from pathlib import Path

import pytest

import kinetostatics as ks
from kinetostatics.casefile.case import shipped_cases
from support.case_files import PLAIN, problems
from support.every import every


def test_a_path_and_a_shipped_name_read_the_same_case(tmp_path):
    copy = tmp_path / "mine.toml"
    shutil.copy(shipped_cases()["sawframe_2r63"], copy)
    assert list(ks.load_case(copy).variants) == list(ks.load_case("sawframe_2r63").variants)


def test_all_problems_of_a_file_come_with_their_keys(tmp_path):
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
def test_a_wrong_entry_names_found_and_allowed(tmp_path, change, words):
    assert any(line.startswith(words) for line in problems(tmp_path, PLAIN.replace(*change)))


def test_shipped_case_name_ignores_local_files(tmp_path, monkeypatch):
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


@pytest.mark.parametrize("key", ["drive", "friction", "gravity"])
def test_wrong_type_is_named_in_toml_words(tmp_path, key):
    found = problems(tmp_path, PLAIN.replace("[common]\n", f'[common]\n{key} = "x"\n', 1))
    assert f"common.{key} must be a table of keys and values, found 'x'" in found


@every(
    "given, meant",
    [("p", "p.toml"), ("mypress", "mypress.toml"), ("mypres.toml", "mypress.toml"), ("in/saw", "in/saw.toml")],
)
def test_missing_or_wrong_ending_suggests_the_file(tmp_path_factory, given, meant):
    folder = tmp_path_factory.mktemp("cases")
    for name in ("p.toml", "mypress.toml", "in/saw.toml"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(PLAIN)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        with pytest.raises(ks.CaseError, match=f"; did you mean '{meant}'\\?\\)"):
            ks.load_case(given)


def test_misspelt_shipped_case_is_suggested(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ks.CaseError, match=r"; did you mean 'sawframe_2r63'\?\)"):
        ks.load_case("sawframe")
