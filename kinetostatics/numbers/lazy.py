"""Lazy loading and caching: public names, cached properties, pyplot.

It has no heavy imports, because the package itself loads it first.
"""

import functools
import os
import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from ..errors import ParameterError

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property
else:

    class cached_property(functools.cached_property):  # noqa: N801  spelled as in the standard library
        """As in Python 3.12, without a lock: the lock of 3.11 costs more than most values."""

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            found = instance.__dict__[self.attrname] = self.func(instance)
            return found


__all__ = ["cached_property", "public_name", "pyplot"]


@functools.cache
def _stub(package):
    """Loader of the public names in the stub `__init__.pyi` of a package, and these names."""
    import lazy_loader

    load, _, names = lazy_loader.attach_stub(package, sys.modules[package].__file__)
    return load, names


def public_name(package, name, otherwise=lambda name: ""):
    """Object of a public name of a package, loaded from the module in its stub; for ``"__all__"`` the names.

    ``otherwise(name)`` ends the error message for a name without a near public name.
    """
    missing = f"module {package!r} has no attribute {name!r}"
    if name.startswith("_") and name != "__all__":  # Python itself asks for these
        raise AttributeError(missing, name=name, obj=sys.modules[package])
    load, names = _stub(package)
    if name == "__all__":
        return names
    if name not in names:
        from .checks import hint

        raise AttributeError(missing + (hint(name, names) or otherwise(name)), name=name, obj=sys.modules[package])
    try:
        found = load(name)
    except AttributeError as error:
        if error.name != name or not isinstance(error.obj, ModuleType):
            raise
        found = import_module(f"{error.obj.__name__}.{name}")  # a module of that folder, not loaded yet
    setattr(sys.modules[package], name, found)
    return found


def pyplot():
    """Module matplotlib.pyplot; `ParameterError` if the backend in MPLBACKEND cannot be loaded."""
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
