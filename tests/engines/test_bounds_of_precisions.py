"""Bounds on single precision and on other engines: never less than the true error, and none where nothing is known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.error_bounds import DOUBLE, SINGLE, ErrorBounds, is_handed_over
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.jax_backend import Backend, Given, MixedPrecision
from kinetostatics.engines.program import Program
from kinetostatics.errors import NotGivenError
from kinetostatics.numbers.arithmetic import NEGLIGIBLE_LENGTH, RELATIVE_OFFSET, UNIT_ROUNDOFF, offset_from_zero
from support.bounded import FAMILIES, over_worst, solution
from support.elsewhere import errors, exact_values
from support.every import every
from support.graphs import Case
from support.inclined import INCLINED


def _single(program, angle, given, rows):
    """Values in single precision, of what a design fixes in double."""
    recording, split = program.recording, MixedPrecision(program)
    bounds = ErrorBounds(recording.graph, recording.inputs, SINGLE).of(program.outputs)
    fixed = [np.asarray(part, np.float32) for part in split._fixed_by(given)]
    turn = [np.asarray(part, np.float32) for part in (angle, np.sin(angle), np.cos(angle))]
    handed = Given(*turn, fixed, [row.astype(np.float32) for row in rows], angle.shape)
    return *split.by_numpy(handed), *Program(recording, bounds).by_numpy(angle, given, rows, angle.shape)


SINGLE_PRECISION = {"single": _single}


U = 2.0**-24
ANGLES = np.linspace(0.01, 6.2, 40)
NUMPY = Backend("numpy", "single")


@pytest.mark.slow
@every("family", FAMILIES)
def test_single_precision_values_lie_within_bounds(flint, family):
    made = next(found for found in (solution(family, seed) for seed in range(9)) if found is not None)
    exact = exact_values(made, ("balancing_torque", *made.reactions, "kinetic_energy"))
    found = errors(made, exact, [NUMPY])[NUMPY]
    assert found.values > 10
    assert found.wrong == []


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning", "ignore::kinetostatics.HintWarning")
@every("place", INCLINED, ids=lambda place: place.name)
def test_no_bound_near_a_direction_lost_in_single(flint, place):
    for number in place.numbers[4::9]:
        scene = place.scene(number)
        made = ks.Scene(scene.mechanism, scene.crank_speed, 0.0, scene.loads).solve(
            scene.crank_angle[:: max(1, scene.crank_angle.size // 4)], on_gap="nan"
        )
        found = errors(made, exact_values(made), [NUMPY])[NUMPY]
        assert found.values > 10
        assert found.wrong == []


def test_zero_times_an_undefined_value_has_no_bound():
    """A moment that is zero wherever the mechanism closes is NaN where single precision cannot tell that it does."""
    lever = ks.slotted_lever(5 / 16, pivot=(3 / 16, 4 / 16), lever=ks.Link(1.0, 0.1, 0.1), block=ks.Link(1.0))
    angle = float(np.arctan2(4.0, 3.0)) + np.array([1e-9, 0.5])
    program = ks.compile(ks.Scene(lever, 10.0), "slot_moment", engine="numpy", precision="single")
    value, bound = program(angle)["slot_moment"], program.error_bound(angle)["slot_moment"]
    assert np.isnan(value).tolist() == np.isinf(bound).tolist() == [True, False]


@pytest.mark.slow
@every("case, variant, most", over_worst("single"))
def test_bounds_stay_near_the_worst_error_of_a_turn(case, variant, most):
    scene = ks.load_case(case).variants[variant].scene
    program = ks.compile(scene, ("balancing_torque", "O"), engine="numpy", precision="single")
    exact = ks.compile(scene, ("balancing_torque", "O"), engine="numpy")(ANGLES)
    values, bounds = program(ANGLES), program.error_bound(ANGLES)
    for name, bound in bounds.items():
        error = np.abs(values[name] - exact[name])
        assert np.all(error <= bound)
        assert np.max(bound) < most * np.max(error)


def bounds_of(outputs, values, arithmetic=SINGLE):
    found = ErrorBounds(outputs[0].graph, {}, arithmetic).of(outputs)
    return Program(None, found)._by_numbers(np.array([0.5]), values, (1,))[:, 0]


def test_inputs_and_operations_are_each_rounded_once():
    graph = Graph()
    turn, mass, length = graph.angle().sin(), graph.parameter(0), graph.parameter(1)
    outputs = turn, mass * length, (mass * length) * turn, mass * turn + length * turn
    found = bounds_of(outputs, [3.0, 0.7])
    s = np.sin(0.5)
    wanted = [s * U, 2.1 * U, 3 * 2.1 * s * U, 4 * 3.7 * s * U]
    assert np.all(found >= wanted)
    np.testing.assert_allclose(found, wanted, rtol=0.05)


def test_double_precision_rounds_no_input():
    graph = Graph()
    mass, turn = graph.parameter(0), graph.angle().sin()
    (found,) = bounds_of([mass * turn], [3.0], DOUBLE)
    assert found == pytest.approx(3.0 * np.sin(0.5) * 3 * 2.0**-53, rel=1e-6)


@pytest.mark.slow
def test_a_total_is_within_its_bound_by_every_engine(numba, jax):
    graph = Graph()
    turn, mass, length = graph.angle().sin(), graph.parameter(0), graph.parameter(1)
    outputs = [graph.node("total", mass * turn, -1.0 * length, 1.0)]
    recording = SimpleNamespace(graph=graph, inputs={}, tables=())
    state = SimpleNamespace(crank_angle=np.linspace(0.1, 1.5, 60), shape=(60,))
    leaves = SimpleNamespace(numbers=[0.7, 1.3], tables=())
    exact = 0.7 * np.sin(state.crank_angle.astype(np.longdouble)) - 1.3 + 1.0
    for engine, precision in (("numpy", "single"), ("compiled", "single"), ("jax", "single"), ("jax", "double")):
        program, backend = Program(recording, outputs), Backend(engine, precision, "cpu")
        error = np.abs(backend.run(program, state, leaves)[0] - exact)
        bound = backend.bounds(program, state, leaves)[0]
        assert np.all(error <= bound)
        assert np.max(bound) < 40 * (U if precision == "single" else UNIT_ROUNDOFF)


def test_constants_that_single_precision_lacks_count():
    graph = Graph()
    turn = graph.angle().sin()
    half, tenth = bounds_of([(turn + 1.0) * 0.5, (turn + 1.0) * 0.1], [])
    assert tenth > 1.2 * half / 5


def test_overflow_of_an_intermediate_leaves_no_bound():
    """In single precision 1 / (m s)^2 is 0 for m = 1e25, as wrong as can be and finite."""
    graph = Graph()
    large = graph.parameter(0) * graph.angle().sin()
    small = 1.0 / (large * large)
    assert bounds_of([small], [1e15]) < 1e-35
    assert not np.isfinite(bounds_of([small], [1e25]))
    heavy = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(1e37)), 30.0)
    program = ks.compile(heavy, "balancing_torque", engine="numpy", precision="single")
    assert np.all(np.isinf(program.error_bound(ANGLES)["balancing_torque"]))


def test_underflow_in_single_precision_is_bounded():
    light = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(1e-43)), 1.0)
    program = ks.compile(light, "balancing_torque", engine="numpy", precision="single")
    exact = light.solve(ANGLES).balancing_torque
    bound = program.error_bound(ANGLES)["balancing_torque"]
    assert np.all(np.abs(program(ANGLES)["balancing_torque"] - exact) <= bound)
    assert np.max(bound) < 1e-35


def test_no_bound_where_single_cannot_tell_assembly():
    folded = ks.Scene(ks.crank_slider(0.5, 0.5, slider=ks.Link(1.0)), 1.0)
    program = ks.compile(folded, "B", engine="numpy", precision="single")
    with np.errstate(all="ignore"):
        angles = [0.3, np.pi / 2 - 1e-5, np.pi / 2]
        bound, found = program.error_bound(angles)["B"], program(angles)["B"]
    assert not np.isfinite(bound[:, 2]).any()
    near = ks.compile(folded, "B", engine="numpy")(angles[:2])["B"]  # in double, far nearer than single precision
    assert np.all(np.abs(found[:, :2] - near) <= bound[:, :2])


def test_no_bound_where_there_is_no_value():
    short = ks.Scene(ks.crank_slider(0.5, 0.3, slider=ks.Link(1.0)), 1.0)
    program = ks.compile(short, "B", engine="numpy", precision="single")
    assert np.isnan(program.error_bound([0.1, 1.5])["B"][:, 1]).all()
    assert np.isnan(program([0.1, 1.5])["B"][:, 1]).all()


@pytest.mark.slow
def test_no_bound_after_too_many_operations():
    graph = Graph()
    long = graph.angle().sin()
    for _ in range(3000):
        long = long * graph.angle().cos()
    with pytest.raises(NotGivenError, match="too many operations"):
        bounds_of([long], [])


def test_tables_and_design_constants_are_passed_on():
    graph = Graph()
    mass, angle, row = graph.parameter(0), graph.angle(), graph.row(0)
    assert all(map(is_handed_over, (mass, mass * mass, angle, row, angle.sin(), angle.cos())))
    assert not any(map(is_handed_over, (angle * angle, mass * angle, (2.0 * angle).sin(), row * row)))


FUNCTIONS = [("sin", "sin"), ("cos", "cos"), ("arctan", "atan"), ("exp", "exp"), ("log", "log")]


def single_numbers(name):
    """Numbers of all sizes, and those next to multiples of a right angle; for which a function has a value."""
    random = np.random.default_rng(1)
    sizes = random.uniform(-1, 1, 60_000) * 10.0 ** random.uniform(-10, 6, 60_000)
    near = (np.arange(1, 20_000) * np.pi / 2).astype(np.float32)
    found = np.concatenate([sizes.astype(np.float32), near, np.nextafter(near, np.float32(0))])
    if name == "exp":
        return found[abs(found) < 80.0]
    return found[(found > 0.0) & (found != 1.0)] if name == "log" else found


def most_ulp(name, arithmetic):
    return 1.0 if name == "sqrt" else arithmetic.ulp


def off(found, exact, unit):
    return np.max(np.abs(found.astype(float) - exact) / np.abs(exact)) / unit


@every("function, name", FUNCTIONS)
def test_numpy_functions_in_single_keep_to_their_ulp(function, name):
    numbers = single_numbers(name)
    compute = getattr(np, function)
    assert off(compute(numbers), compute(numbers.astype(float)), U) <= most_ulp(name, SINGLE)


@pytest.mark.slow
@every("function, name", FUNCTIONS)
def test_loop_functions_in_single_keep_to_their_ulp(numba, function, name):
    own = getattr(math, name)
    compute = numba.vectorize([numba.float32(numba.float32)], nopython=True)(lambda number: own(number))
    numbers = single_numbers(name)
    assert off(compute(numbers), getattr(np, function)(numbers.astype(float)), U) <= most_ulp(name, SINGLE)


@pytest.mark.slow
@every("function, name", FUNCTIONS)
def test_jax_functions_on_the_cpu_keep_to_their_ulp(jax, function, name):
    numbers = single_numbers(name)
    exact = getattr(np, function)(numbers.astype(np.longdouble))
    with jax.default_device(jax.devices("cpu")[0]):
        single = np.asarray(jax.jit(getattr(jax.numpy, function))(numbers))
        with jax.enable_x64(True):
            double = np.asarray(jax.jit(getattr(jax.numpy, function))(numbers.astype(float)))
    assert off(single, exact.astype(float), U) <= most_ulp(name, SINGLE)
    if np.finfo(np.longdouble).eps < 1e-18:
        assert np.max(np.abs(double - exact) / np.abs(exact)) <= most_ulp(name, DOUBLE) * 2.0**-53


@every("arithmetic, unit", [(SINGLE, U), (DOUBLE, UNIT_ROUNDOFF)])
def test_what_is_moved_off_zero_is_in_bounds(arithmetic, unit):
    """By a share of lengths, or by a unit that no distance sees; exact arithmetic moves neither."""
    graph = Graph()
    half, sizes = 0.5 * graph.angle(), graph.parameter(0) + graph.parameter(1)
    for moved, least in (
        (offset_from_zero(half, sizes), RELATIVE_OFFSET * 7.0),
        (offset_from_zero(half, NEGLIGIBLE_LENGTH), RELATIVE_OFFSET * NEGLIGIBLE_LENGTH),
    ):
        (bound,) = ErrorBounds(graph, {}, arithmetic).of([moved])
        assert Program(None, [bound])._by_numbers(np.array([0.0]), [3.0, 4.0], (1,))[0, 0] >= least


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_bounds_near_change_points_hold_or_are_inf(flint, jax):
    links = {name: ks.Link(1.0, (0.15, 0.0), 0.01) for name in ("crank", "coupler", "rocker")}
    backends = NUMPY, Backend("jax", "single"), Backend("jax", "double")
    for assembly in (1, "open", "crossed"):
        rhombus = ks.four_bar(0.3, 0.3, 0.3, rocker_pivot=(0.3, 0.0), assembly=assembly, **links)
        angles = [1e-30, 1e-45, 1e-100, 1e-121, -1e-150, 1e-300]
        s = ks.solve(rhombus, angles, crank_speed=3.0, loads=[ks.Gravity()], on_gap="nan")
        found = errors(s, exact_values(s), backends)
        assert [found[backend].wrong for backend in backends] == [[], [], []]


@pytest.mark.slow
def test_random_graphs_in_single_lie_within_bounds(flint):
    assert [wrong for seed in range(30) for wrong in Case(seed).wrong(SINGLE_PRECISION)] == []
