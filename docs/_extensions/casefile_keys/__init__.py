"""The case-file reference, made of the schema: every key with what may stand there, default, meaning and example.

Meanings come from ``kinetostatics/casefile/schema``; examples come from the shipped cases and their starters,
where they have the key.
"""

import inspect
from typing import NamedTuple

from kinetostatics.casefile.schema.meanings import about, meaning

from . import sections
from .examples import example
from .sections import anchor
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
        Part(anchor(title), title, inspect.cleandoc(about(model)), keys(model, left_out))
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
