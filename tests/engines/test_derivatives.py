"""Derivatives of recorded quantities by every parameter: against enclosures, compiled, and by either sweep."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.dynamics import Dynamics
from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.leaves import put_together

ANGLES = np.linspace(0.1, 6.2, 7)
SIZES = np.array([[0.9], [1.0], [1.1]])
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


def shipped():
    for name in ("sawframe_2r63", "mower_drive", "chain_unit"):
        for variant, found in ks.load_case(name).variants.items():
            loads = found.loads
            yield f"{name} {variant}", ks.Scene(found.mechanism, found.crank_speed, 3.0, loads)
    yield "six-bar", ks.Scene(SIX_BAR, 12.0, -20.0, (ks.Gravity(9.81, -1.2), ks.ProcessForce(40.0, "slider2")))


SCENES = dict(shipped())


def _fields(scene):
    return scene.mechanism, ANGLES, scene.crank_speed, scene.crank_acceleration


@pytest.mark.parametrize("name", SCENES)
def test_derivatives_equal_central_differences_of_the_kernels_on_enclosures(name):
    """At 300 bits, each number of the scene moved by 1e-30 of itself: both sides share no arithmetic of derivatives.

    Relative to the largest derivative over the angles, or to the quantity over the number where that is more.
    """
    flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    scene = SCENES[name]
    quantities = ("balancing_torque", *(name for name in ("O", "B", "cam_force") if name in scene.mechanism.outputs))
    program = ks.compile(scene, quantities, engine="numpy")
    found = program.derivatives(ANGLES)
    state = Dynamics(*_fields(scene), loads=scene.loads)
    structure, leaves = state.apart
    places = {path: int(number) for path, (number, _) in program._numbers.items()}
    with flint.ctx.workprec(300):
        angle = np.array([flint.arb(float(part)) for part in ANGLES], dtype=object)

        def at(place, share):
            numbers = [flint.arb(float(number)) for number in leaves.numbers]
            numbers[place] *= 1 + share
            given = iter(numbers)
            mechanism, speed, acceleration, loads = put_together(structure, lambda: next(given), None, None)
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
def test_derivatives_are_the_same_compiled_and_by_either_sweep(name):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    quantities = ("balancing_torque", "O")
    found = [
        ks.compile(SCENES[name], quantities, engine=engine).derivatives(ANGLES) for engine in ("numpy", "compiled")
    ]
    one_by_one = ks.compile(SCENES[name], quantities, engine="numpy")
    for quantity in quantities:
        for path, slope in found[0][quantity].items():
            largest = np.abs(slope).max()
            assert np.abs(found[1][quantity][path] - slope).max() <= 1e-13 * largest
            alone = one_by_one.derivatives(ANGLES, path)[quantity][path]  # one parameter: forward
            assert np.abs(alone - slope).max() <= 1e-12 * largest
