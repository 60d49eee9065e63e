"""Faults of values as sentences, the one error that lists them, and "did you mean" by synonyms and spelling.

A function named after a kind of value (`count`, `truth` ...) returns the fault of a value not of this kind, or None.
"""

import numbers
import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ...errors import ParameterError

SYNONYMS = {
    # machines
    "four_bar": ("fourbar", "crank_rocker", "double_crank", "double_rocker"),
    "crank_slider": ("slider_crank",),
    "slotted_lever": ("quick_return", "whitworth"),
    "scotch_yoke": ("yoke",),
    # engines
    "compiled": ("numba", "jit", "njit", "fast"),
    "numpy": ("np", "python"),
    "jax": ("gpu", "xla"),
    # reductions
    "largest": ("max", "maximum", "maximal", "peak", "highest", "greatest"),
    "smallest": ("min", "minimum", "minimal", "lowest", "least"),
    "largest_at": ("argmax", "max_at"),
    "smallest_at": ("argmin", "min_at"),
    "largest_absolute": ("max_abs", "absmax", "abs_max", "amplitude"),
    "mean_absolute": ("mean_abs", "abs_mean"),
    "mean": ("average", "avg"),
    "rms": ("root_mean_square", "effective"),
    "range": ("ptp", "peak_to_peak", "span"),
    # outputs
    "mean balancing_torque": ("mean_torque", "mean_power", "energy_per_turn"),
    # quantities
    "balancing_torque": ("torque", "moment", "drive_torque", "driving_torque", "input_torque", "crank_torque"),
    "guide_force": ("normal_force", "side_force", "side_thrust"),
    "slider_position": ("position", "displacement", "stroke", "travel"),
    "slider_velocity": ("velocity", "speed"),
    "slider_acceleration": ("acceleration",),
    "O": ("support", "bearing", "main_bearing"),
    "A": ("crank_pin", "crankpin"),
    "B": ("wrist_pin", "gudgeon_pin", "piston_pin", "slider_pin"),
    # parameters and links
    "crank_speed": ("omega", "rpm", "speed", "angular_velocity"),
    "crank_acceleration": ("alpha", "angular_acceleration"),
    "crank_length": ("crank_radius", "throw"),
    "coupler_length": ("rod_length", "conrod_length", "connecting_rod_length"),
    "guide_offset": ("offset", "eccentricity"),
    "coupler": ("rod", "conrod", "connecting_rod"),
    "slider": ("piston", "crosshead", "ram"),
    "rocker": ("follower", "output_link"),
}
"""Synonyms of each of the library's words."""
_WORDS_BY_SYNONYM: dict[str, list[str]] = {}
for _word, _others in SYNONYMS.items():
    for _other in _others:
        _WORDS_BY_SYNONYM.setdefault(_other, []).append(_word)
MIN_SIMILARITY_OF_ALL = 0.9
"""Least similarity at which a whole text, rather than its last word, is matched with an allowed word."""
_UNIT = re.compile(r"\s*(?:\([^()]*\)|\[[^\[\]]*\])\s*$")
"""A unit after a name, as in headings."""
_PART = re.compile(r"([^\s.]*?)(\d*)(?=[\s.]|$)")
"""A word of a path or output, and the digits at its end."""


def nearest(value, allowed):
    """The nearest allowed word by synonym or spelling, or None; a unit and the bars of ``"|O|"`` are ignored."""
    import difflib

    text, allowed = _UNIT.sub("", str(value)[:100]).strip("|"), list(allowed)
    by_lower = {str(word).lower(): word for word in reversed(allowed)}
    for spelled in (text, *_synonym_spellings(text.lower())):
        if spelled.lower() in by_lower:
            return by_lower[spelled.lower()]
    last = by_lower.get(text.rpartition(" ")[2].lower())
    for cutoff in (MIN_SIMILARITY_OF_ALL, 0.6):
        if found := difflib.get_close_matches(text, allowed, 1, cutoff):
            return found[0]
        if last is not None:
            return last
    return None


def _synonym_spellings(text):
    """Spellings of a text in the library's words: replaced as a whole, then word by word."""
    yield from _WORDS_BY_SYNONYM.get(text, ())
    yield _PART.sub(lambda found: _WORDS_BY_SYNONYM.get(found[1], [found[1]])[0] + found[2], text)


class Problem(str):
    """Fault of a value, as a sentence; `designs` is the mask of the designs that have it, None for all.

    `wrong` is the mask of the values at fault in an array (designs, N).
    """

    designs: Any

    def __new__(cls, text, wrong=None):
        made = super().__new__(cls, text)
        made.designs = np.any(wrong, axis=-1) if np.ndim(wrong) > 1 else None
        return made


def shown(value):
    """Text of a value, short enough for a message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 120 else f"{text[:80]} ... {text[-20:]}"


def require(owner, *problems):
    """Raise one `ParameterError` that lists every problem found."""
    if any(problems):
        found = [text for text in problems if text]
        masks: list[Any] = [getattr(text, "designs", None) for text in found]
        designs = None if any(mask is None for mask in masks) else np.any(np.broadcast_arrays(*masks), axis=0)
        raise ParameterError(f"{owner}: " + "; ".join(found), designs)


def broadcast_problem(**shapes):
    """Fault if named shapes do not broadcast together, else None."""
    if len(shapes) < 2:
        return None
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        text = ", ".join(f"{name} {tuple(shape)}" for name, shape in shapes.items() if shape)
        return f"these shapes do not fit together: {text}; the last axis is the crank angle, designs come before it"
    return None


MAX_TABLE_MEMORY = 10_000_000_000
"""Largest size of a table of angles or designs, bytes."""
MAX_COUNT = 10**15
"""Largest whole number where no table is needed."""
BYTES_PER_ANGLE = 1000
"""Memory for the results at one crank angle, in a table of all forces, bytes."""


def count(name, value, *, size=None):
    """Fault unless the value is a whole number of at least 1; ``value * size`` bytes must fit into memory."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 1:
        return f"{name} must be a whole number of at least 1, got {value!r}"
    if size is None and int(value) > MAX_COUNT:
        return f"{name} must be at most {MAX_COUNT}, got {shown(value)}"
    if size is not None and value * size > MAX_TABLE_MEMORY:
        found = f"{value} would need {value * size // 10**9} GB" if value < 10**15 else "this number would need all"
        return f"{name} must be at most {MAX_TABLE_MEMORY // size}, as {found} of memory"
    return None


def truth(name, value):
    """Fault unless the value is True or False."""
    return None if isinstance(value, bool | np.bool_) else f"{name} must be True or False, got {shown(value)}"


def mapping(name, value):
    """Fault unless the value is a mapping."""
    found = isinstance(value, Mapping)
    return None if found else f'{name} must be a dict of path to number, as {{"crank_length": 0.3}}, got {shown(value)}'


def names(name, value):
    """Fault unless the value is a name, or several."""
    several = isinstance(value, Iterable) and not isinstance(value, bytes | Mapping)
    return None if several else f"{name} must be a name, or several in a list, got {shown(value)}"


def seed(name, value):
    """Fault unless the value is a seed of random numbers, or None."""
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 0:
        return f"{name} must be a whole number of at least 0, got {shown(value)}"
    return None


def solution(name, value):
    """Fault unless the value is a `Solution`."""
    if hasattr(type(value), "power_residual"):
        return None
    return (
        f"{name} must be a Solution, as ks.solve(...), case.solve(name) and variant.solve() return, "
        f"got {_described(value)}"
    )


def case(name, value):
    """Fault unless the value is a `Case`."""
    return None if hasattr(value, "variants") else f"{name} must be a Case, as ks.load_case, got {_described(value)}"


def mechanism(name, value):
    """Fault unless the value is a `Mechanism`."""
    if hasattr(type(value), "references"):
        return None
    return f"{name} must be a Mechanism, as ks.crank_slider(...) and solution.mechanism are, got {_described(value)}"


def quantity(value, *, function=False):
    """Fault unless the value is the name of a quantity, or a function if allowed."""
    if isinstance(value, str) or (function and callable(value)):
        return None
    other = ", or a function of a solution" if function else ""
    return f'quantity must be a name, such as "balancing_torque" or "O"{other}, got {_described(value)}'


def _described(value):
    """Short text of a value, or its type."""
    text = repr(value) if isinstance(value, str | int | float | None) else ""
    return text if 0 < len(text) < 80 else f"a {type(value).__name__}"


def choice(name, value, allowed):
    """Fault unless the value is one of `allowed`, with the nearest of these."""
    if (type(value) is str and value in allowed) or any(value is word for word in allowed):
        return None
    return f"{name} is {shown(value)}, allowed: {', '.join(map(repr, allowed)) or 'none'}{hint(value, allowed)}"


def hint(value, allowed):
    """Question "; did you mean ...?" with the nearest allowed word; empty without a near word."""
    near = nearest(value, allowed)
    return f"; did you mean {near!r}?" if near else ""
