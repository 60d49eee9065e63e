"""Forces of the study's frame saw on its frame, lying as the study has it and upright.

Computed apart from the library by spectral derivatives of the positions and Newton-Euler equations. Upright the springs
are moved so that they carry the slider.
"""

import math

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import shipped

STANDING = {"lying": (-math.pi / 2, 0), "above": (math.pi, 1), "below": (0.0, -1)}
"""Direction of the pull of weight, the guide along +x, and the sign by which the springs are moved."""
LARGEST = {
    ("plain", "lying", "ground"): 286.9,
    ("plain", "above", "ground"): 279.4,
    ("plain", "below", "ground"): 294.1,
    ("plain", "lying", "shaking_force"): 286.8,
    ("cam-circle", "lying", "shaking_force"): 252.1,
    ("cam-circle", "lying", "ground"): 252.2,
    ("cam-circle", "above", "ground"): 259.4,
    ("cam-circle", "below", "ground"): 253.5,
    ("cam-circle", "lying", "ground O"): 22.3,
    ("cam-circle", "lying", "ground guide"): 17.9,
    ("cam-circle", "lying", "ground cam"): 49.9,
    ("cam-circle", "lying", "ground spring"): 202.1,
    ("cam-circle", "above", "ground spring"): 208.0,
}
"""Largest forces in kN by variant, how the saw stands, and quantity."""


def standing(variant, way):
    scene, (pull, side) = shipped("sawframe_2r63").variants[variant].scene, STANDING[way]
    loads = [ks.Gravity(9.81, pull)]
    for spring in scene.loads:
        if isinstance(spring, ks.Spring):
            sag = scene.mechanism.links["slider"].mass * 9.81 / spring.stiffness
            loads.append(ks.Spring(spring.stiffness, spring.free_position + side * sag))
    return ks.Scene(scene.mechanism, scene.crank_speed, 0.0, loads)


@pytest.mark.parametrize(("variant", "way", "quantity"), LARGEST)
def test_largest_forces(variant, way, quantity):
    found = ks.extremes(standing(variant, way).solve(90), quantity).largest
    assert round(found / 1e3, 1) == LARGEST[variant, way, quantity]


def first_harmonic(case, variant):
    """Amplitude of the first harmonic of the shaking force along the guide, kN."""
    s = shipped(case).variants[variant].scene.solve(720)
    return 2e-3 * abs(np.mean(s.shaking_force[0] * np.exp(-1j * s.crank_angle)))


def test_the_cam_leaves_the_first_harmonic_of_the_shaking_force():
    assert round(first_harmonic("sawframe_2r63", "plain"), 2) == 252.66
    assert round(first_harmonic("sawframe_2r63", "cam-circle"), 2) == 253.11


@pytest.mark.slow
def test_so_does_the_torque_free_cam():
    assert round(first_harmonic("sawframe_2r63_optimal", "cam-optimal"), 2) == 252.68
