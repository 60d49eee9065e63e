"""Compiled outputs of scenes, their derivatives, and cycles in parts."""

import copy
import pickle
import warnings
from dataclasses import dataclass

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.reductions import parsed
from kinetostatics.errors import NotGivenError
from kinetostatics.solution.piecewise_turns import PiecewiseTurns
from support.every import every

ANGLES = np.linspace(0.0, 6.0, 25)
QUANTITIES = ("balancing_torque", "O", "guide_force", "slider_acceleration", "coupler_rate", "shaking_force")


def saw(**links):
    given = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)} | links
    return ks.Scene(ks.crank_slider(0.3, 2.0, **given), 30.0, loads=ks.Gravity())


def assert_as_solved(found, solution):
    for name, values in found.items():
        expected = solution[name]
        assert values.shape == expected.shape, name
        size = np.nanmax(np.abs(expected))
        assert np.allclose(values, expected, rtol=0.0, atol=1e-14 * size, equal_nan=True), name


@pytest.mark.parametrize("angle", [0.3, ANGLES, ANGLES[:3], ANGLES[None]], ids=["one", "turn", "few", "row"])
def test_program_gives_what_a_solution_gives(angle):
    assert_as_solved(ks.compile(saw(), QUANTITIES, engine="numpy")(angle), saw().solve(np.asarray(angle)))


def test_other_numbers_give_what_a_varied_scene_gives():
    values = {"slider.mass": 620.0, "crank_length": 0.31, "gravity.direction": -1.4, "crank_speed": 31.0}
    found = ks.compile(saw(), QUANTITIES, engine="numpy")(ANGLES, values)
    assert_as_solved(found, saw().varied(values).solve(ANGLES))


def test_arrays_of_numbers_make_a_batch():
    masses = np.array([[500.0], [600.0], [700.0]])
    found = ks.compile(saw(), ("balancing_torque", "O"), engine="numpy")(ANGLES, {"slider.mass": masses})
    assert found["O"].shape == (2, 3, ANGLES.size)
    for row, mass in enumerate(masses[:, 0]):
        alone = saw(slider=ks.Link(mass)).solve(ANGLES)
        assert np.array_equal(found["balancing_torque"][row], alone.balancing_torque)


@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize("angle", [np.linspace(0.0, 6.0, 25), 3.0])
def test_derivatives_are_nan_where_values_are(interpreted, angle, engine):
    coupler, rocker = ks.Link(2.0, 0.2, 0.03), ks.Link(2.0, 0.1, 0.02)
    crank = {"crank": ks.Link(1.0, 0.1, 0.01), "coupler": coupler, "rocker": rocker}
    scene = ks.Scene(ks.four_bar(0.3, 0.4, 0.3, rocker_pivot=(0.55, 0.1), **crank), 20.0, 0.0, ks.Gravity())
    program = ks.compile(scene, ["balancing_torque", "O", "rocker_rate"], engine=engine)
    values, slopes = program(angle), program.derivatives(angle)
    assert np.isnan(values["balancing_torque"]).any()
    for quantity, by_path in slopes.items():
        for path, slope in by_path.items():
            assert np.array_equal(np.isnan(slope), np.isnan(values[quantity])), (quantity, path)


def test_parameters_are_the_present_and_the_asked_for():
    program = ks.compile(saw(), "balancing_torque", parameters=("crank.mass", "slider.centre.across"), engine="numpy")
    assert program.parameters["crank.mass"] == 0.0
    assert "crank.inertia" not in program.parameters
    assert program.parameters["slider.mass"] == 600.0
    plain = ks.compile(saw(), "balancing_torque", engine="numpy")
    assert np.array_equal(program(ANGLES)["balancing_torque"], plain(ANGLES)["balancing_torque"])
    varied = saw().varied({"crank.mass": 5.0, "slider.centre.across": 0.1}).solve(ANGLES)
    found = program(ANGLES, {"crank.mass": 5.0, "slider.centre.across": 0.1})
    assert found["balancing_torque"] == pytest.approx(varied.balancing_torque, rel=1e-14)


def test_gaps_are_nan_without_a_word():
    scene = ks.Scene(ks.crank_slider(1.0, 0.8, slider=ks.Link(1.0)), 3.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ks.compile(scene, "O", engine="numpy")(ANGLES)["O"]
    expected = scene.solve(ANGLES, on_gap="nan").reaction("O")
    assert np.array_equal(found, expected, equal_nan=True)
    assert np.isnan(found).any()


BAD = {
    "absent": ({"crank.mass": 1.0}, r'crank.mass is zero .* compile\(\.\.\., parameters=\("crank.mass",\)\)'),
    "unknown": ({"slider.mas": 1.0}, "did you mean 'slider.mass'"),
    "negative": ({"slider.mass": -1.0, "crank_length": 0.0}, "slider.mass must be at least 0.*crank length must be gr"),
    "text": ({"slider.mass": "600 kg"}, "slider.mass must be a number"),
    "over the angles": ({"crank_length": ANGLES}, "last axis would be the crank angle"),
    "not a number": ({"crank_speed": np.nan}, "crank_speed must be finite"),
}


@every("name", BAD)
def test_numbers_no_machine_can_have_are_refused(name):
    values, words = BAD[name]
    with pytest.raises(ks.ParameterError, match=words):
        ks.compile(saw(), "O", engine="numpy")(ANGLES, values)


def test_inconsistent_numbers_are_refused():
    mechanism = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.0, slider=ks.Link(1.0))
    program = ks.compile(ks.Scene(mechanism, 3.0), "cam_force", engine="numpy")
    with pytest.raises(ks.ParameterError, match="O must lie inside the pitch circle"):
        program(ANGLES, {"cam.centre.x": -0.5})


WRONG = {
    "a variant": (
        lambda: ks.compile(ks.load_case("shaper").variants["idle"], "O"),
        r"got Variant\(.*; give its .scene",
    ),
    "no scene": (lambda: ks.compile(saw().mechanism, "O"), "scene must be a Scene"),
    "no quantity": (lambda: ks.compile(saw(), ()), "no quantities"),
    "unknown quantity": (lambda: ks.compile(saw(), "cam_force", engine="numpy"), "quantity is 'cam_force', allowed"),
    "unknown parameter": (
        lambda: ks.compile(saw(), "O", ("block.mass",), "numpy"),
        "parameter is 'block.mass', allowed",
    ),
    "unknown engine": (lambda: ks.compile(saw(), "O", engine="fortran"), "engine is 'fortran', allowed"),
}


@every("name", WRONG)
def test_what_cannot_be_compiled_is_refused(name):
    call, words = WRONG[name]
    with pytest.raises((ks.ParameterError, ks.QuantityError), match=words):
        call()


def test_crank_speed_over_the_angles_must_fit_them():
    scene = ks.Scene(saw().mechanism, np.linspace(20.0, 30.0, ANGLES.size))
    program = ks.compile(scene, "balancing_torque", engine="numpy")
    assert np.array_equal(program(ANGLES)["balancing_torque"], scene.solve(ANGLES).balancing_torque)
    with pytest.raises(ks.ParameterError, match="do not fit together"):
        program(ANGLES[:4])


def test_derivatives_have_the_shape_of_the_quantity():
    program = ks.compile(saw(), ("O", "balancing_torque"), engine="numpy")
    found = program.derivatives(ANGLES, ("crank_length", "slider.mass"))
    assert {name: {path: slope.shape for path, slope in slopes.items()} for name, slopes in found.items()} == {
        "O": dict.fromkeys(("crank_length", "slider.mass"), (2, ANGLES.size)),
        "balancing_torque": dict.fromkeys(("crank_length", "slider.mass"), (ANGLES.size,)),
    }


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["numpy", "compiled"])
@pytest.mark.parametrize("angle", [0.5, [0.5]])
@pytest.mark.parametrize("count", [5, 5000])
def test_one_angle_at_many_speeds_gives_many_results(count, angle, engine):
    if engine == "compiled":
        pytest.importorskip("numba")
    scene = ks.Scene(saw().mechanism, np.linspace(20.0, 30.0, count))
    expected = scene.solve(np.full(count, 0.5)).balancing_torque
    assert np.array_equal(scene.solve(angle, engine="numpy").balancing_torque, expected)
    found = ks.compile(scene, "balancing_torque", engine=engine)(angle)["balancing_torque"]
    assert np.allclose(found, expected, rtol=1e-13, atol=0.0)
    assert np.allclose(scene.solve(angle, engine=engine).balancing_torque, expected, rtol=1e-13, atol=0.0)


@pytest.mark.parametrize("copied", [lambda program: pickle.loads(pickle.dumps(program)), copy.deepcopy])
def test_a_program_goes_from_process_to_process(copied):
    program = ks.compile(saw(), "O", ("guide_offset",), "numpy")
    values = {"guide_offset": 0.01}
    assert np.array_equal(copied(program)(ANGLES, values)["O"], program(ANGLES, values)["O"])


@dataclass(frozen=True, eq=False)
class Brake:
    damping: float = 3.0
    on: str = "slider"

    def push(self, motion):
        """Force, N."""
        return np.where(motion.slider_velocity > 0, -self.damping * motion.slider_velocity, 0.0)


def test_unrecorded_load_allows_no_derivatives():
    scene = ks.Scene(saw().mechanism, 30.0, loads=Brake())
    program = ks.compile(scene, "balancing_torque", engine="numpy")
    varied = scene.varied({"damping": 5.0}).solve(ANGLES).balancing_torque
    assert np.array_equal(program(ANGLES, {"damping": 5.0})["balancing_torque"], varied)
    with pytest.raises(NotGivenError, match="Brake on 'slider' does more than arithmetic"):
        program.derivatives(ANGLES, "damping")


def test_derivatives_off_an_unrecorded_load_are_given():
    program = ks.compile(ks.Scene(saw().mechanism, 30.0, loads=Brake()), "slider_velocity", engine="numpy")
    found = program.derivatives(ANGLES, "crank_speed")["slider_velocity"]["crank_speed"]
    assert np.allclose(found, program(ANGLES)["slider_velocity"] / 30.0)


def test_one_kept_parameter_may_be_a_text():
    assert "guide_offset" in ks.compile(saw(), "O", "guide_offset", "numpy").parameters


@every(
    ("call", "words"),
    [
        (lambda program: program(0.5, ["slider.mass"]), "values must be a dict"),
        (lambda program: program(0.5, 3), "values must be a dict"),
        (lambda program: program.derivatives(0.5, ()), "by is empty"),
        (lambda program: program([]), "program: there are no crank angles"),
        (lambda program: program(np.array([])), "program: there are no crank angles"),
        (lambda program: program(["a"]), "program: crank_angle must be a number"),
    ],
)
def test_senseless_program_calls_are_refused(call, words):
    with pytest.raises(ks.ParameterError, match=words):
        call(ks.compile(saw(), "O", engine="numpy"))


# What the numbers of a scene are to a program


def test_a_wanted_axis_number_has_a_derivative():
    """Along an axis a guide's direction belongs to the structure."""
    upright, inclined = (
        ks.Scene(ks.crank_slider(0.1, 3.0, guide=ks.Guide.through((0.0, 0.0), end), slider=ks.Link(1.0)), 3.0)
        for end in ((0.0, 2.0), (1e-9, 2.0))
    )
    for path in ("exact.x", "exact.y"):
        assert path in ks.compile(upright, ("O",), (path,), engine="numpy").parameters
        one, other = (
            scene.solve([0.3, 1.0]).uncertainty("balancing_torque", {path: 1e-6}) for scene in (upright, inclined)
        )
        assert np.all(one.inputs[path] > 0.0)
        np.testing.assert_allclose(one.inputs[path], other.inputs[path], rtol=1e-7)
    with pytest.raises(ks.ParameterError, match=r"exact.y is of an axis and so left out; keep it by compile"):
        ks.compile(upright, ("O",), engine="numpy")(0.3, {"exact.y": 0.9})


# Outputs over the turn parted where it bends

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


@pytest.mark.slow
def test_designs_have_the_numbers_that_they_have_alone():
    crank, mass = np.array([[0.03], [0.05], [0.06]]), np.array([[1.0], [2.0], [0.1]])
    together, _ = PiecewiseTurns.of(pump(crank, mass), OUTPUTS, 192).estimated(OUTPUTS)
    for row in range(3):
        alone, _ = PiecewiseTurns.of(pump(crank[row : row + 1], mass[row : row + 1]), OUTPUTS, 192).estimated(OUTPUTS)
        np.testing.assert_array_max_ulp(together[:, row], alone[:, 0], 4)  # BLAS adds rows in groups of its own


@pytest.mark.slow
def test_the_compiled_loop_gives_the_same(numba):
    plain, compiled = (
        PiecewiseTurns.of(pump(), OUTPUTS, 192, engine=engine).estimated(OUTPUTS)[0] for engine in ("numpy", "compiled")
    )
    np.testing.assert_allclose(plain, compiled, rtol=1e-9)
