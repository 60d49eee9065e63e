"""Quantities of a scene as a program: `compile` records it once, calls take other crank angles and numbers."""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from ..engines.error_bounds import PRECISIONS
from ..engines.graph import needed
from ..engines.jax_backend import Backend
from ..engines.numba_backend import numba_available, require_numba
from ..engines.program import program_of
from ..errors import ParameterError
from ..machine.loads import has_no_user_code, refusals, value_of
from ..mechanics import jamming
from ..mechanics.dynamics import Dynamics
from ..mechanics.load_values import require_pure
from ..mechanics.quantities import FRICTION_CHECKS
from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.parameter_tree import construct_unchecked
from .certainty import sensitivities
from .parameters import (
    DRIVE,
    angle_problem,
    crank_angles,
    has_joint_rule,
    hint_at_angles,
    is_zero,
    keep_numbers,
    leaf_by_path,
    passage_paths,
    path_problem,
    paths_without_derivative,
    require_derivatives,
)
from .scene import scene_problem, unchecked_solution

MAPPING_TYPES = (dict, MappingProxyType)
"""Types accepted without the slower test of the protocol."""
FRICTION_ANGLES = 180
"""Crank angles around the turn that decide the number of passes over friction."""


class Program:
    """Quantities of a scene as a program of crank angle and parameters; `compile` returns it.

    Attributes
    ----------
    scene : Scene
    quantities : tuple of str
    parameters : mapping of path to value
        Every number that a call may change, with its value in the scene.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> scene = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5)
    >>> program = ks.compile(scene, ("balancing_torque", "O"))
    >>> sorted(program.parameters)
    ['coupler_length', 'crank_length', 'crank_speed', 'slider.mass']
    >>> program(1.0, {"slider.mass": 620.0})["O"].shape
    (2,)
    """

    def __init__(self, scene, quantities, kept, backend):
        self.scene, self.quantities, self._backend, self._kept = scene, quantities, backend, kept
        self._compiled, self._is_own = backend.engine == "compiled", backend.is_own
        places = scene.places
        checks.require("compile", *(path_problem(scene, path) for path in kept if path not in places))
        if scene.friction.acting:
            scene = _solve_friction(scene)
        scene = keep_numbers(scene, places, kept)
        state = scene.dynamics(np.zeros(1))
        self._fields, self._refuses = dict(vars(state)), any(getattr(item, "REFUSES", False) for item in scene.loads)
        self._program, self._leaves = program_of(state, quantities)
        self._friction: Any = program_of(state, FRICTION_CHECKS)[0] if scene.friction.acting else None
        self._numbers = {}
        for path, number in leaf_by_path(places, state).items():
            rule = places[path].rule  # one value a design is recorded, no table over the crank angles
            self._numbers[path] = number, replace(rule, table=False) if getattr(rule, "table", False) else rule
        self._absent = tuple(path for path in places if path not in self._numbers)
        self._doors = {path for path in self._numbers if has_joint_rule(scene, places[path].steps)}
        if scene.sense is not None:  # it must not contradict the speed
            self._doors |= {"crank_speed", "sense"} & self._numbers.keys()
        self._passages = scene.mechanism.passages
        groups = scene.mechanism.groups
        self._lengths = passage_paths(places, scene.mechanism, [group for group in groups if group.through])
        self._fixed = paths_without_derivative(places, scene.mechanism)
        values = {path: self._leaves.numbers[number] for path, (number, _) in self._numbers.items()}
        self.parameters: Mapping[str, Any] = MappingProxyType(values)

    def __repr__(self):
        names = ", ".join(self.parameters)
        runs = f"{self.engine}, {self.precision}"
        return f"<Program: {', '.join(self.quantities)} of {self.scene.mechanism.name}; {runs}; parameters {names}>"

    def __reduce__(self):
        return Program, (self.scene, self.quantities, self._kept, self._backend)

    def __call__(self, angle, values=MappingProxyType({})):
        """Values by quantity.

        Parameters
        ----------
        angle : float or array (..., N)
            Crank angles, rad; tables over the crank angles of the scene, a crank speed for instance, must fit them.
        values : mapping of path to float or array (designs, 1)
            New numbers, SI, checked as in a scene; all others keep their values.

        Returns
        -------
        dict of str to array
            By quantity: scalars (..., N), vectors (2, ..., N), in the units of `Solution`; NaN where the mechanism does
            not close.

        Raises
        ------
        ParameterError
            A value is impossible, or a path is unknown. Numbers that are zero in the scene or part of a direction along
            an axis are absent unless `parameters` of `compile` names them.

        Warns
        -----
        HintWarning
            The crank angles look like degrees, or like a count of them.
        ConditionWarning
            With these values friction does not converge to rounding: compile a scene that has them.
        """
        found = self.evaluated(angle, values)
        hint_at_angles(self.scene.mechanism.name, angle)
        return found

    def evaluated(self, angle, values=MappingProxyType({})):
        """The values of a call, without hints at its crank angles."""
        state, leaves = self._at(angle, values)
        if values and self._friction is not None:  # other numbers may need more passes over friction than the scene's
            checks.require("program", jamming.problem_at_rest(self.scene.varied(values)))
            margin, residual = self._friction.run(state, leaves, self._compiled)
            jamming.warn_if_not_converged(state, np.asarray(margin), np.asarray(residual), stacklevel=4)
        if self._is_own:
            rows = self._program.run(state, leaves, self._compiled)
        else:
            rows = self._backend.run(self._program, state, leaves)
        return self._program.recording.named(read_only(rows))

    @property
    def engine(self):
        """Engine: "compiled", "numpy" or "jax"."""
        return self._backend.engine

    @property
    def precision(self):
        """Of its results: "double" or "single"."""
        return self._backend.precision

    @property
    def device(self):
        """Processor: "cpu", or JAX's name for it, such as "gpu: NVIDIA H100"."""
        return self._backend.device

    def error_bound(self, angle, values=MappingProxyType({}), tight=False):
        """Proven bounds on the rounding errors of the values of a call, computed in double.

        Numbers and crank angles, in double, count as exact; see `Solution.error_bound`.

        Parameters
        ----------
        angle, values
            As for a call.
        tight : bool
            As for `Solution.error_bound`; in double precision only, not with JAX.

        Returns
        -------
        dict of str to array
            Shaped as the quantities, in their units. Infinite where nothing can be proven, in single precision also
            where a number on the way may be too large for it; NaN where there is no value.

        Raises
        ------
        ParameterError
            Tight bounds are asked for of single precision, or of JAX.
        NotGivenError
            The rounding of your own code or of the device is unknown.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), crank_speed=100.0)
        >>> program = ks.compile(pump, "balancing_torque", engine="numpy", precision="single")
        >>> bool(program.error_bound(0.5)["balancing_torque"] < 1e-4)  # of 14.9 N m
        True
        """
        checks.require("program", checks.truth("tight", tight))
        if tight and not self._is_own:
            raise ParameterError(
                "program: tight bounds exist in double precision with the engines compiled and numpy. This one runs "
                f"by {self.engine} in {self.precision} precision, so leave tight out, or compile a program with them"
            )
        state, leaves = self._at(angle, values)
        hint_at_angles(self.scene.mechanism.name, angle)
        return self._program.recording.named(read_only(self._backend.bounds(self._program, state, leaves, tight)))

    def unlooked(self, angle, values, compiled):
        """Values by quantity, compiled or not; the caller checks numbers, friction, and at a single float the loads."""
        numbers = list(self._leaves.numbers)
        for path, value in values.items():
            numbers[self._numbers[path][0]] = value
        if type(angle) is float and not self._program.recording.tables:
            return self._program.recording.named(self._program.at_one(angle, numbers, compiled))
        state, leaves = self._state(np.asarray(angle), values, self._leaves.with_numbers(numbers))
        return self._program.recording.named(self._program.run(state, leaves, compiled))

    def derivatives(self, angle, by=None, values=MappingProxyType({})):
        """Exact derivatives of every quantity by parameters, from the recorded arithmetic.

        Parameters
        ----------
        angle, values
            As for a call.
        by : str or sequence of str, optional
            Paths; by default all parameters except lengths where change points are passed. The mapping `values` may
            also come first, as in a call.

        Returns
        -------
        dict of str to dict of path to array
            Shaped as the quantities, in units of the quantity by units of the parameter; NaN where these are.

        Raises
        ------
        ParameterError
            A parameter is unknown, or it is a length of a mechanism that passes change points: any other length
            would make a mechanism of another kind.
        NotGivenError
            A cam or load of your own does more than arithmetic with sin, cos and sqrt.
        """
        by, values = _names_and_values(by, values)
        checks.require("program", None if by is None else checks.names("by", by))
        every = tuple(path for path in self.parameters if path not in self._fixed)
        names = every if by is None else ((by,) if isinstance(by, str) else tuple(by))
        checks.require("program", None if names else "by is empty; name at least one parameter")
        self._require_known(names)
        require_derivatives("program", self.scene.mechanism, names, self._fixed)
        state, leaves = self._at(angle, values)
        hint_at_angles(self.scene.mechanism.name, angle)
        return sensitivities(
            self._program, {path: self._numbers[path][0] for path in names}, state, leaves, self._backend
        )

    @property
    def unrecorded(self):
        """Names of the user's functions whose dependence on parameters is not recorded, a tuple."""
        return self._program.unrecorded

    def depends_on(self, path):
        """Whether a quantity depends on a parameter, as far as it is recorded; see `unrecorded`."""
        self._require_known((path,))
        place, _ = self._numbers[path]
        if path == ("crank_speed" if self.scene.sense is None else "sense") and any(
            getattr(value_of(item), "by_sense", False) for item in self.scene.loads
        ):
            return True
        return self._program.recording.parameters[place] in set(needed(self._program.outputs))

    def _at(self, angle, values):
        """The scene at crank angles, a `Dynamics`, and its leaves."""
        angle = np.array(angle) if type(angle) is float else crank_angles(angle, "program")
        wrong = angle_problem(angle)
        if wrong:
            checks.require("program", wrong)
        if type(values) not in MAPPING_TYPES and not isinstance(values, Mapping):
            checks.require("program", checks.mapping("values", values))
        return self._state(
            angle, values, self._leaves.with_numbers(self._numbers_with(values)) if values else self._leaves
        )

    def _state(self, angle, values, leaves):
        fields, shape = self._fields, _shape(angle, leaves)
        if not (self._refuses or self._program.recording.tables):
            return construct_unchecked(Dynamics, **{**fields, "crank_angle": angle, "shape": shape}), leaves
        drive = values.keys() <= DRIVE.rules.keys() | {"sense"}
        fields = {**fields, **values} if drive else vars(self.scene.varied(values).dynamics(angle))
        state = construct_unchecked(Dynamics, **{**fields, "crank_angle": angle, "shape": shape})
        checks.require("program", *refusals(state))
        return state, leaves

    def _numbers_with(self, values):
        """All numbers in their order, some with new values, checked."""
        self._require_known(values)
        numbers, wrong = list(self._leaves.numbers), []
        for path, value in values.items():
            number, rule = self._numbers[path]
            found = rule.quick(value)
            if found is checks.UNDECIDED:
                found, problem = rule.check(value, path)
                wrong.append(problem)
            numbers[number] = found
        if wrong:
            checks.require("program", *wrong)
        lengths = self._lengths.intersection(values)
        if lengths or not self._doors.isdisjoint(values):
            varied = self.scene.varied(values)
            if lengths and varied.mechanism.passages != self._passages:
                raise ParameterError(
                    f"program: {self.scene.mechanism.name} with other values of {', '.join(sorted(lengths))} is "
                    "of another kind (it passes other change points) and needs another program. Change lengths "
                    "together so that the kind stays, or compile a program of it"
                )
        return numbers

    def _require_known(self, names):
        if all(isinstance(path, str) and path in self._numbers for path in names):
            return
        for path in names:
            if isinstance(path, str) and path in self._absent:
                why = "zero in the scene" if is_zero(self.scene.places[path].value(self.scene)) else "of an axis"
                raise ParameterError(
                    f'program: {path} is {why} and so left out; keep it by compile(..., parameters=("{path}",))'
                )
        checks.require("program", *(path_problem(self.scene, path, self._numbers) for path in names))


def _names_and_values(by, values):
    """Parameter names and values, in either order: only values are a mapping."""
    if not isinstance(by, Mapping):
        return by, values
    if isinstance(values, Mapping) and values:
        raise ParameterError(
            "program: by and values are both mappings: give the parameter names as a list, "
            f"by={list(values)!r} for instance"
        )
    return None if isinstance(values, Mapping) else values, by


def _solve_friction(scene):
    """The scene with enough passes over its friction all around the turn."""
    if any(np.ndim(leaf) and np.shape(leaf)[-1] > 1 for leaf in (scene.crank_speed, scene.crank_acceleration)):
        return jamming.solve_friction(scene)
    angles = np.linspace(0.0, scene.period, FRICTION_ANGLES, endpoint=False)
    with np.errstate(all="ignore"):
        return jamming.solve_friction(
            scene, lambda scene: jamming.checks_of(unchecked_solution(scene, angles, "numpy"))
        )


def _shape(angle, leaves):
    """Shape (..., N) of scalar results; an error if tables or designs do not fit the crank angles."""
    try:
        return leaves.shape(angle.shape)
    except ValueError:
        arrays = (leaf for leaf in (*leaves.numbers, *leaves.tables) if type(leaf) is not float)
        given = {f"array {number} of the scene": array.shape for number, array in enumerate(arrays, 1)}
        checks.require("program", checks.broadcast_problem(crank_angle=angle.shape, **given))
        raise


TRIAL_ANGLES = np.array([0.3, 2.0])
"""Crank angles at which functions of loads are tested before recording, rad."""


def compile(  # noqa: A001 - the contract's name
    scene, quantities, parameters=(), engine=None, *, precision="double", device=None
) -> Program:
    """Program of some quantities of a scene, to be called with other crank angles and other numbers.

    Parameters
    ----------
    scene : Scene
    quantities : str or sequence of str
        "balancing_torque", a joint (its reaction), "slider_acceleration", "coupler_rate" ...
    parameters : str or sequence of str
        Paths of numbers that are zero in the scene but that calls may change; other zeros cost no time.
    engine : "compiled", "numpy" or "jax"
        By default "compiled" if numba is installed; "jax" (extra `grad`) runs on the accelerator that JAX finds.
    precision : "double" or "single"
        Precision of the arithmetic at each crank angle and of the results. With "single", sines of crank angles, tables
        and constants of a design are still computed in double and rounded once; `Program.error_bound` bounds the error.
    device : str, optional
        For JAX: "cpu", "gpu" or another platform instead of the first that it has.

    Returns
    -------
    Program

    Raises
    ------
    ParameterError
        A parameter or device is unknown, or a function of a load is not pure.
    QuantityError
        The quantity is unknown; the message lists those of the mechanism.
    NotGivenError
        A group or load of your own does more than arithmetic with sin, cos and sqrt, so it cannot be recorded.
    MissingLibraryError
        ``engine="compiled"`` without numba, or ``engine="jax"`` without JAX.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> program = ks.compile(ks.Scene(pump, crank_speed=100.0), "balancing_torque", engine="numpy")
    >>> round(float(program(0.5)["balancing_torque"]), 6)
    14.875291
    >>> round(float(program(0.5, {"slider.mass": 2.0})["balancing_torque"]), 6)
    29.750582
    >>> ks.compile(program.scene, "balancing_torque", engine="numpy", precision="single")(0.5)["balancing_torque"].dtype
    dtype('float32')
    """
    checks.require("compile", checks.names("quantities", quantities), checks.names("parameters", parameters))
    names = (quantities,) if isinstance(quantities, str) else tuple(quantities)
    checks.require(
        "compile",
        scene_problem(scene),
        None if names else "no quantities are asked for",
        *(checks.quantity(name) for name in names),
        None if engine is None else checks.choice("engine", engine, ("compiled", "numpy", "jax")),
        checks.choice("precision", precision, tuple(PRECISIONS)),
        None if device is None else _device_problem(device, engine),
    )
    if engine == "compiled":
        require_numba()
    if (
        not all(map(has_no_user_code, scene.loads))
        and np.size(scene.crank_speed) == np.size(scene.crank_acceleration) == 1
    ):
        require_pure(unchecked_solution(scene, TRIAL_ANGLES))
    kept = (parameters,) if isinstance(parameters, str) else tuple(parameters)
    backend = Backend(engine or ("compiled" if numba_available() else "numpy"), precision, device)
    backend.device  # noqa: B018  refuses one that is not there
    return Program(scene, names, kept, backend)


def _device_problem(device, engine):
    """Sentence on an impossible device, else None; its existence is tested later."""
    if engine != "jax":
        return 'device is for engine="jax"; all others run on the processor'
    return None if isinstance(device, str) else f'device must be a text such as "gpu", got {checks.shown(device)}'
