"""What designs have in common, computed once: that it is all of it, and the same numbers as without."""

import numpy as np

from kinetostatics.engines import shared_work
from kinetostatics.engines.codegen import BY_DESIGN, compile_line, line_source
from kinetostatics.engines.graph import Graph, needed, operations
from kinetostatics.engines.program import program_of
from kinetostatics.engines.simplify import SimplifiedGraph
from support import graphs
from support.case_files import shipped
from support.every import every

ANGLE = np.linspace(0.1, 6.0, 5)


def run(outputs, parameters, tables):
    """Outputs of a graph at some crank angles."""
    with np.errstate(all="ignore"):
        found = compile_line(line_source(outputs), BY_DESIGN)(ANGLE, np.sin(ANGLE), np.cos(ANGLE), parameters, tables)
    return [np.broadcast_to(part, ANGLE.shape) for part in found]


@every("seed", range(60))
def test_programs_split_in_two_give_the_same_bits(seed):
    random = np.random.default_rng(seed)
    graph = (SimplifiedGraph if seed % 2 else Graph)()
    angle, count = graph.angle(), graphs.PARAMETERS + graphs.UNITS
    inputs = [*map(graph.parameter, range(count)), angle, angle.sin(), angle.cos(), graph.row(0)]
    values = graphs.recorded(graphs.recipe(random, 25), inputs)
    outputs = tuple(values[-6:])
    varied = set(random.integers(count, size=2).tolist())
    common, rest = shared_work.split_common(outputs, varied, first=1)
    parameters, row = list(map(np.float64, graphs.numbers(random, count))), graphs.numbers(random, ANGLE.size)
    expected = run(outputs, parameters, [row])
    found = run(rest, parameters, [row, *run(common, parameters, [row])])
    assert np.array_equal(found, expected, equal_nan=True)
    assert np.array_equal(np.signbit(found), np.signbit(expected))
    behind = {node.arguments[0] for node in needed(common) if node.operation == "parameter"}
    assert behind.isdisjoint(varied)


def of_saw(varied):
    """Outputs of the saw with a cosine cam, and the same in two parts if some numbers vary."""
    scene = shipped("sawframe_2r63").variants["cam-cosine"].scene
    scene = scene.varied({name: scene.parameters[name] * np.array([[1.0], [1.1]]) for name in varied})
    program, leaves = program_of(scene.solve(ANGLE).dynamics, ("O", "balancing_torque"), sizes=True)
    places = {place for place, number in enumerate(leaves.numbers) if np.ndim(number)}
    assert len(places) == len(varied)
    return program.outputs, *shared_work.split_common(program.outputs, places)


def test_motion_is_shared_if_spring_and_mass_vary():
    outputs, common, rest = of_saw(["spring.stiffness", "slider.mass"])
    assert operations(common) > 0.6 * operations(outputs)
    assert operations(rest) < 0.5 * operations(outputs)


def test_little_is_common_where_lengths_vary():
    outputs, common, _ = of_saw(["coupler_length", "cam.mean"])
    assert operations(common) < shared_work.MIN_SHARE * operations(outputs)


def test_two_loops_are_made_for_many_designs_only(numba, monkeypatch):
    scene = shipped("sawframe_2r63").variants["plain"].scene
    scene = scene.varied({"slider.mass": np.array([[500.0], [600.0]])})
    state = scene.solve(ANGLE).dynamics
    program, leaves = program_of(state, ("balancing_torque",))
    given = leaves.numbers, ANGLE[None], np.empty((0, 1, ANGLE.size))
    monkeypatch.setattr(program, "loop", "whole")
    found = [shared_work.shared_loop(program, *given, count) for count in (2, shared_work.MIN_SHARED_VALUES)]
    assert found[0][0] == "whole"
    assert len(found[0][1]) == 0
    assert callable(found[1][0])
    assert len(found[1][1]) > 0
    own_angles = leaves.numbers, np.repeat(given[1], 2, axis=0), given[2]
    assert shared_work.shared_loop(program, *own_angles, shared_work.MIN_SHARED_VALUES)[0] == "whole"
