"""Forces that loads put on sliders; what a function of the user's returns is checked."""

import numpy as np

from ..errors import ParameterError
from ..machine.loads import is_given
from ..numbers import checks
from ..numbers.elementary import is_foreign_array


def pushed(item, motion):
    """Force of a load on its slider, N; what a function of the user's returns is checked.

    Raises
    ------
    ParameterError
        It is no array of numbers, one for each crank angle, or not finite where the mechanism closes.
    """
    found = item.push(motion)
    if is_given(item) or (isinstance(found, np.ndarray) and found.dtype == object):
        return found
    owner = f"{type(item).__name__} on {item.on!r}: its function"
    wanted = f"must return its force in N, a number or an array of shape {motion.shape}, one for each crank angle"
    words = None if hasattr(found, "to_numpy") else checks.unfit(found)
    if words:
        raise ParameterError(f"{owner} {wanted}, got {checks.shown(found)}, {words.format(unit='N')}")
    if is_foreign_array(found):
        return found
    array = np.asarray(found)
    if array.dtype == object and array.ndim == 0 and hasattr(found, "__mul__"):  # a recorded number, an enclosure
        return found
    if array.dtype.kind not in "fiu":
        raise ParameterError(f"{owner} {wanted}, got {str(found)[:60]}")
    if not _fits(array.shape, motion.shape):
        raise ParameterError(f"{owner} {wanted}, got shape {array.shape}")
    if not np.isfinite(array).all():
        _require_finite(owner, array, motion)
    return array if array.dtype.kind == "f" else array.astype(float)


def _fits(shape, wanted):
    try:
        return np.broadcast_shapes(shape, wanted) == wanted
    except ValueError:
        return False


def _require_finite(owner, push, motion):
    """Raise an error for a push that is not finite where the mechanism closes."""
    wrong = np.broadcast_to(~np.isfinite(push) & motion.closed, motion.shape)
    if wrong.any():
        angle = np.broadcast_to(motion.crank_angle, motion.shape)[wrong]
        places = ", ".join(f"{place:.6g}" for place in np.degrees(angle[:3]))
        raise ParameterError(
            f"{owner} must return finite forces, got {np.broadcast_to(push, motion.shape)[wrong][0]} at {angle.size} "
            f"crank angles, the first {places} deg",
            wrong.any(axis=-1) if wrong.ndim > 1 else None,
        )
