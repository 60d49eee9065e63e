"""Lines: where formulas end, in what order they stand, their units and noise."""

from itertools import pairwise

import numpy as np

import kinetostatics as ks
from kinetostatics.explain.formulas import names_in
from kinetostatics.explain.named_recording import name_result, node_of, record_with_names
from kinetostatics.explain.steps import MAX_FORMULA_SIZE, lines
from kinetostatics.mechanics.quantities import of_scene
from tests.support.every import every
from tests.support.scenes import SCENES, solve


def found(solution, quantity):
    made, recorder = record_with_names(solution.dynamics, {}, {})
    nodes = [node_of(part) for part in name_result(made, quantity, of_scene(solution)[quantity])]
    return made.names, lines(made.names, nodes, recorder, solution.dynamics)


@every("name", ["circle cam, everything", "four-bar", "six-bar"])
def test_formulas_are_short_and_name_lines_before_them(name):
    _, told_lines = found(solve(SCENES[name], np.array(0.7)), "balancing_torque")
    before = set()
    for line in told_lines:
        if line.tree:
            needed = names_in(line.tree)
            assert len(needed) <= MAX_FORMULA_SIZE
            assert before.issuperset(needed)
        before.add(line.node.index)
    titles = [line.named.title for line in told_lines]
    assert sum(one != other for one, other in pairwise(titles)) < 1.5 * len(set(titles))


def test_a_line_that_is_used_once_and_not_explained_is_part_of_the_formula_that_uses_it():
    _, told_lines = found(solve(SCENES["plain"], np.array(0.7)), "balancing_torque")
    assert {line.named.kind for line in told_lines} == {"given", "protocol", "term"}


def test_units_follow_from_those_given():
    solution = ks.solve(
        ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 0.7, crank_speed=9.0, loads=ks.Spring(1e3, 0.2, cubic=10.0)
    )
    made, recorder = record_with_names(
        solution.dynamics,
        dict(enumerate(("crank_length", "coupler_length", "slider.mass", "crank_speed", "k", "s0", "c"))),
        {"crank_length": "m", "coupler_length": "m", "slider.mass": "kg", "crank_speed": "rad/s"}
        | {"k": "N/m", "s0": "m", "c": "N/m**3"},
    )
    nodes = [node_of(part) for part in name_result(made, "kinetic_energy", of_scene(solution)["kinetic_energy"])]
    units = {line.named.symbol.text: line.unit for line in lines(made.names, nodes, recorder, solution.dynamics)}
    assert units["w"] == "m"
    assert units["E_kinetic"] == "J"
    assert units["s_slider'"] == "m"


def test_what_is_rounding_of_larger_terms_is_noise():
    solution = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), np.pi, crank_speed=9.0)
    _, told_lines = found(solution, "slider_velocity")
    noise = {line.named.symbol.text for line in told_lines if line.is_noise}
    assert {"uy_crank", "y_A", "v_slider"} <= noise
    assert "x_A" not in noise
