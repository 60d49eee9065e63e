"""Session: requests checked, states with their scenes, the start by an address, answers that belong to their state."""

import gc
import json
import os
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.explore import session as module
from kinetostatics.views.explore.messages import framed
from kinetostatics.views.explore.session import ANSWERS, MAX_ADDRESS, MAX_COUNT, MAX_SCENES, Session
from kinetostatics.views.page import packed
from support.every import every

CASE = ks.load_case("sawframe_2r63")
PRESS = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(50.0)), 10.0, loads=ks.Gravity())
PLAIN = {"variant": "plain", "values": {}}


@pytest.fixture
def session():
    return Session(CASE)


def asked(session, kind="look", **fields):
    """The answer to a request, a dict."""
    found = session.answer({"id": 1, "kind": kind, **fields})
    return found if isinstance(found, dict) else next(found)


def state(variant="plain", **values):
    return {"variant": variant, "values": values}


def test_a_look_has_the_curves_of_its_state(session):
    changed = {"variant": "cam-circle", "values": {"slider.mass": 620.0, "crank_speed": -20}}
    found = asked(session, state=changed, show=["balancing_torque", "O", "unknown", "O"], count=90)
    s = CASE.variants["cam-circle"].scene.varied(changed["values"]).solve(90)
    assert (found["id"], found["kind"], found["state"], found["sense"]) == (1, "look", changed, -1)
    assert list(found["quantities"]) == ["balancing_torque", "O"]
    np.testing.assert_allclose(found["quantities"]["balancing_torque"]["values"], [s.balancing_torque], rtol=1e-12)
    np.testing.assert_allclose(found["quantities"]["O"]["values"], s.reaction("O"), rtol=1e-12, atol=1e-6)
    assert found["values"]["slider.mass"] == 620.0
    assert found["period"] == 360.0


WRONG_STATES = {
    "none": (None, "state must be an object, got None"),
    "a list": ([1], "state must be an object"),
    "a text": ("plain", "state must be an object"),
    "other keys": ({"value": 1}, "key of state is 'value', allowed: 'variant', 'values', 'chain'"),
    "unknown variant": (state("plane"), "variant is 'plane'"),
    "variant of another type": ({"variant": ["plain"]}, "variant must be a text, got ['plain']"),
    "values of another type": ({"values": [1]}, "values must be an object, got [1]"),
    "unknown path": (state(crank_lenght=0.3), "did you mean 'crank_length'?"),
    "text": (state(crank_length="0.3 m"), "crank_length must be a number, got '0.3 m'"),
    "truth": (state(crank_length=True), "crank_length must be a number, got True"),
    "null": (state(crank_length=None), "crank_length must be a number, got None"),
    "designs": (state(crank_length=[[0.3], [0.4]]), "crank_length must be a number, got [[0.3], [0.4]]"),
    "infinite": (state(crank_length=float("inf")), "crank_length must be a number, got inf"),
    "no number": (state(crank_length=float("nan")), "crank_length must be a number, got nan"),
    "larger than floats": (state(crank_length=10**400), "crank_length must be a number, got 1000"),
    "impossible": (state(crank_length=-0.3), "crank length must be greater than 0, got -0.3"),
    "not to be assembled": (state(crank_length=2.5), "233.13 .. 306.87 deg; change the lengths"),
}


@every("name", WRONG_STATES)
def test_a_wrong_state_is_a_problem_in_words(session, name):
    wrong, message = WRONG_STATES[name]
    for kind in ("look", "describe", "python"):
        if name == "not to be assembled" and kind != "look":
            continue
        found = asked(session, kind, state=wrong)
        assert set(found) == {"id", "kind", "state", "problem"}, kind
        assert message in found["problem"]
        assert "fault of the library" not in found["problem"]


WRONG_REQUESTS = {
    "unknown kind": ({"kind": "lok"}, "kind of request is 'lok'"),
    "kind of another type": ({"kind": {"a": 1}}, "kind of request is {'a': 1}"),
    "no kind": ({"kind": None}, "kind of request is None"),
    "no angles": ({"count": 0}, f"count must be a whole number from 1 to {MAX_COUNT}, got 0"),
    "too many angles": ({"count": MAX_COUNT + 1}, f"got {MAX_COUNT + 1}"),
    "part of an angle": ({"count": 360.0}, "got 360.0"),
    "truth for angles": ({"count": True}, "got True"),
    "text for angles": ({"count": "360"}, "got '360'"),
    "one name": ({"show": "O"}, "show must be a list of at most 100 names, got 'O'"),
    "names of another type": ({"show": [["O"]]}, "got [['O']]"),
    "too many names": ({"show": ["O"] * 101}, "show must be a list"),
    "no reference": ({"kind": "ask", "reference": 3}, "reference must be an object, got 3"),
}


@every("name", WRONG_REQUESTS)
def test_a_wrong_request_is_a_problem_in_words(session, name):
    fields, message = WRONG_REQUESTS[name]
    found = asked(session, **({"state": PLAIN} | fields))
    assert message in found["problem"]


@pytest.mark.slow
@every("value", [0.0, 1e-300, 1e-9, 1e9, 1e150, 1e300, -1e300])
def test_no_number_ends_in_more_than_words(session, value):
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("error", RuntimeWarning)
        for path in ("crank_length", "coupler.inertia", "slider.mass", "crank_speed", "guide_offset"):
            found = asked(session, state=state(**{path: value}), show=["O", "balancing_torque"])
            framed(*packed(found))
            assert "fault of the library" not in found.get("problem", ""), path


def test_a_fault_of_the_library_is_named_as_one(session, monkeypatch):
    def broken(session, request):
        yield {"row": 1}
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setitem(ANSWERS, "look", lambda session, request: 1 / 0)
    monkeypatch.setitem(ANSWERS, "ask", broken)
    text = "this is a fault of the library, please report it: ZeroDivisionError: "
    assert asked(session, "look", state=PLAIN)["problem"].startswith(text)
    first, last = session.answer({"id": 1, "kind": "ask", "state": PLAIN})
    assert (first["row"], first["more"]) == (1, True)
    assert last["problem"].startswith(text)


def test_warnings_are_notes_of_the_answer_alone(session, monkeypatch, recwarn):
    def doubtful(session, request):
        for _ in range(2):
            warnings.warn(ks.errors.HintWarning("crank", "is it in mm?"), stacklevel=1)
        warnings.warn("overflow", RuntimeWarning, stacklevel=1)
        return {}

    monkeypatch.setitem(ANSWERS, "describe", doubtful)
    assert asked(session, "describe", state=PLAIN)["notes"] == ["crank: is it in mm?"]
    assert asked(session, state=PLAIN)["notes"] == []
    assert not recwarn.list


def test_a_page_begins_with_the_variant_and_the_references(session):
    found = asked(Session(CASE, "cam-cosine"), "open")
    assert (found["title"], found["source"], found["show"]) == (CASE.title, CASE.source, None)
    assert found["start"] == state("cam-cosine")
    assert {"name": "upright-circle", "reference": "upright-plain"} in found["variants"]
    assert asked(session, "open")["start"] == PLAIN
    scene = asked(Session(PRESS), "open")
    assert scene["variants"] == [{"name": "crank-slider", "reference": "crank-slider"}]


def test_an_unknown_variant_is_refused_before_a_page_is_served():
    with pytest.raises(ks.ParameterError, match="variant is 'cam', allowed"):
        Session(CASE, "cam")


def test_the_address_reopens_a_state(session):
    kept = state("cam-circle", **{"slider.mass": 620.0})
    found = asked(session, "open", address={"state": json.dumps(kept), "show": '["O"]', "token": "x"})
    assert (found["start"], found["show"], found["notes"]) == (kept, ["O"], [])


HOSTILE = {
    "no JSON": {"state": "{"},
    "deep": {"state": "[" * 50_000},
    "long": {"state": json.dumps(state(crank_length=0.3)) + " " * MAX_ADDRESS},
    "null": {"state": "null"},
    "no text": {"state": PLAIN},
    "unknown variant": {"state": json.dumps(state("<script>alert(1)</script>"))},
    "unknown path": {"state": json.dumps(state(crank=1))},
    "NaN": {"state": '{"values": {"crank_length": NaN}}'},
    "impossible": {"state": json.dumps(state(crank_length=-1))},
    "a list as state": {"state": "[]"},
    "names of another type": {"show": "{}"},
    "names that are no JSON": {"show": "O"},
}


@every("name", HOSTILE)
def test_a_hostile_address_gives_words_and_the_first_state(session, name):
    found = asked(session, "open", address=HOSTILE[name])
    assert found["start"] == PLAIN
    assert found["show"] is None
    (note,) = found["notes"]
    assert note.startswith("the address has no state of this case, so the first one is shown: ")
    assert len(note) < 600


def test_an_address_that_is_no_object_is_none(session):
    for address in ("state", [1], 5, None):
        assert asked(session, "open", address=address)["notes"] == []


def test_the_scene_of_a_state_is_kept_for_the_last_ones(session):
    scenes = [session.scene(state(crank_length=0.3 + 1e-3 * step)) for step in range(MAX_SCENES + 5)]
    last = state(crank_length=0.3 + 1e-3 * (MAX_SCENES + 4))
    assert session.scene({"values": last["values"], "variant": "plain"}) is scenes[-1]
    assert session.scene(state(crank_length=0.3)) is not scenes[0]
    assert session._scene.cache_info().currsize == MAX_SCENES


def test_two_sessions_do_not_share_states():
    one, other = Session(CASE), Session(CASE)
    asked(one, state=state(crank_length=0.31))
    assert other._scene.cache_info().currsize == 0
    assert asked(other, state=PLAIN)["values"]["crank_length"] == 0.3


MEMORY = Path("/proc/self/statm")
LEAK = 1000
"""Bytes for each change that count as a leak: a solution or a scene that stays has many more."""


@pytest.mark.slow
@pytest.mark.skipif(not MEMORY.exists(), reason="the memory of a process is read as on Linux")
def test_memory_stays_flat(session):
    """Also where numbers become zero and so the structure of the machine another one."""
    fields = [item for item in asked(session, "describe", state=PLAIN)["parameters"] if item["value"]]
    zeroed = [item["path"] for item in fields if item["path"].endswith((".mass", ".inertia"))][:3]
    rng = np.random.default_rng(1)

    def change(count):
        for _ in range(count):
            item = fields[rng.integers(len(fields))]
            values = {item["path"]: item["value"] * (1 + 1e-3 * rng.random())}
            values |= {path: 0.0 for path in zeroed if rng.random() < 0.3}
            framed(*packed(asked(session, state=state(**values), show=["O"], count=12)))
        gc.collect()
        return int(MEMORY.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")

    usual = gc.get_threshold()
    gc.set_threshold(700, 10, 10)  # as in a process without tests
    try:
        before = change(300)
        assert change(500) - before < LEAK * 500
    finally:
        gc.set_threshold(*usual)


def test_dropped_kinds_are_kinds_of_requests():
    assert set(module.OF_NEWEST) <= set(ANSWERS)


GOAL = {"goal": "minimise", "output": "rms O"}
WRONG = {  # kind of request, fields of any type: what is said
    "names of numbers": ("ask", {"show": 5}, "show must be a list of at most 100 names, got 5"),
    "50 000 names": ("tolerances", {"show": ["O"] * 50_000}, "show must be a list of at most 100 names"),
    "too many angles": ("tolerances", {"count": 10**9}, "count must be a whole number from 1 to 3600, got 1000000000"),
    "half an angle": ("tolerances", {"count": 1.5}, "count must be a whole number from 1 to 3600, got 1.5"),
    "no goal": ("optimise", {}, "a request optimise needs vary, goal, output"),
    "no output": ("sensitivities", {}, "a request sensitivities needs output"),
    "no bounds": ("optimise", {"vary": {"crank_length": 5}} | GOAL, "crank_length must vary"),
    "bounds of nothing": ("optimise", {"vary": 5} | GOAL, "vary must be an object, got 5"),
    "limits of a number": ("optimise", {"limits": 5}, "limits must be a list, got 5"),
    "no action": ("edit", {}, "a request edit needs action"),
    "action of a list": ("edit", {"action": [1]}, "action must be an object, got [1]"),
}


@every("name", WRONG)
def test_wrong_fields_of_questions_are_told(session, name):
    kind, fields, text = WRONG[name]
    found = asked(session, kind, state=PLAIN, **fields)
    assert text in found["problem"]
    assert "fault of the library" not in found["problem"]


def test_a_state_without_variant_is_of_the_first(session):
    assert asked(session, state={})["values"] == asked(session, state=PLAIN)["values"]
    assert "running" in asked(session, "running", state={})
    assert asked(session, "describe", state={"values": {"slider.mass": 5e-324}})["parameters"]


def test_a_drag_begins_with_the_machine_that_is_shown(session, monkeypatch):
    shown = asked(session, state=PLAIN)
    place = {"handle": "crank_length", "x": 0.31, "y": 0.0, "index": 0, "step": 0.01, "snap": True}
    solved, solve = [], ks.Scene.solve
    monkeypatch.setattr(ks.Scene, "solve", lambda scene, *how, **more: solved.append(1) or solve(scene, *how, **more))
    found = asked(session, "drag", state=PLAIN, **place)
    assert shown["values"]["crank_length"] == 0.3
    assert found["state"]["values"] == {"crank_length": 0.31}
    assert len(solved) == 1


def test_a_drawing_under_the_hand_has_its_pose_alone():
    session, at = Session("pumpjack", "weights"), {"variant": "weights", "values": {}}
    place = {"handle": "rocker_pivot.x", "x": 2.5, "y": -1.0, "index": 60 - 360, "step": 0.01}
    one, all_poses = (asked(session, "drag", state=at, still=still, **place)["drawing"] for still in (True, False))
    assert (one["pose"], len(one["torque"])) == (60, 1)
    assert "pose" not in all_poses
    for key in ("joints", "forces"):
        for name, places in all_poses[key].items():
            np.testing.assert_array_equal(one[key][name], places[60:61], f"{key} {name}")
    for stroke, whole in zip(one["strokes"], all_poses["strokes"], strict=True):
        np.testing.assert_array_equal(stroke["points"], whole["points"])
        for key in ("poses", "shapes"):
            np.testing.assert_array_equal(stroke.get(key, []), whole.get(key, [])[60:61])
    assert [one[key] for key in ("box", "scale", "moving")] == [all_poses[key] for key in ("box", "scale", "moving")]


def test_packed_answers_are_freed_at_once():
    """A server answers for hours: no answer waits for the garbage collection."""
    gc.disable()
    tracemalloc.start()
    try:
        for _ in range(50):
            packed({"values": np.zeros(10_000), "inner": [{"more": np.zeros(3, dtype=np.float32)}]})
        assert tracemalloc.get_traced_memory()[0] < 400_000  # of 50 times 80 kB
    finally:
        tracemalloc.stop()
        gc.enable()
