"""Files: CSV tables read to SI, and results written whole or not at all."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .errors import CaseError
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
