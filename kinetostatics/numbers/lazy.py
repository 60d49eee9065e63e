"""Properties that are computed when first read, and kept; pyplot, loaded when a figure is drawn."""

import functools
import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property
else:

    class cached_property(functools.cached_property):  # noqa: N801  spelled as in the standard library
        """That of Python 3.12, which takes no lock: in Python 3.11 the lock costs more than most of what is kept."""

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            found = instance.__dict__[self.attrname] = self.func(instance)
            return found


__all__ = ["cached_property", "pyplot"]


def pyplot():
    """Module matplotlib.pyplot; refused where the backend that MPLBACKEND names cannot be loaded."""
    backend = os.environ.get("MPLBACKEND", "")
    if "matplotlib.pyplot" not in sys.modules and backend:
        try:
            import_module("matplotlib")  # refuses names that it does not know
            import_module(backend.removeprefix("module://") if backend.startswith("module://") else "matplotlib.pyplot")
        except (ValueError, ImportError) as error:
            raise ParameterError(
                f"figures cannot be drawn, as the environment variable MPLBACKEND is {backend!r}: {error}; unset it, "
                "or set it to agg, which draws without a screen"
            ) from error
    return import_module("matplotlib.pyplot")
