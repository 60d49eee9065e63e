"""Friction laws of a part together: linear equations with the directions of what they watch, solved pass by pass.

How each pass follows from the one before, `friction` says.
"""

from functools import reduce
from typing import Any

from ..numbers.elementary import held, root
from ..numbers.nothing import absent
from ..numbers.planar import minus, number, plus, product
from .friction_laws import direction_of, larger, size_of, smaller

SMALL = 1e-100
"""Friction that need not be found to rounding."""


class System:
    """Friction laws of a part, and how what they watch hangs on the channels that friction acts by."""

    def __init__(self, laws, names, free, columns):
        self.laws = laws
        self.free = [tuple(map(absent, law.watched(free))) for law in laws]
        slopes = [[tuple(map(absent, law.watched(column))) for column in columns] for law in laws]
        feeling = [sum(any(part is not None for part in law[place]) for law in slopes) for place in range(len(names))]
        felt = [place for place in sorted(range(len(names)), key=feeling.__getitem__) if feeling[place]]
        self.slopes = [[law[place] for place in felt] for law in slopes]
        places = {names[place]: number for number, place in enumerate(felt)}
        self.effects = [
            [(places[channel.name], way) for channel, way in law.effects if channel.name in places] for law in laws
        ]
        self.count = len(felt)
        self.residual = None
        self.margin = self._margin() if felt else None

    def solved(self, passes, angle):
        """Friction of each law, NaN where it jams or is not the only one."""
        watched: list[Any] = self.free
        amounts, unknowns = self._amounts(watched), []
        if self.margin is None:
            return amounts
        signs = all(law.kind != "length" for law in self.laws)  # found at once unless friction turns one
        for step in range(passes - signs):
            unknowns = self._linear(watched) if step else self._totals(amounts)
            watched = [self._at(number, unknowns) for number in range(len(self.laws))]
        amounts = self._amounts(watched)
        self.residual = self._residual(unknowns, amounts, watched)
        closed = held(0.0 * root(self.margin + 0.0 * angle, 1.0))
        return [amount + closed for amount in amounts]

    def _amounts(self, watched):
        """Friction of each law, from what it watches."""
        sizes = (size_of(law.kind, parts) for law, parts in zip(self.laws, watched, strict=True))
        return [number(product(law.factor, size)) for law, size in zip(self.laws, sizes, strict=True)]

    def _totals(self, amounts):
        """Friction by channel, from that of each law."""
        found: list[Any] = [None] * self.count
        for amount, effects in zip(amounts, self.effects, strict=True):
            for place, way in effects:
                found[place] = (plus if way > 0 else minus)(found[place], amount)
        return found

    def _at(self, law, unknowns):
        """What a law watches, for given friction."""
        found = list(self.free[law])
        for slope, unknown in zip(self.slopes[law], unknowns, strict=True):
            found = [plus(part, product(unknown, one)) for part, one in zip(found, slope, strict=True)]
        return tuple(found)

    def _linear(self, watched):
        """Friction by channel with the directions of what laws watch."""
        directed = [direction_of(law, parts) for law, parts in zip(self.laws, watched, strict=True)]
        matrix: list[list] = [[None] * self.count for _ in range(self.count)]
        right: list[Any] = [None] * self.count
        for law, weights in enumerate(directed):
            constant = _weighted(weights, self.free[law])
            row = [_weighted(weights, slope) for slope in self.slopes[law]]
            for place, way in self.effects[law]:
                add = plus if way > 0 else minus
                right[place] = add(right[place], constant)
                matrix[place] = [add(one, other) for one, other in zip(matrix[place], row, strict=True)]
        return _eliminated(matrix, right)

    def _margin(self):
        """How far friction is from jamming: 1 without friction, 0 where it may jam or have several solutions.

        Smallest pivot of one less the largest feedback from friction to friction: all are positive if and only if its
        spectral radius is less than 1. Then friction is a contraction, for all loads and senses of motion, so there is
        one state. That is necessary as well for a guide or pin alone, 1 - |kappa|, but not for several joints, whose
        feedbacks may be of opposite signs.
        """
        matrix: list[list] = [[None] * self.count for _ in range(self.count)]
        for law, slopes, effects in zip(self.laws, self.slopes, self.effects, strict=True):
            kind = "size" if law.kind == "itself" else law.kind
            sizes = [product(abs(law.factor), size_of(kind, slope)) for slope in slopes]
            for place, _ in effects:
                matrix[place] = [plus(one, other) for one, other in zip(matrix[place], sizes, strict=True)]
        return reduce(smaller, _pivots(matrix))

    def _residual(self, unknowns, amounts, watched):
        """Change of the forces that friction hangs on by one more pass, over the largest of them."""
        changes = [minus(total, unknown) for total, unknown in zip(self._totals(amounts), unknowns, strict=True)]
        moved, sizes = [], []
        for law, slopes, parts in zip(self.laws, self.slopes, watched, strict=True):
            shifts = [_weighted(changes, column) for column in zip(*slopes, strict=True)]
            kind = "size" if law.kind == "itself" else law.kind
            moved.append(size_of(kind, shifts))
            sizes.append(size_of(kind, parts))
        given = [[part for part in found if part is not None] for found in (moved, sizes)]
        change, largest = (reduce(larger, found, 0.0) for found in given)
        return change / (largest + SMALL)


def _weighted(weights, parts):
    return reduce(plus, (product(weight, part) for weight, part in zip(weights, parts, strict=True)))


def _eliminated(matrix, right):
    """Solution x of x - matrix x = right, by elimination: near one no pivot is small."""
    above, right, inverse = _triangle(matrix, right)
    count, found = len(right), [None] * len(right)
    for i in reversed(range(count)):
        rest = reduce(plus, (product(above[i][k], found[k]) for k in range(i + 1, count)), None)
        found[i] = product(minus(right[i], rest), inverse[i])
    return [number(one) for one in found]


def _pivots(matrix):
    """Pivots of one less a matrix."""
    above, _, _ = _triangle(matrix, [None] * len(matrix))
    return [row[i] for i, row in enumerate(above)]


def _triangle(matrix, right):
    """One less a matrix, and a right-hand side, with nothing left below the pivots; and the pivots' inverses."""
    count = len(right)
    rows = [[minus(1.0 if i == k else None, matrix[i][k]) for k in range(count)] for i in range(count)]
    right, inverse = list(right), []
    for i in range(count):
        inverse.append(1.0 / rows[i][i])
        for k in range(i + 1, count):
            factor = product(rows[k][i], inverse[i])
            rest = zip(rows[k][i + 1 :], rows[i][i + 1 :], strict=True)
            rows[k][i + 1 :] = [minus(one, product(factor, other)) for one, other in rest]
            right[k] = minus(right[k], product(factor, right[i]))
    return rows, right, inverse
