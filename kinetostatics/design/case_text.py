"""Scenes written as case files: what a design is, ready for `kinetostatics run` and `ks.load_case`.

Keys and units are those of the parts' own rules, as case files have them; numbers are written with all their digits.
"""

import json
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..machine.cam_roller import CamRoller
from ..machine.cams import Circle, CosineLaw
from ..machine.guide import Guide
from ..machine.harmonic_cam import Harmonic
from ..machine.links import Link
from ..machine.loads import KINDS, Gravity
from ..machine.loads.places import Between, Place
from ..machine.roller import Roller
from ..machine.slider_group import SliderGroup
from ..numbers import checks
from ..numbers.files import written_whole

CAMS: dict[Any, str] = {Circle: "circle", CosineLaw: "cosine-law", Harmonic: "harmonic"}


def write(path, title, scenes, source="", *, comment="", designs=None) -> Path:
    """Write a case file of scenes by the names of their variants, the first as reference.

    Before them may stand a comment, behind them tables of designs as they stood in another file.

    Raises
    ------
    ParameterError
        A part of a scene is a function, a table or an object that case files have no text for.
    FileError
        The file cannot be written.
    """
    path = Path(path)
    parts = [f"# {line}" for line in comment.splitlines()]
    parts += [f"title = {_quoted(title)}"]
    parts += [f"source = {_quoted(source)}"] if source else []
    parts += [f"reference = {_quoted(next(iter(scenes)))}"]
    parts += [variant(name, scene) for name, scene in scenes.items()]
    parts += [table(f"design.{_key(name)}", raw) for name, raw in (designs or {}).items()]
    with written_whole(path) as place:
        Path(place).write_text("\n".join(parts) + "\n", encoding="utf-8")
    return path


def table(head, raw) -> str:
    """Text of a table as it was read from a case file, tables within it below."""
    inner = {key: value for key, value in raw.items() if isinstance(value, dict)}
    own = [f"{_key(key)} = {_plain_text(value)}" for key, value in raw.items() if key not in inner]
    return "\n".join(["", f"[{head}]", *own, *(table(f"{head}.{_key(key)}", value) for key, value in inner.items())])


def _plain_text(value):
    """Text, truth values, numbers and lists of them as TOML and JSON alike have them."""
    return json.dumps(value, ensure_ascii=False)


def variant(name, scene) -> str:
    """Text of a variant of a case file: a scene under a name."""
    head = f"variants.{_key(name)}"
    keys, tables = _mechanism(scene.mechanism)
    keys["crank_speed"] = _number(scene.crank_speed, "rad/s", "crank_speed")
    if np.any(scene.crank_acceleration):
        keys["crank_acceleration"] = _number(scene.crank_acceleration, "rad/s^2", "crank_acceleration")
    lines = ["", f"[{head}]", *(f"{key} = {value}" for key, value in keys.items())]
    gravity = [item for item in scene.loads if isinstance(item, Gravity)]
    others = [item for item in scene.loads if not isinstance(item, Gravity)]
    if len(gravity) > 1:
        raise ParameterError("case file: takes one Gravity, the scene has several")
    for item in gravity:
        tables.append(("gravity", _keys(item)))
    for joint, friction in scene.friction.items():
        tables.append((f"friction.{_key(joint)}", _keys(friction)))
    tables += [("[loads]", {"kind": _quoted(_word(item)), **_keys(item)}) for item in others]
    for table, own in tables:
        repeated = table.startswith("[")
        opened = f"[[{head}.{table[1:-1]}]]" if repeated else f"[{head}.{table}]"
        lines += ["", opened, *(f"{key} = {value}" for key, value in own.items())]
    return "\n".join(lines)


def _mechanism(mechanism):
    """Keys of a mechanism, and its tables."""
    *before, last = mechanism.groups
    crank = _link(mechanism.crank.link)
    keys: dict[str, str] = {}
    tables = [("crank", crank)] if crank else []
    if mechanism.crank.length is not None:
        keys["crank_length"] = _number(mechanism.crank.length, "m", "crank_length")
    rollers = [group for group in before if isinstance(group, CamRoller)]
    usual = isinstance(last, SliderGroup) and (last.on, last.pin, last.label) == ("A", "B", "")
    if usual and len(before) == len(rollers) <= 1:
        own = _keys(last) | (_keys(rollers[0]) if rollers else {})
        kept = {key: value for key, value in own.items() if key not in ("on", "pin", "label")}
        return {"mechanism": _quoted("cam-crank-slider" if rollers else "crank-slider"), **keys, **kept}, tables
    tables += [("[groups]", {"kind": _quoted(_group_word(group)), **_keys(group)}) for group in mechanism.groups]
    return {"mechanism": _quoted("chain"), "name": _quoted(mechanism.name), **keys}, tables


def _group_word(group):
    """Word for a kind of group: "cam roller", "slider"."""
    name = type(group).__name__.removesuffix("Group")
    return "".join(f" {letter}" if letter.isupper() else letter for letter in name).strip().lower()


def _word(load):
    if type(load) not in KINDS:
        raise ParameterError(f"case file: has no text for the load {checks.shown(load)}")
    return load.PATH.replace("_", " ")


def _keys(item):
    """Keys of a part by its rules; those at their defaults are left out."""
    defaults = {field.name: field.default for field in fields(item)}
    found: dict[str, str] = {}
    for name, rule in item.RULES.rules.items():
        value = getattr(item, name)
        if value is None or (
            defaults[name] is not MISSING and type(value) is type(defaults[name]) and value == defaults[name]
        ):
            continue
        if isinstance(value, Guide):
            found |= _guide(value)
        elif isinstance(value, Link):
            link = _link(value)
            found |= {name: _inline(link)} if link else {}
        elif isinstance(value, Roller):
            found[name] = _inline(_keys(value))
        elif name == "cam":
            found["cam"] = _cam(value)
        else:
            found[name] = _value(value, rule, name)
    return found


def _value(value, rule, name):
    """Text of a value by its rule."""
    if isinstance(rule, checks.Optional | checks.OrFunction):
        return _value(value, rule.rule, name)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(rule, Between):
        return f"[{', '.join(_value(part, Place(), name) for part in value)}]"
    if isinstance(value, tuple):
        unit = getattr(getattr(rule, "rule", None), "unit", "m")
        parts = (_quoted(part) if isinstance(part, str) else _number(part, _spelled(unit), name) for part in value)
        return f"[{', '.join(parts)}]"
    if isinstance(rule, checks.Number) and rule.unit in ("", "1"):
        return repr(_plain(value, name))
    return _number(value, _spelled(getattr(rule, "unit", "")), name)


def _guide(guide):
    found = {"guide_angle": _number(guide.guide_angle, "rad", "guide_angle")} if np.any(guide.guide_angle) else {}
    return found | (
        {"guide_offset": _number(guide.guide_offset, "m", "guide_offset")} if np.any(guide.guide_offset) else {}
    )


def _link(link):
    """Keys of a link that are not zero."""
    found = {}
    if np.any(link.mass):
        found["mass"] = _number(link.mass, "kg", "mass")
    if np.any(link.centre):
        found["centre"] = f"[{', '.join(_number(part, 'm', 'centre') for part in link.centre)}]"
    if np.any(link.inertia):
        found["inertia"] = _number(link.inertia, "kg m^2", "inertia")
    return found


def _cam(cam):
    if type(cam) not in CAMS:
        raise ParameterError(
            f"case file: has no text for a cam of the class {type(cam).__name__}; write it by cam.export as .csv, and "
            'name that in a case file: cam = { kind = "sampled", table = "cam.csv" }'
        )
    keys = {PLAIN.get(name, name): value for name, value in _keys(cam).items() if name != "guide_angle"}
    return _inline({"kind": _quoted(CAMS[type(cam)]), **keys})


PLAIN = {"pitch_radius": "radius"}
"""Keys of case files by fields that are called otherwise."""


def _inline(keys):
    return f"{{ {', '.join(f'{key} = {value}' for key, value in keys.items())} }}"


def _number(value, unit, name):
    return _quoted(f"{_plain(value, name)!r} {unit}")


def _plain(value, name):
    if isinstance(value, float | int) or (isinstance(value, np.ndarray) and value.size == 1):
        return float(value)
    raise ParameterError(f"case file: {name} must be one number to be written, got {checks.shown(value)}")


def _spelled(unit):
    """A unit as case files have it."""
    return unit.replace("**", "^").replace("*", " ") or "1"


def _quoted(text):
    return json.dumps(text, ensure_ascii=False)


def _key(name):
    return name if name.replace("-", "").replace("_", "").isalnum() and name.isascii() else _quoted(name)
