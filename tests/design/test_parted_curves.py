"""Curves on pieces between bends: numbers as sweeps have them, derivatives as differences of these."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.problem import Problem, true_value
from kinetostatics.results.reductions import parsed

KINDS = ("largest", "smallest", "range", "largest_absolute", "mean", "mean_absolute", "rms", "harmonic_2")
OUTPUTS = [f"{kind} {name}" for kind in KINDS for name in ("balancing_torque", "O")] + ["swing balancing_torque"]
VARY = {"crank_length": (0.03, 0.07), "slider.mass": (0.5, 4.0)}


def pump(friction=None, width=2e-4):
    """A pump whose force rises and falls within a degree, so that even samples miss the top."""
    rows = [0.1, 0.2, 0.2 + width, 0.2 + 2 * width, 0.3], [0.0, 0.0, 3e3, 0.0, 0.0]
    made = ks.crank_slider(
        0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0), crank=ks.Link(1.0, 0.01)
    )
    force = ks.ProcessForce(ks.Table(*rows, over="travel"))
    return ks.Scene(made, 30.0, loads=[ks.Gravity(), force], friction=friction or {})


SCENES = {
    "spike": pump(),
    "pins": pump({"O": ks.PinFriction(0.1, 0.02), "B": ks.PinFriction(0.1, 0.02)}),
}


@pytest.mark.slow
@pytest.mark.parametrize("text", OUTPUTS)
@pytest.mark.parametrize("kind", SCENES)
def test_derivatives_are_those_of_the_number(kind, text):
    output, step = parsed(text), np.array([1e-6, 1e-4])
    problem = Problem(SCENES[kind], VARY, [output.quantity])
    start = problem.start
    found, slopes = problem.output(output, start)
    assert found == pytest.approx(true_value(output, SCENES[kind]), rel=1e-6)
    for place, size in enumerate(step):
        move = size * np.eye(2)[place]
        above, below = (true_value(output, problem.scene(start + side * move)) for side in (1.0, -1.0))
        difference = (above - below) / (2.0 * size)
        scale = max(abs(found), 1e-3 * true_value(parsed(f"rms {output.quantity}"), SCENES[kind])) / start[place]
        assert slopes[place] == pytest.approx(difference, rel=2e-3, abs=2e-3 * scale)
