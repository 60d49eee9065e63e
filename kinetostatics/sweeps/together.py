"""Designs of a chunk computed together, as one batch, and reduced to a row of numbers for each.

The loop over designs and crank angles runs block by block, so that values over the turn never leave the cache.
"""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ..engines import numba_backend, shared_work
from ..engines.program import program_of
from ..errors import ParameterError
from ..machine.loads import TURN, refusals
from ..mechanics import energy_contact
from ..mechanics.quantities import scale, sizes
from ..numbers import checks
from ..numbers.arithmetic import ROUNDING
from ..results.bends import bent
from ..results.passes import Passes
from ..results.rounding import FLOOR
from ..results.turn import NEAR
from ..solution.drive_and_loads import over_the_angles
from ..solution.parted import VALUES, Parted, quantities, solution_of

DESIGNS = 128
"""Designs whose turns are parted at a time: so many that the calls count little, and memory is no concern."""
BLOCK = 40_000
"""Values of all quantities over designs and angles that a compiled loop leaves at a time: a third of a core's cache."""
SHARES = 8
"""Parts of a chunk that each thread gets, so that none waits long for another."""


def run(scene, job, count, outputs):
    """Numbers (outputs, designs), reasons (designs,) of those that do not close, and what must be looked at again.

    That is which numbers so many crank angles do not tell (outputs, designs); the crank angle at which a design is
    nearest to a limit position (designs,), NaN if it is not near; and of which outputs the turn is parted (outputs,).
    """
    solution = solution_of(scene, job.angles)
    checks.require("solve", *refusals(solution), *energy_contact.refusals(solution))
    made = math.prod(solution.shape[:-1])
    if made not in (1, count):
        raise ParameterError(
            f"the scene made has designs of shape {solution.shape[:-1]}, not ({count},): arrays must have the shape "
            "(designs, 1) of the values handed in"
        )
    if count == solution.shape[-1] > 1 and over_the_angles(scene):  # fewer designs at a time tell which of both it is
        raise ParameterError(f"an array of shape ({count},) may be of so many designs, or of so many crank angles")
    parted = np.array([bent(solution, item.quantity, job.straight) for item in outputs])
    even = [item for item, apart in zip(outputs, parted, strict=True) if not apart]
    numbers, gaps = np.empty((len(even), made)), np.zeros(made, dtype=int)
    rough, nearest = np.zeros(numbers.shape, dtype=bool), np.full(made, np.nan)
    way = _by_loop if job.engine == "compiled" else _by_numpy
    fill, step = way(solution, even, made, (numbers, rough, gaps, nearest), job.threads)
    starts = range(0, made, step)
    if job.threads == 1 or len(starts) == 1:
        for start in starts:
            fill(start)
    else:
        with ThreadPoolExecutor(job.threads) as pool:
            list(pool.map(fill, starts))
    reasons = np.full(made, "", dtype=object)
    for row in np.flatnonzero(gaps):
        where = f"at {gaps[row]} of {job.angles} crank angles"
        reasons[row] = f"{scene.mechanism.name} cannot be assembled {where}; change the lengths"
    if parted.any():
        apart = [item for item in outputs if item not in even]
        found = np.empty((2, len(outputs), made))
        found[:, ~parted], found[:, parted] = (numbers, rough), _parted(scene, job, apart).estimated(apart)
        numbers, rough = found[0], found[1] > 0
    shape = len(outputs), count
    rough, nearest = np.broadcast_to(rough, shape), np.broadcast_to(nearest, count)
    return np.broadcast_to(numbers, shape), np.broadcast_to(reasons, count), rough, nearest, parted


def _by_loop(solution, outputs, count, found, threads):
    """Function that fills in what is found of some designs, from one on, and how many these are.

    Values are computed and reduced by machine code, block by block in the same memory.
    """
    state, names = solution.dynamics, quantities(outputs)
    program, leaves = program_of(state, (*names, "closure"), sizes=True)
    angle = np.array(solution.crank_angle, ndmin=2)
    tables = numba_backend.row_table(program.rows(state, leaves), solution.shape)
    parameters = numba_backend.parameter_table(leaves.numbers, solution.shape[:-1])
    loop, tables = shared_work.shared_loop(program, leaves.numbers, angle, tables, count)
    given = angle, *numba_backend.compiled_sines(angle), parameters, tables
    first = np.cumsum([0, *program.recording.widths])
    rows = [first[names.index(item.quantity)] for item in outputs]
    passes = Passes(outputs, rows, first[len(names)], round(solution.period / TURN))
    size = len(program.outputs), angle.shape[1]
    block = max(1, BLOCK // math.prod(size))
    step = max(block, -(-count // (SHARES * threads)))

    def fill(start):
        passes(loop, given, numba_backend.aligned_memory(block, *size), found, start, min(start + step, count))

    return fill, step


def _by_numpy(solution, outputs, count, found, threads):
    """The same by NumPy, all designs at a time."""
    numbers, rough, gaps, nearest = found
    with np.errstate(all="ignore"):
        values = {
            name: np.reshape(parts, (len(parts), count, solution.shape[-1]))
            for name in (*quantities(outputs), "closure")
            for parts in [sizes(solution, name)]
        }
    turns = round(solution.period / TURN)
    step = max(1, VALUES // solution.shape[-1])

    def fill(start):
        block = slice(start, start + step)
        with np.errstate(all="ignore"):
            for row, item in enumerate(outputs):
                numbers[row, block], rough[row, block] = item.estimated(values[item.quantity][0, block], turns)
            closure = values["closure"][:, block]
            margin = closure.min(axis=-1)
            gaping = ~(margin >= -ROUNDING).all(axis=0)
            gaps[block][gaping] = (~(closure[:, gaping] >= -ROUNDING)).any(axis=0).sum(axis=-1)
            near = ~gaping & (margin < NEAR).any(axis=0)
            if near.any():
                nearest[block][near] = solution.crank_angle[closure[:, near].min(axis=0).argmin(axis=-1)]

    return fill, step


def _parted(scene, job, outputs):
    return Parted.of(scene, outputs, job.angles, job.straight, job.engine)


def noise(scene, job, outputs):
    """Whether outputs are of what changes over the turn by rounding of its terms only: (outputs, designs or 1)."""
    solution = solution_of(scene, job.angles)
    if any(bent(solution, item.quantity, job.straight) for item in outputs):
        solution = solution_of(scene, _parted(scene, job, outputs).pieces.angle)
    with np.errstate(all="ignore"):
        found = [_is_noise(solution, item.quantity) for item in outputs]
    return np.array(found)


def _is_noise(solution, name):
    values = sizes(solution, name)[0]
    size = np.maximum(scale(solution, name), np.abs(values).max(axis=-1))
    return np.ravel(np.ptp(values, axis=-1) <= FLOOR * size)
