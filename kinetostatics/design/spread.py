"""How numbers of a design spread, and by which quantile it is judged: samples and their weights.

The samples are a scrambled Sobol sequence, the same whatever the design. The quantile is Harrell and Davis's mean of
ordered samples (1982), which changes smoothly with the design.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..errors import ParameterError
from ..numbers import checks, spreads
from ..numbers.units import base_factor, factor

MOST_SAMPLES = 2**20


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
        checks.require(
            "spread",
            None
            if isinstance(self.quantile, float) and 0 < self.quantile < 1
            else (f"quantile must lie between 0 and 1, got {self.quantile!r}"),
            None
            if isinstance(self.spreads, Mapping) and self.spreads
            else ('spreads must be a dict of path to text, such as {"slider.mass": "normal 0 % +- 1 %"}'),
            samples_problem(self.samples),
            checks.single("trim", self.trim, low=0.0, high=1.0)[1],
            checks.seed("seed", self.seed),
        )
        spreads.distributions(self.spreads)


def samples_problem(samples):
    """What is wrong with a number of samples, as a sentence, or None."""
    whole = isinstance(samples, int) and 1 < samples <= MOST_SAMPLES
    if whole and not samples & (samples - 1):
        return None
    return f"samples must be a power of two, up to {MOST_SAMPLES}, got {checks.shown(samples)}"


def not_spread(name, value):
    """What is wrong with what must be a `Spread`, or None."""
    if isinstance(value, Spread):
        return None
    return f'{name} must be a Spread, as ks.design.Spread(0.05, {{"slider.mass": ...}}), got {checks.shown(value)}'


def deviations(spread, known, count):
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


def harrell_davis(quantile, count):
    """Weights of the ordered samples in a quantile."""
    from scipy.special import betainc

    first, second = (count + 1) * quantile, (count + 1) * (1.0 - quantile)
    return np.diff(betainc(first, second, np.linspace(0.0, 1.0, count + 1)))
