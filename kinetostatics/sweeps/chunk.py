"""The computation of a chunk of designs: one batch, reduced to a row of numbers for each design.

`_compute_designs` separates designs that cannot be built or solved, each with its reason; the others stay in one batch.
The loop over designs and crank angles runs block by block, so that values over the turn stay in the cache. `dry_run`
computes one design before the sweep to choose engine and crank angles. Designs whose outputs are not resolved by the
crank angles are computed again with twice as many.
"""

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from ..cycle.compiled_reductions import CompiledReductions
from ..cycle.kinks import has_kinks
from ..cycle.limit_positions import NEAR
from ..cycle.load_functions import repeating_problem, resolution_note
from ..cycle.peaks import lowest
from ..cycle.reductions import Output, SolutionNumber
from ..cycle.rounding import FLOOR
from ..engines import numba_backend, shared_work
from ..engines.program import program_of
from ..errors import HintWarning, MissingLibraryError, NotGivenError, ParameterError, QuantityError
from ..machine.loads import KINK_TOLERANCE, TURN, refusals
from ..mechanics import energy_contact
from ..mechanics.assembly import NO_DIGITS_CONDITION
from ..mechanics.quantities import component_sizes, components, largest_term, quantity
from ..numbers import checks
from ..numbers.arithmetic import SQUARE_TOLERANCE
from ..solution.parameters import tables_over_angles
from ..solution.piecewise_turns import BLOCK_VALUES, START_ANGLES, PiecewiseTurns, quantity_names, unchecked_turn
from ..solution.scene import Scene, scene_hints

MAX_SPLIT_DESIGNS = 128
"""Number of designs whose turns are split at kinks together: a compromise of call overhead and memory."""
MAX_LOOP_VALUES = 40_000
"""Values of all quantities over designs and angles in a block of the compiled loop: a third of a core's cache."""
PARTS_PER_THREAD = 8
"""Number of parts of a chunk per thread, so that threads end at about the same time."""


def compute_batch(scene, job, count, outputs):
    """Outputs of a batch of designs: numbers, reasons, rough, nearest, kinked.

    The numbers are (outputs, designs), the reasons (designs,) of text, empty for a design with numbers. `rough` marks
    numbers that the crank angles do not resolve. `nearest` is the crank angle, rad, (designs,) nearest to a limit
    position, or NaN; `kinked` marks the outputs, (outputs,), whose turn is split at kinks.
    """
    solution = unchecked_turn(scene, job.angles)
    checks.require("solve", *refusals(solution), *energy_contact.refusals(solution))
    made = math.prod(solution.shape[:-1])
    if made not in (1, count):
        raise ParameterError(
            f"the scene returned has designs of shape {solution.shape[:-1]}, not ({count},): arrays need the shape "
            "(designs, 1) of the given values"
        )
    if count == solution.shape[-1] > 1 and tables_over_angles(scene):  # ambiguous; the caller tries fewer designs
        raise ParameterError(f"an array of shape ({count},) is ambiguous: its axis may be designs or crank angles")
    kinked = np.array([has_kinks(solution, item.quantity, job.kink_tolerance) for item in outputs])
    smooth = [item for item, split in zip(outputs, kinked, strict=True) if not split]
    numbers, gaps = np.empty((len(smooth), made)), np.zeros(made, dtype=int)
    rough, nearest = np.zeros(numbers.shape, dtype=bool), np.full(made, np.nan)
    if job.engine == "compiled":
        _reduce_by_loop(solution, smooth, job.threads, numbers, rough, gaps, nearest)
    else:
        _reduce_by_numpy(solution, smooth, numbers, rough, gaps, nearest)
    reasons = np.full(made, "", dtype=object)
    for row in np.flatnonzero(gaps):
        where = f"at {gaps[row]} of {job.angles} crank angles"
        reasons[row] = f"{scene.mechanism.name} cannot be assembled {where}; change the lengths"
    if kinked.any():
        split = [item for item in outputs if item not in smooth]
        found = np.empty((2, len(outputs), made))
        found[:, ~kinked], found[:, kinked] = (numbers, rough), _split_turns(scene, job, split).estimated(split)
        numbers, rough = found[0], found[1] > 0
    for_all = (np.broadcast_to(part, (*part.shape[:-1], count)) for part in (numbers, reasons, rough, nearest))
    return *map(np.array, for_all), kinked


def _reduce_by_loop(solution, outputs, threads, *found):
    """Write the results of all designs, computed and reduced block by block by machine code."""
    state, names, count = solution.dynamics, quantity_names(outputs), found[0].shape[1]
    program, leaves = program_of(state, (*names, "closure"), sizes=True)
    angle = np.array(solution.crank_angle, ndmin=2)
    tables = numba_backend.row_table(program.rows(state, leaves), solution.shape)
    parameters = numba_backend.parameter_table(leaves.numbers, solution.shape[:-1])
    loop, tables = shared_work.shared_loop(program, leaves.numbers, angle, tables, count)
    given = angle, *numba_backend.compiled_sines(angle), parameters, tables
    first = np.cumsum([0, *program.recording.widths])
    rows = [first[names.index(item.quantity)] for item in outputs]
    reduce_block = CompiledReductions(outputs, rows, first[len(names)], round(solution.period / TURN))
    size = len(program.outputs), angle.shape[1]
    block = max(1, MAX_LOOP_VALUES // math.prod(size))
    step = max(block, -(-count // (PARTS_PER_THREAD * threads)))

    def fill(start):
        reduce_block(loop, given, numba_backend.aligned_memory(block, *size), found, start, min(start + step, count))

    starts = range(0, count, step)
    if threads == 1 or len(starts) == 1:
        for start in starts:
            fill(start)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, starts))


def _reduce_by_numpy(solution, outputs, numbers, rough, gaps, nearest):
    """Write the results by NumPy, all designs at once."""
    shape, turns = (gaps.size, solution.shape[-1]), round(solution.period / TURN)
    with np.errstate(all="ignore"):
        values = {name: np.reshape(component_sizes(solution, name)[0], shape) for name in quantity_names(outputs)}
        for row, item in enumerate(outputs):
            numbers[row], rough[row] = item.estimated(values[item.quantity], turns)
        closure = np.reshape(solution.closure, (-1, *shape))
        margin = closure.min(axis=-1)
        gaping = ~(margin >= -SQUARE_TOLERANCE).all(axis=0)
        gaps[gaping] = (~(closure[:, gaping] >= -SQUARE_TOLERANCE)).any(axis=0).sum(axis=-1)
        near = ~gaping & (margin < NEAR).any(axis=0)
        if near.any():
            nearest[near] = solution.crank_angle[closure[:, near].min(axis=0).argmin(axis=-1)]


def _split_turns(scene, job, outputs):
    return PiecewiseTurns.of(scene, outputs, job.angles, job.kink_tolerance, job.engine)


MAX_PROBED_DESIGNS = 64
"""Largest number of designs that a dry run tries."""
MIN_ANGLES = 12
"""Smallest number of crank angles of a sweep."""
MIN_ANGLES_PER_TURN = 180
"""Smallest number of crank angles in a turn: with fewer, doubling them may agree although both are wrong."""


@dataclass(frozen=True)
class Job:
    """Instructions for a chunk of designs, sent to the workers.

    Attributes
    ----------
    make, make_reference : function
        From values in SI by name to a `Scene`, or an object with a scene; None for the reference without ratios.
    columns : tuple of (column, name, factor)
        Columns of the parameters in the table of designs.
    outputs, numbers : tuple
        Outputs computed for all designs together, and numbers of the solution of each design alone.
    order : tuple of int
        Columns of the table: places among the outputs followed by the numbers.
    threads : int
        Cores for a chunk.
    streams : bool
        Whether one compiled loop computes all designs of a chunk without a table for each.
    kinked : bool
        Whether tables or friction cause kinks in an output, so that its turn may be split.
    kink_tolerance : float
        Change of slope of a table, relative to its largest value, above which the turn is split there.
    hints : tuple of HintWarning
        Implausible values of the design of the dry run, and load functions that change between their samples.
    resolution : str
        Sentence on the resolution of load functions without `kinks`; empty if there are none.
    """

    make: Callable[[dict], Any]
    make_reference: Callable[[dict], Any] | None
    columns: tuple[tuple[str, str, float], ...]
    outputs: tuple[Output, ...]
    numbers: tuple[SolutionNumber, ...]
    order: tuple[int, ...]
    angles: int
    engine: str
    threads: int
    streams: bool = False
    kinked: bool = False
    kink_tolerance: float = KINK_TOLERANCE
    hints: tuple[HintWarning, ...] = ()
    resolution: str = ""

    @property
    def ratios(self):
        """Indices of the outputs that are ratios to the reference."""
        return [place for place, item in enumerate(self.outputs) if item.ratio]

    @property
    def items(self):
        """All outputs, by rows of the results."""
        return *self.outputs, *self.numbers

    @property
    def sides(self):
        """Functions that make scenes, each with the outputs to compute."""
        own = [(self.make, self.outputs)]
        return [*own, (self.make_reference, [self.outputs[place] for place in self.ratios])] if self.ratios else own

    def given(self, frame):
        """Parameters of designs, (designs, columns), in SI."""
        rows = [frame[column].to_numpy(dtype=float) * scale for column, _, scale in self.columns]
        return np.reshape(rows, (len(rows), len(frame))).T

    def values(self, given):
        """Alternative arguments of the functions: arrays, and for a single design plain numbers."""
        names = (name for _, name, _ in self.columns)
        arrays = dict(zip(names, given.T.copy()[..., None], strict=True))  # a copy: functions may change it
        return [arrays] if len(given) > 1 else [arrays, {name: float(value[0, 0]) for name, value in arrays.items()}]


class _NoSceneError(ParameterError):
    """A function returns no scene."""


def dry_run(job, designs, engines):
    """The job with the first engine that supports the mechanism, and with units of outputs; None if no design is valid.

    Errors that concern every design are raised. `QuantityError`: the mechanism lacks a quantity. `ParameterError`: a
    function returns no scene, there are too few crank angles, or loads do not repeat after their period.
    `NotGivenError`: no engine supports the mechanism.
    """
    few = (
        None
        if job.angles >= MIN_ANGLES
        else f"angles must be at least {MIN_ANGLES}, got {job.angles}: they miss every peak"
    )
    checks.require("sweep", few)
    for row in range(len(designs)):
        *_, plain = job.values(job.given(designs.iloc[row : row + 1]))
        try:
            scenes = [scene_of(make, plain) for make, _ in job.sides]
        except _NoSceneError:
            raise
        except Exception:
            continue
        try:
            solutions = [unchecked_turn(scene, job.angles) for scene in scenes]
            pairs = list(zip(solutions, job.sides, strict=True))
            for solution, (_, outputs) in pairs:
                for name in quantity_names(outputs):
                    components(solution, name)
            problems = [repeating_problem(solution) for solution in solutions]
            missed = scenes[0].check_resolution().hints
            for item in job.numbers:
                item.value(scenes[0], scenes[-1])
        except QuantityError:
            raise
        except Exception:
            continue
        checks.require("sweep", *problems)
        hints = tuple(HintWarning(scenes[0].mechanism.name, text) for text in (*scene_hints(solutions[0]), *missed))
        outputs = tuple(item.of(scenes[0]) for item in job.outputs)
        engine, streams = _engine_of(pairs, engines)
        kinked = any(has_kinks(solution, item.quantity, 0.0) for solution, (_, wanted) in pairs for item in wanted)
        angles = max(job.angles, (START_ANGLES if kinked else MIN_ANGLES_PER_TURN) * round(scenes[0].period / TURN))
        found = {"kinked": kinked, "angles": angles, "hints": hints, "resolution": resolution_note(scenes[0])}
        return replace(job, engine=engine, outputs=outputs, streams=streams, **found)
    return None


def scene_of(make, values):
    """Scene that a function makes from values."""
    found = make(values)
    scene = getattr(found, "scene", found)
    if not isinstance(scene, Scene):
        raise _NoSceneError(f"sweep: the function must return a kinetostatics.Scene, got {checks.shown(found)}")
    return scene


def _engine_of(pairs, engines):
    """First engine that supports the mechanism, and whether its loop needs no tables.

    `pairs` are a solution and (maker, outputs) of the designs and of the reference.
    """
    if engines[0] == "numpy":
        return "numpy", False
    try:
        programs = [
            program_of(solution.dynamics, (*quantity_names(outputs), "closure"), sizes=True)[0]
            for solution, (_, outputs) in pairs
        ]
    except NotGivenError:
        if len(engines) == 1:
            raise
        return engines[1], False
    return "compiled", not any(program.recording.row_count for program in programs)


NEGLIGIBLE_SHARE = 1e-12
"""Share of the reference's number below which a design's number counts as zero, as in `comparison`."""
MAX_ANGLES = 5760
"""Largest number of crank angles, by doubling, for designs whose outputs are not resolved."""
ANGLES_TOLERANCE = 1e-3
"""Negligible relative change of an output when even crank angles are doubled."""
KINK_REFINEMENT = 16
"""Factor by which `kink_tolerance` falls when the crank angles are doubled."""
FAILED = "failed"
"""Name of the column with the reason why a design has no numbers."""


def run_chunk(job, frame) -> pd.DataFrame:
    """Outputs of some designs, with the reason for those that have none."""
    count = len(job.outputs)
    numbers, reasons = np.empty((len(job.items), len(frame))), np.empty(len(frame), dtype=object)
    step = max(1, BLOCK_VALUES // job.angles if job.engine == "numpy" else len(frame))
    step = min(step, MAX_SPLIT_DESIGNS) if job.kinked else step
    given = job.given(frame)
    for start in range(0, len(frame), step):
        part = slice(start, start + step)
        (numbers[:count, part], reasons[part]), *reference = (
            _compute_designs(make, job, given[part], outputs) for make, outputs in job.sides
        )
        for above, failing in reference:
            numbers[job.ratios, part] = _ratios(above, numbers[job.ratios, part])
            reasons[part] = np.where((reasons[part] == "") & (failing != ""), "reference: " + failing, reasons[part])
    if job.numbers:
        for row in np.flatnonzero(reasons == ""):
            numbers[count:, row], reasons[row] = _solution_numbers(job, given[row : row + 1])
    for row in np.flatnonzero(np.isnan(numbers).any(axis=0) & (reasons == "")):
        wrong = (str(item) for item, number in zip(job.items, numbers[:, row], strict=True) if np.isnan(number))
        reasons[row] = f"{', '.join(wrong)} is not a number, as for 0 / 0"
    return result_table(job, frame, numbers, reasons)


def _solution_numbers(job, given):
    """Numbers (numbers,) of the solution of one design, and the reason if it has none."""
    *_, plain = job.values(given)
    try:
        scene = scene_of(job.make, plain)
        reference = job.make_reference and scene_of(job.make_reference, plain)
        return [item.value(scene, reference) for item in job.numbers], ""
    except (MissingLibraryError, OSError):
        raise
    except Exception as error:
        return np.nan, str(error) or type(error).__name__


def _ratios(above, below):
    """Numbers of the reference over those of designs; infinite where these count as zero, NaN for 0/0 and inf/inf."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios = np.where(abs(below) <= NEGLIGIBLE_SHARE * abs(above), np.inf, above / below)
    return np.where(((above == 0) & (below == 0)) | (np.isinf(above) & np.isinf(below)), np.nan, ratios)


def result_table(job, frame, numbers, reasons):
    """Table of all outputs (outputs, designs) and reasons; NaN where there is a reason."""
    failing = reasons != ""
    numbers[:, failing] = np.nan
    found = {job.items[place].column: numbers[place] for place in job.order}
    texts = reasons if failing.any() else ""  # one text for all takes a third of the time
    return pd.DataFrame({**found, FAILED: pd.Series(texts, frame.index, dtype=str)}, index=frame.index)


# Designs that fail are separated


def _compute_designs(make, job, given, outputs, earlier=None, refused=False):
    """Numbers (outputs, designs) and reasons (designs,) why a scene cannot be made or solved, if there are outputs.

    A single design is an array of one, so that results do not depend on the batch. `earlier` are the numbers from half
    as many crank angles; `refused` means that arrays of a single design fail.
    """
    count, scene = len(given), None
    if not outputs:
        return np.empty((0, count)), np.full(count, "", dtype=object)
    for values in job.values(given)[refused:]:
        try:
            scene = scene_of(make, values)
            return _refine_angles(make, job, given, outputs, compute_batch(scene, job, count, outputs), earlier)
        except (MissingLibraryError, OSError):
            raise
        except Exception as caught:
            error = caught
    if count == 1:
        return np.full((len(outputs), 1), np.nan), np.array([str(error) or type(error).__name__], dtype=object)
    wrong = _designs_at_fault(error, count)
    if wrong is None and scene is not None:
        parts = np.array_split(np.arange(count), 2)
    else:
        wrong = _find_unbuildable(make, job, given) if wrong is None else wrong
        alone = np.flatnonzero(wrong if wrong.any() else ~wrong)  # if all fail as arrays, each is computed separately
        parts = [np.delete(np.arange(count), alone), *alone[:, None]]
    numbers, reasons = np.empty((len(outputs), count)), np.empty(count, dtype=object)
    for part in parts:
        if part.size:
            known = None if earlier is None else earlier[:, part]
            refused = part.size == 1 and wrong is not None and bool(wrong[part[0]])
            numbers[:, part], reasons[part] = _compute_designs(make, job, given[part], outputs, known, refused)
    return numbers, reasons


def _refine_angles(make, job, given, outputs, found, earlier):
    """Numbers and reasons; designs that the crank angles do not resolve are computed with twice as many."""
    numbers, reasons, rough, nearest, kinked = found
    near = np.flatnonzero(~np.isnan(nearest) & (reasons == ""))
    narrow = np.zeros(len(given), dtype=bool)
    if near.size:
        reasons[near], narrow[near] = _check_near_limits(make, job, given[near], nearest[near], outputs)
    if earlier is not None:  # agreement proves nothing for split turns: their pieces stay the same
        with np.errstate(invalid="ignore"):
            rough &= kinked[:, None] | (abs(numbers - earlier) > ANGLES_TOLERANCE * abs(numbers))
    rough &= (reasons == "") & ~narrow
    if rough.any():
        rough &= ~_noise_by_design(make, job, given, outputs, rough)
    again = np.flatnonzero(rough.any(axis=0) | (narrow & (reasons == "")))
    if again.size and (earlier is None or 2 * job.angles <= MAX_ANGLES):
        finer = replace(job, angles=2 * job.angles, kink_tolerance=job.kink_tolerance / KINK_REFINEMENT)
        step = MAX_SPLIT_DESIGNS if job.kinked else again.size
        for start in range(0, again.size, step):
            some = again[start : start + step]
            numbers[:, some], reasons[some] = _compute_designs(make, finer, given[some], outputs, numbers[:, some])
    else:
        for row in again:
            wrong = [str(item) for item, wrong in zip(outputs, rough[:, row], strict=True) if wrong or narrow[row]]
            reasons[row] = f"{', '.join(wrong)} is not resolved by {job.angles} crank angles" + (
                f": it passes close to a limit position at {np.degrees(nearest[row]):.6g} deg"
                if narrow[row]
                else "; if a load jumps, let it rise over a degree"
            )
    return numbers, reasons


def _noise_by_design(make, job, given, outputs, asked):
    """Mask (outputs, designs) of the outputs that are constant over the turn to rounding."""
    found, designs = np.zeros(asked.shape, dtype=bool), np.flatnonzero(asked.any(axis=0))
    wanted = {row: outputs[row] for row in np.flatnonzero(asked.any(axis=1))}
    for start in range(0, designs.size, MAX_SPLIT_DESIGNS):
        some = designs[start : start + MAX_SPLIT_DESIGNS]
        scene = scene_of(make, job.values(given[some])[-1])
        turns, solution = _split_turns(scene, job, wanted.values()), unchecked_turn(scene, job.angles)
        pieces = turns.pieces
        with np.errstate(all="ignore"):
            values = turns.values(quantity_names(wanted.values()), pieces.owner, pieces.angle)
            for row, item in wanted.items():
                own = values[item.quantity]
                low, high = -pieces.largest_of(-own.min(axis=1)), pieces.largest_of(own.max(axis=1))
                size = np.maximum(largest_term(solution, item.quantity), np.maximum(-low, high))
                found[row, some] = np.ravel(high - low <= FLOOR * size)
    return found


def _check_near_limits(make, job, given, nearest, outputs):
    """Reasons of designs that do not close or lose all digits between crank angles, and whether peaks may be there.

    Each design is computed again around the crank angle nearest to a limit position.
    """
    scene = scene_of(make, job.values(given)[-1])
    step = scene.period / job.angles
    angle = nearest[:, None] + step * np.linspace(-1.5, 1.5, 25)
    around = np.broadcast_arrays(*unchecked_turn(scene, angle).closure)
    margin, place, bend = lowest(np.array(around).min(axis=0), step / 8)
    place = np.round(angle[:, 12] + place, 9) % scene.period
    reasons = np.full(len(given), "", dtype=object)
    for row in np.flatnonzero(margin < -SQUARE_TOLERANCE):
        where = f"between the crank angles, at {np.degrees(place[row]):.6g} deg"
        reasons[row] = f"{scene.mechanism.name} cannot be assembled {where}; change the lengths"
    if all(quantity(scene, item.quantity).unit == "m" for item in outputs):
        return reasons, np.zeros(len(given), dtype=bool)
    with np.errstate(all="ignore"):
        lost = unchecked_turn(scene, np.column_stack([place, angle])).condition.max(axis=-1) >= NO_DIGITS_CONDITION
        narrow = step > np.sqrt(2.0 * np.maximum(margin, 0.0) / bend)
    for row in np.flatnonzero(np.ravel(lost) & (reasons == "")):
        reasons[row] = f"has no correct digit at crank angle {np.degrees(place[row]):.6g} deg, a limit position"
    return reasons, narrow


def _designs_at_fault(error, count):
    """Mask of the designs that an error names; None if it names no design."""
    wrong: Any = getattr(error, "designs", None)
    return np.ravel(wrong) if np.size(wrong) == count and np.any(wrong) else None


def _find_unbuildable(make, job, given):
    """Mask of the designs that cannot be made, by bisection."""
    for values in job.values(given):
        try:
            make(values)
        except Exception:
            continue
        return np.zeros(len(given), dtype=bool)
    if len(given) == 1:
        return np.ones(1, dtype=bool)
    halves = np.array_split(np.arange(len(given)), 2)
    return np.concatenate([_find_unbuildable(make, job, given[half]) for half in halves])
