"""Output for other programs: ``--json`` and ``--csv``, numbers in full, nothing else on standard output.

NaN (no value) is null in JSON and empty in CSV; infinity is the text "Infinity" in JSON.
"""

import json
import math
import sys
from collections.abc import Mapping
from pathlib import Path

from ..version import __version__
from .output import STDOUT, write_table


def wants_json(options):
    return getattr(options, "json", False)


def wants_csv(options):
    return getattr(options, "csv", None) == STDOUT


def quiet(options):
    """Whether standard output carries JSON or CSV."""
    return wants_json(options) or wants_csv(options)


def announce(options, *lines):
    """Print lines for people."""
    if not quiet(options):
        print(*lines, sep="\n")


def print_json(command, **parts):
    print(json.dumps(_jsonable({"command": command, "version": __version__, **parts}), indent=1, allow_nan=False))


def write_csv(options, table):
    """Write a table to standard output or a file, as ``--csv`` says."""
    if wants_csv(options):
        sys.stdout.write(table.to_csv(index=False))
    elif options.csv:
        announce(options, "", write_table(table, options.csv))


def case_header(case):
    """Title, path and reference of a case."""
    return {"title": case.title, "path": case.path, "reference": case.reference}


def rows_by_name(table):
    """Rows of a pandas DataFrame as dicts, by its index."""
    return {str(name): row for name, row in zip(table.index, table.to_dict("records"), strict=True)}


def shows_progress(options):
    """Whether to show progress: standard error is a terminal."""
    return not quiet(options) and sys.stderr is not None and sys.stderr.isatty()


def progress(options, names, label):
    """Yield the names, with a progress bar on a terminal."""
    if not shows_progress(options):
        yield from names
        return
    from tqdm import tqdm

    bar = tqdm(list(names), desc=label, leave=False)
    for name in bar:
        bar.set_postfix_str(str(name))
        yield name


def _jsonable(item):
    """The item with values that JSON has."""
    if isinstance(item, Mapping):
        return {str(key): _jsonable(value) for key, value in item.items()}
    if hasattr(item, "columns"):  # a pandas DataFrame
        return [_jsonable(row) for row in item.to_dict("records")]
    if isinstance(item, list | tuple | set):
        return [_jsonable(value) for value in item]
    if hasattr(item, "tolist"):
        return _jsonable(item.tolist())
    if isinstance(item, float):
        return item if math.isfinite(item) else None if math.isnan(item) else f"{'-' if item < 0 else ''}Infinity"
    return str(item) if isinstance(item, Path) else item
