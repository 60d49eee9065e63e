"""Motions near rest: small oscillations, equilibria, stops in steep ramps and at jumps, swings that die out."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import kinetostatics as ks

INERTIA, RADIUS, ROD = 0.1, 0.1, 0.4
FLYWHEEL = ks.crank_slider(RADIUS, ROD)
"""Massless links."""


def rate(angle):
    """Slider travel by crank angle, m."""
    rest = math.sqrt(ROD**2 - (RADIUS * math.sin(angle)) ** 2)
    return -RADIUS * math.sin(angle) * (1.0 + RADIUS * math.cos(angle) / rest)


class Step:
    """Force on the slider, one from 1 to 2 rad and another elsewhere; the first jump may move with the crank speed."""

    def __init__(self, inside, outside, moves=0.0):
        self.inside, self.outside, self.moves = inside, outside, moves

    def __call__(self, motion):
        """Force, N."""
        angle = np.mod(motion.crank_angle, 2.0 * np.pi)
        return np.where(
            (angle >= 1.0 + self.moves * abs(motion.crank_speed)) & (angle < 2.0), self.inside, self.outside
        )

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return [], [1.0 + self.moves * float(np.max(np.abs(motion.crank_speed))), 2.0]


@pytest.mark.parametrize("swing", [1e-2, 1e-4, 1e-6, 1e-9])
def test_small_oscillations_are_harmonic(swing):
    """By hand: at an angle s from the lowest place the potential of the weight is m g r (1 + r / l) s^2 / 2."""
    hanging = ks.crank_slider(RADIUS, ROD, guide_angle=-math.pi / 2, slider=ks.Link(4.0))
    motion = ks.drive.coast(ks.Scene(hanging, 1.0, loads=ks.Gravity()), INERTIA, -math.pi / 2 + swing, until=1.0)
    frequency = math.sqrt(4.0 * 9.81 * RADIUS * (1.0 + RADIUS / ROD) / INERTIA)
    found = (motion.crank_angle[-1] + math.pi / 2) / swing
    assert found == pytest.approx(math.cos(frequency), abs=max(2.0 * swing**2, 1e-6))


@pytest.mark.parametrize("angle", [0.0, math.pi, 2.0 * math.pi, -math.pi, 3.0 * math.pi])
def test_an_equilibrium_to_rounding_is_one(angle):
    motion = ks.drive.coast(ks.Scene(FLYWHEEL, 1.0, loads=ks.ProcessForce(-100.0)), INERTIA, angle, until=1.0)
    assert motion.events[-1].name == "standstill"
    assert motion.crank_angle[-1] == angle


@pytest.mark.parametrize("width", [1e-3, 1e-5, 1e-6])
def test_a_machine_turns_back_within_a_steep_ramp(width):
    start, share = 2.0, 0.6
    force = -200.0 * np.sign(rate(start))
    work = width * quad(lambda place: abs(force) * place * abs(rate(start + width * place)), 0.0, share)[0]
    speed = math.sqrt(2.0 * work / INERTIA)
    table = ks.Table([0.0, start, start + width, 3.0, 3.0 + width, 2.0 * math.pi], [0.0, 0.0, force, force, 0.0, 0.0])
    scene = ks.Scene(FLYWHEEL, 1.0, loads=ks.ProcessForce(table))
    motion = ks.drive.coast(scene, INERTIA, start - 0.01, speed, until=0.04 / speed)
    (turned,) = (event.crank_angle for event in motion.events if event.name == "reversal")
    assert turned == pytest.approx(start + share * width, abs=1e-8 * width)
    assert motion.speed[-1] == pytest.approx(-speed, rel=1e-8)


@pytest.mark.parametrize(
    ("inside", "outside", "angle", "moves"),
    [
        (-100.0, 0.0, 1.0, 1),
        (0.0, -100.0, 1.0, 0),
        (0.0, 100.0, 1.0, -1),
        (100.0, 0.0, 2.0, -1),
        (100.0, -100.0, 1.0, 0),
    ],
)
def test_a_machine_at_a_jump_goes_by_the_force_ahead(inside, outside, angle, moves):
    motion = ks.drive.coast(
        ks.Scene(FLYWHEEL, 1.0, loads=ks.ProcessForce(Step(inside, outside))), INERTIA, angle, until=0.1
    )
    assert np.sign(motion.crank_angle[-1] - angle) == moves


@pytest.mark.slow
def test_swings_that_die_out_end_in_standstill():
    friction = {"O": ks.PinFriction(0.9, 0.05), "guide": ks.GuideFriction(0.4)}
    scene = ks.Scene(FLYWHEEL, 1.0, loads=ks.ProcessForce(Step(100.0, -100.0)), friction=friction)
    motion = ks.drive.coast(scene, INERTIA, 1.2, 0.5, until=5.0)
    assert motion.events[-1].name == "standstill"
    assert motion.crank_angle[-1] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("run", ["coast", "start", "steady"])
def test_kinks_that_move_with_the_speed_are_refused(run):
    scene = ks.Scene(FLYWHEEL, 20.0, loads=ks.ProcessForce(Step(-10.0, 0.0, moves=0.01)))
    motor = ks.drive.Motor.linear(30.0, 50.0)
    runs = {
        "coast": lambda: ks.drive.coast(scene, INERTIA, 0.0, 20.0, until=1.0),
        "start": lambda: ks.drive.start(scene, motor, INERTIA),
        "steady": lambda: ks.drive.steady(scene, motor, INERTIA),
    }
    with pytest.raises(ks.DriveError, match="move with the crank speed"):
        runs[run]()


@pytest.mark.parametrize("run", ["coast", "steady", "flywheel"])
def test_functions_that_repeat_later_are_refused(run):
    scene = ks.Scene(FLYWHEEL, 20.0, loads=ks.ProcessForce(lambda motion: -30.0 * np.sin(0.5 * motion.crank_angle)))
    runs = {
        "coast": lambda: ks.drive.coast(scene, INERTIA, 0.3, 20.0, until=1.0),
        "steady": lambda: ks.drive.steady(scene, ks.drive.Motor.linear(30.0, 50.0), INERTIA),
        "flywheel": lambda: ks.drive.flywheel(scene, 0.02),
    }
    with pytest.raises(ks.ParameterError, match=r"repeats only after 2 turns: give period=4\*pi"):
        runs[run]()


@pytest.mark.parametrize("step", [0.14117633580345515, 0.05, 0.01, 0.2])
def test_flywheels_see_pulses_across_angle_0_at_any_resolution(step):
    at, width = np.radians([359.92943568256004, 0.2116929523198858])

    def pulse(motion):
        return np.where(np.mod(motion.crank_angle - at, 2.0 * np.pi) < width, -1e6, 0.0)

    def declared(motion):
        return pulse(motion)

    declared.kinks = lambda motion: ([], np.mod([at, at + width], 2.0 * np.pi))
    machine = ks.crank_slider(0.3, 1.1, slider=ks.Link(10.0), guide_offset=0.05)
    known = ks.drive.flywheel(ks.Scene(machine, 30.0, loads=ks.ProcessForce(declared)), 0.02)
    scene = ks.Scene(machine, 30.0, loads=ks.ProcessForce(pulse), resolution=np.radians(step))
    assert ks.drive.flywheel(scene, 0.02).energy == pytest.approx(known.energy, rel=1e-11)
