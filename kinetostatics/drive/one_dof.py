"""A scene as one degree of freedom: its reduced inertia and the torque that its loads ask, by crank angle and speed.

    (J + Jf) alpha + J' omega^2 / 2 + load torque(phi, omega) = motor torque

Functions as loads may depend on the crank angle and speed, not on the acceleration.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..errors import AssemblyError, DriveError, NotGivenError
from ..machine.friction import NO_FRICTION
from ..machine.loads import TURN, Table, has_no_user_code, kink_sources, kinks_of, period_on, value_of
from ..mechanics.load_values import drive_dependence, title_of
from ..numbers import checks
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import replace_unchecked
from ..solution.program import compile as compiled
from ..solution.scene import scene_problem
from .motor import Motor

INERTIA, SLOPE, TORQUE, CLOSURE = QUANTITIES = ("reduced_inertia", "reduced_inertia_slope", "load_torque", "closure")
ANGLE_TOLERANCE = 1e-12
"""Crank angles this near, rad, are the same."""
LOAD_PROBE_ANGLES = 720
"""Crank angles over the period at which it is looked at what functions read."""
RELATIVE_SPEED_STEP = 1e-6
"""Relative step of speed by which functions that cannot be recorded are differentiated, for the iteration alone."""


class State(NamedTuple):
    """Reduced inertia, its slope, and load torque at crank angles."""

    inertia: np.ndarray
    slope: np.ndarray
    torque: np.ndarray
    closure: np.ndarray


class DrivenMachine:
    """What a scene is to its drive; `flywheel` holds all inertia on the crank besides the links.

    The crank speed of the scene does not matter, but for its sign without a motor. `direction` is that sense of
    rotation, +1 or -1, and that of every motion unless another `sense` is given: a machine that coasts may turn back.
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
        checks.require(owner, _batch_problem(self.scene))
        free = replace_unchecked(self.scene, friction=NO_FRICTION)
        self.program = compiled(free, QUANTITIES, parameters=("crank_speed", "sense"), engine=engine or "numpy")
        self._compiled = engine == "compiled"
        self.torque_given = 0.0
        self._kept: tuple[Any, Any, State] | None = None
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
        """Whether the torque that is asked depends on the speed."""
        return self.loads_by_speed

    @property
    def smooth_by_speed(self):
        """Whether that dependence is known to be smooth."""
        return False

    @cached_property
    def loads_by_speed(self):
        """Whether the torque of the loads depends on the speed."""
        return self.program.depends_on("crank_speed") or any(
            title_of(one) in self.program.unrecorded and "crank_speed" in asked for one, asked in self._asked
        )

    @cached_property
    def loads_by_sense(self):
        """Whether the torque of the loads depends on the sense of rotation, or on the speed."""
        asked = any("sense" in asked for _, asked in self._asked)
        return asked or self.loads_by_speed or self.program.depends_on("sense")

    @cached_property
    def _asked(self):
        """Loads that are functions, each with what of the crank's drive it reads somewhere in the period."""
        motion = self.scene.unsolved(np.linspace(0.0, self.period, LOAD_PROBE_ANGLES, endpoint=False))
        functions = [
            item for item in self.scene.loads if not has_no_user_code(item) and not isinstance(value_of(item), Table)
        ]
        with np.errstate(all="ignore"):
            return [(item, drive_dependence(item, motion)) for item in functions]

    @cached_property
    def kinks(self):
        """Crank angles in (0, period) at which tables of loads have kinks, rad."""
        found, motion = [np.zeros(0)], self.scene.unsolved(np.zeros(1))
        for part in kink_sources(self.scene.loads):
            repeats = np.arange(0.0, self.period - ANGLE_TOLERANCE, period_on(part, self.scene.mechanism))[:, None]
            found.append(np.ravel(np.concatenate(kinks_of(part, motion)) + repeats))
        return distinct_angles(np.concatenate(found), self.period)

    def at(self, angle, speed=None) -> State:
        """State at crank angles, at crank speeds if it depends on them."""
        return self.unrubbed(angle, speed)

    def at_constant_speed(self, angle, speed) -> State:
        """State at crank angles and speeds without acceleration."""
        return self.at_acceleration(angle, speed, 0.0)

    def at_acceleration(self, angle, speed, acceleration) -> State:
        """State at crank angles, speeds and accelerations that are given."""
        return self.at(angle, speed)

    @property
    def jumps(self):
        """Crank angles in [0, period) at which the torque is known to jump, exactly."""
        return np.empty(0)

    def unrubbed(self, angle, speed=None, sense=None) -> State:
        """State without friction; kept for the same angles where loads do not depend on the speed."""
        if self._kept and self._kept[0] is angle and self._kept[1] is sense and not self.loads_by_speed:
            return self._kept[2]
        found = self._checked(angle, State(*self._values(angle, speed, sense)))
        self._kept = angle, sense, found
        return found

    def here(self, angle, speed, sense=None):
        """Inertia with the flywheel, slope of it, and torque left over, at one crank angle and speed, as floats.

        A step may end beyond the standstill that it looks for: loads see no speed there.
        """
        sense = sense or (math.copysign(1.0, speed) if speed else self.direction)
        values = self._given(sense * max(sense * speed, 0.0), sense)
        found = self.program.unlooked(angle, values, self._compiled)
        inertia, slope, load = float(found[INERTIA]), float(found[SLOPE]), float(found[TORQUE])
        return self.flywheel + inertia, slope, float(self.motor_torque(speed)) - load

    def prepare(self, speed):
        """Get ready for motions from standstill to a speed: without friction there is nothing to do."""

    def senses_ahead(self, angle, sense):
        """Senses of all motions just ahead of a crank angle in [0, period], and the next angle where one changes."""
        return {"sense": sense}, sense * math.inf

    def moving(self, angle, speed, senses):
        """What `here` gives, and the friction torque, with the senses of `senses_ahead`."""
        return *DrivenMachine.here(self, angle, speed, senses["sense"]), 0.0

    @property
    def forces_here(self):
        """What `forces_on` gives, as `moving` met it last."""
        return []

    def inertia_here(self, angle):
        """All inertia that the crank feels at one crank angle, kg m2, as a float."""
        return DrivenMachine.here(self, angle, self.direction)[0]

    def forces_on(self, angle, speed):
        """What is zero where the torque has kinks that hang on the motion, each over the crank angles."""
        return []

    def forces_at(self, angle, speed, acceleration):
        """The same with accelerations that are given."""
        return []

    def torque_by_speed(self, angle, speed, torque):
        """Derivative of the torque by the crank speed, for a torque known there."""
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
        """All inertia that the crank feels, kg m2."""
        return self.flywheel + self.unrubbed(angle, self._any_speed(angle)).inertia

    def motor_torque(self, speed):
        """Torque of the motor on the crank, N m; without one that given for it."""
        return 0.0 * speed + self.torque_given if self.motor is None else self.motor.torque_at_crank(speed)

    def acceleration(self, state, speed):
        """Crank acceleration, rad/s2."""
        turning = self.motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope
        return turning / (self.flywheel + state.inertia)

    def acceleration_along(self, angle, speed, sense):
        """Crank acceleration at crank angles, speeds and senses of a motion, which may go either way, rad/s2."""
        return self.acceleration(self.unrubbed(angle, speed, sense), speed)

    def at_rest(self, angle, sense):
        """Torque left over at the crank at rest, about to move one way, and friction in it, N m."""
        return DrivenMachine.here(self, angle, 0.0, sense)[2], 0.0

    def _any_speed(self, angle):
        return np.full(np.shape(angle), self.direction) if self.loads_by_speed else None

    def _given(self, speed, sense):
        """Numbers of the program that differ from its scene's: another sense, and speeds if loads depend on them."""
        if self.loads_by_speed:
            return {"crank_speed": speed, "sense": sense}
        if self.loads_by_sense and np.any(sense != self.direction):
            return {"crank_speed": sense, "sense": sense}
        return {}

    def _values(self, angle, speed, sense=None):
        angle = np.asarray(angle, dtype=float)
        values = self._given(speed, self.direction if sense is None else sense)
        if not values:
            found = self.program.evaluated(angle)
            return tuple(found[name] for name in QUANTITIES)
        columns = {name: np.broadcast_to(np.asarray(value, dtype=float), angle.shape) for name, value in values.items()}
        columns = {name: value.reshape(-1, 1) for name, value in columns.items()}
        found = self.program.unlooked(angle.reshape(-1, 1), columns, self._compiled)
        *scalars, closure = (np.reshape(found[name], (-1, *angle.shape)) for name in QUANTITIES)
        return *(part[0] for part in scalars), closure

    def _checked(self, angle, state):
        """The state, where all of it is finite; else what `solve` says of these crank angles."""
        finite = np.isfinite(state.torque).all() and np.isfinite(state.inertia).all()
        if not (finite and state.closure.min(initial=0.0) >= 0.0):
            self._require_closing(angle)
        if not finite:
            raise DriveError(f"{self.scene.mechanism.name}: the loads have no finite torque at some crank angles")
        return state

    def _require_closing(self, angle):
        """Say where the machine does not close, which no drive turns."""
        try:
            self.scene.solve(np.ravel(angle))
        except AssemblyError as error:
            raise AssemblyError(error.condition, error.intervals, ": a drive turns the crank all round") from None

    def _require_no_acceleration(self, owner):
        if all(map(has_no_user_code, self.scene.loads)):
            return
        angle = np.linspace(0.1, self.period, 7)
        calm, hasty = (
            replace_unchecked(self.scene, crank_acceleration=alpha).solve(angle, on_gap="nan").load_torque
            for alpha in (0.0, 1e3)
        )
        if any("crank_acceleration" in asked for _, asked in self._asked) or not np.array_equal(
            calm, hasty, equal_nan=True
        ):
            checks.require(
                owner,
                "a load is a function that depends on the crank acceleration, which follows from the loads; let it "
                "depend on angle, position and velocity alone",
            )


def distinct_angles(angles, period):
    """Crank angles in (0, period), rising, those that are the same once."""
    angles = np.unique(np.mod(angles, period))
    return angles[(np.diff(angles, prepend=0.0) > ANGLE_TOLERANCE) & (angles < period - ANGLE_TOLERANCE)]


def _load_problems(scene):
    """What keeps loads from being taken at any crank angle, as sentences."""
    for item in scene.loads:
        value = value_of(item)
        if np.ndim(value) and not callable(value) and np.shape(value)[-1] > 1:
            yield (
                f"{type(item).__name__} is a table over the crank angles given, unknown between them; use a constant, "
                "a table by crank angle or a function of the motion"
            )


def _batch_problem(scene):
    *designs, _ = scene.unsolved(np.zeros(1)).shape
    if designs:
        return f"takes one design at a time, but the scene has shape {(*designs,)}"
    return None
