"""A scene as one degree of freedom: reduced inertia and load torque by crank angle and speed.

    (J + Jf) alpha + J' omega^2 / 2 + load torque(phi, omega) + friction torque(phi, omega, alpha) = motor torque

J is the reduced inertia of the links in kg m2, Jf the flywheel with the motor's rotor; torques in N m are positive
counter-clockwise. Loads may depend on the crank angle and speed, not on the acceleration. Friction depends on alpha:
the secant rule solves for it at each crank angle, or a bracketing search where a kink of friction stops the secant
rule. Friction torque comes from the scene's own program at the true alpha. Its senses are known beforehand (`senses`),
so it is smooth between the angles at which a sense changes.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..engines.numba_backend import numba_available
from ..errors import AssemblyError, DriveError, NotGivenError
from ..machine.friction import NO_FRICTION
from ..machine.links import Rolling, Sliding
from ..machine.loads import TURN, Table, has_no_user_code, kink_sources, kinks_of, period_on, value_of
from ..mechanics.friction import kink_functions
from ..mechanics.jamming import require_free, solve_friction
from ..mechanics.load_values import drive_dependence, title_of
from ..numbers import checks
from ..numbers.brackets import find_roots
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import replace_unchecked
from ..solution.program import compile as compiled
from ..solution.scene import scene_problem
from .motor import Motor
from .senses import Senses

INERTIA, SLOPE, TORQUE, CLOSURE = QUANTITIES = ("reduced_inertia", "reduced_inertia_slope", "load_torque", "closure")
FRICTION, *CHECKS = FRICTION_OUTPUTS = ("friction_torque", "friction_margin", "friction_residual")
ANGLE_TOLERANCE = 1e-12
"""Crank angles nearer than this, rad, count as one."""
LOAD_PROBE_ANGLES = 720
"""Crank angles over the period that probe which inputs a load function reads."""
RELATIVE_SPEED_STEP = 1e-6
"""Relative speed step of difference quotients; they only steer the iteration."""
MAX_SECANT_STEPS = 30
"""Secant steps for the acceleration; three or four suffice unless friction nearly jams."""
FRICTION_TOLERANCE = 2e-16
"""Change of the friction torque, relative to all torques, at which the secant rule ends."""
TORQUE_TOLERANCE = 1e-14
"""Unbalanced torque, relative to all torques, at which it ends where friction does not depend on the acceleration."""
MIN_FRICTION_CHANGE = 1e-9
"""Change of the friction torque, relative to all torques, above which a secant is meaningful."""
MAX_DOUBLINGS = 50
"""Doublings of the acceleration bracket before friction counts as jamming."""
BRACKET_TOLERANCE = 1e-16
"""Error of an acceleration relative to its bracket."""
PREPARED_ANGLES = 180
"""Crank angles over the period at which `prepare` solves friction."""
BLOCK_SIZE = 4096
"""Crank angles of one call of the friction program."""


class State(NamedTuple):
    """Reduced inertia (kg m2), its slope (kg m2/rad), load torque (N m) and closure at crank angles."""

    inertia: np.ndarray
    slope: np.ndarray
    torque: np.ndarray
    closure: np.ndarray


class DrivenMachine:
    """A scene without friction as one degree of freedom; `flywheel` is all inertia on the crank besides the links.

    Of the scene's crank speed only the sign counts, and only without a motor. `direction`, +1 or -1, is the sense of
    rotation; methods take another `sense` because a coasting machine may turn back.
    """

    def __init__(self, owner, scene, motor, flywheel, engine=None, direction=None):
        flywheel, wrong = checks.single_number("flywheel", flywheel, "kg*m**2", low=0.0)
        checks.require(
            owner,
            scene_problem(scene),
            None if isinstance(motor, Motor | None) else f"motor must be a Motor, got {checks.shown(motor)}",
            wrong,
            None if engine is None else checks.choice("engine", engine, ("compiled", "numpy")),
        )
        checks.require(owner, *_load_problems(scene))
        self.motor = motor
        self.direction = motor.direction if motor is not None else direction or 1.0
        self.flywheel = flywheel + (motor.inertia_at_crank if motor is not None else 0.0)
        self.scene = replace_unchecked(scene, crank_speed=self.direction, crank_acceleration=0.0, sense=self.direction)
        *designs, _ = self.scene.unsolved(np.zeros(1)).shape
        checks.require(owner, f"takes one design at a time, but the scene has shape {(*designs,)}" if designs else None)
        free = replace_unchecked(self.scene, friction=NO_FRICTION)
        self.program = compiled(free, QUANTITIES, parameters=("crank_speed", "sense"), engine=engine or "numpy")
        self._compiled = engine == "compiled"
        self.constant_torque = 0.0
        self.last_forces: list[Any] = []
        self._cached_state: tuple[Any, Any, State] | None = None
        self._require_no_acceleration(owner)

    @property
    def period(self):
        """Crank angle after which motion and loads repeat, rad."""
        return self.scene.period

    @property
    def turns(self):
        return round(self.period / TURN)

    @property
    def by_speed(self):
        """Whether load or friction torque depends on the speed."""
        return self.loads_by_speed

    @property
    def smooth_by_speed(self):
        """Whether that dependence is certainly smooth."""
        return False

    @cached_property
    def loads_by_speed(self):
        """Whether the torque of the loads depends on the speed."""
        return self.program.depends_on("crank_speed") or any(
            title_of(one) in self.program.unrecorded and "crank_speed" in inputs for one, inputs in self._function_loads
        )

    @cached_property
    def loads_by_sense(self):
        """Whether the torque of the loads depends on the sense of rotation, or on the speed."""
        by_function = any("sense" in inputs for _, inputs in self._function_loads)
        return by_function or self.loads_by_speed or self.program.depends_on("sense")

    @cached_property
    def _function_loads(self):
        """Load functions, each with the inputs of the crank's drive that it reads somewhere in the period."""
        motion = self.scene.unsolved(np.linspace(0.0, self.period, LOAD_PROBE_ANGLES, endpoint=False))
        functions = [
            item for item in self.scene.loads if not has_no_user_code(item) and not isinstance(value_of(item), Table)
        ]
        with np.errstate(all="ignore"):
            return [(item, drive_dependence(item, motion)) for item in functions]

    @cached_property
    def kinks(self):
        """Crank angles in (0, period) at which load tables have kinks, rad."""
        found, motion = [np.zeros(0)], self.scene.unsolved(np.zeros(1))
        for part in kink_sources(self.scene.loads):
            repeats = np.arange(0.0, self.period - ANGLE_TOLERANCE, period_on(part, self.scene.mechanism))[:, None]
            found.append(np.ravel(np.concatenate(kinks_of(part, motion)) + repeats))
        return distinct_angles(np.concatenate(found), self.period)

    def at(self, angle, speed=None) -> State:
        """State at crank angles; `speed` counts where loads or friction depend on it."""
        return self.without_friction(angle, speed)

    def at_constant_speed(self, angle, speed) -> State:
        """State at crank angles and speeds without acceleration."""
        return self.at_acceleration(angle, speed, 0.0)

    def at_acceleration(self, angle, speed, acceleration) -> State:
        """State at given crank angles, speeds and accelerations."""
        return self.at(angle, speed)

    @property
    def jumps(self):
        """Crank angles in [0, period) at which friction torque jumps, rad, exact."""
        return np.empty(0)

    def without_friction(self, angle, speed=None, sense=None) -> State:
        """State without friction; the last one is cached where loads do not depend on the speed."""
        cached = self._cached_state
        if cached and cached[0] is angle and cached[1] is sense and not self.loads_by_speed:
            return cached[2]
        found = self._require_finite(angle, State(*self._values(angle, speed, sense)))
        self._cached_state = angle, sense, found
        return found

    def balance(self, angle, speed, sense=None):
        """Total inertia, its slope, and motor torque less load torque at one crank angle and speed, as floats."""
        sense = sense or (math.copysign(1.0, speed) if speed else self.direction)
        values = self._drive_values(clip_at_standstill(speed, sense), sense)
        found = self.program.unlooked(angle, values, self._compiled)
        inertia, slope, load = float(found[INERTIA]), float(found[SLOPE]), float(found[TORQUE])
        return self.flywheel + inertia, slope, float(self.motor_torque(speed)) - load

    def prepare(self, speed):
        """Settle the passes of the friction program for speeds from 0 to `speed`."""

    def senses_ahead(self, angle, sense):
        """Senses just ahead of a crank angle in [0, period], and the next angle at which one changes."""
        return {"sense": sense}, sense * math.inf

    def balance_along(self, angle, speed, senses):
        """`balance` and the friction torque, with the senses of `senses_ahead`; sets `last_forces`, see `forces_at`."""
        return *DrivenMachine.balance(self, angle, speed, senses["sense"]), 0.0

    def inertia_at(self, angle):
        """Total inertia at one crank angle, kg m2, as a float."""
        return DrivenMachine.balance(self, angle, self.direction)[0]

    def forces_in_running(self, angle, speed):
        """Rows over the crank angles, zero where friction has a kink, at the acceleration that follows."""
        return []

    def forces_at(self, angle, speed, acceleration):
        """The same at given accelerations."""
        return []

    def torque_by_speed(self, angle, speed, torque):
        """Derivative by the crank speed of `torque`, the load and friction torque there, N m s."""
        if not self.loads_by_speed:
            return 0.0
        shape = angle.shape
        try:
            found = self.program.derivatives(angle.reshape(-1, 1), "crank_speed", {"crank_speed": speed.reshape(-1, 1)})
            return found[TORQUE]["crank_speed"].reshape(shape)
        except NotGivenError:
            step = RELATIVE_SPEED_STEP * np.abs(speed).max()
            return (self._values(angle, speed + step)[2] - torque) / step

    def inertia(self, angle):
        """Total inertia, kg m2."""
        speed = np.full(np.shape(angle), self.direction) if self.loads_by_speed else None
        return self.flywheel + self.without_friction(angle, speed).inertia

    def motor_torque(self, speed):
        """Torque of the motor on the crank, N m; without motor `constant_torque`."""
        return 0.0 * speed + self.constant_torque if self.motor is None else self.motor.torque_at_crank(speed)

    def _accelerating_torque(self, state, speed):
        return self.motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope

    def acceleration_along(self, angle, speed, sense):
        """Crank acceleration at crank angles, speeds and senses of a motion that may turn back, rad/s2."""
        state = self.without_friction(angle, speed, sense)
        return self._accelerating_torque(state, speed) / (self.flywheel + state.inertia)

    def torque_at_rest(self, angle, sense):
        """Net torque on a crank at rest, about to start in a sense, and the friction torque in it, N m."""
        return DrivenMachine.balance(self, angle, 0.0, sense)[2], 0.0

    def _drive_values(self, speed, sense):
        """Program inputs that differ from the scene's: speeds and senses that the loads depend on."""
        if self.loads_by_speed:
            return {"crank_speed": speed, "sense": sense}
        if self.loads_by_sense and np.any(sense != self.direction):
            return {"crank_speed": sense, "sense": sense}
        return {}

    def _values(self, angle, speed, sense=None):
        angle = np.asarray(angle, dtype=float)
        values = self._drive_values(speed, self.direction if sense is None else sense)
        if not values:
            found = self.program.evaluated(angle)
            return tuple(found[name] for name in QUANTITIES)
        columns = {name: np.broadcast_to(np.asarray(value, dtype=float), angle.shape) for name, value in values.items()}
        columns = {name: value.reshape(-1, 1) for name, value in columns.items()}
        found = self.program.unlooked(angle.reshape(-1, 1), columns, self._compiled)
        *scalars, closure = (np.reshape(found[name], (-1, *angle.shape)) for name in QUANTITIES)
        return *(part[0] for part in scalars), closure

    def _require_finite(self, angle, state):
        """The state if it is finite; otherwise raise the error of `solve` at these crank angles."""
        finite = np.isfinite(state.torque).all() and np.isfinite(state.inertia).all()
        if not (finite and state.closure.min(initial=0.0) >= 0.0):
            try:
                self.scene.solve(np.ravel(angle))
            except AssemblyError as error:
                raise AssemblyError(error.condition, error.intervals, ": a drive turns the crank all round") from None
        if not finite:
            raise DriveError(f"{self.scene.mechanism.name}: the loads have no finite torque at some crank angles")
        return state

    def _require_no_acceleration(self, owner):
        if all(map(has_no_user_code, self.scene.loads)):
            return
        angle = np.linspace(0.1, self.period, 7)
        calm, hasty = (
            replace_unchecked(self.scene, crank_acceleration=alpha).solve(angle, on_gap="nan").load_torque
            for alpha in (0.0, 1e3)
        )
        if any("crank_acceleration" in inputs for _, inputs in self._function_loads) or not np.array_equal(
            calm, hasty, equal_nan=True
        ):
            checks.require(
                owner,
                "a load is a function that depends on the crank acceleration, which follows from the loads; let it "
                "depend on angle, position and velocity alone",
            )


def clip_at_standstill(speed, sense):
    """Speeds against the sense become 0: a step may end beyond a standstill, where loads continue smoothly."""
    forward = sense * speed
    return sense * (max(forward, 0.0) if isinstance(forward, float) else np.maximum(forward, 0.0))


def distinct_angles(angles, period):
    """Distinct crank angles in (0, period), rising, rad."""
    angles = np.unique(np.mod(angles, period))
    return angles[(np.diff(angles, prepend=0.0) > ANGLE_TOLERANCE) & (angles < period - ANGLE_TOLERANCE)]


def _load_problems(scene):
    """Sentences about loads that are unknown at some crank angles."""
    for item in scene.loads:
        value = value_of(item)
        if np.ndim(value) and not callable(value) and np.shape(value)[-1] > 1:
            yield (
                f"{type(item).__name__} is a table over the crank angles given, unknown between them; use a constant, "
                "a table by crank angle or a function of the motion"
            )


def driven_machine(owner, scene, motor, flywheel, engine=None, direction=None) -> DrivenMachine:
    """A scene as one degree of freedom, with friction or without."""
    friction = getattr(scene, "friction", None)
    kind = DrivenMachineWithFriction if friction and friction.acting else DrivenMachine
    return kind(owner, scene, motor, flywheel, engine, direction)


class DrivenMachineWithFriction(DrivenMachine):
    """A scene with friction as one degree of freedom; the crank turns in `direction` unless a sense is given."""

    def __init__(self, owner, scene, motor, flywheel, engine=None, direction=None):
        super().__init__(owner, scene, motor, flywheel, engine, direction)
        self.senses = Senses.of(self.scene)
        self._engine = engine
        rubs = tuple(replace_unchecked(rub, sense=1.0) for rub in self.scene.friction.rubs)
        self._friction_scene = replace_unchecked(self.scene, friction=replace_unchecked(self.scene.friction, rubs=rubs))
        self._has_load_functions = not all(map(has_no_user_code, self.scene.loads))
        self._single_by_loop = engine == "compiled" or (engine is None and numba_available())
        self._last_solution: tuple[Any, ...] = (None,)
        self._last_solution_at_angle: Any = ()

    @property
    def by_speed(self):
        return True

    @property
    def smooth_by_speed(self):
        return not self.loads_by_speed

    @cached_property
    def kinks(self):
        """Crank angles in (0, period) at which loads have kinks or friction jumps, rad."""
        return distinct_angles(np.concatenate([super().kinks, self.senses.all_edges]), self.period)

    @property
    def jumps(self):
        return self.senses.all_edges

    @cached_property
    def _program(self):
        """Friction torque, its checks, and the forces and couples in `_friction_pairs`."""
        forces = [
            name
            for force, couple, half in self._friction_pairs
            for name in ([force] if half is None else [force, couple])
        ]
        outputs, varied = (*FRICTION_OUTPUTS, *dict.fromkeys(forces)), ("crank_speed", "crank_acceleration")
        return compiled(self._friction_scene, outputs, parameters=varied, engine=self._engine or "numpy")

    @cached_property
    def _friction_pairs(self):
        """Force, couple and half length of joints whose friction has a kink where these vanish or are equal."""
        pairs, acting = self.scene.mechanism.pairs, self.scene.friction.acting
        rolling = [(pairs[name].force, None, None) for name in acting if isinstance(pairs[name], Rolling)]
        sliding = [name for name in acting if isinstance(pairs[name], Sliding)]
        return rolling + [(pairs[name].force, pairs[name].couple, acting[name].half_length) for name in sliding]

    def friction_outputs(self, angle, speed, acceleration, senses):
        """Outputs of the friction program at crank angles, speeds and accelerations of one shape."""
        shape = np.shape(angle)
        if self._has_load_functions:
            speed = clip_at_standstill(speed, senses["sense"])
        given = {"crank_speed": speed, "crank_acceleration": acceleration} | senses
        if not shape:
            found = self._program.unlooked(float(angle), given, self._single_by_loop)
            return {name: float(value) for name, value in found.items()}
        columns = {path: np.broadcast_to(value, shape).reshape(-1, 1) for path, value in given.items()}
        rows = self._program.unlooked(np.reshape(angle, (-1, 1)), columns, self._engine == "compiled")
        return {name: value.reshape(shape) for name, value in rows.items()}

    def at(self, angle, speed=None) -> State:
        state = self.without_friction(angle, speed)
        friction, _ = self.friction_and_acceleration(angle, speed, state)
        return state._replace(torque=state.torque + friction)

    def at_acceleration(self, angle, speed, acceleration) -> State:
        state = self.without_friction(angle, speed)
        parts = [part.ravel() for part in np.broadcast_arrays(angle, speed, acceleration)]
        starts = range(0, parts[0].size, BLOCK_SIZE)
        blocks = [self._converged_outputs(*(part[start : start + BLOCK_SIZE] for part in parts)) for start in starts]
        friction = np.concatenate([block[FRICTION] for block in blocks])
        return state._replace(torque=state.torque + friction.reshape(state.torque.shape))

    def balance(self, angle, speed, sense=None):
        senses = {name: float(sign) for name, sign in self.senses.at(angle, sense or self.direction).items()}
        return self.balance_along(angle, speed, senses)[:3]

    def senses_ahead(self, angle, sense):
        return self.senses.stretch(angle, sense)

    def balance_along(self, angle, speed, senses):
        inertia, slope, spare = super().balance(angle, speed, senses["sense"])
        friction, *self._last_solution_at_angle = self._solve_at_angle(
            lambda acceleration: self.friction_outputs(angle, speed, acceleration, senses),
            angle,
            speed,
            inertia,
            spare - 0.5 * speed * speed * slope,
            *self._last_solution_at_angle,
        )
        return inertia, slope, spare - friction, friction

    def torque_at_rest(self, angle, sense):
        senses, _ = self.senses.stretch(angle % self.period, sense)
        friction = self.friction_outputs(angle, 0.0, 0.0, senses)[FRICTION]
        return super().balance(angle, 0.0, sense)[2] - friction, friction

    def prepare(self, speed):
        angle = np.linspace(0.0, self.period, PREPARED_ANGLES, endpoint=False) + 0.5 * self.period / PREPARED_ANGLES
        for part in (0.0, 0.5, 1.0):
            self._converged_outputs(angle, np.full(PREPARED_ANGLES, self.direction * part * speed), 0.0)

    def acceleration_along(self, angle, speed, sense):
        state, senses = self.without_friction(angle, speed, sense), self.senses.at(angle, sense)
        rest = self._accelerating_torque(state, speed)
        return self._solve_acceleration(angle, speed, senses, self.flywheel + state.inertia, rest)[1]

    def friction_and_acceleration(self, angle, speed, state):
        """Friction torque and crank acceleration at crank angles and speeds, from the state without friction."""
        rest = self._accelerating_torque(state, speed)
        guess = self._last_solution[1:] if self._last_solution[0] is angle else ()
        inertia = self.flywheel + state.inertia
        friction, acceleration, slope = self._solve_acceleration(angle, speed, None, inertia, rest, *guess)
        self._last_solution = angle, acceleration, slope
        return friction, acceleration

    def forces_in_running(self, angle, speed):
        if not self._friction_pairs:
            return []
        state = self.without_friction(angle, speed)
        return self.forces_at(angle, speed, self.friction_and_acceleration(angle, speed, state)[1])

    def forces_at(self, angle, speed, acceleration):
        if not self._friction_pairs:
            return []
        return self._kink_values(self._converged_outputs(angle, speed, acceleration))

    def torque_by_speed(self, angle, speed, torque):
        """Derivative by the crank speed, with the acceleration that follows from the speed."""
        _, acceleration, by_acceleration = self._last_solution
        state, step = self.without_friction(angle, speed), RELATIVE_SPEED_STEP * np.abs(speed).max()
        changed = self._converged_outputs(angle, speed + step, acceleration)[FRICTION]
        own = super().torque_by_speed(angle, speed, state.torque) + (changed - torque + state.torque) / step
        drive = 0.0 if self.motor is None else self.motor.slope_at_crank(speed)
        rising = (drive - own - speed * state.slope) / (self.flywheel + state.inertia + by_acceleration)
        return own + by_acceleration * rising

    def _converged_outputs(self, angle, speed, acceleration, senses=None):
        """Outputs of the friction program after as many passes as it needs."""
        senses = self.senses.at(angle, self.direction) if senses is None else senses
        found: dict[str, Any] = {}

        def evaluate(scene):
            if scene is not self._friction_scene:
                self._friction_scene = scene
                del self._program
            found.update(self.friction_outputs(angle, speed, acceleration, senses))
            if not np.isfinite(found[FRICTION]).all():
                require_free(self.scene.solve(np.ravel(angle), on_gap="nan"), "drive")
            return [found[name] for name in CHECKS]

        solve_friction(self._friction_scene, evaluate)
        return found

    def _solve_acceleration(self, angle, speed, senses, inertia, rest, acceleration=None, slope=0.0):
        """Friction torque Tf, acceleration a and dTf/da with Tf(a) + inertia a = rest, by the secant rule."""

        def friction_at(acceleration, place=...):
            own = None if senses is None else {name: _at_places(sense, place) for name, sense in senses.items()}
            angles, speeds = _at_places(angle, place), _at_places(speed, place)
            return self._converged_outputs(angles, speeds, acceleration, own)[FRICTION]

        acceleration = rest / inertia if acceleration is None else acceleration
        friction = friction_at(acceleration)
        for _ in range(MAX_SECANT_STEPS):
            step = (rest - friction - inertia * acceleration) / (inertia + slope)
            size = np.max(np.abs(rest)) + np.max(np.abs(friction))
            new = acceleration + step
            found = friction_at(new)
            change = found - friction
            known = np.abs(change) > MIN_FRICTION_CHANGE * size
            with np.errstate(divide="ignore", invalid="ignore"):
                slope = np.where(known, change / step, slope)
            acceleration, friction = new, found
            left = (rest - friction - inertia * acceleration) / (inertia + slope)
            doubt = np.where(
                known, np.abs(slope * left) / FRICTION_TOLERANCE, np.abs(inertia * left) / TORQUE_TOLERANCE
            )
            converged = (doubt <= size) & (inertia + slope > 0.0)
            if converged.all():
                return friction + slope * left, acceleration + left, slope
        place = np.nonzero(~converged)
        friction, acceleration, slope = friction + slope * left, acceleration + left, slope + 0.0 * left
        friction[place], acceleration[place], slope[place] = self._bracket_acceleration(
            lambda acceleration, some: friction_at(acceleration, tuple(row[some] for row in place)),
            *(_at_places(part, place) for part in (angle, speed, inertia, rest)),
        )
        return friction, acceleration, slope

    def _solve_at_angle(self, values_at, angle, speed, inertia, rest, acceleration=None, slope=0.0):
        """`_solve_acceleration` at one crank angle, in floats; `values_at(a)` returns all outputs of the program."""
        acceleration = rest / inertia if acceleration is None else acceleration
        friction = values_at(acceleration)[FRICTION]
        size = abs(rest) + abs(friction)
        for _ in range(MAX_SECANT_STEPS):
            step = (rest - friction - inertia * acceleration) / (inertia + slope)
            acceleration += step
            found = values_at(acceleration)
            change, friction = found[FRICTION] - friction, found[FRICTION]
            known = abs(change) > MIN_FRICTION_CHANGE * size
            if known:
                slope = change / step
            left = (rest - friction - inertia * acceleration) / (inertia + slope)
            doubt = abs(slope * left) / FRICTION_TOLERANCE if known else abs(inertia * left) / TORQUE_TOLERANCE
            if not (doubt > size or inertia + slope <= 0.0):  # also where friction is NaN
                self.last_forces = self._kink_values(found)
                return friction + slope * left, acceleration + left, slope

        def friction_at(accelerations, _):
            return np.array([values_at(float(one))[FRICTION] for one in accelerations])

        rows = self._bracket_acceleration(friction_at, *(np.array([part]) for part in (angle, speed, inertia, rest)))
        friction, acceleration, slope = (float(row[0]) for row in rows)
        self.last_forces = self._kink_values(values_at(acceleration))
        return friction, acceleration, slope

    def _bracket_acceleration(self, friction_at, angle, speed, inertia, rest):
        """`_solve_acceleration` by bracketing, which converges across kinks of friction.

        `friction_at(acceleration, place)` returns the friction torque (n,) at the crank angles of index `place`.
        Friction resists the motion, so the root lies beyond `rest / inertia`, the acceleration without friction, on
        the side to which friction points there.
        """
        every = np.arange(rest.size)
        start = rest / inertia
        first = friction_at(start, every)
        reach, jams = -0.5 * first / inertia, first != 0.0
        for _ in range(MAX_DOUBLINGS):
            reach = np.where(jams, 2.0 * reach, reach)
            friction = friction_at(start + reach, every)
            jams = np.sign(friction + inertia * reach) * np.sign(first) > 0.0
            if not jams.any():
                break
        else:
            self._refuse_jam(angle, speed, inertia, np.divide(first - friction, reach, where=jams, out=0.0 * reach))

        def left(share, place):
            return friction_at(start[place] + share * reach[place], place) + inertia[place] * share * reach[place]

        share = find_roots(left, 0.0 * rest, 0.0 * rest + 1.0, BRACKET_TOLERANCE)
        acceleration = start + share * reach
        friction = friction_at(acceleration, every)
        with np.errstate(invalid="ignore"):
            slope = np.where(share * reach != 0.0, (friction - first) / (share * reach), 0.0)
        return friction, acceleration, slope

    def _refuse_jam(self, angle, speed, inertia, growth):
        """Raise: friction grows with the deceleration faster than the inertia torque."""
        worst = int(np.argmax(growth - inertia))
        degrees = math.degrees(angle[worst] % self.period)
        raise DriveError(
            f"{self.scene.mechanism.name}: friction jams at crank angle {degrees:.6g} deg and "
            f"{speed[worst]:.6g} rad/s: each rad/s2 of deceleration adds {growth[worst]:.6g} N m of friction torque, "
            f"but frees only {inertia[worst]:.6g} N m of inertia torque, so no acceleration balances them; give a "
            f"flywheel of {growth[worst] - inertia[worst]:.3g} kg m2 or more in addition, or lower "
            "coefficients of friction",
            crank_angle=float(angle[worst]),
        )

    def _kink_values(self, found):
        rows = []
        for force, couple, half in self._friction_pairs:
            if half is None:
                rows += kink_functions("size", (found[force],))
            else:
                rows += kink_functions("larger", (found[force], found[couple] / half))
        return rows


def _at_places(values, place):
    """Values at indices; a number holds at every index."""
    return values[place] if np.ndim(values) else values
