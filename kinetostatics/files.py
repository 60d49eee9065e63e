"""Files: CSV tables read to SI, and results written whole or not at all."""

import csv
import io
import os
import re
import stat
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from . import checks
from .errors import CaseError
from .units import NUMBER, factor, shown

LARGEST_TABLE = 10_000_000
"""Bytes that a table may have: half a million rows."""
_HEADING = re.compile(r"([^\[\]]*)(?:\[([^\[\]]*)\])?")
_NUMBER = re.compile(NUMBER)


def read_text(path, largest):
    """Text of a file in UTF-8, looked at before it is read: no pipe, device or folder, no more than `largest` bytes.

    Raises
    ------
    CaseError
        It is none of these, or no text.
    """
    try:
        found = Path(path).stat()
        if not stat.S_ISREG(found.st_mode):
            kind = "folder" if stat.S_ISDIR(found.st_mode) else "pipe or device"
            raise CaseError(path, [f"cannot be read: it is a {kind}, not a file"])
        with Path(path).open("rb") as file:
            content = file.read(largest + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, CaseError):
            raise
        raise CaseError(path, [f"cannot be read: {getattr(error, 'strerror', None) or error}"]) from None
    if len(content) > largest:
        raise CaseError(path, [f"cannot be read: it is larger than {largest / 1e6:g} MB, which such files never are"])
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise CaseError(path, ["is not UTF-8 text, but UTF-16; save it as UTF-8"])
    if b"\0" in content:
        raise CaseError(path, [f"is not text: it has a zero byte at {content.index(0)}"])
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CaseError(path, [f"is not UTF-8 text: {error.reason} at byte {error.start}; save it as UTF-8"]) from None


def read_columns(path, wanted):
    """Columns of a CSV file in SI.

    Parameters
    ----------
    path : path
        Its first line names each column with its unit: ``angle [deg], radius [mm]``. Commas stand between the columns,
        numbers have a decimal point, and every row has as many fields as the heading; empty lines are left out.
    wanted : dict
        Column name to SI unit.

    Returns
    -------
    list of arrays, in the order wanted

    Raises
    ------
    CaseError
        The file cannot be read, a column is missing, there twice, has no unit or one that does not convert, a row is of
        another length, or holds no number.
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


def _column(headings, rows, name, wanted):
    """Values of a column in the SI unit wanted; `ValueError` says what is wrong with it."""
    named = [_HEADING.fullmatch(heading) for heading in headings]
    names = [found[1].strip() if found else heading for found, heading in zip(named, headings, strict=True)]
    places = [place for place, found in enumerate(names) if found == name]
    if len(places) != 1:
        there = ", ".join(map(repr, headings[:20]))
        twice = f"{len(places)} columns are {name!r}, of {there}; keep one"
        raise ValueError(twice if places else f"no column {name!r}; it has {there}{checks.hint(name, names)}")
    (place,) = places
    heading, found = headings[place], named[place]
    if not found or not found[2]:
        raise ValueError(f'column {heading!r}: has no unit; head it for example "{name} [{wanted}]"')
    try:
        scale = factor(found[2].strip(), wanted)
    except ValueError as error:
        raise ValueError(f"column {heading!r}: {error}") from None
    for line, cells in rows:
        if not _is_number(cells[place]):
            raise ValueError(f"column {heading!r}, line {line}: not a number: {shown(cells[place])}")
    return np.array([cells[place] for _, cells in rows], dtype=float) * scale


def _is_number(cell):
    return _NUMBER.fullmatch(cell) is not None and abs(float(cell)) < np.inf


def _rows(path):
    """Headings, and each row that is not empty with the number of its line."""
    text = read_text(path, LARGEST_TABLE)
    lines = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
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
    return headings, rows


@contextmanager
def written_whole(path):
    """Path of a temporary file that takes the place of `path` when the block ends without an error."""
    path = Path(path)
    if path.exists() and not path.is_file():  # a pipe or a device takes what is written as it comes
        yield path
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    os.close(handle)
    try:
        yield temporary
        Path(temporary).chmod(0o666 & ~_umask())
        Path(temporary).replace(path)
    finally:
        Path(temporary).unlink(missing_ok=True)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
