"""Slider and yoke groups."""

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import ParameterError
from kinetostatics.studies.methods.high_precision.independent import Machine
from support.every import every

TURN = np.linspace(0.05, 2 * np.pi, 25)
CRANK, L, E = 0.1, 0.4, 0.03


@every("assembly", [1, -1])
def test_position_and_velocity_are_the_closed_form(assembly):
    s = ks.solve(ks.crank_slider(CRANK, L, guide_offset=E, assembly=assembly), TURN, crank_speed=3.0)
    root = np.sqrt(L**2 - (E - CRANK * np.sin(TURN)) ** 2)
    assert s.slider_position == pytest.approx(CRANK * np.cos(TURN) + assembly * root, rel=1e-14)
    slope = -CRANK * np.sin(TURN) + assembly * (E - CRANK * np.sin(TURN)) * CRANK * np.cos(TURN) / root
    assert s.slider_velocity == pytest.approx(3.0 * slope, abs=1e-14)


def test_a_massless_coupler_is_a_two_force_member():
    s = ks.solve(ks.crank_slider(CRANK, L, slider=ks.Link(2.0)), TURN, crank_speed=30.0, loads=ks.Gravity())
    rod, force = s.position("B") - s.position("A"), s.reaction("B")
    assert np.abs(rod[0] * force[1] - rod[1] * force[0]).max() < 1e-13 * np.abs(force).max()
    assert s.guide_force - 2.0 * 9.81 == pytest.approx(force[1] * np.sign(force[1] * (s.guide_force - 19.62)), abs=1e-9)


def test_short_coupler_is_refused_with_its_intervals():
    with pytest.raises(ks.AssemblyError) as caught:
        ks.solve(ks.crank_slider(0.4, 0.3), TURN, crank_speed=1.0)
    assert caught.value.intervals[0][1] == pytest.approx(np.pi - np.arcsin(0.75), abs=1e-12)


# Scotch yokes

R, SPEED = 0.07, 12.0
ANGLES = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
EPSILON = 2.0**-53


def test_upright_slot_gives_a_pure_cosine():
    s = ks.solve(ks.scotch_yoke(R), ANGLES, crank_speed=SPEED)
    assert np.max(np.abs(s.slider_position - R * np.cos(ANGLES))) < 2 * EPSILON * R
    assert np.max(np.abs(s.slider_velocity + SPEED * R * np.sin(ANGLES))) < 4 * EPSILON * SPEED * R
    assert np.max(np.abs(s.slider_acceleration + SPEED**2 * R * np.cos(ANGLES))) < 4 * EPSILON * SPEED**2 * R


def test_yoke_shaking_force_is_one_harmonic():
    s = ks.solve(ks.scotch_yoke(R, slider=ks.Link(5.0)), ANGLES, crank_speed=SPEED)
    spectrum = np.fft.rfft(s.shaking_force, axis=-1) / (ANGLES.size / 2)
    assert spectrum[0, 1].real == pytest.approx(5.0 * R * SPEED**2, rel=1e-14)
    spectrum[0, 1] = 0.0
    assert np.max(np.abs(spectrum)) < 1e-14 * 5.0 * R * SPEED**2


@pytest.mark.slow
@every("slot", [0.01, 1.2, 2.0, 3.1, -1.0, 4.0])
@every("tilt, offset", [(0.0, 0.0), (0.4, 0.03), (np.pi / 2, -0.02), (2.5, 0.0)])
def test_motion_is_of_intersecting_lines(slot, tilt, offset):
    made = ks.scotch_yoke(R, guide_angle=tilt, guide_offset=offset, slot_angle=slot, slider=ks.Link(1.0))
    s = ks.solve(made, ANGLES, crank_speed=SPEED, crank_acceleration=3.0)
    with mp.workdps(130):
        rows = [Machine(mp, s, index, 20) for index in range(0, ANGLES.size, 5)]
        for order in ("position", "velocity", "acceleration"):
            expected = np.array([complex(getattr(row, order)["joint", "B"]) for row in rows])
            x, y = getattr(s, order)("B")[:, ::5]
            size = (R + abs(offset)) / abs(np.sin(slot)) * {"position": 1.0, "velocity": SPEED}.get(order, SPEED**2)
            assert np.max(np.abs(x + 1j * y - expected)) < 8 * EPSILON * size, order


@pytest.mark.slow
def test_a_spring_that_is_nearly_free_keeps_its_digits():
    """The pin is within 1e-12 m of the free position, where the coordinate alone is good to 1e-16 m."""
    mean = 1.0
    made = ks.Mechanism(
        "yoke on a pin", ks.Crank(R), (ks.Pin(on="crank", at=(mean, 0.0)), ks.YokeGroup(on="C", slot_angle=1.2))
    )
    angle = np.array([0.0, 1e-3])
    s = ks.solve(made, angle, crank_speed=1.0)
    with mp.workdps(40):
        exact = [mp.cos(a) - mp.sin(a) * mp.cot(mp.mpf(1.2)) for a in map(mp.mpf, angle)]
        free = float(exact[1])
        expected = [float(place - mp.mpf(free)) for place in exact]
    assert np.max(np.abs(s.elongation(free) - expected)) < 2 * EPSILON


@every("slot", [0.0, np.pi, -np.pi, 2 * np.pi, 1e-12])
def test_a_slot_parallel_to_the_guide_is_refused(slot):
    with pytest.raises(ParameterError, match="parallel to the guide; it must differ from 0 and pi"):
        ks.YokeGroup(slot_angle=slot)
    with pytest.raises(ParameterError, match=r"slot_angle .* rad makes the slot parallel"):
        ks.scotch_yoke(R, slot_angle=np.array([[1.0], [slot]]))


def test_program_refuses_a_parallel_slot():
    program = ks.compile(ks.Scene(ks.scotch_yoke(R, slider=ks.Link(1.0)), 1.0), ("O",), engine="numpy")
    with pytest.raises(ParameterError, match="parallel to the guide"):
        program(0.3, {"slot_angle": np.pi})


@every("field, value", [("slot_angle", np.nan), ("slot_angle", None), ("guide", 0.3), ("block", 1.0)])
def test_what_no_yoke_can_have_is_refused(field, value):
    with pytest.raises(ParameterError, match=f"yoke group: {field}"):
        ks.YokeGroup(**{field: value})


@pytest.mark.slow
def test_a_yoke_found_in_another_way_bears_the_same():
    """A series of one harmonic is the yoke itself."""
    made = ks.scotch_yoke(R, guide_angle=0.3, guide_offset=0.01, slot_angle=1.1, slider=ks.Link(2.0, (0.1, 0.2), 0.1))
    s = ks.solve(made, ANGLES, crank_speed=SPEED)
    found = ks.needs(s, "guide_moment", 0.01)
    series = next(model for model in found.alone if model.name == "one harmonic")
    assert series.error < 1e-13
