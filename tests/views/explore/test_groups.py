"""Chains built on the page: templates, actions on groups and loads, forms, hostile tables, and back to a file."""

import copy
import json

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.starters import STARTERS
from kinetostatics.cli import main
from kinetostatics.views.explore import groups
from kinetostatics.views.explore.forms import fields, number_text, text_of, value_of, with_texts
from kinetostatics.views.explore.session import Session
from support.every import every

KINDS = [(name, kind) for name, models in groups.MODELS.items() for kind in models]


def added(raw, kind, name="groups", **keys):
    return groups.edited(raw, {"do": "add", "at": [name], "kind": kind, "keys": keys})


def change(*at, **keys):
    return {"do": "change", "at": list(at), "keys": keys}


def toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {toml(part)}" for key, part in value.items()) + "}"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


def from_file(raw, folder):
    """Scene of a table written as a case file."""
    lines = [f"{key} = {toml(value)}" for key, value in raw.items()]
    text = "\n".join(['title = "t"', 'reference = "a"', "[variants.a]", *lines])
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return ks.load_case(folder / "case.toml").variants["a"].scene


def assert_same(scene, other):
    """Equal numbers, and every quantity equal bit for bit."""
    assert scene.parameters == other.parameters
    ours, theirs = scene.solve(24), other.solve(24)
    assert list(ours.quantities) == list(theirs.quantities)
    assert [name for name in ours.quantities if not np.array_equal(ours[name], theirs[name])] == []


# Templates


def links(**tables):
    return {name: ks.Link(*numbers) for name, numbers in tables.items()}


MID = 0.2
BUILT = {
    "crank-slider": lambda: ks.crank_slider(
        0.1, 0.4, **links(crank=(2.0, 0.03, 0.01), coupler=(3.0, MID, 0.04), slider=(10.0,))
    ),
    "four-bar": lambda: ks.four_bar(
        *(0.1, 0.4, 0.3),
        rocker_pivot=(350 * 1e-3, 0.1),
        assembly="open",
        **links(crank=(2.0, 0.05), coupler=(4.0, MID, 0.05), rocker=(3.0, 0.15, 0.02)),
    ),
    "cam": lambda: ks.cam_crank_slider(
        ks.cams.Circle(0.2), 0.8, **links(crank=(10.0,), block=(1.0,), coupler=(8.0, 0.25, 0.5), slider=(30.0,))
    ),
}


@pytest.mark.slow
@every("kind", BUILT)
def test_a_template_is_the_built_mechanism_as_a_chain(kind):
    scene = groups.scene_of(groups.template(kind))
    assert_same(scene, ks.Scene(BUILT[kind](), scene.crank_speed, loads=scene.loads))


@pytest.mark.slow
@every("kind", STARTERS)
def test_a_template_equals_its_starter_case(kind, tmp_path):
    from kinetostatics.casefile.starters import starter

    path = tmp_path / "case.toml"
    path.write_text(starter(kind, kind), encoding="utf-8")
    case = ks.load_case(path)
    scene = groups.scene_of(groups.template(kind))
    assert_same(scene, next(iter(case.variants.values())).scene)
    assert_same(scene, from_file(groups.template(kind), tmp_path))


# Groups and loads are added

SLIDING = ("spring", "process force", "sawing", "mowing", "gas spring")
LACKS = {"cam roller": "the crank pin slides in its slot; give"} | dict.fromkeys(SLIDING, "four-bar has no slider")
"""What the four-bar lacks for a load."""


@pytest.mark.slow
@every("part", KINDS, ids=lambda part: part[1])
def test_every_kind_is_added_by_its_proposal_and_solves(part):
    name, kind = part
    raw = groups.template("crank-slider")
    found = added(raw, kind, name)
    assert kind in [item["kind"] for item in found[name]]
    solution = groups.scene_of(found).solve(24)
    assert np.isfinite(solution.balancing_torque).all()
    assert float(np.max(solution.power_residual)) < 1e-11


@pytest.mark.slow
@every("part", KINDS, ids=lambda part: part[1])
def test_every_kind_is_added_to_a_four_bar_or_the_message_names_the_lack(part):
    name, kind = part
    raw = groups.template("four-bar")
    if kind in LACKS:
        with pytest.raises(groups.ChainError, match=LACKS[kind]):
            added(raw, kind, name)
    else:
        assert np.isfinite(groups.scene_of(added(raw, kind, name)).solve(24).balancing_torque).all()


def test_an_added_group_has_free_names_and_the_keys_given():
    raw = added(groups.template("crank-slider"), "slider", **{"coupler_length": "500 mm", "slider.mass": "2 kg"})
    assert raw["groups"][1] == {
        "kind": "slider",
        "coupler_length": "500 mm",
        "guide_angle": "90 deg",
        "guide_offset": "0 mm",
        "on": "A",
        "pin": "C",
        "slider": {"mass": "2 kg"},
        "label": "2",
    }
    assert groups.scene_of(raw).parameters["coupler_length2"] == 0.5


def test_a_cam_roller_takes_the_place_of_the_crank_pin():
    before = groups.template("crank-slider")
    raw = added(before, "cam roller")
    assert "crank_length" not in raw
    assert [group["kind"] for group in raw["groups"]] == ["cam roller", "slider"]
    ours, theirs = groups.scene_of(raw).solve(24), groups.scene_of(before).solve(24)
    assert np.allclose(ours.slider_position, theirs.slider_position, rtol=1e-14)


def test_gravity_and_friction_are_parts():
    raw = groups.template("crank-slider")
    raw = groups.edited(raw, {"do": "remove", "at": ["gravity"]})
    assert not any(isinstance(load, ks.Gravity) for load in groups.scene_of(raw).loads)
    raw = groups.edited(raw, {"do": "add", "at": ["gravity"]})
    assert any(isinstance(load, ks.Gravity) for load in groups.scene_of(raw).loads)
    for joint in ("B", "guide"):
        raw = groups.edited(raw, {"do": "add", "at": ["friction"], "kind": joint})
    raw = groups.edited(raw, change("friction", "B", radius="12 mm"))
    friction = groups.scene_of(raw).friction
    assert friction["B"].radius == 0.012
    assert friction["guide"].mu == 0.1
    assert list(groups.edited(raw, {"do": "remove", "at": ["friction", "B"]})["friction"]) == ["guide"]


# Groups are changed and removed


def test_a_key_changes_and_an_empty_text_takes_it_away():
    raw = groups.template("crank-slider")
    found = groups.edited(raw, change("groups", 0, **{"coupler_length": "0.5 m", "slider.mass": ""}))
    parameters = groups.scene_of(found).parameters
    assert (parameters["coupler_length"], parameters["slider.mass"]) == (0.5, 0.0)
    assert parameters["coupler.centre.along"] == 0.25  # mid-length
    assert raw == groups.template("crank-slider")


def test_another_kind_of_cam_gets_its_own_keys():
    raw = groups.edited(groups.template("cam"), change("groups", 0, **{"cam.kind": "harmonic"}))
    assert list(raw["groups"][0]["cam"]) == ["kind", "cosine"]


@pytest.mark.slow
@every("kind", ["roller follower", "flat follower", "swinging follower"])
def test_a_law_of_segments_rises_dwells_and_returns(kind):
    raw = added(groups.template("crank-slider"), kind)
    raw = groups.edited(raw, change("groups", 1, **{"cam.kind": "joined"}))
    assert np.isfinite(groups.scene_of(raw).solve(24).balancing_torque).all()
    unit = "deg" if kind.startswith("swinging") else "mm"
    text = f"harmonic, 50 {unit}, 60 {unit}, 180 deg; harmonic, 60 {unit}, 50 {unit}, 180 deg"
    raw = groups.edited(raw, change("groups", 1, **{"cam.segments": text}))
    first = {"kind": "harmonic", "start": f"50 {unit}", "end": f"60 {unit}", "angle": "180 deg"}
    assert raw["groups"][1]["cam"]["segments"][0] == first
    for wrong, words in SEGMENTS_WITH_FAULTS.items():
        with pytest.raises(groups.ChainError, match=words):
            groups.edited(raw, change("groups", 1, **{"cam.segments": wrong}))


SEGMENTS_WITH_FAULTS = {
    "harmonic, 50 mm": r"cam\.segments\[1\]\.end is missing",
    "spline, 1 mm, 2 mm, 3 deg": r"cam\.segments\[1\]\.kind is 'spline', allowed",
    "dwell, 50 mm, 180 deg, 7": r"cam\.segments\[1\]\.value 3 is not a key here",
    ";": r"cam\.segments\[1\]\.kind is '', allowed",
}


def test_crank_and_drive_change_as_a_part():
    raw = groups.edited(groups.template("four-bar"), change(crank_speed="90 rpm"))
    assert groups.scene_of(raw).crank_speed == pytest.approx(3.0 * np.pi)


def test_a_group_that_carries_others_is_removed_with_them_only_if_asked():
    raw = added(groups.template("four-bar"), "slider")
    raw = added(raw, "process force", "loads")
    raw = groups.edited(raw, {"do": "add", "at": ["friction"], "kind": "guide2"})
    removal = {"do": "remove", "at": ["groups", 0]}
    words = r"\(rocker\) carries groups\[2\] \(slider\), loads\[1\] .*, friction\.guide2; remove these too$"
    with pytest.raises(groups.ChainError, match=r"^groups\[1\] " + words):
        groups.edited(raw, removal)
    with pytest.raises(groups.ChainError, match="is the last group; add another one first"):
        groups.edited(raw, removal | {"attached": True})
    assert groups.edited(raw, {"do": "remove", "at": ["loads", 0]})["loads"] == raw["loads"][1:]
    without = groups.edited(raw, {"do": "remove", "at": ["groups", 1], "attached": True})
    assert without == groups.template("four-bar") | {"friction": {}}


FAULTS = [
    ({"do": "change", "at": ["groups", 0], "keys": {"coupler_length": "long"}}, "groups[1].coupler_length"),
    ({"do": "change", "at": ["groups", 0], "keys": {"coupler_length": "3 kg"}}, "groups[1].coupler_length"),
    ({"do": "change", "at": ["groups", 0], "keys": {"coupler_length": ""}}, "groups[1].coupler_length is missing"),
    ({"do": "change", "at": ["groups", 0], "keys": {"on": "Z"}}, "'Z'"),
    ({"do": "change", "at": ["groups", 0], "keys": {"lenght": "3 m"}}, "key is 'lenght', allowed: 'coupler_length'"),
    ({"do": "change", "at": ["groups", 7], "keys": {}}, "there is no part at ['groups', 7]"),
    ({"do": "change", "at": ["groups", True], "keys": {}}, "there is no part at ['groups', True]"),
    ({"do": "change", "at": "groups", "keys": {}}, "at must be a list"),
    ({"do": "change", "at": ["groups", 0], "keys": [1]}, "keys must be a"),
    ({"do": "change", "at": ["groups", 0], "keys": {"on": 7}}, "on must be a text"),
    ({"do": "change", "at": ["groups", 0], "keys": {"cam.kind": "circle"}}, "key is 'cam.kind', allowed: "),
    ({"do": "change", "at": ["groups", 0], "keys": {"cam.kind": ["circle"]}}, "key is 'cam.kind', allowed: "),
    ({"do": "burn", "at": []}, "do is 'burn', allowed: 'add', 'change', 'remove'"),
    ({"do": "add", "at": ["groups"], "kind": "<b>"}, "kind is '<b>', allowed: 'slider'"),
    ({"do": "add", "at": ["friction"], "kind": "Z"}, "joint is 'Z', allowed: 'O'"),
    ({"do": "add", "at": ["title"], "kind": "Z"}, "nothing can be added at ['title']"),
    ({"do": "remove", "at": []}, "the crank stays"),
    ({}, "do is None"),
]


@every("fault", FAULTS, ids=lambda fault: fault[1][:30])
def test_an_action_with_a_fault_is_refused_in_words(fault):
    action, words = fault
    with pytest.raises(ks.ParameterError) as caught:
        groups.edited(groups.template("crank-slider"), action)
    assert words in str(caught.value)


def test_a_fault_names_its_key():
    with pytest.raises(groups.ChainError) as caught:
        groups.edited(groups.template("crank-slider"), change("groups", 0, **{"slider.mass": "heavy"}))
    assert [keys for keys, _ in caught.value.faults] == [("groups", 0, "slider", "mass")]


# Hostile tables


def deep(levels):
    found = {}
    for _ in range(levels):
        found = {"crank": found}
    return found


def with_groups(items):
    return groups.template("crank-slider") | {"groups": items}


PIN = {"kind": "pin", "on": "crank", "at": ["1 m", "0 m"]}
CHAIN = groups.template("four-bar")
HOSTILE = {
    "list": ([], "a chain must be a table"),
    "none": (None, "a chain must be a table"),
    "deep": (deep(100), "nested more than 20 deep"),
    "groups": (with_groups([PIN] * 100_000), "groups has 100000 parts; a page takes at most 40"),
    "values": (with_groups([{"kind": "slider", "x": [1] * 100_000}]), "has over 4000 values"),
    "text": ({"name": "n" * 100_000}, "name has 100000 letters"),
    "key": ({"k" * 1000: 1}, "must be a key"),
    "nan": ({"crank_speed": float("nan")}, "crank_speed must be a finite number"),
    "integer": ({"crank_speed": 10**400}, "crank_speed must be a finite number"),
    "object": ({"crank_speed": {1, 2}}, "crank_speed must be a text, number, list or table"),
    "null": ({"crank_speed": None}, "crank_speed must be a text, number, list or table"),
    "numbers as keys": ({1: 2}, "must be a key"),
    "empty": ({}, "crank_speed is missing; groups is missing"),
    "no groups": (with_groups([]), "groups must be a list of tables"),
    "kinds": (with_groups(["slider", 7]), "groups[1] must be a table with a kind"),
    "mechanism": ({"mechanism": "four-bar"}, "mechanism"),
    "load from a file": (
        groups.template("crank-slider") | {"loads": [{"kind": "process force", "force": {"file": "/etc/passwd"}}]},
        "loads[1].force.file names a file, but a page reads none",
    ),
    "cam from a file": (
        with_groups([{"kind": "cam roller", "cam": {"kind": "sampled", "table": "../secret.csv"}}]),
        "groups[1].cam.table names a file",
    ),
    "motor from a file": ({"drive": {"motor": {"kind": "table", "file": "m.csv"}}}, "drive.motor.file names a file"),
    "surrogate": (groups.template("chain") | {"name": "\ud800"}, "name must be a name"),
    "names twice": (with_groups([PIN, PIN]), "a second time"),
}


@pytest.mark.slow
@every("name", HOSTILE)
def test_a_hostile_table_ends_in_one_message(name):
    raw, words = HOSTILE[name]
    with pytest.raises(groups.ChainError) as caught:
        groups.scene_of(raw)
    assert words in str(caught.value)
    assert len(str(caught.value)) < 4000
    if name not in ("object", "numbers as keys"):  # no JSON
        found = Session(CHAIN).answer({"id": 1, "kind": "describe", "state": {"chain": raw}})
        assert words in found["problem"]


def test_names_with_quotes_and_markup_are_names():
    raw = groups.template("chain") | {"name": 'a "b" <script>alert(1)</script>'}
    assert groups.scene_of(raw).mechanism.name == raw["name"]


# Forms


def test_fields_have_the_texts_of_the_schema():
    (length, *_) = fields(groups.MODELS["groups"]["slider"], {})
    assert length == {
        "key": "coupler_length",
        "text": 'From the joint "on" to "pin".',
        "required": True,
        "unit": "m",
        "form": "text",
        "default": "",
        "choices": [],
    }


@every("part", KINDS, ids=lambda part: part[1])
def test_every_field_is_told_of(part):
    name, kind = part
    for field in fields(groups.MODELS[name][kind], {}):
        assert field["text"].endswith("."), field["key"]
        assert field["form"] in ("text", "number", "choice", "list", "place", "places", "segments")
        assert field["form"] != "choice" or len(field["choices"]) > 0
        assert "file" not in field["text"]


@pytest.mark.slow
@every("part", KINDS, ids=lambda part: part[1])
def test_texts_of_a_part_give_the_part_again(part):
    name, kind = part
    found = added(groups.template("crank-slider"), kind, name)
    own = next(item for item in found[name][::-1] if item["kind"] == kind)
    model = groups.MODELS[name][kind]
    texts = {field["key"]: text_of(groups._value(own, field["key"])) for field in fields(model, own)}
    assert with_texts(model, own, texts) == own


@every(
    "case",
    [
        ("30 mm", "text", "30 mm"),
        ("2", "text", "2"),
        (" 1.3 ", "number", 1.3),
        ("1/3", "number", "1/3"),
        ("nan", "number", "nan"),
        ("-1", "choice", -1),
        ("open", "choice", "open"),
        ("true", "choice", True),
        ("30 mm, 5 mm", "list", ["30 mm", "5 mm"]),
        ("30 mm", "list", ["30 mm"]),
        ("mid-length", "place", "mid-length"),
        ("coupler, 0.5 m, 0 m", "place", ["coupler", "0.5 m", "0 m"]),
        ("B; 1 m, 0 m", "places", ["B", ["1 m", "0 m"]]),
    ],
    ids=lambda case: f"{case[0]} {case[1]}",
)
def test_a_text_becomes_the_value_of_a_table(case):
    text, form, value = case
    assert value_of(text, form) == value
    assert type(value_of(text, form)) is type(value)


@every(
    "number", [(0.412, "m"), (0.1, "m"), (1.0 / 3.0, "m"), (0.7, "rad"), (np.pi / 4, "rad"), (31.4, "rad/s")], ids=str
)
def test_a_number_as_text_is_read_exactly(number):
    from kinetostatics.numbers.units import to_si

    value, unit = float(number[0]), number[1]
    assert to_si(number_text(value, unit), unit) == value


# States: numbers of sliders stay with their groups


def state_of(kind, **values):
    return {"variant": kind, "values": values, "chain": groups.template(kind)}


def test_changed_numbers_stay_when_a_group_is_added():
    values = {"crank_length": 0.1 / 3, "rocker_pivot.x": 0.34, "crank.centre.across": 0.001, "crank_speed": 7.1}
    state = state_of("four-bar", **values)
    found, notes = groups.state_after(state, {"do": "add", "at": ["groups"], "kind": "slider"})
    parameters = groups.scene_of(found["chain"]).varied(found["values"]).parameters
    assert {path: parameters[path] for path in values} == values
    assert notes == []
    assert state == state_of("four-bar", **values)


@pytest.mark.slow
def test_numbers_written_into_the_table_give_the_same_scene_bit_for_bit():
    values = {
        path: 1.01 * value + 1e-3 / 3 for path, value in groups.scene_of(groups.template("chain")).parameters.items()
    }
    raw, left = groups.with_values(groups.template("chain"), values)
    assert_same(groups.scene_of(raw).varied(left), groups.scene_of(groups.template("chain")).varied(values))
    assert left == {}


def test_a_number_without_a_place_in_the_table_stays_beside_it():
    state = state_of("crank-slider", **{"coupler.centre.along": 0.19})  # mid-length in the table
    found, _ = groups.state_after(state, {"do": "remove", "at": ["loads", 0]})
    assert found["values"] == {"coupler.centre.along": 0.19}
    found, notes = groups.state_after(found, change("groups", 0, **{"coupler.centre": "150 mm"}))
    assert found["values"] == {}
    assert notes == ["changed numbers are lost with the part that had them: coupler.centre.along"]


@every(
    "case",
    [
        (["groups", 1], ["O", "A", "B", "O2", "C"]),
        (["loads", 0], ["crank", "coupler", "rocker", "coupler2", "slider2", "frame"]),
        (["loads", 2], ["slider2"]),
    ],
    ids=str,
)
def test_names_are_chosen_among_joints_links_or_sliders(case):
    at, names = case
    raw = added(added(groups.template("four-bar"), "slider"), "process force", "loads")
    part = next(item for item in groups.parts_of({"chain": raw})["parts"] if item["at"] == at)
    assert next(field["choices"] for field in part["fields"] if field["key"] == "on") == names


def test_numbers_of_a_removed_group_are_named():
    state = state_of("chain", **{"slider2.mass": 0.7, "slider.mass": 0.6})
    found, notes = groups.state_after(state, {"do": "remove", "at": ["groups", 1]})
    assert notes == ["changed numbers are lost with the part that had them: slider2.mass"]
    assert groups.scene_of(found["chain"]).parameters["slider.mass"] == 0.6


def test_parts_show_the_numbers_of_the_sliders():
    parts = groups.parts_of(state_of("four-bar", crank_length=0.12))
    crank, rocker = (next(item for item in parts["parts"] if item["at"] == at) for at in ([], ["groups", 0]))
    assert {field["key"]: field["value"] for field in crank["fields"]}["crank_length"] == "120 mm"
    assert rocker["title"] == "1 rocker B"
    assert {field["key"]: field["value"] for field in rocker["fields"]}["pivot"] == "350 mm, 100 mm"
    assert {"at": ["friction"], "kind": "O2", "about": "Friction at O2."} in parts["kinds"]
    json.dumps(parts)


# Requests of a page


def test_a_page_asks_for_parts_and_actions():
    state = state_of("four-bar")
    parts = groups.answer_groups(None, {"state": state})["parts"]
    assert [part["title"] for part in parts] == ["crank", "1 rocker B", "gravity", "1 torque", "2 force"]
    found = groups.answer_edit(None, {"state": state, "action": {"do": "add", "at": ["groups"], "kind": "slider"}})
    assert len(found["state"]["chain"]["groups"]) == 2
    removal = {"do": "remove", "at": ["groups", 0]}
    refused = groups.answer_edit(None, {"state": found["state"], "action": removal})
    assert refused["carried"] == [("groups", 1), ("loads", 0), ("loads", 1)]
    wrong = {"do": "change", "at": ["groups", 0], "keys": {"pivot": "1 m, x", "coupler.mass": "-1 kg"}}
    refused = groups.answer_edit(None, {"state": state, "action": wrong})
    assert [fault["key"] for fault in refused["faults"]] == ["pivot", "coupler.mass"]


@every("state", [None, {}, {"variant": "plain", "values": {}}], ids=str)
def test_only_a_chain_has_groups(state):
    for answer in (groups.answer_groups, groups.answer_edit):
        with pytest.raises(ks.ParameterError, match="only a chain that was begun by --new"):
            answer(None, {"state": state, "action": {"do": "remove", "at": []}})


def test_a_broken_chain_and_an_action_without_a_place_end_in_words():
    found = groups.answer_edit(None, {"state": {"chain": {"crank_speed": "x"}}, "action": {}})
    assert "crank_speed must be" in found["problem"]
    assert {fault["key"] for fault in found["faults"]} == {"crank_speed", "groups"}


@pytest.mark.slow
@every("kind", STARTERS)
def test_a_session_begins_with_a_chain_and_keeps_its_state(kind, tmp_path):
    session = Session(groups.template(kind), folder=tmp_path)

    def answer(kind, **fields):
        found = session.answer({"id": 1, "kind": kind, **fields})
        assert "problem" not in found
        return found

    state = answer("open")["start"]
    assert state["chain"] == groups.template(kind)
    action = {"do": "add", "at": ["groups"], "kind": "dyad"}
    state = answer("edit", state=state | {"values": {"crank_speed": 5.0}}, action=action)["state"]
    assert "dyad1.mass" in [field["path"] for field in answer("describe", state=state)["parameters"]]
    looked = answer("look", state=state | {"values": {"dyad1.mass": 2.0}}, show=["balancing_torque"], count=24)
    assert looked["values"]["dyad1.mass"] == 2.0
    assert answer("save", state=looked["state"], name=kind)["saved"] == f"{kind}.toml"
    again = list(ks.load_case(tmp_path / f"{kind}.toml").variants.values())[-1].scene
    assert_same(session.scene(looked["state"]), again)
    python = answer("python", state=looked["state"])["text"]
    names = {}
    exec(compile(python, "text", "exec"), names)
    assert np.array_equal(
        names["solution"].balancing_torque, session.scene(looked["state"]).solve(360).balancing_torque
    )


@every("options", [[], ["compressor", "--new", "cam"]], ids=str)
def test_the_command_needs_a_case_or_a_mechanism_to_begin_with(options, capsys):
    assert main(["explore", *options, "--no-browser"]) == 2
    assert "explore: give a case, or --new with a mechanism to begin with" in capsys.readouterr().err


# A chain of many actions is the same from a file


@pytest.mark.slow
def test_an_edited_chain_is_equal_when_read_from_a_file(tmp_path):
    state = state_of("four-bar", crank_length=0.11, **{"coupler.mass": 4.4})
    for action in (
        {"do": "add", "at": ["groups"], "kind": "slider"},
        {"do": "add", "at": ["loads"], "kind": "process force"},
        {"do": "add", "at": ["friction"], "kind": "O"},
        {"do": "change", "at": ["groups", 1], "keys": {"slider.mass": "3.3 kg", "guide_offset": "0.3 m"}},
    ):
        state, _ = groups.state_after(state, action)
    scene = groups.scene_of(copy.deepcopy(state["chain"])).varied(state["values"])
    assert_same(scene, from_file(state["chain"], tmp_path))
