"""Reductions over the turn: one number for each design from the values of a quantity at evenly spaced crank angles.

Written as text, the reduction before the quantity: "largest O", "mean_absolute balancing_torque",
"harmonic_2 balancing_torque", "ratio mean_absolute balancing_torque".
"""

import re
from dataclasses import dataclass

import numpy as np

from . import checks
from .errors import ParameterError
from .quantities import label, unit


def _peak(values):
    """Largest value and its place in samples, by the parabola through the largest sample and its neighbours."""
    rows, count = np.arange(len(values)), values.shape[-1]
    top = np.argmax(values, axis=-1)
    before, here, after = (values[rows, (top + k) % count] for k in (-1, 0, 1))
    bend = before - 2.0 * here + after
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.where(bend < 0, 0.5 * (before - after) / bend, 0.0)
    return here - 0.25 * (before - after) * shift, 2 * np.pi * ((top + shift) % count) / count


def _harmonic(order):
    def amplitude(values):
        turn = np.exp(-2j * np.pi * order * np.arange(values.shape[-1]) / values.shape[-1])
        return abs(values @ turn) * ((1.0 if order == 0 else 2.0) / values.shape[-1])

    return amplitude


REDUCTIONS = {
    "largest": lambda values: _peak(values)[0],
    "largest_at": lambda values: _peak(values)[1],
    "smallest": lambda values: -_peak(-values)[0],
    "smallest_at": lambda values: _peak(-values)[1],
    "range": lambda values: _peak(values)[0] + _peak(-values)[0],
    "mean": lambda values: values.mean(axis=-1),
    "mean_absolute": lambda values: abs(values).mean(axis=-1),
    "rms": lambda values: np.sqrt(np.einsum("dn,dn->d", values, values) / values.shape[-1]),
}
"""By name: function of values (designs, N) at crank angles evenly over the turn; extremes are found between them."""


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
    """

    quantity: str
    reduction: str
    ratio: bool = False

    def __str__(self):
        return f"{'ratio ' * self.ratio}{self.reduction} {self.quantity}"

    @property
    def column(self):
        """Heading with unit."""
        if self.ratio:
            return f"{self} [1]"
        return f"{self} [{'rad' if self.reduction.endswith('_at') else unit(self.quantity)}]"

    @property
    def label(self):
        """What an axis calls it."""
        return f"{'ratio of ' * self.ratio}{self.reduction.replace('_', ' ')} {label(self.quantity)}"

    def reduced(self, values):
        """Numbers (designs,) from values (designs, N); NaN where a value is."""
        harmonic = re.fullmatch(r"harmonic_(\d+)", self.reduction)
        return (_harmonic(int(harmonic[1])) if harmonic else REDUCTIONS[self.reduction])(values)


def parsed(text) -> Output:
    """Output from its text.

    Raises
    ------
    ParameterError
        The text names no reduction and quantity; the message lists the reductions.
    """
    if isinstance(text, Output):
        return text
    *first, reduction, quantity = ["", "", *str(text).split()]
    known = reduction in REDUCTIONS or re.fullmatch(r"harmonic_\d+", reduction)
    first = [word for word in first if word]
    if first not in ([], ["ratio"]) or not known:
        names = ", ".join((*REDUCTIONS, "harmonic_1", "harmonic_2 ..."))
        hint = checks.hint(reduction, REDUCTIONS)
        raise ParameterError(
            f'output {text!r} must be a reduction and a quantity, such as "largest O" or "ratio mean_absolute '
            f'balancing_torque"; reductions: {names}{hint}'
        )
    return Output(quantity, reduction, bool(first))
