"""Exact periodic running of a machine under its motor.

The state is U = (Jf + J(phi)) omega^2 / 2 as a function of the crank angle: dU/dphi = motor torque - load torque, with
no derivative of J. Newton's iteration on U, each step a linear equation u' = a u + g that is solved by its integrating
factor in Chebyshev series between the kinks, converges to rounding in about four steps.
"""

import itertools
import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import DriveError
from ..machine.loads import TURN
from ..numbers import checks
from ..numbers.elementary import read_only
from ..solution.angles import crank_angles
from ..solution.scene import Scene
from .driven import Driven
from .motor import Motor, single
from .pieces import Pieces
from .running import RunningSolution

POINTS, FEW_POINTS, MANY = 24, 12, 60
"""Points of a piece, and those where there are so many pieces."""
WIDEST = TURN / 6
TAIL = 2e-14
"""Size of the last coefficients of a series, relative to its largest value, that is rounding."""
STIFF = 4.0
"""Integral of a over a piece, at most: more takes digits."""
ROUNDED = 1e-14
"""Relative change of speed that is rounding, for what a motor's torque makes of it."""
LEVELS = 60
MOST_PIECES = 20_000
STEPS = 40
HALVED = 3
"""How often all pieces are halved where Newton's iteration does not settle, as that of stiff motors on wide ones."""
JUMP = 1e-9
"""Difference of values, relative to the largest, from both sides of an edge that is a jump."""
CONVERGED = 1e-14
VANISHING = 1e-10
"""Smallest inertia, relative to the largest, with which there is a speed."""
SAMPLED = 96
"""Crank angles by which mean load torques are judged, before running is known."""
SEEN = 512
"""Speeds at which the mean torques of motor and loads are compared."""
FOLLOWED = 1e-6
"""Tolerance to which a machine is followed from above."""
TURNS = 100
"""Turns that are followed from above, where Newton's iteration does not find the way."""


def steady(scene, motor, flywheel=0.0, *, angles=720, engine=None) -> "Running":
    """Periodic running of a machine under its motor, exact to rounding.

    Where there are several, the stable one, at the highest speed; a motor below its breakdown torque does not count.
    It is followed over one turn, or as many as motion and loads take to repeat.

    Parameters
    ----------
    scene : Scene
        Mechanism and loads; its crank speed does not matter, but for `motor` None.
    motor : Motor or None
        None: a motor that gives the constant torque that the machine takes at the mean speed of the scene, as textbooks
        assume; loads must not depend on the speed then.
    flywheel : float
        Moment of inertia on the crank, beside its own link, kg m2.
    angles : int or array
        Crank angles of the tables: so many over the period, its end excluded, or these, rad.
    engine : "numpy" or "compiled"
        As for `solve`; "compiled" pays where the same kind of machine is run often.

    Returns
    -------
    Running

    Raises
    ------
    DriveError
        There is no periodic running: the motor is too weak, with the torque missing; nothing holds the speed; the
        inertia vanishes somewhere.
    ParameterError
        A value is out of range, or a load cannot be taken at any crank angle.
    AssemblyError
        The mechanism does not make full turns.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> run = ks.drive.steady(pump, motor, flywheel=0.05)
    >>> print(f"{run.mean_speed:.4f} rad/s, fluctuation {run.fluctuation:.5f}")
    104.6753 rad/s, fluctuation 0.05021
    """
    direction = _direction(scene) if motor is None else None
    driven = Driven("steady", scene, motor, flywheel, engine, direction)
    checks.require("steady", _angles_problem(angles))
    pieces, energy = (_prescribed if motor is None else _driven_running)(driven, scene)
    angle = np.linspace(0.0, driven.period, angles, endpoint=False) if _is_count(angles) else crank_angles(angles)
    return Running(scene, motor, driven.flywheel, angle, driven, pieces, energy)


@dataclass(frozen=True, eq=False)
class Running:
    """A machine in periodic running; made by `steady`.

    Attributes
    ----------
    scene : Scene
    motor : Motor or None
    flywheel : float
        All inertia on the crank besides the links, that of the motor's rotor with it, kg m2.
    crank_angle : array (..., N)
        rad.
    """

    scene: Scene
    motor: Motor | None
    flywheel: float
    crank_angle: np.ndarray
    _driven: Driven = field(repr=False)
    _pieces: Pieces = field(repr=False)
    _energy: np.ndarray = field(repr=False)

    def __repr__(self):
        lines = [
            f"<Running: {self.scene.mechanism.name}, period {self.turns} turn{'s' * (self.turns > 1)}",
            f"  mean speed      {self.mean_speed:.9g} rad/s",
            f"  fluctuation     {self.fluctuation:.9g} ({self.speed_range[0]:.9g} to {self.speed_range[1]:.9g} rad/s)",
            f"  energy a turn   {self.energy_per_turn:.9g} J",
            f"  motor power     {self.mean_power:.9g} W mean, {self.rms_power:.9g} rms, {self.peak_power:.9g} peak>",
        ]
        return "\n".join(lines)

    # the period

    @property
    def period(self):
        """Crank angle after which running repeats, rad."""
        return self._driven.period

    @property
    def turns(self):
        """Turns of the crank after which running repeats."""
        return self._driven.turns

    @cached_property
    def duration(self):
        """Time of the period, s."""
        return abs(self._pieces.total(1.0 / self._speed))

    @cached_property
    def mean_speed(self):
        """Mean over time of the crank speed, rad/s: 2 pi turns by the time of the period."""
        return math.copysign(self.period / self.duration, self._driven.direction)

    @cached_property
    def speed_range(self):
        """Smallest and largest speed of the crank, without sign, rad/s."""
        size = np.abs(self._speed)
        return -self._pieces.largest(-size)[0], self._pieces.largest(size)[0]

    @property
    def fluctuation(self):
        """Coefficient of fluctuation: largest less smallest speed over the mean speed over time."""
        return float(np.subtract(*self.speed_range[::-1])) / abs(self.mean_speed)

    @property
    def fluctuation_arithmetic(self):
        """The same over the mean of largest and smallest speed, as textbooks have it."""
        low, high = self.speed_range
        return 2.0 * (high - low) / (high + low)

    # over the crank angle

    @cached_property
    def speed(self):
        """Crank speed at the crank angles, (..., N), rad/s."""
        return read_only(self.motion(self.crank_angle)[0])

    @cached_property
    def acceleration(self):
        """Crank acceleration at the crank angles, (..., N), rad/s2."""
        return read_only(self.motion(self.crank_angle)[1])

    @cached_property
    def time(self):
        """Time since crank angle 0, of which crank angles are taken modulo the period, (..., N), s."""
        return read_only(self._time_at(np.mod(self.crank_angle, self.period)))

    @cached_property
    def motor_torque(self):
        """Torque of the motor at its shaft, its rotor's inertia not taken off, (..., N), N m."""
        return read_only(self._motor_torque(self.speed))

    @property
    def motor_speed(self):
        """Speed of the motor's shaft, (..., N), rad/s; of the crank without motor."""
        return self._transmission * self.speed

    @property
    def motor_power(self):
        """Power of the motor at its shaft, (..., N), W."""
        return self.motor_torque * self.motor_speed

    @property
    def crank_torque(self):
        """Torque that the machine itself takes at the crank: its balancing torque, (..., N), N m."""
        return self.solution.balancing_torque

    def motion(self, angle):
        """Speed and acceleration of the crank at any crank angles, rad/s, rad/s2."""
        driven, angle = self._driven, np.mod(angle, self.period)
        energy, inertia = self._pieces.evaluate(self._energy_series, angle), driven.inertia(angle)
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
        state = driven.at(angle, speed)
        turning = self._transmission * self._motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope
        return speed, turning / inertia

    @cached_property
    def solution(self):
        """`Solution` at the crank angles with the true speed and acceleration, for tables, extremes, plots, compare."""
        return RunningSolution.of(self)

    def plot(self, ax=None):
        """Crank speed over the crank angle, and on a second axis the torques of motor and machine at the crank.

        Returns both axes.
        """
        import matplotlib.pyplot as plt

        ax = ax if ax is not None else plt.subplots()[1]
        angle = np.linspace(0.0, self.period, 721)
        speed, acceleration = self.motion(angle)
        drive = self._transmission * self._motor_torque(speed)
        ax.plot(np.degrees(angle), speed, color="C0", label="crank speed")
        ax.axhline(self.mean_speed, color="C0", lw=0.8, ls=":", label="its mean")
        ax.set(xlabel="crank angle [deg]", ylabel="crank speed [rad/s]", title=self.scene.mechanism.name)
        torques = ax.twinx()
        torques.plot(np.degrees(angle), drive, color="C1", label="motor")
        torques.plot(np.degrees(angle), drive - self.flywheel * acceleration, color="C2", label="machine")
        torques.set_ylabel("torque at the crank [N m]")
        lines = [*ax.get_lines(), *torques.get_lines()]
        torques.legend(lines, [str(line.get_label()) for line in lines], frameon=False, fontsize="small")
        return ax, torques

    def frame(self):
        """Table with a row for each crank angle, a pandas DataFrame: time, motion, torques and power of the drive."""
        import pandas as pd

        columns = {
            "crank_angle [deg]": np.degrees(self.crank_angle),
            "time [s]": self.time,
            "crank_speed [rad/s]": self.speed,
            "crank_acceleration [rad/s2]": self.acceleration,
            "motor_torque [N m]": self.motor_torque,
            "motor_power [W]": self.motor_power,
            "balancing_torque [N m]": self.solution.balancing_torque,
            "load_torque [N m]": self.solution.load_torque,
            "kinetic_energy [J]": self.solution.kinetic_energy + 0.5 * self.flywheel * self.speed**2,
        }
        return pd.DataFrame({name: np.ravel(values) for name, values in columns.items()})

    # powers and energies

    @cached_property
    def energy_per_turn(self):
        """Energy that the motor gives at its shaft in a turn, J."""
        return self._pieces.total(self._powers / np.abs(self._speed)) / self.turns

    @cached_property
    def air_gap_energy_per_turn(self):
        """Energy through the air gap of an induction motor in a turn, J: torque times speed of the field."""
        if self.motor is None or self.motor.field_speed is None:
            raise DriveError(
                "air_gap_energy_per_turn: only an induction motor, Motor.kloss, has an air gap that it knows"
            )
        power = self._motor_torque(self._speed) * self.motor.field_speed
        return self._pieces.total(power / np.abs(self._speed)) / self.turns

    @property
    def rotor_loss_per_turn(self):
        """Energy that an induction motor loses in its rotor by slip in a turn, J."""
        return self.air_gap_energy_per_turn - self.energy_per_turn

    @property
    def mean_power(self):
        """Mean over time of the motor's power at its shaft, W."""
        return self.energy_per_turn * self.turns / self.duration

    @cached_property
    def rms_power(self):
        """Root of the mean over time of the square of the motor's power, W."""
        return math.sqrt(self._pieces.total(self._powers**2 / np.abs(self._speed)) / self.duration)

    @cached_property
    def peak_power(self):
        """Largest power of the motor, with its sign, W."""
        high, low = self._pieces.largest(self._powers)[0], -self._pieces.largest(-self._powers)[0]
        return max(high, low, key=abs)

    @cached_property
    def peak_motor_torque(self):
        """Largest torque of the motor at its shaft, with its sign, N m."""
        torque = self._motor_torque(self._speed)
        high, low = self._pieces.largest(torque)[0], -self._pieces.largest(-torque)[0]
        return max(high, low, key=abs)

    # on the points of the pieces

    @cached_property
    def _state(self):
        driven, angle = self._driven, self._pieces.angle
        if not driven.by_speed:
            return driven.at(angle)
        inertia = driven.inertia(angle)
        return driven.at(angle, driven.direction * np.sqrt(2.0 * self._energy / inertia))

    @cached_property
    def _speed(self):
        return self._driven.direction * np.sqrt(2.0 * self._energy / (self._driven.flywheel + self._state.inertia))

    @cached_property
    def _energy_series(self):
        return self._pieces.series(self._energy)

    @property
    def _transmission(self):
        return 1.0 if self.motor is None else self.motor.transmission

    def _motor_torque(self, speed):
        if self.motor is None:
            return 0.0 * speed + self._pieces.total(self._state.torque) / self.period
        return self.motor.torque(self.motor.transmission * speed)

    @property
    def _powers(self):
        return self._transmission * self._motor_torque(self._speed) * self._speed

    def _time_at(self, angle):
        slowness = 1.0 / np.abs(self._speed)
        return self._pieces.evaluate(self._pieces.series(self._pieces.integrated(slowness)), angle)


# Finding it


def _driven_running(driven, scene):
    """Pieces, and the energy U at their points, of stable periodic running under a motor."""
    start = _operating_speed(driven)
    pieces = resolved(driven, start)
    _require_inertia(driven, pieces)
    found = _settled(driven, pieces, lambda pieces: 0.5 * driven.inertia(pieces.angle) * start * start)
    pieces, energy = found or _from_above(driven, pieces, start)
    for _ in range(LEVELS):
        marked = _unresolved(driven, pieces, energy)
        if not marked.any() or len(pieces.half) > MOST_PIECES:
            break
        found = _settled(driven, pieces.split(marked), _interpolated(pieces, energy))
        pieces, energy = found or _from_above(driven, pieces.split(marked), start)
    _require_known(driven, pieces, energy)
    return pieces, energy


def _interpolated(pieces, energy):
    """Energy as a function of other pieces."""
    series = pieces.series(energy)
    return lambda finer: pieces.evaluate(series, finer.angle)


def _settled(driven, pieces, guess):
    """Pieces and energy of periodic running near a guess, a function of pieces, halved while that helps; or None."""
    for halving in range(HALVED + 1):
        if halving:
            pieces = pieces.split(pieces.can_split)
        pieces = _yielding(driven, pieces, guess)
        energy = _newton(driven, pieces, guess(pieces))
        if energy is not None:
            return pieces, energy
    return None


def _yielding(driven, pieces, guess):
    """Pieces divided where the motor is stiff, as near a guess."""
    _, _, _, growth = _looked_at(driven, pieces, guess(pieces))
    parts = np.ceil(np.abs(pieces.whole(growth)) / STIFF).astype(int)
    if parts.max() <= 1 or parts.sum() > MOST_PIECES:
        return pieces
    spans = zip(pieces.edges[:-1], pieces.edges[1:], parts, strict=True)
    edges = [np.linspace(low, high, max(count, 1), endpoint=False) for low, high, count in spans]
    return Pieces(np.concatenate([*edges, pieces.edges[-1:]]), pieces.count)


def _unresolved(driven, pieces, energy):
    """Which pieces have series that are not done, and can be halved."""
    state, inertia, speed, growth = _looked_at(driven, pieces, energy)
    drive = driven.motor_torque(speed)
    wide = np.abs(pieces.whole(growth)) > STIFF
    rounding = ROUNDED * np.abs(driven.motor.slope_at_crank(speed) * speed).max()
    floor = max(10.0 * TAIL * max(np.abs(state.torque).max(), np.abs(drive).max()), rounding)
    rough = np.abs(pieces.series(drive - state.torque)[-3:]).max(axis=0) > floor
    tails = [pieces.tail(part) > TAIL for part in (energy, inertia)]
    tails.append(pieces.tail(speed) > 10.0 * TAIL)
    return (np.any([wide, rough, *tails], axis=0)) & pieces.can_split


def _looked_at(driven, pieces, energy, state=None):
    """State, inertia, speed, and derivative of the net torque by U, at the points of pieces."""
    angle = pieces.angle
    if driven.by_speed:
        inertia = driven.inertia(angle)
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
        state = driven.at(angle, speed)
    else:
        state = state or driven.at(angle)
        inertia = driven.flywheel + state.inertia
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
    by_speed = driven.motor.slope_at_crank(speed) - driven.torque_by_speed(angle, speed, state.torque)
    return state, inertia, speed, by_speed / (inertia * speed)


def _newton(driven, pieces, energy):
    """Energy U of periodic running near a guess; None if the iteration does not settle on stable running."""
    state, before = None, math.inf
    for _ in range(STEPS):
        state, _, speed, growth = _looked_at(driven, pieces, energy, state)
        net = driven.motor_torque(speed) - state.torque
        found = _periodic(pieces, growth, net - growth * energy)
        if found is None:
            return None
        change, factor = found - energy, 1.0
        if not found.min() > 0.0:
            falling = change < 0.0
            factor = 0.7 * float(np.min(energy[falling] / -change[falling]))
            if factor < 1e-6:
                return None
        energy = energy + factor * change
        size = float(np.abs(change).max() / np.abs(energy).max())
        if factor == 1.0 and (size < CONVERGED or (size < 1e-10 and size >= 0.1 * before)):
            stable = driven.direction * pieces.total(growth) < 0.0
            return energy if stable else None
        before = size
    return None


def _periodic(pieces, growth, rest):
    """Periodic solution of u' = growth u + rest; None where it grows over the period, or neither grows nor fades."""
    with np.errstate(over="ignore", invalid="ignore"):
        raised = pieces.integral(growth)
        gathered = pieces.integral(rest * np.exp(-raised))
        ends = np.exp(pieces.whole(growth))
        added = ends * pieces.whole(rest * np.exp(-raised))
    if not (np.isfinite(ends).all() and np.isfinite(added).all()):
        return None
    whole = pieces.total(growth)
    if not abs(whole) > 1e-15:
        return None
    chain = list(zip(ends.tolist(), added.tolist(), strict=True))
    if whole < 0.0:
        value = 0.0
        for end, part in chain:
            value = value * end + part
        left, value = [], value / -math.expm1(whole)
        for end, part in chain:
            left.append(value)
            value = value * end + part
    else:  # the way in which differences fade
        value = 0.0
        for end, part in reversed(chain):
            value = (value - part) / end
        left, value = [], value / -math.expm1(-whole)
        for end, part in reversed(chain):
            value = (value - part) / end
            left.insert(0, value)
    return np.exp(raised) * (np.array(left)[:, None] + gathered)


# Where it begins


def _operating_speed(driven):
    """Crank speed at which the mean torques of motor and loads agree and the motor yields to more load, rad/s."""
    motor, name = driven.motor, driven.scene.mechanism.name
    if math.isfinite(motor.top):
        speed = motor.top * np.linspace(0.0, 1.0, SEEN)
    elif driven.by_speed:
        speed = np.concatenate([[0.0], np.geomspace(1e-4, 1e6, SEEN)]) * abs(motor.transmission)
    else:
        mean = float(_mean_load(driven, np.ones(1))[0])
        raise DriveError(
            f"{name}: nothing holds the speed, as neither the motor's torque nor the loads depend on it; a turn leaves "
            f"{TURN * (motor.torque_at_crank(0.0) - mean):.6g} J over; give a motor whose torque falls with speed"
        )
    load = _mean_load(driven, speed / motor.transmission) / motor.transmission
    spare = motor.torque(speed) - load
    crossing = np.flatnonzero((spare[:-1] > 0.0) & (spare[1:] <= 0.0))
    if crossing.size:
        from scipy.optimize import brentq

        low, high = speed[crossing[-1]], speed[crossing[-1] + 1]

        def spare_at(own):
            if not driven.by_speed:
                return motor.torque(own) - load[0]
            mean = _mean_load(driven, np.array([own / motor.transmission]))[0] / motor.transmission
            return float(motor.torque(own) - mean)

        return float(brentq(spare_at, low, high, xtol=1e-9 * high, rtol=1e-9)) / motor.transmission
    if spare[-1] > 0.0:
        raise DriveError(
            f"{name}: the machine runs away: at {speed[-1]:.6g} rad/s, the highest speed of the motor that is looked "
            f"at, {spare[-1]:.6g} N m are left over at its shaft"
        )
    best = int(np.argmax(spare))
    missing = float(-spare[best] * abs(motor.transmission))
    raise DriveError(
        f"{name}: the motor is too weak, so there is no periodic running: the loads take {load[best]:.6g} N m at its "
        f"shaft in the mean, where it gives {motor.torque(speed[best]):.6g} N m at most (at {speed[best]:.6g} rad/s); "
        f"{-spare[best]:.6g} N m are missing, {missing:.6g} N m at the crank; give a motor "
        f"{_times(load[best], motor, speed)}or another transmission",
        missing,
    )


def _times(load, motor, speed):
    most = float(motor.torque(speed).max())
    return f"{load / most:.3g} times as strong " if most > 0.0 else "that drives "


def _mean_load(driven, speed):
    """Mean load torque over the period at constant crank speeds, N m."""
    angle = (np.arange(SAMPLED) + 0.5) * driven.period / SAMPLED
    if not driven.by_speed:
        return driven.at(angle).torque.mean() + 0.0 * speed
    grid = np.broadcast_arrays(angle[None, :], speed[:, None])
    return driven.at(*grid).torque.mean(axis=1)


def resolved(driven, speed):
    """Pieces in which inertia and load torque at a speed are series that are done."""
    edges = _edges(np.concatenate([[0.0], driven.kinks, [driven.period]]))
    pieces = _refined(driven, Pieces(edges, FEW_POINTS if len(edges) > MANY else POINTS), speed)
    width = 2.0 * pieces.half[:, 0]
    if np.any(width < 1e-6 * driven.period):
        jumps = 0.5 * (pieces.edges[:-1] + pieces.edges[1:])[~pieces.can_split]
        edges = _edges(np.unique(np.concatenate([[0.0], driven.kinks, jumps, [driven.period]])))
        again = _refined(driven, Pieces(edges, pieces.count), speed)
        pieces = again if len(again.half) < len(pieces.half) else pieces
    return _with_jumps(driven, pieces, speed)


def _with_jumps(driven, pieces, speed):
    """Pieces with further edges where the load torque jumps between an edge and the points beside it."""
    torque = _state_at(driven, pieces.angle, speed).torque
    series = pieces.series(torque)
    ends, starts = series.sum(axis=0), (series * (-1.0) ** np.arange(pieces.count)[:, None]).sum(axis=0)
    starts = np.append(starts[1:], starts[0])
    jumping = np.flatnonzero(np.abs(ends - starts) > JUMP * np.abs(torque).max())
    found = []
    for piece in jumping:
        low = pieces.angle[piece, -1]
        high = pieces.angle[(piece + 1) % len(ends), 0] + (driven.period if piece + 1 == len(ends) else 0.0)
        while high - low > 1e-15 * driven.period:
            inner = np.linspace(low, high, 34)[1:-1]
            if not (inner[0] > low and inner[-1] < high):
                break
            values = _state_at(driven, np.mod(inner, driven.period), speed).torque
            after = np.abs(values - starts[piece]) < np.abs(values - ends[piece])
            first = int(np.argmax(after)) if after.any() else after.size
            bounds = np.concatenate([[low], inner, [high]])
            low, high = bounds[first], bounds[first + 1]
        found.append(high % driven.period)
    edges = np.unique(np.concatenate([pieces.edges, found]))
    return Pieces(edges, pieces.count) if found else pieces


def _state_at(driven, angle, speed):
    return driven.at(angle, np.full(angle.shape, speed) if driven.by_speed else None)


def _refined(driven, pieces, speed):
    for _ in range(LEVELS):
        state = _state_at(driven, pieces.angle, speed)
        marked = ((pieces.tail(state.inertia) > TAIL) | (pieces.tail(state.torque) > TAIL)) & pieces.can_split
        if not marked.any() or len(marked) > MOST_PIECES:
            break
        pieces = pieces.split(marked)
    return pieces


def _edges(breaks):
    """Edges at breaks, and between them where they are far apart."""
    parts = [np.linspace(a, b, math.ceil((b - a) / WIDEST - 1e-9) + 1)[:-1] for a, b in itertools.pairwise(breaks)]
    return np.concatenate([*parts, breaks[-1:]])


def _require_inertia(driven, pieces):
    """Refuse a machine whose inertia vanishes somewhere, so that it has no speed there."""
    inertia = driven.inertia(pieces.angle)
    least, angle = pieces.largest(-inertia)
    if not -least > VANISHING * inertia.max():
        raise DriveError(
            f"{driven.scene.mechanism.name}: all inertia vanishes at crank angle {math.degrees(angle):.6g} deg "
            f"({max(-least, 0.0):.3g} kg m2, {inertia.max():.3g} at most), so there is no speed there; give a "
            "flywheel, or the crank or the rotor of the motor its inertia",
            crank_angle=angle,
        )


def _from_above(driven, pieces, start):
    """Running found by following the machine from a high speed, where Newton's iteration alone does not find it.

    Motions of one degree of freedom do not cross, so from above the highest periodic running is met, or none exists.
    """
    from scipy.integrate import solve_ivp

    period, direction = driven.period, driven.direction

    def net(angle, energy):
        angle, inertia = float(angle), driven.here(float(angle), direction)[0]
        return driven.here(angle, direction * math.sqrt(2.0 * max(float(energy[0]), 0.0) / inertia))[2]

    most = 0.5 * driven.inertia(pieces.angle).max() * (2.0 * start) ** 2

    def standstill(angle, energy):
        return energy[0] - 1e-9 * most

    vars(standstill)["terminal"] = True
    energy, ends = most, (0.0, period) if direction > 0 else (period, 0.0)
    for turn in range(TURNS):
        found = solve_ivp(
            net, ends, [energy], "LSODA", rtol=FOLLOWED, atol=1e-10 * most, dense_output=True, events=standstill
        )
        if found.status != 0:
            angle = float(found.t[-1]) % period
            missing = abs(net(angle, np.zeros(1)))
            raise DriveError(
                f"{driven.scene.mechanism.name}: the motor is too weak, so there is no periodic running: followed from "
                f"{2.0 * abs(start):.6g} rad/s, the machine comes to a standstill at crank angle "
                f"{math.degrees(angle):.6g} deg in turn {turn + 1}, where {missing:.6g} N m are missing at the crank; "
                "give a larger flywheel or a stronger motor",
                missing,
                angle,
            )
        last, energy = energy, float(found.y[0, -1])
        if abs(energy - last) < 0.05 * last:
            settled = _settled(driven, pieces, lambda pieces, path=found.sol: _on_path(pieces, path, 1e-9 * most))
            if settled is not None:
                return settled
            if abs(energy - last) < 1e-4 * last:
                break
    raise DriveError(
        f"{driven.scene.mechanism.name}: no periodic running was found in {turn + 1} turns from "
        f"{2.0 * abs(start):.6g} rad/s; give a larger flywheel"
    )


def _on_path(pieces, path, least):
    return np.maximum(path(pieces.angle.ravel())[0].reshape(pieces.angle.shape), least)


def _require_known(driven, pieces, energy):
    """Refuse running at speeds of which a table of the motor knows nothing."""
    _, _, speed, _ = _looked_at(driven, pieces, energy)
    own = driven.motor.transmission * speed
    low, high = driven.motor.limits
    if own.min() < low or own.max() > high:
        raise DriveError(
            f"{driven.scene.mechanism.name}: the motor runs at {own.min():.6g} to {own.max():.6g} rad/s, but its table "
            f"knows {low:.6g} to {high:.6g} rad/s only; give more rows"
        )


# Without a motor


def _prescribed(driven, scene):
    """Pieces, and the energy U at their points, under the constant torque that keeps the mean speed of the scene."""
    if driven.by_speed:
        raise DriveError(
            f"{scene.mechanism.name}: loads depend on the speed, so no constant torque is known that carries them; "
            "give a motor"
        )
    from scipy.optimize import brentq

    speed = abs(scene.crank_speed)
    pieces = resolved(driven, speed)
    _require_inertia(driven, pieces)
    for _ in range(LEVELS):
        state = driven.at(pieces.angle)
        inertia = driven.flywheel + state.inertia
        spare = pieces.total(state.torque) / driven.period - state.torque
        gained = pieces.integrated(spare)
        gained = gained + pieces.largest(-gained)[0]
        scale = 0.5 * speed * speed * pieces.total(inertia) / driven.period

        def too_fast(size, inertia=inertia, gained=gained, pieces=pieces, scale=scale):
            slowness = np.sqrt(0.5 * inertia / (gained + scale * math.exp(size)))
            return driven.period / pieces.total(slowness) - speed

        low = next((size for size in (-5.0, -12.0, -25.0) if too_fast(size) < 0.0), None)
        if low is None:
            raise DriveError(
                f"{scene.mechanism.name}: no constant torque keeps a mean speed as low as {speed:.6g} rad/s: the "
                "energy gained over the turn alone makes it faster; give a larger flywheel or a higher speed"
            )
        energy = gained + scale * math.exp(brentq(too_fast, low, 5.0, xtol=1e-15, rtol=1e-15))
        slow = np.sqrt(0.5 * inertia / energy)
        marked = ((pieces.tail(energy) > TAIL) | (pieces.tail(slow) > TAIL)) & pieces.can_split
        if not marked.any():
            break
        pieces = pieces.split(marked)
    return pieces, energy


def _direction(scene):
    """Sign of the crank speed of a scene that is to be run without motor."""
    checks.require("steady", None if isinstance(scene, Scene) else f"scene must be a Scene, got {checks.shown(scene)}")
    speed, wrong = single(scene.crank_speed, name="crank_speed of the scene", unequal=0.0)
    checks.require("steady", wrong)
    return math.copysign(1.0, speed)


def _is_count(angles):
    return isinstance(angles, int | np.integer) and not isinstance(angles, bool)


def _angles_problem(angles):
    """What is wrong with a number of crank angles, or None."""
    return checks.count("angles", angles, size=checks.ANGLE) if _is_count(angles) else None
