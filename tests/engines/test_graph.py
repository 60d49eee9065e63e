"""Recorded numbers: what they write down, and what a kernel must not ask of them."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Node
from kinetostatics.engines.program import program_of
from kinetostatics.errors import NotGivenError
from support.scenes import (
    SCENES,
    Pan,
    solve,
    with_group,
)


def program(solution, names, sizes=False):
    """Program of some quantities, and a function that runs it: by NumPy unless told."""
    made, leaves = program_of(solution.dynamics, tuple(names), sizes)
    return made, lambda compiled=False: made.run(solution.dynamics, leaves, compiled)


class Stop(Pan):
    """A group that looks at values."""

    def place(self, placement):
        """Turn with the crank on one side."""
        super().place(placement)
        if placement.joints["A"].position[0] > 0:
            placement.links["pan"] = placement.links["crank"]


def test_a_kernel_that_branches_on_values_is_refused():
    s = solve(with_group(Stop(ks.Link(3.0, 0.1))), np.array([0.3]), on_gap="nan")
    with pytest.raises(NotGivenError, match="kernels must not branch on values"):
        program(s, ["O"])


def test_recorded_numbers_have_no_value():
    recorded = []
    force = ks.ProcessForce(lambda motion: recorded.append(motion.travel()[0]) or motion.travel())
    program(ks.solve(SCENES["plain"].mechanism, [0.1], crank_speed=1.0, loads=force), ["A"])
    node = next(value for value in recorded if isinstance(value, Node))
    for look in (bool, float, int, lambda x: x == 0, lambda x: x != 0, lambda x: x > 0, lambda x: x <= 0.0):
        with pytest.raises(TypeError, match="not known yet"):
            look(node)
    with pytest.raises(TypeError, match="only squares"):
        node**3
