"""Quantiles of an output over machines as they are made and run: what a design is worth when its numbers spread.

Each sample is the design with its own deviations, the same whatever the design, from a scrambled Sobol sequence. The
quantile is Harrell and Davis's mean of ordered samples, which changes smoothly with the design, by exact derivatives.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np

from ..errors import KinetostaticsError, ParameterError
from ..mechanics.quantities import of_scene
from ..mechanics.quantities import values as values_of
from ..numbers import checks, spreads
from ..numbers.units import base_factor, factor
from ..solution.compile import compile as compiled
from . import measures
from .demands import wanted
from .derived import Derived, scene_of
from .problem import chosen, own

ANGLES, TOGETHER = 180, 16
"""Crank angles of each sample, and samples computed at a time."""
SPEED = "crank_speed"
NARROWED = 30
"""Steps of the golden section that trims a speed: to a millionth of the range."""
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0


@dataclass(frozen=True)
class Spread:
    """How numbers spread, and which quantile of an output counts; for `optimise` and `torque_free_cam`.

    Parameters
    ----------
    quantile : float
        Between 0 and 1: of an output to be made greatest that which few fall below, 0.05.
    spreads : mapping of path to text
        Deviations from the design: "normal 0 mm +- 0.05 mm", "-2..2 mm", and in per cent of the design's value "normal
        0 % +- 0.5 %". What a text spreads about does not count, so the texts of a case's [tolerances] will do.
    samples : int
        While it is searched; a power of two.
    trim : float
        Share of the design's crank speed within which each machine's own is set to what suits it best.
    seed : int
        Of the scrambled Sobol sequence.
    """

    quantile: float
    spreads: Mapping[str, str]
    samples: int = 256
    trim: float = 0.0
    seed: int = field(default=0)

    def __post_init__(self):
        power = isinstance(self.samples, int) and self.samples > 1 and not self.samples & (self.samples - 1)
        checks.require(
            "spread",
            None
            if isinstance(self.quantile, float) and 0 < self.quantile < 1
            else (f"quantile must lie between 0 and 1, got {self.quantile!r}"),
            None
            if isinstance(self.spreads, Mapping) and self.spreads
            else ('spreads must be a dict of path to text, such as {"slider.mass": "normal 0 % +- 1 %"}'),
            None if power else f"samples must be a power of two, got {self.samples!r}",
            None if 0 <= self.trim < 1 else f"trim must be a share of the speed, at least 0, got {self.trim!r}",
        )
        spreads.distributions(self.spreads)


class Sampled:
    """An output of a design over its spread."""

    def __init__(self, problem, output, spread, sign, samples=None, angles=ANGLES):
        self.problem, self.output, self.spread, self.sign = problem, output, spread, sign
        known = problem.source.units
        problems = [checks.choice("parameter", path, tuple(known)) for path in spread.spreads]
        checks.require("spread", *problems)
        self.count = spread.samples if samples is None else samples
        self.shares, self.deviations = _deviations(spread, known, self.count)
        self.names = (*problem.names, *(path for path in spread.spreads if path not in problem.names))
        if spread.trim and SPEED not in self.names:
            self.names = (*self.names, SPEED)
        scene = scene_of(problem.source)
        self.angle = np.linspace(0.0, scene.period, angles, endpoint=False)
        self.derived = Derived(problem.source, self.names)
        zeros = [path for path in self.derived.paths if scene.parameters[path] == 0.0]
        self.program = compiled(scene, output.quantity, zeros, problem.engine)
        own_values = problem.source.parameters
        self._fixed = [
            scene.parameters[name] if isinstance(own_values[name], str) else own_values[name]
            for name in self.names[len(problem.names) :]
        ]
        self._vector = (2,) if of_scene(scene)[output.quantity].vector else ()
        self._weights = _harrell_davis(spread.quantile, self.count)
        if spread.trim:
            self._require_trim()

    def __call__(self, values):
        """The quantile, and its derivatives by the numbers that vary."""
        try:
            found, slopes = self._sampled(values, True)
        except KinetostaticsError:  # a machine within the spread that cannot be built
            return np.nan, np.full(values.size, np.nan)
        order = np.argsort(found)
        return self._weights @ found[order], self._weights @ slopes[order]

    def outputs(self, values):
        """The output of each sample."""
        return self._sampled(values, False)[0]

    def _sampled(self, values, sloped):
        parts = [
            self._part(values, slice(start, min(start + TOGETHER, self.count)), sloped)
            for start in range(0, self.count, TOGETHER)
        ]
        return tuple(np.concatenate([part[place] for part in parts]) for place in (0, 1))

    def _part(self, values, part, sloped):
        """Output of some samples, with derivatives (samples, n)."""
        whole, rises = self._numbers(values, part)
        if not self.spread.trim:
            curves, slopes = self._curves(whole, rises, sloped)
            above = self._above(whole)
        else:
            curves, slopes, above = self._trimmed(whole, rises, sloped)
        found = np.empty(len(curves)), np.zeros((len(curves), len(self.problem.names)))
        for place, curve in enumerate(curves):
            own_slopes = slopes[place] if sloped else np.zeros((0, curve.size))
            value, changes = measures.reduced(self.output.reduction, measures.Curve(curve, own_slopes))
            if self.output.ratio:
                value, changes = above[place] / value, -above[place] / value**2 * changes
            found[0][place] = value
            found[1][place] = changes if sloped else 0.0
        return found

    def _numbers(self, values, part):
        """Values of all numbers of some samples (names, samples, 1), and how each rises with the design's own."""
        count = len(self.deviations[next(iter(self.deviations))][part])
        whole = np.empty((len(self.names), count, 1))
        rises = np.ones((len(self.names), count))
        for place, (name, value) in enumerate(zip(self.names, [*values, *self._fixed], strict=True)):
            deviation = self.deviations[name][part] if name in self.deviations else np.zeros(count)
            if name in self.shares:
                rises[place] = 1.0 + deviation
                whole[place, :, 0] = value * (1.0 + deviation)
            else:
                whole[place, :, 0] = value + deviation
        return whole, rises

    def _curves(self, whole, rises, sloped):
        """Values (samples, N) and derivatives (samples, n, N)."""
        numbers, changes = self.derived(whole)
        shape = whole.shape[1], self.angle.size
        values = np.broadcast_to(self.program(self.angle, numbers)[self.output.quantity], (*self._vector, *shape))
        if not sloped:
            return (np.hypot(*values) if values.ndim == 3 else values), None
        found = self.program.derivatives(self.angle, self.derived.paths, numbers)[self.output.quantity]
        count = len(self.problem.names)
        slopes = np.zeros((count, *values.shape))
        for row, part in enumerate(found.values()):
            for place in range(count):
                change = changes[row, place] * rises[place][:, None]
                if np.any(change):
                    slopes[place] += change * part
        if values.ndim == 3:
            size = np.hypot(*values)
            slopes = np.einsum("csa,ncsa->nsa", values / np.maximum(size, np.finfo(float).tiny), slopes)
            values = size
        return values, np.moveaxis(slopes, 0, 1)

    def _above(self, whole):
        """The reference's output for each sample."""
        return own(self.output).reduced(self._of_reference(whole)) if self.output.ratio else None

    def _of_reference(self, whole):
        """Curves of the reference, with those of the numbers that spread that it has too."""
        reference, quantity = scene_of(self.problem.reference), self.output.quantity
        known = [name for name in self.names if name in (*self.spread.spreads, SPEED) and name in reference.units]
        numbers = {name: whole[self.names.index(name)] for name in known}
        found = values_of(reference.varied(numbers).solve(self.angle), quantity)
        return np.broadcast_to(found, (whole.shape[1], self.angle.size))

    def _trimmed(self, whole, rises, sloped):
        """Curves at the speed within the trim that makes each sample's output best."""
        slow, fast = (self._at_speed(whole, 1.0 + side * self.spread.trim) for side in (-1.0, 1.0))
        (low, low_slopes), (high, high_slopes) = (self._curves(at, rises, sloped) for at in (slow, fast))
        below, above = (self._of_reference(at) if self.output.ratio else None for at in (slow, fast))
        reduced = own(self.output).reduced

        def outputs(share):
            found = reduced(_between(low, high, share[:, None]))
            return self.sign * (reduced(_between(below, above, share[:, None])) / found if self.output.ratio else found)

        share = _least(outputs, len(low))[:, None]
        slopes = _between(low_slopes, high_slopes, share[..., None]) if sloped else None
        compared = reduced(_between(below, above, share)) if self.output.ratio else None
        return _between(low, high, share), slopes, compared

    def _at_speed(self, whole, share):
        """Numbers of samples at a share of the design's speed."""
        found, place = whole.copy(), self.names.index(SPEED)
        found[place] = self._fixed[place - len(self.problem.names)] * share
        return found

    def _require_trim(self):
        """Refuse to trim what does not change with the square of the speed alone, which two speeds tell."""
        problem = None
        if SPEED in self.problem.names:
            problem = f"trim sets {SPEED}, so it cannot vary too"
        else:
            whole, rises = self._numbers(self.problem.start, slice(0, 1))
            squares = np.array([(1.0 - self.spread.trim) ** 2, 1.0, (1.0 + self.spread.trim) ** 2])
            low, middle, high = (
                self._curves(self._at_speed(whole, share), rises, False)[0] for share in np.sqrt(squares)
            )
            share = (1.0 - squares[0]) / (squares[2] - squares[0])
            if not np.allclose(middle, _between(low, high, share), rtol=1e-9, atol=1e-9 * np.abs(middle).max()):
                problem = (
                    f"trim takes outputs of constant parts and others that grow as the speed squared; "
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
    item, compared = chosen(source, variant, reference)
    text = wanted(output, scene_of(item))
    bare = SimpleNamespace(source=item, reference=compared, names=(), engine="numpy", start=np.empty(0))
    return Sampled(bare, text, spread, -1.0 if text.ratio else 1.0, samples).outputs(np.empty(0))


def _between(one, other, share):
    """Values between those at two speeds: inertia grows with the square of the speed, all else stays."""
    return one * (1.0 - share) + other * share


def _least(function, count):
    """Where, from 0 to 1, each of several functions is least, by the golden section."""
    low, high = np.zeros(count), np.ones(count)
    inner, outer = high - GOLDEN, low + GOLDEN
    at_inner, at_outer = function(inner), function(outer)
    for _ in range(NARROWED):
        left = at_inner < at_outer
        high, low = np.where(left, outer, high), np.where(left, low, inner)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        value = function(new)
        inner, outer = np.where(left, new, outer), np.where(left, inner, new)
        at_inner, at_outer = np.where(left, value, at_outer), np.where(left, at_inner, value)
    return np.where(at_inner < at_outer, inner, outer)


def _deviations(spread, known, count):
    """Which numbers deviate in shares of their own value, and deviations (count,) of each."""
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


def _harrell_davis(quantile, count):
    """Weights of the ordered samples in a quantile."""
    from scipy.special import betainc

    first, second = (count + 1) * quantile, (count + 1) * (1.0 - quantile)
    return np.diff(betainc(first, second, np.linspace(0.0, 1.0, count + 1)))
