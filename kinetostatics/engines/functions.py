"""What is known of functions however computed: of sines and cosines next to one, of totals, of what is moved apart."""

from functools import reduce
from operator import add

from ..numbers.elementary import APART, UNIT, UNSEEN
from ..numbers.planar import plus
from .graph import BY_DESIGN, Node

ULP = {"sin": 2.0, "cos": 2.0, "atan": 2.0, "sqrt": 1.0, "root": 1.0}
"""Largest relative error of a function of any backend, in `UNIT`; a test holds NumPy and compiled loops to it."""
OTHER = {"sin": "cos", "cos": "sin"}
SMALL = 2.0**-27
"""Sine or cosine below which the other is a sign exactly; a test holds NumPy and compiled loops to it."""
SHARE = 4.5
"""Part of its other squared that a sine or cosine is off at most: half of it below `SMALL`, and above by `ULP`.

In single precision, too, to which it is rounded once.
"""
LOST = 2.0**-900
"""In units: what the square may have lost as too small."""


def beside_one(graph, node, of_sign, unit=UNIT):
    """Bound on the error, in units, that a sum of one and a sine or cosine of the crank angle has of that.

    None for other nodes. Where the sum vanishes, as linkages fold, this does so as well, which `ULP` does not tell.
    Along an axis it is times a sign that a design has; ``of_sign(sign)`` bounds the error of that: 0 or None where it
    is known, else infinite or NaN, as then the whole is. It is a number of the design, so it costs no angle anything.
    """
    turn, sign = _beside_one(node)
    if turn is None:
        return None
    other = graph.node(OTHER[turn.operation], *turn.arguments)
    unsure = None if sign is None else of_sign(sign)
    square = (-SHARE / unit) * (other * other)
    return -graph.node("divisor", square - plus(LOST, unsure), -plus(ULP[turn.operation], unsure))


def _beside_one(node):
    """The sine or cosine of the crank angle to which, or to its opposite, one is added, and the sign it is times."""
    if node.operation not in "+-" or len(node.arguments) != 2:
        return None, None
    turn, one = sorted(node.arguments, key=lambda part: not isinstance(part, Node))
    if isinstance(one, Node) or abs(one) != 1.0:
        return None, None
    sign = None
    if turn.operation == "*":  # along an axis
        sign, turn = sorted(turn.arguments, key=_is_of_angle)
        if not (isinstance(sign, Node) and sign.operation == "sign" and sign.varies == BY_DESIGN):
            return None, None
    return (turn, sign) if _is_of_angle(turn) else (None, None)


def _is_of_angle(part):
    return isinstance(part, Node) and part.operation in OTHER and part.arguments[0].operation == "angle"


def is_over_root(node):
    """Whether a node is one over a root, which is not too small for a double unless the square is infinite."""
    above, below = node.arguments
    while isinstance(below, Node) and below.operation == "divisor":
        below = below.arguments[0]
    is_root = isinstance(below, Node) and below.operation in ("sqrt", "root")
    return node.operation == "/" and is_root and not isinstance(above, Node) and abs(above) >= 1.0


def lost_by_total(graph, node):
    """Bound on the error of a total, in `UNIT`, beside the rounding of itself.

    Of numbers of a design nothing is lost where the last losses are zero, as they are where lengths fall in line.
    """
    parts = node.arguments
    if node.varies == BY_DESIGN:
        return 8.0 * graph.node("lost", *parts)
    return ((2.0 * (len(parts) - 1)) ** 3 * UNIT * UNIT) * reduce(add, map(abs, parts))


def beside_length(graph, rest):
    """Bound on the error of a length and its rest together, in `UNIT`: none where rounding took nothing."""
    length = rest.arguments[0]
    lost = graph.node("lost_by_squares", *rest.arguments)
    return 4.0 * abs(rest) + (rest * rest * (1.0 / UNIT) + 8.0 * lost) / length


def moved_apart(parts, unit=UNIT):
    """What a number is off, in units, that `elementary.apart` moved off zero; None where it did not."""
    for part in parts:
        if not isinstance(part, Node):
            if part == APART * UNSEEN:
                return APART * UNSEEN / unit
        elif part.operation == "*" and APART in (factor for factor in part.arguments if not isinstance(factor, Node)):
            return part * (1.0 / unit)
    return None
