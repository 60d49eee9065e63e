"""Outputs over the turn parted where it bends: of single designs, of some of many, whatever the engine."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.reductions import parsed
from kinetostatics.solution.piecewise_turns import PiecewiseTurns

OUTPUTS = tuple(map(parsed, ("smallest O", "mean B", "largest balancing_torque", "rms O", "range guide_force")))


def pump(crank=0.05, mass=2.0):
    made = ks.crank_slider(crank, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(mass))
    friction = {"O": ks.PinFriction(0.1, 0.02), "guide": ks.GuideFriction(0.2)}
    table = ks.Table([0.1, 0.18, 0.19, 0.2, 0.3], [0.0, 0.0, 1e3, 2e3, 2e3], over="travel")
    return ks.Scene(made, 30.0, loads=[ks.Gravity(), ks.ProcessForce(table)], friction=friction)


def test_numbers_are_those_of_extremes_and_means():
    numbers, rough = PiecewiseTurns.of(pump(), OUTPUTS, 192).estimated(OUTPUTS)
    at = pump().solve(4)
    assert not rough.any()
    assert numbers[0, 0] == pytest.approx(ks.extremes(at, "O").range[0], rel=1e-6)
    assert numbers[2, 0] == pytest.approx(ks.extremes(at, "balancing_torque").range[1], rel=1e-8)
    assert numbers[4, 0] == pytest.approx(np.ptp(ks.extremes(at, "guide_force").range), rel=1e-8)


def test_designs_have_the_numbers_that_they_have_alone():
    crank, mass = np.array([[0.03], [0.05], [0.06]]), np.array([[1.0], [2.0], [0.1]])
    together, _ = PiecewiseTurns.of(pump(crank, mass), OUTPUTS, 192).estimated(OUTPUTS)
    for row in range(3):
        alone, _ = PiecewiseTurns.of(pump(crank[row : row + 1], mass[row : row + 1]), OUTPUTS, 192).estimated(OUTPUTS)
        np.testing.assert_array_equal(together[:, row], alone[:, 0])


def test_the_compiled_loop_gives_the_same(numba):
    plain, compiled = (
        PiecewiseTurns.of(pump(), OUTPUTS, 192, engine=engine).estimated(OUTPUTS)[0] for engine in ("numpy", "compiled")
    )
    np.testing.assert_allclose(plain, compiled, rtol=1e-9)
