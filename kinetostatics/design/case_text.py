"""Scenes written as case files for `kinetostatics run` and `ks.load_case`.

Keys and units follow the rules of the parts; numbers keep all digits. Tables of loads and cams go to CSV files next to
the case file, named after it, the variant and the part.
"""

import json
import os
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import FileError, ParameterError
from ..machine.builders import crank_slider_parts
from ..machine.cams.cam import Harmonic
from ..machine.cams.cams import Circle, CosineLaw, Sampled
from ..machine.cams.roller import Roller
from ..machine.guide import Guide
from ..machine.links import Link
from ..machine.loads import KINDS, TURN, Gravity, Table
from ..machine.loads.points import PlacePairRule, PlaceRule
from ..machine.loads.table import COLUMNS, VALUE_HEADINGS
from ..numbers import checks
from ..numbers.files import write_atomically
from ..numbers.parameter_tree import Axis

CAMS: dict[Any, str] = {Circle: "circle", CosineLaw: "cosine-law", Harmonic: "harmonic"}


def write_case(
    path, title, scenes, source="", *, comment="", references=None, drives=None, designs=None, sizing=None
) -> Path:
    """Write a case file of scenes by the names of their variants; `references` is by default the first one.

    A comment precedes them. Drives by variant, designs and parts by name are tables as another case file has them.
    Raises `ParameterError` for objects without a text in case files, `FileError` if a file cannot be written or a
    table's file has another text.
    """
    path = Path(path)
    parts = [f"# {line}" for line in comment.splitlines()]
    parts += [f"title = {_quoted(title)}"]
    parts += [f"source = {_quoted(source)}"] if source else []
    first = next(iter(scenes))
    parts += [f"reference = {_quoted(first)}"]
    own = {name: reference for name, reference in (references or {}).items() if reference != first}
    for name, scene in scenes.items():
        parts.append(variant(name, scene, path.stem, own.get(name)))
        if drive := (drives or {}).get(name):
            parts.append(table(f"variants.{_key(name)}.drive", drive))
    parts += [table(f"design.{_key(name)}", raw) for name, raw in (designs or {}).items()]
    parts += [table(f"sizing.{_key(name)}", raw) for name, raw in (sizing or {}).items()]
    for file, text in tables(path, scenes).items():
        with write_atomically(file) as place:
            Path(place).write_text(text, encoding="utf-8")
    with write_atomically(path) as place:
        Path(place).write_text("\n".join(parts) + "\n", encoding="utf-8")
    return path


def tables(path, scenes) -> dict[Path, str]:
    """Text of each file with a table of the scenes, by path beside the case file; `FileError` if one has another text.

    No table is replaced: an older case file may read it.
    """
    beside = {path.with_name(file): text for name, scene in scenes.items() for file, text in _files(name, scene, path)}
    there = [str(file) for file, text in beside.items() if os.path.lexists(file) and not _has_text(file, text)]
    if there:
        raise FileError(f"{', '.join(there)}: exists already; choose another name of the case file")
    return beside


def _has_text(path, text):
    """Whether a file has this text."""
    return path.is_file() and path.read_bytes() == text.encode()


def table(head, raw) -> str:
    """Text of a table read from a case file, inner tables below it."""
    inner = {key: value for key, value in raw.items() if isinstance(value, dict)}
    own = [f"{_key(key)} = {_quoted(value)}" for key, value in raw.items() if key not in inner]
    return "\n".join(["", f"[{head}]", *own, *(table(f"{head}.{_key(key)}", value) for key, value in inner.items())])


def variant(name, scene, stem="case", reference=None) -> str:
    """Text of a variant: a scene with a name and its own reference; names of its table files begin with `stem`."""
    head = f"variants.{_key(name)}"
    keys, tables = _mechanism_keys(scene.mechanism, _table_file(stem, name, "cam"))
    if reference is not None:
        keys["reference"] = _quoted(reference)
    keys["crank_speed"] = _number(scene.crank_speed, "rad/s", "crank_speed")
    if np.any(scene.crank_acceleration):
        keys["crank_acceleration"] = _number(scene.crank_acceleration, "rad/s^2", "crank_acceleration")
    if scene.sense is not None:
        keys["sense"] = f"{scene.sense:.0f}"
    lines = ["", f"[{head}]", *(f"{key} = {value}" for key, value in keys.items())]
    gravity = [item for item in scene.loads if isinstance(item, Gravity)]
    others = [item for item in scene.loads if not isinstance(item, Gravity)]
    if len(gravity) > 1:
        raise ParameterError("case file: only one Gravity can be written, the scene has several")
    for item in gravity:
        tables.append(("gravity", _keys(item)))
    for joint, friction in scene.friction.items():
        tables.append((f"friction.{_key(joint)}", _keys(friction)))
    named = [(item, _table_file(stem, name, f"load_{number}")) for number, item in enumerate(others, 1)]
    tables += [("[loads]", {"kind": _quoted(_load_word(item)), **_keys(item, file)}) for item, file in named]
    for table, own in tables:
        repeated = table.startswith("[")
        opened = f"[[{head}.{table[1:-1]}]]" if repeated else f"[{head}.{table}]"
        lines += ["", opened, *(f"{key} = {value}" for key, value in own.items())]
    return "\n".join(lines)


def _table_file(stem, variant, what):
    """Name of the file of a table."""
    plain = "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in variant)
    return f"{stem}_{plain}_{what}.csv"


def _files(variant, scene, path):
    """Name and text of each file with a table of a variant."""
    others = [item for item in scene.loads if not isinstance(item, Gravity)]
    for number, item in enumerate(others, 1):
        found = item.value_now
        if isinstance(found, Table):
            column, unit = COLUMNS[found.over]
            of = item.RULES.rules[item.VALUE].rule.unit
            columns = {f"{column} [{unit}]": found.sense * found.x, f"{VALUE_HEADINGS[of]} [{_unit_text(of)}]": found.y}
            if found.back is not None:
                columns[f"{VALUE_HEADINGS[of]}_back [{_unit_text(of)}]"] = found.back
            yield _table_file(path.stem, variant, f"load_{number}"), _columns(columns)
    for group in scene.mechanism.groups:
        if type(cam := getattr(group, "cam", None)) is Sampled:
            columns = {"angle [rad]": cam.angle, "radius [m]": cam.values}
            yield _table_file(path.stem, variant, "cam"), _columns(columns)


def _columns(columns):
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    return "\n".join([", ".join(columns), *(", ".join(map(repr, row)) for row in rows)]) + "\n"


def _mechanism_keys(mechanism, cam_file):
    """Keys of a mechanism, and its tables; a sampled cam refers to a file."""
    rotor, bearings = mechanism.crank.link, mechanism.crank.bearings
    crank = _link_keys(rotor)
    if rotor.plane is not None:
        crank |= {"plane": _number(rotor.plane, "m", "plane"), **_nonzero_keys(rotor, couple_unbalance="kg m^2")}
    keys: dict[str, str] = {} if bearings is None else {"bearings": _numbers(bearings, "m", "bearings")}
    tables = [("crank", crank)] if crank else []
    if mechanism.crank.length is not None:
        keys["crank_length"] = _number(mechanism.crank.length, "m", "crank_length")
    flat = bearings is None and not mechanism.has_planes
    roller, slider = (crank_slider_parts(mechanism) if flat else None) or (None, None)
    if slider is not None and slider.pin == "B":
        own = _keys(slider) | (_keys(roller, cam_file) if roller else {})
        kept = {key: value for key, value in own.items() if key not in ("on", "pin", "label")}
        return {"mechanism": _quoted("cam-crank-slider" if roller else "crank-slider"), **keys, **kept}, tables
    tables += [
        ("[groups]", {"kind": _quoted(_group_word(group)), **_keys(group, cam_file)}) for group in mechanism.groups
    ]
    return {"mechanism": _quoted("chain"), "name": _quoted(mechanism.name), **keys}, tables


def _group_word(group):
    """Word for a kind of group: "cam roller", "slider"."""
    name = type(group).__name__.removesuffix("Group")
    return "".join(f" {letter}" if letter.isupper() else letter for letter in name).strip().lower()


def _load_word(load):
    if type(load) not in KINDS:
        raise ParameterError(f"case file: has no text for the load {checks.shown(load)}")
    return load.PATH.replace("_", " ")


def _keys(item, file=""):
    """Keys of a part by its rules, without defaults; a table refers to a file."""
    defaults = {field.name: field.default for field in fields(item)}
    found: dict[str, str] = {}
    for name, rule in item.RULES.rules.items():
        value = getattr(item, name)
        if (
            value is None
            or name == "period"
            or (  # a table has one, a constant none
                defaults[name] is not MISSING and type(value) is type(defaults[name]) and value == defaults[name]
            )
        ):
            continue
        if isinstance(value, Guide):
            found |= _guide_keys(value)
        elif isinstance(value, Link):
            link = _link_keys(value)
            found |= {name: _inline_table(link)} if link else {}
        elif isinstance(value, Roller):
            found[name] = _inline_table(_keys(value))
        elif name == "cam":
            found["cam"] = _cam_text(value, file)
        elif isinstance(value, Table):
            found[name] = _table_reference(value, file)
        else:
            found[name] = _value(value, rule, name)
    return found


def _guide_keys(guide):
    """Keys of a guide: two points for a direction along an axis, which an angle in radians would round."""
    if type(guide.exact) is not Axis:
        return _nonzero_keys(guide, guide_angle="rad", guide_offset="m")
    (x, y), offset = guide.exact, _single_number(guide.guide_offset, "guide_offset")
    points = (-offset * y, offset * x), (x - offset * y, y + offset * x)
    return {"guide_through": f"[{', '.join(_numbers(point, 'm', 'guide_through') for point in points)}]"}


def _value(value, rule, name):
    """Text of a value by its rule."""
    if isinstance(rule, checks.Optional | checks.OrFunction):
        return _value(value, rule.rule, name)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, int):
        return str(value).lower()  # of a truth value too
    if isinstance(rule, PlacePairRule):
        return f"[{', '.join(_value(part, PlaceRule(), name) for part in value)}]"
    if isinstance(value, tuple):
        return _numbers(value, _unit_text(getattr(getattr(rule, "rule", None), "unit", "m")), name)
    if getattr(rule, "unit", "") in ("", "1"):
        return repr(_single_number(value, name))
    return _number(value, _unit_text(getattr(rule, "unit", "")), name)


def _table_reference(values, file):
    """Text that refers to a table of values in a file."""
    keys = {"file": _quoted(file), "over": _quoted(values.over)}
    if values.period != TURN:
        keys["period"] = _quoted(f"{360 * round(values.period / TURN)} deg")
    if values.zero is not None:
        keys["zero"] = _quoted(values.zero if values.from_dead_centre else "0 deg")
    if values.sense == -1:
        keys["sense"] = "-1"
    return _inline_table(keys | ({"slider": _quoted(values.slider)} if values.slider is not None else {}))


def _link_keys(link):
    return _nonzero_keys(link, mass="kg", centre="m", inertia="kg m^2")


def _nonzero_keys(item, **units):
    """Keys of numbers and pairs of a part that are not zero, by their units."""
    values = {name: getattr(item, name) for name in units}
    return {name: _numbers(value, units[name], name) for name, value in values.items() if np.any(value)}


def _cam_text(cam, file):
    if type(cam) is Sampled:
        noise = {} if cam.smoothing is None else {"noise": _number(cam.smoothing, "m", "noise")}
        return _inline_table({"kind": _quoted("sampled"), "table": _quoted(file), **noise})
    if type(cam) not in CAMS:
        raise ParameterError(
            f"case file: has no text for a cam of the class {type(cam).__name__}; write it by cam.export as .csv, and "
            'name that in a case file: cam = { kind = "sampled", table = "cam.csv" }'
        )
    keys = {KEYS_BY_FIELD.get(name, name): value for name, value in _keys(cam).items() if name != "guide_angle"}
    return _inline_table({"kind": _quoted(CAMS[type(cam)]), **keys})


KEYS_BY_FIELD = {"pitch_radius": "radius"}
"""Keys of case files for fields of another name."""


def _inline_table(keys):
    return f"{{ {', '.join(f'{key} = {value}' for key, value in keys.items())} }}"


def _numbers(value, unit, name):
    """Text of a number with its unit, or of a tuple of numbers and texts."""
    if not isinstance(value, tuple):
        return _number(value, unit, name)
    return f"[{', '.join(_quoted(part) if isinstance(part, str) else _number(part, unit, name) for part in value)}]"


def _number(value, unit, name):
    return _quoted(f"{_single_number(value, name)!r} {unit}")


def _single_number(value, name):
    if isinstance(value, float | int) or (isinstance(value, np.ndarray) and value.size == 1):
        return float(value)
    raise ParameterError(f"case file: {name} must be one number in a case file, got {checks.shown(value)}")


def _unit_text(unit):
    """A unit as case files spell it."""
    return unit.replace("**", "^").replace("*", " ") or "1"


def _quoted(value):
    """Text of a string, boolean, number or list, equal in TOML and JSON except for the letter DEL."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(name):
    return name if name.replace("-", "").replace("_", "").isalnum() and name.isascii() else _quoted(name)
