"""The case-file reference, made of the schema: every key with what may stand there, default, meaning and example.

Meanings are the texts below the keys in ``kinetostatics/casefile/schema``, and `MEANINGS` for groups and loads;
examples come from the shipped cases and their starters, where they have the key.
"""

import ast
import inspect
import re
from functools import cache
from itertools import pairwise
from textwrap import dedent
from typing import NamedTuple

from kinetostatics.casefile.schema import parts

from . import sections
from .examples import example
from .meanings import MEANINGS
from .sections import anchor, own_text, word_of
from .words import default, takes

PLACE = "<!-- every key -->"


class Key(NamedTuple):
    """A row of the reference."""

    name: str
    takes: str
    default: str
    meaning: str
    example: str


class Part(NamedTuple):
    """A table of a case file: heading, what it says of itself, its keys."""

    anchor: str
    title: str
    about: str
    keys: list[Key]


def setup(app):
    """Fill the page as it is read."""
    app.connect("source-read", fill)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}


def fill(app, docname, source):
    """Put the reference in its place."""
    if PLACE in source[0]:
        source[0] = source[0].replace(PLACE, page())


def page():
    """The reference as Markdown."""
    lines = []
    for part in parts_of_the_reference():
        lines += [f"({part.anchor})=", f"## {part.title}", "", part.about, ""]
        if not part.keys:
            continue
        lines += [":::{container} keys", "", "| key | takes | default | meaning | example |", "|---|---|---|---|---|"]
        for key in part.keys:
            shown = f"`{key.example}`" if key.example else ""
            said = key.meaning.replace("[[", "\\[\\[")
            row = (f"`{key.name}`", key.takes, key.default, said, shown)
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |")
        lines += ["", ":::", ""]
    return "\n".join(lines)


def parts_of_the_reference():
    """All of it."""
    return [
        Part(anchor(title), title, inspect.cleandoc(own_text(model)), keys(model, left_out))
        for title, model, left_out in sections.sections()
    ]


def keys(model, left_out=()):
    """Rows of a table, first those that must be there."""
    found = [
        Key(name, takes(field), default(field), meaning(model, name), example(model, name, field))
        for name, field in model.model_fields.items()
        if name not in left_out
    ]
    return sorted(found, key=lambda key: (key.name not in ("kind", "mechanism"), key.default != "required"))


def meaning(model, name):
    """The text of a key."""
    if model in parts.MADE_OF:
        if name == "kind":
            return "Which kind it is."
        known = MEANINGS.get(f"{word_of(model)}.{name}") or MEANINGS.get(name)
        return known or parameter(parts.MADE_OF[model], name)
    owners = [base for base in model.__mro__ if name in vars(base).get("__annotations__", ())]
    told = model.model_fields[name].description or (texts_below(owners[0]).get(name, "") if owners else "")
    return told[:1].upper() + told[1:].removesuffix(".") + "." if told else ""


def parameter(kind, name):
    """What the docstring of a class says of a parameter."""
    text = re.search(rf"^{name} : .*\n((?:    .*(?:\n|\Z))+)", inspect.getdoc(kind), flags=re.MULTILINE)
    return " ".join(text[1].split()) if text else ""


@cache
def texts_below(model):
    """Texts that stand below the fields of a class."""
    body = ast.parse(dedent(inspect.getsource(model))).body[0].body
    return {
        field.target.id: text.value.value
        for field, text in pairwise(body)
        if isinstance(field, ast.AnnAssign)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
        and isinstance(text.value.value, str)
    }
