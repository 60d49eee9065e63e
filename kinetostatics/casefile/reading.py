"""Reading: a TOML file or a shipped case, validated table by table, every problem told with its key."""

import os
import re
import tomllib
import typing
import warnings
from pathlib import Path

import pydantic

from ..errors import CaseError, ParameterError
from ..numbers import checks
from ..numbers.files import read_text
from ..numbers.texts import normal, on_disk
from ..numbers.units import quoted
from . import schema

LARGEST_CASE = 300_000
"""Bytes that a case file may have."""
DEEPEST = 20
"""Tables within tables that a case file may have; those that are used have three."""
_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){50}""")


def shipped_cases():
    """Path by name of the cases that come with the library.

    Returns
    -------
    dict of str to Path

    Examples
    --------
    >>> import kinetostatics as ks
    >>> list(ks.shipped_cases())[:3]
    ['chain_unit', 'compressor', 'in_line_twin']
    """
    package = Path(__file__).parents[1]
    folder = next(path for path in (package / "cases", package.parent / "cases") if path.is_dir())
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def place(path):
    """Path of the case file that is meant."""
    if not isinstance(path, str | os.PathLike):
        raise ParameterError(f"load_case: takes a path or the name of a shipped case, got {quoted(path)}")
    shipped = shipped_cases()
    if not isinstance(path, str) or path not in shipped:
        found = Path(path)
        return shipped[str(found)] if str(found) in shipped and not found.is_file() else found
    if Path(path).is_file():
        warnings.warn(
            f"{path!r} is read as the shipped case of that name, not the file here; write {'./' + path!r} for the file",
            stacklevel=3,
        )
    return shipped[path]


def read(path):
    """The path and what its file holds."""
    shipped = shipped_cases()
    try:
        path = on_disk(path)
        missing = not path.exists()
    except (OSError, ValueError):  # no path at all: reading it says why
        missing = False
    if missing:
        names = f"{', '.join(shipped)}{_meant(path) or checks.hint(path.stem, shipped)}"
        raise CaseError(path, [f"no such file, and no shipped case of that name ({names})"])
    text = read_text(path, LARGEST_CASE)
    try:
        raw = None if _LONG_KEY.search(text) else tomllib.loads(normal(text))
    except ValueError as error:
        raise CaseError(path, [f"is not TOML: {error}"]) from None
    except RecursionError:
        raw = None
    if raw is None or _deeper(raw, DEEPEST):
        raise CaseError(path, [f"holds tables or lists within each other more than {DEEPEST} deep"])
    return path, raw


def _meant(path):
    """Question that names the file beside it that may be meant: its ending left out, or a letter wrong."""
    beside, whole = [str(file) for file in path.parent.glob("*.toml")], f"{path}.toml"
    return f"; did you mean {whole!r}?" if whole in beside else checks.hint(path, beside)


def _deeper(table, depth):
    """Whether tables and lists stand within each other more than so deep."""
    level = [table]
    for _ in range(depth):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
    return bool(level)


def merged(common, own):
    """A table with what it has in common with others."""
    found = dict(common)
    for key, value in own.items():
        both = isinstance(value, dict) and isinstance(common.get(key), dict)
        found[key] = merged(common[key], value) if both else value
    return found


def holds(table, keys):
    """Whether keys, each within the one before, lead to something; a list is looked at as a whole."""
    for key in keys:
        if isinstance(key, int):
            return True
        if not isinstance(table, dict) or key not in table:
            return False
        table = table[key]
    return True


def validated(model, raw, place):
    """The model or None, and a line for each problem; `place` tells where in the file a key stands."""
    try:
        return model.model_validate(raw), []
    except pydantic.ValidationError as error:
        return None, [_sentence(model, item, place) for item in error.errors()]


NO_TABLE = ("model_type", "dict_type")
"""What is wrong, as pydantic calls it, where a table should stand."""


def _sentence(model, item, place):
    keys = tuple(key for key in item["loc"] if key not in schema.TAGS)
    path = key_path(place(keys))
    found = item["input"]
    if item["type"] == "missing":
        return f"{path} is missing"
    if item["type"] == "extra_forbidden":
        allowed = _allowed(model, item["loc"][:-1])
        return f"{path} is not a key here{checks.hint(keys[-1], allowed)} (allowed: {', '.join(allowed)})"
    if item["type"] == "kind":
        allowed = schema.kinds(item["msg"])
        if not isinstance(found, dict):
            return f"{path} must be a table with a kind, of {', '.join(map(repr, allowed))}, found {quoted(found)}"
        if "kind" not in found:
            return f"{path}.kind is missing; allowed: {', '.join(map(repr, allowed))}"
        return checks.choice(f"{path}.kind", found["kind"], allowed)
    if item["type"] == "literal_error" and keys[-1] == "kind":
        return checks.choice(path, found, schema.kinds(item["loc"][-2]))
    if item["type"] in NO_TABLE:
        return f"{path} must be a table of keys and values, found {quoted(found)}"
    if item["type"] == "value_error":
        return f"{path} {item['ctx']['error']}"
    return f"{path}: {item['msg'][0].lower()}{item['msg'][1:]}, found {quoted(found)}"


def key_path(keys):
    """Keys as a file has them: "variants.plain.cam.centre[1]"."""
    text = ""
    for key in keys:
        text += f"[{key + 1}]" if isinstance(key, int) else f".{key}" if text else str(key)
    return text


def _allowed(model, keys):
    """Keys allowed in the table at a path of the model."""
    return [key for table in _at(model, keys) for key in table.model_fields]


def _at(model, keys):
    """Tables that may stand at a path of the model."""
    candidates = [model]
    for key in keys:
        if key in schema.TAGS:
            candidates = [schema.TAGS[key]]
        elif any(key in table.model_fields for table in candidates):  # others are numbers in a list, and names
            fields = [table.model_fields[key].annotation for table in candidates if key in table.model_fields]
            candidates = [inner for annotation in fields for inner in _tables(annotation)]
    return candidates


def _tables(annotation):
    if isinstance(annotation, type) and issubclass(annotation, schema.Table):
        return [annotation]
    return [table for part in typing.get_args(annotation) for table in _tables(part)]
