"""A machine whose joints rub as one degree of freedom: its friction depends on the acceleration, and that on friction.

    (J + Jf) alpha + J' omega^2 / 2 + load torque(phi, omega) + friction torque(phi, omega, alpha) = motor torque

is solved for alpha at each crank angle by the secant rule, and between two bounds where a kink of friction keeps that
from converging; friction comes from the scene's own program at the true alpha. Which way each joint moves is known
beforehand (`senses`), so all is smooth between the angles at which that changes.
"""

import math
from functools import cached_property
from typing import Any

import numpy as np

from ..engines.numba_backend import numba_available
from ..errors import DriveError
from ..machine.links import Rolling, Sliding
from ..machine.loads import has_no_user_code
from ..mechanics.friction import kink_functions
from ..mechanics.jamming import require_free, solve_friction
from ..numbers.brackets import find_roots
from ..numbers.parameter_tree import replace_unchecked
from ..solution.program import compile as compiled
from .one_dof import RELATIVE_SPEED_STEP, DrivenMachine, State, distinct_angles
from .senses import Senses

FRICTION, *CHECKS = FRICTION_OUTPUTS = ("friction_torque", "friction_margin", "friction_residual")
MAX_SECANT_STEPS = 30
"""Solves for the acceleration, at most; three or four are enough unless friction nearly jams."""
FRICTION_TOLERANCE = 2e-16
"""Change of the friction torque, relative to all torques, that is rounding."""
MAX_DOUBLINGS = 50
"""Times that the interval in which an acceleration is looked for doubles before friction counts as jamming."""
BRACKET_TOLERANCE = 1e-16
"""Error of an acceleration between two, relative to their distance."""
MIN_FRICTION_CHANGE = 1e-9
"""Change of the friction torque, relative, that tells how it hangs on the acceleration."""
TORQUE_TOLERANCE = 1e-14
"""Torque left over, relative to all torques, that is rounding where the friction torque changes by less than that."""
PREPARED_ANGLES = 180
"""Crank angles around the period at which friction is looked at beforehand."""
BLOCK_SIZE = 4096
"""Crank angles whose friction is computed together."""


def driven_machine(owner, scene, motor, flywheel, engine=None, direction=None) -> DrivenMachine:
    """What a scene is to its drive, with friction or without."""
    friction = getattr(scene, "friction", None)
    kind = DrivenMachineWithFriction if friction and friction.acting else DrivenMachine
    return kind(owner, scene, motor, flywheel, engine, direction)


class DrivenMachineWithFriction(DrivenMachine):
    """What a scene with friction is to its drive, the crank turning in `direction` unless told otherwise."""

    def __init__(self, owner, scene, motor, flywheel, engine=None, direction=None):
        super().__init__(owner, scene, motor, flywheel, engine, direction)
        self.senses = Senses.of(self.scene)
        self._engine = engine
        rubs = tuple(replace_unchecked(rub, sense=1.0) for rub in self.scene.friction.rubs)
        self._solved = replace_unchecked(self.scene, friction=replace_unchecked(self.scene.friction, rubs=rubs))
        self._asks_for_speed = not all(map(has_no_user_code, self.scene.loads))
        self._single_by_loop = engine == "compiled" or (engine is None and numba_available())
        self._guess: tuple[Any, ...] = (None,)
        self._near: Any = ()

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
        kept = "crank_speed", "crank_acceleration"
        return compiled(
            self._solved, (*FRICTION_OUTPUTS, *self._bending), parameters=kept, engine=self._engine or "numpy"
        )

    @cached_property
    def _pressed(self):
        """Force, couple and half length of the joints whose friction has a kink where these vanish or are equal."""
        pairs, acting = self.scene.mechanism.pairs, self.scene.friction.acting
        rolling = [(pairs[name].force, None, None) for name in acting if isinstance(pairs[name], Rolling)]
        sliding = [name for name in acting if isinstance(pairs[name], Sliding)]
        return rolling + [(pairs[name].force, pairs[name].couple, acting[name].half_length) for name in sliding]

    @cached_property
    def _bending(self):
        """Names of these forces and couples."""
        names = [name for force, couple, half in self._pressed for name in (force, *[couple] * (half is not None))]
        return tuple(dict.fromkeys(names))

    def rubbed(self, angle, speed, acceleration, senses):
        """Values of the program of friction at crank angles, speeds and accelerations, all of one shape.

        Tables and functions see a speed against the sense, of a step that ends beyond a standstill, as none; without
        them all goes on smoothly there.
        """
        shape = np.shape(angle)
        if self._asks_for_speed:
            sense = senses["sense"]
            speed = sense * (np.maximum(sense * speed, 0.0) if shape else max(sense * speed, 0.0))
        given = {"crank_speed": speed, "crank_acceleration": acceleration}
        given |= senses
        if not shape:
            found = self._program.unlooked(float(angle), given, self._single_by_loop)
            return {name: float(value) for name, value in found.items()}
        columns = {path: np.broadcast_to(value, shape).reshape(-1, 1) for path, value in given.items()}
        rows = self._program.unlooked(np.reshape(angle, (-1, 1)), columns, self._engine == "compiled")
        return {name: value.reshape(shape) for name, value in rows.items()}

    def at(self, angle, speed=None) -> State:
        state = self.unrubbed(angle, speed)
        friction, _ = self.accelerated(angle, speed, state)
        return state._replace(torque=state.torque + friction)

    def at_acceleration(self, angle, speed, acceleration) -> State:
        state = self.unrubbed(angle, speed)
        parts = [part.ravel() for part in np.broadcast_arrays(angle, speed, acceleration)]
        starts = range(0, parts[0].size, BLOCK_SIZE)
        blocks = [self._looked_at(*(part[start : start + BLOCK_SIZE] for part in parts)) for start in starts]
        friction = np.concatenate([block[FRICTION] for block in blocks])
        return state._replace(torque=state.torque + friction.reshape(state.torque.shape))

    def here(self, angle, speed, sense=None):
        senses = {name: float(sign) for name, sign in self.senses.at(angle, sense or self.direction).items()}
        return self.moving(angle, speed, senses)[:3]

    def senses_ahead(self, angle, sense):
        return self.senses.stretch(angle, sense)

    @property
    def forces_here(self):
        return self.pressed

    def moving(self, angle, speed, senses):
        inertia, slope, spare = super().here(angle, speed, senses["sense"])
        friction, *self._near = self._settled_here(
            lambda acceleration: self.rubbed(angle, speed, acceleration, senses),
            angle,
            speed,
            inertia,
            spare - 0.5 * speed * speed * slope,
            *self._near,
        )
        return inertia, slope, spare - friction, friction

    def at_rest(self, angle, sense):
        senses, _ = self.senses.stretch(angle % self.period, sense)
        friction = self.rubbed(angle, 0.0, 0.0, senses)[FRICTION]
        return super().here(angle, 0.0, sense)[2] - friction, friction

    def prepare(self, speed):
        """Take as many passes over friction as it takes around the period, from standstill to a speed."""
        angle = np.linspace(0.0, self.period, PREPARED_ANGLES, endpoint=False) + 0.5 * self.period / PREPARED_ANGLES
        for part in (0.0, 0.5, 1.0):
            self._looked_at(angle, np.full(PREPARED_ANGLES, self.direction * part * speed), 0.0)

    def acceleration_along(self, angle, speed, sense):
        state, senses = self.unrubbed(angle, speed, sense), self.senses.at(angle, sense)
        rest = self.motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope
        return self._settled(angle, speed, senses, self.flywheel + state.inertia, rest)[1]

    def accelerated(self, angle, speed, state):
        """Friction torque and crank acceleration at crank angles and speeds, from the state without friction."""
        rest = self.motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope
        guess = self._guess[1:] if self._guess[0] is angle else ()
        friction, acceleration, slope = self._settled(angle, speed, None, self.flywheel + state.inertia, rest, *guess)
        self._guess = angle, acceleration, slope
        return friction, acceleration

    def forces_on(self, angle, speed):
        """What is zero where friction has a kink, each over the crank angles."""
        if not self._pressed:
            return []
        return self.forces_at(angle, speed, self.accelerated(angle, speed, self.unrubbed(angle, speed))[1])

    def forces_at(self, angle, speed, acceleration):
        if not self._pressed:
            return []
        return self._pressing(self._looked_at(angle, speed, acceleration))

    def torque_by_speed(self, angle, speed, torque):
        """Derivative of load and friction torque by the crank speed, with the acceleration that follows from it."""
        _, acceleration, by_acceleration = self._guess
        state, step = self.unrubbed(angle, speed), RELATIVE_SPEED_STEP * np.abs(speed).max()
        changed = self._looked_at(angle, speed + step, acceleration)[FRICTION]
        own = super().torque_by_speed(angle, speed, state.torque) + (changed - torque + state.torque) / step
        drive = 0.0 if self.motor is None else self.motor.slope_at_crank(speed)
        rising = (drive - own - speed * state.slope) / (self.flywheel + state.inertia + by_acceleration)
        return own + by_acceleration * rising

    def _looked_at(self, angle, speed, acceleration, senses=None):
        """Values of the program of friction with as many passes as it takes, the crank turning in `direction`."""
        senses = self.senses.at(angle, self.direction) if senses is None else senses
        found: dict[str, Any] = {}

        def evaluate(scene):
            if scene is not self._solved:
                self._solved = scene
                del self._program
            found.update(self.rubbed(angle, speed, acceleration, senses))
            if not np.isfinite(found[FRICTION]).all():
                require_free(self.scene.solve(np.ravel(angle), on_gap="nan"), "drive")
            return [found[name] for name in CHECKS]

        solve_friction(self._solved, evaluate)
        return found

    def _settled(self, angle, speed, senses, inertia, rest, acceleration=None, slope=0.0):
        """Friction torque, acceleration, and derivative of the one by the other: their sum with inertia is `rest`."""

        def friction_at(acceleration, place=...):
            own = None if senses is None else {name: _at_places(sense, place) for name, sense in senses.items()}
            return self._looked_at(_at_places(angle, place), _at_places(speed, place), acceleration, own)[FRICTION]

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
        friction[place], acceleration[place], slope[place] = self._bracketed(
            lambda acceleration, some: friction_at(acceleration, tuple(row[some] for row in place)),
            *(_at_places(part, place) for part in (angle, speed, inertia, rest)),
        )
        return friction, acceleration, slope

    def _settled_here(self, values_at, angle, speed, inertia, rest, acceleration=None, slope=0.0):
        """The same for floats, `values_at` giving all values of the program."""
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
                self.pressed = self._pressing(found)
                return friction + slope * left, acceleration + left, slope

        def friction_at(accelerations, _):
            return np.array([values_at(float(one))[FRICTION] for one in accelerations])

        rows = self._bracketed(friction_at, *(np.array([part]) for part in (angle, speed, inertia, rest)))
        friction, acceleration, slope = (float(row[0]) for row in rows)
        self.pressed = self._pressing(values_at(acceleration))
        return friction, acceleration, slope

    def _bracketed(self, friction_at, angle, speed, inertia, rest):
        """What `_settled` returns, found between two accelerations, which no kink of friction keeps from converging.

        `friction_at(acceleration, place)` is the friction torque at those of the crank angles, each one-dimensional.
        Friction torque always resists the motion, so the root lies beyond that without friction, `rest / inertia`, on
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
        """Say where friction grows with the deceleration faster than the torque of inertia."""
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

    def _pressing(self, found):
        """What is zero where friction has a kink."""
        return [
            row
            for force, couple, half in self._pressed
            for row in kink_functions("size" if half is None else "larger", _kink_arguments(found, force, couple, half))
        ]


def _at_places(values, place):
    """Values at some of the places, of arrays; a number is the same at all of them."""
    return values[place] if np.ndim(values) else values


def _kink_arguments(found, force, couple, half):
    return (found[force],) if half is None else (found[force], found[couple] / half)
