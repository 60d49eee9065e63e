"""Design sweeps: a row of numbers for each of many designs, on one core or many machines.

What is asked for is checked (`asked`), and tried on one design (`job`). Then a sweep goes chunk by chunk (`chunks`)
through any `concurrent.futures.Executor` (`workers`); with a folder the results stream to a Parquet dataset
(`dataset`), from which a sweep that was stopped goes on.
"""

import sys
import warnings
from contextlib import closing

import pandas as pd

from ..numbers import checks
from ..numbers.files import folder_problem
from ..numbers.fingerprint import digest
from ..version import __version__
from .asked import job_of
from .chunks import FAILED
from .dataset import Dataset, Parts
from .job import PROBED, tried
from .workers import ATTEMPTS, Workers, computed

__all__ = ["FAILED", "sweep"]

CHUNK, WIDE = 10_000, 50_000
"""Designs computed together, unless told, and where they take little time and memory and nobody waits for them."""


def sweep(
    source,
    designs,
    outputs,
    *,
    variant=None,
    reference=None,
    angles=360,
    engine=None,
    executor=None,
    workers=None,
    chunk=None,
    folder=None,
    progress=True,
):
    """Outputs of many designs, a row for each.

    Parameters
    ----------
    source : Case, Scene or function
        Of a case what its file derives from other numbers follows (`Variant.varied`); of a scene all numbers stay but
        those that vary. Or a function that takes the parameters as keywords, arrays (designs, 1) in SI, and returns a
        `Scene`. A function of plain numbers will do, but then each design is solved by itself, which takes some
        milliseconds; so it is with variants that are balanced by counterweights.
    designs : pandas.DataFrame
        A column for each parameter: of a case or scene its path with a unit, "spring.stiffness [kN/m]" (see
        `designs.grid`, `.latin_hypercube` ...); of a function its keyword. Without a unit in SI.
    outputs : sequence of str
        "largest O", "mean_absolute balancing_torque", "range cam_force", "harmonic_2 balancing_torque", "largest
        contact_pressure" (of a cam with a `Roller`), "swing balancing_torque" (the energy of its flywheel, J) ...; with
        "ratio" in front the reference's number divided by the design's. All reductions: `reductions.REDUCTIONS`.
    variant, reference : str
        Of a case: which variant the designs vary (the only one, or the first besides the reference), and which one
        ratios refer to (the case's reference). Of a scene or function `reference` is a `Scene`. It takes those
        parameters that it has too, but stays as it is for a function.
    angles : int
        Crank angles over the period of the loads, at least 12, but 180 a turn are taken where these are fewer, 192
        with tables or friction; extremes are refined between them. Where they do not resolve an output of a design,
        they are doubled for it, up to 5760. Where tables or friction bend forces, the turn of each design is parted
        there, so that neither peaks nor means miss what lies between two angles. Rows within 1e-5 of the largest value
        of a smooth curve bend nothing, unless they keep an output from being resolved.
    engine : "compiled" or "numpy"
        Unless told, compiled for a million crank angles, all designs together, and more, if numba is installed and
        takes the mechanism.
    executor : concurrent.futures.Executor
        Where chunks run; this process, on all its cores, unless told. A Dask cluster: ``client.get_executor()``. One
        that breaks ends the sweep.
    workers : int
        In place of an executor: so many processes of the sweep's own (by loky), which take any function and end with
        this process. When one dies, only the chunks under way are run again, and only designs that kill their worker by
        themselves have no numbers.
    chunk : int
        Designs computed together: what bounds the memory. Unless told 10 000, or 50 000 where this process computes
        them compiled and writes no folder.
    folder : path
        Parquet dataset that chunks are written to as they are done. If it holds part of the same sweep, that is kept
        and the rest computed, also what was damaged since. A function is the same if its code is, with what it holds
        and what it names of its own module (`numbers.fingerprint`).
    progress : bool
        Whether a bar is shown.

    Returns
    -------
    pandas.DataFrame
        The designs with a column for each output, in SI, and a column "failed": why a design has none, else empty.
        Last bits may differ with the chunk: where a design comes near a singular place, all of its chunk are computed
        by formulas made for that.

    Raises
    ------
    ParameterError
        A parameter, unit, output or reduction is not known, or the folder holds another sweep.
    QuantityError
        The mechanism, or the reference of a ratio, has no such quantity.
    NotGivenError
        ``engine="compiled"`` does not take the mechanism.

    Warns
    -----
    HintWarning
        Numbers of the first design that can be made look like slips; told before the sweep begins.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> table = ks.sweep(
    ...     saw, ks.designs.grid({"spring.stiffness": "600..800 kN/m:3"}),
    ...     ["ratio mean_absolute balancing_torque"], variant="cam-circle", progress=False,
    ... )
    >>> table.iloc[:, 1].round(1).tolist()
    [3.9, 7.6, 50.6]
    """
    checks.require("sweep", None if folder is None else folder_problem(folder), checks.truth("progress", progress))
    job, engines, compared = job_of(
        source, designs, outputs, variant, reference, angles, engine, executor, workers, chunk
    )
    with Workers(executor, workers) as hands:
        job = _tried(job, designs, engines, hands)
        for hint in job.hints:
            warnings.warn(hint, stacklevel=2)
        here = executor is None and workers is None and folder is None
        chunk = chunk or (WIDE if here and job.wide else CHUNK)
        parts = Parts(designs, chunk)
        if folder is not None:
            parts = Dataset(designs, chunk, folder, _identity(job, designs, compared, chunk))
        todo = [number for number in parts.numbers if not parts.holds(number)]
        with _bar(progress, len(designs)) as bar, closing(computed(job, parts.rows, todo, hands)) as found:
            bar.update(len(designs) - sum(len(parts.rows(number)) for number in todo))
            for number, rows in found:
                parts.keep(number, rows)
                bar.update(len(rows))
    return parts.table()


def _tried(job, designs, engines, hands):
    """The job made ready by a trial; designs with which workers die are passed over, some of them."""
    for first in range(min(ATTEMPTS, len(designs))):
        for ready in hands.survived(tried, job, designs[first : first + PROBED], engines):
            return ready or job
    return job


def _bar(shown, total):
    from tqdm import tqdm

    return tqdm(total=total, unit=" designs", disable=not shown)


def _identity(job, designs, compared, chunk):
    """What the results of a sweep depend on, by name: a folder takes up a sweep only if all of it is the same."""
    hashed = pd.util.hash_pandas_object(designs, index=True).to_numpy()
    of_case = hasattr(compared[0], "content")
    varied = "variant" if of_case else "scene" if hasattr(compared[0], "mechanism") else "function"
    return {
        "version": __version__,
        **({} if of_case else {"python": sys.implementation.cache_tag}),  # whose code differs from release to release
        **{name: digest(item) for name, item in zip((varied, "reference"), compared, strict=False)},
        "outputs": [str(item) for item in job.outputs],
        "angles": int(job.angles),
        "chunk": int(chunk),
        "columns": [str(column) for column in designs.columns],
        "designs": digest(hashed),
    }
