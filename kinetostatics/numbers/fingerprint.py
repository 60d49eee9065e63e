"""Fingerprints of user code and of designs: equal only where both compute the same.

`key_of` and `class_key` return keys of functions and classes within a process, for cached programs. A key holds code
and the constants it refers to: globals, closures, defaults, attributes of functions, modules and classes. It is None
where a value may change unnoticed, for example the items of a list.

`digest` returns a text that is the same in every session, for resumed sweeps: of a variant, a scene or a function. For
a function it covers the compiled code and all it refers to: constants, defaults, closures, arguments of a `partial`,
the function inside a decorator, the object of a method, values and functions of its own module. Of other modules it
covers name and version only, and no attribute that is looked up by text.
"""

import hashlib
import re
import sys
from dataclasses import fields, is_dataclass
from functools import cached_property, partial
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType

import numpy as np

LIBRARY = __name__.partition(".")[0]
TRUSTED_PACKAGES = (LIBRARY, "numpy", "math", "pint", "builtins", "typing", "abc")
"""Packages whose functions and classes do not change within a process."""
MISSING = "missing"
GENERATED_METHODS = {
    f"__{name}__" for name in ["init", "post_init", "repr", "eq", "hash", "replace", "setattr", "delattr"]
}
"""Methods that construct or compare dataclass items; no calculation calls them afterwards."""

CODE_ATTRIBUTES = tuple(
    f"co_{name}"
    for name in ("code", "consts", "names", "varnames", "freevars", "cellvars", "argcount", "posonlyargcount")
) + ("co_kwonlyargcount", "co_flags")
"""Attributes of compiled code that determine its behaviour; not its file and lines."""
IGNORED_ATTRIBUTES = {
    f"__{name}__" for name in ("dict", "weakref", "doc", "module", "annotations", "firstlineno", "slots")
}
"""Entries of a class that do not affect its behaviour."""


def key_of(value, names=(), above=()):
    """Key of a constant, a function, or the used `names` of a module; None where a value may change unnoticed.

    `above` holds the objects that contain `value`; a reference to one of them becomes its depth.
    """
    if isinstance(value, bool | int | float | complex | str | bytes | None):
        return type(value), value, np.copysign(1.0, value) if isinstance(value, float) else None
    if any(value is other for other in above):
        return "again", next(place for place, other in enumerate(above) if value is other)
    above = (*above, value)
    if isinstance(value, ModuleType):
        return value.__name__, *_module_keys(value, names, above)
    if isinstance(value, FunctionType):
        return value if _is_trusted(value) else _function_key(value, above)
    if isinstance(value, type):
        return value if _is_trusted(value) else class_key(value, above)
    if isinstance(value, staticmethod | classmethod):
        return _none_or_all(type(value), key_of(value.__func__, (), above))
    if isinstance(value, property | cached_property):
        return _none_or_all(type(value), key_of(value.fget if isinstance(value, property) else value.func, (), above))
    if isinstance(value, tuple):
        return _none_or_all(type(value), *(key_of(part, (), above) for part in value))
    if isinstance(value, BuiltinFunctionType):  # a method of a list, say, is one too
        return value if isinstance(value.__self__, ModuleType | None) else None
    if isinstance(value, np.ufunc | type(np.where)):
        return value
    return value if type(value).__module__.partition(".")[0] == LIBRARY and callable(value) else None


def class_key(kind, above=()):
    """Key of a user's class and its own base classes: methods, constants, declarations."""
    return _none_or_all(*(part for base in kind.__mro__ if not _is_trusted(base) for part in _class_keys(base, above)))


def _class_keys(base, above):
    yield base
    for name, value in vars(base).items():
        if name.startswith("__"):
            if isinstance(value, FunctionType) and name not in GENERATED_METHODS:
                yield key_of(value, (), above)
        elif not (name.startswith("_abc_") or type(value).__name__ in ("member_descriptor", "getset_descriptor")):
            yield name
            yield _attribute_key(value, above)


def _attribute_key(value, above):
    """Key of a class attribute, which may be a table of declarations."""
    if isinstance(value, dict):
        return _none_or_all(dict, *(_attribute_key(part, above) for pair in value.items() for part in pair))
    if isinstance(value, list | tuple | set | frozenset):
        return _none_or_all(type(value), *(_attribute_key(part, above) for part in value))
    if isinstance(value, np.ndarray) and value.dtype != object:
        return value.dtype.str, value.shape, value.tobytes()
    if value is not None and not isinstance(value, type) and type(value).__module__.partition(".")[0] == LIBRARY:
        return "library's", id(value)
    return key_of(value, (), above)


def _function_key(function, above):
    code, outer = function.__code__, function.__globals__
    names = _names(code)
    values = [outer.get(name, MISSING) for name in names] + _closed_over(function)
    values += [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values(), *vars(function).values()]
    return _none_or_all(code, *(key_of(value, names, above) for value in values))


def _closed_over(function):
    """Values in the closure of a function; None for a name without a value yet."""
    values = []
    for cell in function.__closure__ or ():
        try:
            values.append(cell.cell_contents)
        except ValueError:
            values.append(None)
    return values


def _names(code):
    """Global and attribute names in code and its inner functions."""
    inner = (part for part in code.co_consts if isinstance(part, CodeType))
    return tuple(dict.fromkeys([*code.co_names, *(name for part in inner for name in _names(part))]))


def _module_keys(module, names, above):
    """Keys of the used `names` of a module; its functions stand for themselves."""
    if module.__name__.partition(".")[0] in TRUSTED_PACKAGES:
        return
    for name in names:
        value = vars(module).get(name, MISSING)
        yield name
        yield value if isinstance(value, FunctionType) else key_of(value, names, above)


def _is_trusted(item):
    return (getattr(item, "__module__", None) or "").partition(".")[0] in TRUSTED_PACKAGES


def _none_or_all(*parts):
    """The parts, or None if any part is None."""
    return None if any(part is None for part in parts) else parts


def digest(item):
    """Digest of a variant, a scene or a function, the same in every session."""
    return _sha256(item.content) if hasattr(item, "content") else _Digests().digest(item)


class _Digests:
    """Digests of objects by content; an object inside itself counts by its depth."""

    def __init__(self):
        self._above, self._done = {}, {}

    def digest(self, item):
        if isinstance(item, bool | int | float | complex | str | bytes | type(None) | type(Ellipsis)):
            return _hash_texts(type(item).__name__, repr(item))
        if id(item) in self._above:
            return _hash_texts("above", str(self._above[id(item)]))
        if id(item) not in self._done:
            self._above[id(item)] = len(self._above)
            found = _hash_texts(_versioned_name(type(item)), *self._parts(item))
            del self._above[id(item)]
            self._done[id(item)] = found, item  # keeps the item alive, so that no other gets its id
        return self._done[id(item)][0]

    def _parts(self, item):
        """Texts and digests that distinguish an object from others of its type."""
        if isinstance(item, np.ndarray | np.generic):
            whole = np.asarray(item)
            held = self._all(whole.ravel().tolist()) if whole.dtype.hasobject else [_sha256(whole.tobytes())]
            return [str(whole.dtype), str(whole.shape), *held]
        if type(item).__module__.startswith("pandas.") and hasattr(item, "to_numpy"):
            return self._all([item.to_numpy(), *map(np.asarray, getattr(item, "axes", ()))])
        if isinstance(item, set | frozenset):
            return sorted(self._all(item))
        if isinstance(item, ModuleType | BuiltinFunctionType | np.ufunc):
            return [_versioned_name(item)]
        if isinstance(item, type):
            return [_versioned_name(item), *self._all(_class_attributes(item))]
        parts = next((parts for kind, parts in _PARTS.items() if isinstance(item, kind)), _object_parts)
        return self._all(parts(item))

    def _all(self, items):
        return [self.digest(item) for item in items]


def _hash_texts(*texts):
    return _sha256(repr(texts).encode())


def _sha256(content):
    return hashlib.sha256(content).hexdigest()


def _versioned_name(item):
    """Name of a module, class or function, with the version of its package."""
    module = item.__name__ if isinstance(item, ModuleType) else str(getattr(item, "__module__", ""))
    version = getattr(sys.modules.get(_package(module)), "__version__", "")
    return f"{module}.{getattr(item, '__qualname__', None) or getattr(item, '__name__', '')} {version}"


def _package(module):
    return module.partition(".")[0]


def _is_library(module):
    """Whether a module is Python's, ours, or installed, so that its version identifies it."""
    if module == "__main__":
        return False
    file = getattr(sys.modules.get(module), "__file__", None) or ""
    ours = _package(module) == _package(__name__)
    return ours or _package(module) in sys.stdlib_module_names or "site-packages" in file or "dist-packages" in file


def _function_parts(function):
    """Code of a function, its defaults, closure and attributes, and the globals of its own module."""
    code, defaults = function.__code__, (function.__defaults__, function.__kwdefaults__)
    return code, *defaults, _closed_over(function), vars(function), _own_globals(function)


def _own_globals(function):
    """Values that a function uses of its own module, and functions and classes defined there, by name."""
    known, module = function.__globals__, function.__module__
    if _is_library(str(module)):
        return {}
    used = {name: known[name] for name in sorted(_names(function.__code__)) if name in known}
    return {
        name: item
        for name, item in used.items()
        if not isinstance(item, ModuleType) and (not callable(item) or getattr(item, "__module__", module) == module)
    }


def _class_attributes(kind):
    """Attributes of a class and its bases, libraries' bases excluded."""
    written = [vars(base) for base in kind.__mro__ if not _is_library(base.__module__)]
    return [{name: value for name, value in table.items() if name not in IGNORED_ATTRIBUTES} for table in written]


def _object_parts(item):
    """Class and state of any other object; its text if it has no state or belongs to Python's library."""
    wrapped = getattr(item, "__wrapped__", None)  # of a cached or compiled function
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


_PARTS = {
    list: list,
    tuple: list,
    dict: lambda item: [part for pair in item.items() for part in pair],
    CodeType: lambda item: [getattr(item, name) for name in CODE_ATTRIBUTES],
    partial: lambda item: [item.func, item.args, dict(sorted(item.keywords.items()))],
    property: lambda item: [item.fget, item.fset, item.fdel],
    MethodType: lambda item: [item.__func__, item.__self__],
    FunctionType: _function_parts,
}
"""Function by type that returns the distinguishing data of an object."""
