"""Reductions over the turn: one number for each design from the values of a quantity at evenly spaced crank angles.

Written as text, the reduction before the quantity: "largest O", "mean_absolute balancing_torque",
"harmonic_2 balancing_torque", "ratio mean_absolute balancing_torque".

"swing balancing_torque" is the energy, J, that a flywheel takes up and gives back while the crank gets the mean of the
torque: the range of the integral of torque less mean over the crank angle. For a coefficient of fluctuation delta the
flywheel is nearly swing / (delta omega^2), as textbooks have it (`drive.flywheel`).
"""

import re
from dataclasses import dataclass, replace

import numpy as np

from ..errors import ParameterError
from ..mechanics.quantities import quantity
from ..numbers import checks
from ..numbers.formatting import heading
from .peaks import peak, pieces, scratch

PEAK = 1e-4
"""Error of a peak, relative to it, from which so many samples do not tell it; or a hundredth of that of the range."""
MEAN = 1e-2
"""Error of a mean, relative to it, from which so many samples do not tell it; and a tenth of that of the peak."""
PEAKS = ("largest", "largest_at", "smallest", "smallest_at", "largest_absolute", "range")
OVER_THE_ANGLE = ("largest_at", "smallest_at", "swing")
"""Reductions that are as many times as large where the same values come over several turns."""


def _mean(values):
    """Mean of each design, and how far that of every other sample is from it."""
    found = values.mean(axis=-1)
    return found, np.abs(values[:, ::2].mean(axis=-1) - found) * (values.shape[-1] % 2 == 0)


def _mean_absolute(values):
    """Mean of magnitudes of each design, and how far that of every other sample is from it."""
    found, error = np.empty((2, len(values)))
    for first, some in pieces(values, 8):
        size, designs = np.abs(some, out=scratch(float, *some.shape)), slice(first, first + len(some))
        found[designs] = size.mean(axis=-1) - _kinks(some)
        error[designs] = size[:, ::2].mean(axis=-1) - _kinks(some[:, ::2]) - found[designs]
    return found, np.abs(error) * (values.shape[-1] % 2 == 0)


def _kinks(values):
    """What the mean magnitude of samples is too large by, as the magnitude has a kink where the sign changes.

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


def _harmonic(order):
    def amplitude(values):
        angle = 2 * np.pi * order * np.arange(values.shape[-1]) / values.shape[-1]
        parts = (np.einsum("dn,n->d", values, wave(angle)) for wave in (np.cos, np.sin))
        return np.hypot(*parts) * ((1.0 if order == 0 else 2.0) / values.shape[-1])

    return lambda values: (amplitude(values), np.abs(amplitude(values[:, ::2]) - amplitude(values)))


def _rms(values):
    def size(some):
        return np.sqrt(np.einsum("dn,dn->d", some, some) / some.shape[-1])

    found = size(values)
    return found, np.abs(size(values[:, ::2]) - found) * (values.shape[-1] % 2 == 0)


def gained(values):
    """Integral over the crank angle, in rad over one turn, of values less their mean, at the same angles.

    By their Fourier series: exact for what so many values tell, linear in them.
    """
    count = values.shape[-1]
    series = np.fft.rfft(values)
    orders = np.arange(series.shape[-1])
    orders[0] = 1
    series = series / (1j * orders)
    series[..., :: count // 2 if count % 2 == 0 else count] = 0.0  # the mean, and what is told of by its sign alone
    return np.fft.irfft(series, count)


def _swing(values):
    """Range of the integral of values less their mean, and how far that of every other value is from it."""

    def swing(some):
        integral = gained(some)
        return peak(integral)[0] + peak(integral, -1.0)[0]

    found = swing(values)
    return found, np.abs(swing(values[:, ::2]) - found) * (values.shape[-1] % 2 == 0)


def _highest_at(sign):
    def place(values):
        highest, where, error = peak(values, sign)
        return 2 * np.pi * where, np.where(error > PEAK * np.abs(highest), np.inf, 0.0)

    return place


def _largest(values):
    highest, _, error = peak(values)
    return highest, error


def _smallest(values):
    lowest, _, error = peak(values, -1.0)
    return -lowest, error


def _both(joined):
    def found(values):
        (high, above), (low, below) = _largest(values), _smallest(values)
        return joined(high, low), np.maximum(above, below)

    return found


FOUND = {
    "largest": _largest,
    "largest_at": _highest_at(1.0),
    "smallest": _smallest,
    "smallest_at": _highest_at(-1.0),
    "largest_absolute": _both(lambda high, low: np.maximum(high, -low)),
    "range": _both(np.subtract),
    "mean": _mean,
    "mean_absolute": _mean_absolute,
    "rms": _rms,
    "swing": _swing,
}
"""By name: function of values (designs, N) evenly over the period to numbers and about how much they may be wrong."""


def _alone(estimated):
    return lambda values: estimated(values)[0]


REDUCTIONS = {name: _alone(estimated) for name, estimated in FOUND.items()}
"""By name: function of values (designs, N) evenly over a turn; extremes are found between them, places in turns."""


@dataclass(frozen=True)
class Output:
    """One column of a sweep.

    Attributes
    ----------
    quantity : str
        As for `quantities.components`; of a vector the magnitude is reduced.
    reduction : str
        A name of `REDUCTIONS`, or "harmonic_K": amplitude of the K-th harmonic of the crank angle.
    ratio : bool
        Whether the reference mechanism's value is divided by the design's: a dynamic coefficient.
    unit : str
        SI unit of the number; empty until it is told of a mechanism, by `of`.
    """

    quantity: str
    reduction: str
    ratio: bool = False
    unit: str = ""

    def __str__(self):
        return f"{'ratio ' * self.ratio}{self.reduction} {self.quantity}"

    def of(self, scene) -> "Output":
        """The output with the unit that its quantity has in a scene, or whatever has a mechanism.

        Raises
        ------
        QuantityError
            The mechanism has no such quantity; the message lists those it has.
        ParameterError
            It is of a force that grows without bound at change points that the mechanism passes; or the swing of
            something else than a torque.
        """
        unit, mechanism = quantity(scene, self.quantity).unit, scene.mechanism
        if self.reduction == "swing":
            if unit != "N m":
                raise ParameterError(
                    f"output {str(self)!r}: swing is the energy that a torque gives and takes in turn, of a quantity "
                    f"in N m such as balancing_torque; {self.quantity} is in {unit}"
                )
            unit = "J"
        if mechanism.grows(self.quantity):
            raise ParameterError(
                f"output {str(self)!r}: {self.quantity} grows as one over the distance from change points that "
                f"{mechanism.name} passes, so it has no mean and no largest value; ks.extremes tells where"
            )
        return replace(self, unit=unit)

    @property
    def column(self):
        """Heading with unit."""
        own = "rad" if self.reduction.endswith("_at") else self.unit
        measure = "1" if self.ratio else own
        return heading(self, measure) if measure else str(self)

    def label(self, scene):
        """What an axis calls it, in a scene or whatever has a mechanism."""
        return f"{'ratio of ' * self.ratio}{self.reduction.replace('_', ' ')} {quantity(scene, self.quantity).label}"

    @property
    def order(self):
        """Order of the harmonic; None for any other reduction."""
        found = re.fullmatch(r"harmonic_(\d+)", self.reduction)
        return int(found[1]) if found else None

    def reduced(self, values):
        """Numbers (designs,) from values (designs, N) evenly over a turn; NaN where a value is."""
        return self.estimated(values)[0]

    def estimated(self, values, turns=1):
        """Numbers (designs,) from values (designs, N) evenly over some turns, and whether so many do not tell them."""
        found, error = FOUND[self.reduction](values) if self.order is None else _harmonic(self.order * turns)(values)
        mean = self.reduction not in PEAKS

        def size(rough):
            return np.abs(values[rough]).max(axis=-1) if mean else np.ptp(values[rough], axis=-1)

        rough = is_rough(self, found, error, size)
        return found * turns if self.reduction in OVER_THE_ANGLE else found, rough


def is_rough(output, found, error, size):
    """Whether an output may be wrong by more than `PEAK` or `MEAN` allows, of each design.

    ``size(rough)`` gives by how much values of those designs differ, or of a mean how large they are.
    """
    share, least = (PEAK, PEAK / 100) if output.reduction in PEAKS else (MEAN, MEAN / 10)
    with np.errstate(invalid="ignore"):
        rough = error > share * np.abs(found)
    if rough.any():
        rough[rough] = error[rough] > least * size(rough)
    return rough


def parsed(text) -> Output:
    """Output from its text.

    Raises
    ------
    ParameterError
        The text names no reduction and quantity; the message lists the reductions.
    """
    if isinstance(text, Output):
        return text
    words = str(text).split()
    ratio = words[:1] == ["ratio"]
    reduction, *quantity = words[ratio:] or [""]
    found = Output(" ".join(quantity), reduction, ratio)
    if quantity and (reduction in FOUND or found.order is not None):
        return found
    names = ", ".join((*FOUND, "harmonic_1", "harmonic_2 ..."))
    meant = None if reduction in FOUND else checks.nearest(reduction, FOUND)
    advice = f"; did you mean {' '.join([*words[:ratio], meant, *quantity])!r}?" if meant else ""
    raise ParameterError(
        f'output {text!r} must be a reduction and a quantity, such as "largest O" or "ratio mean_absolute '
        f'balancing_torque"; reductions: {names}{advice}'
    )
