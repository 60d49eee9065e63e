"""Whether numba (extra `fast`) can be had, and generated source as its modules."""

import importlib
import os
import sys
from functools import cache

from ..errors import MissingLibraryError


def cores():
    """Number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _problem():
    """Why numba cannot be used, or None."""
    if sys.modules.get("numba") is not None:
        return None
    try:
        importlib.import_module("numba")
    except ImportError as error:  # not there, or installed beside a NumPy that it does not know, for instance
        return "is not installed" if error.name == "numba" else f"cannot be imported: {error}"
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
def loaded(text):
    """Module of a source, its machine code kept on disk."""
    from .machine_code import load

    require()
    return load(text, keep=True)
