"""Programs: compiled, cached by structure, split between designs; values equal those of kernels and of enclosures."""

import json
import math
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import kinetostatics as ks
from kinetostatics.engines import numba_backend, shared_work
from kinetostatics.engines.codegen import BY_DESIGN, compile_line, line_source
from kinetostatics.engines.engines import KERNELS
from kinetostatics.engines.graph import Graph, needed, operations
from kinetostatics.engines.program import plausibility_test, program_of
from kinetostatics.engines.simplify import SimplifiedGraph
from kinetostatics.mechanics.quantities import magnitude
from kinetostatics.numbers import parameter_tree
from support import DATA, graphs
from support.case_files import shipped
from support.every import every, quick
from support.scenes import (
    ANGLES,
    BATCHES,
    FORCES,
    OWN,
    SAMPLES,
    SCENES,
    SPEED,
    everything,
    solve,
)

ROUNDED = 1e-14
"""Difference from the kernels, relative to the largest value, of programs, which round in other places."""
DIVERSE = ["plain, weightless", "cosine cam", "circle cam, everything", "six-bar"]
"""Scenes that have among them all that the others have."""


def results(solution):
    """Every reaction, force and moment by name."""
    vectors = {name: solution.reaction(name) for name in solution.reactions}
    return vectors | {name: solution.scalar(name) for name in solution.scalars}


def largest(values):
    return max(abs(float(value)) for value in np.ravel(values))


def assert_agree(found, expected, tolerance=1e-13):
    """Every result agrees, to the tolerance times its largest value."""
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert largest(np.asarray(found[name]) - values) <= tolerance * largest(values), name


# JAX


@pytest.mark.slow
@pytest.mark.parametrize("name", DIVERSE)
def test_solve_under_jax_jit_equals_numpy(double, name):
    found = double.jit(lambda angles: results(solve(SCENES[name], angles, on_gap="nan")))(ANGLES)
    assert all(values.dtype == "float64" for values in found.values())
    assert_agree(found, results(solve(SCENES[name], ANGLES)))


@pytest.mark.slow
def test_jax_in_single_precision_is_warned_of(jax):
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", False)
    try:
        with pytest.warns(UserWarning, match="single precision.*jax_enable_x64"):
            solve(SCENES["plain"], jax.numpy.asarray(ANGLES), on_gap="nan")
    finally:
        jax.config.update("jax_enable_x64", before)


# arb


def assert_narrow(found, flint):
    """All enclosures are narrower than 1e-40 of the largest value."""
    for name, values in found.items():
        radii = [flint.arb(value).rad() for value in values.flat]
        assert largest(radii) <= 1e-40 * largest(values), name


def middles(found, flint):
    return {name: np.vectorize(lambda value: flint.arb(value).mid(), "O")(values) for name, values in found.items()}


@pytest.mark.parametrize("name", SCENES)
def test_double_precision_agrees_with_the_enclosure(flint, name):
    """The same binary inputs, so the enclosures hold the true values of what NumPy was asked."""
    angles = np.array([flint.arb(angle) for angle in ANGLES.tolist()])
    found = results(solve(SCENES[name], angles))
    assert_narrow(found, flint)
    assert_agree(middles(found, flint), results(solve(SCENES[name], ANGLES)))


def sawframe(variant, flint):
    """The sawframe at the crank angles of the tables, from decimal inputs."""
    arb = flint.arb
    angles = np.array([degrees * arb.pi() / 180 for degrees in range(0, 360, 5)])
    speed = 320 * 2 * arb.pi() / 60
    gravity = ks.Gravity(arb("9.81"), -arb.pi() / 2)
    spring = ks.Spring.balancing(600, speed, 2)
    cam = {
        "plain": None,
        "cam_circle": ks.cams.Circle(arb("0.3"), (arb("-0.0219"), arb(0))),
        "cam_cosine": ks.cams.CosineLaw(arb("0.3"), arb(2)),
    }[variant]
    length = {"plain": arb(2), "cam_circle": arb("2.0219")}.get(variant) or cam.coupler_length
    moving = {"coupler": ks.Link(150, length / 2, arb("20.5")), "slider": ks.Link(600)}
    if cam is None:
        return ks.solve(ks.crank_slider(arb("0.3"), length, **moving), angles, crank_speed=speed, loads=[gravity])
    mechanism = ks.cam_crank_slider(cam, length, **moving)
    return ks.solve(mechanism, angles, crank_speed=speed, loads=[gravity, spring])


@pytest.mark.parametrize("variant", ["plain", "cam_circle", "cam_cosine"])
def test_enclosures_equal_50_digit_tables_to_24_digits(flint, variant):
    path = DATA / f"sawframe_{variant}.json"
    rows = json.loads(path.read_text(encoding="utf-8"))["rows"]
    columns = {"guide_force": "N", "balancing_torque": "T", "cam_force": "cam", "slot_force": "slot"}
    found = {name: values for name, values in results(sawframe(variant, flint)).items() if name != "guide"}
    decimals = {name: np.array([row[columns.get(name, name)] for row in rows]).T for name in found}
    expected = {name: np.vectorize(lambda text: flint.arb(str(text)), "O")(texts) for name, texts in decimals.items()}
    assert_narrow(found, flint)
    assert_agree(middles(found, flint), expected, tolerance=1e-24)


# dask


@pytest.mark.slow
@pytest.mark.parametrize("name", DIVERSE[2:])
def test_dask_arrays_stay_lazy_and_equal_numpy(name):
    dask = pytest.importorskip("dask", reason="dask is not installed (extra: distributed)")
    array = pytest.importorskip("dask.array", reason="dask is not installed (extra: distributed)")
    found = results(solve(SCENES[name], array.from_array(ANGLES, chunks=90)))
    assert all(values.chunks[-1] == (90,) * 4 for values in found.values())
    assert_agree(dask.compute(found)[0], results(solve(SCENES[name], ANGLES)))


# Recorded and compiled programs


def program(solution, names, sizes=False):
    """Program of some quantities, and a function that runs it: by NumPy unless told."""
    made, leaves = program_of(solution.dynamics, tuple(names), sizes)
    return made, lambda compiled=False: made.run(solution.dynamics, leaves, compiled)


def assert_program_equals(solution, tables=0, rounded=ROUNDED):
    """A program gives what the kernels give, by NumPy and by the loop: the same NaN, and the same but for rounding."""
    names = everything(solution)
    made, run = program(solution, names)
    assert len(made.recording.tables) == tables
    expected = KERNELS.values(solution.dynamics, names)
    for compiled_loop in (False, True):
        found = made.recording.named(run(compiled_loop))
        assert tuple(found) == tuple(dict.fromkeys(names))
        for name in names:
            assert found[name].shape == expected[name].shape, name
            assert np.array_equal(np.isnan(found[name]), np.isnan(expected[name])), name
            error, size = (np.nanmax(np.abs(part)) for part in (found[name] - expected[name], expected[name]))
            assert error <= rounded * size, name


@pytest.mark.parametrize("name", SCENES)
def test_recorded_program_equals_solve(interpreted, name):
    assert_program_equals(solve(SCENES[name], ANGLES))


@pytest.mark.slow
def test_compiled_programs_equal_solve(numba):
    assert_program_equals(solve(SCENES["circle cam, everything"], ANGLES))
    sine, cosine = numba_backend.compiled_sines(ANGLES[None])
    assert largest(sine - np.sin(ANGLES)) <= 2**-52
    assert largest(cosine - np.cos(ANGLES)) <= 2**-52


@pytest.mark.slow
@every("angles", [ANGLES[7:8], ANGLES[:5]])
@every("name", SCENES)
def test_program_on_plain_numbers_equals_the_kernels(name, angles):
    """A few crank angles are computed one by one."""
    s = solve(SCENES[name], angles)
    names = everything(s)
    made, run = program(s, names)
    expected = KERNELS.values(s.dynamics, names)
    for quantity, found in made.recording.named(run()).items():
        assert largest(found - expected[quantity]) <= ROUNDED * max(1.0, largest(expected[quantity])), quantity


def test_programs_in_blocks_equal_one_block(monkeypatch):
    """NumPy takes so many crank angles at once that its buffers stay in the cache."""
    s = solve(SCENES["six-bar"], np.linspace(0, 7, 5000))
    found = [program(s, everything(s))[1]()]
    monkeypatch.setattr("kinetostatics.engines.program.BUFFER_VALUES", 10_000)
    found.append(program(s, everything(s))[1]())
    assert np.array_equal(*found)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*near a limit position:kinetostatics.errors.ConditionWarning")
def test_compiled_programs_keep_gaps_and_limits(numba):
    """The six-bar with a second coupler that is too short over a part of the turn, and one that just reaches."""
    scene = SCENES["six-bar"]
    first, second = scene.mechanism.groups
    pin = solve(scene, ANGLES).position("B")[1]
    for length in (0.35, pin.max()):
        groups = (first, replace(second, coupler_length=length))
        s = solve(replace(scene, mechanism=replace(scene.mechanism, groups=groups)), ANGLES, on_gap="nan")
        assert np.array_equal(np.isnan(s.balancing_torque), np.abs(pin) > length)
        assert_program_equals(s, rounded=1e-12)  # near its limit rounding counts for more
    assert s.condition[pin.argmax()] == np.inf


@pytest.mark.parametrize("name", OWN)
def test_programs_of_own_groups_equal_solve(interpreted, name):
    """What takes plain numbers only is computed by NumPy beforehand."""
    scene, tables = OWN[name]
    assert_program_equals(solve(scene, ANGLES), tables)


@pytest.mark.parametrize("name", FORCES)
def test_program_under_a_process_force_equals_solve(interpreted, name):
    force, tables = FORCES[name]
    s = ks.solve(SCENES["plain"].mechanism, ANGLES, crank_speed=SPEED, loads=ks.ProcessForce(force))
    assert_program_equals(s, tables)


@pytest.mark.parametrize("name", quick(BATCHES, 5))
def test_program_of_many_designs_equals_solve(interpreted, name):
    s = BATCHES[name]()
    made, run = program(s, ["balancing_torque"])
    assert run().shape == run(compiled=True).shape == (1, *s.shape)
    assert_program_equals(s, len(made.recording.tables))


@pytest.mark.parametrize("sizes", [False, True])
@pytest.mark.parametrize("name", ["crank angles, other lengths, sampled cam, table", "one design"])
def test_program_in_pieces_gives_the_same(interpreted, monkeypatch, name, sizes):
    s = BATCHES[name]() if name in BATCHES else solve(SCENES["plain, everything"], SAMPLES)
    _, run = program(s, ["O", "balancing_torque"], sizes)
    whole = run(compiled=True)
    expected = [magnitude(s.reaction("O"))] if sizes else s.reaction("O")
    assert largest(whole[:-1] - expected) <= 1e-13 * largest(expected)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    assert np.array_equal(run(compiled=True), whole)


# What a program costs


def cost(scene, *names):
    s = solve(scene, ANGLES)
    return program(s, names or everything(s))[0].recording.operations


def test_what_is_absent_or_not_asked_for_costs_nothing():
    plain, weightless = SCENES["plain"], SCENES["plain, weightless"]
    light = replace(plain, mechanism=plain.mechanism.with_link("coupler", ks.Link()))
    assert cost(light) < cost(weightless) < cost(plain) < cost(SCENES["plain, everything"])
    assert cost(plain, "slider_position") <= 10
    torque, reactions = cost(plain, "balancing_torque"), cost(plain, "O", "A", "B", "guide")
    assert cost(plain, "coupler_rate") < torque < reactions < cost(plain)
    assert cost(plain, "balancing_torque", "A", "A") == cost(plain, "A", "balancing_torque")


def test_designs_of_one_structure_share_a_program():
    def found(**changes):
        values = {"guide_offset": 0.1, "assembly": 1, "slider": 600.0} | changes
        mass = ks.Link(values.pop("slider"))
        mechanism = ks.crank_slider(0.3, values.pop("coupler", 2.0), slider=mass, **values)
        s = ks.solve(mechanism, ANGLES, crank_speed=changes.get("coupler", 5.0))
        return program(s, ["balancing_torque"])[0]

    same = [{"guide_offset": -0.2}, {"slider": 1.0}, {"coupler": 3.0}, {"coupler": np.array([[1.5], [2.5]])}]
    assert {found(**changes) for changes in same} == {found()}
    others = [{"guide_offset": 0.0}, {"slider": 0.0}, {"assembly": -1}, {"guide_angle": 0.3}]
    assert len({found(), *(found(**changes) for changes in others)}) == 5


@pytest.mark.slow
def test_a_second_process_loads_the_compiled_program(numba, tmp_path, monkeypatch, capsys):
    """Nothing is compiled anew, neither there nor here for crank angles that are locked against writing."""
    monkeypatch.setenv("KINETOSTATICS_CACHE", str(tmp_path))
    code = (
        "import kinetostatics as ks;"
        " scene = ks.Scene(ks.crank_slider(0.3, 2.0), crank_speed=1.0);"
        " made = ks.compile(scene, ['slider_position', 'coupler_rate'], engine='compiled');"
        " locked = scene.solve(20).crank_angle;"
        " print(made(locked)['coupler_rate'].tolist(), made(list(locked))['slider_position'].shape)"
    )

    def files():
        kept = (path for path in tmp_path.rglob("*") if path.suffix in (".py", ".nbi", ".nbc"))
        return sorted((path.name, path.stat().st_mtime_ns) for path in kept)

    numba_backend.load_compiled.cache_clear()
    parameter_tree.structure_cache.cache_clear()
    exec(code)
    here, compiled_here = capsys.readouterr().out, files()
    sources, code_files = ([name for name, _ in compiled_here if name.endswith(end)] for end in (".py", ".nbc"))
    assert len(sources) == len(code_files) == 2
    assert all(name.endswith(".1.nbc") for name in code_files)
    there = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert there.stdout == here
    assert files() == compiled_here


def test_program_of_a_table_at_other_angles_is_refused():
    loads = ks.ProcessForce(np.sin(ANGLES))
    scene = ks.Scene(SCENES["plain"].mechanism, crank_speed=1.0, loads=loads)
    made = ks.compile(scene, ["A"], engine="numpy")
    assert made(ANGLES)["A"].shape == (2, 360)
    for angles in (ANGLES[:9], ANGLES[:9] * np.ones((2, 1))):
        with pytest.raises(ks.ParameterError, match="do not fit"):
            made(angles)


def test_missing_numba_names_the_extra_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    scene = ks.Scene(SCENES["plain"].mechanism, crank_speed=1.0)
    for call in (lambda: ks.compile(scene, ["O"], engine="compiled"), lambda: scene.solve(3, engine="compiled")):
        with pytest.raises(ks.errors.MissingLibraryError, match=r'pip install "kinetostatics\[fast\]"'):
            call()


RUBBING = ks.Scene(
    ks.crank_slider(0.05, 0.2, slider=ks.Link(2.0)),
    20.0,
    loads=ks.Gravity(),
    friction={"A": ks.PinFriction(0.1, 0.02), "guide": ks.GuideFriction(0.15, 0.03)},
)


@pytest.mark.slow
def test_repeated_calls_with_few_angles_use_the_loop(monkeypatch):
    pytest.importorskip("numba")
    program = ks.compile(RUBBING, "friction_torque", engine="compiled")
    angles = np.linspace(0.1, 6.0, 5)
    before = [program(angle)["friction_torque"] for angle in (0.3, angles)]
    assert "_short_loop" not in vars(program._program)
    monkeypatch.setattr("kinetostatics.engines.program.MIN_LONG_OPERATIONS", 0)
    monkeypatch.setattr("kinetostatics.engines.program.MIN_COMPILED_OPERATIONS", 0)
    after = [program(angle)["friction_torque"] for angle in (0.3, angles)]
    assert "_short_loop" in vars(program._program)
    assert all(np.array_equal(one, other) for one, other in zip(before, after, strict=True))
    assert program.unlooked(0.3, {}, True)["friction_torque"] == before[0]


def test_few_angles_use_plain_numbers_without_numba(monkeypatch):
    program = ks.compile(RUBBING, "friction_loss", engine="numpy")
    monkeypatch.setattr("kinetostatics.engines.program.MIN_LONG_OPERATIONS", 0)
    monkeypatch.setattr("kinetostatics.engines.program.MIN_COMPILED_OPERATIONS", 0)
    monkeypatch.setattr("kinetostatics.engines.program.numba_available", lambda: False)
    expected = program(0.3)["friction_loss"]
    assert [program.unlooked(0.3, {}, True)["friction_loss"] for _ in range(3)] == [expected] * 3
    assert "_short_loop" not in vars(program._program)


SIZES = st.sampled_from([0.02, 0.05, 0.3, 0.3 * (1 + 1e-12), 2.0, 50.0])
MASSES = st.sampled_from([0.0, 1e-6, 0.01, 5.0, 400.0])


@pytest.mark.slow
@given(SIZES, SIZES, MASSES, MASSES, SIZES, SIZES, st.sampled_from(["open", "crossed", 1, -1]))
def test_a_scene_with_hints_always_gets_a_closer_look(crank, length, mass, inertia, centre, offset, assembly):
    assume(inertia == 0.0 or mass > 0.0)
    try:
        rod = ks.Link(mass, centre, inertia)
        mechanism = ks.crank_slider(crank, length, guide_offset=offset - 0.02, assembly=assembly, coupler=rod)
    except ks.ParameterError:
        assume(False)
    s = ks.Scene(mechanism, crank_speed=1.0).unsolved(np.array([0.3]))
    proportion, odd = s.first_look
    assert math.isclose(proportion, mechanism.proportion, rel_tol=1e-15)
    assert odd or mechanism.hints == ()


@pytest.mark.slow
@every("name", SCENES)
def test_ordinary_machines_need_no_closer_look(name):
    s = solve(SCENES[name], SCENES[name].mechanism.turns * [0.3])
    proportion, odd = s.first_look
    assert math.isclose(proportion, s.mechanism.proportion, rel_tol=1e-15)
    assert not odd


def test_what_cannot_be_recorded_gets_a_closer_look():
    class Measured(ks.cams.Circle):
        @property
        def lengths(self):
            return (math.floor(self.pitch_radius),)

    mechanism = ks.cam_crank_slider(Measured(0.3, (0.01, 0.0)), 2.0)
    s = ks.solve(mechanism, 0.3, crank_speed=1.0)
    assert plausibility_test(s.kind) is None
    assert s.first_look is None
    assert s.proportion == mechanism.proportion


# What designs have in common, computed once

ANGLE = np.linspace(0.1, 6.0, 5)


def run(outputs, parameters, tables):
    """Outputs of a graph at some crank angles."""
    with np.errstate(all="ignore"):
        found = compile_line(line_source(outputs), BY_DESIGN)(ANGLE, np.sin(ANGLE), np.cos(ANGLE), parameters, tables)
    return [np.broadcast_to(part, ANGLE.shape) for part in found]


@pytest.mark.slow
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


@pytest.mark.slow
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
