"""Commented starter case files for several mechanisms; `kinetostatics new` writes them.

May import nothing of the package.
"""

import json
from pathlib import Path

STARTERS = ("crank-slider", "four-bar", "cam", "chain")
"""Kinds of starters."""


def starter(kind, title):
    """Text of a starter file of this kind; the title also names the mechanism of a chain."""
    text = Path(__file__).with_name(f"{kind}.toml").read_text(encoding="utf-8")
    name = "".join(letter if letter.isprintable() else " " for letter in title)
    for place, value in {'"TITLE"': title, '"NAME"': name}.items():
        text = text.replace(place, json.dumps(value, ensure_ascii=False), 1)
    return text
