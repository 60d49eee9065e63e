"""Outputs of scenes whose loads, friction or cams bend: the turn of each parted there, and finer where need be."""

import math
from typing import Any, NamedTuple

import numpy as np

from ..engines.program import program_of
from ..errors import NotGivenError
from ..machine.loads import KINK_TOLERANCE
from ..mechanics.jamming import solve_friction
from ..mechanics.quantities import component_sizes, quantity
from ..numbers.parameter_tree import Leaves, flatten, unflatten
from ..results.bends import bends
from ..results.pieces import Pieces
from ..results.refining import GOAL, refined
from .scene import unchecked_solution

START_ANGLES = 192
"""Crank angles a turn to begin with that tell most outputs of a turn that is parted."""
BLOCK_VALUES = 100_000
"""Values over designs and angles that NumPy computes at a time: about what the cache holds."""


def unchecked_turn(scene, angles):
    """Solution at so many crank angles over the period, or at these."""
    if scene.friction.acting:
        scene = solve_friction(scene)
    return unchecked_solution(scene, scene.turn(angles), "numpy")


def quantity_names(outputs):
    return list(dict.fromkeys(item.quantity for item in outputs))


class PiecewiseTurns(NamedTuple):
    """The turn of designs, parted where they bend.

    Attributes
    ----------
    scene : Scene
    designs : int
        How many it has.
    pieces : Pieces
        As they are to begin with.
    goal : float
        Share of the largest value of a quantity by which an output may be wrong.
    engine : "numpy" or "compiled"
    """

    scene: Any
    designs: int
    pieces: Any
    goal: float
    engine: str = "numpy"

    @classmethod
    def of(cls, scene, outputs, angles, straight=KINK_TOLERANCE, engine="numpy"):
        """For some outputs, of at least so many crank angles, with loads taken as straight where they bend by less."""
        solution = unchecked_turn(scene, 1)
        count, order = math.prod(solution.shape[:-1]), max(item.order or 0 for item in outputs)
        found, jumps, rest = bends(solution, straight)
        found = np.broadcast_to(found, (count, found.shape[1]))
        return cls(scene, count, Pieces.of(found, solution.period, angles, order, jumps), max(GOAL, rest), engine)

    def values(self, names, designs, angle):
        """Values of quantities, of vectors magnitudes, of some designs (D,) at crank angles (D, N)."""
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
        """Parts of the designs: which, their pieces, and values by quantity, so fine that they tell if any do."""
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
        """Numbers (outputs, designs), and whether so many crank angles do not tell them."""
        found = np.empty((2, len(outputs), self.designs))
        with np.errstate(all="ignore"):
            for designs, pieces, told in self.refined(outputs):
                for row, item in enumerate(outputs):
                    vector = quantity(self.scene, item.quantity).vector
                    found[:, row, designs] = pieces.estimated(item, told[item.quantity], vector)
        return found

    def _of(self, designs):
        """A scene that has some of its designs, how many it has, and which of these they are.

        All, where something in it, as a function does, may hold numbers of designs that nobody can take apart.
        """
        leaves = Leaves()
        structure = flatten(self.scene, leaves)
        if len(designs) == self.designs or not leaves.lasting:
            return self.scene, self.designs, designs
        numbers = (part[designs] if np.shape(part)[:1] == (self.designs,) else part for part in leaves.numbers)
        scene = unflatten(structure, numbers.__next__, iter(leaves.tables).__next__, iter(leaves.parts).__next__)
        return scene, len(designs), np.arange(len(designs))


def _magnitudes(solution, names, engine):
    """Values of quantities, of vectors their magnitudes."""
    state, compiled = solution.dynamics, engine == "compiled"
    try:
        program, leaves = program_of(state, tuple(names), sizes=True, lasting=not compiled)
    except NotGivenError:
        with np.errstate(all="ignore"):
            return [component_sizes(solution, name)[0] for name in names]
    return program.run(state, leaves, compiled)
