"""Where uncertainties to first order say too little: beside them stands what the second order makes.

Of independent normal inputs with deviations u the terms of second order, 1/2 sum f_ij d_i d_j, have the mean
1/2 sum f_ii u_i^2 and the variance 1/2 sum f_ij^2 u_i^2 u_j^2 (JCGM 100:2008, 5.1.2, note): products of two inputs
shift nothing, but they spread. What the second order makes is the root of their mean square.
"""

from functools import lru_cache
from itertools import combinations
from itertools import count as numbers
from typing import Any, NamedTuple

import numpy as np

SMALL = 0.1
"""Part of an uncertainty to first order that the second order may be."""
TYPICAL = 0.01
"""Part of the median over the crank angles that is not small beside a first order that vanishes at some."""
FEW = 3
"""Inputs up to which each product of two is looked at by itself."""


class Beyond(NamedTuple):
    """Where the second order is not small beside the first.

    Attributes
    ----------
    values, of : int
        How many values, of how many.
    angle : float
        Crank angle where it is worst, rad.
    paths : tuple of str
        Of the input, or of both, that make most of the second order there.
    first, second : float
        What both orders make there; the second is NaN where there is no value with these inputs moved.
    """

    values: int
    of: int
    angle: float
    paths: tuple[str, ...]
    first: float
    second: float

    def doubt(self, quantity, unit, inputs):
        """What must be said of it, as a `Doubt`."""
        moved, way = " and ".join(f"{path} {inputs[path]:.3g}" for path in self.paths), " or smaller"
        found = f"with {moved} larger{way if len(self.paths) == 1 else ''} there is no value"
        if np.isfinite(self.second):
            most = " and ".join(self.paths) + (" together" if len(self.paths) > 1 else "")
            found = f"the first makes {self.first:.2g} {unit}, the second {self.second:.2g}, most of it of {most}"
        where = f"at {np.degrees(self.angle):.9g} deg {found}; vary the inputs there, as ks.tolerances does"
        places = f"which says too little at {self.values} of {self.of} crank angles"
        return Doubt(quantity, places, where, self.second / self.first if self.first > 0.0 else np.inf)


class Doubt(NamedTuple):
    """Why the uncertainty of a quantity to first order says too little: what it does, where or when, and how much."""

    quantity: str
    what: str
    where: str
    share: float = np.inf


def told(doubts):
    """What must be said of some quantities, as one sentence."""
    if len(doubts) == 1:
        (doubt,) = doubts
        return f"the uncertainty of {doubt.quantity} is of first order in the inputs, {doubt.what}: {doubt.where}"
    worst = max(doubts, key=lambda doubt: np.nan_to_num(doubt.share, nan=np.inf))
    *names, last = dict.fromkeys(doubt.quantity for doubt in doubts)
    return (
        f"the uncertainties of {', '.join(names)} and {last} are of first order in the inputs, and may be more; "
        f"that of {worst.quantity} most: {worst.where}"
    )


class Terms:
    """Terms of second order, as differences have them, of values (components, *shape); zero where there are none.

    Parameters
    ----------
    run : function
        ``run(leaves)``: values.
    plain : array
        These of the leaves as they are.
    leaves : Leaves
    places : dict of path to int
        Which leaf each input is.
    deviations : dict of path to float
    """

    def __init__(self, run, plain, leaves, places, deviations):
        self._run, self._plain, self._leaves, self._places, self._deviations = run, plain, leaves, places, deviations
        gap = np.isnan(plain)
        self._gap = gap if gap.any() else None
        with np.errstate(all="ignore"):
            self._by_one = {sign: {path: self._moved({path: sign}) for path in places} for sign in (1.0, -1.0)}

    def _moved(self, signs):
        """What values change by with some inputs larger or smaller by their deviations."""
        numbers = list(self._leaves.numbers)
        for path, sign in signs.items():
            numbers[self._places[path]] = numbers[self._places[path]] + sign * self._deviations[path]
        change = self._run(self._leaves.with_numbers(numbers)) - self._plain
        return change if self._gap is None else np.where(self._gap, 0.0, change)

    def _together(self, signs):
        """The same beyond what each of them changes by itself."""
        return self._moved(signs) - sum(self._by_one[sign][path] for path, sign in signs.items())

    def of_one(self):
        """By (path,) 1/2 f_ii u_i^2."""
        ahead, behind = self._by_one.values()
        return {(path,): 0.5 * (ahead[path] + behind[path]) for path in self._places}

    def of_two(self):
        """By (path, other) f_ij u_i u_j."""
        return {pair: self._together(dict.fromkeys(pair, 1.0)) for pair in combinations(self._places, 2)}

    def of_all(self):
        """Sums of all products of two, with such signs that no two products take each other away in all of them."""
        codes = dict(zip(self._places, _codes(len(self._places)), strict=True))
        bits = [0, *(1 << row for row in range(max(codes.values()).bit_length()))]
        signs = ({path: -1.0 if code & bit else 1.0 for path, code in codes.items()} for bit in bits)
        return {("all", str(row)): self._together(part) for row, part in enumerate(signs)}


@lru_cache(maxsize=64)
def _codes(count):
    """Whole numbers, of few bits, of which no two differ in the same bits as two others do."""
    codes: list[int] = []
    known: set[int] = set()
    for code in numbers():
        if len(codes) == count:
            return codes
        differences = {code ^ other for other in codes}
        if known.isdisjoint(differences):
            codes.append(code)
            known |= differences


def found(terms, count, angle, first, rounding) -> Beyond | None:
    """Where second order is not small; products of so many inputs are looked at in few sums if these are small."""
    with np.errstate(all="ignore"):
        squares = terms.of_one()
        if count > FEW and beyond(angle, first, squares | terms.of_all(), rounding) is None:
            return None
        return beyond(angle, first, squares | terms.of_two(), rounding)


def beyond(angle, first, second, rounding) -> Beyond | None:
    """Where the second order of some inputs is not small beside the first, or rounding; None if it is nowhere.

    Parameters
    ----------
    angle : array (..., N)
    first : dict of path to array (components, ..., N)
    second : dict of tuple of paths to array (components, ..., N)
        As of `Terms`.
    rounding : array (components, ..., N)
        Bound on the rounding of values.
    """
    terms = np.array(list(second.values()))
    squares = np.array([len(paths) == 1 for paths in second])
    own, parts = _size(np.array(list(first.values())), (0, 1)), _size(terms, 1)
    parts[squares] *= np.sqrt(2.0)  # of its mean, squared, the variance of a square is twice that
    more = _size(np.array([*parts, _size(terms[squares].sum(axis=0))]))
    scale = np.fmax(own, TYPICAL * np.nanmedian(own)) if np.isfinite(own).any() else own
    gap = np.isnan(more)
    too_much = gap | (more > SMALL * scale + 4.0 * len(second) * _size(rounding))
    if not too_much.any():
        return None
    worst = int(np.argmax(np.where(too_much, np.where(gap, np.inf, more / scale), -1.0)))
    most = int(np.argmax(np.nan_to_num(parts.reshape(len(parts), -1)[:, worst], nan=np.inf)))
    at = float(np.broadcast_to(angle, more.shape).flat[worst])
    paths = list(second)[most]
    return Beyond(int(too_much.sum()), too_much.size, at, paths, float(own.flat[worst]), float(more.flat[worst]))


def _size(part: Any, axis: Any = 0):
    """Root of the sum of squares over axes."""
    return np.sqrt(np.sum(np.square(part), axis=axis))
