"""Checks of the values a user hands in. Kernels trust what has passed here.

Only plain numbers and NumPy arrays of floats are looked at: a traced JAX number or an `arb` enclosure passes as it is.
"""

import math
import numbers
from typing import Any

import numpy as np

from .errors import ParameterError


class Problem(str):
    """What is wrong with a value, as a sentence; `designs` tells which of a batch have it, None all."""

    designs: Any

    def __new__(cls, text, wrong=None):
        made = super().__new__(cls, text)
        made.designs = wrong[..., 0] if np.ndim(wrong) > 1 else None
        return made


def known(value):
    """Whether the values can be looked at now."""
    if isinstance(value, np.ndarray):
        return value.dtype != object
    return value is None or isinstance(value, numbers.Real | str | list | tuple)


def problem(name, value, *, low=None, strict=False, table=False):
    """What is wrong with one value, as a sentence, or None; a `table` has a value for each crank angle."""
    if isinstance(value, float | int) and math.isfinite(value) and low is None:
        return None
    if not known(value):
        return None
    kind = "an array of numbers" if table else "an array of shape (designs, 1)"
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        return f"{name} must be a number or {kind}, got {value!r}"
    if isinstance(value, str) or (not table and (isinstance(value, list | tuple) or array.ndim == 1 < array.size)):
        return f"{name} must be a number or {kind}, got {value!r}"
    infinite = ~np.isfinite(array)
    if np.any(infinite):
        return Problem(f"{name} must be finite, got {value}", infinite)
    if low is not None:
        outside = array <= low if strict else array < low
        if np.any(outside):
            found = value if array.ndim == 0 else f"a smallest value of {array.min():g}"
            return Problem(f"{name} must be {'greater than' if strict else 'at least'} {low:g}, got {found}", outside)
    return None


def pair(name, value):
    """What is wrong with a vector (x, y), or None."""
    try:
        x, y = value
    except (TypeError, ValueError):
        return f"{name} must be a pair (x, y), got {value!r}"
    return problem(f"{name} x", x) or problem(f"{name} y", y)


def require(owner, *problems):
    """Raise one `ParameterError` that lists every problem found."""
    found = [text for text in problems if text]
    if found:
        masks: list[Any] = [getattr(text, "designs", None) for text in found]
        designs = None if any(mask is None for mask in masks) else np.any(np.broadcast_arrays(*masks), axis=0)
        raise ParameterError(f"{owner}: " + "; ".join(found), designs)


def fitting(**values):
    """What is wrong with shapes that do not broadcast together, or None; lists of values are looked at one by one."""
    shapes = {}
    for name, value in values.items():
        for number, item in enumerate(value if isinstance(value, list) else [value], 1):
            if not isinstance(item, float | int):
                shapes[f"{name} {number}" if number > 1 else name] = np.shape(item)
    if len(shapes) < 2:
        return None
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        text = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        return f"these shapes do not fit together: {text}; the last axis is the crank angle, designs come before it"
    return None


def positive(name, value):
    return problem(name, value, low=0.0, strict=True)


def not_negative(name, value):
    return problem(name, value, low=0.0)


def finite(name, value):
    return problem(name, value)


def table(name, value):
    return problem(name, value, table=True)


def unit_vector(name, value):
    """What is wrong with a direction, or None."""
    length = np.hypot(*value) if all(known(part) for part in value) else 1.0
    return None if np.all(np.abs(length - 1.0) < 1e-9) else f"{name} must have length 1, got {length}; use Guide.at"


def links(table):
    """What is wrong with the links of a group: they must be made by `Link`."""
    return [f"{name} must be a Link, got {link!r}" for name, link in table.items() if not hasattr(link, "body")]


def assembly_sign(value):
    return None if value in (1, -1) else f"assembly must be +1 or -1, got {value!r}"


MEMORY = 10_000_000_000
"""Bytes that no table of angles or designs may take."""
ANGLE = 1000
"""Bytes that the results at a crank angle take, all forces in a table."""


def count(name, value, *, size=None):
    """What is wrong with a number of things, or None; with their `size` in bytes, they must have room in memory."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 1:
        return f"{name} must be a whole number of at least 1, got {value!r}"
    if size is not None and value * size > MEMORY:
        found = f"{value} would take {value * size // 10**9} GB" if value < 10**15 else "so many would take all"
        return f"{name} must be at most {MEMORY // size}, as {found} of memory"
    return None


def solution(name, value):
    """What is wrong with what must be a `Solution`, or None."""
    if hasattr(type(value), "power_residual"):
        return None
    return (
        f"{name} must be a Solution, as ks.solve(...), case.solve(name) and variant.solve() return, "
        f"got {_described(value)}"
    )


def case(name, value):
    """What is wrong with what must be a `Case`, or None."""
    return None if hasattr(value, "variants") else f"{name} must be a Case, as ks.load_case, got {_described(value)}"


def mechanism(name, value):
    """What is wrong with what must be a `Mechanism`, or None."""
    if hasattr(type(value), "references"):
        return None
    return f"{name} must be a Mechanism, as ks.crank_slider(...) and solution.mechanism are, got {_described(value)}"


def quantity(value, *, function=False):
    """What is wrong with what must name a quantity, or None."""
    if isinstance(value, str) or (function and callable(value)):
        return None
    other = ", or a function of a solution" if function else ""
    return f'quantity must be a name, such as "balancing_torque" or "O"{other}, got {_described(value)}'


def _described(value):
    """A value as errors show it: what it is, and short."""
    text = repr(value) if isinstance(value, str | int | float | None) else ""
    return text if 0 < len(text) < 80 else f"a {type(value).__name__}"


def choice(name, value, allowed):
    """What is wrong with a name that must be one of `allowed`; names the nearest."""
    if value in allowed:
        return None
    return f"{name} is {value!r}, allowed: {', '.join(map(repr, allowed))}{hint(value, allowed)}"


def hint(value, allowed):
    """Question that names the nearest allowed word, empty if none is near."""
    import difflib

    near = difflib.get_close_matches(str(value), list(allowed), n=1)
    return f"; did you mean {near[0]!r}?" if near else ""
