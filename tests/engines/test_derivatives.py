"""Derivatives of recorded quantities by every parameter: against enclosures, compiled, and by either sweep."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.derivatives import Evaluation, tangents
from kinetostatics.mechanics.dynamics import Dynamics
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers import arithmetic
from kinetostatics.numbers.parameter_tree import unflatten
from support.case_files import shipped
from support.graphs import new_graph

ANGLES = np.linspace(0.1, 6.2, 7)
SIX_BAR = ks.Mechanism(
    "six-bar",
    ks.Crank(0.1, ks.Link(2.0, 0.04, 0.01)),
    (
        ks.RockerGroup(0.4, 0.3, (0.35, 0.02), coupler=ks.Link(3.0, (0.2, 0.03), 0.05), rocker=ks.Link(2.0, 0.1, 0.03)),
        ks.SliderGroup(
            0.5,
            ks.Guide.at(0.2, 0.05),
            on="B",
            pin="C",
            label="2",
            coupler=ks.Link(1.0, 0.2, 0.02),
            slider=ks.Link(4.0),
        ),
    ),
)


def scene_of(name):
    """A variant of a shipped case with a crank acceleration, or the six-bar with two loads."""
    if name == "six-bar":
        return ks.Scene(SIX_BAR, 12.0, -20.0, (ks.Gravity(9.81, -1.2), ks.ProcessForce(40.0, "slider2")))
    case, variant = name.split(" ", 1)
    found = shipped(case).variants[variant]
    return ks.Scene(found.mechanism, found.crank_speed, 3.0, found.loads)


NAMES = (
    *(f"sawframe_2r63 {variant}" for variant in ("plain", "cam-circle", "cam-cosine")),
    *("mower_drive unbalanced", "mower_drive full", "chain_unit rho-0.5", "chain_unit free-start", "six-bar"),
)


@pytest.mark.parametrize("name", NAMES)
def test_derivatives_match_differences_of_enclosures(name):
    """At 300 bits, each number of the scene moved by 1e-30 of itself: both sides share no arithmetic of derivatives.

    Relative to the largest derivative over the angles, or to the quantity over the number where that is more.
    """
    flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    scene = scene_of(name)
    quantities = ("balancing_torque", *(name for name in ("O", "B", "cam_force") if name in scene.mechanism.outputs))
    program = ks.compile(scene, quantities, engine="numpy")
    found = program.derivatives(ANGLES)
    structure, leaves = scene.dynamics(ANGLES).apart
    places = {path: int(number) for path, (number, _) in program._numbers.items()}
    with flint.ctx.workprec(300):
        angle = np.array([flint.arb(float(part)) for part in ANGLES], dtype=object)

        def at(place, share):
            numbers = [flint.arb(float(number)) for number in leaves.numbers]
            numbers[place] *= 1 + share
            given = iter(numbers)
            mechanism, speed, acceleration, loads, *_ = unflatten(structure, lambda: next(given), None, None)
            moved = Dynamics(mechanism, angle, speed, acceleration, loads)
            return {name: np.array([list(part) for part in components(moved, name)]) for name in quantities}

        for path, place in places.items():
            step = flint.arb("1e-30")
            above, below = at(place, step), at(place, -step)
            value = flint.arb(float(leaves.numbers[place]))
            for quantity in quantities:
                slope = ((above[quantity] - below[quantity]) / (2 * step * value)).astype(float)
                own = np.reshape(found[quantity][path], slope.shape)
                terms = np.abs(above[quantity].astype(float)).max() / abs(float(leaves.numbers[place]))
                unit = max(np.abs(slope).max(), terms) or np.abs(own).max() or 1.0
                assert np.abs(own - slope).max() <= 1e-12 * unit, (path, quantity)


@pytest.mark.parametrize("name", ["sawframe_2r63 plain", "sawframe_2r63 cam-circle"])
def test_derivatives_agree_compiled_and_by_both_sweeps(name):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    quantities = ("balancing_torque", "O")
    found = [
        ks.compile(scene_of(name), quantities, engine=engine).derivatives(ANGLES) for engine in ("numpy", "compiled")
    ]
    one_by_one = ks.compile(scene_of(name), quantities, engine="numpy")
    for quantity in quantities:
        for path, slope in found[0][quantity].items():
            largest = np.abs(slope).max()
            assert np.abs(found[1][quantity][path] - slope).max() <= 1e-13 * largest
            alone = one_by_one.derivatives(ANGLES, path)[quantity][path]  # one parameter: forward
            assert np.abs(alone - slope).max() <= 1e-12 * largest


FUNCTIONS = {
    "arithmetic": lambda x, f: (2.0 - x) * x / (1.0 + x) + 3.0 / x - 1.5,
    "square": lambda x, f: -(x**2),
    "size": lambda x, f: abs(1.0 - 2.0 * x),
    "sine": lambda x, f: f.sin(x) * f.cos(3.0 * x),
    "root": lambda x, f: f.sqrt(1.0 + x * x),
    "angle": lambda x, f: f.atan(x / 2.0),
    "power": lambda x, f: f.exp(-1.3 * f.log(x)),
}


class Elementary:
    """The elementary functions as kernels call them: on arrays of objects."""

    def __getattr__(self, name):
        return lambda x: getattr(arithmetic, name)(np.array([x], dtype=object))[0]


def along_two_directions(function):
    """Value of a function of a recorded number at 0.8, and its slopes along 1 and 2."""
    graph, x, direction = new_graph(2)
    found = function(x)
    outputs = [found, *tangents(graph, [found], {x: direction})]
    return Evaluation(outputs)({x: np.array([0.8]), direction: np.array([[1.0], [2.0]])})


@pytest.mark.parametrize("name", FUNCTIONS)
def test_derivatives_of_operations_match_sympy(name):
    sp = pytest.importorskip("sympy")
    x = sp.Symbol("x", positive=True)
    expression = FUNCTIONS[name](x, sp)
    value, slopes = along_two_directions(lambda number: FUNCTIONS[name](number, Elementary()))
    slope = float(sp.diff(expression, x).subs(x, 0.8))
    assert value[0] == pytest.approx(float(expression.subs(x, 0.8)), rel=1e-14)
    assert slopes[:, 0] == pytest.approx([slope, 2.0 * slope], rel=1e-13)


@pytest.mark.parametrize("name", ["stop_gradient", "sign", "length_error"])
def test_signs_and_stopped_gradients_are_flat(name):
    functions = {"length_error": lambda x: arithmetic.length_error(x, 0.3 * x, 0.4)}
    value, slope = along_two_directions(functions.get(name, getattr(Elementary(), name)))
    assert np.isfinite(value[0])
    assert slope == 0.0


def test_a_compensated_sum_has_the_slopes_of_a_sum():
    value, slopes = along_two_directions(lambda x: arithmetic.compensated_sum(x, 0.2, -(x * x)))
    assert value[0] == pytest.approx(0.36, rel=1e-15)
    assert slopes[:, 0] == pytest.approx([-0.6, -1.2], rel=1e-15)
