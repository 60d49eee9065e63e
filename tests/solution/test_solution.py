"""A solution as its user meets it: results on demand, tables, other angles."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.mechanism import Mechanism

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_torque_by_power_computes_no_reaction(monkeypatch):
    expected = solved().balancing_torque

    def refuse(*_):
        raise AssertionError("forces were resolved")

    monkeypatch.setattr(Mechanism, "resolve", refuse)
    np.testing.assert_allclose(solved().balancing_torque_by_power, expected, atol=1e-9)


def test_motion_and_shaking_force_compute_no_reaction(monkeypatch):
    monkeypatch.setattr(Mechanism, "resolve", None)
    solution = solved()
    assert solution.position("B").shape == solution.shaking_force.shape == (2, TURN.size)


def test_a_standing_mechanism_is_held_by_the_statics_of_its_loads():
    standing = solved(crank_speed=0.0)
    work = 150 * 9.81 * standing.at(TURN).position("coupler")[1]
    slope = np.fft.irfft(1j * np.arange(TURN.size // 2 + 1) * np.fft.rfft(work), TURN.size)
    np.testing.assert_allclose(standing.balancing_torque, slope, atol=1e-6)
    assert standing.power_residual < 1e-14


def test_power_residual_shows_a_torque_that_is_wrong(monkeypatch):
    monkeypatch.setattr(ks.Solution, "balancing_torque", property(lambda s: s.scalar("balancing_torque") + 1.0))
    solution = solved()
    assert solution.power_residual == pytest.approx(1.0 / solution.largest_torque_term, rel=1e-9)
    assert 1e-5 < solution.power_residual < 1e-4


def test_cosine_law_cam_warns_of_a_mechanism_that_breaks_the_law():
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
def test_a_slider_that_stands_still_all_over_the_turn_is_warned_of(mechanism):
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
