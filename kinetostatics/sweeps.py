"""Design sweeps: a row of numbers for each of many designs, on one core or many machines.

A sweep goes chunk by chunk: a chunk of designs is built as one batch, its loop runs block by block so that values over
the turn never leave the cache, and what is kept is one number for each output. Chunks go through any
`concurrent.futures.Executor`; with a folder they stream to a Parquet dataset, from which a sweep that was stopped goes
on.
"""

import hashlib
import inspect
import json
from collections import Counter, deque
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np
import pandas as pd

from . import checks, compiled
from .case import Case, Variant, load_case
from .errors import ParameterError
from .files import written_whole
from .parameters import base_columns, paths, si_columns
from .quantities import components, magnitude
from .reductions import Output, parsed
from .solution import Solution

BLOCK = 64
"""Designs whose values over the turn are held at a time, by each core."""
ATTEMPTS = 3
"""How often a chunk is run whose worker dies, before its designs are given up."""
WAITING = 32
"""Chunks handed to an executor at a time."""
FAILED = "failed"
"""Column with the reason why a design has no numbers; empty for the others."""


@dataclass(frozen=True)
class Job:
    """What to do with a chunk of designs; goes to the workers.

    Attributes
    ----------
    make, make_reference : function
        From values in SI by name to a `Variant`; None without ratios.
    columns : tuple of (column, name, factor)
        Where the values stand in the table of designs.
    """

    make: Callable[[dict], Variant]
    make_reference: Callable[[dict], Variant] | None
    columns: tuple[tuple[str, str, float], ...]
    outputs: tuple[Output, ...]
    angles: int
    engine: str
    threads: int


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
    chunk=10_000,
    folder=None,
    progress=True,
):
    """Outputs of many designs, a row for each.

    Parameters
    ----------
    source : Case or function
        A case, or a function that takes the parameters as keywords, arrays (designs, 1) in SI, and returns a
        `case.Variant` of a mechanism, drive and loads.
    designs : pandas.DataFrame
        A column for each parameter: of a case its path with a unit, "spring.stiffness [kN/m]" (see
        `designs.grid`, `.latin_hypercube` ...); of a function its keyword. Without a unit in SI.
    outputs : sequence of str
        "largest O", "mean_absolute balancing_torque", "range cam_force", "harmonic_2 balancing_torque" ...; with
        "ratio" in front the reference's number divided by the design's. All reductions: `reductions.REDUCTIONS`.
    variant, reference : str
        Of a case: which variant the designs vary (the only one, or the first besides the reference), and which one
        ratios refer to (the case's reference); the reference takes those parameters that it has too. With a function,
        `reference` is a `Variant`.
    angles : int
        Crank angles over the turn; extremes are refined between them.
    engine : "compiled" or "numpy"
        Compiled if numba is installed, unless told.
    executor : concurrent.futures.Executor
        Where chunks run; this process, on all its cores, unless told. A Dask cluster: ``client.get_executor()``.
    chunk : int
        Designs computed together: what bounds the memory.
    folder : path
        Parquet dataset that chunks are written to as they are done. If it holds part of the same sweep, that is kept
        and the rest computed.
    progress : bool
        Whether a bar is shown.

    Returns
    -------
    pandas.DataFrame
        The designs with a column for each output, in SI, and a column "failed": why a design has none, else empty.

    Raises
    ------
    ParameterError
        A parameter, unit, output or quantity is not known, or the folder holds another sweep.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> table = ks.sweep(
    ...     saw, ks.designs.grid({"spring.stiffness": "600..800 kN/m:3"}),
    ...     ["ratio mean_absolute balancing_torque"], variant="cam-circle", progress=False,
    ... )
    >>> table.iloc[:, 1].round(2).tolist()
    [2.83, 8.55, 3.47]
    """
    job = _job(source, designs, outputs, variant, reference, angles, engine, executor)
    checks.require("sweep", checks.positive("chunk", chunk))
    parts = _Parts(folder, _fingerprint(source, job, designs, variant, reference, chunk), designs, chunk)
    with _bar(progress, len(designs)) as bar:
        bar.update(sum(len(parts.rows(number)) for number in parts.done))
        for number, found in _computed(job, parts, executor):
            parts.keep(number, found)
            bar.update(len(found))
    return parts.table()


def _bar(shown, total):
    from tqdm.auto import tqdm

    return tqdm(total=total, unit=" designs", disable=not shown)


# What is to be done, checked


def _job(source, designs, outputs, variant, reference, angles, engine, executor):
    wanted = tuple(map(parsed, [outputs] if isinstance(outputs, str | Output) else outputs))
    engine = engine or ("compiled" if compiled.available() else "numpy")
    checks.require(
        "sweep",
        None if len(designs) else "there are no designs",
        None if wanted else "no outputs are asked for",
        checks.choice("engine", engine, ("compiled", "numpy")),
        checks.positive("angles", angles),
    )
    ratios = any(item.ratio for item in wanted)
    if isinstance(source, Case):
        variant, reference = _variants(source, variant, reference)
        path = str(Path(source.path).resolve())
        make, make_reference = (partial(_varied, path, name) for name in (variant, reference))
        columns = si_columns(source.variant(variant).table, designs.columns, f"sweep of {variant}")
    else:
        make, make_reference = partial(_called, source), None if reference is None else partial(_fixed, reference)
        columns = base_columns(designs.columns)
    if ratios and make_reference is None:
        raise ParameterError("sweep: ratios need a reference: a Variant, as the function makes")
    threads = 1 if executor is not None else compiled.cores()
    job = Job(make, make_reference if ratios else None, columns, wanted, angles, engine, threads)
    _require_quantities(job, designs)
    return job


def _variants(case, variant, reference):
    reference = reference or case.reference
    variant = variant or next((name for name in case.variants if name != reference), reference)
    for name in (variant, reference):
        case.variant(name)
    return variant, reference


@cache
def _case(path):
    return load_case(path)


def _varied(path, name, values):
    """Variant of a case with those of the values that it has a place for."""
    variant = _case(path).variant(name)
    known = paths(variant.table)
    return variant.varied({path: value for path, value in values.items() if path in known})


def _called(function, values):
    return function(**values)


def _fixed(variant, values):
    return variant


def _require_quantities(job, designs):
    """Raise `QuantityError` for a quantity that no design has, by the first of some designs that can be solved."""
    for row in range(min(len(designs), BLOCK)):
        try:
            made = _solution(job.make(_scalars(job, designs.iloc[row : row + 1])), 8)
        except Exception:
            continue
        for item in job.outputs:
            components(made, item.quantity)
        return


def _values(job, frame):
    return {name: frame[column].to_numpy(dtype=float)[:, None] * factor for column, name, factor in job.columns}


def _scalars(job, frame):
    return {name: float(value[0, 0]) for name, value in _values(job, frame).items()}


def _solution(variant, angles):
    turn = np.linspace(0.0, 2 * np.pi, angles, endpoint=False)
    return Solution(variant.mechanism, turn, variant.crank_speed, variant.crank_acceleration, variant.loads)


# One chunk


def run_chunk(job, frame) -> pd.DataFrame:
    """Outputs of some designs, with the reason for those that have none; what a worker does."""
    numbers = np.full((len(job.outputs), len(frame)), np.nan)
    reasons = np.full(len(frame), "", dtype=object)
    own = [k for k, item in enumerate(job.outputs)]
    numbers[own], reasons[:] = _reduced(job.make, job, frame, job.outputs)
    ratios = [k for k, item in enumerate(job.outputs) if item.ratio]
    if ratios:
        above, failing = _reduced(job.make_reference, job, frame, [job.outputs[k] for k in ratios])
        with np.errstate(divide="ignore", invalid="ignore"):
            numbers[ratios] = above / numbers[ratios]
        reasons = np.where((reasons == "") & (failing != ""), "reference: " + failing.astype(object), reasons)
    numbers[:, reasons != ""] = np.nan
    found = {item.column: row for item, row in zip(job.outputs, numbers, strict=True)}
    return pd.DataFrame({**found, FAILED: reasons.astype(str)}, index=frame.index)


def _reduced(make, job, frame, outputs):
    """Numbers (outputs, designs) and reasons (designs,), empty for designs that have numbers."""
    numbers, reasons = np.full((len(outputs), len(frame)), np.nan), np.full(len(frame), "", dtype=object)
    try:
        variant = make(_values(job, frame) if len(frame) > 1 else _scalars(job, frame))
        numbers, gaps = _run(variant, job, len(frame), outputs)
    except Exception as error:
        if len(frame) == 1:
            reasons[0] = str(error) or type(error).__name__
            return numbers, reasons
        for part in _apart(error, len(frame)):
            numbers[:, part], reasons[part] = _reduced(make, job, frame.iloc[part], outputs)
        return numbers, reasons
    for row in np.flatnonzero(gaps):
        reasons[row] = (
            f"{variant.mechanism.name} cannot be assembled at {gaps[row]} of {job.angles} crank angles; change the "
            "lengths"
        )
    return numbers, reasons


def _apart(error, count):
    """Rows to try again apart from each other: the good ones and each wrong one, or halves if that is not known."""
    wrong = np.ravel(getattr(error, "designs", None))
    if wrong.dtype == bool and wrong.size == count and wrong.any():
        return [part for part in (np.flatnonzero(~wrong), *np.flatnonzero(wrong)[:, None]) if part.size]
    return np.array_split(np.arange(count), 2)


def _run(variant, job, count, outputs):
    """Numbers (outputs, designs), and at how many crank angles each design does not close."""
    solution = _solution(variant, job.angles)
    quantities = list(dict.fromkeys(item.quantity for item in outputs))
    evaluate = (_by_loop if job.engine == "compiled" else _by_numpy)(solution, quantities, count)
    numbers, gaps = np.empty((len(outputs), count)), np.zeros(count, dtype=int)

    def fill(start):
        block = slice(start, min(start + BLOCK, count))
        with np.errstate(all="ignore"):
            found = dict(zip(quantities, evaluate(block), strict=True))
            for row, item in enumerate(outputs):
                numbers[row, block] = item.reduced(found[item.quantity])
            gaps[block] = np.max([np.isnan(values).sum(axis=-1) for values in found.values()], axis=0)

    with ThreadPoolExecutor(job.threads) as threads:
        list(threads.map(fill, range(0, count, BLOCK)))
    return numbers, gaps


def _by_loop(solution, quantities, count):
    """Function from a block of designs to the values of each quantity over the turn, (block, N), compiled."""
    program = compiled.program(solution, quantities)
    angle = solution.crank_angle[None]
    turn, tables = program.turn(angle), program.tabulated(solution)
    parameters = np.broadcast_to(program.parameters, (count, program.parameters.shape[1]))
    widths = program.trace.widths

    def evaluate(block):
        shared = tables if tables.shape[1] == 1 else tables[:, block]
        rows = program.at(angle, *turn, shared, np.ascontiguousarray(parameters[block]))
        for part in np.split(rows, np.cumsum(widths)[:-1]):
            yield part[0] if len(part) == 1 else magnitude(part)

    return evaluate


def _by_numpy(solution, quantities, count):
    """The same by NumPy, which holds the whole batch at a time."""
    found = [np.broadcast_to(values, (count, values.shape[-1])) for values in _magnitudes(solution, quantities)]
    return lambda block: [values[block] for values in found]


def _magnitudes(solution, quantities):
    for name in quantities:
        parts = components(solution, name)
        yield parts[0] if len(parts) == 1 else magnitude(parts)


# Chunk after chunk


def _computed(job, parts, executor):
    """Number and result of each chunk still to do, in the order in which they are done."""
    if executor is None:
        for number in parts.todo:
            yield number, run_chunk(job, parts.rows(number))
        return
    waiting, running = deque(parts.todo), {}
    deaths: Counter[int] = Counter()
    suspects: set[int] = set()
    while waiting or running:
        while waiting and len(running) < (1 if suspects else WAITING):
            number = waiting.popleft()
            try:
                running[executor.submit(run_chunk, job, parts.rows(number))] = number
            except BrokenExecutor:
                waiting.appendleft(number)
                executor = _renewed(executor)
        for future in wait(running, return_when=FIRST_COMPLETED).done:
            number = running.pop(future)
            try:
                found = future.result()
            except Exception as error:
                if not _died(error):
                    raise
                # in a broken pool every chunk under way is lost: those run again one by one, to find the one to blame
                alone = not running and suspects
                deaths[number] += bool(alone)
                suspects.add(number)
                if deaths[number] < ATTEMPTS:
                    waiting.appendleft(number)
                    continue
                found = _given_up(job, parts.rows(number))
            suspects.discard(number)
            yield number, found


def _died(error):
    """Whether a worker was lost, not the computation wrong; KilledWorker is what Dask says."""
    return isinstance(error, BrokenExecutor) or type(error).__name__ == "KilledWorker"


def _renewed(executor):
    """A process pool like one that broke."""
    return type(executor)(max_workers=getattr(executor, "_max_workers", None))


def _given_up(job, frame):
    columns = {item.column: np.nan for item in job.outputs}
    return pd.DataFrame({**columns, FAILED: f"the worker died {ATTEMPTS} times with these designs"}, index=frame.index)


def _fingerprint(source, job, designs, variant, reference, chunk):
    """What makes a sweep the same sweep, by name."""
    text = Path(source.path).read_text(encoding="utf-8") if isinstance(source, Case) else inspect.getsource(source)
    hashed = pd.util.hash_pandas_object(designs, index=True).to_numpy().tobytes()
    return {
        "source": hashlib.sha256(text.encode()).hexdigest(),
        "variant": str(variant),
        "reference": str(reference),
        "outputs": [str(item) for item in job.outputs],
        "angles": job.angles,
        "chunk": chunk,
        "columns": [str(column) for column in designs.columns],
        "designs": hashlib.sha256(hashed).hexdigest(),
    }


class _Parts:
    """Results by chunk: in memory, or as files of a Parquet dataset that outlive the process."""

    def __init__(self, folder, fingerprint, designs, chunk):
        self.designs, self.chunk = designs, chunk
        self.folder = None if folder is None else Path(folder)
        self.count = -(-len(designs) // chunk)
        self.kept: dict[int, pd.DataFrame] = {}
        if self.folder is not None:
            self._open(fingerprint)
        self.done = [number for number in range(self.count) if self.folder and self._path(number).exists()]
        self.todo = [number for number in range(self.count) if number not in set(self.done)]

    def _open(self, fingerprint):
        manifest = self.folder / "sweep.json"
        if manifest.exists():
            before = json.loads(manifest.read_text(encoding="utf-8"))
            differing = [name for name, value in fingerprint.items() if before.get(name) != value]
            if differing:
                raise ParameterError(
                    f"sweep: {self.folder} holds another sweep, which differs in {', '.join(differing)}; give another "
                    "folder, or delete that one"
                )
        else:
            with written_whole(manifest) as temporary:
                Path(temporary).write_text(json.dumps(fingerprint, indent=1), encoding="utf-8")

    def _path(self, number):
        return self.folder / f"part-{number:06d}.parquet"

    def rows(self, number):
        return self.designs.iloc[number * self.chunk : (number + 1) * self.chunk]

    def keep(self, number, found):
        whole = pd.concat([self.rows(number), found], axis=1)
        if self.folder is None:
            self.kept[number] = whole
        else:
            with written_whole(self._path(number)) as temporary:
                whole.to_parquet(temporary)

    def table(self):
        """All rows in the order of the designs."""
        numbers = range(self.count)
        if self.folder is None:
            return pd.concat([self.kept[number] for number in numbers])
        return pd.concat([pd.read_parquet(self._path(number)) for number in numbers])
