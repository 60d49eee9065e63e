"""What was computed of the last crank angles: loops over designs ask for the sines of the same ones each time."""

import threading
from functools import wraps

MAX_KEPT_ANGLES = 10_000
"""Crank angles up to which they are kept."""
_last = threading.local()


def keep_for_same_angles(compute):
    """Function of an array of crank angles that is not repeated, in each thread, for those of the last call."""

    @wraps(compute)
    def computed(angle):
        if angle.size > MAX_KEPT_ANGLES:
            return compute(angle)
        key = angle.shape, angle.tobytes()
        held = _last.__dict__
        known = held.get(compute)
        if known is None or known[0] != key:
            known = held[compute] = key, compute(angle)
        return known[1]

    return computed


def forget_angles():
    """Compute anew at the next call in this thread: what is timed shall not gain by having been called before."""
    _last.__dict__.clear()
