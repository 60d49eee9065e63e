"""Pairs of links that rub: what a group declares in `pairs`, by the name of the reaction.

A pin is fixed to the link that owns its joint; each rod on it rubs against it alone.
"""

from typing import Any, NamedTuple


class Turning(NamedTuple):
    """A pin: `link` turns against another, the one that carries `joint` unless told; the reaction acts on `link`.

    What turns against itself never turns: both are parts of one rigid triangle.
    """

    link: str
    joint: str
    against: str = ""


class Sliding(NamedTuple):
    """A straight pair: `link` slides along another, at `joint`.

    `force` is the name of the force across the pair, `couple` that of the moment it carries. The group answers
    ``sliding(name, placement)`` with a `Slide`.
    """

    link: str
    joint: str
    against: str
    force: str
    couple: str


class Rolling(NamedTuple):
    """A roller on a pin of `link` at `joint`, pressed by `force` against a fixed curve, positive from its outside."""

    link: str
    joint: str
    force: str


class Slide(NamedTuple):
    """Direction of a straight pair (None: +x), d s / d phi of the sliding link along it, and the moment of a unit force
    along it about the reference joint of what it slides on (None: none).
    """

    direction: Any
    rate: Any
    moment: Any = None
