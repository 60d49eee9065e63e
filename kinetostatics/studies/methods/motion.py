"""Ways to a motion over time, on benchmarks of multibody dynamics with published results.

Of the slider-crank of SUNDIALS (Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*, example 6.1.8)
and the N-four-bar of IFToMM's library of benchmark problems (A02; through its singular positions), the crank angle
after 10 s is asked for.

ours               `drive.coast`: the machine as one degree of freedom, DOP853 at the tightest tolerance
reduced inertia    the same equation by other integrators of SciPy, and by fixed steps of Runge and Kutta
constraint         all links by their coordinates: the constraint equations differentiated twice (index 1), drift held
                   by Baumgarte's terms, DOP853
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...drive.one_dof import Driven
from ...drive.transient import coast
from ...engines.numba_backend import numba_available
from ...errors import NotGivenError
from ...machine.builders import crank_slider
from ...machine.crank import Crank
from ...machine.groups.rocker import RockerGroup
from ...machine.links import Link
from ...machine.loads import Force, Gravity, PointDamper, PointSpring
from ...machine.mechanism import Mechanism
from ...solution.scene import Scene
from .global_system.configurations import Configuration
from .global_system.constraints import Model
from .method import Method

DAMPING = 10.0
"""Baumgarte's a = alpha = beta, 1/s."""


@dataclass(frozen=True)
class Problem:
    """A scene that coasts from a crank angle and speed, rad, rad/s, for a time, s, and where it comes to, rad."""

    scene: Any
    from_angle: float
    from_speed: float
    until: float
    exact: float


def slider_crank():
    """Crank 0.5, rod 1, J1 = 1, m2 = 1 at the slider, J2 = 2; spring and damper between the middles of the bars."""
    bars = {"crank": Link(0.0, 0.0, 1.0), "coupler": Link(0.0, 0.0, 2.0), "slider": Link(1.0)}
    middles = (("crank", 0.25), ("coupler", 0.5))
    loads = (
        PointSpring(1.0, 1.0, between=middles),
        PointDamper(1.0, between=middles),
        Force(1.0, at=("coupler", 2.0)),
    )
    return Problem(Scene(crank_slider(0.5, 1.0, **bars), 1.0, loads=loads), math.pi / 2, 0.0, 10.0, 1.27567584865023941)


def n_four_bar(windows=2):
    """Bars of 1 kg and 1 m: uprights on pivots 1 m apart, level ones between their ends; from the top with 1 m/s."""
    bar = Link(1.0, 0.5, 1 / 12)
    groups = tuple(
        RockerGroup(
            float(k),
            1.0,
            (float(k), 0.0),
            "open",  # type: ignore[arg-type]
            Link(1.0, k - 0.5),
            bar,
            pin=f"B{k}",
            pivot_name=f"P{k}",
            label=f"_{k}",
        )
        for k in range(1, windows + 1)
    )
    scene = Scene(Mechanism("N-four-bar", Crank(1.0, bar), groups), 1.0, loads=Gravity())
    end = math.atan2(0.94451853817860096216, 0.32845811154081537865) - 10 * math.pi
    return Problem(scene, math.pi / 2, -1.0, 10.0, end)


BENCHMARKS = {"slider-crank of SUNDIALS": slider_crank, "N-four-bar of IFToMM, N = 2": n_four_bar}


def _ours(engine):
    def prepare(problem, quantity, setting):
        if engine == "compiled" and not numba_available():
            raise NotGivenError("numba is not installed")

        def run():
            motion = coast(problem.scene, 0.0, problem.from_angle, problem.from_speed, problem.until, engine=engine)
            return motion.crank_angle[-1]

        return run

    return prepare


def _acceleration(problem):
    """Crank acceleration at a crank angle and speed, by the library's compiled program where numba is there."""
    driven = Driven("study", problem.scene, None, 0.0, "compiled" if numba_available() else "numpy")

    def acceleration(angle, speed):
        inertia, slope, spare = driven.here(angle, speed)
        return (spare - 0.5 * speed * speed * slope) / inertia

    return acceleration


def _reduced(method):
    def prepare(problem, quantity, tolerance):
        from scipy.integrate import solve_ivp

        acceleration = _acceleration(problem)
        start = problem.from_angle, problem.from_speed

        def run():
            found = solve_ivp(
                lambda time, state: (state[1], acceleration(*state.tolist())),
                (0.0, problem.until),
                start,
                method,
                [problem.until],
                rtol=max(tolerance, 3e-14),
                atol=tolerance,
            )
            if found.status < 0:
                raise NotGivenError(f"integration stops: {found.message}")
            return found.y[0, -1]

        return run

    return prepare


def _fixed(problem, quantity, steps):
    """Runge and Kutta's method of order 4."""
    acceleration, width = _acceleration(problem), problem.until / steps

    def run():
        angle, speed = problem.from_angle, problem.from_speed
        for _ in range(steps):
            a1 = acceleration(angle, speed)
            v2 = speed + 0.5 * width * a1
            a2 = acceleration(angle + 0.5 * width * speed, v2)
            v3 = speed + 0.5 * width * a2
            a3 = acceleration(angle + 0.5 * width * v2, v3)
            v4 = speed + width * a3
            a4 = acceleration(angle + width * v3, v4)
            angle += width * (speed + 2.0 * v2 + 2.0 * v3 + v4) / 6.0
            speed += width * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0
        return angle

    return run


def _constraints(problem, quantity, tolerance):
    from scipy.integrate import solve_ivp

    scene = problem.scene
    if scene.mechanism.passes:
        raise NotGivenError(f"{scene.mechanism.name} passes change points, where constraint equations are singular")
    model, loaded = Model(scene.mechanism), scene.unsolved(np.zeros(1))
    crank = 2 * model.size + model.names.index("crank")
    _, torque = model.readings["balancing_torque"]
    q = model.start(problem.from_angle)
    rates = Configuration(model, q, problem.from_angle).rates(problem.from_speed)

    def change(time, state):
        q, rates = np.split(state, 2)
        at = Configuration(model, q, q[crank])
        right = at.gamma(rates) - 2.0 * DAMPING * (at.jacobian @ rates - model.drive * rates[crank])
        still = at.solve(right - DAMPING * DAMPING * at.residual)
        faster = still + at.solve(model.drive)
        asked = [
            (torque @ at.solve(at.demand(rates, accelerations, loaded), transposed=True)).item()
            for accelerations in (still, faster)
        ]
        alpha = -asked[0] / (asked[1] - asked[0])
        return np.concatenate([rates, still + alpha * (faster - still)])

    def run():
        found = solve_ivp(
            change,
            (0.0, problem.until),
            np.concatenate([q, rates]),
            "DOP853",
            [problem.until],
            rtol=tolerance,
            atol=tolerance,
        )
        if found.status < 0:
            raise NotGivenError(f"integration stops: {found.message}")
        return found.y[crank, -1]

    return run


TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
METHODS = (
    Method("ours, NumPy", _ours("numpy"), ours=True),
    Method("ours, compiled", _ours("compiled"), ours=True),
    Method("reduced inertia, DOP853", _reduced("DOP853"), "tolerance", TOLERANCES),
    Method("reduced inertia, RK45", _reduced("RK45"), "tolerance", TOLERANCES[:-1]),
    Method("reduced inertia, LSODA", _reduced("LSODA"), "tolerance", TOLERANCES),
    Method("reduced inertia, Radau", _reduced("Radau"), "tolerance", TOLERANCES[:-2]),
    Method("reduced inertia, fixed steps, RK4", _fixed, "steps", (100, 300, 1000, 3000, 10_000)),
    Method("constraint equations, DOP853", _constraints, "tolerance", TOLERANCES[:-1]),
)
