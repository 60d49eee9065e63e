"""Outputs of scenes with kinks: the turn of each design is split at the kinks of its loads, friction and cams.

Each piece gets more crank angles until the error of an output, such as a mean, is below `goal` times the
largest value of its quantity. Angles in rad, values in SI.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..cycle import piecewise_reductions
from ..cycle.kinks import design_kinks
from ..cycle.piecewise import Pieces
from ..cycle.piecewise_reductions import MAX_OUTPUT_ERROR, values_key
from ..engines.program import program_of
from ..errors import NotGivenError
from ..machine.loads import KINK_TOLERANCE, TURN
from ..mechanics.jamming import solve_friction
from ..mechanics.quantities import component_sizes, quantity
from ..numbers.parameter_tree import Leaves, flatten, unflatten
from .scene import unchecked_solution

POINTS = 12
"""Points of a piece."""
START_ANGLES = 192
"""Crank angles of a turn at the start; enough for most outputs of a turn split at its kinks."""
BLOCK_VALUES = 100_000
"""Values over designs and angles that NumPy computes at a time; about this number fits into the cache."""


def unchecked_turn(scene, angles):
    """Unchecked solution at a number of even crank angles over the period, or at given angles."""
    if scene.friction.acting:
        scene = solve_friction(scene)
    return unchecked_solution(scene, scene.turn(angles), "numpy")


def quantity_names(outputs):
    return list(dict.fromkeys(item.quantity for item in outputs))


class PiecewiseTurns(NamedTuple):
    """Turns of all designs of a scene, split at their kinks into `pieces`.

    `goal` is the largest error of an output, relative to the largest value of its quantity; the engine is "numpy" or
    "compiled".
    """

    scene: Any
    pieces: Any
    goal: float
    engine: str = "numpy"

    @classmethod
    def of(cls, scene, outputs, angles, kink_tolerance=KINK_TOLERANCE, engine="numpy"):
        """Pieces for some outputs with at least `angles` crank angles; smaller kinks of loads are ignored."""
        solution = unchecked_turn(scene, 1)
        count, order = math.prod(solution.shape[:-1]), max(item.order or 0 for item in outputs)
        found, rest = design_kinks(solution, kink_tolerance)
        found, period = np.broadcast_to(found, (count, found.shape[1])), solution.period
        width = min(period * POINTS / angles, TURN / (2 * order or 1))
        return cls(scene, Pieces.between(found, period, width, POINTS), max(MAX_OUTPUT_ERROR, rest), engine)

    @property
    def designs(self):
        """Number of designs."""
        return self.pieces.firsts.size

    def values(self, names, designs, angle):
        """Values (P, N) by quantity, of vectors magnitudes, of the designs (P,) of pieces at crank angles (P, N)."""
        leaves, count = Leaves(), self.designs
        structure = flatten(self.scene, leaves)
        if count > 1 and leaves.lasting:
            numbers = (part[designs] if np.shape(part)[:1] == (count,) else part for part in leaves.numbers)
            scene = unflatten(structure, numbers.__next__, iter(leaves.tables).__next__, iter(leaves.parts).__next__)
            everywhere, own = angle, (slice(None), slice(None))
        else:  # of one design, or a part, as a function, may contain numbers of designs that cannot be separated
            scene, number = self.scene, np.arange(designs.size) - np.searchsorted(designs, designs)
            everywhere = np.broadcast_to(angle[0], (count, number.max() + 1, angle.shape[1])).copy()
            everywhere[designs, number], own = angle, (designs, number)
        flat = everywhere.reshape(len(everywhere), -1)
        found = _magnitudes(unchecked_turn(scene, flat), names, self.engine)
        rows = (np.broadcast_to(row, flat.shape).reshape(everywhere.shape)[own] for row in found)
        return dict(zip(names, rows, strict=True))

    def refined(self, outputs):
        """Yield blocks of designs: their numbers, refined pieces, and values by `values_key`."""
        vectors = {name: quantity(self.scene, name).vector for name in quantity_names(outputs)}
        step = max(1, BLOCK_VALUES * self.designs // self.pieces.check_angles.size)
        for start in range(0, self.designs, step):
            some = np.arange(start, min(start + step, self.designs))
            pieces, _ = self.pieces.of_designs(np.isin(np.arange(self.designs), some))

            def evaluated(angle, designs, start=start):
                return self.values(list(vectors), start + designs, angle)

            yield some, *piecewise_reductions.resolved(pieces, outputs, vectors, evaluated, self.goal)

    def estimated(self, outputs):
        """Outputs (outputs, designs), and whether each is still uncertain with the finest pieces."""
        vectors = {name: quantity(self.scene, name).vector for name in quantity_names(outputs)}
        found = np.empty((2, len(outputs), self.designs))
        with np.errstate(all="ignore"):
            for designs, pieces, values in self.refined(outputs):
                for row, item in enumerate(outputs):
                    own = values[values_key(item, vectors)]
                    found[:, row, designs] = piecewise_reductions.estimated(pieces, item, own, vectors[item.quantity])
        return found


def _magnitudes(solution, names, engine):
    """Values of quantities, of vectors magnitudes, a list of arrays."""
    state, compiled = solution.dynamics, engine == "compiled"
    try:
        program, leaves = program_of(state, tuple(names), sizes=True, lasting=not compiled)
    except NotGivenError:
        with np.errstate(all="ignore"):
            return [component_sizes(solution, name)[0] for name in names]
    return program.run(state, leaves, compiled)
