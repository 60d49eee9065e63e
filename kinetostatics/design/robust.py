"""Quantiles of an output over the spread of a design's numbers, with exact derivatives.

Each sample is the design plus deviations of its numbers. These come from one scrambled Sobol sequence, the same for
every design. The quantile is the weighted mean of the ordered samples (Harrell and Davis, 1982), smooth in the design.
"""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..cycle.kinks import has_kinks
from ..cycle.reductions import Output
from ..errors import KinetostaticsError, ParameterError
from ..mechanics import assembly
from ..mechanics.quantities import of_scene
from ..mechanics.quantities import values as values_of
from ..numbers import checks, spreads
from ..numbers.brackets import GOLDEN_SECTION, find_minima
from ..numbers.units import base_factor, factor
from ..solution.piecewise_turns import START_ANGLES, PiecewiseTurns, unchecked_turn
from ..solution.program import compile as compiled
from . import measures
from .constraints import parse_output, table_limits
from .duties import in_each, read_duties
from .problem import DerivedNumbers, scene_of, turns_of, without_ratio

MAX_SAMPLES = 2**20


@dataclass(frozen=True)
class Spread:
    """Deviations of a design's numbers, and the quantile of an output to optimise; for `optimise`, `torque_free_cam`.

    Parameters
    ----------
    quantile : float
        Between 0 and 1; a low one, such as 0.05, for an output to maximise.
    spreads : mapping of path to text
        Deviations from the design: "normal 0 mm +- 0.05 mm", "-2..2 mm", or in per cent of the design's value "normal
        0 % +- 0.5 %". Deviations count from the median, so the texts of a case's [tolerances] fit.
    samples : int
        Number of samples in the search; a power of two.
    trim : float
        Range of speed adjustment relative to the design's crank speed; each machine runs at its best speed within it.
    seed : int
        Seed of the scrambled Sobol sequence.

    Raises
    ------
    ParameterError
        The quantile is not between 0 and 1, or a text cannot be read.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> spread = ks.design.Spread(0.95, {"spring.stiffness": "normal 0 % +- 1 %"})
    >>> spring = ks.Spring(673e3, free_position=2.0)
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[spring])
    >>> found = ks.design.over_spread(saw, "rms balancing_torque", spread, samples=64)
    >>> print(f"{np.quantile(found, spread.quantile) / found.min():.2f}")
    1.05
    """

    quantile: float
    spreads: Mapping[str, str]
    samples: int = 256
    trim: float = 0.0
    seed: int = field(default=0)

    def __post_init__(self):
        quantile, wrong = checks.single_number("quantile", self.quantile, "1")
        if not wrong and not 0.0 < quantile < 1.0:
            wrong = f"quantile must lie between 0 and 1, got {quantile!r}"
        found = checks.single_numbers(
            "spread",
            wrong,
            None
            if isinstance(self.spreads, Mapping) and self.spreads
            else ('spreads must be a dict of path to text, such as {"slider.mass": "normal 0 % +- 1 %"}'),
            samples_problem(self.samples),
            checks.seed("seed", self.seed),
            trim=(self.trim, "1", {"low": 0.0, "high": 1.0}),
        )
        vars(self).update(found, quantile=quantile)
        spreads.distributions(self.spreads)


def samples_problem(samples):
    """Sentence on an invalid number of samples, or None."""
    whole = isinstance(samples, int) and 1 < samples <= MAX_SAMPLES
    if whole and not samples & (samples - 1):
        return None
    return f"samples must be a power of two, up to {MAX_SAMPLES}, got {checks.shown(samples)}"


def spread_problem(name, value):
    """Sentence on a value that is no `Spread`, or None."""
    if isinstance(value, Spread):
        return None
    return f'{name} must be a Spread, as ks.design.Spread(0.05, {{"slider.mass": ...}}), got {checks.shown(value)}'


def deviations(spread, known, count):
    """Set of paths with relative deviations, and a dict of path to deviations (count,), relative or in SI."""
    from scipy.stats import qmc

    found = spreads.distributions(spread.spreads)
    uniform = qmc.Sobol(len(found), rng=spread.seed).random(count)
    shares, deviations = set(), {}
    for (path, (distribution, unit)), column in zip(found.items(), uniform.T, strict=True):
        deviations[path] = distribution.ppf(column) - distribution.median()
        is_share = unit.strip() in ("%", "percent")
        try:
            deviations[path] *= base_factor(unit) if is_share else factor(unit, known[path])
        except ValueError as error:
            raise ParameterError(f"spread: {path}: {error}") from None
        if is_share:
            shares.add(path)
    return shares, deviations


def harrell_davis_weights(quantile, count):
    """Weights (count,) of the ordered samples in a quantile (Harrell and Davis)."""
    from scipy.special import betainc

    first, second = (count + 1) * quantile, (count + 1) * (1.0 - quantile)
    return np.diff(betainc(first, second, np.linspace(0.0, 1.0, count + 1)))


ANGLES_PER_SAMPLE, SAMPLES_PER_BLOCK = 180, 128
"""Crank angles of each sample, and samples computed at a time."""
SPEED = "crank_speed"
MAX_CACHED_BLOCKS = 64
"""Number of blocks of samples with cached reference curves: a search needs them for each design."""
NEGLIGIBLE_WEIGHT = 1e-12
"""Weight of a sample in the quantile, relative to the largest, below which its derivatives are left out."""
SPEED_TOLERANCE = 1e-6
"""Error of the square of a trimmed speed, relative to twice its range."""
SHIFT = 2.0
"""Offset of shares, because tolerances of minima are relative to their arguments."""
TRIMMED_ROUGHNESS = 1e-6
"""Relative roughness of a trimmed quantile: caused by sign changes of small torques between crank angles."""


class SampledOutput:
    """An output of a design over its spread: each number of the scene has its own deviation in each sample.

    A call returns the quantile and its derivatives, `outputs` the output of each sample.
    """

    def __init__(self, problem, output, spread, sign, samples=None):
        self.problem, self.spread, self.sign = problem, spread, sign
        scene = scene_of(problem.source)
        checks.require("spread", *(checks.choice("parameter", path, tuple(scene.units)) for path in spread.spreads))
        self.count = spread.samples if samples is None else samples
        self._relative_paths, self._deviations = deviations(spread, scene.units, self.count)
        self.angle, self.turns = np.linspace(0.0, scene.period, ANGLES_PER_SAMPLE, endpoint=False), turns_of(scene)
        self._design_numbers: Any = DerivedNumbers(problem.source, problem.names) if problem.names else None
        designed = self._design_numbers.paths if self._design_numbers else ()
        self.paths = tuple(dict.fromkeys([*designed, *spread.spreads, *[SPEED] * bool(spread.trim)]))
        self._nominal = scene.parameters
        self._set_output(output)
        self._reference_curves = lru_cache(MAX_CACHED_BLOCKS)(self._solved_reference)
        self.weights = harrell_davis_weights(spread.quantile, self.count)
        self.roughness = TRIMMED_ROUGHNESS if spread.trim else 0.0
        if spread.trim:
            self._require_trim()

    def _set_output(self, output):
        """Compile the program of an output and set the fields that depend on it."""
        scene = scene_of(self.problem.source)
        zeros = [path for path in self.paths if self._nominal[path] == 0.0]
        self.unit, self.ratio = output.unit, output.ratio
        self.output, self.program = output, compiled(scene, output.quantity, zeros, self.problem.engine)
        self._vector = (2,) if of_scene(scene)[output.quantity].vector else ()
        self._has_kinks = not self.spread.trim and has_kinks(unchecked_turn(scene, 1), output.quantity)

    def __str__(self):
        return f"{self.output} within the spread"

    def within_tables(self):
        """Limits that keep all samples within load tables over travel, if the spread moves sliders."""
        limits = []
        for limit in table_limits(scene_of(self.problem.source)):
            # all weight on the ordered sample nearest to the limit or farthest beyond it; the copy shares deviations
            worst = copy.copy(self)
            worst._set_output(limit.output)
            worst.weights = np.zeros(self.count)
            worst.weights[-1 if limit.relation == "<=" else 0] = 1.0
            if any(map(worst.program.depends_on, self.spread.spreads)):
                limits.append(replace(limit, output=worst))
        return tuple(limits)

    def __call__(self, values):
        """The quantile, and its derivatives (n,) by the numbers that vary."""
        nothing = np.nan, np.full(values.size, np.nan)
        try:
            found, slopes_of = self.sampled(values)
            order = np.argsort(found)
            quantile = self.weights @ found[order]
            if np.isnan(quantile):
                return nothing
            counted = self.weights > NEGLIGIBLE_WEIGHT * self.weights.max()
            return quantile, self.weights[counted] @ slopes_of(order[counted])
        except KinetostaticsError:  # a machine within the spread that cannot be built
            return nothing

    def sampled(self, values):
        """The output of each sample, (samples,), and a function of samples to its derivatives (samples, n)."""
        design, changes = self._design(values)
        found, own, numbers = self._evaluated(design)

        def slopes_of(samples):
            slopes = self._derivatives(numbers, samples, changes)
            return slopes * -(found / own)[samples, None] if self.output.ratio else slopes

        return found, slopes_of

    def outputs(self, values):
        """The output of each sample, (samples,)."""
        return self._evaluated(self._design(values)[0])[0]

    def _design(self, values):
        """The design's numbers by path, and their derivatives (paths, n)."""
        return self._design_numbers(values) if self._design_numbers else ({}, np.zeros((0, 0)))

    def _evaluated(self, design):
        """Output of each sample, the same without the reference, both (samples,), and its numbers (samples, 1)."""
        starts = range(0, self.count, SAMPLES_PER_BLOCK)
        blocks = [self._block(self._numbers(design, slice(start, start + SAMPLES_PER_BLOCK))) for start in starts]
        found, own, parts = zip(*blocks, strict=True)
        numbers = {path: np.concatenate([part[path] for part in parts]) for path in self.paths}
        return np.concatenate(found), np.concatenate(own), numbers

    def _numbers(self, design, samples):
        """Numbers (samples, 1) of some samples by path."""
        numbers = {}
        for path in self.paths:
            value = design.get(path, self._nominal[path])
            deviation = self._deviations.get(path, np.zeros(self.count))[samples, None]
            numbers[path] = value * (1.0 + deviation) if path in self._relative_paths else value + deviation
        return numbers

    def _block(self, numbers):
        """As `_evaluated` for some samples, each at its best crank speed within the trim."""
        if self.spread.trim:
            return self._at_best_speeds(numbers)
        if self._has_kinks:
            found = self._on_pieces(scene_of(self.problem.source), numbers)
            own = np.broadcast_to(found, len(next(iter(numbers.values()))))
        else:
            own = self.output.reduced(self._values(numbers), self.turns)
        return self._reference_outputs(numbers) / own if self.output.ratio else own, own, numbers

    def _on_pieces(self, scene, numbers):
        """Outputs (1 or samples,) of a scene with kinks, without the reference, with other numbers."""
        plain = (without_ratio(self.output),)
        return PiecewiseTurns.of(scene.varied(numbers), plain, START_ANGLES * self.turns).estimated(plain)[0, 0]

    def _derivatives(self, numbers, samples, changes):
        """Derivatives (samples, n) of the outputs of some samples, without the reference."""
        if not self._design_numbers:
            return np.zeros((samples.size, 0))
        rises = np.ones((len(changes), samples.size))
        for place, path in enumerate(self._design_numbers.paths):
            if path in self._relative_paths:
                rises[place] += self._deviations[path][samples]
        changes = rises[:, :, None] * changes[:, None]
        numbers = {path: values[samples] for path, values in numbers.items()}
        if self._has_kinks:
            curves = self._piecewise_curves(numbers, changes)
        else:
            pairs = zip(*self._curves(numbers, changes), strict=True)
            curves = (measures.Curve(values, slopes, self.turns) for values, slopes in pairs)
        return np.array([measures.reduced(self.output.reduction, curve)[1] for curve in curves])

    def _piecewise_curves(self, numbers, changes):
        """Yield the curve of each of some samples, on pieces between its kinks."""
        output = without_ratio(self.output)
        turns = PiecewiseTurns.of(scene_of(self.problem.source).varied(numbers), (output,), START_ANGLES * self.turns)
        for samples, pieces, _ in turns.refined((output,)):
            own = samples[pieces.owner]
            some = {path: values[own] for path, values in numbers.items()}
            values, slopes = self._curves(some, changes[:, own], pieces.angle)
            for sample in range(samples.size):
                alone, mask = pieces.of_designs(np.arange(samples.size) == sample)
                yield measures.PiecewiseCurve(values[mask], np.moveaxis(slopes[mask], 0, 1), alone, bool(self._vector))

    def _values(self, numbers):
        """Values (samples, N), of vectors magnitudes, at the crank angles of all samples."""
        values = self._components(numbers, self.angle)
        return np.hypot(*values) if self._vector else values

    def _components(self, numbers, angle):
        shape = (*self._vector, len(next(iter(numbers.values()))), angle.shape[-1])
        return np.broadcast_to(self.program(angle, numbers)[self.output.quantity], shape)

    def _curves(self, numbers, changes, angle=None):
        """Values and derivatives (samples, n, N) at crank angles, (N,) for all samples or (samples, N).

        `changes` (paths, samples, n) are the derivatives of the numbers.
        """
        angle = self.angle if angle is None else angle
        values = self._components(numbers, angle)
        found = self.program.derivatives(angle, self._design_numbers.paths, numbers)[self.output.quantity]
        by_path = np.array([np.broadcast_to(part, values.shape) for part in found.values()])
        slopes = np.einsum("psn,p...sa->n...sa", changes, by_path, optimize=True)
        if self._vector:
            values, slopes = measures.size(values, slopes)
        return values, np.moveaxis(slopes, 0, 1)

    def _reference_outputs(self, numbers):
        """The reference's output, (1 or samples,)."""
        reference, shared = scene_of(self.problem.reference), self._shared_numbers(numbers)
        if has_kinks(unchecked_turn(reference.varied(shared), 1), self.output.quantity):
            return self._on_pieces(reference, shared)
        return self.output.reduced(self._reference_values(numbers), self.turns)

    def _reference_values(self, numbers):
        """Values of the reference (samples, N), with the deviations of the numbers that it shares."""
        shared = ((path, values.tobytes()) for path, values in self._shared_numbers(numbers).items())
        found = self._reference_curves(self.output.quantity, *shared)
        return np.broadcast_to(found, (len(next(iter(numbers.values()))), self.angle.size))

    def _solved_reference(self, quantity, *shared):
        """Values of a quantity of the reference with some numbers, pairs of path and bytes."""
        numbers = {path: np.frombuffer(values)[:, None] for path, values in shared}
        return values_of(scene_of(self.problem.reference).varied(numbers).solve(self.angle), quantity)

    def _shared_numbers(self, numbers):
        """The samples' crank speed and numbers that spread, if the reference has them too."""
        known = scene_of(self.problem.reference).units
        return {path: numbers[path] for path in numbers if path in (*self.spread.spreads, SPEED) and path in known}

    def _at_best_speeds(self, numbers):
        """As `_block`, at the best speed of each sample within the trim; values are linear in the squared speed."""
        squares = (1.0 - self.spread.trim) ** 2, (1.0 + self.spread.trim) ** 2
        ends = [self._at_speed(numbers, np.sqrt(square)) for square in squares]
        sides = [self._values, self._reference_values][: 1 + self.output.ratio]
        curves = [(low, high - low) for low, high in ([side(at) for at in ends] for side in sides)]

        def outputs(share, some=slice(None)):
            mixed = (low[some] + share[:, None] * rise[some] for low, rise in curves)
            own, *above = (self.output.reduced(values, self.turns) for values in mixed)
            return above[0] / own if above else own, own

        share = _best_shares(lambda *at: self.sign * outputs(*at)[0], len(numbers[SPEED]))
        speeds = self._at_speed(numbers, np.sqrt(_between(*squares, share[:, None])))
        return *outputs(share), speeds

    def _at_speed(self, numbers, share):
        """Numbers of samples with the crank speed at a multiple of the design's."""
        return numbers | {SPEED: np.broadcast_to(self._nominal[SPEED] * share, numbers[SPEED].shape)}

    def _require_trim(self):
        """Refuse trim for outputs that are not linear in the squared speed, tested at three speeds."""
        problem = None
        if SPEED in self.problem.names:
            problem = f"trim sets {SPEED}, so it cannot vary too"
        elif has_kinks(unchecked_turn(scene_of(self.problem.source), 1), self.output.quantity):
            problem = (
                f"trim needs outputs without kinks, but loads, friction or a cam's law cause kinks of {self.output}"
            )
        else:
            numbers = self._numbers({}, slice(0, 1))
            squares = np.array([(1.0 - self.spread.trim) ** 2, 1.0, (1.0 + self.spread.trim) ** 2])
            low, middle, high = (self._values(self._at_speed(numbers, share)) for share in np.sqrt(squares))
            share = (1.0 - squares[0]) / (squares[2] - squares[0])
            if not np.allclose(middle, _between(low, high, share), rtol=1e-9, atol=1e-9 * np.abs(middle).max()):
                problem = (
                    "trim needs outputs of constant parts and parts that grow with the squared speed; "
                    f"{self.output} does not, as with friction or dampers"
                )
        checks.require("spread", problem)


class MeanSampledOutput(SampledOutput):
    """Mean of the sampled outputs of several duties, weighted by their shares; each sample is one machine in all."""

    def __init__(self, parts, shares):
        first = next(iter(parts.values()))
        self.parts, self.shares, self.output, self.spread = parts, shares, first.output, first.spread
        self.weights, self.roughness = first.weights, first.roughness

    def sampled(self, values):
        """As of one duty."""
        found, slopes = zip(*(part.sampled(values) for part in self.parts.values()), strict=True)
        shares = np.array(list(self.shares.values()))
        return shares @ np.array(found), lambda samples: np.tensordot(shares, [rise(samples) for rise in slopes], 1)

    def outputs(self, values):
        """The mean output of each sample, (samples,)."""
        return self.sampled(values)[0]

    def within_tables(self):
        """Limits that keep all samples within load tables over travel, in each duty."""
        return tuple(replace(limit, duty=name) for name, part in self.parts.items() for limit in part.within_tables())


def sampled_output(problem, output, spread, sign, samples=None):
    """`SampledOutput` of a problem, or the mean of those of its duties."""
    parts = {name: SampledOutput(part, output, spread, sign, samples) for name, part in problem.parts.items()}
    return parts[""] if "" in parts else MeanSampledOutput(parts, problem.shares)


def over_spread(source, output, spread, *, variant=None, reference=None, samples=4096):
    """An output of machines whose numbers deviate from the design's.

    Parameters
    ----------
    source, variant, reference
        As for `optimise`; for an optimised design pass its `.scene` and `.reference`. The reference has the same
        deviations of shared numbers. With duties the result is the weighted mean, for the same machine in all.
    output : str
    spread : Spread
    samples : int
        A power of two.

    Returns
    -------
    array (samples,)
        Output of each sample, for ``numpy.quantile``.

    Raises
    ------
    ParameterError
        An argument is invalid or names an unknown number; or machines within the spread have no value.
    AssemblyError
        The design itself does not close all round the turn.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> spread = ks.design.Spread(0.05, {"spring.stiffness": "normal 0 % +- 0.5 %", "crank_speed": "normal 0 % +- 1 %"})
    >>> saw = ks.load_case("sawframe_2r63")
    >>> found = ks.design.over_spread(
    ...     saw, "ratio mean_absolute balancing_torque", spread, variant="cam-circle", samples=64
    ... )
    >>> round(float(np.quantile(found, 0.05)), 1)
    5.2
    """
    checks.require("over_spread", spread_problem("spread", spread), samples_problem(samples))
    duties = read_duties(source, variant, reference)
    text = next(iter(in_each(duties, lambda _, duty: parse_output(output, scene_of(duty.source))).values()))
    checks.require(
        "over_spread", None if isinstance(text, Output) else f"{str(text)!r} is a number of a part; use ks.tolerances"
    )
    for duty in duties.values():
        assembly.require_turn(scene_of(duty.source).mechanism)
    sampled = _fixed_output(duties, text, spread, -1.0 if text.ratio else 1.0, samples)
    found = sampled.outputs(np.empty(0))
    without = np.count_nonzero(np.isnan(found))
    checks.require(
        "over_spread",
        f"{without} of {found.size} machines within the spread have no {output!r}: they do not close all round the "
        "turn, or have no value there; use narrower spreads"
        if without
        else None,
    )
    return found


def quantile(duties, output, spread, sign):
    """The quantile of the output of duties over a spread; NaN where a machine within it cannot be built."""
    try:
        sampled = _fixed_output(duties, output, spread, sign)
        return float(sampled.weights @ np.sort(sampled.outputs(np.empty(0))))
    except KinetostaticsError:
        return np.nan


def _fixed_output(duties, output, spread, sign, samples=None):
    """`sampled_output` of duties by name without varied numbers, so without derivatives."""
    given = {"names": (), "engine": "numpy", "start": np.empty(0)}
    parts = {
        name: SimpleNamespace(source=duty.source, reference=duty.reference, **given) for name, duty in duties.items()
    }
    whole: Any = SimpleNamespace(parts=parts, shares={name: duty.share for name, duty in duties.items()})
    return sampled_output(whole, output, spread, sign, samples)


def _between(one, other, share):
    """Values between those at two squared speeds."""
    return one + share * (other - one)


def _best_shares(function, count):
    """Minimiser in [0, 1] of each of several functions (K,) of arguments and their numbers, with one minimum there.

    The functions are reflected at 0 and 1, so that a minimum there lies inside a bracket.
    """

    def reflected(place, number):
        return function(1.0 - np.abs(1.0 - np.abs(place - SHIFT)), number)

    places = SHIFT + np.array([-GOLDEN_SECTION, 0.0, GOLDEN_SECTION, 1.0, 2.0 - GOLDEN_SECTION])
    every = np.arange(count)
    lowest = np.argmin([reflected(np.full(count, place), every) for place in places[1:-1]], axis=0)
    found = find_minima(reflected, places[lowest + np.arange(3)[:, None]], SPEED_TOLERANCE)
    return 1.0 - np.abs(1.0 - np.abs(found - SHIFT))
