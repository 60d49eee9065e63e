"""Where friction jams, or leaves more than one state of forces: the check behind `solve`."""

import warnings
from dataclasses import replace

import numpy as np

from ..errors import ConditionWarning, JammingError
from ..machine.friction import PASSES
from ..machine.sense import WANTED, stands
from ..numbers.leaves import with_fields

CONVERGED = 1e-13
"""Change of forces by one more pass, relative, times the margin from jamming, from which on they are not found."""


def standing(solution):
    """What is wrong with a crank that neither moves nor begins to, as a sentence, or None."""
    return f"friction acts against motion, {WANTED}" if np.any(stands(solution)) else None


def converged(margin, residual):
    """Whether friction was found to rounding."""
    with np.errstate(invalid="ignore", over="ignore"):
        return np.asarray((margin > 0) & (residual * margin <= CONVERGED))


def settled(solution):
    """The solution with as many passes over its friction as it takes, or the most there are."""
    for passes in PASSES:
        if passes > solution.friction.passes:
            solution = replace(solution, friction=with_fields(solution.friction, passes=passes))
        margin, residual = solution._found("friction_margin"), solution._found("friction_residual")
        if not _is_plain(margin) or np.all(converged(margin, residual) | ~(margin > 0)):
            break
    return solution


def _is_plain(values):
    return isinstance(values, np.ndarray | np.floating) and np.issubdtype(values.dtype, np.float64)


def check(solution, on_gap):
    """Raise `JammingError` where friction has no state, or several; warn where it was not found to rounding."""
    margin, residual = solution._found("friction_margin"), solution._found("friction_residual")
    if not _is_plain(margin):
        return
    with np.errstate(invalid="ignore"):
        jams = margin <= 0
    if jams.any() and on_gap == "raise":
        raise _error(solution, margin, jams)
    warn(solution, margin, residual, stacklevel=6)


def require_free(solution, owner):
    """Raise `JammingError` for a result over the turn if friction jams at the solution's crank angles."""
    if where(solution).size:
        margin = solution._found("friction_margin")
        raise _error(solution, margin, margin <= 0, f"{owner}: ", "")


def where(solution):
    """Crank angles of a solution of one design at which friction jams."""
    if not solution.friction.acting:
        return np.empty(0)
    with np.errstate(invalid="ignore"):
        return np.asarray(solution.crank_angle)[solution._found("friction_margin") <= 0]


def warn(item, margin, residual, stacklevel):
    """Warn where friction of a solution, or of a program's state, was not found to rounding."""
    with np.errstate(invalid="ignore"):
        lost = (margin > 0) & ~converged(margin, residual)
    if lost.any():
        angle = np.broadcast_to(item.crank_angle, margin.shape)[lost]
        warnings.warn(
            f"{item.mechanism.name}: friction and reactions are not found to rounding at {lost.sum()} of "
            f"{lost.size} crank angles, {_degrees(angle)} deg; one more pass would change them by up to "
            f"{np.max(residual[lost]):.1g} of the largest",
            ConditionWarning,
            stacklevel=stacklevel,
        )


def _error(solution, margin, jams, owner="", other=', or pass on_gap="nan" to get NaN there and the rest exact'):
    """What is wrong where friction jams, for the owner of a call."""
    angle = np.broadcast_to(solution.crank_angle, margin.shape)[jams]
    return JammingError(
        f"{owner}{solution.mechanism.name}: friction jams at {angle.size} of {margin.size} crank angles, "
        f"{_degrees(angle)} deg: "
        f"it feeds back on itself {1.0 - float(np.min(margin[jams])):.4g} times (at 1 or more there are no "
        "forces in equilibrium, or several states of them; of several joints together: there may be); lower the "
        f"coefficients, lengthen the shoes or steepen the links{other}",
        np.unique(angle).tolist(),
    )


def _degrees(angles):
    angles = np.unique(np.degrees(angles))
    shown = ", ".join(f"{angle:.6g}" for angle in angles[:3])
    return shown if angles.size <= 3 else f"{shown} ... {angles[-1]:.6g}"
