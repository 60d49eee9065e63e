"""Whether numba (extra `fast`) can be had, and generated source as its modules."""

import importlib
import os
import sys
from functools import cache

from ..errors import MissingLibraryError


def core_count():
    """Number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _problem():
    """Why numba cannot be used and how to mend it, or None."""
    numba = sys.modules.get("numba")
    try:
        numba = numba or importlib.import_module("numba")
    except ImportError as error:  # not there, or installed beside a NumPy that it does not know, for instance
        why = "is not installed" if error.name == "numba" else f"cannot be imported: {error}"
        return f'{why}: pip install "kinetostatics[fast]"'
    return "compiles nothing while NUMBA_DISABLE_JIT is set: unset it" if numba.config.DISABLE_JIT else None


def numba_available():
    """Whether numba is installed, can be imported, and compiles."""
    return _problem() is None


def require_numba():
    """Raise `MissingLibraryError` unless numba is available."""
    if problem := _problem():
        raise MissingLibraryError(f'the compiled engine needs numba, which {problem}; engine="numpy" works without')


@cache
def load_compiled(text):
    """Module of a source, its machine code kept on disk."""
    from .code_cache import load_module

    require_numba()
    return load_module(text, keep=True)
