"""Reductions: one number for each design from the values of a quantity at evenly spaced crank angles of the turn.

As text the reduction precedes the quantity: "largest O", "mean_absolute balancing_torque",
"harmonic_2 balancing_torque", "ratio mean_absolute balancing_torque".

"swing balancing_torque" is the energy, J, that a flywheel stores and returns if the crank gets the mean torque. It is
the range of the integral of torque less its mean over the crank angle. For a coefficient of fluctuation delta, the
textbook flywheel is nearly swing / (delta omega^2) (`drive.flywheel`).
"""

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..errors import HintWarning, ParameterError
from ..mechanics.quantities import quantity
from ..numbers import checks
from ..numbers.formatting import heading
from .peaks import blocks, peak, scratch

PEAK_TOLERANCE = 1e-4
"""Largest error of a peak relative to the peak; relative to the range a hundredth of this. More samples if larger."""
MEAN_TOLERANCE = 1e-2
"""Largest error of a mean relative to the mean; relative to the peak a tenth of this. More samples if larger."""
SOLUTION_ANGLES = 360
"""Number of crank angles of solutions for functions; it does not affect their numbers."""
PEAKS = ("largest", "largest_at", "smallest", "smallest_at", "largest_absolute", "range")
OVER_THE_ANGLE = ("largest_at", "smallest_at", "swing")
"""Reductions in proportion to the number of turns with the same values."""


def signs(reduction):
    """Signs with which a peak is the highest value."""
    return {"largest": (1.0,), "smallest": (-1.0,)}.get(reduction.removesuffix("_at"), (1.0, -1.0))


def combined_peaks(reduction, heights):
    """Number of a reduction from the peaks of `signs(reduction)`."""
    if reduction == "range":
        return heights[0] - heights[1]
    return np.maximum(heights[0], -heights[-1]) if reduction == "largest_absolute" else heights[0]


def _peaks(reduction, values):
    heights, where, errors = zip(*(peak(values, sign) for sign in signs(reduction)), strict=True)
    error = np.max(errors, axis=0)
    if reduction in OVER_THE_ANGLE:
        return 2 * np.pi * where[0], np.where(error > PEAK_TOLERANCE * np.abs(heights[0]), np.inf, 0.0)
    signed = [sign * height for sign, height in zip(signs(reduction), heights, strict=True)]
    return combined_peaks(reduction, signed), error


def _mean_absolute(values):
    found = np.empty(len(values))
    for first, some in blocks(values, 8):
        size = np.abs(some, out=scratch(float, *some.shape))
        found[first : first + len(some)] = size.mean(axis=-1) - _kink_excess(some)
    return found


def _kink_excess(values):
    """Excess of the mean magnitude of samples over the integral mean, from its kinks where the sign changes.

    By the Euler-Maclaurin formula, with a straight line between the samples on both sides of each change.
    """
    below = values < 0.0
    changed = np.empty(values.shape, bool)
    np.not_equal(below[:, 1:], below[:, :-1], out=changed[:, :-1])
    np.not_equal(below[:, 0], below[:, -1], out=changed[:, -1])
    design, place = np.divmod(np.flatnonzero(changed), values.shape[-1])
    here, there = np.abs(values[design, place]), np.abs(values[design, place + 1 - values.shape[-1]])
    both = here + there
    return np.bincount(design, here * there / both - both / 6.0, len(values)) / values.shape[-1]


def _harmonic(order, values):
    angle = 2 * np.pi * order * np.arange(values.shape[-1]) / values.shape[-1]
    parts = (np.einsum("dn,n->d", values, wave(angle)) for wave in (np.cos, np.sin))
    return np.hypot(*parts) * ((1.0 if order == 0 else 2.0) / values.shape[-1])


def gained(values):
    """Integral over the crank angle, rad, of values less their mean, at the same angles of one turn.

    It uses Fourier series: exact for the harmonics that the samples resolve, linear in the values.
    """
    count = values.shape[-1]
    series = np.fft.rfft(values)
    orders = np.arange(series.shape[-1])
    orders[0] = 1
    series = series / (1j * orders)
    series[..., :: count // 2 if count % 2 == 0 else count] = 0.0  # mean, and the highest harmonic, known by sign only
    return np.fft.irfft(series, count)


def _swing(values):
    integral = gained(values)
    return peak(integral)[0] + peak(integral, -1.0)[0]


MEANS: dict[str, Callable] = {
    "mean": partial(np.mean, axis=-1),
    "mean_absolute": _mean_absolute,
    "rms": lambda values: np.sqrt(np.einsum("dn,dn->d", values, values) / values.shape[-1]),
    "swing": _swing,
}
"""By name: function of values (designs, N) evenly over the period to numbers."""
REDUCTIONS = (*PEAKS, *MEANS)
"""Names of reductions except harmonics."""


@dataclass(frozen=True)
class Output:
    """One column of a sweep.

    Attributes
    ----------
    quantity : str
        As for `quantities.components`; a vector is reduced by its magnitude.
    reduction : str
        A name of `REDUCTIONS`, or "harmonic_K": amplitude of the K-th harmonic of the crank angle.
    ratio : bool
        True for the ratio of the reference mechanism's value to the design's: a dynamic coefficient.
    unit : str
        SI unit of the number; empty before `of`.
    """

    quantity: str
    reduction: str
    ratio: bool = False
    unit: str = ""

    def __str__(self):
        return f"{'ratio ' * self.ratio}{self.reduction} {self.quantity}"

    def of(self, scene) -> "Output":
        """The output with the unit of its quantity in a scene, or another object with a mechanism.

        Raises
        ------
        QuantityError
            The quantity is unknown; the message lists those of the mechanism.
        ParameterError
            The quantity is a force that grows without bound at passed change points; or the swing
            is not that of a torque.
        """
        unit, mechanism = quantity(scene, self.quantity).unit, scene.mechanism
        if self.reduction == "swing":
            if unit != "N m":
                raise ParameterError(
                    f"output {str(self)!r}: swing is the energy that a torque exchanges, for a quantity "
                    f"in N m such as balancing_torque; {self.quantity} is in {unit}"
                )
            unit = "J"
        if mechanism.grows(self.quantity):
            raise ParameterError(
                f"output {str(self)!r}: {self.quantity} grows as one over the distance from change points that "
                f"{mechanism.name} passes, so it has no mean and no largest value; ks.extremes gives the angles"
            )
        return replace(self, unit=unit)

    @property
    def column(self):
        """Heading with unit."""
        own = "rad" if self.reduction.endswith("_at") else self.unit
        measure = "1" if self.ratio else own
        return heading(self, measure) if measure else str(self)

    def label(self, scene):
        """Label of an axis, for a scene or another object with a mechanism."""
        return f"{'ratio of ' * self.ratio}{self.reduction.replace('_', ' ')} {quantity(scene, self.quantity).label}"

    @property
    def order(self):
        """Order of the harmonic; None for any other reduction."""
        found = re.fullmatch(r"harmonic_(\d+)", self.reduction)
        return int(found[1]) if found else None

    def reduced(self, values, turns=1):
        """Numbers (designs,) from values (designs, N) evenly over some turns; NaN where a value is."""
        if self.reduction in PEAKS:
            return self.with_errors(values, turns)[0]
        order = self.order
        found = MEANS[self.reduction](values) if order is None else _harmonic(order * turns, values)
        return found * turns if self.reduction in OVER_THE_ANGLE else found

    def with_errors(self, values, turns=1):
        """Numbers as of `reduced`, and error estimates; of a mean the difference from that of every other value."""
        if self.reduction in PEAKS:
            found, error = _peaks(self.reduction, values)
            return found * turns if self.reduction in OVER_THE_ANGLE else found, error
        found, resolves = self.reduced(values, turns), values.shape[-1] % 2 == 0 or self.order is not None
        return found, np.abs(self.reduced(values[:, ::2], turns) - found) * resolves

    def estimated(self, values, turns=1):
        """Numbers as of `reduced`, and whether the samples are too few."""
        found, error = self.with_errors(values, turns)
        if self.reduction in PEAKS:
            return found, is_rough(self, found, error, lambda rough: np.ptp(values[rough], axis=-1))
        return found, is_rough(self, found, error, lambda rough: np.abs(values[rough]).max(axis=-1))


@dataclass(frozen=True)
class SolutionNumber:
    """A function's number for the solution of each design: an output of `sweep` and `design.optimise`.

    Attributes
    ----------
    name : str
        Heading without the unit; goals and limits use this name.
    function : function
        From a `Solution` to a float; several workers need one that can be pickled.
    unit : str
        SI, or another unit of the function's number, such as "h".
    ratio : bool
        True for the ratio of the reference mechanism's number to the design's.

    Examples
    --------
    The energy of a turn under a motor, with the slip of its rotor, and the flywheel that makes it least:

    >>> import kinetostatics as ks
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> def mains(solution):
    ...     return ks.drive.steady(ks.Scene.of(solution), motor).air_gap_energy_per_turn
    >>> number = ks.design.SolutionNumber("mains energy", mains, "J")
    >>> crank = ks.crank_slider(0.05, 0.2, crank=ks.Link(1.0, inertia=0.1), slider=ks.Link(1.0))
    >>> pump = ks.Scene(crank, 100.0, loads=ks.ProcessForce(ks.Table([0.1, 0.3], [-200.0, -200.0], over="travel")))
    >>> found = ks.design.optimise(pump, {"crank.inertia": (0.05, 0.5)}, "mains energy", numbers=[number])
    >>> found.report().index.to_list()
    ['mains energy [J]']
    """

    name: str
    function: Callable
    unit: str
    ratio: bool = False

    def __str__(self):
        return f"{'ratio ' * self.ratio}{self.name}"

    @property
    def column(self):
        """Heading with unit."""
        return heading(self, "1" if self.ratio else self.unit)

    def label(self, scene):
        """Label of an axis."""
        return f"{'ratio of ' * self.ratio}{self.name}"

    def of(self, scene) -> "SolutionNumber":
        """The output itself; the function defines its unit."""
        return self

    def value(self, scene, reference=None):
        """Number of a scene; or the ratio of the reference's number to it. Notes of the function are not shown."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", HintWarning)
            found = float(self.function(scene.solve(SOLUTION_ANGLES)))
        return replace(self, ratio=False).value(reference) / found if self.ratio else found


def is_rough(output, found, error, size):
    """Whether the error of an output exceeds `PEAK_TOLERANCE` or `MEAN_TOLERANCE`, by design.

    ``size(rough)`` returns the range of the values of those designs for a peak, their largest size for a mean.
    """
    is_peak = output.reduction in PEAKS
    share, least = (PEAK_TOLERANCE, PEAK_TOLERANCE / 100) if is_peak else (MEAN_TOLERANCE, MEAN_TOLERANCE / 10)
    with np.errstate(invalid="ignore"):
        rough = error > share * np.abs(found)
    if rough.any():
        rough[rough] = error[rough] > least * size(rough)
    return rough


def parsed(text, parts=None) -> Output | SolutionNumber:
    """Output from its text.

    Parameters
    ----------
    text : str
        "largest O", or "main_bearing.life_hours" where `parts` has the part "main_bearing".
    parts : mapping of name to part or number, optional
        Parts to be sized, as `sizing.Part`; a `SolutionNumber` by its name.

    Raises
    ------
    ParameterError
        The text is not a reduction and a quantity (the message lists the reductions), or the part lacks the number.
    """
    if isinstance(text, Output | SolutionNumber):
        return text
    words = str(text).split()
    ratio = words[:1] == ["ratio"]
    own = (parts or {}).get(" ".join(words[ratio:]))
    if isinstance(own, SolutionNumber):
        return replace(own, ratio=ratio)
    part, point, number = "".join(words[ratio:]).partition(".")
    if point and parts and len(words) == 1 + ratio:
        checks.require(f"output {text!r}", checks.choice("part", part, tuple(parts)))
        return parts[part].number(number, ratio)
    reduction, *quantity = words[ratio:] or [""]
    found = Output(" ".join(quantity), reduction, ratio)
    if quantity and (reduction in REDUCTIONS or found.order is not None):
        return found
    names = ", ".join((*REDUCTIONS, "harmonic_1", "harmonic_2 ..."))
    allowed = *REDUCTIONS, "mean balancing_torque"
    meant = None if reduction in REDUCTIONS else checks.nearest(reduction, allowed)
    advice = f"; did you mean {' '.join([*words[:ratio], meant, *quantity])!r}?" if meant else ""
    raise ParameterError(
        f'output {text!r} must be a reduction and a quantity, such as "largest O" or "ratio mean_absolute '
        f'balancing_torque"; reductions: {names}{advice}'
    )
