"""Crank angles over the period where loads, friction and laws of cams have kinks or jumps, of one design or of many.

Friction has them where a rate or a force changes its sign; `sign_changes` finds these. Load functions that declare no
kinks are sampled at the resolution of their scene (`FunctionSamples`); what is narrower may be missed.
"""

import math
import warnings
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import HintWarning
from ..machine.loads import (
    KINK_TOLERANCE,
    TURN,
    has_no_user_code,
    has_significant_kinks,
    kink_sources,
    kinks_of,
    pad_rows,
    period_on,
    significant_kinks,
)
from ..mechanics.load_values import title_of, user_value
from ..mechanics.quantities import quantity
from ..numbers import checks
from ..numbers.brackets import find_roots

LOAD_FREE_KINDS = ("slider", "motion", "rate")
"""Kinds of quantities that do not depend on loads."""
SAMPLES = 720
"""Crank angles of a turn between which a rate or force of friction is expected to change its sign once."""
SAMPLE_OFFSET = 1e-3
"""Crank angle of the first sample, rad: no sample stands at a dead centre."""
MAX_VERTEX = 0.1
"""Height of a parabola's vertex, relative to its second difference, below which the vertex is evaluated too."""
ANGLE_TOLERANCE = 1e-9
"""Crank angles nearer than this, rad, count as one."""
FUNCTION_STEP = math.radians(0.05)
"""Default step of crank angles, rad, at which load functions without declared kinks are sampled."""
MIN_FUNCTION_STEP, MAX_FUNCTION_STEP = 1e-5, math.radians(0.25)
"""Limits of the step, rad: memory, and the widest pulse that may be missed."""
ROUGHNESS = 1e-5
"""Fourth difference, relative to the largest value, of a function that is not smooth: by default of a 64th harmonic."""
BLOCK_VALUES = 2**20
"""Values of such functions that are computed at a time."""
SECTION_ANGLES, SECTIONS = 33, 9
"""Crank angles that section an interval with a jump, and how often they do, to its last digits."""
JUMP_TOLERANCE = 1e-6
"""Change of a function in the last section, relative to its largest value, above which it jumps."""
MAX_SHOWN_FEATURES = 3
"""Missed features of a load in texts."""


def undeclared_functions(loads):
    """Loads that are functions without kinks, a list: pulses narrower than the resolution may be missed."""
    return [item for item in loads if not has_no_user_code(item) and not kink_sources([item])]


def function_step(owner, name, value, largest=MAX_FUNCTION_STEP):
    """Checked step of crank angles at which load functions are sampled, rad."""
    step, problem = checks.single_number(name, value, "rad")
    if not problem and not MIN_FUNCTION_STEP <= step <= largest:
        problem = (
            f"{name} must lie between {MIN_FUNCTION_STEP:g} and {largest:.4g} rad ({_degrees(largest)} deg), got "
            f"{step:.4g} rad ({_degrees(step)} deg); for degrees give np.radians(...)"
        )
    checks.require(owner, problem)
    return float(step)


def resolution_note(scene, name=None):
    """Sentence on the resolution of load functions without kinks in a scene or solution; "" where none acts.

    With the `name` of a quantity "" too if it does not depend on loads.
    """
    titles = [title_of(item) for item in undeclared_functions(scene.loads)]
    if not titles or (isinstance(name, str) and quantity(scene, name).kind in LOAD_FREE_KINDS):
        return ""
    return (
        f"load functions without `kinks` ({', '.join(titles)}) are sampled every {_degrees(scene.resolution)} deg of "
        "the crank: what is narrower may be missed"
    )


def with_resolution(table, *scenes):
    """A pandas DataFrame with the `resolution_note` of scenes or solutions in its `attrs`, if there is one."""
    if notes := dict.fromkeys(filter(None, map(resolution_note, scenes))):
        table.attrs["resolution"] = "; ".join(notes)
    return table


def _degrees(angle):
    return f"{np.degrees(angle):.4g}"


def has_kinks(solution, name, tolerance=KINK_TOLERANCE):
    """Whether friction, a cam's law, or a load may put a kink above `tolerance` into a quantity."""
    if law_kinks(solution).size:
        return True
    kinked = any(has_significant_kinks(part, tolerance) for part in kink_sources(solution.loads))
    loads = kinked or undeclared_functions(solution.loads)
    return bool(solution.friction.acting or loads) and quantity(solution, name).kind not in LOAD_FREE_KINDS


def design_kinks(solution, tolerance=KINK_TOLERANCE):
    """Kinks of all designs of a solution, of loads those larger than `tolerance` times the load's largest value.

    Returns their crank angles (1 or designs, K), NaN where a design has fewer; which of them may be jumps, the same
    shape; and the largest kink left out, relative to its load's largest value.
    """
    law = law_kinks(solution)[None]
    sources, largest_left_out = [(law, np.isin(law, law_kinks(solution, jumps=True)))], 0.0
    if solution.friction.acting:
        rates = len(solution.dynamics.friction_solver.rates) if solution.dynamics.friction_signs else 0
        row, angle = _friction_sign_changes(solution, SAMPLES * round(solution.period / TURN))
        sources.append((angle, row < rates))
    for part in kink_sources(solution.loads):
        angles, jumps, left_out = significant_kinks(part, solution, tolerance)
        starts = _period_starts(part, solution)
        angles = (angles[..., None] + starts).reshape(len(angles), -1)
        sources.append((angles, np.repeat(jumps, starts.size)[None]))
        largest_left_out = max(largest_left_out, left_out)
    for function in samples_of_functions(solution):
        angles = function.rough_places
        sources.append((angles, np.zeros(angles.shape, dtype=bool)))
    designs = max(len(angles) for angles, _ in sources)
    rows = ([np.broadcast_to(part, (designs, part.shape[1])) for part in row] for row in zip(*sources, strict=True))
    angle, jumps = map(np.column_stack, rows)
    return angle, jumps, largest_left_out


def kinks_and_jumps(solution, samples):
    """Crank angles of all kinks, and of those that may be jumps, of one design over the period, rad, rising.

    The signs of friction are sampled at `samples` crank angles. A `HintWarning` tells where load functions without
    kinks change between their samples.
    """
    kinks, jumps = declared_kinks(solution)
    functions = samples_of_functions(solution)
    for function in functions:
        kinks = np.union1d(kinks, function.rough_places)
    for text in () if solution.silent else check_resolution(solution, functions, solution.resolution).hints:
        warnings.warn(HintWarning(solution.mechanism.name, text), stacklevel=3)
    if not solution.friction.acting:
        return kinks, jumps
    friction = _friction_sign_changes(solution, samples)[1].ravel()
    return np.union1d(kinks, friction), np.union1d(jumps, friction)


def declared_kinks(motion):
    """The same of loads and laws of cams alone, of a solution or a motion."""
    law = law_kinks(motion, jumps=True)
    sources = [(law, law)]
    for part in kink_sources(motion.loads):
        starts = _period_starts(part, motion)[:, None]
        kinks, jumps = kinks_of(part, motion)
        sources.append((np.ravel(np.concatenate([kinks, jumps]) + starts), np.ravel(jumps + starts)))
    return tuple(np.unique(_wrapped(np.concatenate(angles), motion.period)) for angles in zip(*sources, strict=True))


def _wrapped(angle, period):
    """Crank angles in [0, period); those within `ANGLE_TOLERANCE` below the period are 0 but for rounding."""
    angle = np.mod(angle, period)
    return np.where(angle > period - ANGLE_TOLERANCE, 0.0, angle)


class MissedFeatures(NamedTuple):
    """Features of a load function between its samples.

    Attributes
    ----------
    load, unit : str
        Name of the load and unit of its value.
    angle : array (K,)
        Crank angles, rad.
    size : array (K,)
        Values there, less those that the samples around let expect.
    """

    load: str
    unit: str
    angle: np.ndarray
    size: np.ndarray

    def __str__(self):
        every = zip(self.size, np.degrees(self.angle), strict=True)
        texts = [f"{size:.4g} {self.unit} at {angle:.7g} deg" for size, angle in every]
        more = f" and {len(texts) - MAX_SHOWN_FEATURES} more" if len(texts) > MAX_SHOWN_FEATURES else ""
        return ", ".join(texts[:MAX_SHOWN_FEATURES]) + more


@dataclass(frozen=True, eq=False)
class ResolutionCheck:
    """Features of load functions that the resolution of a scene misses; made by `Scene.check_resolution`.

    Its length is their number.

    Attributes
    ----------
    resolution : float
        Step of crank angles at which the scene samples load functions without kinks, rad.
    step : float
        Finer step of the check, rad.
    missed : tuple of MissedFeatures
        For each load with missed features its name (`load`), the `unit` of its value, the crank angles (`angle`, rad)
        and by how much the function differs there from what its samples let expect (`size`).

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> def knock(q):
    ...     return np.where(abs(np.degrees(q.crank_angle) - 100.525) < 0.01, -4e4, 0.0)
    >>> scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(2.0)), 30.0, loads=ks.ProcessForce(knock))
    >>> scene.check_resolution(np.radians(0.005))
    <ResolutionCheck every 0.005 deg: features narrower than 0.05 deg
      ProcessForce on 'slider': -4e+04 N at 100.5175 deg>
    """

    resolution: float
    step: float
    missed: tuple[MissedFeatures, ...]

    @property
    def hints(self):
        """A sentence on each load with missed features, and the remedy."""
        head = f"a load function without `kinks` changes between its samples every {_degrees(self.resolution)} deg"
        remedy = "declare its `kinks`, give a ks.Table, or a finer `resolution`"
        return tuple(f"{head}, {found.load}: {found}; {remedy}" for found in self.missed)

    def __len__(self):
        return sum(len(item.angle) for item in self.missed)

    def __repr__(self):
        found = f"{'' if self.missed else 'no '}features narrower than {_degrees(self.resolution)} deg"
        lines = [
            f"<ResolutionCheck every {_degrees(self.step)} deg: {found}",
            *(f"{item.load}: {item}" for item in self.missed),
        ]
        return "\n  ".join(lines) + ">"


def check_resolution(solution, functions, step):
    """`ResolutionCheck` of sampled load functions of a solution, at a finer step, rad."""
    missed = [function.missed(step) for function in functions]
    return ResolutionCheck(solution.resolution, step, tuple(found for found in missed if found.angle.size))


def samples_of_functions(solution):
    """`FunctionSamples` of the load functions without kinks, a list."""
    return [FunctionSamples.of(item, solution) for item in undeclared_functions(solution.loads)]


class FunctionSamples(NamedTuple):
    """A load function without kinks, sampled at the resolution of a solution over the period.

    Attributes
    ----------
    item, solution : the load, and the solution
    angle : array (N,)
        Even crank angles, rad.
    value, change : array (designs, N)
        Values, and sizes of their fourth differences.
    """

    item: Any
    solution: Any
    angle: np.ndarray
    value: np.ndarray
    change: np.ndarray

    @classmethod
    def of(cls, item, solution):
        angle = np.linspace(0.0, solution.period, round(solution.period / solution.resolution), endpoint=False)
        value = _values_of(item, solution, angle)
        near, far = (_beside(value, -step) + _beside(value, step) for step in (1, 2))
        return cls(item, solution, angle, value, abs(far - 4.0 * near + 6.0 * value))

    @property
    def negligible(self):
        """Fourth difference that counts as smooth, (designs, 1)."""
        return ROUGHNESS * np.fmax.reduce(abs(self.value), axis=-1)[:, None]

    @property
    def rough_places(self):
        """Crank angles around and in stretches where the function is not smooth, (designs, K); NaN pads the rows.

        Jumps and kinks lie between them. A long stretch, as of measured values with noise, is split every fourth step.
        """
        rough = np.any([_beside(self.change > self.negligible, step) for step in range(-2, 3)], axis=0)
        inside = _beside(rough, -1) & _beside(rough, 1) & (np.arange(self.angle.size) % 4 > 0)
        design, place = np.nonzero(rough & ~inside)
        return pad_rows(design, len(self.value), self.angle[place])[0]

    def missed(self, step):
        """`MissedFeatures` at crank angles a finer step apart: where values differ from Bessel's interpolation formula.

        Differences up to the fourth differences of the samples around are expected, so jumps that these show are none.
        """
        count = round(self.solution.period / step)
        angle = (np.arange(count) + 0.5) * (self.solution.period / count)
        share, place = np.modf(angle / self.angle[1])
        place = place.astype(int)
        before, low, high, after = (_beside(self.value, at)[:, place] for at in range(-1, 3))
        expected = low + share * (high - low) - 0.25 * share * (1.0 - share) * (before - low - high + after)
        excess = _values_of(self.item, self.solution, angle) - expected
        rough = np.max([_beside(self.change, at) for at in range(-2, 4)], axis=0)
        excess = np.where(abs(excess) > (self.negligible + rough)[:, place], excess, 0.0)
        excess = excess[abs(excess).argmax(axis=0), np.arange(count)]  # of the design where it is largest
        found = np.flatnonzero(excess)
        runs = np.split(found, np.flatnonzero(np.diff(found) > 1) + 1) if found.size else []
        tops = np.array([run[abs(excess[run]).argmax()] for run in runs], dtype=int)
        return MissedFeatures(title_of(self.item), getattr(self.item, "UNIT", "N"), angle[tops], excess[tops])


def undeclared_jumps(function, places):
    """Crank angles at which a function of the crank angle jumps between neighbouring `rough_places`, (K,), rising."""
    narrow = np.diff(places) < 1.5 * MAX_FUNCTION_STEP
    low, high = places[:-1][narrow], places[1:][narrow]
    if not low.size:
        return low
    row = np.arange(low.size)
    for _ in range(SECTIONS):
        angle = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SECTION_ANGLES)
        value = function(angle)
        change = abs(np.diff(value))
        place = change.argmax(axis=1)
        low, high = angle[row, place], angle[row, place + 1]
    return np.unique(high[change.max(axis=1) > JUMP_TOLERANCE * abs(value).max()])


def _values_of(item, solution, angle):
    """Values of a load function at crank angles, (designs, N)."""
    blocks = np.array_split(angle, 1 + angle.size * math.prod(solution.shape[:-1]) // BLOCK_VALUES)
    values = [np.atleast_2d(user_value(item, solution.at(some))) + 0.0 * some for some in blocks]
    return np.concatenate(values, axis=-1)


def _beside(row, step):
    """Values so many samples ahead, around the period."""
    return np.roll(row, -step, axis=-1)


def law_kinks(solution, jumps=False):
    """Crank angles over the period at which laws of cams have kinks or jumps, or jumps only."""
    angles = [knot.angle for group in solution.mechanism.groups for knot in group.knots if knot.jumps or not jumps]
    starts = np.arange(0.0, solution.period - ANGLE_TOLERANCE, TURN)[:, None]
    return np.ravel(np.mod(np.array(angles, dtype=float), TURN) + starts)


def _period_starts(part, solution):
    """Crank angles at which the period of a part with kinks starts again within the period of a solution."""
    return np.arange(0.0, solution.period - ANGLE_TOLERANCE, period_on(part, solution.mechanism))


def _friction_sign_changes(solution, samples):
    return sign_changes(lambda angle: solution.at(angle).dynamics.friction_signs, solution.period, samples)


def sign_changes(function, period, samples):
    """Which of several functions change their signs, and at which crank angles, both (designs, K), else NaN.

    Parameters
    ----------
    function : function
        From crank angles (1 or designs, N) to a sequence of arrays that broadcast with them: one for each function.
    period : float
    samples : int or array
        Crank angles over the period, rising, or their number: between two of them each function changes its sign once
        at most, or twice where its size has a minimum.
    """

    def evaluate(angle):
        with np.errstate(all="ignore"):
            found = function(angle)
        return np.stack([np.broadcast_arrays(np.atleast_2d(row), angle)[0] for row in found])

    start = SAMPLE_OFFSET + np.linspace(0.0, period, samples, endpoint=False) if np.ndim(samples) == 0 else samples
    angle = np.append(start, start[0] + period)[None]
    found = function(angle)
    if not len(found):
        return np.empty((1, 0)), np.empty((1, 0))
    values = np.stack(np.broadcast_arrays(*(np.atleast_2d(row) for row in found), angle)[:-1])
    low, high, row = _sign_change_brackets(evaluate, values, angle)
    if not low.size:
        return row, low
    known = np.nan_to_num(row).astype(int)

    def own(angle, asked):
        everywhere = low.copy()
        everywhere.flat[asked] = angle
        return np.take_along_axis(evaluate(everywhere), known[None], axis=0)[0].flat[asked]

    root = find_roots(own, low, high)
    first = own(low.ravel(), np.arange(low.size)).reshape(low.shape)
    ends = np.where(first == 0.0, low, high)
    return row, np.mod(np.where(np.isnan(root), ends, root), period)


def _sign_change_brackets(evaluate, values, angle):
    """Crank angles before and after each sign change, and which function, (designs, K); values (functions, designs, N).

    Where the parabola through three samples of one sign has its vertex near zero, the function is evaluated there: it
    may change its sign twice.
    """
    sign = np.signbit(values)
    row, design, place = np.nonzero((sign[..., :-1] != sign[..., 1:]) & ~np.isnan(np.diff(values)))
    brackets = [(design, angle[0, place], angle[0, place + 1], row)]
    before, here, after = (np.abs(part) for part in (values[..., :-2], values[..., 1:-1], values[..., 2:]))
    alike = (sign[..., :-2] == sign[..., 1:-1]) & (sign[..., 1:-1] == sign[..., 2:])
    left, right = np.diff(angle[0])[:-1], np.diff(angle[0])[1:]
    curve = ((after - here) / right - (here - before) / left) / (left + right)
    slope = (here - before) / left + curve * left
    with np.errstate(invalid="ignore", divide="ignore"):
        shift = -0.5 * slope / curve
        near = alike & (here <= before) & (here <= after) & (curve > 0.0)
        near &= here + 0.5 * slope * shift < MAX_VERTEX * 0.5 * curve * (left + right) ** 2
    row, design, place = np.nonzero(near)
    if place.size:
        place = place + 1
        vertex = angle[0, place] + shift[near]
        at, known, order = pad_rows(design, values.shape[1], vertex, row, np.arange(vertex.size))
        there = evaluate(np.where(np.isnan(at), angle[0, 0], at))
        there = np.take_along_axis(there, np.nan_to_num(known).astype(int)[None], axis=0)[0]
        own = np.empty(vertex.size)
        own[order[~np.isnan(order)].astype(int)] = there[~np.isnan(order)]
        beyond = np.signbit(own) != sign[row, design, place]
        row, design, place, vertex = (part[beyond] for part in (row, design, place, vertex))
        brackets += [(design, angle[0, place - 1], vertex, row), (design, vertex, angle[0, place + 1], row)]
    design, low, high, row = (np.concatenate(parts) for parts in zip(*brackets, strict=True))
    order = np.lexsort((low, row, design))
    return pad_rows(design[order], values.shape[1], low[order], high[order], row[order])
