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


@pytest.mark.parametrize("text", ["largest O", "largest_absolute balancing_torque", "swing balancing_torque"])
def test_parts_are_as_many_whatever_the_design_and_the_highest_is_the_output(text):
    output = parsed(text)
    problem = Problem(SCENES["pins"], VARY, [output.quantity])
    designs = [np.array(values) for values in ([0.05, 2.0], [0.041, 3.3])]
    parts = [problem.curve(output, values).bounded(output.reduction) for values in designs]
    assert parts[0][0].shape == parts[1][0].shape
    for (heights, slopes), values in zip(parts, designs, strict=True):
        found, own = problem.output(output, values)
        assert heights.max() == pytest.approx(found, rel=1e-12)
        np.testing.assert_allclose(slopes[:, heights.argmax()], own, rtol=1e-9)


def test_the_signs_of_a_piece_are_weighed_where_they_change():
    from kinetostatics.design.parted_curves import _signed
    from kinetostatics.results.means import NODES

    values = (2.0 * NODES - 1.0 - 0.3)[None]
    assert float((_signed(values) * values).sum()) == pytest.approx((1.3**2 + 0.7**2) / 4.0, rel=1e-14)
