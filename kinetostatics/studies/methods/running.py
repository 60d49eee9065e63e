"""Methods for periodic running under a motor and for motions over time, with a study of time and error for each.

Periodic running: the energy U(phi) solves dU/dphi = motor torque - load torque with U(0) = U(period). All methods use
the library's inertia and load torque, so only the solution of this equation is compared.

stepping      integrate turn after turn until the speed repeats
shooting      secant rule on the change of energy over one turn
fixed steps   shooting with Runge-Kutta methods of order 4 or 8 (Hairer, Nørsett and Wanner, *Solving Ordinary
              Differential Equations I*, II.5)
collocation   SciPy's `solve_bvp` with periodic ends; trigonometric polynomials (Fourier) with Newton's iteration

Motions over time: the crank angle after 10 s of two published benchmarks. They are the slider-crank of SUNDIALS (Haug,
*Computer Aided Kinematics and Dynamics of Mechanical Systems*, example 6.1.8) and the N-four-bar of IFToMM (A02). They
are solved by `drive.coast`, by other integrators of the same equation, and by constraint equations with Baumgarte's
terms.
"""

import math
import time
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...drive.one_dof import DrivenMachine
from ...drive.steady_running import steady
from ...drive.transient import coast
from ...engines.numba_backend import numba_available
from ...errors import NotGivenError
from ...machine.builders import crank_slider
from ...machine.crank import Crank
from ...machine.groups.rocker import RockerGroup
from ...machine.links import Link
from ...machine.loads import Force, Gravity, PointDamper, PointSpring
from ...machine.mechanism import Mechanism
from ...numbers import checks
from ...solution.scene import Scene
from .global_system.constraints import Configuration, Model, integrate
from .high_precision.certified import exact_speed
from .method import Method, run_methods, seconds

DAMPING = 10.0
"""Baumgarte's a = alpha = beta, 1/s."""


@dataclass(frozen=True)
class CoastDown:
    """A scene that coasts from a crank angle, rad, and speed, rad/s, for a time, s, to an exact angle, rad."""

    scene: Any
    from_angle: float
    from_speed: float
    until: float
    exact: float

    def by_library(self, engine):
        return coast(self.scene, 0.0, self.from_angle, self.from_speed, self.until, engine=engine).crank_angle[-1]


def slider_crank():
    """Crank 0.5, rod 1, J1 = 1, m2 = 1 at the slider, J2 = 2; spring and damper between the middles of the bars."""
    bars = {"crank": Link(0.0, 0.0, 1.0), "coupler": Link(0.0, 0.0, 2.0), "slider": Link(1.0)}
    middles = (("crank", 0.25), ("coupler", 0.5))
    spring, damper = PointSpring(1.0, 1.0, between=middles), PointDamper(1.0, between=middles)
    scene = Scene(crank_slider(0.5, 1.0, **bars), 1.0, loads=(spring, damper, Force(1.0, at=("coupler", 2.0))))
    return CoastDown(scene, math.pi / 2, 0.0, 10.0, 1.27567584865023941)


def two_four_bars():
    """Bars of 1 kg and 1 m: uprights on pivots 1 m apart, level bars between their ends; start upright with 1 m/s."""
    bar = Link(1.0, 0.5, 1 / 12)
    groups = []
    for k in (1, 2):
        names = {"on": f"B{k - 1}" if k > 1 else "A", "pin": f"B{k}", "pivot_name": f"P{k}", "label": f"_{k}"}
        groups.append(RockerGroup(1.0, 1.0, (float(k), 0.0), "open", bar, bar, **names))  # type: ignore[arg-type]
    scene = Scene(Mechanism("N-four-bar", Crank(1.0, bar), tuple(groups)), 1.0, loads=Gravity())
    end = math.atan2(0.94451853817860096216, 0.32845811154081537865) - 10 * math.pi
    return CoastDown(scene, math.pi / 2, -1.0, 10.0, end)


BENCHMARKS = {"slider-crank of SUNDIALS": slider_crank, "N-four-bar of IFToMM, N = 2": two_four_bars}


def _ours(engine, problem, quantity, setting):
    if engine == "compiled" and not numba_available():
        raise NotGivenError("numba is not installed")
    return lambda: problem.by_library(engine)


OUR_METHODS = (
    Method("ours, NumPy", partial(_ours, "numpy"), ours=True),
    Method("ours, compiled", partial(_ours, "compiled"), ours=True),
)


MIN_TOLERANCE = 3e-14
"""Smallest relative tolerance for SciPy."""


def _acceleration(problem):
    """Function of crank angle and speed that returns the crank acceleration, rad/s^2."""
    driven = DrivenMachine("study", problem.scene, None, 0.0, "compiled" if numba_available() else "numpy")

    def acceleration(angle, speed):
        inertia, slope, spare = driven.balance(angle, speed)
        return (spare - 0.5 * speed * speed * slope) / inertia

    return acceleration


def _reduced_inertia(method, problem, quantity, tolerance):
    acceleration, end = _acceleration(problem), problem.until
    start = problem.from_angle, problem.from_speed

    def slopes(time, state):
        return state[1], acceleration(*state.tolist())

    return lambda: integrate(slopes, (0.0, end), start, method, [end], max(tolerance, MIN_TOLERANCE), tolerance)[0, -1]


def _runge_kutta(problem, quantity, steps):
    """Runge and Kutta's method of order 4."""
    acceleration, width = _acceleration(problem), problem.until / steps

    def slope(state):
        """Derivative by time of the crank angle and i times the crank speed."""
        return complex(state.imag, acceleration(state.real, state.imag))

    def run():
        state = complex(problem.from_angle, problem.from_speed)
        for _ in range(steps):
            first = slope(state)
            second = slope(state + 0.5 * width * first)
            third = slope(state + 0.5 * width * second)
            fourth = slope(state + width * third)
            state += width * (first + 2.0 * second + 2.0 * third + fourth) / 6.0
        return state.real

    return run


def _constraints(problem, quantity, tolerance):
    scene = problem.scene
    if scene.mechanism.passes:
        raise NotGivenError(f"{scene.mechanism.name} passes change points, where constraint equations are singular")
    model, loaded = Model(scene.mechanism), scene.unsolved(np.zeros(1))
    crank = 2 * model.size + model.names.index("crank")
    _, torque = model.readings["balancing_torque"]
    q, end = model.start(problem.from_angle), problem.until
    start = np.concatenate([q, Configuration(model, q, problem.from_angle).rates(problem.from_speed)])

    def change(time, state):
        q, rates = np.split(state, 2)
        at = Configuration(model, q, q[crank])
        still = at.solve(at.damped_gamma(rates, rates[crank], DAMPING))
        faster = still + at.solve(model.drive)
        asked = [
            (torque @ at.solve(at.demand(rates, accelerations, loaded), transposed=True)).item()
            for accelerations in (still, faster)
        ]
        alpha = -asked[0] / (asked[1] - asked[0])
        return np.concatenate([rates, still + alpha * (faster - still)])

    return lambda: integrate(change, (0.0, end), start, "DOP853", [end], tolerance, tolerance)[crank, -1]


TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
MOTION_METHODS = (
    *OUR_METHODS,
    Method("reduced inertia, DOP853", partial(_reduced_inertia, "DOP853"), "tolerance", TOLERANCES),
    Method("reduced inertia, RK45", partial(_reduced_inertia, "RK45"), "tolerance", TOLERANCES[:-1]),
    Method("reduced inertia, LSODA", partial(_reduced_inertia, "LSODA"), "tolerance", TOLERANCES),
    Method("reduced inertia, Radau", partial(_reduced_inertia, "Radau"), "tolerance", TOLERANCES[:-2]),
    Method("reduced inertia, fixed steps, RK4", _runge_kutta, "steps", (100, 300, 1000, 3000, 10_000)),
    Method("constraint equations, DOP853", _constraints, "tolerance", TOLERANCES[:-1]),
)


MAX_TURNS = 2000
"""Largest number of periods of stepping."""
MAX_SECANT_STEPS = 30


class PeriodicRunning:
    """A machine under its motor, and rising crank angles within its period at which to compute the speed."""

    def __init__(self, scene, motor, flywheel, angles):
        self.machine, self.angles = (scene, motor, flywheel), np.asarray(angles, dtype=float)
        self.driven = DrivenMachine("study", *self.machine, "compiled" if numba_available() else "numpy")
        if self.driven.by_speed:
            raise NotGivenError("other methods need loads that do not depend on the speed")
        self.motor, self.period = motor, self.driven.period
        if self.driven.direction < 0.0:
            raise NotGivenError("other methods need motors that turn the crank counter-clockwise")

    @property
    def guess(self):
        """Starting value of the energy, J: the value at crank angle 0 and the motor's no-load speed."""
        speed = (self.motor.field_speed or 0.5 * self.motor.top) / abs(self.motor.transmission)
        return 0.5 * float(self.inertia(np.zeros(1))[0]) * speed * speed

    def inertia(self, angle):
        return self.driven.flywheel + self.driven.program(angle)["reduced_inertia"]

    def slope(self, angle, energy):
        """dU/dphi, N m, at one crank angle."""
        found = self.driven.program(angle)
        inertia = self.driven.flywheel + float(found["reduced_inertia"])
        return self.motor.torque_at_crank(math.sqrt(2.0 * energy[0] / inertia)) - float(found["load_torque"])

    def slopes(self, angle, energy):
        """dU/dphi at crank angles, and its derivative by U."""
        found = self.driven.program(angle)
        inertia = self.driven.flywheel + found["reduced_inertia"]
        speed = np.sqrt(2.0 * energy / inertia)
        by_energy = self.motor.slope_at_crank(speed) / (inertia * speed)
        return self.motor.torque_at_crank(speed) - found["load_torque"], by_energy

    def by_library(self, engine):
        return steady(*self.machine, angles=self.angles, engine=engine).speed

    def speeds(self, energies):
        """Crank speeds, rad/s, from the energies at `angles`."""
        return np.sqrt(2.0 * energies / self.inertia(self.angles))


def _energy_by_stepping(after, guess, tolerance):
    """As `periodic_energy`, turn after turn until the energy repeats."""
    energy = guess
    for _ in range(MAX_TURNS):
        before, energy = energy, after(energy)
        if abs(energy - before) < tolerance * energy:
            break
    return energy


def periodic_energy(after, guess, tolerance):
    """Fixed point of the map from the energy at the start of a period to the energy at its end, by the secant rule."""
    one, two = guess, 0.999 * guess
    first, second = after(one) - one, after(two) - two
    for _ in range(MAX_SECANT_STEPS):
        if abs(two - one) <= tolerance * two or second == first:
            break
        one, two = two, two - second * (two - one) / (second - first)
        first, second = second, after(two) - two
    return two


def _integrated_turns(find_energy, method, problem, quantity, tolerance):
    """Stepping or shooting, by `find_energy`, with an integrator of SciPy."""
    scale = problem.guess

    def energies(energy, asked):
        limits = max(tolerance, MIN_TOLERANCE), tolerance * scale
        return integrate(problem.slope, (0.0, problem.period), [energy], method, asked, *limits)[0]

    def run():
        energy = find_energy(lambda energy: float(energies(energy, None)[-1]), scale, tolerance)
        return problem.speeds(energies(energy, problem.angles))

    return run


def _fixed_steps(stages, problem, quantity, steps):
    from scipy.integrate import DOP853

    places, weights = [0.0, 0.5, 0.5, 1.0], [1 / 6, 1 / 3, 1 / 3, 1 / 6]
    before: list[list[float]] = [[], [0.5], [0.0, 0.5], [0.0, 0.0, 1.0]]
    if stages > 4:
        places, weights = DOP853.C[:stages].tolist(), DOP853.B.tolist()
        before = [DOP853.A[row, :row].tolist() for row in range(stages)]
    width, count = problem.period / steps, problem.angles.size
    if steps % count or not np.allclose(problem.angles, problem.period * np.arange(count) / count):
        raise NotGivenError("fixed steps need crank angles spread evenly from 0 that divide the steps")

    def run():
        angle = width * (np.arange(steps)[:, None] + np.array(places))
        found = problem.driven.program(angle.ravel())
        inertia = (problem.driven.flywheel + found["reduced_inertia"]).reshape(angle.shape).tolist()
        load = found["load_torque"].reshape(angle.shape).tolist()
        drive, root = problem.motor.torque_at_crank, math.sqrt

        def followed(energy):
            """Energies at the ends of all steps, the start included."""
            path = [energy]
            for inertias, loads in zip(inertia, load, strict=True):
                slopes: list[float] = []
                for own, asked, parts in zip(inertias, loads, before, strict=True):
                    value = energy + width * sum(map(float.__mul__, parts, slopes))
                    slopes.append(drive(root(2.0 * value / own)) - asked)
                energy += width * sum(map(float.__mul__, weights, slopes))
                path.append(energy)
            return path

        path = followed(periodic_energy(lambda energy: followed(energy)[-1], problem.guess, 1e-15))
        return problem.speeds(np.array(path[:-1])[:: steps // count])

    return run


def _scipy_bvp(problem, quantity, tolerance):
    from scipy.integrate import solve_bvp

    scale = problem.guess  # energies of about 1, because the solver measures errors so

    def slopes(angle, energy):
        return problem.slopes(angle, scale * energy[0])[0][None] / scale

    def jacobian(angle, energy):
        return problem.slopes(angle, scale * energy[0])[1][None, None]

    def run():
        ends, mesh = np.subtract, np.linspace(0.0, problem.period, 25)
        options = {"fun_jac": jacobian, "tol": tolerance, "bc_tol": 1e-12, "max_nodes": 20_000}
        found = solve_bvp(slopes, ends, mesh, np.ones((1, mesh.size)), **options)
        if not found.success:
            raise NotGivenError(f"solve_bvp: {found.message}")
        return problem.speeds(scale * found.sol(problem.angles)[0])

    return run


def _fourier(problem, quantity, points):
    """Newton's iteration on trigonometric collocation at an odd number of points."""
    angle = problem.period * np.arange(points) / points
    apart = np.arange(points)[:, None] - np.arange(points)
    with np.errstate(divide="ignore"):
        matrix = np.where(apart, (-1.0) ** apart / (2.0 * np.sin(np.pi * apart / points)), 0.0)
    matrix *= 2.0 * np.pi / problem.period

    def run():
        energy, last = np.full(points, problem.guess), np.inf
        for _ in range(40):
            slope, by_energy = problem.slopes(angle, energy)
            change = np.linalg.solve(matrix - np.diag(by_energy), slope - matrix @ energy)
            energy = energy + change
            size = np.abs(change).max() / energy.max()
            if size < 1e-14 or last <= size < 1e-9:  # of many points the rounding alone changes more than 1e-14
                break
            last = size
        half = np.pi * (problem.angles[:, None] - angle) / problem.period
        with np.errstate(divide="ignore", invalid="ignore"):
            weight = np.where(np.abs(np.sin(half)) < 1e-12, 1.0, np.sin(points * half) / (points * np.sin(half)))
        return problem.speeds(weight @ energy)

    return run


_STEPPING = partial(_integrated_turns, _energy_by_stepping)
RUNNING_METHODS = (
    *OUR_METHODS,
    Method("stepping until it repeats, DOP853", partial(_STEPPING, "DOP853"), "tolerance", TOLERANCES),
    Method("stepping until it repeats, LSODA", partial(_STEPPING, "LSODA"), "tolerance", TOLERANCES[:-1]),
    Method("shooting, DOP853", partial(_integrated_turns, periodic_energy, "DOP853"), "tolerance", TOLERANCES),
    Method("shooting, fixed steps, RK4", partial(_fixed_steps, 4), "steps a turn", (24, 72, 216, 648, 1944)),
    Method("shooting, fixed steps, RK8", partial(_fixed_steps, 12), "steps a turn", (24, 48, 96, 192)),
    Method("collocation, SciPy solve_bvp", _scipy_bvp, "tolerance", TOLERANCES[:-1]),
    Method("collocation, Fourier", _fourier, "points", (9, 17, 33, 65, 129, 257, 513)),
)


LONG_RUN_TIME = 0.2
"""Time, s, above which a run is timed only once."""
LONG_FIRST_RUN = 3.0
"""Time, s, above which it is the first run: compilation takes little of it."""
COMPARED_ANGLES = 24
"""Crank angles at which speeds are compared."""


def study_running(scene, motor, flywheel=0.0, *, methods=None, repeats=3, progress=None):
    """Time and error of every method for periodic running under a motor.

    Parameters
    ----------
    scene, motor, flywheel
        As for `drive.steady`; loads must not depend on the speed, and the motor must turn the crank counter-clockwise.
    methods : sequence of Method, optional
        `RUNNING_METHODS` by default.
    repeats : int
        Number of timings; the median counts.
    progress : function, optional
        Called with the name of each method before it runs.

    Returns
    -------
    pandas.DataFrame
        A row for each method and setting: time [ms], and largest error of the crank speed at 24 crank angles relative
        to running at 30 digits. Both are NaN, with the reason, if a method cannot give the result.

    Raises
    ------
    MissingLibraryError
        The `precision` extra is not installed.
    NotGivenError
        Loads depend on the speed, or cannot be computed at many digits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-10.0))
    >>> motor = ks.drive.Motor.linear(20.0, 105.0)
    >>> table = ks.precision.study_running(pump, motor, 0.05, methods=ks.precision.RUNNING_METHODS[:1], repeats=1)
    >>> bool(table.loc[0, "error"] < 1e-12)
    True
    """
    driven = PeriodicRunning(scene, motor, flywheel, np.zeros(1)).driven
    angles = np.arange(COMPARED_ANGLES) * driven.period / COMPARED_ANGLES
    problem, exact = PeriodicRunning(scene, motor, flywheel, angles), exact_speed(driven, angles)
    methods = methods or RUNNING_METHODS
    return _study(
        problem, methods, lambda found: np.abs(found / exact - 1.0).max(), "crank speed", "1", repeats, progress
    )


def study_motion(name, *, methods=None, repeats=3, progress=None):
    """Time and error of every method for a published motion over time.

    Parameters
    ----------
    name : str
        Name in `BENCHMARKS`: "slider-crank of SUNDIALS", "N-four-bar of IFToMM, N = 2".
    methods : sequence of Method, optional
        `MOTION_METHODS` by default.
    repeats, progress
        As for `study_running`.

    Returns
    -------
    pandas.DataFrame
        As for `study_running`, with the error of the crank angle at the end, rad.

    Raises
    ------
    ParameterError
        The benchmark is unknown.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import kinetostatics as ks
    >>> (steps,) = (method for method in ks.precision.MOTION_METHODS if method.name.endswith("RK4"))
    >>> coarse = [replace(steps, settings=(25,))]
    >>> table = ks.precision.study_motion("slider-crank of SUNDIALS", methods=coarse, repeats=1)
    >>> bool(table.loc[0, "error"] < 1e-3)  # rad
    True
    """
    checks.require("study_motion", checks.choice("benchmark", name, tuple(BENCHMARKS)))
    problem, label = BENCHMARKS[name](), "crank angle at the end"
    methods = methods or MOTION_METHODS
    return _study(problem, methods, lambda found: abs(found - problem.exact), label, "rad", repeats, progress)


def _study(problem, methods, error, label, unit, repeats, progress):
    import pandas as pd

    times: dict[Any, float] = {}  # s, of each run

    def measure(method, run):
        for _ in range(2):  # the first call may compile
            begun = time.perf_counter()
            found = run()
            times[run] = time.perf_counter() - begun
            if times[run] > LONG_FIRST_RUN:
                break
        return {"error": float(error(found))}

    rows, runs = run_methods(methods, problem, label, measure, progress)
    short = [run for run in runs.values() if times[run] < LONG_RUN_TIME]
    times |= dict(zip(short, seconds(*short, repeats=repeats), strict=True))
    table = pd.DataFrame(rows).assign(label=label, unit=unit)
    table.insert(4, "time [ms]", 1e3 * pd.Series({row: times[run] for row, run in runs.items()}, dtype=float))
    return table
