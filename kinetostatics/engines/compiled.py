"""Whether numba (extra `fast`) can be had, and generated source as its modules."""

import importlib
import importlib.util
import os
from functools import cache

from ..errors import MissingLibraryError


def cores():
    """Number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _problem():
    """Why numba cannot be used, or None."""
    if importlib.util.find_spec("numba") is None:
        return "is not installed"
    try:
        importlib.import_module("numba")
    except ImportError as error:  # installed beside a NumPy that it does not know, for instance
        return f"cannot be imported: {error}"
    return None


def available():
    """Whether numba is installed, and can be imported."""
    return _problem() is None


def require():
    """Raise `MissingLibraryError` unless numba is available."""
    if not available():
        raise MissingLibraryError(
            f'the compiled engine needs numba, which {_problem()}: pip install "kinetostatics[fast]"; engine="numpy" '
            "works without"
        )


@cache
def _loaded(text):
    """Module of the source, its machine code kept on disk."""
    from .machine_code import load

    require()
    return load(text, keep=True)
