"""Programs in single precision and by JAX: what a user is given, what it costs in digits, and what is refused."""

import pickle

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import of_scene
from support.every import every

ANGLES = np.linspace(0.0, 6.0, 25)
SAW = ks.Scene(
    ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0)), 33.5, loads=ks.Gravity()
)
SINGLE = {"engine": "numpy", "precision": "single"}


def made(scene=SAW, quantities=("balancing_torque", "O"), **options):
    return ks.compile(scene, quantities, **options)


@every("angle", [0.3, ANGLES, ANGLES[None], ANGLES[:3]], ids=np.shape)
@every("values", [{}, {"slider.mass": 620.0}, {"slider.mass": np.array([[500.0], [620.0]])}], ids=len)
def test_single_precision_is_within_its_bound(angle, values):
    program, exact = made(**SINGLE), made(engine="numpy")(angle, values)
    found, bounds = program(angle, values), program.error_bound(angle, values)
    for name, value in exact.items():
        assert found[name].shape == bounds[name].shape == value.shape
        assert (found[name].dtype, bounds[name].dtype) == (np.float32, float)
        assert np.all(np.abs(found[name] - value) <= bounds[name])
        assert np.all(bounds[name] < 1e-5 * np.max(np.abs(value)))


def test_derivatives_are_in_single_precision_too():
    exact = made(engine="numpy").derivatives(ANGLES)
    for quantity, found in made(**SINGLE).derivatives(ANGLES).items():
        for path, slope in found.items():
            assert slope.dtype == np.float32
            wanted = exact[quantity][path]
            assert np.max(np.abs(slope - wanted)) <= 1e-5 * np.max(np.abs(wanted)), path


@pytest.mark.slow
def test_double_bounds_equal_the_solutions():
    solution = SAW.solve(ANGLES)
    for name, bound in made(engine="numpy").error_bound(ANGLES).items():
        assert np.array_equal(bound, solution.error_bound(name))


@pytest.mark.slow
def test_tight_bounds_equal_the_solutions():
    solution, values = SAW.solve(ANGLES), {"slider.mass": 600.0}
    for name, bound in made(engine="numpy").error_bound(ANGLES, values, tight=True).items():
        assert np.array_equal(bound, solution.error_bound(name, tight=True))
        assert not np.array_equal(bound, solution.error_bound(name))
    with pytest.raises(ks.ParameterError, match="by numpy in single precision, so leave tight out"):
        made(**SINGLE).error_bound(ANGLES, tight=True)


def test_derivatives_take_values_in_any_position():
    program, values, name = made(quantities="balancing_torque", engine="numpy"), {"crank_length": 0.25}, "slider.mass"
    wanted = program.derivatives(ANGLES, by=name, values=values)["balancing_torque"]
    for given in [(name, values), (values, name), (values, [name]), ((name,), values)]:
        assert np.array_equal(program.derivatives(ANGLES, *given)["balancing_torque"][name], wanted[name])
    every = program.derivatives(ANGLES, values)["balancing_torque"]
    assert every.keys() == program.parameters.keys()
    assert np.array_equal(every[name], program.derivatives(ANGLES, values=values)["balancing_torque"][name])
    assert not np.array_equal(wanted[name], program.derivatives(ANGLES)["balancing_torque"][name])
    with pytest.raises(ks.ParameterError, match="both mappings: give the parameter names as a list"):
        program.derivatives(ANGLES, {name: 1.0}, values)


def test_program_and_copy_name_their_engine():
    program = pickle.loads(pickle.dumps(made(**SINGLE)))
    assert (program.engine, program.precision, program.device) == ("numpy", "single", "cpu")
    assert "numpy, single; parameters" in repr(program)
    assert made(engine="numpy").precision == "double"
    assert np.array_equal(program(0.3)["O"], made(**SINGLE)(0.3)["O"])


def test_results_cannot_be_written_to():
    with pytest.raises(ValueError, match="read-only"):
        made(**SINGLE)(ANGLES)["O"][0] = 0.0


SAMPLES = np.radians(np.arange(0.0, 360.0, 4.0))
LAW = ks.cams.CosineLaw(0.3, 2.0)
WHAT_IS_TABLED = {
    "a sampled cam": ks.cam_crank_slider(ks.cams.Sampled(SAMPLES, LAW.radius(SAMPLES)[0]), 2.0, slider=ks.Link(600.0)),
    "no mass": ks.crank_slider(0.3, 2.0),
    "a function": ks.crank_slider(0.3, 2.0, slider=ks.Link(1.0)),
}


def pull(motion):
    return np.where(np.asarray(motion.crank_angle) < 3.0, 100.0, 0.0)


@every("name", WHAT_IS_TABLED)
def test_what_is_no_arithmetic_is_computed_beforehand(name):
    scene = ks.Scene(WHAT_IS_TABLED[name], 30.0, loads=ks.ProcessForce(pull) if name == "a function" else ())
    exact = made(scene, engine="numpy")(ANGLES)
    found = made(scene, **SINGLE)(ANGLES)
    for quantity, value in exact.items():
        assert np.max(np.abs(found[quantity] - value)) <= 3e-6 * np.max(np.abs(value)), quantity


def test_unknown_rounding_has_no_bound():
    scene = ks.Scene(WHAT_IS_TABLED["a function"], 30.0, loads=ks.ProcessForce(pull))
    with pytest.raises(ks.NotGivenError, match="no bound can be given"):
        made(scene, **SINGLE).error_bound(ANGLES)


REFUSED = [
    ({"precision": "half"}, "precision is 'half', allowed: 'double', 'single'"),
    ({"precision": "singel"}, "did you mean 'single'"),
    ({"precision": None}, "precision is None"),
    ({"precision": np.float32}, "precision is"),
    ({"precision": 32}, "precision is 32"),
    ({"engine": "tpu"}, "engine is 'tpu', allowed: 'compiled', 'numpy', 'jax'"),
    ({"engine": "gpu", "precision": "half"}, "engine is 'gpu'.*precision is 'half'"),
    ({"device": "gpu"}, 'device is for engine="jax"'),
    ({"device": "cpu", "engine": "numpy"}, 'device is for engine="jax"'),
    ({"device": 0, "engine": "jax"}, 'device must be a text such as "gpu", got 0'),
    ({"device": ["gpu"], "engine": "jax"}, "device must be a text"),
]


@every("options, words", REFUSED)
def test_unknown_precision_or_engine_is_refused(options, words):
    with pytest.raises(ks.ParameterError, match=f"(?s){words}"):
        made(**options)


@every("precision", ["single", "double"])
def test_unknown_quantity_is_refused_in_any_precision(precision):
    with pytest.raises(ks.QuantityError, match="torqe"):
        made(quantities="torqe", engine="numpy", precision=precision)


@pytest.mark.slow_start
def test_jax_gives_numpy_arrays_and_names_its_device(jax):
    exact = made(engine="numpy")(ANGLES)
    for precision, dtype in (("single", np.float32), ("double", float)):
        program = made(engine="jax", precision=precision, device="cpu")
        found, bounds = program(ANGLES), program.error_bound(ANGLES)
        assert program.device == "cpu"
        for name, value in exact.items():
            assert type(found[name]) is np.ndarray
            assert found[name].dtype == dtype
            assert np.all(np.abs(found[name] - value) <= 2 * bounds[name])


@pytest.mark.slow
@every(
    "crank, bodies, loads",
    [
        (ks.Link(), {}, []),
        (ks.Link(3.0, 0.1, 0.1), {}, [ks.Gravity()]),
        (ks.Link(), {"coupler": ks.Link(150.0, 0.1, 20.5), "slider": ks.Link(600.0)}, []),
        (ks.Link(3.0, 0.1, 0.1), {"coupler": ks.Link(150.0, 0.1, 20.5)}, [ks.Gravity()]),
    ],
)
def test_all_quantities_have_the_mechanisms_gaps(crank, bodies, loads):
    """The crank turns evenly, and weighs the same, where no coupler reaches the guide."""
    scene = ks.Scene(ks.crank_slider(0.3, 0.25, crank=crank, **bodies), 7.0, 3.0, loads)
    solution = scene.solve([0.1, 1.5], on_gap="nan")
    names = tuple(of_scene(solution))
    program, single = made(scene, names, engine="numpy"), made(scene, names, **SINGLE)
    found, bounds = program(solution.crank_angle), program.error_bound(solution.crank_angle)
    one, coarse = program(1.5), single(solution.crank_angle)
    coarse_bounds, slopes = single.error_bound(solution.crank_angle), program.derivatives(solution.crank_angle)
    for name, quantity in of_scene(solution).items():
        own = quantity.read(solution), found[name], coarse[name], bounds[name], coarse_bounds[name]
        for values in (*own, *slopes[name].values(), solution.error_bound(name)):
            assert np.isfinite(values[..., 0]).all(), name
            assert np.isnan(values[..., 1]).all(), name
        assert np.isnan(one[name]).all(), name
    assert found["crank_rate"][0] == solution.rate("crank")[0] == 7.0
    assert bounds["crank_rate"][0] == 0.0


@pytest.mark.parametrize("options", [{"engine": "numpy"}, {"engine": "compiled"}, SINGLE], ids=str)
@pytest.mark.parametrize("speeds", [[1.0, 2.0], [[1.0, 2.0], [3.0, 4.0]]], ids=np.shape)
def test_speed_as_one_number_cannot_become_a_table(options, speeds):
    if options["engine"] == "compiled":
        pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    with pytest.raises(ks.ParameterError, match=r"crank_speed must be a number or an array of shape \(designs, 1\)"):
        made(**options)([0.1, 0.2], {"crank_speed": np.array(speeds)})
