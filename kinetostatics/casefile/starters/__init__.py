"""Case files to start from, commented, one for each of some mechanisms; `kinetostatics new` writes them."""

import json
from pathlib import Path


def starter(kind, title):
    """Text of the case file of a kind with a title, which is the name of its machine too where the kind tells none."""
    text = Path(__file__).with_name(f"{kind}.toml").read_text(encoding="utf-8")
    name = "".join(letter if letter.isprintable() else " " for letter in title)
    for place, value in {'"TITLE"': title, '"NAME"': name}.items():
        text = text.replace(place, json.dumps(value, ensure_ascii=False), 1)
    return text
