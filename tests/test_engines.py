"""One source of physics on every engine: the kernels of the package, as they are, in numba, JAX, arb and dask."""

import ast
import functools
import inspect
import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import cam_roller, crank, elementary, links, planar, slider_group

SPEED = 320 * 2 * math.pi / 60
ANGLES = np.linspace(0, 2 * math.pi, 360, endpoint=False)
KERNEL_MODULES = (planar, links, crank, cam_roller, slider_group)


class Scene(NamedTuple):
    """A mechanism under load; what is absent is None."""

    mechanism: ks.Mechanism
    gravity: ks.Gravity | None = None
    spring: ks.Spring | None = None
    push: float | None = None
    acceleration: float | None = None


LIGHT = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}
HEAVY = {
    "crank": ks.Link(80.0, (0.1, 0.03), 2.0),
    "coupler": ks.Link(150.0, (0.9, -0.1), 20.5),
    "slider": ks.Link(600.0, (0.2, 0.05), 5.0),
}
BLOCK = ks.Link(30.0, (0.02, 0.01), 0.5)
COSINE = ks.cams.CosineLaw(0.3, 2.0)
BALANCING = ks.Spring.balancing(600.0, SPEED, 2.0)
SCENES = {
    "plain, weightless": Scene(ks.crank_slider(0.3, 2.0, **LIGHT)),
    "plain": Scene(ks.crank_slider(0.3, 2.0, **LIGHT), ks.Gravity()),
    "plain, everything": Scene(
        ks.crank_slider(0.3, 2.0, guide_angle=0.3, guide_offset=0.1, assembly=-1, **HEAVY),
        ks.Gravity(),
        ks.Spring(1e4, -1.0),
        2500.0,
        40.0,
    ),
    "circle cam": Scene(
        ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.0219, 0.0)), 2.0219, **LIGHT), ks.Gravity(), BALANCING
    ),
    "cosine cam": Scene(ks.cam_crank_slider(COSINE, COSINE.coupler_length, **LIGHT), ks.Gravity(), BALANCING),
    "circle cam, everything": Scene(
        ks.cam_crank_slider(
            ks.cams.Circle(0.3, (0.02, 0.01)), 2.0, guide_angle=0.3, guide_offset=0.1, block=BLOCK, **HEAVY
        ),
        ks.Gravity(),
        BALANCING,
        2500.0,
        40.0,
    ),
}
PLAIN = [name for name in SCENES if name.startswith("plain")]
CAMS = [name for name in SCENES if "cam" in name]


def solve(scene, angles, **options):
    loads = [load for load in (scene.gravity, scene.spring) if load is not None]
    if scene.push is not None:
        loads.append(ks.ProcessForce(scene.push))
    return ks.solve(
        scene.mechanism,
        angles,
        crank_speed=SPEED,
        crank_acceleration=scene.acceleration or 0.0,
        loads=loads,
        **options,
    )


def results(solution):
    """Every reaction, force and moment by name."""
    scalars = ["guide_force", "guide_moment", "balancing_torque"]
    if solution.mechanism.crank.length is None:
        scalars += ["cam_force", "slot_force"]
    vectors = {joint: solution.reaction(joint) for joint in ("O", "A", "B")}
    return vectors | {name: getattr(solution, name) for name in scalars}


def largest(values):
    return max(abs(float(value)) for value in np.ravel(values))


def assert_agree(found, expected, tolerance=1e-13):
    """Every result agrees, to the tolerance times its largest value."""
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert largest(np.asarray(found[name]) - values) <= tolerance * largest(values), name


# The kernels of a whole mechanism, called one after the other


class Problem(NamedTuple):
    """A scene as kernels take it."""

    crank_length: Any
    coupler_length: Any
    guide: ks.Guide
    assembly: Any
    crank: links.Body
    block: links.Body | None
    coupler: links.Body
    slider: links.Body
    speed_squared: Any
    acceleration: Any
    gravity: Any
    stiffness: Any
    free_position: Any
    push: Any


def problem(scene):
    mechanism, group = scene.mechanism, scene.mechanism.groups[-1]
    bodies = {name: link.body for name, link in mechanism.links.items()}
    level = ks.Guide(None, None)
    return Problem(
        crank_length=mechanism.crank.length,
        coupler_length=group.coupler_length,
        guide=level if group.guide == ks.Guide.at() else group.guide,
        assembly=group.assembly,
        crank=bodies["crank"],
        block=bodies.get("block"),
        coupler=bodies["coupler"],
        slider=bodies["slider"],
        speed_squared=SPEED * SPEED,
        acceleration=scene.acceleration,
        gravity=scene.gravity and scene.gravity.vector,
        stiffness=scene.spring and scene.spring.stiffness,
        free_position=scene.spring and scene.spring.free_position,
        push=scene.push,
    )


def load(link, body, problem):
    return links.load(link, body, problem.speed_squared, problem.acceleration, problem.gravity)


def slider_forces(group, problem):
    pull = planar.product(problem.stiffness, planar.minus(problem.free_position, group.travel.position))
    return slider_group.resolve(
        group,
        problem.coupler_length,
        problem.guide,
        load(group.coupler, problem.coupler, problem),
        load(group.slider, problem.slider, problem),
        planar.plus(pull, problem.push),
        None,
    )


def plain_forces(angle, problem):
    """O, A, B (x and y of each), guide force and moment, torque of a plain crank-slider."""
    ray = crank.ray(angle)
    joint = crank.pin(ray, problem.crank_length)
    group = slider_group.place(joint, problem.coupler_length, problem.guide, problem.assembly)
    forces = slider_forces(group, problem)
    own = load(links.LinkMotion(crank.ORIGIN, ray, 1.0, None), problem.crank, problem)
    demand = links.Wrench(forces.inner, planar.moment(joint.position, forces.inner))
    ground, torque = crank.resolve(own, demand)
    return ground + forces.inner + forces.pin + (forces.guide_force, forces.guide_moment, torque)


def cam_forces(angle, radius, slope, second, problem):
    """The same of a cam-balanced one, from r, r', r'' of its cam, then cam and slot force."""
    ray = crank.ray(angle)
    joint = cam_roller.place(ray, radius, slope, second)
    group = slider_group.place(joint, problem.coupler_length, problem.guide, problem.assembly)
    forces = slider_forces(group, problem)
    on_block = load(links.LinkMotion(joint, ray, 1.0, None), problem.block, problem)
    roller = cam_roller.resolve(ray, radius, slope, on_block, forces.inner)
    own = load(links.LinkMotion(crank.ORIGIN, ray, 1.0, None), problem.crank, problem)
    ground, torque = crank.resolve(own, roller.crank_demand)
    supports = (forces.guide_force, forces.guide_moment, torque, roller.cam, roller.slot)
    return ground + forces.inner + forces.pin + supports


def plain_loop(angles, problem, rows):
    for i in range(angles.size):
        forces = plain_forces(angles[i], problem)
        for k in range(len(forces)):
            rows[k, i] = forces[k]


def cam_loop(angles, radius, slope, second, problem, rows):
    for i in range(angles.size):
        forces = cam_forces(angles[i], radius[i], slope[i], second[i], problem)
        for k in range(len(forces)):
            rows[k, i] = forces[k]


def named(rows):
    """Rows of forces by the names of `results`."""
    names = ("guide_force", "guide_moment", "balancing_torque", "cam_force", "slot_force")
    vectors = {joint: rows[2 * k : 2 * k + 2] for k, joint in enumerate("OAB")}
    return vectors | dict(zip(names, rows[6:], strict=False))


# numba


class DecideAbsence(ast.NodeTransformer):
    """Turns ``a is None`` into True or False, for arguments known to be absent or present."""

    def __init__(self, absent):
        self.absent = absent

    def visit_Compare(self, node):
        """Called by `ast` for every comparison."""
        match node:
            case ast.Compare(ast.Name(name), [ast.Is() | ast.IsNot() as test]):
                return ast.Constant(self.absent[name] == isinstance(test, ast.Is))
        return node


@functools.cache
def specialised(kernel, *absent):
    """A kernel compiled from its own source, with the tests for absent arguments decided.

    Numba by itself drops only the branch that an argument of None never takes; where the argument is present it keeps
    both, and the result could be None as far as it can tell.
    """
    decide = DecideAbsence(dict(zip(inspect.signature(kernel).parameters, absent, strict=True)))
    tree = ast.fix_missing_locations(decide.visit(ast.parse(inspect.getsource(kernel))))
    made = {}
    exec(compile(tree, inspect.getfile(kernel), "exec"), kernel.__globals__, made)
    return made[kernel.__name__]


@pytest.fixture(scope="module")
def njit():
    """`numba.njit`, once numba knows the kernels."""
    numba = pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    from numba.extending import overload

    def register(kernel):
        @overload(kernel, strict=False)
        def choose(*arguments):
            return specialised(kernel, *(isinstance(kind, numba.types.NoneType) for kind in arguments))

    for module in KERNEL_MODULES:
        for _, function in inspect.getmembers(module, inspect.isfunction):
            if function.__module__ == module.__name__:
                register(function)
    for function in (load, slider_forces, plain_forces, cam_forces):
        register(function)
    overload(elementary.sin)(lambda x: lambda x: math.sin(x))
    overload(elementary.cos)(lambda x: lambda x: math.cos(x))
    overload(elementary.sqrt)(lambda x: lambda x: math.sqrt(x))
    return numba.njit


@pytest.mark.parametrize("name", PLAIN)
def test_numba_loop_over_the_plain_kernels_equals_solve(njit, name):
    rows = np.empty((9, ANGLES.size))
    njit(plain_loop)(ANGLES, problem(SCENES[name]), rows)
    assert_agree(named(rows), results(solve(SCENES[name], ANGLES)))


@pytest.mark.parametrize("name", CAMS)
def test_numba_loop_over_the_cam_kernels_equals_solve(njit, name):
    scene = SCENES[name]
    polar = scene.mechanism.group(ks.CamRoller).cam.radius(ANGLES)
    rows = np.empty((11, ANGLES.size))
    njit(cam_loop)(ANGLES, *polar, problem(scene), rows)
    assert_agree(named(rows), results(solve(scene, ANGLES)))


# JAX


@pytest.fixture
def jax():
    return pytest.importorskip("jax", reason="jax is not installed (extra: grad)")


@pytest.fixture
def double(jax):
    """JAX in double precision, and back to what it was."""
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield jax
    jax.config.update("jax_enable_x64", before)


@pytest.mark.parametrize("name", SCENES)
def test_solve_under_jax_jit_equals_numpy(double, name):
    found = double.jit(lambda angles: results(solve(SCENES[name], angles, on_gap="nan")))(ANGLES)
    assert all(values.dtype == "float64" for values in found.values())
    assert_agree(found, results(solve(SCENES[name], ANGLES)))


@pytest.mark.parametrize("name", PLAIN)
def test_kernels_under_jax_jit_equal_solve(double, name):
    jnp = double.numpy
    compute = double.jit(lambda angles: jnp.broadcast_arrays(*plain_forces(angles, problem(SCENES[name]))))
    assert_agree(named(np.array(compute(ANGLES))), results(solve(SCENES[name], ANGLES)))


def torque_by_stiffness(stiffness):
    """Mean squared torque of the cosine cam, (N m)^2."""
    scene = SCENES["cosine cam"]._replace(spring=ks.Spring(stiffness, 2.0))
    return (solve(scene, elementary.namespace(stiffness).asarray(ANGLES), on_gap="nan").balancing_torque ** 2).mean()


def torque_by_cam_radius(radius):
    """Mean squared torque of the circle cam, (N m)^2."""
    cam = ks.cams.Circle(radius, (-0.0219, 0.0))
    scene = SCENES["circle cam"]._replace(mechanism=ks.cam_crank_slider(cam, 2.0219, **LIGHT))
    return (solve(scene, elementary.namespace(radius).asarray(ANGLES), on_gap="nan").balancing_torque ** 2).mean()


@pytest.mark.parametrize(("cost", "at"), [(torque_by_stiffness, 7e5), (torque_by_cam_radius, 0.31)])
def test_jax_gradient_equals_central_difference(double, cost, at):
    step = 1e-5 * at
    difference = (cost(at + step) - cost(at - step)) / (2 * step)
    assert float(double.grad(cost)(at)) == pytest.approx(difference, rel=1e-6)


def test_jax_in_single_precision_is_warned_of(jax):
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", False)
    try:
        with pytest.warns(UserWarning, match="single precision.*jax_enable_x64"):
            solve(SCENES["plain"], jax.numpy.asarray(ANGLES))
    finally:
        jax.config.update("jax_enable_x64", before)


# arb


@pytest.fixture
def flint():
    """python-flint at 200 bits, and back to what it was."""
    flint = pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    before = flint.ctx.prec
    flint.ctx.prec = 200
    yield flint
    flint.ctx.prec = before


def assert_narrow(found, flint):
    """All enclosures are narrower than 1e-40 of the largest value."""
    for name, values in found.items():
        radii = [flint.arb(value).rad() for value in values.flat]
        assert largest(radii) <= 1e-40 * largest(values), name


def middles(found, flint):
    return {name: np.vectorize(lambda value: flint.arb(value).mid(), "O")(values) for name, values in found.items()}


@pytest.mark.parametrize("name", SCENES)
def test_double_precision_lies_within_rounding_of_the_arb_enclosure(flint, name):
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
def test_arb_enclosures_equal_the_50_digit_tables_to_24_digits(flint, variant):
    path = Path(__file__).parent / "data" / f"sawframe_{variant}.json"
    rows = json.loads(path.read_text(encoding="utf-8"))["rows"]
    columns = {"guide_force": "N", "balancing_torque": "T", "cam_force": "cam", "slot_force": "slot"}
    found = results(sawframe(variant, flint))
    decimals = {name: np.array([row[columns.get(name, name)] for row in rows]).T for name in found}
    expected = {name: np.vectorize(lambda text: flint.arb(str(text)), "O")(texts) for name, texts in decimals.items()}
    assert_narrow(found, flint)
    assert_agree(middles(found, flint), expected, tolerance=1e-24)


# dask


@pytest.mark.parametrize("name", SCENES)
def test_dask_arrays_stay_lazy_in_chunks_and_equal_numpy(name):
    dask_array = pytest.importorskip("dask.array", reason="dask is not installed (extra: distributed)")
    found = results(solve(SCENES[name], dask_array.from_array(ANGLES, chunks=90)))
    assert all(values.chunks[-1] == (90,) * 4 for values in found.values())
    assert_agree({name: values.compute() for name, values in found.items()}, results(solve(SCENES[name], ANGLES)))
