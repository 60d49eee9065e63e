"""Where uncertainties to first order say too little: beside them stand what second differences leave out."""

from typing import Any, NamedTuple

import numpy as np

SMALL = 0.1
"""Part of an uncertainty to first order that the second order may be."""
TYPICAL = 0.01
"""Part of the median over the crank angles that is not small beside a first order that vanishes at some."""


class Beyond(NamedTuple):
    """Where the second order is not small beside the first.

    Attributes
    ----------
    values, of : int
        How many values, of how many.
    angle : float
        Crank angle where it is worst, rad.
    path : str
        Of the input that makes most of the second order there.
    first, second : float
        What both orders make there; the second is NaN where there is no value with that input larger or smaller.
    """

    values: int
    of: int
    angle: float
    path: str
    first: float
    second: float

    def told(self, quantity, unit, inputs):
        """What must be said of it, as a sentence."""
        found = f"with {self.path} {inputs[self.path]:.3g} larger or smaller there is no value"
        if np.isfinite(self.second):
            found = f"the first makes {self.first:.2g} {unit}, the second {self.second:.2g}, most of it of {self.path}"
        return (
            f"the uncertainty of {quantity} is of first order in the inputs, which says too little at {self.values} of "
            f"{self.of} crank angles: at {np.degrees(self.angle):.9g} deg {found}; vary the inputs there, as "
            "ks.tolerances does"
        )


def seconds(run, leaves, places, deviations):
    """Second-order term of each input, by path: half of the second difference over plus and minus its deviation.

    Parameters
    ----------
    run : function
        ``run(leaves)``: values (components, *shape).
    leaves : Leaves
    places : dict of path to int
        Which leaf each input is.
    deviations : dict of path to float
    """
    plain, found = run(leaves), {}
    with np.errstate(invalid="ignore", over="ignore"):
        for path, place in places.items():
            high, low = (run(_with(leaves, place, sign * deviations[path])) for sign in (1.0, -1.0))
            found[path] = np.where(np.isnan(plain), 0.0, 0.5 * np.abs((high - plain) + (low - plain)))
    return found


def _with(leaves, place, more):
    numbers = list(leaves.numbers)
    numbers[place] = numbers[place] + more
    return leaves.with_numbers(numbers)


def beyond(angle, first, second, rounding) -> Beyond | None:
    """Where the second order of some inputs is not small beside the first, or rounding; None if it is nowhere.

    Parameters
    ----------
    angle : array (..., N)
    first, second : dict of path to array (components, ..., N)
    rounding : array (components, ..., N)
        Bound on the rounding of values.
    """
    own, more = (_size([_size(part) for part in parts.values()]) for parts in (first, second))
    scale = np.fmax(own, TYPICAL * np.nanmedian(own)) if np.isfinite(own).any() else own
    with np.errstate(invalid="ignore", divide="ignore"):
        gap = np.isnan(more)
        too_much = gap | (more > SMALL * scale + 4.0 * _size(rounding))
        if not too_much.any():
            return None
        worst = int(np.argmax(np.where(too_much, np.where(gap, np.inf, more / scale), -1.0)))
    path = max(second, key=lambda path: np.nan_to_num(_size(second[path]).flat[worst], nan=np.inf))
    at = float(np.broadcast_to(angle, more.shape).flat[worst])
    return Beyond(int(too_much.sum()), too_much.size, at, path, float(own.flat[worst]), float(more.flat[worst]))


def _size(part: Any):
    """Root of the sum of squares over the first axis."""
    return np.sqrt(np.sum(np.square(part), axis=0))
