"""A first look at the numbers of a scene never overlooks what hints would say, and agrees on the proportion."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import kinetostatics as ks
from kinetostatics.engines.first_look import plausibility_test
from support.scenes import SCENES, solve

SIZES = st.sampled_from([0.02, 0.05, 0.3, 0.3 * (1 + 1e-12), 2.0, 50.0])
MASSES = st.sampled_from([0.0, 1e-6, 0.01, 5.0, 400.0])


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


@pytest.mark.parametrize("name", SCENES)
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
