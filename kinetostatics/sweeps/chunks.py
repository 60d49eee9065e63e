"""What a worker of a sweep does: a chunk of designs built as one batch, and reduced to a row of numbers for each.

Designs that cannot be built are set apart, each with its reason, and the others go on together.
"""

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from ..errors import MissingLibraryError
from ..mechanics.assembly import NO_DIGIT
from ..mechanics.quantities import quantity
from ..numbers.arithmetic import ROUNDING
from ..results.peaks import lowest
from . import together
from .job import scene_of

NEGLIGIBLE = 1e-12
"""Share of the reference's number below which a design's counts as zero, as in `comparison`."""
MOST = 5760
"""Crank angles up to which their number is doubled for designs of which fewer do not tell the outputs."""
SETTLED = 1e-3
"""Relative change of an output of even crank angles, when these are doubled, that is none."""
CLOSER = 16
"""By how much closer tables are followed when the crank angles are doubled."""
FAILED = "failed"
"""Column with the reason why a design has no numbers; empty for the others."""


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
        scene = scene_of(make, values)
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
            return _settled(make, job, given, outputs, together.run(scene_of(make, values), job, 1, outputs), earlier)
        except (MissingLibraryError, OSError):
            raise
        except Exception as error:
            reason = str(error) or type(error).__name__
    return np.full((len(outputs), 1), np.nan), np.array([reason], dtype=object)


def _settled(make, job, given, outputs, found, earlier):
    """Numbers and reasons, those of designs that so many crank angles do not tell from twice as many."""
    numbers, reasons, rough, nearest, parted = found
    numbers, reasons, rough = np.array(numbers), np.array(reasons), np.array(rough)
    near = np.flatnonzero(~np.isnan(nearest) & (reasons == ""))
    narrow = np.zeros(len(given), dtype=bool)
    if near.size:
        reasons[near], narrow[near] = _near_limits(make, job, given[near], nearest[near], outputs)
    if earlier is not None:  # pieces end up the same from twice as many, so that these agree says nothing
        with np.errstate(invalid="ignore"):
            rough &= parted[:, None] | (abs(numbers - earlier) > SETTLED * abs(numbers))
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
        scene = scene_of(make, job.values(given[some])[-1])
        found[np.ix_(rows, some)] = together.noise(scene, job, wanted)
    return found


def _near_limits(make, job, given, nearest, outputs):
    """Reasons of designs that do not close, or lose all digits, between crank angles, and whether peaks hide there.

    Looked at anew around the crank angle at which each is nearest to a limit position.
    """
    scene = scene_of(make, job.values(given)[-1])
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
