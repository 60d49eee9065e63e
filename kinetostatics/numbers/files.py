"""Files: CSV tables read in SI units, texts read with a size limit, results written whole or not at all."""

import csv
import io
import os
import re
import secrets
import stat
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np

from ..errors import CaseError, FileError
from . import checks
from .formatting import heading, normalise, parse_user_heading
from .units import NUMBER, factor, quoted

MAX_TABLE_BYTES = 10_000_000
"""Largest size of a table: half a million rows."""
_NUMBER = re.compile(NUMBER)


def find_on_disk(path) -> Path:
    """Path of a file, also where a name on disk has another Unicode form ("ä" as one character or as two)."""
    path = Path(path)
    if str(path).isascii() or path.exists() or path == path.parent:
        return path
    folder = find_on_disk(path.parent)
    if not folder.is_dir():
        return path
    same = (other for other in folder.iterdir() if normalise(other.name) == normalise(path.name))
    return next(same, path)


def read_text(path, largest):
    """Text of a regular file in UTF-8 of at most `largest` bytes; `CaseError` for all others."""
    try:
        path = find_on_disk(path)
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            kind = "folder" if stat.S_ISDIR(found.st_mode) else "pipe or device"
            raise CaseError(path, [f"cannot be read: it is a {kind}, not a file"])
        with path.open("rb") as file:
            content = file.read(largest + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, CaseError):
            raise
        raise CaseError(path, [f"cannot be read: {getattr(error, 'strerror', None) or error}"]) from None
    if len(content) > largest:
        raise CaseError(path, [f"cannot be read: it is larger than {largest / 1e6:g} MB, too large for these files"])
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise CaseError(path, ["is not UTF-8 text, but UTF-16; save it as UTF-8"])
    if b"\0" in content:
        raise CaseError(path, [f"is not text: it has a zero byte at {content.index(0)}"])
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CaseError(path, [f"is not UTF-8 text: {error.reason} at byte {error.start}; save it as UTF-8"]) from None


def read_columns(path, wanted):
    """Columns of a CSV file in SI, arrays in the order of `wanted`, a dict of column name to SI unit.

    The first line names each column with its unit: ``angle [deg], radius [mm]``; see `formatting.parse_user_heading`.
    Commas separate the columns, numbers have a decimal point, and every row has as many fields as the heading. Empty
    lines are skipped; comments, lines that begin with ``#``, may precede the heading. `CaseError` for any other file.
    """
    headings, rows = _rows(path)
    for line, cells in rows:
        if len(cells) != len(headings):
            comma = "; if a comma is meant for a decimal point, write a point" if len(cells) > len(headings) else ""
            raise CaseError(path, [f"line {line} has {len(cells)} fields, but the heading {len(headings)}{comma}"])
    problems, columns = [], []
    for name, unit in wanted.items():
        try:
            columns.append(_column(headings, rows, name, unit))
        except ValueError as error:
            problems.append(str(error))
    if problems:
        raise CaseError(path, problems)
    return columns


def headings(path):
    """Name and unit of each column of a CSV file, from its heading."""
    return list(map(parse_user_heading, _rows(path)[0]))


def _column(headings, rows, name, wanted):
    """Values of a column in the SI unit wanted; `ValueError` if it is missing or unreadable."""
    names, units = zip(*map(parse_user_heading, headings), strict=True)
    places = [place for place, found in enumerate(names) if found == name]
    if len(places) != 1:
        there = ", ".join(map(repr, headings[:20]))
        twice = f"{len(places)} columns are {name!r}, of {there}; keep one"
        raise ValueError(
            twice if places else f"no column {name!r}; it has {there}{_heading_advice(name, wanted, names, units)}"
        )
    (place,) = places
    own, unit = headings[place], units[place]
    if not unit:
        raise ValueError(f'column {own!r}: has no unit; head it for example "{heading(name, wanted)}"')
    try:
        scale = factor(unit, wanted)
    except ValueError as error:
        raise ValueError(f"column {own!r}: {error}") from None
    for line, cells in rows:
        if not _is_number(cells[place]):
            raise ValueError(f"column {own!r}, line {line}: not a number: {quoted(cells[place])}")
    return np.array([cells[place] for _, cells in rows], dtype=float) * scale


def _heading_advice(name, wanted, names, units):
    """Advice on the heading of the column with the nearest name; empty if no name is near."""
    near = checks.nearest(name, names)
    if near is None:
        return ""
    unit = units[names.index(near)]
    return f"; if {near!r} is meant, head it {heading(name, unit or wanted)!r}"


def _is_number(cell):
    return _NUMBER.fullmatch(cell) is not None and abs(float(cell)) < np.inf


def _rows(path):
    """Headings, and each non-empty row with its line number."""
    text = read_text(path, MAX_TABLE_BYTES)
    lines = csv.reader(_without_comments(text), skipinitialspace=True, strict=True)
    try:
        rows = [(lines.line_num, [cell.strip() for cell in cells]) for cells in lines if any(map(str.strip, cells))]
    except csv.Error as error:
        raise CaseError(path, [f"cannot be read as CSV: line {lines.line_num}: {error}"]) from None
    if not rows:
        raise CaseError(path, ["is empty: a heading and rows of numbers are needed"])
    (_, headings), *rows = rows
    if len(headings) == 1 and (other := next((sign for sign in ";\t" if sign in headings[0]), None)):
        name = {";": "semicolons", "\t": "tabs"}[other]
        raise CaseError(path, [f"has {name} between its columns; write commas there, and decimal points in numbers"])
    if not rows:
        raise CaseError(path, [f"has a heading, {', '.join(headings)[:80]!r}, but no rows"])
    late = [line for line, cells in rows if cells[0].startswith("#")]
    if late:
        raise CaseError(path, [f"line {late[0]} begins with '#'; comments stand before the heading, so leave it out"])
    if text.lstrip().startswith("#") and all(map(_is_number, headings)):
        raise CaseError(path, ["has no heading after its comments; take the '#' off the line that names the columns"])
    return headings, rows


def _without_comments(text):
    """Lines of a text; comments before the heading become empty lines, so line numbers stay."""
    before = True
    for line in io.StringIO(text, newline=""):
        before = before and line.lstrip()[:1] in ("", "#")
        yield "\n" if before else line


@contextmanager
def write_atomically(path):
    """Path of a temporary file that replaces `path` when the block ends without an error.

    An existing file keeps its permissions and, where allowed, its owner; a symbolic link keeps its target. `FileError`
    if the file cannot be written.
    """
    problem = write_problem(path)
    if problem:
        raise FileError(problem)
    path = Path(path)
    if path.exists() and not path.is_file():  # a pipe or a device accepts text directly
        with _errors_naming(path):
            yield path
        return
    path = Path(os.path.realpath(path))
    before = path.stat() if path.exists() else None
    temporary = path.with_name(f".{secrets.token_hex(8)}{path.suffix}")
    try:
        with _errors_naming(path, "; give another place"):
            path.parent.mkdir(parents=True, exist_ok=True)
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600 if before else 0o666))
        with _errors_naming(path):
            yield str(temporary)
        if before is not None:
            _copy_permissions(temporary, before)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def _errors_naming(path, advice=""):
    """Turn system errors of the block into a `FileError` that names the file written, not the temporary one."""
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{path} cannot be written: {error.strerror or error}{advice}") from error


def describe_os_error(error, elsewhere):
    """Text of a system error without its number: file (by default `elsewhere`) and reason."""
    return f"{error.filename or elsewhere}: {error.strerror or error}"


def _copy_permissions(path, before):
    """Give a file the permissions of another and, where allowed, its owner."""
    own = path.stat()
    if hasattr(os, "chown") and (own.st_uid, own.st_gid) != (before.st_uid, before.st_gid):
        with suppress(PermissionError):
            os.chown(path, before.st_uid, before.st_gid)
    path.chmod(stat.S_IMODE(before.st_mode))


def write_problem(path, *, inputs=(), endings=()):
    """Reason why a result cannot be written to this file, or None; call it before a long calculation.

    `inputs` are files that are read, so must not be replaced. `endings` are allowed; pipes and devices need none.
    """
    if not isinstance(path, str | os.PathLike):
        return f"{path!r} is no name of a file: give a text or a path"
    path = Path(path)
    try:
        if path.is_dir():
            return f"{path} is a folder; give the name of a file in it"
        if any(path.exists() and item.exists() and path.samefile(item) for item in map(Path, inputs)):
            return f"{path} is read as input and would be replaced; give another name"
        if path.exists() and not path.is_file():
            return None
        if endings and path.suffix.lower() not in endings:
            return checks.choice(f"{path}: the ending", path.suffix, endings)
        target = Path(os.path.realpath(path))
        if target.is_symlink():
            return f"{path} is a symbolic link that leads in a circle"
        if target.exists() and not (target.stat().st_mode & 0o222 and os.access(target, os.W_OK)):
            return f"{path} is read-only; allow writing, or give another name"
        return folder_write_problem(target.parent)
    except (OSError, ValueError) as error:
        return f"{str(path)!r} is no name of a file here: {getattr(error, 'strerror', None) or error}"


def folder_problem(path):
    """Fault of an argument `folder` for results, as a sentence, or None."""
    if not isinstance(path, str | os.PathLike):
        return f"folder must be a path, got {checks.shown(path)}"
    if not os.fspath(path):
        return "folder must name a place for the results, got ''; \".\" is the folder you are in, None writes nothing"
    return None


def folder_write_problem(path):
    """Reason why results cannot be written into this folder, or None; a missing folder is no fault."""
    path = Path(path)
    try:
        standing = next(place for place in (path.absolute(), *path.absolute().parents) if os.path.lexists(place))
        if not standing.is_dir():
            return f"{standing} is no folder, so nothing can be written to {path}"
        if not os.access(standing, os.W_OK | os.X_OK):
            return f"folder {standing} may not be written to; give another place"
    except (OSError, ValueError) as error:
        return f"{str(path)!r} is no name of a folder here: {getattr(error, 'strerror', None) or error}"
    return None
