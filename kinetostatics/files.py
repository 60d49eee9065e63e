"""Files: CSV tables read to SI, and results written whole or not at all."""

import os
import secrets
import stat
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np

from . import checks
from .errors import CaseError, FileError
from .units import to_si


def read_columns(path, wanted):
    """Columns of a CSV file in SI.

    Parameters
    ----------
    path : path
        Its first line names each column with its unit: ``angle [deg], radius [mm]``.
    wanted : dict
        Column name to SI unit.

    Returns
    -------
    list of arrays, in the order wanted

    Raises
    ------
    CaseError
        The file cannot be read, a column is missing, has no unit or one that does not convert, or holds no number.
    """
    import pandas as pd

    try:
        table = pd.read_csv(path, skipinitialspace=True)
    except (OSError, ValueError) as error:
        raise CaseError(path, [f"cannot be read as CSV: {error}"]) from error
    headings = {str(column).partition("[")[0].strip(): column for column in table.columns}
    problems, columns = [], []
    for name, wanted_unit in wanted.items():
        if name not in headings:
            problems.append(f"no column {name!r}; it has {', '.join(map(str, table.columns))}")
            continue
        heading = str(headings[name])
        given = heading.partition("[")[2].rstrip("] ")
        try:
            factor = to_si(f"1 {given}", wanted_unit)
        except ValueError as error:
            problems.append(f"column {heading!r}: {error}")
            continue
        values = pd.to_numeric(table[headings[name]], errors="coerce").to_numpy(dtype=float)
        if not np.all(np.isfinite(values)):
            row = int(np.argmin(np.isfinite(values)))
            problems.append(f"column {heading!r}, line {row + 2}: not a number: {table[headings[name]].iloc[row]!r}")
        columns.append(values * factor)
    if problems:
        raise CaseError(path, problems)
    return columns


@contextmanager
def written_whole(path):
    """Path of a temporary file that takes the place of `path` when the block ends without an error.

    What stands there keeps its permissions and, where that is allowed, its owner; through a symbolic link its target is
    written. A file that may not be written is refused.
    """
    path = Path(os.path.realpath(path))
    if path.exists() and not path.is_file():  # a pipe or a device takes what is written as it comes
        yield path
        return
    problem = unwritable(path)
    if problem:
        raise FileError(problem)
    path.parent.mkdir(parents=True, exist_ok=True)
    before = path.stat() if path.exists() else None
    temporary = path.with_name(f".{secrets.token_hex(8)}{path.suffix}")
    try:
        _create(temporary, 0o600 if before else 0o666, path)
        yield str(temporary)
        if before is not None:
            _resembling(temporary, before)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _create(temporary, mode, path):
    """An empty file that is new; errors name what it is for."""
    try:
        os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))
    except OSError as error:
        error.filename = str(path)
        raise


def _resembling(path, before):
    """Give a file the permissions that another had, and its owner where this process may."""
    own = path.stat()
    if hasattr(os, "chown") and (own.st_uid, own.st_gid) != (before.st_uid, before.st_gid):
        with suppress(PermissionError):
            os.chown(path, before.st_uid, before.st_gid)
    path.chmod(stat.S_IMODE(before.st_mode))


def unwritable(path, *, inputs=(), endings=()):
    """Why a result cannot be written to this file, as a sentence, or None; to ask before the work that it takes.

    Parameters
    ----------
    path : path
    inputs : sequence of paths
        What is read and so must not be replaced, under whatever name.
    endings : sequence of str
        Those a file may have; pipes and devices have none.
    """
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
        return unwritable_folder(target.parent)
    except (OSError, ValueError) as error:
        return f"{str(path)!r} is no name of a file here: {getattr(error, 'strerror', None) or error}"


def unwritable_folder(path):
    """Why results cannot be written into this folder, as a sentence, or None; it need not exist."""
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
