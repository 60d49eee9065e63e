"""How fast periodic running is found: ours against stepping through time until the turn repeats, and against shooting.

All rivals reach the same accuracy, 1e-11 of the speed, and evaluate the same compiled program.
"""

import json
import math
import timeit

import numpy as np
from scipy.integrate import solve_ivp

import kinetostatics as ks
from kinetostatics.drive.one_dof import DrivenMachine
from kinetostatics.studies.methods.running import study_running
from support import DATA
from support.drives import RUBBING
from support.speed import PLAIN, SPEED

REFERENCE = json.loads((DATA / "driven_sawframe.json").read_text(encoding="utf-8"))
MOTOR = ks.drive.Motor.kloss(
    REFERENCE["motor"]["power"],
    REFERENCE["motor"]["speed"],
    synchronous_speed=REFERENCE["motor"]["synchronous_speed"],
    overload=REFERENCE["motor"]["overload"],
    transmission=REFERENCE["motor"]["transmission"],
)
SCENE = ks.Scene(PLAIN, SPEED, loads=ks.Gravity())
TURN = 2 * np.pi
EXACT = float(REFERENCE["speed"][0])
MOST = {"ours [ms]": 5.0}
LEAST = {"stepping": 100.0, "shooting": 10.0}


def ours():
    return ks.drive.steady(SCENE, MOTOR, 1000.0, angles=[0.0], engine="compiled").speed[0]


class Rivals:
    """DOP853 on energy by crank angle, from the synchronous speed."""

    def __init__(self):
        self.driven = DrivenMachine("benchmark", SCENE, MOTOR, 1000.0, "compiled")
        self.here = self.driven.balance(0.0, SPEED)[0]

    def turn(self, speed):
        """Speed after one turn."""
        program = self.driven.program

        def change(angle, energy):
            found = program(angle)
            speed = math.sqrt(2.0 * energy[0] / (1000.0 + float(found["reduced_inertia"])))
            return MOTOR.torque_at_crank(speed) - float(found["load_torque"])

        start = [0.5 * self.here * speed * speed]
        found = solve_ivp(change, (0.0, TURN), start, "DOP853", rtol=1e-13, atol=1e-6)
        return np.sqrt(2.0 * found.y[0, -1] / self.here)

    def stepping(self):
        """Turn by turn until it repeats."""
        speed = MOTOR.synchronous_speed / MOTOR.transmission
        for _ in range(1000):
            before, speed = speed, self.turn(speed)
            if abs(speed - before) < 1e-12 * speed:
                break
        return speed

    def shooting(self):
        """Secant rule on the speed after a turn."""
        one = MOTOR.synchronous_speed / MOTOR.transmission
        two = one * 1.001
        first, second = self.turn(one) - one, self.turn(two) - two
        while abs(two - one) > 1e-12 * two:
            one, two = two, two - second * (two - one) / (second - first)
            first, second = second, self.turn(two) - two
        return two


def test_periodic_running_beside_stepping_and_shooting(benchmark, tell):
    rivals = Rivals()
    found = {
        name: call() for name, call in (("ours", ours), ("shooting", rivals.shooting), ("stepping", rivals.stepping))
    }
    times = {
        "ours": min(timeit.repeat(ours, number=10, repeat=10)) / 10,
        "shooting": min(timeit.repeat(rivals.shooting, number=1, repeat=3)),
        "stepping": min(timeit.repeat(rivals.stepping, number=1, repeat=1)),
    }
    for name, speed in found.items():
        error = abs(speed / EXACT - 1.0)
        tell(f"{name}: {1e3 * times[name]:.3g} ms, error {error:.1e}, {times[name] / times['ours']:.0f} times ours")
        benchmark.extra_info[name] = times[name]
        assert error < 1e-11, name
    benchmark(ours)
    assert 1e3 * times["ours"] < MOST["ours [ms]"]
    for name, ratio in LEAST.items():
        assert times[name] > ratio * times["ours"], name


def test_all_running_methods_at_every_accuracy(benchmark, tell):
    """How long the fastest of each method takes to come within 1e-6 and 1e-11, in times of ours (compiled)."""
    table = study_running(SCENE, MOTOR, 1000.0, repeats=1)
    mine = table.set_index("method").loc["ours, compiled"]
    assert mine["error"] < 1e-13
    for wanted in (1e-6, 1e-11):
        fine = table[(table["error"] <= wanted) & ~table["ours"]]
        for method, part in fine.groupby("method", sort=False):
            ratio = part["time [ms]"].min() / mine["time [ms]"]
            tell(f"within {wanted:g}: {method} takes {ratio:.2f} times as long as ours, {mine['time [ms]']:.3g} ms")
            benchmark.extra_info[f"{method}, {wanted:g}"] = ratio
    benchmark(ours)


LEAST_WITH_FRICTION = 5.0


def test_motion_with_friction_beside_solve_ivp(benchmark, tell):
    """Coasting for 0.3 s; the rival solves for the same accelerations, one after another."""
    driven = DrivenMachine("benchmark", RUBBING, None, 20.0)

    def change(time, state):
        angle, speed = np.array(state)[:, None]
        return state[1], driven.acceleration(angle, speed)[0]

    def coasting():
        return ks.drive.coast(RUBBING, 20.0, 1.0, 8.0, until=0.3).crank_angle[-1]

    def rival():
        return solve_ivp(change, (0.0, 0.3), (1.0, 8.0), "DOP853", rtol=1e-9, atol=1e-9).y[0, -1]

    assert abs(rival() - coasting()) < 1e-6
    times = [min(timeit.repeat(call, number=1, repeat=3)) for call in (coasting, rival)]
    tell(f"coasting with friction: {1e3 * times[0]:.3g} ms, DOP853 {times[1] / times[0]:.1f} times as long")
    benchmark(coasting)
    assert times[1] > LEAST_WITH_FRICTION * times[0]
