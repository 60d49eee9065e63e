"""What a worker of a sweep does: a chunk of designs built as one batch, and reduced to a row of numbers for each.

Designs that cannot be built are set apart, each with its reason, and the others go on together.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from ..engines import programs
from ..errors import HintWarning, MissingLibraryError, NotGivenError, ParameterError, QuantityError
from ..machine.loads import STRAIGHT, TURN
from ..mechanics.assembly import NO_DIGIT
from ..mechanics.quantities import components, quantity
from ..numbers import checks
from ..numbers.elementary import ROUNDING
from ..results.bends import bent
from ..results.peaks import lowest
from ..results.reductions import Output
from ..results.turn import repeating_problem
from ..solution.scene import Scene, odd
from . import together

NEGLIGIBLE = 1e-12
"""Share of the reference's number below which a design's counts as zero, as in `comparison`."""
FEWEST = 12
"""Crank angles below which a sweep is refused."""
LEAST = 180
"""Crank angles a turn that are taken at least: fewer may agree with twice as many, and both be wrong."""
PARTED = 192
"""The same where tables or friction act: so many tell most outputs of a turn that is parted."""
MOST = 5760
"""Crank angles up to which their number is doubled for designs of which fewer do not tell the outputs."""
SETTLED = 1e-3
"""Relative change of an output, when the crank angles are doubled, that is none."""
CLOSER = 16
"""By how much closer tables are followed when the crank angles are doubled."""
FAILED = "failed"
"""Column with the reason why a design has no numbers; empty for the others."""


@dataclass(frozen=True)
class Job:
    """What to do with a chunk of designs; goes to the workers.

    Attributes
    ----------
    make, make_reference : function
        From values in SI by name to a `Scene`, or what has one; the reference's is None without ratios.
    columns : tuple of (column, name, factor)
        Where the values stand in the table of designs.
    threads : int
        Cores to use for a chunk.
    wide : bool
        Whether a compiled loop takes all designs of a chunk, and no table for each of them.
    bent : bool
        Whether tables or friction act on an output, so that its turn may be parted.
    straight : float
        Share of its largest value by which a table bends where the turn is parted.
    hints : tuple of HintWarning
        What looks like a slip in the design that was tried.
    """

    make: Callable[[dict], Any]
    make_reference: Callable[[dict], Any] | None
    columns: tuple[tuple[str, str, float], ...]
    outputs: tuple[Output, ...]
    angles: int
    engine: str
    threads: int
    wide: bool = False
    bent: bool = False
    straight: float = STRAIGHT
    hints: tuple[HintWarning, ...] = ()

    @property
    def ratios(self):
        """Places of the outputs that are ratios to the reference."""
        return [place for place, item in enumerate(self.outputs) if item.ratio]

    @property
    def sides(self):
        """Functions that make scenes, each with the outputs wanted of what it makes."""
        own = [(self.make, self.outputs)]
        return [*own, (self.make_reference, [self.outputs[place] for place in self.ratios])] if self.ratios else own

    def given(self, frame):
        """Numbers (designs, columns) of designs, in SI."""
        rows = [frame[column].to_numpy(dtype=float) * scale for column, _, scale in self.columns]
        return np.reshape(rows, (len(rows), len(frame))).T

    def values(self, given):
        """What to call the functions with for some designs, in turn: arrays, and plain numbers for a single design."""
        names = (name for _, name, _ in self.columns)
        arrays = dict(zip(names, given.T.copy()[..., None], strict=True))  # which the functions may change
        return [arrays] if len(given) > 1 else [arrays, {name: float(value[0, 0]) for name, value in arrays.items()}]


def run_chunk(job, frame) -> pd.DataFrame:
    """Outputs of some designs, with the reason for those that have none."""
    numbers, reasons = np.empty((len(job.outputs), len(frame))), np.empty(len(frame), dtype=object)
    step = max(1, together.VALUES // job.angles if job.engine == "numpy" else len(frame))
    step = min(step, together.DESIGNS) if job.bent else step
    given = job.given(frame)
    for start in range(0, len(frame), step):
        part = slice(start, start + step)
        numbers[:, part], reasons[part] = _compared(job, given[part])
    return rows(job, frame, numbers, reasons)


def rows(job, frame, numbers, reasons):
    """Table of outputs (outputs, designs) and reasons; no numbers where there is a reason."""
    failing = reasons != ""
    numbers[:, failing] = np.nan
    found = {item.column: row for item, row in zip(job.outputs, numbers, strict=True)}
    told = reasons if failing.any() else ""  # one text for all takes a third of the time
    return pd.DataFrame({**found, FAILED: pd.Series(told, frame.index, dtype=str)}, index=frame.index)


def tried(job, designs, engines):
    """The job with the first of the engines that takes the mechanism, and units of its outputs.

    Tried on the first design that can be built; None if none can. Raises what would otherwise be the reason of every
    design: `QuantityError` for a quantity that the mechanism does not have, `ParameterError` for a function that makes
    something else than a scene, `NotGivenError` if no engine takes it. The same for fewer crank angles than tell
    anything, and loads that do not repeat after their period.
    """
    few = None if job.angles >= FEWEST else f"angles must be at least {FEWEST}, got {job.angles}: they miss every peak"
    checks.require("sweep", few)
    for row in range(len(designs)):
        *_, plain = job.values(job.given(designs.iloc[row : row + 1]))
        try:
            scenes = [_scene(make, plain) for make, _ in job.sides]
        except _NoSceneError:
            raise
        except Exception:
            continue
        try:
            solutions = [together.solution_of(scene, job.angles) for scene in scenes]
            pairs = list(zip(solutions, job.sides, strict=True))
            for solution, (_, outputs) in pairs:
                for name in together.quantities(outputs):
                    components(solution, name)
            problems = [repeating_problem(solution) for solution in solutions]
        except QuantityError:
            raise
        except Exception:
            continue
        checks.require("sweep", *problems)
        hints = tuple(HintWarning(scenes[0].mechanism.name, text) for text in odd(solutions[0]))
        outputs = tuple(item.of(scenes[0]) for item in job.outputs)
        engine = _engine(job, solutions, engines)
        wide = engine == "compiled" and not any(program.recording.rows for program in _programs(job, solutions))
        parted = any(bent(solution, item.quantity, 0.0) for solution, (_, wanted) in pairs for item in wanted)
        angles = max(job.angles, (PARTED if parted else LEAST) * round(scenes[0].period / TURN))
        return replace(job, engine=engine, outputs=outputs, wide=wide, bent=parted, angles=angles, hints=hints)
    return None


class _NoSceneError(ParameterError):
    """A function makes something else than a scene."""


def _scene(make, values):
    """What a function makes of values, if it is a scene or has one."""
    found = make(values)
    scene = getattr(found, "scene", found)
    if not isinstance(scene, Scene):
        raise _NoSceneError(f"sweep: the function must return a kinetostatics.Scene, got {checks.shown(found)}")
    return scene


def _engine(job, solutions, engines):
    first, *others = engines
    if first == "numpy":
        return first
    try:
        _programs(job, solutions)
    except NotGivenError:
        if not others:
            raise
        return _engine(job, solutions, others)
    return first


def _programs(job, solutions):
    """What a compiled loop of each side computes."""
    return [
        programs.of(solution.dynamics, (*together.quantities(outputs), "closure"), sizes=True)[0]
        for solution, (_, outputs) in zip(solutions, job.sides, strict=True)
    ]


# Designs set apart


def _compared(job, given):
    """Numbers (outputs, designs), ratios among them, and reasons (designs,), empty for designs that have numbers."""
    (own, reasons), *reference = (_reduced(make, job, given, outputs) for make, outputs in job.sides)
    numbers, reasons = np.array(own), np.array(reasons)
    for above, failing in reference:
        below = numbers[job.ratios]
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = np.where(abs(below) <= NEGLIGIBLE * abs(above), np.inf, above / below)
        unknown = ((above == 0) & (below == 0)) | (np.isinf(above) & np.isinf(below))
        numbers[job.ratios] = np.where(unknown, np.nan, ratios)
        reasons = np.where((reasons == "") & (failing != ""), "reference: " + failing, reasons)
    for row in np.flatnonzero(np.isnan(numbers).any(axis=0) & (reasons == "")):
        wrong = (str(item) for item, number in zip(job.outputs, numbers[:, row], strict=True) if np.isnan(number))
        reasons[row] = f"{', '.join(wrong)} is no number, such as 0 / 0"
    return numbers, reasons


def _reduced(make, job, given, outputs, earlier=None, wrong=False):
    """Numbers of a scene (outputs, designs) and reasons (designs,) why it cannot be made or solved.

    `earlier` are the numbers from half as many crank angles; `wrong` tells that arrays of a single design are refused.
    """
    count = len(given)
    if count == 1:
        return _alone(make, job, given, outputs, earlier, wrong)
    (values,) = job.values(given)
    try:
        scene = _scene(make, values)
    except Exception as error:
        wrong = _told(error, count)
        if wrong is None:
            wrong = _unbuildable(make, job, given)
        apart = np.flatnonzero(wrong if wrong.any() else ~wrong)  # all that can be built by themselves only
        parts = [np.delete(np.arange(count), apart), *apart[:, None]]
    else:
        try:
            return _settled(make, job, given, outputs, together.run(scene, job, count, outputs), earlier)
        except (MissingLibraryError, OSError):
            raise
        except Exception as error:
            wrong = _told(error, count)
            halves = np.array_split(np.arange(count), 2)
            parts = halves if wrong is None else [np.flatnonzero(~wrong), *np.flatnonzero(wrong)[:, None]]
    numbers, reasons = np.empty((len(outputs), count)), np.empty(count, dtype=object)
    for part in parts:
        if part.size:
            known = None if earlier is None else earlier[:, part]
            refused = part.size == 1 and wrong is not None and bool(wrong[part[0]])
            numbers[:, part], reasons[part] = _reduced(make, job, given[part], outputs, known, refused)
    return numbers, reasons


def _alone(make, job, given, outputs, earlier, wrong):
    """The same for a single design, as an array of one, so that it does not matter which designs come together."""
    for values in job.values(given)[wrong:]:
        try:
            return _settled(make, job, given, outputs, together.run(_scene(make, values), job, 1, outputs), earlier)
        except (MissingLibraryError, OSError):
            raise
        except Exception as error:
            reason = str(error) or type(error).__name__
    return np.full((len(outputs), 1), np.nan), np.array([reason], dtype=object)


def _settled(make, job, given, outputs, found, earlier):
    """Numbers and reasons, those of designs that so many crank angles do not tell from twice as many."""
    numbers, reasons, rough, nearest = found
    numbers, reasons, rough = np.array(numbers), np.array(reasons), np.array(rough)
    near = np.flatnonzero(~np.isnan(nearest) & (reasons == ""))
    narrow = np.zeros(len(given), dtype=bool)
    if near.size:
        reasons[near], narrow[near] = _near_limits(make, job, given[near], nearest[near], outputs)
    if earlier is not None:
        with np.errstate(invalid="ignore"):
            rough &= abs(numbers - earlier) > SETTLED * abs(numbers)
    rough &= (reasons == "") & ~narrow
    if rough.any():
        rough &= ~_noise(make, job, given, outputs, rough)
    again = np.flatnonzero(rough.any(axis=0) | (narrow & (reasons == "")))
    if again.size and (earlier is None or 2 * job.angles <= MOST):
        finer = replace(job, angles=2 * job.angles, straight=job.straight / CLOSER)
        step = together.DESIGNS if job.bent else again.size
        for start in range(0, again.size, step):
            some = again[start : start + step]
            numbers[:, some], reasons[some] = _reduced(make, finer, given[some], outputs, numbers[:, some])
    else:
        for row in again:
            wrong = [str(item) for item, wrong in zip(outputs, rough[:, row], strict=True) if wrong or narrow[row]]
            reasons[row] = f"{', '.join(wrong)} is not resolved by {job.angles} crank angles" + (
                f": it passes so near a limit position at {np.degrees(nearest[row]):.6g} deg"
                if narrow[row]
                else "; if a load jumps, let it rise over a degree"
            )
    return numbers, reasons


def _noise(make, job, given, outputs, asked):
    """Which outputs (outputs, designs) of those asked for are of what changes by rounding of its terms only."""
    found = np.zeros(asked.shape, dtype=bool)
    rows, designs = np.flatnonzero(asked.any(axis=1)), np.flatnonzero(asked.any(axis=0))
    wanted = [outputs[row] for row in rows]
    for start in range(0, designs.size, together.DESIGNS):
        some = designs[start : start + together.DESIGNS]
        scene = _scene(make, job.values(given[some])[-1])
        found[np.ix_(rows, some)] = together.noise(scene, job, wanted)
    return found


def _near_limits(make, job, given, nearest, outputs):
    """Reasons of designs that do not close, or lose all digits, between crank angles, and whether peaks hide there.

    Looked at anew around the crank angle at which each is nearest to a limit position.
    """
    scene = _scene(make, job.values(given)[-1])
    step = scene.period / job.angles
    angle = nearest[:, None] + step * np.linspace(-1.5, 1.5, 25)
    around = np.broadcast_arrays(*together.solution_of(scene, angle).closure)
    margin, place, bend = lowest(np.array(around).min(axis=0), step / 8)
    place = np.round(angle[:, 12] + place, 9) % scene.period
    reasons = np.full(len(given), "", dtype=object)
    for row in np.flatnonzero(margin < -ROUNDING):
        where = f"between the crank angles, at {np.degrees(place[row]):.6g} deg"
        reasons[row] = f"{scene.mechanism.name} cannot be assembled {where}; change the lengths"
    if all(quantity(scene, item.quantity).unit == "m" for item in outputs):
        return reasons, np.zeros(len(given), dtype=bool)
    with np.errstate(all="ignore"):
        lost = together.solution_of(scene, np.column_stack([place, angle])).condition.max(axis=-1) >= NO_DIGIT
        narrow = step > np.sqrt(2.0 * np.maximum(margin, 0.0) / bend)
    for row in np.flatnonzero(np.ravel(lost) & (reasons == "")):
        reasons[row] = f"has no correct digit at crank angle {np.degrees(place[row]):.6g} deg, a limit position"
    return reasons, narrow


def _told(error, count):
    """Which designs an error is about, as a mask; None if it does not tell."""
    wrong: Any = getattr(error, "designs", None)
    return np.ravel(wrong) if np.size(wrong) == count and np.any(wrong) else None


def _unbuildable(make, job, given):
    """Which designs cannot be made, found by halves."""
    for values in job.values(given):
        try:
            make(values)
        except Exception:
            continue
        return np.zeros(len(given), dtype=bool)
    if len(given) == 1:
        return np.ones(1, dtype=bool)
    halves = np.array_split(np.arange(len(given)), 2)
    return np.concatenate([_unbuildable(make, job, given[half]) for half in halves])
