"""Design sweeps: a row of numbers for each of many designs, on one core or many machines.

A sweep first checks all arguments, makes a `Job`, and tries it on one design. Then chunks of designs run through any
`concurrent.futures.Executor` (`workers`). With a folder the results go to a Parquet dataset (`dataset`), from which a
stopped sweep continues.
"""

import inspect
import pickle
import sys
import warnings
from collections.abc import Iterable
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import closing
from functools import partial

import numpy as np
import pandas as pd

from ..cycle.reductions import Output, SolutionNumber, parsed
from ..engines import numba_backend
from ..errors import ParameterError
from ..numbers import checks
from ..numbers.files import folder_problem
from ..numbers.fingerprint import digest
from ..numbers.formatting import parse_heading, si_columns
from ..solution.parameters import path_problem
from ..solution.scene import MIN_VALUES_COMPILED, Scene
from ..version import __version__
from .chunk import FAILED, MAX_PROBED_DESIGNS, MIN_ANGLES_PER_TURN, Job, dry_run
from .dataset import ChunkResults, Dataset
from .workers import MAX_CHUNK_RUNS, Workers, run_chunks


def job_of(source, designs, outputs, variant, reference, angles, engine, executor, workers, chunk):
    """The checked job, the engines to try, and the source and reference (only the source without ratios)."""
    compared = _source_and_reference(source, designs, variant, reference)
    known = compared[0].units if can_vary(compared[0]) else None
    wanted, problems = _outputs(outputs, getattr(source, "sizing", None))
    columns, wrong = si_columns(
        designs.columns, known, partial(path_problem, source) if isinstance(source, Scene) else None
    )
    problems += [
        *wrong,
        *_column_problems(designs, wanted),
        None if known is not None or wrong else _signature_problem(source, [name for _, name, _ in columns]),
        checks.count("angles", angles, size=checks.BYTES_PER_ANGLE),
        None if chunk is None else checks.count("chunk", chunk),
        None if engine is None else checks.choice("engine", engine, ("compiled", "numpy")),
        None if len(designs) else "the table of designs is empty",
        *_worker_problems(executor, workers),
        *(
            f"output {str(item)!r} needs more than {2 * item.order} crank angles, got {angles}"
            for item in wanted
            if isinstance(item, Output) and item.order and isinstance(angles, int) and 2 * item.order >= angles
        ),
    ]
    ratios = any(item.ratio for item in wanted)
    if ratios and not _is_scene(compared[1]):
        problems.append(f"ratios need a reference: a Scene, got {checks.shown(compared[1])}")
    checks.require("sweep", *problems)
    make, make_reference = partial(_call, source), partial(_return_fixed, reference)
    if known is not None:
        make, make_reference = (partial(_vary, item) for item in compared)
        wanted = tuple(item.of(compared[0]) for item in wanted)
    if engine == "compiled":
        numba_backend.require_numba()
    is_large = len(designs) * max(angles, MIN_ANGLES_PER_TURN) >= MIN_VALUES_COMPILED
    engines = [engine or "numpy"]
    if engine is None and is_large and numba_backend.numba_available():
        engines = ["compiled", "numpy"]
    threads = numba_backend.core_count() if executor is None and workers is None else 1
    together = tuple(item for item in wanted if isinstance(item, Output))
    alone = tuple(item for item in wanted if isinstance(item, SolutionNumber))
    order = tuple((*together, *alone).index(item) for item in wanted)
    made = make, make_reference if ratios else None
    job = Job(*made, columns, together, alone, order, angles, engines[-1], threads)
    _require_portable(job, executor, workers)
    return job, engines, compared if ratios else compared[:1]


def _source_and_reference(source, designs, variant, reference):
    """Source that designs vary, and reference of ratios; an error for arguments of the wrong kind."""
    if not isinstance(designs, pd.DataFrame):
        raise ParameterError(
            f"sweep: designs must be a pandas DataFrame, as from ks.designs, got {type(designs).__name__}"
        )
    if is_case(source):
        return variant_and_reference(source, variant, reference)
    if not (can_vary(source) or callable(source)):
        raise ParameterError(
            "sweep: source must be a Case, as from ks.load_case, a Scene or a function that returns a Scene, got "
            f"{checks.shown(source)}"
        )
    kind = "a Scene" if can_vary(source) else "a function"
    checks.require(
        "sweep",
        None
        if variant is None
        else f"variant names one of a case's variants, and {kind} has none, got {checks.shown(variant)}; leave it out, "
        "or give a Case",
        None
        if reference is None or _is_scene(reference)
        else f"reference must be a Scene, like the source, {kind}, got {checks.shown(reference)}",
    )
    return source, reference


def is_case(source):
    """Whether a source has variants by name, as a `Case` does."""
    return hasattr(source, "variants") and hasattr(source, "reference")


def can_vary(source):
    """Whether a source can be varied by path, as a `Scene` and a case's variant can."""
    return not isinstance(source, type) and hasattr(source, "varied") and hasattr(source, "units")


def variant_and_reference(case, variant=None, reference=None):
    """The variant that designs vary, and the reference of ratios."""
    return tuple(map(case.variant, case.names_of(variant, reference)))


def _is_scene(item):
    return isinstance(getattr(item, "scene", item), Scene)


def _vary(item, values):
    """The item with those values that are among its parameters."""
    known = item.units
    return item.varied({path: value for path, value in values.items() if path in known})


def _call(function, values):
    return function(**values)


def _return_fixed(item, values):
    return item


def output_list(outputs):
    """Outputs as a list; a single one may be given directly."""
    if isinstance(outputs, str | Output | SolutionNumber):
        return [outputs]
    if not isinstance(outputs, Iterable):
        raise ParameterError(f'sweep: outputs must be texts such as "largest O", got {outputs!r}')
    return list(outputs)


def _outputs(outputs, parts):
    """The parsed outputs, and problems with them; `parts` by name are those of a case."""
    wanted, problems = [], []
    for text in output_list(outputs):
        try:
            wanted.append(parsed(text, parts))
        except ParameterError as error:
            problems.append(str(error))
    return tuple(dict.fromkeys(wanted)), problems or ([] if wanted else ["give at least one output"])


def _column_problems(designs, wanted):
    """Problems with columns of the designs: the name of an output, or values other than plain numbers."""
    taken = {*map(str, wanted), FAILED}
    for column, kind in designs.dtypes.items():
        if parse_heading(column)[0] in taken:
            yield f"column {column!r} of the designs has the name of an output; rename it"
        if hasattr(kind, "units"):  # of pint-pandas
            yield f"column {column!r} must contain plain numbers, with the unit {kind.units} in its heading"
        elif not pd.api.types.is_any_real_numeric_dtype(kind):
            yield f"column {column!r} must contain numbers, but is of type {kind}"


def _signature_problem(function, names):
    try:
        inspect.signature(function).bind(**dict.fromkeys(names))
    except TypeError as error:
        return f"the function does not accept the columns of the designs: {error}"
    except ValueError:  # a function without a signature
        return None
    return None


def _worker_problems(executor, workers):
    """Problems with the executor or the number of workers, limited by the cores because each needs 100 MB."""
    if not isinstance(executor, Executor | None):
        found = type(executor).__name__
        yield f"executor must be an Executor of concurrent.futures (of Dask: client.get_executor()), got {found}"
    if workers is None:
        return
    most = max(64, 4 * numba_backend.core_count())
    if isinstance(workers, bool) or not isinstance(workers, int | np.integer) or not 1 <= workers <= most:
        yield f"workers must be a whole number of processes from 1 to {most} here, got {workers!r}"
    elif executor is not None:
        yield "give workers or an executor, not both"


def _require_portable(job, executor, workers):
    """Raise an error for functions that cannot be pickled for other processes."""
    if workers:
        from cloudpickle import dumps

        remedy = "give it no open files or locks, or use threads"
    elif isinstance(executor, ProcessPoolExecutor):
        dumps, remedy = pickle.dumps, "define the function at the top of a module, or use workers=n, threads or Dask"
    else:
        return
    try:
        dumps(job)
    except Exception as error:
        raise ParameterError(
            f"sweep: the function and its reference cannot go to other processes: {error}; {remedy}, which take any"
        ) from error


CHUNK_DESIGNS, STREAMED_CHUNK_DESIGNS = 10_000, 50_000
"""Default numbers of designs in a chunk: in general, and for a compiled loop in this process without a folder."""


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
        In a case, numbers that its file derives from others follow (`Variant.varied`); in a scene all other numbers are
        constant. A function has the parameters as keywords, arrays (designs, 1) in SI, and returns a `Scene`. A
        function of plain numbers also works, but each design is then solved separately, in some milliseconds; the same
        holds for variants balanced by counterweights.
    designs : pandas.DataFrame
        A column for each parameter. For a case or scene its path with a unit, "spring.stiffness [kN/m]" (see
        `designs.grid`, `.latin_hypercube` ...); for a function its keyword. SI without a unit.
    outputs : sequence of str
        "largest O", "mean_absolute balancing_torque", "range cam_force", "harmonic_2 balancing_torque" ... "largest
        contact_pressure" needs a cam with a `Roller`; "swing balancing_torque" is the energy of its flywheel, J. A
        leading "ratio" divides the reference's number by the design's. `reductions.REDUCTIONS` lists all reductions.
        "main_bearing.life_hours" is a number of a part in the case's [sizing], or `sizing.Part.number`; each design is
        then solved separately.
    variant, reference : str
        For a case: the variant that the designs vary (by default the first besides the reference), and the reference of
        ratios (by default the case's). For a scene or function `reference` is a `Scene`. The reference varies in shared
        parameters, except for a function.
    angles : int
        Crank angles over the period of the loads, at least 12; a turn has at least 180, and 192 with tables or
        friction. Extremes are refined between them. For a design with an unresolved output they are doubled, up to
        5760. If tables or friction cause kinks, the turn of each design is split, so peaks and means are exact. Table
        rows within 1e-5 of the largest value of a smooth curve cause no split, unless an output needs it.
    engine : "compiled" or "numpy"
        By default "compiled" for a million crank angles or more, over all designs, if numba is installed and supports
        the mechanism.
    executor : concurrent.futures.Executor
        Runs the chunks; by default this process runs them, on all its cores. For a Dask cluster:
        ``client.get_executor()``. An executor that breaks ends the sweep.
    workers : int
        Instead of an executor: number of worker processes (by loky), which accept any function and end with this
        process. If a worker dies, only its chunks run again; only designs that kill their worker have no numbers.
    chunk : int
        Number of designs computed together; it limits the memory. By default 10 000, or 50 000 if this process computes
        them compiled and writes no folder.
    folder : path
        Parquet dataset for the finished chunks. If it contains part of the same sweep, only the remaining chunks and
        damaged files are computed. Functions are equal if their code, closures and used names of their own module are
        equal (`numbers.fingerprint`).
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    pandas.DataFrame
        The designs with a column for each output, in SI, and a column "failed": the reason why a design has no numbers,
        else empty. Last bits may differ with the chunk: if a design comes near a singular position, its whole chunk is
        computed by special formulas. ``attrs["resolution"]`` is the resolution of load functions without `kinks`, if
        there are any.

    Raises
    ------
    ParameterError
        A parameter, unit, output or reduction is unknown, or the folder contains another sweep.
    QuantityError
        The quantity is unknown in the mechanism, or in the reference of a ratio.
    NotGivenError
        ``engine="compiled"`` does not support the mechanism.

    Warns
    -----
    HintWarning
        Implausible numbers of the first valid design, before the sweep begins; or its load functions without `kinks`
        change between their samples.

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
    from tqdm import tqdm

    checks.require("sweep", None if folder is None else folder_problem(folder), checks.truth("progress", progress))
    job, engines, compared = job_of(
        source, designs, outputs, variant, reference, angles, engine, executor, workers, chunk
    )
    with Workers(executor, workers) as pool:
        job = _dry_run(job, designs, engines, pool)
        for hint in job.hints:
            warnings.warn(hint, stacklevel=2)
        here = executor is None and workers is None and folder is None
        chunk = chunk or (STREAMED_CHUNK_DESIGNS if here and job.streams else CHUNK_DESIGNS)
        parts = ChunkResults(designs, chunk)
        if folder is not None:
            parts = Dataset(designs, chunk, folder, _identity(job, designs, compared, chunk))
        todo = [number for number in parts.numbers if not parts.holds(number)]
        with (
            tqdm(total=len(designs), unit=" designs", disable=not progress) as bar,
            closing(run_chunks(job, parts.rows, todo, pool)) as found,
        ):
            bar.update(len(designs) - sum(len(parts.rows(number)) for number in todo))
            for number, rows in found:
                parts.keep(number, rows)
                bar.update(len(rows))
    table = parts.table()
    if job.resolution:
        table.attrs["resolution"] = job.resolution
    return table


def _dry_run(job, designs, engines, pool):
    """The job after a dry run, which skips a few chunks of designs that kill their worker."""
    for first in range(min(MAX_CHUNK_RUNS, len(designs))):
        for ready in pool.result_unless_killed(dry_run, job, designs[first : first + MAX_PROBED_DESIGNS], engines):
            return ready or job
    return job


def _identity(job, designs, compared, chunk):
    """All inputs of the results of a sweep, by name; a folder continues a sweep only if all of them are equal."""
    hashed = pd.util.hash_pandas_object(designs, index=True).to_numpy()
    of_case = hasattr(compared[0], "content")
    varied = "variant" if of_case else "scene" if hasattr(compared[0], "mechanism") else "function"
    return {
        "version": __version__,
        **({} if of_case else {"python": sys.implementation.cache_tag}),  # bytecode differs between releases
        **{name: digest(item) for name, item in zip((varied, "reference"), compared, strict=False)},
        "outputs": [*map(str, job.outputs), *(digest((str(item), item.function)) for item in job.numbers)],
        "angles": int(job.angles),
        "chunk": int(chunk),
        "columns": [str(column) for column in designs.columns],
        "designs": digest(hashed),
    }
