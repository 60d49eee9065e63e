"""Gradients by JAX through the kernels, against central differences of the same kernels with 60 digits."""

import math

import numpy as np
import pytest

import kinetostatics as ks

pytestmark = pytest.mark.slow

ANGLES = np.linspace(0.0, 2 * math.pi, 360, endpoint=False)
SPEED = 320 * 2 * math.pi / 60
STIFFNESS = 600.0 * SPEED**2
STEP = "1e-20"
"""Of the central difference, relative: its own error is 1e-40 times the third derivative."""


def links(coupler_length=2.0):
    """Of the sawframe: the mass centre stays at the middle of the coupler, whatever its length."""
    return {"coupler": ks.Link(150.0, coupler_length / 2, 20.5), "slider": ks.Link(600.0)}


def cam_balanced(stiffness=STIFFNESS, radius=0.3, offset=-0.0219, coupler_length=2.0219):
    """Circle cam with its centre at `offset` from O, and spring."""
    cam = ks.cams.Circle(radius, (offset, 0.0))
    return ks.cam_crank_slider(cam, coupler_length, **links(coupler_length)), (ks.Spring(stiffness, 2.0),)


def plain(crank_length=0.3, coupler_length=2.0):
    return ks.crank_slider(crank_length, coupler_length, **links(coupler_length)), ()


PARAMETERS = {
    "spring stiffness": lambda x: cam_balanced(stiffness=x),
    "cam radius": lambda x: cam_balanced(radius=x),
    "cam offset": lambda x: cam_balanced(offset=x),
    "coupler length, cam-balanced": lambda x: cam_balanced(coupler_length=x),
    "crank length": lambda x: plain(crank_length=x),
    "coupler length": lambda x: plain(coupler_length=x),
}
VALUES = {
    "spring stiffness": (STIFFNESS, 1.3 * STIFFNESS),
    "cam radius": (0.3, 0.33),
    "cam offset": (-0.0219, 0.01),
    "coupler length, cam-balanced": (2.0219, 1.8),
    "crank length": (0.3, 0.9),
    "coupler length": (2.0, 0.5),
}
"""The case's own value and another."""


def mean_absolute_torque(parameter, value, angles):
    """N m, in numbers of the kind of the value."""
    mechanism, springs = PARAMETERS[parameter](value)
    s = ks.solve(mechanism, angles, crank_speed=SPEED, loads=[ks.Gravity(), *springs], on_gap="nan")
    return abs(s.balancing_torque).mean()


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_mean_torque_gradient_equals_differences(double, flint, parameter):
    """To 1e-12, at two values of each parameter by one compiled function."""
    angles = np.array([flint.arb(angle) for angle in ANGLES.tolist()])
    gradient = double.jit(
        double.grad(lambda value: mean_absolute_torque(parameter, value, double.numpy.asarray(ANGLES)))
    )
    for value in VALUES[parameter]:
        step = abs(flint.arb(value)) * flint.arb(STEP)
        above, below = (mean_absolute_torque(parameter, flint.arb(value) + sign * step, angles) for sign in (1, -1))
        difference = (above - below) / (2 * step)
        assert difference.rad() < 1e-30 * abs(difference)
        found = gradient(value)
        assert found.dtype == "float64"
        assert abs(flint.arb(float(found)) - difference) < 1e-12 * abs(difference), (value, float(found), difference)
