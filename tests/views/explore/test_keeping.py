"""What the explore page keeps: case files with the same numbers bit for bit, Python text, reports; in one folder."""

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.explore.keeping import scenes_of
from kinetostatics.views.explore.session import Session
from support.every import every

CASE = ks.load_case("sawframe_2r63")
HEAVIER = {"variant": "cam-circle", "values": {"slider.mass": 620.0, "coupler.inertia": 100 / 3}}
PRESS = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(50.0)), 10.0, loads=ks.Gravity())


STATE = {"variant": "crank-slider", "values": {}}


def kept(what, folder, kind="save", state=HEAVIER, **fields):
    """The answer of a session to a request to keep a state."""
    session = what if isinstance(what, Session) else Session(what, folder=folder)
    found = session.answer({"id": 1, "kind": kind, "state": state, **fields})
    while not isinstance(found, dict):
        found = next(part for part in found if part)
    return found


def assert_same_bits(one, other):
    """All quantities of two scenes are the same numbers."""
    first, second = one.solve(36), other.solve(36)
    assert list(first.quantities) == list(second.quantities)
    for name in first.quantities:
        np.testing.assert_array_equal(first[name], second[name], name)


@pytest.mark.slow
def test_a_saved_case_has_the_same_numbers_and_its_reference(tmp_path):
    session = Session(CASE, folder=tmp_path)
    found = kept(session, tmp_path, name="heavier")
    assert (found["saved"], found["path"]) == ("heavier.toml", str(tmp_path / "heavier.toml"))
    case = ks.load_case(tmp_path / "heavier.toml")
    assert (case.title, case.source, case.reference) == (CASE.title, CASE.source, "plain")
    assert list(case.variants) == ["plain", "cam-circle"]
    assert_same_bits(case.variants["cam-circle"].scene, session.scene(HEAVIER))
    assert_same_bits(case.variants["plain"].scene, CASE.variants["plain"].scene)
    assert case.compare("plain", "cam-circle").mean_torque_ratio > 1
    assert found["notes"] == ["The tolerances of sawframe_2r63.toml are not in it."]


def with_motor(folder, file):
    """The path of a copy of the case in a new folder, its motor a table in a file beside it."""
    folder.mkdir()
    rows = "speed [rad/s], torque [N m]\n0, 800\n150, 900\n170, 0\n"
    (folder / file).write_text(rows, encoding="utf-8")
    text = CASE.path.read_text(encoding="utf-8")
    start, end = text.index("[common.drive.motor]"), text.index("[variants.plain]")
    own = f'[common.drive.motor]\nkind = "table"\nfile = "{file}"\ntransmission = 2.5\n\n'
    (folder / "saw.toml").write_text(text[:start] + own + text[end:], encoding="utf-8")
    return folder / "saw.toml"


def test_a_saved_case_has_its_drives_and_their_files(tmp_path):
    (tmp_path / "to").mkdir()
    for what in (CASE, ks.load_case(with_motor(tmp_path / "from", "motor.csv"))):
        found = kept(what, tmp_path / "to", name="heavier", overwrite=True)
        for name, variant in ks.load_case(found["path"]).variants.items():
            assert variant.flywheel == what.variants[name].flywheel > 0
            speed = np.linspace(0.0, 160.0, 9)
            np.testing.assert_array_equal(variant.motor.torque(speed), what.variants[name].motor.torque(speed))


FOLDERS = {"decomposed": "e\u0301 '\"", "DEL": "a\x7fb", "relative": "plain"}


@pytest.mark.slow
@every("name", FOLDERS)
def test_a_motor_is_found_again_from_any_folder(tmp_path_factory, monkeypatch, name):
    top = tmp_path_factory.mktemp("top")
    with_motor(top / FOLDERS[name], "m\u00e9.csv")
    monkeypatch.chdir(top)
    case = ks.load_case(Path(FOLDERS[name]) / "saw.toml")
    (top / "elsewhere").mkdir()
    monkeypatch.chdir(top / "elsewhere")
    found = kept(case, top, name="heavier")
    saved = ks.load_case(found["path"]).variants["cam-circle"].motor
    assert saved.torque(85.0) == case.variants["cam-circle"].motor.torque(85.0)


STATES = {
    "a changed reference": (CASE, {"variant": "plain", "values": {"crank_length": 0.31}}, ["plain", "plain-changed"]),
    "a reference": (CASE, {"variant": "plain", "values": {}}, ["plain"]),
    "its own reference": (CASE, {"variant": "upright-circle", "values": {}}, ["upright-plain", "upright-circle"]),
    "a scene": (PRESS, STATE, ["crank-slider"]),
    "a changed scene": (PRESS, {"values": {"crank_speed": -20.0}}, ["crank-slider", "crank-slider-changed"]),
}


@every("name", STATES)
def test_a_state_is_kept_beside_its_reference(tmp_path, name):
    what, state, variants = STATES[name]
    session = Session(what)
    assert list(scenes_of(session, state)) == variants
    assert scenes_of(session, state)[variants[-1]] is session.scene(state)


@pytest.mark.slow
@pytest.mark.parametrize("name", ks.shipped_cases())
def test_every_variant_of_the_shipped_cases_is_saved_bit_for_bit(tmp_path, name):
    case = ks.load_case(name)
    session = Session(case, folder=tmp_path)
    for number, variant in enumerate(case.variants):
        scene = case.variants[variant].scene
        numbers = {path: value for path, value in scene.parameters.items() if np.ndim(value) == 0 and path != "sense"}
        values = {path: float(value) * (1 + 1e-7 / 3) for path, value in numbers.items() if path.endswith("mass")}
        state = {"variant": variant, "values": values}
        found = kept(session, tmp_path, state=state, name=f"saved {number}")
        assert "saved" in found, found["problem"]
        assert_same_bits(list(ks.load_case(found["path"]).variants.values())[-1].scene, session.scene(state))


@pytest.mark.slow
def test_a_sampled_cam_goes_to_a_file_beside_it_and_is_never_replaced(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)

    def follower(size):
        cam = ks.cams.Sampled(angle, size + 0.01 * np.cos(angle))
        return ks.Scene(ks.Mechanism("bare", ks.Crank(None), (ks.CamRoller(cam, ks.Link(2.0)),)), 10.0)

    state = {"variant": "bare", "values": {}}
    assert kept(follower(0.1), tmp_path, state=state, name="cam")["saved"] == "cam.toml"
    assert {path.name for path in tmp_path.iterdir()} == {"cam.toml", "cam_bare_cam.csv"}
    whole = (tmp_path / "cam_bare_cam.csv").read_bytes()
    assert kept(follower(0.1), tmp_path, state=state, name="cam", overwrite=True)["saved"] == "cam.toml"
    assert_same_bits(ks.load_case(tmp_path / "cam.toml").variants["bare"].scene, follower(0.1))
    refused = kept(follower(0.2), tmp_path, state=state, name="cam", overwrite=True)
    assert "cam_bare_cam.csv: exists already; choose another name" in refused["problem"]
    assert (tmp_path / "cam_bare_cam.csv").read_bytes() == whole


def test_an_existing_file_is_replaced_only_on_request(tmp_path):
    path = tmp_path / "press.toml"
    path.write_text("mine", encoding="utf-8")
    for overwrite in ({}, {"overwrite": False}, {"overwrite": "yes"}, {"overwrite": 1}):
        assert kept(PRESS, tmp_path, state=STATE, name="press", **overwrite)["exists"] == "press.toml"
        assert path.read_text(encoding="utf-8") == "mine"
    assert kept(PRESS, tmp_path, state=STATE, name="press.toml", overwrite=True)["saved"] == "press.toml"
    assert_same_bits(ks.load_case(path).variants["crank-slider"].scene, PRESS)


def test_the_file_of_the_case_is_not_replaced(tmp_path):
    path = tmp_path / "own.toml"
    ks.design.case_text.write_case(path, "Own", {"one": PRESS})
    found = kept(path, tmp_path, state={"variant": "one", "values": {}}, name="own", overwrite=True)
    assert "own.toml is read as input and would be replaced; give another name" in found["problem"]


NAMES = [
    *("", " ", ".", "..", "../up", "/tmp/x", "a/b", "a\\b", ".hidden", "a.b", "a.toml.toml", "~", "a\0b", "a\nb"),
    *("-rf", "x" * 81, "\U0001d49c" * 80, "\ud800", "C:x", "a%2fb", "$HOME", None, 5, ["a"], {"name": "a"}),
]


@every("name", NAMES)
def test_a_name_that_might_leave_the_folder_is_refused(tmp_path, name):
    for kind in ("save", "report"):
        found = kept(PRESS, tmp_path, kind, STATE, name=name, overwrite=True)
        assert "the name of a file has letters, digits, blanks, - and _, 80 at most" in found["problem"]
    assert list(tmp_path.iterdir()) == []


def test_a_link_out_of_the_folder_is_not_followed(tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    outside = tmp_path / "outside.toml"
    outside.write_text("mine", encoding="utf-8")
    (folder / "press.toml").symlink_to(outside)
    (folder / "new.toml").symlink_to(tmp_path / "nowhere.toml")
    for name in ("press", "new"):
        found = kept(PRESS, folder, state=STATE, name=name, overwrite=True)
        assert "is a link to another place; give another name" in found["problem"]
    assert outside.read_text(encoding="utf-8") == "mine"
    assert {path.name for path in tmp_path.iterdir()} == {"folder", "outside.toml"}


def test_without_a_folder_nothing_is_written(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "no folder to write into was given" in kept(PRESS, None, state={"values": {}}, name="press")["problem"]
    assert list(tmp_path.iterdir()) == []


def test_a_load_without_a_text_is_a_problem_and_leaves_no_file(tmp_path):
    scene = ks.Scene(PRESS.mechanism, 10.0, loads=ks.ProcessForce(lambda motion: -100.0 * motion.slider_velocity))
    found = kept(scene, tmp_path, state={"values": {}}, name="press")
    assert "force must be one number in a case file" in found["problem"]
    assert list(tmp_path.iterdir()) == []


def run_text(text):
    """The scene that a Python text builds."""
    names: dict = {}
    exec(text, names)
    return names["scene"]


@pytest.mark.slow
def test_python_text_builds_the_same_scene(tmp_path, capsys):
    session = Session(CASE, folder=tmp_path)
    text = kept(session, tmp_path, "python")["text"]
    assert "case = ks.load_case('sawframe_2r63')" in text
    assert "'slider.mass': 620.0," in text
    assert_same_bits(run_text(text), session.scene(HEAVIER))
    assert capsys.readouterr().out.startswith("[")
    plain = kept(session, tmp_path, "python", {"variant": "plain", "values": {}})["text"]
    assert "varied" not in plain
    assert run_text(plain).parameters == CASE.variants["plain"].scene.parameters


def test_python_text_of_a_case_of_ones_own_names_its_file(tmp_path):
    path = tmp_path / "it's 'own'.toml"
    ks.design.case_text.write_case(path, "Own", {'a "b"': PRESS})
    session = Session(path)
    state = {"variant": 'a "b"', "values": {"crank_length": 0.11}}
    assert_same_bits(run_text(kept(session, None, "python", state)["text"]), session.scene(state))


def test_python_text_of_a_scene_reads_the_file_in_which_it_was_saved(tmp_path):
    session, state = Session(PRESS, folder=tmp_path), {"variant": "crank-slider", "values": {"crank_length": 0.11}}
    assert "save the case first" in kept(session, tmp_path, "python", state)["problem"]
    kept(session, tmp_path, state=state, name="press")
    assert_same_bits(run_text(kept(session, tmp_path, "python", state)["text"]), session.scene(state))
    other = {"variant": "crank-slider", "values": {"crank_length": 0.12}}
    assert "save the case first" in kept(session, tmp_path, "python", other)["problem"]


@pytest.mark.slow
def test_a_report_of_state_and_reference_is_written_while_others_are_answered(tmp_path):
    pytest.importorskip("jinja2")
    session = Session(CASE, folder=tmp_path)
    request = {"id": 1, "kind": "report", "state": HEAVIER, "name": "heavier"}
    parts, waited = [], 0
    for part in session.answer(request | {"reference": {"variant": "cam-circle", "values": {}}}):
        waited += part is None
        parts += [part] if part else []
        session.answer({"id": 2, "kind": "look", "state": HEAVIER, "count": 12})
    assert waited
    assert [part["more"] for part in parts] == [True, False]
    assert parts[0]["report"] == str(tmp_path / "heavier.html")
    text = (tmp_path / "heavier.html").read_text(encoding="utf-8")
    assert CASE.title in text
    assert "before" in text
    assert "620" in text
    assert kept(session, tmp_path, "report", name="heavier")["exists"] == "heavier.html"


KILLED = """
import os, sys, threading, time
from pathlib import Path
from kinetostatics.views.explore.session import Session

session = Session("sawframe_2r63", folder=sys.argv[1])
for turn in range(10_000):
    state = {"variant": "cam-circle", "values": {"slider.mass": 600.0 + turn}}
    found = session.answer({"id": 1, "kind": "save", "state": state, "name": "saw", "overwrite": True})
    assert "saved" in found, found
    print(turn, flush=True)
"""


@pytest.mark.slow
def test_a_server_killed_while_it_saves_leaves_files_whole(tmp_path):
    for attempt in range(3):
        with subprocess.Popen([sys.executable, "-c", KILLED, tmp_path], stdout=subprocess.PIPE, text=True) as process:
            process.stdout.readline()
            time.sleep(0.04 * attempt)
            process.kill()
        case = ks.load_case(tmp_path / "saw.toml")
        assert list(case.variants) == ["plain", "cam-circle"]
        assert case.variants["cam-circle"].parameters["slider.mass"] >= 600.0
