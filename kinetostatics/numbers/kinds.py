"""What all items of one structure have in common: found once, and kept by structure."""

import itertools
import threading
from typing import Any

from .lazy import cached_property
from .leaves import put_together

MOST = 256
"""Structures that are known at a time; the longest unused goes first."""


class Numbered(int):
    """Place of a number among the leaves of an item."""


class Kind:
    """A structure, as `structures.taken_apart` gives it, and what is known of all items that have it.

    Attributes
    ----------
    structure : tuple
    known : dict
        Whatever was found to hold for all of them, by the question.
    used : int
        When it was last asked for, counted in such questions.
    """

    def __init__(self, structure):
        self.structure, self.known, self.used = structure, {}, 0

    def __reduce__(self):
        return Kind, (self.structure,)

    @cached_property
    def numbered(self) -> Any:
        """The item with the place of each number among its leaves, a `Numbered`, instead of it."""
        places = itertools.count()
        return put_together(self.structure, lambda: Numbered(next(places)), lambda: None, lambda: None)

    def answer(self, question):
        """What ``question(kind)`` found, asked once."""
        if question not in self.known:
            self.known[question] = question(self)
        return self.known[question]


_kinds: dict[Any, Kind] = {}
_lock = threading.Lock()
_uses = itertools.count()


def of(structure) -> Kind:
    """Kind of a structure that tells all."""
    found = _kinds.get(structure) or _added(structure)
    found.used = next(_uses)
    return found


def _added(structure):
    """A new kind, or that which another thread has added meanwhile."""
    with _lock:
        found = _kinds.setdefault(structure, Kind(structure))
        found.used = next(_uses)
        while len(_kinds) > MOST:
            idle = min((kind for kind in _kinds.values() if kind is not found), key=lambda kind: kind.used)
            del _kinds[idle.structure]
    return found


def forget():
    """Find all anew."""
    with _lock:
        _kinds.clear()
