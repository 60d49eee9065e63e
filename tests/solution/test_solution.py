"""A solution as its user meets it: results on demand, tables, other angles."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.mechanism import Mechanism

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def balanced_pump(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_torque_by_power_computes_no_reaction(monkeypatch):
    expected = balanced_pump().balancing_torque

    def refuse(*_):
        raise AssertionError("forces were resolved")

    monkeypatch.setattr(Mechanism, "resolve", refuse)
    np.testing.assert_allclose(balanced_pump().balancing_torque_by_power, expected, atol=1e-9)


def test_motion_and_shaking_force_compute_no_reaction(monkeypatch):
    monkeypatch.setattr(Mechanism, "resolve", None)
    solution = balanced_pump()
    assert solution.position("B").shape == solution.shaking_force.shape == (2, TURN.size)


def test_standing_mechanism_is_in_static_equilibrium():
    standing = balanced_pump(crank_speed=0.0)
    work = 150 * 9.81 * standing.at(TURN).position("coupler")[1]
    slope = np.fft.irfft(1j * np.arange(TURN.size // 2 + 1) * np.fft.rfft(work), TURN.size)
    np.testing.assert_allclose(standing.balancing_torque, slope, atol=1e-6)
    assert standing.power_residual < 1e-14


def test_power_residual_shows_a_torque_that_is_wrong(monkeypatch):
    monkeypatch.setattr(ks.Solution, "balancing_torque", property(lambda s: s.scalar("balancing_torque") + 1.0))
    solution = balanced_pump()
    assert solution.power_residual == pytest.approx(1.0 / solution.largest_torque_term, rel=1e-9)
    assert 1e-5 < solution.power_residual < 1e-4


def test_cosine_cam_warns_off_its_law():
    law = ks.cams.CosineLaw(0.3, 2.0)
    with pytest.warns(UserWarning, match=r"coupler_length 2.0 m is not the cam's 2.02"):
        ks.cam_crank_slider(law, 2.0)
    with pytest.warns(UserWarning, match="guide_offset 0.1 m is not 0"):
        ks.cam_crank_slider(law, law.coupler_length, guide_offset=0.1)


def rockers_slider(length, assembly=1):
    """A slider hung on a rocker whose pivot its guide runs through."""
    ram = ks.SliderGroup(length, ks.Guide.at(0.0, 0.1), assembly, on="B", pin="C", label="2")
    return ks.Mechanism("press", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), ram))


@pytest.mark.parametrize("mechanism", [ks.crank_slider(0.1, 0.1, assembly="crossed"), rockers_slider(0.3)])
def test_slider_that_never_moves_is_warned_of(mechanism):
    with pytest.warns(
        ks.HintWarning, match=r"the slider2? stands still all over the turn: the coupler2? is as long as"
    ):
        ks.solve(mechanism, 0.3, crank_speed=1.0)


@pytest.mark.parametrize(
    "mechanism",
    [
        ks.crank_slider(0.1, 0.1, assembly="open"),
        ks.crank_slider(0.1, 0.1, guide_offset=0.01, assembly=-1),
        ks.crank_slider(0.1, 0.1),
        rockers_slider(0.3, -1),
        rockers_slider(0.31),
    ],
)
def test_sliders_that_move_are_not_warned_of(mechanism):
    assert mechanism.hints == ()


# Crank angles as solutions keep them


def test_a_single_crank_angle_gives_single_values():
    solution = balanced_pump(0.5)
    assert solution.balancing_torque.shape == ()
    assert solution.reaction("O").shape == (2,)
    assert solution.power_residual < 1e-14


def test_results_are_read_only_and_stay():
    turn = TURN.copy()
    solution = balanced_pump(turn)
    before = solution.guide_force.copy()
    turn[:] = 0.0
    np.testing.assert_array_equal(solution.at(TURN).guide_force, before)
    with pytest.raises(ValueError, match="read-only"):
        solution.guide_force[0] = 0.0


def test_integer_angles_do_not_truncate_results():
    np.testing.assert_array_equal(balanced_pump(np.arange(4)).rate("crank"), np.full(4, 33.5))


# A scene


TWELVE = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
SCENE = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), 10.0, 2.0, (ks.Gravity(), ks.Spring(500.0, 0.4)))


def test_a_scene_is_solved_as_its_parts_are():
    whole, parts = (
        SCENE.solve(TWELVE),
        ks.solve(SCENE.mechanism, TWELVE, crank_speed=10.0, crank_acceleration=2.0, loads=SCENE.loads),
    )
    assert np.array_equal(whole.balancing_torque, parts.balancing_torque)
    assert SCENE.solve(12).crank_angle == pytest.approx(TWELVE)


def test_the_period_is_that_of_loads_and_mechanism():
    table = ks.Table(np.pi * np.arange(4), [1.0, 2.0, 1.0, 0.0], period=4 * np.pi)
    assert SCENE.period == 2 * np.pi
    assert ks.Scene(SCENE.mechanism, 1.0, loads=(ks.ProcessForce(table, period=4 * np.pi),)).period == 4 * np.pi


# Drive and loads in a line, and tables among them


def test_scene_and_solution_print_in_a_line():
    speed = np.linspace(30.0, 40.0, TURN.size)
    scene = ks.Scene(SAW, speed, loads=[ks.Gravity(), ks.ProcessForce(speed)])
    drive = "crank_speed=<array of shape (24,)>, crank_acceleration=0.0, Gravity, ProcessForce>"
    assert repr(scene) == f"<Scene: crank-slider, {drive}"
    assert repr(scene.solve(TURN)) == f"<Solution: crank-slider, shape (24,), {drive}"
    assert repr(ks.Scene(SAW, 33.5)) == "<Scene: crank-slider, crank_speed=33.5, crank_acceleration=0.0, no loads>"


# A solution as a table


def test_frame_has_a_row_an_angle_with_units():
    table = balanced_pump().frame()
    assert len(table) == TURN.size
    assert all(name.endswith("]") for name in table.columns)
    np.testing.assert_allclose(table["crank_angle [deg]"], np.arange(0, 360, 15))
    np.testing.assert_array_equal(table["balancing_torque [N m]"], balanced_pump().balancing_torque)
    np.testing.assert_array_equal(table["reaction_O_x [N]"], balanced_pump().reaction("O")[0])


def test_frame_of_a_batch_numbers_its_designs():
    batch = ks.solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(600)), TURN, crank_speed=33.5)
    table = batch.frame()
    assert len(table) == 2 * TURN.size
    np.testing.assert_array_equal(table["design"], np.repeat([0, 1], TURN.size))
    np.testing.assert_array_equal(table["A_x [m]"], batch.position("A")[0].ravel())


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


def test_frame_has_motion_of_every_slider():
    s = two_sliders("1", "2")
    table = s.frame()
    for slider in ("slider1", "slider2"):
        assert np.array_equal(table[f"{slider}_position [m]"], s.travel(slider))
        assert np.array_equal(table[f"{slider}_velocity [m/s]"], s.travel_velocity(slider))
        assert np.array_equal(table[f"{slider}_acceleration [m/s2]"], s.travel_acceleration(slider))
