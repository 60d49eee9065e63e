"""`ks.solve(engine=...)`: the compiled engine gives what NumPy gives, and says what it does not take."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import COMPILED, FASTEST, NUMPY
from kinetostatics.errors import NotGivenError
from kinetostatics.mechanics.quantities import components
from kinetostatics.solution import scene as scenes
from support.both_engines import SHIPPED, ULP, VARIANTS, again, assert_same, engine
from support.scenes import (
    ANGLES,
    BATCHES,
    FORCES,
    OWN,
    SAMPLES,
    SCENES,
    SIZES,
    OneSided,
    everything,
    solve,
    with_group,
)


@pytest.mark.slow
@pytest.mark.parametrize(("case", "name"), VARIANTS)
def test_shipped_variants_are_the_same_by_both_engines(interpreted, case, name):
    expected = SHIPPED[case].solve(name, 36)
    found = again(expected)
    assert_same(found, expected)
    assert float(found.power_residual) <= 1e-13
    assert np.abs(found.frame() - expected.frame()).max(axis=None) <= 8 * ULP * expected.frame().abs().max(axis=None)


@pytest.mark.parametrize("name", SCENES)
def test_scenes_are_the_same_by_both_engines(interpreted, name):
    assert_same(solve(SCENES[name], SAMPLES, engine="compiled"), solve(SCENES[name], SAMPLES))


@pytest.mark.parametrize("name", OWN)
def test_own_cams_and_groups_agree_on_both_engines(interpreted, name):
    scene, _ = OWN[name]
    assert_same(solve(scene, SAMPLES, engine="compiled"), solve(scene, SAMPLES))


@pytest.mark.parametrize("name", FORCES)
def test_process_forces_are_the_same_by_both_engines(interpreted, name):
    force, _ = FORCES[name]
    expected = ks.solve(SCENES["plain"].mechanism, ANGLES, crank_speed=30.0, loads=ks.ProcessForce(force))
    assert_same(again(expected), expected)


@pytest.mark.parametrize("name", BATCHES)
def test_batches_are_the_same_by_both_engines(interpreted, name):
    expected = BATCHES[name]()
    assert_same(again(expected), expected)


SHAPES = {
    "one angle": (0.3, 2.0, 0.3),
    "a list of angles": (0.3, 2.0, [0.3, 1.0]),
    "one row of angles": (SIZES, 2.0, SAMPLES[None]),
    "a row of angles for each design": (SIZES, 2.0, SAMPLES + SIZES),
    "a row of angles for each of one axis of designs": (SIZES, 2.0, (SAMPLES + SIZES[:2])[:, None]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_angles_of_any_shape_agree_on_both_engines(interpreted, name):
    crank, coupler, angles = SHAPES[name]
    expected = ks.solve(ks.crank_slider(crank, coupler, slider=ks.Link(1.0)), angles, crank_speed=3)
    assert_same(again(expected), expected)


def test_rows_of_angles_broadcast_over_designs(interpreted):
    expected = ks.solve(ks.crank_slider(SIZES[:, None], 2.0), SAMPLES + SIZES[:2], crank_speed=3.0)
    assert_same(again(expected), expected)


@pytest.mark.parametrize("load", ["spring", "force", "table"])
def test_batches_of_loads_are_the_same_by_both_engines(interpreted, load):
    loads = {
        "spring": ks.Spring(1e3 * SIZES, 1.0),
        "force": ks.ProcessForce(1e3 * SIZES),
        "table": ks.ProcessForce(1e3 * SIZES * np.sin(SAMPLES)),
    }
    expected = ks.solve(SCENES["plain"].mechanism, SAMPLES, crank_speed=3.0, loads=loads[load])
    assert_same(again(expected), expected)


@dataclass
class Damper:
    """A load of the user's own, which can be compared and so not be looked up."""

    drag: float
    on: str = "slider"

    def push(self, motion):
        """Against the velocity."""
        return -self.drag * motion.slider_velocity


def test_unhashable_loads_agree_on_both_engines(interpreted):
    expected = ks.solve(SCENES["plain"].mechanism, SAMPLES, crank_speed=3.0, loads=Damper(5.0))
    assert_same(again(expected), expected)


# What hangs on a solution


def test_compiled_solutions_have_extremes_and_ratios(interpreted):
    expected = [SHIPPED["sawframe_2r63"].solve(name, 8) for name in ("plain", "cam-circle")]
    found = [again(s) for s in expected]
    for quantity in ("O", "balancing_torque"):
        one, other = (ks.extremes(s[1], quantity) for s in (found, expected))
        assert one.angle == pytest.approx(other.angle, abs=1e-9)
        assert one.value == pytest.approx(other.value, rel=1e-12)
    ratios = [ks.compare(*pair).peak_reaction_ratio("O") for pair in (found, expected)]
    assert ratios[0] == pytest.approx(ratios[1], rel=1e-12)


def test_a_batch_makes_a_row_for_each_design_and_angle(interpreted):
    expected = BATCHES["guide"]()
    table = again(expected).frame()
    assert table.shape == expected.frame().shape
    assert (table.columns == expected.frame().columns).all()


def test_compiled_results_cannot_be_written_to(interpreted):
    s = solve(SCENES["circle cam, everything"], SAMPLES, engine="compiled")
    for name in everything(s):
        for part in components(s, name):
            with pytest.raises(ValueError, match="read-only"):
                part[0] = 1.0


def test_a_compiled_solution_is_told_in_a_line(interpreted):
    expected = solve(SCENES["plain"], SAMPLES)
    assert repr(again(expected)) == repr(expected)
    assert repr(replace(expected)) == repr(expected)


@pytest.mark.parametrize("name", ["cam_force", "slot_force", "pressure_angle"])
def test_unknown_quantities_give_the_same_message(interpreted, name):
    expected = solve(SCENES["plain"], SAMPLES)
    messages = []
    for s in (expected, again(expected)):
        with pytest.raises(ks.QuantityError) as caught:
            getattr(s, name)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]


def test_unknown_joints_are_refused_with_a_list(interpreted):
    with pytest.raises(ks.QuantityError, match=r"reaction is 'C', allowed: 'A', 'B', 'guide', 'O'"):
        solve(SCENES["plain"], SAMPLES, engine="compiled").reaction("C")


def test_unknown_engines_are_refused_with_a_list():
    with pytest.raises(ks.ParameterError, match=r"engine is 'fortran', allowed: .*'numpy', 'compiled'"):
        solve(SCENES["plain"], SAMPLES, engine="fortran")


def test_a_group_that_branches_on_values_is_refused(interpreted):
    scene = with_group(OneSided(ks.Link(3.0, 0.1)))
    assert solve(scene, SAMPLES).scalar("pan moment").shape == SAMPLES.shape
    with pytest.raises(NotGivenError, match=r"cannot run crank with a pan.*kernels must not branch on values"):
        solve(scene, SAMPLES, engine="compiled")


@pytest.fixture
def threshold(interpreted, monkeypatch):
    """Many are 30 angles and more."""
    monkeypatch.setattr(scenes, "MIN_VALUES_COMPILED", SAMPLES.size)


def test_many_angles_are_compiled_by_default(threshold):
    assert engine(SAMPLES) is engine(SAMPLES[:10] + SIZES) is FASTEST
    assert engine(SAMPLES[1:]) is engine(SAMPLES, engine="numpy") is NUMPY
    assert engine(SAMPLES[1:], engine="compiled") is COMPILED


def test_other_kinds_of_numbers_stay_with_numpy(threshold):
    with pytest.warns(UserWarning, match="single precision"):
        assert engine(SAMPLES.astype(np.float32)) is NUMPY


def test_without_numba_many_angles_use_numpy(threshold, monkeypatch):
    monkeypatch.setattr(scenes, "numba_available", lambda: False)
    assert engine(SAMPLES) is NUMPY


def test_the_threshold_is_a_million_crank_angles():
    assert scenes.MIN_VALUES_COMPILED == 1_000_000
    assert "a million crank angles" in " ".join(ks.solve.__doc__.split())


def test_designs_of_a_batch_count_as_crank_angles(threshold):
    mechanism = ks.crank_slider(SIZES, 2.0)
    assert ks.solve(mechanism, SAMPLES[:10], crank_speed=1.0).engine is FASTEST


def test_uncompilable_scenes_use_numpy_by_default(threshold):
    assert solve(with_group(OneSided(ks.Link(3.0, 0.1))), SAMPLES).scalar("pan moment").shape == SAMPLES.shape
