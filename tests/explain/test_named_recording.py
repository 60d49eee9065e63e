"""Told scenes: the kernels' own arithmetic, with the names of the mechanism."""

import numpy as np

import kinetostatics as ks
from kinetostatics.engines.program import Program
from kinetostatics.engines.record import Recording
from kinetostatics.explain.named_recording import name_result, node_of, record_with_names
from kinetostatics.mechanics.quantities import of_scene
from tests.support.scenes import SCENES, everything, solve


def named(solution, quantity):
    made, recorder = record_with_names(solution.dynamics, {}, {})
    return made, recorder, name_result(made, quantity, of_scene(solution)[quantity])


def test_every_quantity_is_computed_to_the_same_bits():
    solution = solve(SCENES["circle cam, everything"], np.array(0.7))
    _, leaves = solution.apart
    for quantity in everything(solution):
        _, recorder, found = named(solution, quantity)
        nodes = [node for node in map(node_of, found) if node is not None]
        recording = Recording(
            (), tuple(nodes), (), (), tuple(recorder.parameters), tuple(recorder.tables), recorder.graph
        )
        values = Program(recording).run(solution.dynamics, leaves)
        wanted = np.ravel(of_scene(solution)[quantity].read(solution))
        np.testing.assert_array_equal(values, wanted if len(nodes) == wanted.size else wanted[wanted != 0], quantity)


def test_names_are_those_of_joints_links_loads_and_reactions():
    solution = solve(SCENES["plain, everything"], np.array(0.7))
    made, _, _ = named(solution, "balancing_torque")
    names = {found.symbol.text for found in made.names.of.values() if found.kind == "protocol"}
    assert {"x_A", "y_A'", "ux_coupler", "theta_coupler''", "s_slider", "L_spring"} <= names
    assert {"rx_slider", "Px_coupler", "K_slider", "Fs_slider", "Rx_B", "F_guide", "M_guide", "M_crank", "T"} <= names


def test_headings_follow_the_calculation():
    solution = solve(SCENES["six-bar"], np.array(0.7))
    made, _, _ = named(solution, "balancing_torque")
    titles = made.names.titles
    order = [
        "Crank",
        "Motion of coupler and rocker, joint B and O2",
        "Forces on coupler2 and slider2",
        "Forces on crank",
    ]
    assert [title for title in titles if title in order] == order


def test_numbers_without_a_path_have_a_symbol_all_the_same():
    made, _ = record_with_names(
        ks.solve(ks.crank_slider(0.05, 0.2), 0.7, crank_speed=1.0).dynamics, {0: "crank_length"}, {}
    )
    symbols = [found.symbol.text for found in made.names.of.values() if found.kind == "given"]
    assert symbols == ["l_crank", "c_2", "c_3", "phi"]
