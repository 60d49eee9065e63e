"""Pieces of a turn halved, those of each design that do not tell its outputs, until all are told.

What bends where nobody says so, as friction in a pin does where the reaction passes near zero within as small an angle
as it likes, is smooth on pieces that are smaller still; a few of them reach there.
"""

from typing import NamedTuple

import numpy as np

from ..machine.loads import TURN
from .means import NODES
from .pieces import NARROWEST, signs
from .reductions import PEAKS

GOAL = 1e-8
"""Share of the largest value of a quantity by which an output may be wrong."""
FEW = 8
"""Pieces, about, that are doubtful and take part in an integral."""
MOST = 720
"""Pieces a turn that halving adds to a design at most."""


def refined(pieces, values, outputs, evaluate, goal=GOAL):
    """Parts of the designs: which, their pieces, and values by quantity, so fine that these tell the outputs if any do.

    Parameters
    ----------
    pieces : Pieces
    values : dict of str to array (designs, N)
    outputs : sequence of (Output, bool)
        Each with whether its quantity is a vector.
    evaluate : function
        From places of designs (D,) and crank angles (D, N) to values (D, N) by quantity.
    goal : float
        Share of the largest value of a quantity by which an output may be wrong.
    """
    designs, first = np.arange(len(pieces.start)), (pieces.width > 0.0).sum(axis=1)
    most = first + MOST * round(pieces.period / TURN)
    values = {name: found.reshape(*pieces.start.shape, NODES.size) for name, found in values.items()}
    asked = _asked(outputs)
    while designs.size:
        halved = np.zeros(pieces.start.shape, dtype=bool)
        for name, own in asked.items():
            halved |= own.unresolved(pieces, values[name], goal)
        halved &= pieces.width >= NARROWEST
        count = (pieces.width > 0.0).sum(axis=1) + halved.sum(axis=1)
        going = halved.any(axis=1) & (count <= most[designs])
        if not going.all():
            yield designs[~going], pieces.some(~going), {name: found[~going] for name, found in values.items()}
        designs, pieces, halved = designs[going], pieces.some(going), halved[going]
        values = {name: found[going] for name, found in values.items()}
        if designs.size:
            pieces, values = _halved(pieces, values, halved, lambda angle, own=designs: evaluate(own, angle))


class _Asked(NamedTuple):
    """What outputs want of a quantity: signs of its peaks, and whether its integral."""

    vector: bool
    signs: frozenset
    summed: bool

    def unresolved(self, pieces, values, goal):
        """Pieces (designs, P) by which one of them may be wrong by more than a share of the largest value."""
        size, rough = np.abs(values).max(axis=(1, 2))[:, None], np.zeros(pieces.start.shape, dtype=bool)
        with np.errstate(invalid="ignore"):
            if self.signs:
                rough |= pieces.of_peaks(values, self.signs, self.vector) > goal * size
            if self.summed:
                rough |= pieces.of_integrals(values) > goal / FEW * size
        return rough


def _asked(outputs):
    found: dict[str, _Asked] = {}
    for output, vector in outputs:
        _, known, summed = found.get(output.quantity, (vector, frozenset(), False))
        peak = output.reduction in PEAKS
        found[output.quantity] = _Asked(
            vector, known.union(signs(output.reduction) if peak else ()), summed or not peak
        )
    return found


def _halved(pieces, values, halved, evaluate):
    """Pieces with some of them halved, and values, those of the halves evaluated; each design has some."""
    design, piece = np.nonzero(pieces.width > 0.0)
    parts = 1 + halved[design, piece]
    second = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts) == 1
    design, piece, parts = (np.repeat(part, parts) for part in (design, piece, parts))
    width = pieces.width[design, piece] / parts
    start = pieces.start[design, piece] + second * width
    joined = second | pieces.joined[design, piece]
    count = np.bincount(design, minlength=len(halved))
    column = np.arange(design.size) - (np.cumsum(count) - count)[design]
    shape = len(halved), count.max()
    found = type(pieces)(
        np.broadcast_to(pieces.start[:, :1], shape).copy(), np.zeros(shape), np.ones(shape, dtype=bool), pieces.period
    )
    for whole, part in zip(found, (start, width, joined), strict=False):
        whole[design, column] = part
    new = parts == 2
    many = 2 * halved.sum(axis=1)
    place = np.arange(new.sum()) - (np.cumsum(many) - many)[design[new]]
    angle = np.repeat(pieces.angle[:, None, : NODES.size], many.max(), axis=1)
    angle[design[new], place] = start[new, None] + width[new, None] * NODES
    evaluated = evaluate(angle.reshape(len(angle), -1))
    filled = {}
    for name, old in values.items():
        filled[name] = np.broadcast_to(old[:, :1], (*shape, NODES.size)).copy()
        filled[name][design[~new], column[~new]] = old[design[~new], piece[~new]]
        filled[name][design[new], column[new]] = evaluated[name].reshape(angle.shape)[design[new], place]
    return found, filled
