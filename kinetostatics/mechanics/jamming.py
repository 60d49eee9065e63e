"""Passes over the friction of a scene, and the errors and warnings where it jams or does not converge.

Friction jams where its margin is not positive: there are no forces in equilibrium, or several states of forces.
"""

import warnings

import numpy as np

from ..errors import ConditionWarning, JammingError
from ..machine.friction import PASSES_BY_SOLVER
from ..machine.kinematic_state import SENSE_REMEDY, has_no_sense
from ..numbers.parameter_tree import replace_unchecked

MAX_CHANGE = 1e-13
"""Upper limit of the relative change of forces by one more pass, times the margin from jamming, for convergence."""


def solve_friction(item, evaluate=None):
    """The item, a scene or solution, with enough passes over its friction to converge, or with the largest number.

    ``evaluate(item) -> (margin, residual)`` tests convergence; without it the item gets more passes than most need.
    """
    if evaluate is None:
        return with_passes(item, max(item.friction.passes, PASSES_BY_SOLVER[1]))
    for passes in (item.friction.passes, *(more for more in PASSES_BY_SOLVER if more > item.friction.passes)):
        item = with_passes(item, passes)
        margin, residual = evaluate(item)
        if not _is_plain(margin) or np.all(converged(margin, residual) | np.logical_not(margin > 0)):
            break
    return item


def with_passes(item, passes):
    """The item with a number of passes over its friction; one more doubles the digits."""
    if passes == item.friction.passes:
        return item
    return replace_unchecked(item, friction=replace_unchecked(item.friction, passes=passes))


def checks_of(solution):
    """Margin from jamming and relative change by one more pass of a solution, each (..., N)."""
    return solution._found("friction_margin"), solution._found("friction_residual")


def converged(margin, residual):
    """Whether friction has converged to rounding, (..., N) of bool."""
    with np.errstate(invalid="ignore", over="ignore"):
        return np.asarray((margin > 0) & (residual * margin <= MAX_CHANGE))


def _is_plain(values):
    return isinstance(values, float) or (isinstance(values, np.ndarray) and values.dtype == np.float64)


def problem_at_rest(solution):
    """Problem of friction on a crank at rest without acceleration, as a sentence, or None."""
    return f"friction acts against motion, {SENSE_REMEDY}" if np.any(has_no_sense(solution)) else None


def check(solution, on_gap):
    """Raise `JammingError` where friction jams; warn where it has not converged."""
    margin, residual = checks_of(solution)
    if not _is_plain(margin):
        return
    with np.errstate(invalid="ignore"):
        jams = margin <= 0
    if jams.any() and on_gap == "raise":
        raise _error(solution, margin, jams)
    warn_if_not_converged(solution, margin, residual, stacklevel=6)


def require_free(solution, owner):
    """Raise `JammingError` on behalf of `owner` if friction jams at a crank angle of the solution."""
    if jammed_angles(solution).size:
        margin, _ = checks_of(solution)
        raise _error(solution, margin, margin <= 0, f"{owner}: ", "")


def jammed_angles(solution):
    """Crank angles at which friction of a single design jams, (K,), rad."""
    if not solution.friction.acting:
        return np.empty(0)
    with np.errstate(invalid="ignore"):
        return np.asarray(solution.crank_angle)[solution._found("friction_margin") <= 0]


def warn_if_not_converged(item, margin, residual, stacklevel):
    """Warn where friction of a solution, or of a program's state, has not converged."""
    if not _is_plain(margin):
        return
    with np.errstate(invalid="ignore"):
        lost = (margin > 0) & ~converged(margin, residual)
    if lost.any():
        angle = np.broadcast_to(item.crank_angle, margin.shape)[lost]
        warnings.warn(
            f"{item.mechanism.name}: friction and reactions are not converged to rounding at {lost.sum()} of "
            f"{lost.size} crank angles, {_degrees(angle)} deg; one more pass would change them by up to "
            f"{np.max(residual[lost]):.1g} of the largest",
            ConditionWarning,
            stacklevel=stacklevel,
        )


def _error(solution, margin, jams, owner="", other=', or pass on_gap="nan" to get NaN there and the rest exact'):
    """`JammingError` of a solution with its crank angles."""
    angle = np.broadcast_to(solution.crank_angle, margin.shape)[jams]
    return JammingError(
        f"{owner}{solution.mechanism.name}: friction jams at {angle.size} of {margin.size} crank angles, "
        f"{_degrees(angle)} deg. "
        f"It feeds back on itself {1.0 - float(np.min(margin[jams])):.4g} times. At 1 or more there are no forces in "
        "equilibrium or several states of forces (for several joints together: may be). Lower the "
        f"coefficients, lengthen the shoes or steepen the links{other}",
        np.unique(angle).tolist(),
    )


def _degrees(angles):
    angles = np.unique(np.degrees(angles))
    shown = ", ".join(f"{angle:.6g}" for angle in angles[:3])
    return shown if angles.size <= 3 else f"{shown} ... {angles[-1]:.6g}"
