"""Tables of a case file checked against their models: one sentence for each problem, with the key it stands at."""

import typing

import pydantic

from ...numbers import checks
from ...numbers.units import quoted
from .tables import TAGS, Table, kinds


def validated(model, raw, place):
    """The model or None, and a line for each problem; `place` tells where in the file a key stands."""
    try:
        return model.model_validate(raw), []
    except pydantic.ValidationError as error:
        return None, [_sentence(model, item, place) for item in error.errors()]


NO_TABLE = ("model_type", "dict_type")
"""What is wrong, as pydantic calls it, where a table should stand."""


def _sentence(model, item, place):
    keys = tuple(key for key in item["loc"] if key not in TAGS)
    path = key_path(place(keys))
    found = item["input"]
    if item["type"] == "missing":
        return f"{path} is missing"
    if item["type"] == "extra_forbidden":
        allowed = _allowed(model, item["loc"][:-1])
        return f"{path} is not a key here{checks.hint(keys[-1], allowed)} (allowed: {', '.join(allowed)})"
    if item["type"] == "kind":
        allowed = kinds(item["msg"])
        if not isinstance(found, dict):
            return f"{path} must be a table with a kind, of {', '.join(map(repr, allowed))}, found {quoted(found)}"
        if "kind" not in found:
            return f"{path}.kind is missing; allowed: {', '.join(map(repr, allowed))}"
        return checks.choice(f"{path}.kind", found["kind"], allowed)
    if item["type"] == "literal_error" and keys[-1] == "kind":
        return checks.choice(path, found, kinds(item["loc"][-2]))
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
        if key in TAGS:
            candidates = [TAGS[key]]
        elif any(key in table.model_fields for table in candidates):  # others are numbers in a list, and names
            fields = [table.model_fields[key].annotation for table in candidates if key in table.model_fields]
            candidates = [inner for annotation in fields for inner in _tables(annotation)]
    return candidates


def _tables(annotation):
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    return [table for part in typing.get_args(annotation) for table in _tables(part)]
