"""What friction of a pair is: a constant times the size of a reaction, its direction, and where that has a kink."""

from typing import Any, NamedTuple

from ..machine.group import FRAME
from ..machine.pairs import Sliding
from ..numbers.elementary import held, sign, sqrt
from ..numbers.planar import minus, product

TINY = 1e-290
"""Square of a force that counts as nothing but can be divided by."""


class Law(NamedTuple):
    """A friction moment or force: `factor` times the size of what is watched.

    Attributes
    ----------
    name : str
        Of the pair.
    factor : number
        With the sign of the motion.
    watched : function
        From a `Resolved` to what is watched, a tuple of components.
    kind : str
        "length" of a vector, "size" of a number, "larger" of the sizes of two, or the number "itself".
    effects : tuple of (Channel, int)
        What it puts on links.
    """

    name: str
    factor: Any
    watched: Any
    kind: str
    effects: tuple


class Channel(NamedTuple):
    """Loads on links, and pushes on sliders, of a unit of friction: of all moments on a link, or of a force."""

    name: str
    wrenches: tuple = ()
    pushes: tuple = ()


def rate_of(part, name, pair, placement):
    """Rate by the crank angle at which a pair of a part turns or slides; None if it never does."""
    if isinstance(pair, Sliding):
        return part.sliding(name, placement).rate
    if pair.against == pair.link:
        return None
    against = None if pair.against == FRAME else placement.links[pair.against].ratio
    return minus(placement.links[pair.link].ratio, against)


def direction_of(law, parts):
    """Factor times direction of what a law watches: by components."""
    if law.kind == "itself":
        return (law.factor,)
    if law.kind == "size" or len(parts) == 1:
        return (None if parts[0] is None else law.factor * sign(parts[0]),)
    first, second = parts
    if first is None and second is None:
        return (None, None)
    if law.kind == "length":
        over = 1.0 / size_of("length", parts)  # of a direction friction depends but in second order: see the module
        return tuple(product(law.factor, None if part is None else held(over * part)) for part in parts)
    if first is None or second is None:
        return tuple(None if part is None else law.factor * sign(part) for part in parts)
    ahead = 0.5 * sign(abs(first) - abs(second))
    return law.factor * (0.5 + ahead) * sign(first), law.factor * (0.5 - ahead) * sign(second)


def bends(kind, parts):
    """What is zero where the size of what is watched has a kink; that of a vector has none but where it vanishes."""
    given = [part for part in parts if part is not None]
    if kind == "larger" and len(given) == 2:
        return [given[0], given[1], abs(given[0]) - abs(given[1])]
    return given if kind == "size" else []


def size_of(kind, parts):
    """Size of what is watched, None if it is absent."""
    if kind == "itself":
        return parts[0]
    given = [part for part in parts if part is not None]
    if not given:
        return None
    if len(given) == 1:
        return abs(given[0])
    if kind == "length":
        return sqrt(given[0] * given[0] + given[1] * given[1] + TINY)
    return larger(abs(given[0]), abs(given[1]))


def larger(a, b):
    return 0.5 * (a + b + abs(a - b))


def smaller(a, b):
    return 0.5 * (a + b - abs(a - b))
