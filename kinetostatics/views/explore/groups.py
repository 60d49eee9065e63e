"""Chains built on the page: templates, and tables of a case file whose groups, loads and friction change.

The table of a chain is part of the state, ``state["chain"]``: keys and texts as in a case file, of a mechanism "chain".
It is read by the schema of case files, with its messages; it names no files, for a page opens none.

An action on a part has `do`, "add", "change" or "remove", and `at`: [] is the crank, ["gravity"], ["groups", 1],
["loads", 0], ["friction", "O"]. To add, `at` is the list alone, ["groups"], and `kind` one of its kinds. `keys` are
texts of the form by key.
"""

import copy
import json
import math
import tomllib
from functools import lru_cache
from typing import Any, NamedTuple

from ...casefile import build
from ...casefile.build import PartsError, build_scene, places_by_path, value_at
from ...casefile.reading import MAX_DEPTH, inherit
from ...casefile.schema.meanings import about, word_of
from ...casefile.schema.parts import GROUPS, LOADS, MADE_OF
from ...casefile.schema.tables import GravityTable, key_path, validate_by_keys
from ...casefile.schema.variants import ChainVariant, FrictionTable
from ...casefile.starters import STARTERS, starter
from ...errors import KinetostaticsError, ParameterError
from ...machine.group import FRAME
from ...numbers import checks
from ...solution.scene import Scene
from . import proposals
from .forms import FILE_KEYS, fields, number_text, plain, text_of, with_texts

MAX_PARTS = 40
"""Most groups, and most loads, of a chain built on a page."""
MAX_VALUES, MAX_TEXT, MAX_INTEGER = 4000, 200, 2**53
"""Most keys and list items of a table, letters of a text, and size of a whole number."""
KEPT_CHAINS = 16
"""Chains whose scenes are kept."""
MODELS: dict[str, dict[str, Any]] = {
    "groups": {word_of(model): model for model, kind in MADE_OF.items() if kind in GROUPS.values()},
    "loads": {word_of(model): model for model, kind in MADE_OF.items() if kind in LOADS.values()},
}
"""Tables by kind, of groups and loads."""
AS_GROUPS = {"crank-slider": ("slider",), "four-bar": ("rocker",), "cam-crank-slider": ("cam roller", "slider")}
"""Kinds of the groups by the name of a mechanism."""
AS_LOADS = {"spring": "spring", "process_force": "process force"}
"""Kinds of loads that have a table of their own in some mechanisms."""
RENAMED = {"rocker_pivot": "pivot"}
"""Keys of mechanisms that groups call otherwise."""
REFERENCES = ("on", "against", "at", "between", "along")
"""Keys of groups and loads that name joints and links of other groups."""


class ChainError(ParameterError):
    """Faults of a chain: `faults` are pairs of keys, from the top of its table, and sentence.

    `carried` are the places of the parts attached to one that cannot be removed alone.
    """

    def __init__(self, faults, carried=()):
        self.faults, self.carried = tuple(faults), tuple(carried)
        super().__init__("; ".join(sentence for _, sentence in self.faults))


class Chain(NamedTuple):
    """A validated table and its scene."""

    table: ChainVariant
    scene: Scene


# Tables


def template(kind):
    """Table of the first variant of a starter case, as a chain."""
    checks.require("explore", checks.choice("kind", kind, STARTERS))
    raw = tomllib.loads(starter(kind, kind))
    return as_chain(inherit(raw["common"], next(iter(raw["variants"].values()))))


def as_chain(raw):
    """The table of a mechanism with a name as that of a chain with the same numbers."""
    name = raw.get("mechanism", "chain")
    if name not in AS_GROUPS:
        return raw
    named = {RENAMED.get(key, key): value for key, value in raw.items()}
    own = set(ChainVariant.model_fields) - {"groups", "loads", "mechanism", "name"}
    groups = [
        {"kind": word}
        | {key: named[key] for key in MODELS["groups"][word].model_fields if key in named and key not in own}
        for word in AS_GROUPS[name]
    ]
    loads = [{"kind": word, **raw[key]} for key, word in AS_LOADS.items() if key in raw]
    kept = {key: value for key, value in raw.items() if key in own}
    return {"mechanism": "chain", "name": name, **kept, "groups": groups, "loads": [*loads, *raw.get("loads", ())]}


def scene_of(raw):
    """Scene of the table of a chain. Raises `ChainError`, which lists all faults with their keys."""
    return read(raw).scene


def read(raw) -> Chain:
    """The table of a chain, validated, and its scene."""
    if problem := _refusal(raw):
        raise ChainError([problem])
    return _read(json.dumps(raw))


@lru_cache(KEPT_CHAINS)
def _read(text):
    table, found = validate_by_keys(ChainVariant, json.loads(text))
    if table is None:
        raise ChainError(found)
    try:
        return Chain(table, build_scene(table, {})[0])
    except PartsError as error:
        raise ChainError([(keys, f"{key_path(keys)}: {sentence}") for keys, sentence in error.problems]) from None
    except KinetostaticsError as error:
        raise ChainError([((), str(error))]) from None


def _refusal(raw):
    """Keys and sentence on a table that is too large, no JSON, or names a file; else None."""
    if not isinstance(raw, dict):
        return (), f"a chain must be a table, found {checks.shown(raw)}"
    level: list[tuple[tuple, Any]] = [((), raw)]
    count = 0
    for _ in range(MAX_DEPTH):
        inner = []
        for keys, item in level:
            for key, value in item.items() if isinstance(item, dict) else enumerate(item):
                count, place = count + 1, (*keys, key)
                if problem := _unfit(key, value, item) or (count > MAX_VALUES and f"has over {MAX_VALUES} values"):
                    return place[:2], f"{key_path(place)[:MAX_TEXT]} {problem}"
                if isinstance(value, dict | list):
                    inner.append((place, value))
        if not inner:
            return None
        level = inner
    return (), f"a chain has tables nested more than {MAX_DEPTH} deep"


def _unfit(key, value, item):
    """Fault of a value for a page, or None."""
    if isinstance(item, dict) and (not isinstance(key, str) or len(key) > MAX_TEXT):
        return f"must be a key, a text of at most {MAX_TEXT} letters"
    if key in FILE_KEYS:
        return "names a file, but a page reads none; write the number here, or the table in a case file"
    if key in MODELS and isinstance(value, list) and len(value) > MAX_PARTS:
        return f"has {len(value)} parts; a page takes at most {MAX_PARTS}"
    if isinstance(value, str) and len(value) > MAX_TEXT:
        return f"has {len(value)} letters; a page takes at most {MAX_TEXT}"
    if not isinstance(value, dict | list | str | bool | int | float):
        return f"must be a text, number, list or table, found {checks.shown(value)}"
    if isinstance(value, float | int) and not (
        math.isfinite(value) if isinstance(value, float) else abs(value) < MAX_INTEGER
    ):
        return f"must be a finite number below {MAX_INTEGER}, found {checks.shown(value)}"
    return None


# Changes


def edited(raw, action):
    """Table of a chain after an action. Raises `ChainError` if the result, or the action, has a fault."""
    do, at, texts = action.get("do"), action.get("at"), action.get("keys", {})
    checks.require("explore", checks.choice("do", do, ("add", "change", "remove")), checks.mapping("keys", texts))
    checks.require("explore", None if isinstance(at, list) else f"at must be a list, got {checks.shown(at)}")
    chain, found = read(raw), copy.deepcopy(raw)
    if do == "add":
        return _added(chain, found, at, action.get("kind"), texts)
    owner, key, model = _part(found, at)
    if do == "remove":
        return _removed(chain, found, at, bool(action.get("attached")))
    part = owner[key]
    kind = texts.get("cam.kind")
    if "cam" in part and isinstance(kind, str) and kind in proposals.CAMS and kind != part["cam"]["kind"]:
        part["cam"] = proposals.cam_of_kind(kind, getattr(MADE_OF[model], "LAW", ("", "m"))[1])
        texts = {key: text for key, text in texts.items() if not key.startswith("cam.")}
    owner[key] = with_texts(model, part, texts)
    found = owner[key] if not at else found
    read(found)
    return found


def _part(raw, at):
    """Owner, key and model of a part at a place."""
    match at:
        case []:
            return [raw], 0, ChainVariant
        case ["gravity"] if "gravity" in raw:
            return raw, "gravity", GravityTable
        case ["friction", str(joint)] if joint in raw.get("friction", {}):
            return raw["friction"], joint, FrictionTable
        case ["groups" | "loads" as name, int(number)] if 0 <= number < len(raw.get(name, ())):
            return raw[name], number, MODELS[name][raw[name][number]["kind"]]
    raise ParameterError(f"explore: there is no part at {checks.shown(at)}")


def _added(chain, raw, at, kind, texts):
    """Table with another part of a kind; keys not given are proposed."""
    mechanism = chain.scene.mechanism
    match at:
        case ["gravity"]:
            return _tried(
                raw | {"gravity": with_texts(GravityTable, proposals.proposed_load("gravity", mechanism), texts)}
            )
        case ["friction"]:
            checks.require("explore", checks.choice("joint", kind, tuple(mechanism.pairs)))
            part = with_texts(FrictionTable, proposals.proposed_friction(kind, mechanism), texts)
            return _tried(raw | {"friction": raw.get("friction", {}) | {kind: part}})
        case ["groups" | "loads" as name]:
            checks.require("explore", checks.choice("kind", kind, tuple(MODELS[name])))
            propose = proposals.proposed_group if name == "groups" else proposals.proposed_load
            proposed = propose(kind, mechanism)
            part = with_texts(MODELS[name][kind], {"kind": kind, **proposed}, texts)
            if kind == "cam roller" and chain.table.crank_length is not None:
                return _on_cam(raw, chain.table.crank_length, part)
            labels = [""]
            if "label" in MODELS[name][kind].model_fields and "label" not in part:
                labels += [str(number) for number in range(2, 3 + len(raw["groups"]))]
            return _first_fit(raw, name, part, labels)
    raise ParameterError(f"explore: nothing can be added at {checks.shown(at)}")


def _on_cam(raw, crank_length, part):
    """Table with a cam roller in place of the pin of the crank, first on the circle of the pin."""
    part["cam"] = {"kind": "circle", "radius": number_text(crank_length, "m")}
    slotted = {key: value for key, value in raw.items() if key != "crank_length"}
    return _tried(slotted | {"groups": [part, *raw["groups"]]})


def _first_fit(raw, name, part, labels):
    """Table with a part under the first label that names nothing twice; with the fault of the first if none fits."""
    faults = []
    for label in labels:
        try:
            return _tried(raw | {name: [*raw.get(name, ()), part | ({"label": label} if label else {})]})
        except ChainError as error:
            faults.append(error)
    raise faults[0]


def _tried(raw):
    read(raw)
    return raw


def _removed(chain, raw, at, attached):
    """Table without a part; with the parts attached to it only if `attached`."""
    if not at:
        raise ParameterError("explore: the crank stays; change its keys")
    gone = _with_attached(chain, tuple(at)) if at[0] == "groups" else [tuple(at)]
    if len(gone) > 1 and not attached:
        names = ", ".join(_name(raw, place) for place in gone[1:])
        raise ChainError([(tuple(at), f"{_name(raw, gone[0])} carries {names}; remove these too")], gone[1:])
    found: dict[str, Any] = {}
    for key, value in raw.items():
        if isinstance(value, list) and key in MODELS:
            value = [part for number, part in enumerate(value) if (key, number) not in gone]
        elif key == "friction":
            value = {joint: part for joint, part in value.items() if (key, joint) not in gone}
        if (key,) not in gone:
            found[key] = value
    if not found["groups"]:
        raise ChainError([(tuple(at), f"{_name(raw, gone[0])} is the last group; add another one first")])
    return _tried(found)


def _name(raw, place):
    """A part in words: "groups[2] (dyad)"."""
    kind = raw[place[0]][place[1]]["kind"] if place[0] in MODELS else ""
    return key_path(place) + (f" ({kind})" if kind else "")


def _with_attached(chain, at):
    """Places of a group and of all groups, loads and friction attached to it, directly or by another."""
    groups, gone = chain.scene.mechanism.groups, [at]
    parts = [(name, number) for name in MODELS for number in range(len(getattr(chain.table, name)))]
    names: set[str] = set()
    for place in gone:  # grows
        if place[0] != "groups":
            continue
        group = groups[place[1]]
        names |= {*group.links, *group.joints}
        gone += [
            other
            for other in parts
            if other not in gone and names & _references(getattr(chain.table, other[0])[other[1]])
        ]
    kept = {pair for number, group in enumerate(groups) if ("groups", number) not in gone for pair in group.pairs}
    lost = [joint for joint in chain.table.friction if joint not in kept and joint != "O"]
    return [gone[0], *sorted(gone[1:]), *(("friction", joint) for joint in lost)]


def _references(part):
    """Names of joints and links that a group or load refers to."""
    found: set[str] = set()
    values = [getattr(part, key) for key in REFERENCES if hasattr(part, key)]
    while values:
        value = values.pop()
        if isinstance(value, str):
            found.add(value)
        elif isinstance(value, tuple):
            values += value
    return found


# States


def with_values(raw, values):
    """Table with numbers by path in SI written into it, and those without a place in it."""
    table = read(raw).table
    places = {path: place for path, place in places_by_path(table).items() if path in values}
    places = {path: place for path, place in places.items() if not isinstance(value_at(table, place.steps), str)}
    changed = build.with_values(table, {place.steps: values[path] for path, place in places.items()})
    found = copy.deepcopy(raw)
    for place in places.values():
        _write(found, changed, place)
    return found, {path: value for path, value in values.items() if path not in places}


def _write(raw, table, place):
    """Write the number at a place of a validated table into the other; a pair or series as a whole."""
    steps = place.steps[:-1] if isinstance(place.steps[-1], int) else place.steps
    value = value_at(table, steps)
    *outer, name = steps
    for step in outer:
        raw = raw[step] if isinstance(step, int) else raw.setdefault(step, {})
    several = isinstance(value, tuple)
    raw[name] = [number_text(part, place.unit) for part in value] if several else number_text(value, place.unit)


def state_after(state, action):
    """State after an action on its chain, and sentences on numbers that are lost with it.

    Numbers that were changed are written into the table; one without a place there stays as long as the action
    leaves it.
    """
    values = state.get("values", {})
    raw, left = with_values(state["chain"], values)
    found = edited(raw, action)
    before, after = scene_of(raw).parameters, scene_of(found).parameters
    kept = {path: value for path, value in left.items() if path in after and after[path] == before.get(path)}
    lost = [path for path in values if path not in after or (path in left and path not in kept)]
    notes = [f"changed numbers are lost with the part that had them: {', '.join(lost)}"] if lost else []
    return state | {"values": kept, "chain": found}, notes


def parts_of(state):
    """Parts of the chain of a state, each with its place, title and the fields of its form, and kinds to add."""
    raw, _ = with_values(state["chain"], state.get("values", {}))
    table, mechanism = read(raw).table, read(raw).scene.mechanism
    places: list[list[Any]] = [[], *(["groups", number] for number in range(len(raw["groups"])))]
    places += [["gravity"]] if "gravity" in raw else []
    places += [["loads", number] for number in range(len(raw.get("loads", ())))]
    places += [["friction", joint] for joint in raw.get("friction", {})]
    found = []
    for at in places:
        owner, key, model = _part(raw, at)
        entries = fields(model, owner[key])
        if at[:1] == ["friction"]:
            entries = [item for item in entries if item["key"] in proposals.friction_keys(at[1], mechanism)]
        entries = [
            item | {"value": text_of(_value(owner[key], item["key"]))} | _names(item, model, mechanism)
            for item in entries
        ]
        found.append(
            {"at": at, "title": _title(table, at), "about": plain(about(model)) if at else "", "fields": entries}
        )
    kinds = [
        {"at": [name], "kind": kind, "about": plain(about(model))}
        for name in MODELS
        for kind, model in MODELS[name].items()
    ]
    kinds += [] if "gravity" in raw else [{"at": ["gravity"], "kind": "gravity", "about": "Weight of all masses."}]
    free = [joint for joint in mechanism.pairs if joint not in raw.get("friction", {})]
    kinds += [{"at": ["friction"], "kind": joint, "about": f"Friction at {joint}."} for joint in free]
    return {"parts": found, "kinds": kinds}


def answer_groups(session, request):
    """Parts of the chain of a state, and kinds to add."""
    return parts_of(_with_chain(request))


def answer_edit(session, request):
    """State after an action, or its faults: each with the key of the field that it names, or ""."""
    action = request["action"]
    try:
        state, notes = state_after(_with_chain(request), action)
    except ChainError as error:
        place = tuple(action["at"]) if isinstance(action.get("at"), list) else ()
        faults = [{"key": _key(keys, place), "text": sentence} for keys, sentence in error.faults]
        return {"problem": str(error), "faults": faults, "carried": list(error.carried)}
    return {"state": state, "notes": notes}


def _with_chain(request):
    """State of a request that must have a chain."""
    state = request.get("state")
    if not isinstance(state, dict) or "chain" not in state:
        raise ParameterError("explore: only a chain that was begun by --new has groups to change")
    return state


def _key(keys, place):
    """Key of a form at a place for the keys of a fault; "" if it belongs to another part."""
    inner = keys[len(place) :] if keys[: len(place)] == place else ()
    return ".".join(key for key in inner if isinstance(key, str))


def _title(table, at):
    """Title of a part: "2 dyad D"."""
    match at:
        case []:
            return "crank"
        case ["groups" | "loads" as name, number]:
            part = getattr(table, name)[number]
            joint = getattr(part, "pin", getattr(part, "name", ""))
            return " ".join(filter(None, (str(number + 1), part.kind, joint)))
        case ["friction", joint]:
            return f"friction at {joint}"
    return at[0]


def _names(field, model, mechanism):
    """Joints or links to choose from for a key that names one."""
    if field["form"] != "text" or field["key"] not in ("on", "against", "along"):
        return {}
    if field["default"] == "slider":
        return {"choices": list(mechanism.guides)}
    on_joint = field["key"] == "on" and word_of(model) in GROUPS and word_of(model) != "pin"
    return {"choices": list(mechanism.joints) if on_joint else [*mechanism.links, FRAME]}


def _value(raw, key):
    for step in key.split("."):
        raw = raw.get(step) if isinstance(raw, dict) else None
    return raw
