"""Case files to start from, commented, one for each of some mechanisms; `kinetostatics new` writes them."""

import json
from pathlib import Path


def starter(kind, title):
    """Text of the case file of a kind with a title."""
    text = Path(__file__).with_name(f"{kind}.toml").read_text(encoding="utf-8")
    return text.replace('"TITLE"', json.dumps(title, ensure_ascii=False), 1)
