"""Whether it is the same sweep: what a case's variant, a scene or a function is made of, told by a digest.

Of a function that is its compiled code with all that it holds and names: constants, defaults, cells, what a `partial`
binds, what a decorator wraps, the object of a method, and the values and functions of its own module that it names. Of
what comes from other modules only name and version are looked at, and neither is what is looked up by text.
"""

import hashlib
import re
import sys
from dataclasses import fields, is_dataclass
from functools import partial
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType

import numpy as np
import pandas as pd

from ..version import __version__

CODE = (
    "co_code",
    "co_consts",
    "co_names",
    "co_varnames",
    "co_freevars",
    "co_cellvars",
    "co_argcount",
    "co_posonlyargcount",
    "co_kwonlyargcount",
    "co_flags",
)
"""What of compiled code decides what it does; not where it was written."""

UNTOLD = ("__dict__", "__weakref__", "__doc__", "__module__", "__annotations__", "__firstlineno__", "__slots__")
"""What stands in a class without deciding what it does."""


def identity(job, designs, compared, chunk):
    """What makes a sweep the same sweep, by name."""
    hashed = pd.util.hash_pandas_object(designs, index=True).to_numpy().tobytes()
    of_case = hasattr(compared[0], "content")
    varied = "variant" if of_case else "scene" if hasattr(compared[0], "mechanism") else "function"
    return {
        "version": __version__,
        **({} if of_case else {"python": sys.implementation.cache_tag}),  # whose code differs from release to release
        **{name: digest(item) for name, item in zip((varied, "reference"), compared, strict=False)},
        "outputs": [str(item) for item in job.outputs],
        "angles": int(job.angles),
        "chunk": int(chunk),
        "columns": [str(column) for column in designs.columns],
        "designs": _digested(hashed),
    }


def digest(item):
    """Digest of a variant, a scene or a function, the same in every session."""
    return _digested(item.content) if hasattr(item, "content") else _Told().digest(item)


class _Told:
    """Digests of objects by what they hold, the same for equal ones; one that holds itself is told by its depth."""

    def __init__(self):
        self._above, self._done = {}, {}

    def digest(self, item):
        if isinstance(item, bool | int | float | complex | str | bytes | type(None) | type(Ellipsis)):
            return _hash(type(item).__name__, repr(item))
        if id(item) in self._above:
            return _hash("above", str(self._above[id(item)]))
        if id(item) not in self._done:
            self._above[id(item)] = len(self._above)
            told = _hash(_named(type(item)), *self._parts(item))
            del self._above[id(item)]
            self._done[id(item)] = told, item  # held, for another would take its id
        return self._done[id(item)][0]

    def _parts(self, item):
        """What tells an object from others of its type."""
        if isinstance(item, np.ndarray | np.generic):
            whole = np.asarray(item)
            held = self._all(whole.ravel().tolist()) if whole.dtype.hasobject else [_digested(whole.tobytes())]
            return [str(whole.dtype), str(whole.shape), *held]
        if isinstance(item, pd.DataFrame | pd.Series | pd.Index):
            return self._all([item.to_numpy(), *map(np.asarray, getattr(item, "axes", ()))])
        if isinstance(item, list | tuple):
            return self._all(item)
        if isinstance(item, set | frozenset):
            return sorted(self._all(item))
        if isinstance(item, dict):
            return self._all([part for pair in item.items() for part in pair])
        if isinstance(item, CodeType):
            return self._all(getattr(item, name) for name in CODE)
        if isinstance(item, partial):
            return self._all([item.func, item.args, dict(sorted(item.keywords.items()))])
        if isinstance(item, property):
            return self._all([item.fget, item.fset, item.fdel])
        if isinstance(item, MethodType):
            return self._all([item.__func__, item.__self__])
        if isinstance(item, FunctionType):
            return self._all(_of_function(item))
        if isinstance(item, ModuleType | BuiltinFunctionType | np.ufunc):
            return [_named(item)]
        if isinstance(item, type):
            return [_named(item), *self._all(_of_class(item))]
        return self._all(_of_object(item))

    def _all(self, items):
        return [self.digest(item) for item in items]


def _hash(*texts):
    return _digested(repr(texts).encode())


def _digested(content):
    return hashlib.sha256(content).hexdigest()


def _named(item):
    """Name of a module, class or function, with the version of what it comes from."""
    module = item.__name__ if isinstance(item, ModuleType) else str(getattr(item, "__module__", ""))
    version = getattr(sys.modules.get(_package(module)), "__version__", "")
    return f"{module}.{getattr(item, '__qualname__', None) or getattr(item, '__name__', '')} {version}"


def _package(module):
    return module.partition(".")[0]


def _library(module):
    """Whether a module is Python's, ours, or installed, and so told by a version."""
    if module == "__main__":
        return False
    file = getattr(sys.modules.get(module), "__file__", None) or ""
    ours = _package(module) == _package(__name__)
    return ours or _package(module) in sys.stdlib_module_names or "site-packages" in file or "dist-packages" in file


def _of_function(function):
    """Code of a function, what it holds and, unless it is a library's, what it names of its own module."""
    cells = [_content(cell) for cell in function.__closure__ or ()]
    return function.__code__, function.__defaults__, function.__kwdefaults__, cells, vars(function), _named_by(function)


def _content(cell):
    try:
        return cell.cell_contents
    except ValueError:  # of a name that has no value yet
        return None


def _named_by(function):
    known, module = function.__globals__, function.__module__
    if _library(str(module)):
        return {}
    names = sorted(name for name in _names(function.__code__) if name in known)
    return {name: known[name] for name in names if _own(known[name], module)}


def _names(code):
    """Names that code, and the code in it, looks up."""
    return {*code.co_names}.union(*(_names(item) for item in code.co_consts if isinstance(item, CodeType)))


def _own(item, module):
    """Whether something is a value, or written in this module."""
    if isinstance(item, ModuleType):
        return False
    return not callable(item) or getattr(item, "__module__", module) == module


def _of_class(kind):
    """What is written in a class and in those it inherits from, but for a library's."""
    written = [vars(base) for base in kind.__mro__ if not _library(base.__module__)]
    return [{name: value for name, value in table.items() if name not in UNTOLD} for table in written]


def _of_object(item):
    """Class and state of any other object; its text where it has none, or is one of Python's own."""
    wrapped = getattr(item, "__wrapped__", None)  # of what is cached or compiled
    if is_dataclass(item):
        return type(item), {field.name: getattr(item, field.name) for field in fields(item)}
    slots = [name for kind in type(item).__mro__ for name in _slots(kind) if hasattr(item, name)]
    state = {**getattr(item, "__dict__", {}), **{name: getattr(item, name) for name in slots}}
    if wrapped is not None:
        return type(item), wrapped
    module = type(item).__module__
    if not state or (_package(module) in sys.stdlib_module_names and module != "functools"):
        return type(item), re.sub(r" at 0x\w+", "", repr(item))
    return type(item), state


def _slots(kind):
    slots = vars(kind).get("__slots__", ())
    return [slots] if isinstance(slots, str) else slots
