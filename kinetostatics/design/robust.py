"""Quantiles of an output over the spread of a design's numbers, with exact derivatives.

Each sample is the design with its own deviations, from a scrambled Sobol sequence that is the same for every design.
The quantile is the mean of ordered samples by Harrell and Davis (1982), smooth in the design.
"""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..cycle.kinks import has_kinks
from ..cycle.pieces import NODES
from ..errors import KinetostaticsError, ParameterError
from ..mechanics import assembly
from ..mechanics.quantities import of_scene
from ..mechanics.quantities import values as values_of
from ..numbers import checks, spreads
from ..numbers.units import base_factor, factor
from ..solution.piecewise_turns import START_ANGLES, PiecewiseTurns, unchecked_turn
from ..solution.program import compile as compiled
from . import measures
from .constraints import parse_output, table_limits
from .problem import DerivedNumbers, choose_design, scene_of, turns_of, without_ratio

MAX_SAMPLES = 2**20


@dataclass(frozen=True)
class Spread:
    """Distributions of numbers and the quantile of an output that counts; for `optimise`, `torque_free_cam`.

    Parameters
    ----------
    quantile : float
        Between 0 and 1: for an output to maximise a low one such as 0.05.
    spreads : mapping of path to text
        Deviations from the design: "normal 0 mm +- 0.05 mm", "-2..2 mm", and in per cent of the design's value "normal
        0 % +- 0.5 %". Only deviations from the median count, so the texts of a case's [tolerances] fit.
    samples : int
        Of the search; a power of two.
    trim : float
        Share of the design's crank speed within which each machine runs at its best speed.
    seed : int
        Of the scrambled Sobol sequence.

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
    """What is wrong with a number of samples, as a sentence, or None."""
    whole = isinstance(samples, int) and 1 < samples <= MAX_SAMPLES
    if whole and not samples & (samples - 1):
        return None
    return f"samples must be a power of two, up to {MAX_SAMPLES}, got {checks.shown(samples)}"


def spread_problem(name, value):
    """What is wrong with what must be a `Spread`, or None."""
    if isinstance(value, Spread):
        return None
    return f'{name} must be a Spread, as ks.design.Spread(0.05, {{"slider.mass": ...}}), got {checks.shown(value)}'


def deviations(spread, known, count):
    """Paths whose deviations are relative to their value, and deviations (count,) by path."""
    from scipy.stats import qmc

    found = spreads.distributions(spread.spreads)
    uniform = qmc.Sobol(len(found), rng=spread.seed).random(count)
    shares, deviations = set(), {}
    for (path, (distribution, unit)), column in zip(found.items(), uniform.T, strict=True):
        deviations[path] = distribution.ppf(column) - distribution.median()
        if unit.strip() in ("%", "percent"):
            shares.add(path)
            deviations[path] = deviations[path] * base_factor(unit)
            continue
        try:
            deviations[path] = deviations[path] * factor(unit, known[path])
        except ValueError as error:
            raise ParameterError(f"spread: {path}: {error}") from None
    return shares, deviations


def harrell_davis_weights(quantile, count):
    """Weights of the ordered samples in a quantile (Harrell and Davis)."""
    from scipy.special import betainc

    first, second = (count + 1) * quantile, (count + 1) * (1.0 - quantile)
    return np.diff(betainc(first, second, np.linspace(0.0, 1.0, count + 1)))


ANGLES, BLOCK_SIZE = 180, 16
"""Crank angles of each sample, and samples computed at a time."""
SPEED = "crank_speed"
GOLDEN_STEPS = 30
"""Golden-section steps of the trimmed speed: to a millionth of the range."""
GOLDEN_RATIO = (np.sqrt(5.0) - 1.0) / 2.0


class SampledOutput:
    """An output of a design over its spread; deviations apply to the scene's own numbers, one by one."""

    def __init__(self, problem, output, spread, sign, samples=None):
        self.problem, self.spread, self.sign = problem, spread, sign
        scene = scene_of(problem.source)
        checks.require("spread", *(checks.choice("parameter", path, tuple(scene.units)) for path in spread.spreads))
        self.count = spread.samples if samples is None else samples
        self._shares, self._deviations = deviations(spread, scene.units, self.count)
        self.angle, self.turns = np.linspace(0.0, scene.period, ANGLES, endpoint=False), turns_of(scene)
        self._derived: Any = DerivedNumbers(problem.source, problem.names) if problem.names else None
        designed = self._derived.paths if self._derived else ()
        self.paths = tuple(dict.fromkeys([*designed, *spread.spreads, *[SPEED] * bool(spread.trim)]))
        self._own = scene.parameters
        self._take_output(output)
        self.weights = harrell_davis_weights(spread.quantile, self.count)
        if spread.trim:
            self._require_trim()

    def _take_output(self, output):
        scene = scene_of(self.problem.source)
        zeros = [path for path in self.paths if self._own[path] == 0.0]
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
            # of the sample nearest to the limit or farthest beyond it; samples shared
            worst = copy.copy(self)
            worst._take_output(limit.output)
            worst.weights = np.zeros(self.count)
            worst.weights[-1 if limit.relation == "<=" else 0] = 1.0
            if any(map(worst.program.depends_on, self.spread.spreads)):
                limits.append(replace(limit, output=worst))
        return tuple(limits)

    def __call__(self, values):
        """The quantile, and its derivatives by the numbers that vary."""
        try:
            found, slopes = self._sampled(values)
        except KinetostaticsError:  # a machine within the spread that cannot be built
            return np.nan, np.full(values.size, np.nan)
        order = np.argsort(found)
        return self.weights @ found[order], self.weights @ slopes[order]

    def outputs(self, values):
        """The output of each sample."""
        return self._sampled(values)[0]

    def _sampled(self, values):
        """The output of each sample, and its derivatives (samples, n)."""
        design, changes = self._derived(values) if self._derived else ({}, np.zeros((0, 0)))
        padded, parts = np.zeros((len(self.paths), 1, changes.shape[1])), []
        padded[: len(changes), 0] = changes
        for start in range(0, self.count, BLOCK_SIZE):
            numbers, rises = self._numbers(design, slice(start, start + BLOCK_SIZE))
            parts.append(self._part(numbers, rises[:, :, None] * padded))
        return tuple(np.concatenate([part[place] for part in parts]) for place in (0, 1))

    def _numbers(self, design, part):
        """Numbers of some samples by path (samples, 1), and their derivatives by the design's own (paths, samples)."""
        numbers, rises = {}, []
        for path in self.paths:
            value = design.get(path, self._own[path])
            deviation = self._deviations.get(path, np.zeros(self.count))[part]
            share = path in self._shares
            rises.append(1.0 + deviation if share else np.ones(deviation.size))
            numbers[path] = (value * (1.0 + deviation) if share else value + deviation)[:, None]
        return numbers, np.array(rises)

    def _part(self, numbers, changes):
        """Output of some samples, with derivatives (samples, n)."""
        if self._has_kinks:
            curves, above = self._on_pieces(numbers, changes), self._above(numbers)
        else:
            if self.spread.trim:
                *pair, above = self._trimmed(numbers, changes)
            else:
                pair, above = self._curves(numbers, changes), self._above(numbers)
            curves = [measures.Curve(values, slopes, self.turns) for values, slopes in zip(*pair, strict=True)]
        found, rows = np.empty(len(curves)), np.zeros((len(curves), changes.shape[-1]))
        for place, curve in enumerate(curves):
            value, row = measures.reduced(self.output.reduction, curve)
            if self.output.ratio:
                value, row = above[place] / value, -above[place] / value**2 * row
            found[place], rows[place] = value, row
        return found, rows

    def _on_pieces(self, numbers, changes):
        """Curves of some samples, each on pieces between its own kinks."""
        output = without_ratio(self.output)
        found: list[Any] = [None] * len(next(iter(numbers.values())))
        parted = PiecewiseTurns.of(scene_of(self.problem.source).varied(numbers), (output,), START_ANGLES * self.turns)
        for samples, pieces, told in parted.refined((output,)):
            some = {path: values[samples] for path, values in numbers.items()}
            values, shape = told[output.quantity], pieces.start.shape[1:] + NODES.shape
            slopes = np.zeros((len(samples), 0, *shape))
            if self._derived:
                values, slopes = self._curves(some, changes[:, samples], pieces.angle)
            for place, sample in enumerate(samples):
                parts = values[place].reshape(shape), slopes[place].reshape(-1, *shape)
                found[sample] = measures.PartedCurve(*parts, pieces.some([place]), bool(self._vector))
        return found

    def _curves(self, numbers, changes, angle=None):
        """Values (samples, N) and derivatives (samples, n, N), at the crank angles of all or of each."""
        quantity, angle = self.output.quantity, self.angle if angle is None else angle
        shape = (*self._vector, len(next(iter(numbers.values()))), angle.shape[-1])
        values, slopes = np.broadcast_to(self.program(angle, numbers)[quantity], shape), np.zeros((0, *shape))
        if self._derived:
            found = self.program.derivatives(angle, self._derived.paths, numbers)[quantity]
            by_path = np.array([np.broadcast_to(part, shape) for part in found.values()])
            slopes = np.einsum("psn,p...sa->n...sa", changes[: len(by_path)], by_path, optimize=True)
        if self._vector:
            curve = [measures.size(values[:, place], slopes[:, :, place]) for place in range(shape[-2])]
            return np.array([part.values for part in curve]), np.array([part.slopes for part in curve])
        return values, np.moveaxis(slopes, 0, 1)

    def _above(self, numbers):
        """The reference's output for each sample."""
        if not self.output.ratio:
            return None
        reference, plain = self._reference(numbers), without_ratio(self.output)
        if not has_kinks(unchecked_turn(reference, 1), plain.quantity):
            return self._reduced(self._of_reference(numbers))
        found = PiecewiseTurns.of(reference, (plain,), START_ANGLES * self.turns).estimated((plain,))[0, 0]
        return np.broadcast_to(found, len(next(iter(numbers.values()))))

    def _reduced(self, curves):
        """The output, not its ratio, of curves (samples, N)."""
        return without_ratio(self.output).estimated(curves, self.turns)[0]

    def _of_reference(self, numbers):
        """Curves of the reference (samples, N), with the deviations of the numbers that it shares."""
        found = self._reference(numbers).solve(self.angle)
        return np.broadcast_to(
            values_of(found, self.output.quantity), (len(next(iter(numbers.values()))), self.angle.size)
        )

    def _reference(self, numbers):
        reference = scene_of(self.problem.reference)
        known = [path for path in numbers if path in (*self.spread.spreads, SPEED) and path in reference.units]
        return reference.varied({path: numbers[path] for path in known})

    def _trimmed(self, numbers, changes):
        """Curves at the speed within the trim at which each sample's output is best, and the reference's output."""
        slow, fast = (self._at_speed(numbers, 1.0 + side * self.spread.trim) for side in (-1.0, 1.0))
        (low, low_slopes), (high, high_slopes) = (self._curves(at, changes) for at in (slow, fast))
        below, above = (self._of_reference(at) if self.output.ratio else None for at in (slow, fast))

        def outputs(share):
            found = self._reduced(_interpolate(low, high, share[:, None]))
            if self.output.ratio:
                found = self._reduced(_interpolate(below, above, share[:, None])) / found
            return self.sign * found

        share = _golden_section(outputs, len(low))[:, None]
        compared = self._reduced(_interpolate(below, above, share)) if self.output.ratio else None
        return _interpolate(low, high, share), _interpolate(low_slopes, high_slopes, share[..., None]), compared

    def _at_speed(self, numbers, share):
        """Numbers of samples at a share of the design's speed."""
        return numbers | {SPEED: np.full_like(numbers[SPEED], self._own[SPEED] * share)}

    def _require_trim(self):
        """Refuse trim for outputs that are not linear in the squared speed; three speeds test it."""
        problem = None
        if SPEED in self.problem.names:
            problem = f"trim sets {SPEED}, so it cannot vary too"
        else:
            numbers, _ = self._numbers({}, slice(0, 1))
            changes = np.zeros((len(self.paths), 1, len(self.problem.names)))
            squares = np.array([(1.0 - self.spread.trim) ** 2, 1.0, (1.0 + self.spread.trim) ** 2])
            low, middle, high = (self._curves(self._at_speed(numbers, share), changes)[0] for share in np.sqrt(squares))
            share = (1.0 - squares[0]) / (squares[2] - squares[0])
            if not np.allclose(middle, _interpolate(low, high, share), rtol=1e-9, atol=1e-9 * np.abs(middle).max()):
                problem = (
                    "trim takes outputs of constant parts and others that grow as the speed squared; "
                    f"{self.output} does not, as with friction or dampers"
                )
        checks.require("spread", problem)


def over_spread(source, output, spread, *, variant=None, reference=None, samples=4096):
    """An output of machines as they are made and run.

    Parameters
    ----------
    source, variant, reference
        As for `optimise`; of a design that was found, its `.scene` and `.reference`. The reference takes those of the
        numbers that spread that it has too.
    output : str
    spread : Spread
    samples : int
        A power of two.

    Returns
    -------
    array (samples,)
        For ``numpy.quantile``.

    Raises
    ------
    ParameterError
        What is asked for cannot be read, or names what the machine has not; machines within the spread have no value.
    AssemblyError
        The machine itself does not close all round the turn.

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
    item, compared = choose_design(source, variant, reference)
    text = parse_output(output, scene_of(item))
    assembly.require_turn(scene_of(item).mechanism)
    found = _sampled_scene(item, compared, text, spread, -1.0 if text.ratio else 1.0, samples).outputs(np.empty(0))
    without = np.count_nonzero(np.isnan(found))
    checks.require(
        "over_spread",
        f"{without} of {found.size} machines within the spread have no {output!r}: they do not close all round the "
        "turn, or have no value there; narrow the spreads"
        if without
        else None,
    )
    return found


def quantile(scene, reference, output, spread, sign):
    """The quantile of an output of a scene over its spread; NaN where a machine within it cannot be built."""
    try:
        sampled = _sampled_scene(scene, reference, output, spread, sign)
        return float(sampled.weights @ np.sort(sampled.outputs(np.empty(0))))
    except KinetostaticsError:
        return np.nan


def _sampled_scene(scene, reference, output, spread, sign, samples=None):
    """An output of a fixed scene over a spread."""
    bare = SimpleNamespace(source=scene, reference=reference, names=(), engine="numpy", start=np.empty(0))
    return SampledOutput(bare, output, spread, sign, samples)


def _interpolate(one, other, share):
    """Values between those at two speeds, linear in the squared speed."""
    return one * (1.0 - share) + other * share


def _golden_section(function, count):
    """Minimiser in [0, 1] of each of several functions, by golden section."""
    low, high = np.zeros(count), np.ones(count)
    inner, outer = high - GOLDEN_RATIO, low + GOLDEN_RATIO
    at_inner, at_outer = function(inner), function(outer)
    for _ in range(GOLDEN_STEPS):
        left = at_inner < at_outer
        high, low = np.where(left, outer, high), np.where(left, low, inner)
        new = np.where(left, high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low))
        value = function(new)
        inner, outer = np.where(left, new, outer), np.where(left, inner, new)
        at_inner, at_outer = np.where(left, value, at_outer), np.where(left, at_inner, value)
    return np.where(at_inner < at_outer, inner, outer)
