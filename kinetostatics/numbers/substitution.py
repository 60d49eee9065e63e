"""The same mechanism and loads with other kinds of numbers in place of their own: recorded ones, enclosures."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ..machine.guide import Guide

KEPT = ("assembly", "period")
"""Fields that are no numbers of the arithmetic."""


def with_numbers(item, number: Callable[[Any], Any], special: dict | None = None):
    """Copy of parameters with ``number(value)`` in place of each number and array.

    Structure stays: plain zeros, which kernels take to be absent, assemblies, a level guide, names. `special` holds by
    type functions that copy an item in their own way. Nothing is checked anew.
    """
    for kind, copied in (special or {}).items():
        if isinstance(item, kind):
            return copied(item)
    if is_dataclass(item):
        numbers = {field.name: getattr(item, field.name) for field in fields(item) if field.name not in KEPT}
        return with_fields(item, **{name: with_numbers(value, number, special) for name, value in numbers.items()})
    if isinstance(item, Guide):
        direction = item.direction if item.is_level else with_numbers(item.direction, number, special)
        return Guide(direction, with_numbers(item.guide_offset, number, special))
    if isinstance(item, tuple | list):
        return tuple(with_numbers(part, number, special) for part in item)
    if isinstance(item, int | float | np.number) and item == 0:
        return item
    return number(item) if isinstance(item, int | float | np.number | np.ndarray) else item


def with_fields(item, **changes):
    """Copy of a dataclass with some fields changed and nothing checked."""
    made = object.__new__(type(item))
    for field in fields(item):
        object.__setattr__(made, field.name, changes.get(field.name, getattr(item, field.name)))
    return made
