"""The certified reference that all methods are measured against, to 30 digits or as many as are asked for.

Two paths that share no formula must agree: the library's kernels on intervals (`enclosures`), and mpmath with formulas
of its own (`independent`).
"""

from dataclasses import replace

import numpy as np

from ....errors import KinetostaticsError
from ....mechanics.jamming import with_one_more_pass
from ....mechanics.quantities import scale
from .enclosures import Enclosure, enclosure, library, magnitude, place_of
from .independent import independent, working_digits

__all__ = ["Enclosure", "certified", "differences", "enclosure", "independent", "relative_errors"]


def certified(solution, quantity, digits=30, checks=8) -> Enclosure:
    """Enclosure of a quantity, confirmed by the independent path.

    Parameters
    ----------
    solution : Solution
        Of one design.
    quantity : str
        As for `quantities.components`.
    digits : int
        How small radius and disagreement must be: 10^-digits of the largest value.
    checks : int
        At how many crank angles, evenly chosen, the two paths are compared.

    Returns
    -------
    Enclosure

    Raises
    ------
    KinetostaticsError
        The paths disagree.
    NotGivenError
        A load or cam is computed in double precision only, or a crank angle lies at a limit position.
    MissingLibraryError
        python-flint or mpmath is not installed.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> found = ks.precision.certified(s, "O", checks=2)
    >>> found.agreement < 1e-30
    True
    """
    found = enclosure(with_one_more_pass(solution), quantity, digits)
    mp = library("mpmath").mp
    count = len(found.middle[0])
    indices = np.unique(np.arange(checks) * count // checks)
    unit = found.largest or scale(solution, quantity) or 1.0
    agreement = 0.0
    with mp.workdps(working_digits(digits)):
        for index, *other in zip(indices, *independent(solution, quantity, indices, digits), strict=True):
            own = [mp.mpf(part[index]) for part in found.exact]
            gap = mp.norm([a - b for a, b in zip(own, other, strict=True)]) / unit
            if not gap <= mp.mpf(10) ** -digits:
                raise KinetostaticsError(_disagreement(mp, solution, quantity, index, own, other, gap, digits))
            agreement = max(agreement, float(gap))
    return replace(found, agreement=agreement)


def relative_errors(found, reference: Enclosure):
    """Errors of computed components at each crank angle, relative to the largest value of the reference.

    Each is the magnitude of the difference, which is taken exactly: double minus unrounded reference.

    Parameters
    ----------
    found : tuple of arrays (N,)
        Components as of `quantities.components`; NaN and infinity stay what they are.
    reference : Enclosure

    Returns
    -------
    array (N,)

    Raises
    ------
    MissingLibraryError
        python-flint is not installed.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> reference = ks.precision.enclosure(s, "O")
    >>> bool(ks.precision.relative_errors(ks.precision.components(s, "O"), reference).max() < 1e-15)
    True
    """
    flint = library("flint")

    def difference(value, exact):
        return float(flint.arb(float(value)) - exact) if np.isfinite(value) else abs(float(value))

    return _relative(found, reference, difference)


def differences(other: Enclosure, reference: Enclosure):
    """Differences of two enclosures at each crank angle, relative to the largest value of the second, array (N,)."""
    return _relative(other.exact, reference, lambda value, exact: float(value - exact))


def _relative(found, reference, difference):
    with library("flint").ctx.workprec(reference.bits):
        parts = [
            np.array([difference(*pair) for pair in zip(np.broadcast_to(values, exact.shape), exact, strict=True)])
            for values, exact in zip(found, reference.exact, strict=True)
        ]
    errors = magnitude(parts)
    return errors / reference.largest if reference.largest else np.where(errors > 0, np.inf, errors)


def _disagreement(mp, solution, quantity, index, own, other, gap, digits):
    own, other = (", ".join(mp.nstr(part, digits + 3) for part in parts) for parts in (own, other))
    return (
        f"{place_of(solution, index)}: {quantity} is {own} by the library's kernels but {other} by the independent "
        f"path; they differ by {mp.nstr(gap, 3)} of the largest value, more than 1e-{digits}"
    )
