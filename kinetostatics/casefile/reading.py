"""Case files as TOML: find the file, read it with limits, and let a variant inherit from [common]."""

import os
import re
import tomllib
import warnings
from pathlib import Path
from typing import Any

from ..errors import CaseError, ParameterError
from ..numbers import checks
from ..numbers.files import find_on_disk, read_text
from ..numbers.formatting import normalise
from ..numbers.units import quoted

MAX_CASE_BYTES = 300_000
"""Largest size of a case file."""
MAX_DEPTH = 20
"""Largest depth of nested tables; the schema has three levels."""
_LONG_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){50}""")


def shipped_cases():
    """Path by name of the shipped cases.

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


def find_case(path):
    """Path of the case file, or of the shipped case of that name."""
    if not isinstance(path, str | os.PathLike):
        raise ParameterError(f"load_case: needs a path or the name of a shipped case, got {quoted(path)}")
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


def read_toml(path):
    """Path on disk and content of a case file."""
    shipped = shipped_cases()
    try:
        path = find_on_disk(path)
        missing = not path.exists()
    except (OSError, ValueError):  # no path; `read_text` reports it
        missing = False
    if missing:
        beside, whole = [str(file) for file in path.parent.glob("*.toml")], f"{path}.toml"
        hint = f"; did you mean {whole!r}?" if whole in beside else checks.hint(path, beside)
        names = f"{', '.join(shipped)}{hint or checks.hint(path.stem, shipped)}"
        raise CaseError(path, [f"there is no file and no shipped case of this name ({names})"])
    text = read_text(path, MAX_CASE_BYTES)
    try:
        raw = None if _LONG_KEY.search(text) else tomllib.loads(normalise(text))
    except ValueError as error:
        raise CaseError(path, [f"is not TOML: {error}"]) from None
    except RecursionError:
        raw = None
    if raw is None or is_deeper(raw, MAX_DEPTH):
        raise CaseError(path, [f"has tables or lists nested more than {MAX_DEPTH} deep"])
    return path, raw


def is_deeper(item, depth):
    """Whether tables and lists in a table are nested deeper than this."""
    level: list[Any] = [item]
    for _ in range(depth):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
    return bool(level)


def require(path, *problems):
    """Raise one `CaseError` that lists every problem found."""
    if any(problems):
        raise CaseError(path, [problem for problem in problems if problem])


def inherit(common, own):
    """Table with the keys of `common`, overridden by its own at every level."""
    found = dict(common)
    for key, value in own.items():
        both = isinstance(value, dict) and isinstance(common.get(key), dict)
        found[key] = inherit(common[key], value) if both else value
    return found


def has_keys(table, keys):
    """Whether nested keys exist in a table; lists are not entered."""
    for key in keys:
        if isinstance(key, int):
            return True
        if not isinstance(table, dict) or key not in table:
            return False
        table = table[key]
    return True
