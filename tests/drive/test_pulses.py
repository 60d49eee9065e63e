"""Loads that act over a fraction of a turn: motions lose none of their energy.

The work of a pulse of torque on the crank is an integral by hand; weight has a potential energy.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import kinetostatics as ks

TURN = 2.0 * math.pi
MASSLESS = ks.crank_slider(0.3, 1.1)
MOTOR = ks.drive.Motor.kloss(5000.0, 99.0, synchronous_speed=104.7, overload=2.5)
QUICK, TURNED = (0, 6), (6, 11, 14, 15)
"""Drawn machines that are tested always, and those that turn back."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Pulse:
    """A pulse of torque over crank angles, rad: a trapezoid for tables, a rectangle for functions."""

    def __init__(self, width, size, middle=math.radians(100.0), ramp=1e-3):
        self.size, self.ends = size, (middle - 0.5 * width, middle + 0.5 * width)
        (low, high), ramp = self.ends, ramp * width
        self.angles = np.array([0.0, low, low + ramp, high - ramp, high, TURN])
        self.torques = np.array([0.0, 0.0, size, size, 0.0, 0.0])

    def load(self, kind):
        """Torque on the crank: "table", "declared" or "undeclared"."""
        if kind == "table":
            return ks.Torque(ks.Table(self.angles, self.torques), on="crank")
        return ks.Torque(self if kind == "declared" else lambda motion: self(motion), on="crank")

    def __call__(self, motion):
        """Torque, N m."""
        inside = np.mod(motion.crank_angle, TURN)
        return np.where((inside > self.ends[0]) & (inside < self.ends[1]), self.size, 0.0)

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return [], list(self.ends)

    def work(self, kind, start, end):
        """Work between two crank angles, J."""
        return self._work(kind, end) - self._work(kind, start)

    def _work(self, kind, angle):
        turns, inside = divmod(angle, TURN)
        if kind != "table":
            return self.size * (turns * np.diff(self.ends)[0] + np.clip(inside, *self.ends) - self.ends[0])
        angles = np.append(self.angles[self.angles < inside], inside)
        parts = np.interp(angles, self.angles, self.torques)
        return turns * np.trapezoid(self.torques, self.angles) + np.trapezoid(parts, angles)


def motor_work(motion):
    """Work of the motor over a motion, J, by Gauss' rule in each step."""
    half = 0.5 * np.diff(motion.time)[:, None]
    inside = motion.at((motion.time[:-1, None] + half * (1.0 + NODES)).ravel())
    power = (inside.motor_torque * motion.motor.transmission * inside.speed).reshape(half.size, -1)
    return float((half * power * WEIGHTS).sum())


@pytest.mark.parametrize("kind", ["table", "declared", "undeclared"])
@pytest.mark.parametrize(("width", "taken"), [(5.0, 872.6646259971648), (9.0, 1570.7963267948966)])
def test_ten_pulses_take_their_energy(kind, width, taken):
    pulse = Pulse(math.radians(width), -1000.0, ramp=1e-7)
    scene = ks.Scene(MASSLESS, 1.0, loads=pulse.load(kind))
    motion = ks.drive.coast(scene, 3.0, 0.0, 60.0, until=1.08)
    energy = 1.5 * motion.speed**2
    assert 9 * TURN + 2.0 < motion.crank_angle[-1] < 10 * TURN + 1.0
    assert energy[0] - energy[-1] == pytest.approx(taken * (1.0 - 1e-7 * (kind == "table")), rel=1e-12)
    assert motion.energy_drift < 1e-12 * energy[0]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["table", "declared"])
def test_run_up_pays_for_narrow_pulses(kind):
    pulse = Pulse(math.radians(1.0), -1000.0)
    motion = ks.drive.start(ks.Scene(MASSLESS, 1.0, loads=pulse.load(kind)), MOTOR, 3.0)
    kept = motor_work(motion) + pulse.work(kind, 0.0, motion.crank_angle[-1])
    assert pulse.work(kind, 0.0, motion.crank_angle[-1]) < -500.0
    assert 1.5 * motion.speed[-1] ** 2 == pytest.approx(kept, rel=1e-12)


def drawn(seed, kind):
    """A scene with pulses, and these."""
    draw = np.random.default_rng(seed).uniform
    mechanism = ks.crank_slider(
        draw(0.05, 0.3),
        draw(0.7, 1.5),
        guide_offset=draw(-0.05, 0.05),
        crank=ks.Link(draw(1.0, 5.0), draw(0.0, 0.04), draw(0.02, 0.1)),
        coupler=ks.Link(draw(1.0, 5.0), draw(0.2, 0.3), draw(0.05, 0.1)),
        slider=ks.Link(draw(1.0, 10.0)),
    )
    least = 0.2 if kind == "undeclared" else 0.05
    widths = np.radians(np.exp([draw(math.log(least), math.log(20.0)) for _ in range(3)]))
    pulses = [Pulse(width, draw(-1.0, 1.0) * 30.0 / width, draw(0.3, TURN - 0.3)) for width in widths]
    friction = {
        "O": ks.PinFriction(draw(0.02, 0.1), 0.03),
        "A": ks.PinFriction(draw(0.02, 0.1), 0.02),
        "guide": ks.GuideFriction(draw(0.02, 0.1), draw(0.05, 0.1)),
    }
    loads = [ks.Gravity(), *(pulse.load(kind) for pulse in pulses)]
    return ks.Scene(mechanism, 1.0, loads=loads, friction=friction if seed % 2 else {}), pulses


def excess(motion, pulses, kind):
    """Kinetic energy less that of the work by hand, at all times of a motion, relative to the largest."""
    weight = replace(motion.scene, loads=ks.Gravity(), friction={})
    height = weight.solve(motion.crank_angle).potential_energy
    first, *angles = motion.crank_angle
    work = [sum(pulse.work(kind, first, angle) for pulse in pulses) for angle in (first, *angles)]
    energy = motion.kinetic_energy
    left = energy - energy[0] + height - height[0] - work + motion.friction_energy
    return np.abs(left).max() / energy.max()


@pytest.mark.parametrize("kind", ["table", "declared", "undeclared"])
@pytest.mark.parametrize(
    "seed", [seed if seed in QUICK else pytest.param(seed, marks=pytest.mark.slow) for seed in range(16)]
)
def test_coasting_keeps_account_of_pulses(kind, seed):
    scene, pulses = drawn(seed, kind)
    speed = (30.0, 4.0)[seed // 2 % 2] * (-1.0) ** (seed // 4)
    motion = ks.drive.coast(scene, 0.5, 0.4 * seed, speed, until=1.0)
    turned = [event for event in motion.events if event.name == "reversal"]
    assert bool(turned) == (seed in TURNED)
    assert excess(motion, pulses, kind) < 1e-11
    assert motion.energy_drift < 1e-11 * motion.kinetic_energy.max()


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_disc_swings_between_two_pulses_as_by_hand(sense):
    """3 J between walls of 60 N m, 40 rad/s2: it turns 0.05 rad deep in each, 0.05 s after it entered."""
    wall = Pulse(0.5, -60.0, 1.75, ramp=1e-12)
    back = Pulse(0.5, 60.0, 0.55, ramp=1e-12)
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(inertia=1.5)), ())
    scene = ks.Scene(disc, 1.0, loads=[wall.load("declared"), back.load("declared")])
    motion = ks.drive.coast(scene, 0.0, 1.0, sense * 2.0, until=2.0)
    turned = [event for event in motion.events if event.name == "reversal"]
    inner = 0.7  # rad between the walls, passed at 2 rad/s
    first = (0.5 if sense > 0.0 else 0.2) / 2.0 + 0.05
    assert [event.time for event in turned] == pytest.approx(
        first + (inner / 2.0 + 0.1) * np.arange(len(turned)), rel=1e-12
    )
    assert [event.crank_angle for event in turned[:2]] == pytest.approx([1.55, 0.75][:: int(sense)], rel=1e-12)
    assert len(turned) == 5 - (sense > 0.0)


@pytest.mark.slow
def test_time_is_the_integral_of_slowness():
    """Energy by hand, time by adaptive quadrature between the kinks."""
    scene, pulses = drawn(0, "table")
    motion = ks.drive.coast(scene, 0.5, 0.3, 30.0, until=0.5)
    weight = replace(scene, loads=ks.Gravity())

    def inertia_and_height(angle):
        found = weight.solve(np.array([angle]))
        return 0.5 + float(found.reduced_inertia[0]), float(found.potential_energy[0])

    inertia, height = inertia_and_height(0.3)
    whole = 0.5 * inertia * 900.0 + height

    def slowness(angle):
        inertia, height = inertia_and_height(angle)
        energy = whole - height + sum(pulse.work("table", 0.3, angle) for pulse in pulses)
        return math.sqrt(0.5 * inertia / energy)

    last = motion.crank_angle[-1]
    turns = np.arange(math.ceil(last / TURN))
    edges = np.unique(np.concatenate([pulse.angles[1:-1] for pulse in pulses]) + TURN * turns[:, None])
    edges = np.concatenate([[0.3], edges[(edges > 0.3) & (edges < last)], [last]])
    spent = sum(quad(slowness, *ends, epsabs=1e-13, epsrel=1e-12)[0] for ends in pairwise(edges))
    assert spent == pytest.approx(0.5, rel=1e-11)


def test_energy_drift_shows_a_lost_pulse():
    """The motion of a machine without the pulse, told to be one with it."""
    bare = ks.Scene(MASSLESS, 1.0, loads=ks.Torque(-1.0, on="crank"))
    motion = ks.drive.coast(bare, 3.0, 0.0, 60.0, until=0.2)
    pulse = Pulse(math.radians(0.05), -1000.0)
    lost = replace(motion, scene=replace(bare, loads=[*bare.loads, pulse.load("table")]))
    taken = -pulse.work("table", 0.0, motion.crank_angle[-1])
    assert motion.energy_drift < 1e-9
    assert lost.energy_drift == pytest.approx(taken, rel=1e-9)
    assert taken > 0.8


@pytest.mark.slow
def test_run_up_passes_the_rows_of_a_motor_table():
    speeds = np.linspace(0.0, 130.0, 14)
    motor = ks.drive.Motor.table(speeds, 130.0 + 4.0 * np.sin(speeds) - speeds)
    scene = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(2.0)), 1.0, loads=ks.Torque(-20.0, on="crank"))
    motion = ks.drive.start(scene, motor, 0.5)
    assert motion.energy_drift < 1e-12 * motion.kinetic_energy.max()
