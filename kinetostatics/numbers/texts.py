"""Names in one Unicode form: "ä" may be written as one character or as "a" with a mark, and looks the same."""

import unicodedata
from pathlib import Path


def normalise(text):
    """A text in the form by which names are compared (NFC); anything else as it is."""
    return unicodedata.normalize("NFC", text) if isinstance(text, str) else text


def find_on_disk(path) -> Path:
    """Path of the file that is meant: of that name, else the one beside it whose name differs in its form alone.

    Raises
    ------
    OSError, ValueError
        The path cannot be looked for.
    """
    path = Path(path)
    if path.name.isascii() or path.exists() or not path.parent.is_dir():
        return path
    same = (other for other in path.parent.iterdir() if normalise(other.name) == normalise(path.name))
    return next(same, path)
