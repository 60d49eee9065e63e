"""Reductions over the turn: one number for each design from the values of a quantity at evenly spaced crank angles.

Written as text, the reduction before the quantity: "largest O", "mean_absolute balancing_torque",
"harmonic_2 balancing_torque", "ratio mean_absolute balancing_torque".

"swing balancing_torque" is the energy, J, that a flywheel takes up and gives back while the crank gets the mean of the
torque: the range of the integral of torque less mean over the crank angle. For a coefficient of fluctuation delta the
flywheel is nearly swing / (delta omega^2), as textbooks have it (`drive.flywheel`).
"""

import math
import re
import threading
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import polynomial

from ..errors import ParameterError
from ..mechanics.quantities import quantity
from ..numbers import checks
from ..numbers.headings import heading

REACH = 4
"""Samples on either side of a peak that tell how high it is between them."""
PEAK = 1e-4
"""Error of a peak, relative to it, from which so many samples do not tell it; or a hundredth of that of the range."""
MEAN = 1e-2
"""Error of a mean, relative to it, from which so many samples do not tell it; and a tenth of that of the peak."""
PEAKS = ("largest", "largest_at", "smallest", "smallest_at", "largest_absolute", "range")
OVER_THE_ANGLE = ("largest_at", "smallest_at", "swing")
"""Reductions that are as many times as large where the same values come over several turns."""
SCRATCH = 2**18
"""Bytes of memory for short use that each thread keeps."""
TINY = np.finfo(float).tiny
_own = threading.local()
_AROUND = np.arange(-REACH, REACH + 1)
_POWERS = np.arange(_AROUND.size)[:, None]
INNER = polynomial.Polynomial.fromroots(_AROUND[1:-1])
THROUGH = np.linalg.inv(np.vander(_AROUND.astype(float), increasing=True))


def _peak(values, sign=1.0):
    """Largest value, times a sign, of each design: of all peaks of the samples the highest between them.

    Also where it is, in periods, and about how much it may be wrong.
    """
    count = values.shape[-1]
    tops = [first * count + _tops(some, sign) for first, some in _pieces(values, 2)]
    design, place = np.divmod(np.concatenate(tops), count)
    if count < _AROUND.size:
        height, shift = sign * values[design, place], 0.0 * place
        error = height
    else:
        rivals = _rivals(sign * _around(values, design, place, 1), design, len(values))
        design, place = design[rivals], place[rivals]
        height, shift, error = _between(sign * _around(values, design, place, REACH))
    highest = _highest(height, design, len(values))
    _, first = np.unique(np.where(height < highest[design], -1, design), return_index=True)
    first = first[-len(values) :]
    where = ((place + shift)[first] % count) / count
    return highest, np.where(np.isnan(highest), np.nan, where), _highest(error, design, len(values))


def _tops(values, sign):
    """Places of samples higher than the one before and not lower than the one behind, or the first highest of all."""
    higher, highest = (np.greater, np.argmax) if sign > 0 else (np.less, np.argmin)
    rising, tops = _scratch(bool, 2, *values.shape)
    higher(values[:, 1:], values[:, :-1], out=rising[:, 1:])
    higher(values[:, 0], values[:, -1], out=rising[:, 0])
    np.greater(rising[:, :-1], rising[:, 1:], out=tops[:, :-1])
    np.greater(rising[:, -1], rising[:, 0], out=tops[:, -1])
    tops[np.arange(len(values)), highest(values, axis=-1)] = True
    return np.flatnonzero(tops)


def _around(values, design, place, reach):
    return values[design, (place + np.arange(-reach, reach + 1)[:, None]) % values.shape[-1]]


def _rivals(near, design, count):
    """Which peaks may be the highest of a design; one rises above its sample by less than that above its neighbours."""
    before, here, after = near
    bend = abs(before - 2.0 * here + after)
    return ~(here + bend < _highest(here - bend, design, count)[design])


def _highest(height, design, count):
    """Highest of the peaks of each design, which stand one design after the other."""
    return np.maximum.reduceat(height, np.searchsorted(design, np.arange(count)))


def _between(near):
    """Height of each peak, and how far from its highest sample, from the samples around it (places, peaks).

    By the polynomial through all of them, by the parabola through three if others spoil it, as beyond a jump, and that
    of the sample if not even three go together. What does not change its sign may be a magnitude, which has a corner at
    zero, but its square has none. About how much the height may be wrong is what two samples less make of it.
    """
    sign = np.where((near >= 0).all(axis=0), 1.0, np.where((near <= 0).all(axis=0), -1.0, 0.0))
    curve = np.where(sign == 0, near, near * abs(near))
    _, bend, _ = bends = np.diff(curve[REACH - 2 : REACH + 3], 2, axis=0)
    before, here, after = curve[REACH - 1 : REACH + 2]
    with np.errstate(all="ignore"):
        shift = 0.5 * (before - after) / bend
        height = here - 0.25 * (before - after) * shift
        series = sum(weights[:, None] * sample for weights, sample in zip(THROUGH.T, curve, strict=True))
        slope = series[1:] * _POWERS[1:]
        change = slope[1:] * _POWERS[1:-1]
        place = shift
        for _ in range(2):
            place = place - polynomial.polyval(place, slope, tensor=False) / polynomial.polyval(place, change, False)
        top = polynomial.polyval(place, series, tensor=False)
        fits = (abs(top - height) < 0.05 * abs(bend)) & (abs(place) < 1)
        fewer = top - INNER(place) * (series[-2] + series[-1] * place)
    smooth = (bends < 0).all(axis=0)
    other = np.where(smooth, np.where(fits, fewer, top), here + abs(bend))
    found = np.where(smooth, np.where(fits, top, height), here)
    height = np.where(sign == 0, found, sign * np.sqrt(np.maximum(sign * found, 0.0)))
    error = abs(found - other)
    error = np.where(sign == 0, error, error / np.maximum(np.maximum(abs(height), np.sqrt(error)), TINY))
    return height, np.where(smooth, np.where(fits, place, shift), 0.0), error


def lowest(values, step):
    """Smallest of values (designs, N) a step apart, between them; how far it is from the middle one; the bend there.

    The bend is the second derivative.
    """
    row, reach = np.arange(len(values)), values.shape[-1] // 2
    place = np.clip(values.argmin(axis=-1), REACH, values.shape[-1] - 1 - REACH)
    near = values[row, place + _AROUND[:, None]]
    bend = (near[REACH - 1] - 2.0 * near[REACH] + near[REACH + 1]) / (step * step)
    height, shift, _ = _between(1.0 - near)  # no margin exceeds 1, so that none of these changes its sign
    return np.minimum(1.0 - height, near.min(axis=0)), (place + shift - reach) * step, bend


def _mean(values):
    """Mean of each design, and how far that of every other sample is from it."""
    found = values.mean(axis=-1)
    return found, np.abs(values[:, ::2].mean(axis=-1) - found) * (values.shape[-1] % 2 == 0)


def _mean_absolute(values):
    """Mean of magnitudes of each design, and how far that of every other sample is from it."""
    found, error = np.empty((2, len(values)))
    for first, some in _pieces(values, 8):
        size, designs = np.abs(some, out=_scratch(float, *some.shape)), slice(first, first + len(some))
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


def _pieces(values, size):
    """Number of the first design, and values, of some designs at a time that take one scratch at that size a value."""
    step = max(1, SCRATCH // (size * values.shape[-1]))
    return [(first, values[first : first + step]) for first in range(0, len(values), step)]


def _scratch(kind, *shape):
    """Memory for what is soon forgotten, the same each time: to get new one may take longer than to use it."""
    size = math.prod(shape) * np.dtype(kind).itemsize
    if size > SCRATCH:
        return np.empty(shape, kind)
    if not hasattr(_own, "scratch"):
        _own.scratch = np.empty(SCRATCH, np.uint8)
    return _own.scratch[:size].view(kind).reshape(shape)


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
        return _peak(integral)[0] + _peak(integral, -1.0)[0]

    found = swing(values)
    return found, np.abs(swing(values[:, ::2]) - found) * (values.shape[-1] % 2 == 0)


def _highest_at(sign):
    def place(values):
        highest, where, error = _peak(values, sign)
        return 2 * np.pi * where, np.where(error > PEAK * np.abs(highest), np.inf, 0.0)

    return place


def _largest(values):
    highest, _, error = _peak(values)
    return highest, error


def _smallest(values):
    lowest, _, error = _peak(values, -1.0)
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
        with np.errstate(invalid="ignore"):
            rough = error > (MEAN if mean else PEAK) * np.abs(found)
        if rough.any():
            some = values[rough]
            size = np.abs(some).max(axis=-1) if mean else np.ptp(some, axis=-1)
            rough[rough] = error[rough] > (MEAN / 10 if mean else PEAK / 100) * size
        return found * turns if self.reduction in OVER_THE_ANGLE else found, rough


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
    raise ParameterError(
        f'output {text!r} must be a reduction and a quantity, such as "largest O" or "ratio mean_absolute '
        f'balancing_torque"; reductions: {names}{"" if reduction in FOUND else checks.hint(reduction, FOUND)}'
    )
