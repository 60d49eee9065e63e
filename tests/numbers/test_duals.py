"""Numbers with derivatives: each operation's slope is that of SymPy."""

import numpy as np
import pytest
import sympy as sp

from kinetostatics.numbers import elementary
from kinetostatics.numbers.duals import Dual

X = 0.8
FUNCTIONS = {
    "arithmetic": lambda x, f: (2.0 - x) * x / (1.0 + x) + 3.0 / x - 1.5,
    "square": lambda x, f: -(x**2),
    "size": lambda x, f: abs(1.0 - 2.0 * x),
    "sine": lambda x, f: f.sin(x) * f.cos(3.0 * x),
    "root": lambda x, f: f.sqrt(1.0 + x * x),
    "angle": lambda x, f: f.atan(x / 2.0),
}


class Elementary:
    """The elementary functions as kernels call them: on arrays of objects."""

    def __getattr__(self, name):
        return lambda x: getattr(elementary, name)(np.array([x], dtype=object))[0]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_value_and_slope_are_those_of_sympy(name):
    x = sp.Symbol("x", positive=True)
    expression = FUNCTIONS[name](x, sp)
    found = FUNCTIONS[name](Dual(np.array([X]), np.array([[1.0], [2.0]])), Elementary())
    slope = float(sp.diff(expression, x).subs(x, X))
    assert found.value[0] == pytest.approx(float(expression.subs(x, X)), rel=1e-14)
    assert found.slopes[:, 0] == pytest.approx([slope, 2.0 * slope], rel=1e-13)


def test_what_has_no_slope_keeps_none_and_what_is_held_loses_it():
    assert (Dual(2.0) * 3.0 + 1.0).slopes is None
    assert Dual(2.0, np.ones((1, 1))).held().slopes is None
    assert Dual(-2.0, np.ones((1, 1))).sign().value == -1.0


def test_other_powers_and_looks_at_several_angles_are_refused():
    with pytest.raises(TypeError, match="only squares"):
        Dual(2.0) ** 3
    with pytest.raises(TypeError, match="one crank angle at a time"):
        bool(Dual(np.ones(2)))
