"""User's load functions without `kinks`: sampled at a resolution, and tested for features missed by it.

Features narrower than the resolution of a scene may be missed, so results state it. A function must repeat after its
period.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..machine.loads import TURN, has_no_user_code, kink_sources, period_of
from ..mechanics.load_values import title_of, user_value
from ..mechanics.quantities import LOAD_FREE_KINDS, quantity
from ..numbers import checks
from ..numbers.sign_changes import pad_rows
from .piecewise import rolled

FUNCTION_STEP = math.radians(0.05)
"""Default step of crank angles, rad, at which load functions without declared kinks are sampled."""
MIN_FUNCTION_STEP, MAX_FUNCTION_STEP = 1e-5, math.radians(0.25)
"""Limits of the step, rad, by memory and by the widest pulse that may be missed."""
ROUGHNESS = 1e-5
"""Fourth difference, relative to the largest value, above which a function is not smooth: that of a 64th harmonic."""
BLOCK_VALUES = 2**20
"""Number of values of load functions computed at a time."""
SPLIT_SAMPLES = 4
"""Number of samples between splits of a long rough stretch."""
SECTION_ANGLES, SECTIONS = 33, 9
"""Crank angles that divide an interval with a jump, and number of divisions down to its last digits."""
JUMP_TOLERANCE = 1e-6
"""Change of a function in the last section, relative to its largest value, above which it jumps."""
MAX_SHOWN_FEATURES = 3
"""Largest number of missed features of a load in texts."""
MAX_PERIODS = 6
"""Periods after which a function is tested for repetition if it does not repeat after one."""
REPEAT_TOLERANCE = 1e-6
"""Difference of a force after a period, relative to its largest value, that counts as rounding."""
REPEAT_SAMPLES = 1440
"""Angles of a turn at which a load function is compared a period later."""


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
    """Sentence on the resolution of load functions without kinks in a scene or solution; "" if there are none.

    With the `name` of a quantity "" too if it does not depend on loads.
    """
    titles = [title_of(item) for item in undeclared_functions(scene.loads)]
    if not titles or (isinstance(name, str) and quantity(scene, name).kind in LOAD_FREE_KINDS):
        return ""
    return (
        f"load functions without `kinks` ({', '.join(titles)}) are sampled every {_degrees(scene.resolution)} deg of "
        "the crank; narrower features may be missed"
    )


def with_resolution(table, *scenes):
    """A pandas DataFrame with the `resolution_note` of scenes or solutions in its `attrs`, if there is one."""
    if notes := dict.fromkeys(filter(None, map(resolution_note, scenes))):
        table.attrs["resolution"] = "; ".join(notes)
    return table


def _degrees(angle):
    return f"{np.degrees(angle):.4g}"


class MissedFeatures(NamedTuple):
    """Features of a load function between its samples.

    Attributes
    ----------
    load, unit : str
        Name of the load and unit of its value.
    angle : array (K,)
        Crank angles, rad.
    size : array (K,)
        Values there, less the values interpolated from neighbouring samples.
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
    """Features of load functions that the resolution of a scene misses; `Scene.check_resolution` returns it.

    Its length is the number of missed features.

    Attributes
    ----------
    resolution : float
        Step of crank angles at which the scene samples load functions without kinks, rad.
    step : float
        Finer step of the check, rad.
    missed : tuple of MissedFeatures
        By load: its name (`load`), the `unit` of its value, the crank angles (`angle`, rad) and the difference of its
        values from those interpolated between the samples (`size`).

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
        near, far = (rolled(value, step) + rolled(value, -step) for step in (1, 2))
        return cls(item, solution, angle, value, abs(far - 4.0 * near + 6.0 * value))

    @property
    def negligible(self):
        """Largest fourth difference of a smooth function, (designs, 1)."""
        return ROUGHNESS * np.fmax.reduce(abs(self.value), axis=-1)[:, None]

    @property
    def rough_places(self):
        """Crank angles around and in stretches where the function is not smooth, (designs, K); NaN pads the rows.

        Jumps and kinks lie between them. A long stretch, as of measured values with noise, is split every fourth step.
        """
        rough = np.any([rolled(self.change > self.negligible, -step) for step in range(-2, 3)], axis=0)
        inside = rolled(rough, 1) & rolled(rough, -1) & (np.arange(self.angle.size) % SPLIT_SAMPLES > 0)
        design, place = np.nonzero(rough & ~inside)
        return pad_rows(design, len(self.value), self.angle[place])[0]

    def missed(self, step):
        """`MissedFeatures` at crank angles a finer step apart: where values differ from Bessel's interpolation formula.

        Differences up to the fourth differences of neighbouring samples are expected and do not count.
        """
        count = round(self.solution.period / step)
        angle = (np.arange(count) + 0.5) * (self.solution.period / count)
        share, place = np.modf(angle / self.angle[1])
        place = place.astype(int)
        before, low, high, after = (rolled(self.value, -at)[:, place] for at in range(-1, 3))
        expected = low + share * (high - low) - 0.25 * share * (1.0 - share) * (before - low - high + after)
        excess = _values_of(self.item, self.solution, angle) - expected
        rough = np.max([rolled(self.change, -at) for at in range(-2, 4)], axis=0)
        excess = np.where(abs(excess) > (self.negligible + rough)[:, place], excess, 0.0)
        excess = excess[abs(excess).argmax(axis=0), np.arange(count)]  # from the design with the largest excess
        found = np.flatnonzero(excess)
        runs = np.split(found, np.flatnonzero(np.diff(found) > 1) + 1) if found.size else []
        tops = np.array([run[abs(excess[run]).argmax()] for run in runs], dtype=int)
        return MissedFeatures(title_of(self.item), getattr(self.item, "UNIT", "N"), angle[tops], excess[tops])


def undeclared_jumps(function, places, step):
    """Crank angles at which a function of the crank angle jumps between neighbouring `rough_places`, (K,), rising.

    The places are one to four steps apart.
    """
    gaps = np.diff(places)
    narrow = gaps < (SPLIT_SAMPLES + 0.5) * step
    parts = gaps[narrow, None] / SPLIT_SAMPLES
    low = (places[:-1][narrow, None] + parts * np.arange(SPLIT_SAMPLES)).ravel()
    high = low + np.repeat(parts, SPLIT_SAMPLES)
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
    values = [np.atleast_2d(user_value(item, solution.unsolved_at(some))) + 0.0 * some for some in blocks]
    return np.concatenate(values, axis=-1)


def repeating_problem(solution):
    """Sentence on a load function of one design that differs after its period, or None."""
    for item in solution.loads:
        if has_no_user_code(item):
            continue
        period = period_of([item], solution.mechanism.turns)
        angle = np.linspace(0.0, period, round(REPEAT_SAMPLES * period / TURN), endpoint=False) + 1e-3

        def push(turns, item=item, angle=angle, period=period):
            return np.broadcast_to(user_value(item, solution.unsolved_at(angle + turns * period)), angle.shape)

        first, other = push(0), push(1)
        if _repeats(first, other):
            continue
        place = int(np.nanargmax(np.abs(other - first)))
        unit = getattr(item, "UNIT", "N")
        here, there = (f"{np.degrees(place):.6g} deg" for place in (angle[place], angle[place] + period))
        found = (
            f"{title_of(item)}: its function gives {first[place]:.6g} {unit} at crank angle {here}, "
            f"but {other[place]:.6g} {unit} at {there}"
        )
        turns = next((turns for turns in range(2, MAX_PERIODS + 1) if _repeats(first, push(turns))), None)
        if turns is None:
            return (
                f"{found}; a force must repeat after its period of {period / TURN:.6g} turns: take its crank angle as "
                "np.mod(motion.crank_angle, period), or state its period"
            )
        whole = turns * period / TURN
        remedy = f"period={2 * whole:.6g}*pi"
        if "period" not in vars(item):
            remedy = f"a Table with {remedy}, or a function with an attribute {remedy}"
        return f"{found}, and repeats only after {whole:.6g} turns: give {remedy}"
    return None


def _repeats(first, other):
    with np.errstate(invalid="ignore"):
        return not np.any(np.abs(first - other) > REPEAT_TOLERANCE * np.fmax.reduce(np.abs(first), initial=0.0))
