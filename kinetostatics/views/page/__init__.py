"""Scripts and styles of the pages: the report, explore in the browser and in a notebook.

A script is an ES module. May import errors to numbers.
"""

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


def split_arrays(value):
    """A nested value of a message and its arrays, apart.

    Arrays become {"array": k, "kind": "f4" | "f8"}: the number k in the list, and its kind.

    Returns
    -------
    value : dict, list or scalar
        For JSON.
    arrays : list of ndarray
        Contiguous, little-endian.
    """
    arrays: list[np.ndarray] = []

    def split(item):
        if isinstance(item, np.ndarray):
            kind = "f4" if item.dtype == np.float32 else "f8"
            arrays.append(np.ascontiguousarray(item, dtype=f"<{kind}"))
            return {"array": len(arrays) - 1, "kind": kind}
        if isinstance(item, dict):
            return {name: split(part) for name, part in item.items()}
        return [split(part) for part in item] if isinstance(item, list | tuple) else item

    return split(value), arrays
