"""A scene as one degree of freedom: reduced inertia and load torque by crank angle and speed.

    (J + Jf) alpha + J' omega^2 / 2 + load torque(phi, omega) + friction torque(phi, omega, alpha) = motor torque

J is the reduced inertia of the links in kg m2, Jf the flywheel with the motor's rotor; torques in N m are positive
counter-clockwise. Loads may depend on the crank angle and speed, not on the acceleration. Friction depends on alpha:
the secant rule solves for it at each crank angle, or a bracketing search where a kink of friction stops the secant
rule. Friction torque comes from the scene's own program at the true alpha. The senses of motion of the joints are
known beforehand (`slip_direction`), so friction is smooth between the angles at which one changes.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..cycle.kinks import declared_kinks
from ..cycle.load_functions import repeating_problem, samples_of_functions, undeclared_functions, undeclared_jumps
from ..errors import AssemblyError, DriveError, NotGivenError
from ..machine.friction import NO_FRICTION
from ..machine.links import Rolling, Sliding
from ..machine.loads import Table, has_no_user_code, value_of
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
from .slip_direction import SlipDirections

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
"""Change of the friction torque, relative to all torques, below which the secant rule ends."""
TORQUE_TOLERANCE = 1e-14
"""Unbalanced torque, relative to all torques, below which it ends if friction does not depend on acceleration."""
MIN_FRICTION_CHANGE = 1e-9
"""Change of the friction torque, relative to all torques, above which a secant is meaningful."""
MAX_DOUBLINGS = 50
"""Doublings of the acceleration bracket before friction counts as jamming."""
BRACKET_TOLERANCE = 1e-16
"""Error of an acceleration relative to its bracket."""
ANGLE_AHEAD = 1e-9
"""Crank angle, rad, ahead of a crank at rest at which the senses of motion are evaluated."""
FORCE_ROUNDING = 1e-9
"""Force of a joint, relative to the largest of those that friction depends on, below which its sign is rounding."""
BLOCK_SIZE = 4096
"""Number of crank angles in one call of the friction program."""


class State(NamedTuple):
    """Reduced inertia (kg m2), its slope (kg m2/rad), load torque (N m) and closure at crank angles."""

    inertia: np.ndarray
    slope: np.ndarray
    torque: np.ndarray
    closure: np.ndarray


class DrivenMachine:
    """A scene as one degree of freedom; `flywheel` is the inertia on the crank without the links.

    The scene's crank speed has no effect. `direction`, +1 or -1, is the sense of rotation, by default that of the
    motor; `along` returns the machine that turns the other way.
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
        self.direction = direction or (1.0 if motor is None else motor.direction)
        self._made = owner, scene, motor, flywheel, engine
        self.flywheel = flywheel + (motor.inertia_at_crank if motor is not None else 0.0)
        self.scene = replace_unchecked(scene, crank_speed=self.direction, crank_acceleration=0.0, sense=self.direction)
        *designs, _ = self.scene.unsolved(np.zeros(1)).shape
        checks.require(owner, f"works on one design at a time, got a scene of shape {(*designs,)}" if designs else None)
        self.period = self.scene.period
        free = replace_unchecked(self.scene, friction=NO_FRICTION)
        self.program = compiled(free, QUANTITIES, parameters=("crank_speed", "sense"), engine=engine or "numpy")
        checks.require(owner, repeating_problem(self.scene.unsolved(np.zeros(1))))  # of pure functions
        self._engine, self._compiled = engine, engine == "compiled"
        self.constant_torque, self.functions = 0.0, []
        self._cached_state: tuple[Any, State] | None = None
        if any("crank_acceleration" in inputs for _, inputs in self._function_loads):
            checks.require(
                owner,
                "a load is a function that depends on the crank acceleration, which follows from the loads; let it "
                "depend only on angle, position and velocity",
            )
        self._slip: Any = SlipDirections.of(self.scene) if self.scene.friction.acting else None
        if self._slip is not None:
            by_joint = tuple(replace_unchecked(item, sense=1.0) for item in self.scene.friction.by_joint)
            friction = replace_unchecked(self.scene.friction, by_joint=by_joint)
            self._friction_scene = replace_unchecked(self.scene, friction=friction)
            self._last_solution: tuple[Any, ...] = (None,)
            self._last_senses: tuple[Any, ...] = (None,)
            self._last_outputs: dict[str, Any] = {}

    @cached_property
    def _reversed(self):
        found = DrivenMachine(*self._made, -self.direction)
        found._reversed = self
        return found

    def along(self, sense):
        """The machine that turns in a sense, +1 or -1."""
        return self if sense == self.direction else self._reversed

    @property
    def by_speed(self):
        """Whether load or friction torque depends on the speed."""
        return self._slip is not None or self.loads_by_speed

    @property
    def smooth_by_speed(self):
        """Whether the torque depends on the speed, but only smoothly, by friction."""
        return self._slip is not None and not self.loads_by_speed

    @cached_property
    def loads_by_speed(self):
        """Whether the torque of the loads depends on the speed."""
        return self.program.depends_on("crank_speed") or any(
            title_of(one) in self.program.unrecorded and "crank_speed" in inputs for one, inputs in self._function_loads
        )

    @cached_property
    def _function_loads(self):
        """Load functions, each with the inputs of the crank's drive that it uses in the period."""
        if all(map(has_no_user_code, self.scene.loads)):
            return []
        motion = self.scene.unsolved(np.linspace(0.0, self.period, LOAD_PROBE_ANGLES, endpoint=False))
        functions = [
            item for item in self.scene.loads if not has_no_user_code(item) and not isinstance(value_of(item), Table)
        ]
        with np.errstate(all="ignore"):
            return [(item, drive_dependence(item, motion)) for item in functions]

    @cached_property
    def kinks(self):
        """Crank angles in (0, period) at which loads have or may have kinks, or friction jumps, rad."""
        return self._kinks_at(self.direction)

    def locate_kinks(self, speed):
        """Locate the kinks of loads at a crank speed, rad/s; afterwards `kinks` returns them.

        `functions` are samples of the load functions without `kinks` there.
        """
        if self.loads_by_speed or undeclared_functions(self.scene.loads):
            self.kinks = self._kinks_at(speed)

    def require_fixed_kinks(self):
        """Refuse loads whose declared kinks move with the crank speed: a motion cannot locate them."""
        if not self.loads_by_speed:
            return
        slow, fast = (
            declared_kinks(replace_unchecked(self.scene, crank_speed=speed * self.direction).unsolved(np.zeros(1)))[0]
            for speed in (1.0, 10.0)
        )
        if slow.size != fast.size or np.any(np.abs(slow - fast) > ANGLE_TOLERANCE):
            raise DriveError(
                f"{self.scene.mechanism.name}: a load declares `kinks` that move with the crank speed, so a motion "
                "cannot locate them. Leave `kinks` out to have the function sampled, or let them depend on the "
                "crank angle alone"
            )

    def _kinks_at(self, speed):
        kinks, self.functions = load_kinks(replace_unchecked(self.scene, crank_speed=speed))
        angles = [kinks] if self._slip is None else [kinks, self._slip.all_edges]
        if self.functions:

            def torque(angle):
                return self.without_friction(angle, np.full(angle.shape, speed)).torque

            places = np.append(kinks, kinks[:1] + self.period)
            angles.append(undeclared_jumps(torque, places, self.scene.resolution))
        return _distinct_angles(np.concatenate(angles), self.period)

    def at(self, angle, speed=None, near=None) -> State:
        """State at crank angles; `speed` matters if loads or friction depend on it.

        `near` are the acceleration and the slope of `motion_with_friction` at nearly this speed: with them friction is
        linear in the acceleration.
        """
        state = self.without_friction(angle, speed)
        if self._slip is None:
            return state
        return state._replace(torque=state.torque + self._solve_friction(angle, speed, state, near)[0])

    @property
    def motion_with_friction(self):
        """Acceleration, and slope of friction by it, that friction was last solved for; None without friction."""
        return None if self._slip is None else self._last_solution[1:]

    def at_acceleration(self, angle, speed, acceleration) -> State:
        """State at given crank angles, speeds and accelerations."""
        state = self.without_friction(angle, speed)
        if self._slip is None:
            return state
        parts = [part.ravel() for part in np.broadcast_arrays(angle, speed, acceleration)]
        starts = range(0, parts[0].size, BLOCK_SIZE)
        blocks = [self._converged_outputs(*(part[start : start + BLOCK_SIZE] for part in parts)) for start in starts]
        friction = np.concatenate([block[FRICTION] for block in blocks])
        return state._replace(torque=state.torque + friction.reshape(state.torque.shape))

    def without_friction(self, angle, speed=None) -> State:
        """State without friction; the last one is cached, for its inertia alone where loads depend on the speed.

        Raises the error of `solve` at the crank angles where the state is not finite.
        """
        cached = self._cached_state
        if cached and cached[0] is angle and not self.loads_by_speed:
            return cached[1]
        state = State(*self._values(angle, speed))
        finite = np.isfinite(state.torque).all() and np.isfinite(state.inertia).all()
        if not (finite and state.closure.min(initial=0.0) >= 0.0):
            try:
                self.scene.solve(np.ravel(angle))
            except AssemblyError as error:
                raise AssemblyError(error.condition, error.intervals, ": a drive turns the crank all round") from None
        if not finite:
            raise DriveError(f"{self.scene.mechanism.name}: the loads have no finite torque at some crank angles")
        self._cached_state = angle, state
        return state

    def balance(self, angle, speed):
        """Total inertia, its slope, and motor torque less load torque without friction at one place, as floats."""
        machine = self.along(math.copysign(1.0, speed)) if speed else self
        values = {"crank_speed": speed, "sense": machine.direction} if self.loads_by_speed else {}
        found = machine.program.unlooked(angle, values, self._compiled)
        inertia, slope, load = float(found[INERTIA]), float(found[SLOPE]), float(found[TORQUE])
        return self.flywheel + inertia, slope, float(self.motor_torque(speed)) - load

    def torque_at(self, angle, speed):
        """Motor torque less load and friction torque at one crank angle and speed, N m."""
        angle, speed = np.array([angle]), np.array([speed])
        return float(self.motor_torque(speed)[0] - self.at(angle, speed).torque[0])

    def torque_at_rest(self, angle):
        """Net torque on a crank at rest, about to start, and the friction torque in it, N m."""
        angle = np.array([angle])
        rest = 0.0 * angle
        spare, friction = float(self.motor_torque(0.0) - self.without_friction(angle, rest).torque[0]), 0.0
        if self._slip is not None:
            senses = self._slip.at(angle + self.direction * ANGLE_AHEAD, self.direction)
            friction = float(self._converged_outputs(angle, rest, rest, senses)[FRICTION][0])
        return spare - friction, friction

    def kink_rows(self, angle, speed, acceleration=None):
        """Rows over the crank angles, zero where friction or the motor's table has a kink.

        By default they are those of the friction last solved, at these angles.
        """
        rows = [] if self.motor is None else [self.motor.transmission * speed - knot for knot in self.motor.knots]
        if self._slip is None or not self._friction_pairs:
            return rows
        if acceleration is not None:
            self._converged_outputs(angle, speed, acceleration)
        return rows + self._kink_values(self._last_outputs)

    def torque_by_speed(self, angle, speed, torque):
        """Derivative by the crank speed of `torque`, the load and friction torque there, N m s.

        With friction the acceleration follows from the speed.
        """
        state = None if self._slip is None else self.without_friction(angle, speed)
        own, step = 0.0, RELATIVE_SPEED_STEP * np.abs(speed).max()
        if self.loads_by_speed:
            columns = {"crank_speed": speed.reshape(-1, 1)}
            try:
                found = self.program.derivatives(angle.reshape(-1, 1), "crank_speed", columns)
                own = found[TORQUE]["crank_speed"].reshape(angle.shape)
            except NotGivenError:
                own = (self._values(angle, speed + step)[2] - (torque if state is None else state.torque)) / step
        if state is None:
            return own
        _, acceleration, by_acceleration = self._last_solution
        changed = self._converged_outputs(angle, speed + step, acceleration)[FRICTION]
        own = own + (changed - torque + state.torque) / step
        rising = (self.motor_slope(speed) - own - speed * state.slope) / (
            self.flywheel + state.inertia + by_acceleration
        )
        return own + by_acceleration * rising

    def inertia(self, angle):
        """Total inertia, kg m2."""
        cached = self._cached_state
        if cached and cached[0] is angle:
            return self.flywheel + cached[1].inertia
        return self.flywheel + self.without_friction(angle, np.full(angle.shape, self.direction)).inertia

    def motor_torque(self, speed):
        """Torque of the motor on the crank, N m; without motor `constant_torque`."""
        return 0.0 * speed + self.constant_torque if self.motor is None else self.motor.torque_at_crank(speed)

    def motor_slope(self, speed):
        """Derivative of the motor's torque on the crank by the crank speed, N m s."""
        return 0.0 if self.motor is None else self.motor.slope_at_crank(speed)

    def _accelerating_torque(self, state, speed):
        return self.motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope

    def acceleration(self, angle, speed):
        """Crank acceleration at crank angles and speeds, rad/s2."""
        state = self.without_friction(angle, speed)
        if self._slip is not None:
            return self._solve_friction(angle, speed, state)[1]
        return self._accelerating_torque(state, speed) / (self.flywheel + state.inertia)

    def _values(self, angle, speed):
        angle = np.asarray(angle, dtype=float)
        if not self.loads_by_speed:
            found = self.program.evaluated(angle)
            return tuple(found[name] for name in QUANTITIES)
        given = {"crank_speed": speed, "sense": self.direction}
        columns = {name: np.broadcast_to(value, angle.shape).reshape(-1, 1) for name, value in given.items()}
        found = self.program.unlooked(angle.reshape(-1, 1), columns, self._compiled)
        *scalars, closure = (np.reshape(found[name], (-1, *angle.shape)) for name in QUANTITIES)
        return *(part[0] for part in scalars), closure

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
        """Force, couple and half length of joints whose friction has a kink where these vanish or are equal.

        A couple that is not a quantity, such as a cam block's, is left out: pieces are halved at its kinks.
        """
        mechanism, acting = self.scene.mechanism, self.scene.friction.acting
        pairs = {name: mechanism.pairs[name] for name in acting}
        rolling = [(pair.force, None, None) for pair in pairs.values() if isinstance(pair, Rolling)]
        sliding = [(name, pair) for name, pair in pairs.items() if isinstance(pair, Sliding)]
        halves = [acting[name].half_length if pair.couple in mechanism.outputs else None for name, pair in sliding]
        return rolling + [(pair.force, pair.couple, half) for (_, pair), half in zip(sliding, halves, strict=True)]

    def _friction_outputs(self, angle, speed, acceleration, senses):
        """Outputs of the friction program at crank angles, speeds and accelerations of one shape."""
        given = {"crank_speed": speed, "crank_acceleration": acceleration} | senses
        columns = {path: value.reshape(-1, 1) for path, value in given.items()}
        rows = self._program.unlooked(angle.reshape(-1, 1), columns, self._compiled)
        return {name: value.reshape(angle.shape) for name, value in rows.items()}

    def _solve_friction(self, angle, speed, state, near=None):
        """Friction torque and crank acceleration at crank angles and speeds, from the state without friction."""
        rest, inertia = self._accelerating_torque(state, speed), self.flywheel + state.inertia
        if near is None:
            guess = self._last_solution[1:] if self._last_solution[0] is angle else ()
            friction, acceleration, slope = self._solve_acceleration(angle, speed, inertia, rest, *guess)
        else:
            acceleration, slope = near
            friction = self._converged_outputs(angle, speed, acceleration)[FRICTION]
            left = (rest - friction - inertia * acceleration) / (inertia + slope)
            friction, acceleration = friction + slope * left, acceleration + left
        self._last_solution = angle, acceleration, slope
        return friction, acceleration

    def _converged_outputs(self, angle, speed, acceleration, senses=None):
        """Outputs of the friction program after as many passes as it needs."""
        if senses is None:
            if self._last_senses[0] is not angle:
                self._last_senses = angle, self._slip.at(angle, self.direction)
            senses = self._last_senses[1]
        found: dict[str, Any] = {}

        def evaluate(scene):
            if scene is not self._friction_scene:
                self._friction_scene = scene
                del self._program
            found.update(self._friction_outputs(angle, speed, acceleration, senses))
            if not np.isfinite(found[FRICTION]).all():
                require_free(self.scene.solve(np.ravel(angle), on_gap="nan"), "drive")
            return [found[name] for name in CHECKS]

        solve_friction(self._friction_scene, evaluate)
        self._last_outputs = found
        return found

    def _solve_acceleration(self, angle, speed, inertia, rest, acceleration=None, slope=0.0):
        """Friction torque Tf, acceleration a and dTf/da with Tf(a) + inertia a = rest, by the secant rule."""

        def friction_at(acceleration):
            return self._converged_outputs(angle, speed, acceleration)[FRICTION]

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
        place = ~converged
        friction, acceleration, slope = friction + slope * left, acceleration + left, slope + 0.0 * left
        friction[place], acceleration[place], slope[place] = self._bracket_acceleration(
            *(part[place] for part in (angle, speed, inertia, rest))
        )
        return friction, acceleration, slope

    def _bracket_acceleration(self, angle, speed, inertia, rest):
        """`_solve_acceleration` by bracketing, which converges across kinks of friction.

        Friction resists the motion, so the root lies beyond `rest / inertia`, the acceleration without friction, on
        the side to which friction points there.
        """

        def friction_at(acceleration, place):
            return self._converged_outputs(angle[place], speed[place], acceleration)[FRICTION]

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
            growth = np.divide(first - friction, reach, where=jams, out=0.0 * reach)
            worst = int(np.argmax(growth - inertia))
            raise DriveError(
                f"{self.scene.mechanism.name}: friction jams at crank angle "
                f"{math.degrees(angle[worst] % self.period):.6g} deg and {speed[worst]:.6g} rad/s. Each rad/s2 of "
                f"deceleration adds {growth[worst]:.6g} N m of friction torque, but frees only {inertia[worst]:.6g} N "
                "m of inertia torque, so no acceleration balances them. Give a flywheel of "
                f"{growth[worst] - inertia[worst]:.3g} kg m2 or more in addition, or lower coefficients of friction",
                crank_angle=float(angle[worst]),
            )

        def left(share, place):
            return friction_at(start[place] + share * reach[place], place) + inertia[place] * share * reach[place]

        share = find_roots(left, 0.0 * rest, 0.0 * rest + 1.0, BRACKET_TOLERANCE)
        acceleration = start + share * reach
        friction = friction_at(acceleration, every)
        with np.errstate(invalid="ignore"):
            slope = np.where(share * reach != 0.0, (friction - first) / (share * reach), 0.0)
        return friction, acceleration, slope

    def _kink_values(self, found):
        rows = []
        for force, couple, half in self._friction_pairs:
            if half is None:
                rows += kink_functions("size", (found[force],))
            else:
                rows += kink_functions("larger", (found[force], found[couple] / half))
        noise = FORCE_ROUNDING * np.max([np.abs(row).max() for row in rows])
        return [np.where(np.abs(row) > noise, row, 0.0) for row in rows]


def load_kinks(scene):
    """Crank angles over the period of all kinks of loads and laws of cams, and samples of functions without `kinks`."""
    motion = replace_unchecked(scene, friction=NO_FRICTION).unsolved(np.zeros(1))
    functions = samples_of_functions(motion)
    rough = [function.rough_places.ravel() for function in functions]
    return np.unique(np.concatenate([declared_kinks(motion)[0], *rough])), functions


def _distinct_angles(angles, period):
    """Distinct crank angles in (0, period), rising, rad."""
    angles = np.unique(np.mod(angles, period))
    return angles[(np.diff(angles, prepend=0.0) > ANGLE_TOLERANCE) & (angles < period - ANGLE_TOLERANCE)]


def _load_problems(scene):
    """Sentences about loads that are unknown at some crank angles."""
    for item in scene.loads:
        value = value_of(item)
        if np.ndim(value) and not callable(value) and np.shape(value)[-1] > 1:
            yield (
                f"{type(item).__name__} is a table over the given crank angles, without values between them; use a "
                "constant, a table by crank angle or a function of the motion"
            )
