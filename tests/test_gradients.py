"""Gradients by JAX through the kernels, against central differences of the same kernels with 60 digits."""

import math
from typing import NamedTuple

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.elementary import namespace

ANGLES = np.linspace(0.0, 2 * math.pi, 360, endpoint=False)
SPEED = 320 * 2 * math.pi / 60
STIFFNESS = 600.0 * SPEED**2
MASSES = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}


def mean_absolute_torque(mechanism, number, spring=None):
    """N m, in numbers of the kind of the given one."""
    angles = namespace(number).asarray(ANGLES) if not is_arb(number) else np.array([arb(a) for a in ANGLES.tolist()])
    loads = [ks.Gravity(), *([spring] if spring else [])]
    return abs(ks.solve(mechanism, angles, crank_speed=SPEED, loads=loads, on_gap="nan").balancing_torque).mean()


def by_stiffness(stiffness):
    mechanism = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.0219, 0.0)), 2.0219, **MASSES)
    return mean_absolute_torque(mechanism, stiffness, ks.Spring(stiffness, 2.0))
