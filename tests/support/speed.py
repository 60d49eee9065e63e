"""What benchmarks share: the plain sawframe, a script for it written flat, and how rivals are timed."""

import math
import os
import subprocess
import sys
import timeit
from pathlib import Path

import numpy as np

import kinetostatics as ks

CRANK, COUPLER, CENTRE = 0.3, 2.0, 1.0
COUPLER_MASS, COUPLER_INERTIA, SLIDER_MASS = 150.0, 20.5, 600.0
SPEED = 320 * 2 * math.pi / 60
GRAVITY = 9.81
PLAIN = ks.crank_slider(
    CRANK, COUPLER, coupler=ks.Link(COUPLER_MASS, CENTRE, COUPLER_INERTIA), slider=ks.Link(SLIDER_MASS)
)
LOADS = (ks.Gravity(GRAVITY),)


def turn(count):
    return np.linspace(0, 2 * math.pi, count, endpoint=False)


def results(mechanism, angles):
    """O, A, B, guide force and moment, torque."""
    s = ks.solve(mechanism, angles, crank_speed=SPEED, loads=LOADS)
    return s.reaction("O"), s.reaction("A"), s.reaction("B"), s.guide_force, s.guide_moment, s.balancing_torque


def flat(angles):
    """The same by one script, specialised by hand: massless crank, level guide through O, coupler centre on A-B.

    With c, s of the coupler, k its rate and e its angular acceleration by crank angle, the centre at the distance a
    from A has the acceleration -(x + a p, y - a q) by crank angle, where p = e s + k^2 c and q = e c - k^2 s.
    """
    square = SPEED * SPEED
    x, y = CRANK * np.cos(angles), CRANK * np.sin(angles)
    s = y * (-1.0 / COUPLER)
    c = np.sqrt((1.0 - s) * (1.0 + s))
    along = COUPLER * c
    k = x / along
    k2 = k * k
    e = (y - k2 * y) / along
    p, q = e * s + k2 * c, e * c - k2 * s
    mass_x = (COUPLER_MASS * square) * (x + CENTRE * p)
    mass_y = (COUPLER_MASS * square) * (y - CENTRE * q) - COUPLER_MASS * GRAVITY
    mass_moment = CENTRE * (c * mass_y - s * mass_x) - (COUPLER_INERTIA * square) * e
    pin_x = (-SLIDER_MASS * square) * (x + COUPLER * p)
    pin_y = (mass_moment / COUPLER + s * pin_x) / c
    inner = np.array((pin_x - mass_x, pin_y - mass_y))
    torque = x * inner[1] - y * inner[0]
    return inner, inner, np.array((pin_x, pin_y)), SLIDER_MASS * GRAVITY - pin_y, np.zeros_like(x), torque


def seconds(*rivals, rounds=12, spent=0.02):
    """Least time of a call of each rival, s; in each round each is called for about `spent` s."""
    timers = [timeit.Timer(rival) for rival in rivals]
    counts = [max(1, round(spent / min(timer.repeat(3, 1)))) for timer in timers]
    times = [[min(timer.repeat(count, 1)) for timer, count in zip(timers, counts, strict=True)] for _ in range(rounds)]
    return np.min(times, axis=0)


def assert_same(found, expected):
    for values, right in zip(found, expected, strict=True):
        np.testing.assert_allclose(values, right, rtol=0, atol=1e-12 * np.max(np.abs(right)))


def run(code, environment):
    """What Python prints in a fresh process that finds what tests share and the package."""
    tests = Path(__file__).parents[1]
    folders = tests, tests / "benchmarks", Path(ks.__file__).parents[1]
    path = {"PYTHONPATH": os.pathsep.join(map(str, folders))}
    command = [sys.executable, "-c", code]
    done = subprocess.run(
        command, env={**os.environ, **path, **environment}, check=True, capture_output=True, text=True
    )
    return done.stdout
