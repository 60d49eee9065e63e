"""What code of the user's is made of: keys that are equal only where functions and classes compute the same.

A key holds code and the constants it refers to: globals, closures, defaults, attributes of functions, modules and
classes. It is None where something may change unseen, as a list's items may.
"""

from functools import cached_property
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType

import numpy as np

LIBRARY = __name__.partition(".")[0]
SETTLED = (LIBRARY, "numpy", "math", "pint", "builtins", "typing", "abc")
"""Packages whose functions and classes are taken as they are."""
MISSING = "missing"
MADE = {f"__{name}__" for name in ["init", "post_init", "repr", "eq", "hash", "replace", "setattr", "delattr"]}
"""Methods that dataclasses are given, and those that only make an item: they compute nothing afterwards."""


def key_of(value, names=(), above=()):
    """Key of a constant, of a function, or of a class of which some names are used; None where it may change unseen."""
    if isinstance(value, bool | int | float | complex | str | bytes | None):
        return type(value), value, np.copysign(1.0, value) if isinstance(value, float) else None
    if any(value is other for other in above):
        return "again", next(place for place, other in enumerate(above) if value is other)
    above = (*above, value)
    if isinstance(value, ModuleType):
        return value.__name__, *_used(value, names, above)
    if isinstance(value, FunctionType):
        return value if _is_settled(value) else _of_function(value, above)
    if isinstance(value, type):
        return value if _is_settled(value) else of_class(value, above)
    if isinstance(value, staticmethod | classmethod):
        return _all(type(value), key_of(value.__func__, (), above))
    if isinstance(value, property | cached_property):
        return _all(type(value), key_of(value.fget if isinstance(value, property) else value.func, (), above))
    if isinstance(value, tuple):
        return _all(type(value), *(key_of(part, (), above) for part in value))
    if isinstance(value, BuiltinFunctionType):  # a method of a list, say, is one too
        return value if isinstance(value.__self__, ModuleType | None) else None
    if isinstance(value, np.ufunc | type(np.where)):
        return value
    return value if type(value).__module__.partition(".")[0] == LIBRARY and callable(value) else None


def of_class(kind, above=()):
    """Key of all that classes of the user's say, those that a class is derived from among them."""
    return _all(*(part for base in kind.__mro__ if not _is_settled(base) for part in _said(base, above)))


def _said(base, above):
    yield base
    for name, value in vars(base).items():
        if name.startswith("__"):
            if isinstance(value, FunctionType) and name not in MADE:
                yield key_of(value, (), above)
        elif not (name.startswith("_abc_") or type(value).__name__ in ("member_descriptor", "getset_descriptor")):
            yield name
            yield _declared(value, above)


def _declared(value, above):
    """Key of a class's attribute, which may be a table of declarations."""
    if isinstance(value, dict):
        return _all(dict, *(_declared(part, above) for pair in value.items() for part in pair))
    if isinstance(value, list | tuple | set | frozenset):
        return _all(type(value), *(_declared(part, above) for part in value))
    if isinstance(value, np.ndarray) and value.dtype != object:
        return value.dtype.str, value.shape, value.tobytes()
    if value is not None and not isinstance(value, type) and type(value).__module__.partition(".")[0] == LIBRARY:
        return "library's", id(value)
    return key_of(value, (), above)


def _of_function(function, above):
    code, outer = function.__code__, function.__globals__
    names = _names(code)
    held = [outer.get(name, MISSING) for name in names]
    for cell in function.__closure__ or ():
        try:
            held.append(cell.cell_contents)
        except ValueError:  # not filled yet
            return None
    held += [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values(), *vars(function).values()]
    return _all(code, *(key_of(value, names, above) for value in held))


def _names(code):
    """Names that code, and functions within it, take from elsewhere."""
    inner = (part for part in code.co_consts if isinstance(part, CodeType))
    return tuple(dict.fromkeys([*code.co_names, *(name for part in inner for name in _names(part))]))


def _used(module, names, above):
    """What of a module is used; its functions are taken as they are."""
    if module.__name__.partition(".")[0] in SETTLED:
        return
    for name in names:
        value = vars(module).get(name, MISSING)
        yield name
        yield value if isinstance(value, FunctionType) else key_of(value, names, above)


def _is_settled(item):
    return (getattr(item, "__module__", None) or "").partition(".")[0] in SETTLED


def _all(*parts):
    """The parts, or None if one of them is."""
    return None if any(part is None for part in parts) else parts
