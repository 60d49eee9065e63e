"""Tables: a solution as a DataFrame, extremes as a DataFrame, CSV in and out."""

import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .errors import CaseError, QuantityError
from .extremes import extremes
from .quantities import UNITS, VECTORS, label, unit
from .units import to_si


def solution_frame(solution):
    """One row for each crank angle (and design), units in the column names."""
    import pandas as pd

    columns = {"crank_angle [deg]": np.degrees(solution.crank_angle)}
    for joint in solution.placement.joints:
        columns |= _components(joint, "m", solution.position(joint))
    for link, motion in solution.placement.links.items():
        if motion.ratio is not None:
            columns[f"{link}_rate [rad/s]"] = solution.rate(link)
            columns[f"{link}_angular_acceleration [rad/s2]"] = solution.angular_acceleration(link)
    for joint in solution.reactions:
        columns |= _components(f"reaction_{joint}", "N", solution.reaction(joint))
    for name in available(solution):
        if name in VECTORS:
            columns |= _components(name, unit(name), getattr(solution, name))
        elif name in UNITS:
            columns[f"{name} [{unit(name)}]"] = getattr(solution, name)
    shape = np.broadcast_shapes(*(np.shape(values) for values in columns.values()))
    table = pd.DataFrame({name: np.broadcast_to(values, shape).ravel() for name, values in columns.items()})
    if len(shape) > 1:
        designs = np.prod(shape[:-1], dtype=int)
        table.insert(0, "design", np.repeat(np.arange(designs), shape[-1]))
    return table


def _components(name, measure, vector):
    return {f"{name}_x [{measure}]": vector[0], f"{name}_y [{measure}]": vector[1]}


def available(solution):
    """Names of the quantities this solution has: scalars and vectors first, then its joints."""
    names = []
    for name in UNITS:
        try:
            getattr(solution, name)
        except QuantityError:
            continue
        names.append(name)
    return (*names, *solution.reactions)


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity, with its crank angle."""
    import pandas as pd

    rows = []
    for name in available(solution):
        found = extremes(solution, name)
        if len(found):
            low, high = np.argmin(found.value), np.argmax(found.value)
            ends = (found.value[low], np.degrees(found.angle[low]), found.value[high], np.degrees(found.angle[high]))
        else:
            constant = float(np.ravel(_constant(solution, name))[0])
            ends = (constant, np.nan, constant, np.nan)
        rows.append((label(name), unit(name), *ends))
    columns = ["quantity", "unit", "smallest", "smallest at [deg]", "largest", "largest at [deg]"]
    return pd.DataFrame(rows, columns=columns).set_index("quantity")


def _constant(solution, name):
    from .quantities import values

    return values(solution.at(np.zeros(1)), name)


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
