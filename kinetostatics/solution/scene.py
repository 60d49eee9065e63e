"""Scene: a mechanism with its drive and loads; `solve` checks it and returns its solution."""

import math
import warnings
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

import numpy as np

from ..cycle.load_functions import FUNCTION_STEP, check_resolution, function_step, samples_of_functions
from ..engines.engines import COMPILED, FASTEST, is_plain
from ..engines.numba_backend import numba_available, require_numba
from ..engines.program import program_of
from ..errors import HintWarning, ParameterError
from ..machine import friction as rubbing
from ..machine import plausibility
from ..machine.loads import KINDS, MAX_TURNS, TURN, Load, period_of, value_of
from ..machine.mechanism import Mechanism
from ..mechanics.dynamics import Dynamics
from ..mechanics.load_values import require_pure
from ..mechanics.motion import SceneParts
from ..numbers import checks, paths
from ..numbers.arithmetic import concrete_array
from ..numbers.parameter_tree import construct_unchecked
from . import parameters
from .parameters import (
    BYTES_PER_VALUE,
    DRIVE,
    SENSE,
    Parameters,
    angle_problem,
    crank_angles,
    drive_and_loads_text,
    path_problem,
)
from .solution import Solution

GAPS, ENGINES = ("raise", "nan"), ("numpy", "compiled")
PARTS = (*SceneParts._fields, "resolution")
"""Fields of a scene that its solutions share."""
read_parts = attrgetter(*PARTS)
MIN_VALUES_COMPILED = 1_000_000
"""Crank angles times designs above which a compiled loop saves time."""


@dataclass(frozen=True, eq=False)
class Scene(Parameters):
    """A mechanism with its drive and loads: the input of a solution without the crank angles.

    Parameters
    ----------
    mechanism : Mechanism
        As made by `crank_slider`, `cam_crank_slider`, `four_bar`, or from a crank and groups of your own.
    crank_speed, crank_acceleration : float or array
        rad/s and rad/s2, counter-clockwise positive; an array has a value for each crank angle, or is (designs, 1).
    loads : sequence
        `Gravity`, `Spring`, `Force`, `Torque` and the others of `machine.loads`, or one of them.
    friction : dict of str to friction, optional
        Friction by joint, as for `solve`.
    sense : +1, -1 or array, optional
        Sense in which a crank at rest is about to turn, as for `solve`.
    resolution : float, optional
        Step of crank angles, rad, at which load functions without `kinks` are sampled, as for `solve`.

    Raises
    ------
    ParameterError
        A value is not finite, or a load names an unknown link or joint.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> scene = ks.Scene(pump, crank_speed=100.0, loads=ks.Gravity())
    >>> print(f"{ks.extremes(scene.solve(360), 'O').largest:.3f} N")
    625.000 N
    >>> scene.varied({"slider.mass": 2.0}).parameters["slider.mass"]
    2.0
    """

    mechanism: Mechanism
    crank_speed: Any
    crank_acceleration: Any = 0.0
    loads: Any = ()
    friction: Any = None
    sense: Any = field(default=None, kw_only=True)
    resolution: float = field(default=FUNCTION_STEP, kw_only=True, metadata={"structural": True})

    def __post_init__(self):
        self._admit("scene")

    def _admit(self, owner):
        values = vars(self)
        if type(self.mechanism) is not Mechanism:
            checks.require(owner, mechanism_problem(self.mechanism))
        DRIVE.keep(values, owner)
        if self.sense is not None:
            values.update(sense=_sense(owner, self.sense, values["crank_speed"]))
        if self.resolution is not FUNCTION_STEP:
            values.update(resolution=function_step(owner, "resolution", self.resolution))
        loads = tuple(self.loads) if isinstance(self.loads, list | tuple) else (self.loads,)
        wrong = [text for item in loads for text in _load_problems(self.mechanism, item)]
        if self.friction is not None and self.friction is not rubbing.NO_FRICTION:
            wrong += rubbing.friction_problems(self.mechanism, self.friction)
        checks.require(owner, *wrong, _period_problem(loads))
        loads = tuple(item if type(item) in KINDS else checks.snapshot(item) for item in loads)
        values.update(loads=loads, friction=rubbing.frictions_by_joint(self.friction))

    def __repr__(self):
        return f"<Scene: {self.mechanism.name}, {drive_and_loads_text(self)}>"

    @classmethod
    def of(cls, solution):
        """The scene of a solution: the solution without its crank angles.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        >>> ks.Scene.of(ks.solve(pump, 0.5, crank_speed=100.0)).crank_speed
        100.0
        """
        checks.require("scene", checks.solution("solution", solution))
        return cls(**{name: getattr(solution, name) for name in PARTS})

    @property
    def period(self):
        """Crank angle after which motion and loads repeat, rad."""
        return period_of(self.loads, self.mechanism.turns)

    @property
    def parameters(self):
        """Every number of the scene by path, including zeros, as in case files: "crank_length", "slider.mass" ..."""
        return {path: place.value(self) for path, place in self.places.items()}

    @property
    def units(self):
        """SI unit of every number by path."""
        return {path: place.rule.unit for path, place in self.places.items()}

    def varied(self, values):
        """The scene with other values at some paths, SI, checked as by the constructor.

        Parameters
        ----------
        values : dict of path to float or array (designs, 1)

        Raises
        ------
        ParameterError
            A path is unknown, or a value is impossible.
        """
        known = self.places
        checks.require("scene", checks.mapping("values", values))
        checks.require("scene", *(path_problem(self, path) for path in values if path not in known))
        return paths.with_values(self, {known[path].steps: value for path, value in values.items()})

    def solve(self, angles=720, *, on_gap="raise", engine=None) -> Solution:
        """Solution at crank angles.

        Parameters
        ----------
        angles : int, float or array
            An int is the number of even angles over one period from 0, end excluded; floats and arrays are angles, rad.
        on_gap, engine
            As for `solve`.
        """
        return _start(self, self.turn(angles), on_gap, engine).check(on_gap)

    def unsolved(self, angle):
        """Solution at an array of crank angles, without any check."""
        return Solution(crank_angle=angle, **self._parts)

    def dynamics(self, angle):
        """Motion and forces at crank angles for engines, without any check."""
        return Dynamics(crank_angle=angle, **{name: getattr(self, name) for name in SceneParts._fields})

    @property
    def _parts(self):
        """All fields by name."""
        return dict(zip(PARTS, read_parts(self), strict=True))

    def check_resolution(self, step=None):
        """Test whether the resolution misses features of load functions without `kinks`.

        Every load function is sampled at crank angles of `step` and compared with the interpolation of its samples at
        the resolution of the scene. Differences below 1e-5 of its largest value do not count.

        Parameters
        ----------
        step : float, optional
            rad, at most the resolution: ``np.radians(0.005)``. By default the resolution, midway between the samples.

        Returns
        -------
        ResolutionCheck
            Empty if nothing is missed.

        Raises
        ------
        ParameterError
            The step is larger than the resolution, or less than 1e-5 rad; or a function is not pure.

        Examples
        --------
        >>> import numpy as np
        >>> import kinetostatics as ks
        >>> work = ks.ProcessForce(lambda q: -200.0 * (q.slider_velocity > 0.0))
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=work)
        >>> pump.check_resolution(np.radians(0.005))
        <ResolutionCheck every 0.005 deg: no features narrower than 0.05 deg>
        """
        step = function_step("check_resolution", "step", self.resolution if step is None else step, self.resolution)
        solution = self.unsolved(np.zeros(1))
        require_pure(solution)
        return check_resolution(solution, samples_of_functions(solution), step)

    def turn(self, angles):
        """Even crank angles over one period from 0, end excluded; anything but an int is returned unchanged."""
        if not isinstance(angles, int | np.integer) or isinstance(angles, bool):
            return angles
        checks.require("solve", checks.count("angles", angles, size=checks.BYTES_PER_ANGLE))
        return np.linspace(0.0, self.period, angles, endpoint=False)


def scene_problem(value):
    """Sentence on an argument that is no scene, else None; case variants and others have a `.scene`."""
    if isinstance(value, Scene):
        return None
    hint = "; give its .scene" if isinstance(getattr(value, "scene", None), Scene) else ""
    return f"scene must be a Scene, as ks.Scene(...), got {checks.shown(value)}{hint}"


def solve(
    mechanism,
    crank_angle,
    *,
    crank_speed,
    crank_acceleration=0.0,
    loads=(),
    friction=None,
    sense=None,
    resolution=FUNCTION_STEP,
    on_gap="raise",
    engine=None,
):
    """Motion and forces of a mechanism at prescribed crank motion.

    Parameters
    ----------
    mechanism : Mechanism
        As made by `crank_slider`, `cam_crank_slider` or from a crank and groups of your own.
    crank_angle : array (..., N)
        rad, counter-clockwise from +x; the last axis is the turn, axes before it broadcast with designs. A single
        number, even an int, is one angle; `Scene.solve` accepts a number of angles.
    crank_speed, crank_acceleration : float or array
        rad/s and rad/s2, counter-clockwise positive.
    loads : sequence
        `Gravity`, `Spring`, `Force`, `Torque` and the others of `machine.loads`, or one of them. Arrays and your own
        loads are copied, so later changes have no effect. A function must be pure, because engines call it any number
        of times.
    friction : dict of str to friction, optional
        By joint, named as its reaction ("O", "A", "guide"), "slot" or "cam", each with the label of its group: a
        `PinFriction`, `GuideFriction`, `SlotFriction` or `RollerFriction`. At crank speed 0 it acts against the motion
        that is about to begin, according to `sense` or the crank acceleration.
    sense : +1, -1 or array, optional
        Sense in which a crank at rest is about to turn, positive counter-clockwise. Friction, and tables with values
        for the return stroke, depend on it. By default the sign of the crank speed, at rest of the crank acceleration.
    resolution : float
        Step of crank angles, rad, at which extremes, means, sweeps, searches and drives sample load functions without
        `kinks`, from 1e-5 rad to 0.25 deg; by default 0.05 deg. They locate every jump between two samples, and every
        pulse wider than the step.
    on_gap : "raise" or "nan"
        Action where the mechanism cannot be assembled. "raise": `AssemblyError` with the crank-angle intervals. "nan":
        NaN there and exact values elsewhere (as needed under ``jax.jit``). If one of several groups is open, NaN are
        its motion and forces and those of groups attached to it, and the forces of groups that carry it. Also NaN are
        all quantities of the crank or the whole mechanism (torque, "O", shaking, inertia, energies).
    engine : "numpy" or "compiled"
        "compiled" runs the same kernels as one loop per quantity, compiled by numba (extra `fast`). The first call
        takes about a second; then the machine code is on disk. By default it is used from a million crank angles
        (designs times angles), if numba is installed. Results agree to a few ulp.

    Returns
    -------
    Solution
        Each result is computed when first read, and cached; arrays are read-only.

    Raises
    ------
    AssemblyError
        The mechanism does not close at some of the angles and ``on_gap="raise"``.
    ParameterError
        A value is not finite, or a load names an unknown link or joint. A load has no value at a crank angle, as a
        force between points that meet, or its function is not pure.
    MissingLibraryError
        ``engine="compiled"`` without numba.
    NotGivenError
        ``engine="compiled"`` for a group or load of your own that does more than arithmetic.

    Warns
    -----
    ConditionWarning
        Half of the digits are lost at some crank angle: `Solution.condition` exceeds 1e8.
    HintWarning
        Something looks like a mistake: angles in degrees, a count of angles, lengths in mm, a speed in rpm, hardly any
        inertia.
    UserWarning
        The crank angles are in single precision; forces of your own group violate the power balance (found when they
        are computed).

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> turn = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    >>> s = ks.solve(saw, turn, crank_speed=33.5, loads=[ks.Gravity()])
    >>> s.reaction("O")[:, 0].round(1)  # N, x and y, at the first angle
    array([-286594.6,     735.8])
    >>> print(f"{s.balancing_torque[30]:.1f} N m at 30 deg")
    37880.5 N m at 30 deg
    >>> bool(s.power_residual < 1e-14)  # two ways to the torque agree
    True
    """
    scene = construct_unchecked(
        Scene,
        mechanism=mechanism,
        crank_speed=crank_speed,
        crank_acceleration=crank_acceleration,
        loads=loads,
        friction=friction,
        sense=sense,
        resolution=resolution,
    )
    scene._admit("solve")
    return _start(scene, crank_angle, on_gap, engine).check(on_gap)


def _start(scene, crank_angle, on_gap, engine):
    if on_gap is not GAPS[0]:
        checks.require("solve", checks.choice("on_gap", on_gap, GAPS))
    solution = unchecked_solution(scene, crank_angle, engine)
    for text in (*scene_hints(solution), *plausibility.angle_hints(solution.crank_angle, crank_angle)):
        warnings.warn(HintWarning(scene.mechanism.name, text), stacklevel=3)
    if engine == "compiled" and not solution.is_given:
        program_of(solution.dynamics)  # refuses what cannot be recorded
    return solution


def scene_hints(solution):
    """Sentences on numbers of the scene that look like mistakes; the full test runs only if the fast one fails."""
    _, may_be = solution.first_look or (None, True)
    return parameters.plausibility_hints(solution) if may_be else ()


def unchecked_solution(scene, crank_angle, engine=None):
    """The solution that `solve` returns, before hints and before `Solution.check`."""
    angle = crank_angles(crank_angle)
    solution = construct_unchecked(Solution, crank_angle=angle, **scene._parts)
    wrong = None if 0.0 < solution.farthest < math.inf else angle_problem(angle)
    checks.require("solve", wrong, None if engine is None else checks.choice("engine", engine, ENGINES))
    if angle.dtype == "float32":
        warnings.warn(
            "crank angles are in single precision, so the results have about 7 digits, 8 fewer than in double; under "
            'JAX switch jax.config.update("jax_enable_x64", True) on first',
            stacklevel=4,
        )
    _, leaves = solution.apart
    if not leaves.are_plain:
        checks.require("solve", checks.broadcast_problem(**_shapes(scene, angle)))
        values = math.prod(solution.shape)
        checks.require("solve", values and checks.count("designs times crank angles", values, size=BYTES_PER_VALUE))
    is_large = math.prod(solution.shape) >= MIN_VALUES_COMPILED
    if engine == "compiled":
        if not is_plain(angle):
            raise ParameterError('solve: engine="compiled" needs crank angles in double precision; use engine="numpy"')
        require_numba()
        vars(solution)["engine"] = COMPILED
    elif engine is None and is_large and is_plain(angle) and numba_available():
        vars(solution)["engine"] = FASTEST
    return solution


def _sense(owner, given, speed):
    """The sense of rotation, checked: +1 or -1, equal to the sign of the speed where the crank turns."""
    sense, problem = SENSE.check(given, "sense")
    ways, rates = None if problem else concrete_array(sense), concrete_array(speed)
    if ways is not None and np.any(np.abs(ways) != 1.0):
        problem = f"sense must be +1 or -1, the sense in which the crank is about to turn, got {checks.shown(given)}"
    elif ways is not None and rates is not None and np.any(rates * ways < 0.0):
        problem = (
            f"sense is for a crank at rest: {checks.shown(given)} contradicts crank_speed {checks.shown(speed)}; leave "
            "sense out, as the speed determines it"
        )
    checks.require(owner, problem)
    return sense


def mechanism_problem(found):
    """Sentence on an argument that is no mechanism, else None."""
    if isinstance(found, Mechanism):
        return None
    itself = not isinstance(found, type) and hasattr(found, "solve")
    remedy = "; call its .solve(angles), which has its drive and loads" if itself else ""
    return f"mechanism must be a Mechanism, as crank_slider or four_bar returns, got {checks.shown(found)}{remedy}"


def _shapes(scene, angle):
    """Shapes that must fit together, by name."""
    arrays = {"crank_angle": angle} | {name: getattr(scene, name) for name in (*DRIVE.rules, "sense")}
    shapes = {name: value.shape for name, value in arrays.items() if hasattr(value, "shape")}
    if scene.mechanism.batch:
        shapes["mechanism"] = scene.mechanism.batch
    for item in scene.loads:
        found = getattr(value_of(item), "shape", ()) or getattr(item, "batch", ())
        if found:
            shapes[f"{type(item).__name__} {len(shapes)}"] = found
    return shapes


def _period_problem(loads):
    """Sentence if the common period of the loads is too long, else None."""
    turns = period_of(loads) / TURN if len(loads) > 1 else 1.0
    if turns <= MAX_TURNS:
        return None
    each = ", ".join(f"{getattr(item, 'period', TURN) / TURN:.6g}" for item in loads)
    return f"loads that repeat after {each} turns repeat together only after {turns:.6g}; {MAX_TURNS} are allowed"


def _load_problems(mechanism, item):
    """Sentences on a load that does not fit the mechanism."""
    if isinstance(item, Load):
        return item.problems(mechanism)
    if isinstance(item, type) or not (hasattr(item, "push") and hasattr(item, "on")):
        *names, last = (kind.__name__ for kind in KINDS)
        return (f"loads must be {', '.join(names)} or {last}, got {checks.shown(item)}",)
    return (checks.choice(f"{type(item).__name__}: on", item.on, tuple(mechanism.guides)),)
