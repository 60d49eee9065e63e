"""Scripts and styles of the pages: the report, explore in the browser and in a notebook.

A script is an ES module. May import errors to numbers.
"""

import math
import re
from importlib import resources

import numpy as np

IMPORT = re.compile(r'^import\b[^"]*"\./([^"]+)";\n', re.M)
"""A module's import of a file beside it."""


def source(name):
    """Text of a script or style."""
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def bundle(entry, read=source):
    """Text of one ES module: a script and all that it imports, each once, before what imports it.

    Exports of the entry stay; modules that it imports share its names, so two of them must not declare the same one.
    `read(name)` gives the text of a script.
    """
    texts: dict[str, str] = {}

    def add(name):
        text = read(name)
        for other in IMPORT.findall(text):
            if other not in texts:
                add(other)
        text = IMPORT.sub("", text)
        texts[name] = text if name == entry else re.sub(r"^export ", "", text, flags=re.M)

    add(entry)
    return "\n".join(texts.values())


KINDS = {np.dtype(np.float32): "f4", np.dtype(np.float64): "f8"}
"""Kinds of arrays in messages, as `arrays.js` reads them."""


def packed(answer):
    """An answer as header and buffers: an array becomes {"array": number, "kind": "f4" or "f8"}, NaN becomes None."""
    buffers: list[bytes] = []
    return _plain(answer, buffers), buffers


def _plain(item, buffers):
    """An item as JSON, its arrays appended to the buffers."""
    if isinstance(item, dict):
        return {str(key): _plain(value, buffers) for key, value in item.items()}
    if isinstance(item, list | tuple):
        return [_plain(value, buffers) for value in item]
    if isinstance(item, np.ndarray):
        if item.dtype not in KINDS:
            item = item.astype(np.float64)
        buffers.append(np.ascontiguousarray(item).astype(item.dtype.newbyteorder("<"), copy=False).tobytes())
        return {"array": len(buffers) - 1, "kind": KINDS[item.dtype]}
    if isinstance(item, np.generic):
        item = item.item()
    return None if isinstance(item, float) and not math.isfinite(item) else item
