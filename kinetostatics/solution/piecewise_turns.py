"""Outputs of scenes with kinks: the turn of each design is split at the kinks of its loads, friction and cams.

Each piece gets more crank angles until an output, as an extreme or a mean, is known to the share `goal` of its
quantity's largest value. Angles in rad, values SI.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..cycle.kinks import design_kinks
from ..cycle.pieces import MAX_OUTPUT_ERROR, Pieces, refined
from ..engines.program import program_of
from ..errors import NotGivenError
from ..machine.loads import KINK_TOLERANCE
from ..mechanics.jamming import solve_friction
from ..mechanics.quantities import component_sizes, quantity
from ..numbers.parameter_tree import Leaves, flatten, unflatten
from .scene import unchecked_solution

START_ANGLES = 192
"""Crank angles of a turn at the start; enough for most outputs of a turn split at its kinks."""
BLOCK_VALUES = 100_000
"""Values over designs and angles that NumPy computes at a time; about as many fit into the cache."""


def unchecked_turn(scene, angles):
    """Unchecked solution at a number of even crank angles over the period, or at given angles."""
    if scene.friction.acting:
        scene = solve_friction(scene)
    return unchecked_solution(scene, scene.turn(angles), "numpy")


def quantity_names(outputs):
    return list(dict.fromkeys(item.quantity for item in outputs))


class PiecewiseTurns(NamedTuple):
    """Turns of all designs of a scene, split at their kinks.

    Attributes
    ----------
    scene : Scene
    designs : int
        Number of designs.
    pieces : Pieces
        Pieces at the start.
    goal : float
        Largest error of an output, relative to the largest value of its quantity.
    engine : "numpy" or "compiled"
    """

    scene: Any
    designs: int
    pieces: Any
    goal: float
    engine: str = "numpy"

    @classmethod
    def of(cls, scene, outputs, angles, straight=KINK_TOLERANCE, engine="numpy"):
        """Pieces for some outputs with at least `angles` crank angles; kinks of loads below `straight` are ignored."""
        solution = unchecked_turn(scene, 1)
        count, order = math.prod(solution.shape[:-1]), max(item.order or 0 for item in outputs)
        found, jumps, rest = design_kinks(solution, straight)
        found = np.broadcast_to(found, (count, found.shape[1]))
        pieces = Pieces.of(found, solution.period, angles, order, jumps)
        return cls(scene, count, pieces, max(MAX_OUTPUT_ERROR, rest), engine)

    def values(self, names, designs, angle):
        """Values (D, N) by quantity, of vectors magnitudes, of some designs (D,) at crank angles (D, N)."""
        scene, count, own = self._of(designs)
        values, everywhere = {name: np.empty(angle.shape) for name in names}, np.repeat(angle[:1], count, axis=0)
        everywhere[own] = angle
        step = max(1, BLOCK_VALUES // count)
        for start in range(0, angle.shape[1], step):
            some = slice(start, start + step)
            found = _magnitudes(unchecked_turn(scene, everywhere[:, some]), names, self.engine)
            for name, part in zip(names, found, strict=True):
                values[name][:, some] = np.broadcast_to(part, everywhere[:, some].shape)[own]
        return values

    def refined(self, outputs):
        """Yield blocks of designs: their numbers, refined pieces, and values by quantity."""
        names = quantity_names(outputs)
        known = {name: quantity(self.scene, name).vector for name in names}
        wanted = [(item, known[item.quantity]) for item in outputs]
        step = max(1, BLOCK_VALUES // self.pieces.angle.shape[1])
        for start in range(0, self.designs, step):
            some = np.arange(start, min(start + step, self.designs))
            first = self.pieces.some(some)

            def evaluated(designs, angle, some=some):
                return self.values(names, some[designs], angle)

            values = evaluated(np.arange(some.size), first.angle)
            for designs, pieces, found in refined(first, values, wanted, evaluated, self.goal):
                yield some[designs], pieces, found

    def estimated(self, outputs):
        """Outputs (outputs, designs), and whether each is still uncertain with the finest pieces."""
        found = np.empty((2, len(outputs), self.designs))
        with np.errstate(all="ignore"):
            for designs, pieces, values in self.refined(outputs):
                for row, item in enumerate(outputs):
                    vector = quantity(self.scene, item.quantity).vector
                    found[:, row, designs] = pieces.estimated(item, values[item.quantity], vector)
        return found

    def _of(self, designs):
        """A scene with some of the designs, the number of its designs, and the places of those asked for.

        It has all designs if a part, as a function, may contain numbers of designs that cannot be separated.
        """
        leaves = Leaves()
        structure = flatten(self.scene, leaves)
        if len(designs) == self.designs or not leaves.lasting:
            return self.scene, self.designs, designs
        numbers = (part[designs] if np.shape(part)[:1] == (self.designs,) else part for part in leaves.numbers)
        scene = unflatten(structure, numbers.__next__, iter(leaves.tables).__next__, iter(leaves.parts).__next__)
        return scene, len(designs), np.arange(len(designs))


def _magnitudes(solution, names, engine):
    """Values of quantities, of vectors magnitudes, a list of arrays."""
    state, compiled = solution.dynamics, engine == "compiled"
    try:
        program, leaves = program_of(state, tuple(names), sizes=True, lasting=not compiled)
    except NotGivenError:
        with np.errstate(all="ignore"):
            return [component_sizes(solution, name)[0] for name in names]
    return program.run(state, leaves, compiled)
