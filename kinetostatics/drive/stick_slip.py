"""Motion from a crank angle and speed, through standstill and reversal: energy over the crank angle, then time.

`energy_equation` follows the motion over parts of the period, up to a whole period at a time. Pieces end at the kinks
of loads and friction, so no kink lies inside a piece. Near a standstill the energy is proportional to the distance from
it. With the distance as length times u^2, the speed over u, the time and all torques are smooth in u. After a stop the
machine continues, turns back, or sticks: it stays at rest if the net torque moves it in neither sense.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..cycle.piecewise import TAIL, Pieces, rule
from ..errors import DriveError, KinetostaticsError
from ..numbers.brackets import find_roots
from .energy_equation import StandstillError, resolve_energy, solve_energy
from .one_dof import ANGLE_AHEAD
from .resolution import MAX_PERIODS, MIN_INERTIA_RATIO, PastPeriods, plain_pieces, resolved

MAX_PARTS = 10_000
"""Largest number of parts of a motion, mostly whole periods."""
ANGLE_TOLERANCE = 1e-12
"""Crank angles nearer than this to an edge, rad, count as the edge."""
REST_ANGLE = 1e-10
"""Crank angle, rad, within which a motion without further steps stops."""
MAX_STEPS_AT_REST = 40
"""Fixed-point steps of the energy near a standstill."""
ROUNDING = 1e-15
"""Relative rounding of crank angles and torques: noise of the net torque on steep ramps and near an equilibrium."""
MAX_TAIL_RATIO = 100.0
"""Tail of a torque, relative to the largest allowed one, above which the steps near a standstill end early."""
MAX_REACH_GROWTH = 8.0
"""Ratio of successive crank angles in attempts."""
MAX_EDGES = 200
"""Largest number of edges of a part, besides 8 times the initial number; beyond it the part is shortened."""
MIN_SPEED = 1e-3
"""Smallest crank speed, rad/s, at which the torques of the period are resolved before the motion is known."""
MIN_PART = 1e-6
"""Smallest part of the period, rad, to which a given end of time shortens it."""
PLACES = np.array([-1.0, -0.5, 0.0, 0.5])
"""Places in each piece at which a motion has rows."""


class Stretch(NamedTuple):
    """Pieces of a motion in order: columns of series over a place from -1 to 1 that rises with time.

    `root` is 1 for a piece that starts at a standstill, -1 for one that ends there, else 0. The speed is that of its
    series times (1 + root place) / 2.
    """

    direction: np.ndarray
    root: np.ndarray
    angle: np.ndarray
    time: np.ndarray
    speed: np.ndarray
    lost: np.ndarray


class MotionPath:
    """Motion over time: rows of crank angle, speed, energy lost by friction, and sense.

    At standstill the sense is that of the motion before it.
    """

    def __init__(self, stretches):
        self._all = Stretch(*(np.concatenate(parts, axis=-1) for parts in zip(*stretches, strict=True)))
        ends = np.cumsum([self._all.time.sum(axis=0), self._all.lost.sum(axis=0)], axis=1)
        self.starts, self._lost = np.column_stack([np.zeros(2), ends[:, :-1]])

    def at_place(self, piece, place):
        """Times and rows at places from -1 to 1 of pieces."""
        own = self._all
        angle, time, speed, lost = (chebyshev.chebval(place, rows[:, piece], tensor=False) for rows in own[2:])
        root = own.root[piece]
        speed = own.direction[piece] * np.maximum(speed, 0.0) * np.where(root == 0, 1.0, 0.5 * (1.0 + root * place))
        before = np.where((place == -1.0) & (piece > 0), piece - 1, piece)
        rows = np.array([angle, speed, self._lost[piece] + lost, own.direction[before]])
        return self.starts[piece] + time, rows

    def __call__(self, time):
        time = np.asarray(time, dtype=float)
        flat = time.ravel()
        piece = np.clip(np.searchsorted(self.starts, flat, side="right") - 1, 0, None)
        whole, asked = self._all.time.sum(axis=0)[piece], flat - self.starts[piece]
        series = self._all.time[:, piece]

        def late(place, some):
            found = chebyshev.chebval(place, series[:, some], tensor=False) - asked[some]
            return np.where(place == -1.0, -asked[some], np.where(place == 1.0, whole[some] - asked[some], found))

        with np.errstate(invalid="ignore"):
            place = find_roots(late, np.full(flat.size, -1.0), np.full(flat.size, 1.0), 1e-16)
        place = np.where(np.isnan(place), np.where(asked > 0.5 * whole, 1.0, -1.0), place)
        return self.at_place(piece, place)[1].reshape(4, *time.shape)


class Motion(NamedTuple):
    """A motion: times, rows of `MotionPath` at these, the path, reversals (time, angle), and its end.

    `end` is "end", "ready" (target speed), "standstill", "stuck", or "lost" where it cannot be followed.
    """

    time: np.ndarray
    rows: np.ndarray
    path: Any
    reversals: list
    end: str


def sense_from_rest(driven, angle):
    """Sense in which a machine starts from rest, +1 or -1; 0 if it stays at rest.

    At a kink, where loads may jump, each sense has the torque ahead of it. A torque whose sign depends on the rounding
    of the crank angle does not move the machine.
    """
    at_kink = np.any(np.abs(driven.kinks - angle % driven.period) < ANGLE_TOLERANCE)
    places = angle + ROUNDING * max(abs(angle), 1.0) * np.array([-1.0, 0.0, 1.0])
    ahead = places + ANGLE_AHEAD * at_kink, places - ANGLE_AHEAD * at_kink
    forward = min(driven.along(1.0).torque_at_rest(place)[0] for place in ahead[0])
    backward = max(driven.along(-1.0).torque_at_rest(place)[0] for place in ahead[1])
    if forward > 0.0 > backward:
        raise DriveError(
            f"{driven.scene.mechanism.name}: at rest at crank angle {math.degrees(angle):.6g} deg it may start either "
            f"way: {forward:.6g} N m drive it on counter-clockwise, {backward:.6g} N m drive it on "
            "clockwise. Give a small from_speed in the wanted sense",
            crank_angle=angle,
        )
    return 1.0 if forward > 0.0 else -1.0 if backward < 0.0 else 0.0


def integrate_motion(driven, angle, speed, end, target=None, to_standstill=False, sense=None) -> Motion:
    """Motion from a crank angle and speed until a time, a target speed, a standstill, or until it sticks.

    `sense` is the sense of a start from rest; without it the net torque decides.
    """
    direction = math.copysign(1.0, speed) if speed else sense or sense_from_rest(driven, angle)
    march = March(driven, angle, speed, end, target)
    reversals: list[tuple[float, float]] = []
    what, last = "stuck", None
    while direction:
        what, last = march.run(direction)
        if what != "still":
            break
        direction = 0.0 if to_standstill else sense_from_rest(driven, march.inside)
        what = "standstill" if to_standstill else "stuck"
        if direction:
            reversals.append((march.time, march.inside + march.shift))
    if not march.stretches:
        rows = np.array([[angle], [speed], [0.0], [direction or driven.direction]])
        return Motion(np.zeros(1), rows, lambda time: np.multiply.outer(rows[:, 0], np.ones(np.shape(time))), [], what)
    path = MotionPath(march.stretches)
    piece, place = (part.ravel() for part in np.meshgrid(np.arange(path.starts.size), PLACES, indexing="ij"))
    time, rows = path.at_place(piece, place)
    if what == "end":
        ended, last_rows = np.array([end]), path(np.array([end]))
    else:
        ended, last_rows = path.at_place(*(np.array([part]) for part in last or (path.starts.size - 1, 1.0)))
    time[0], rows[:, 0] = 0.0, (angle, speed, 0.0, rows[3, 0])
    before = time < ended
    time, rows = np.append(time[before], ended), np.hstack([rows[:, before], last_rows])
    return Motion(time, rows, path, reversals, what)


class March:
    """A motion in progress: its time, s, energy, J, and speed at a crank angle `inside` of the period."""

    def __init__(self, driven, angle, speed, end=math.inf, target=None):
        self.driven, self.end, self.target = driven, end, target
        self.left = math.inf
        self.shift = math.floor(angle / driven.period) * driven.period
        self.inside, self.time, self.speed = angle - self.shift, 0.0, abs(speed)
        self.energy = 0.5 * float(driven.inertia(np.array([self.inside]))[0]) * speed * speed
        self.fastest = max(abs(speed), abs(target or 0.0), MIN_SPEED)
        self.stretches: list[Stretch] = []
        self.known: dict[float, PastPeriods] = {}
        self.turned: list[tuple[Pieces, Any]] = []
        self.problem: Any = None
        self.parts = self.passed = 0

    def run(self, direction):
        """Follow the motion in one sense; returns its end, and the piece and place at a target speed, else None.

        The end is "end", "ready", "still", "turned", or "lost".
        """
        machine, reach = self.driven.along(direction), self.driven.period
        while True:
            found, length = self._step(machine, reach)
            if found is None:
                reach = 0.5 * length
                if reach < ANGLE_TOLERANCE:
                    if self._stops_here():
                        self.energy = self.speed = 0.0
                        return "still", None
                    if isinstance(self.problem, KinetostaticsError):
                        raise self.problem
                    return "lost", None
                continue
            reach = min(MAX_REACH_GROWTH * reach, MAX_PERIODS * self.driven.period)
            stretch, far, self.energy = found
            self.left -= abs(far - self.inside)
            self.inside = far
            ready = None if self.target is None else self._reached(stretch)
            stretch.angle[0] += self.shift
            self.stretches.append(stretch)
            self.passed += stretch.root.size
            self.time += float(stretch.time.sum())
            self.speed = float(stretch.speed[:, -1].sum())
            if ready is not None:
                return "ready", ready
            if self.time >= self.end:
                return "end", None
            if self.left < ANGLE_TOLERANCE:
                return "turned", None
            if self.energy == 0.0:
                return "still", None

    def _stops_here(self):
        """Whether the local torques absorb the remaining energy within `REST_ANGLE`."""
        around = (
            self.driven.along(sense).torque_at_rest(self.inside + way * ANGLE_AHEAD)[0]
            for sense in (1.0, -1.0)
            for way in (1.0, -1.0)
        )
        return self.energy <= REST_ANGLE * max(map(abs, around))

    def turn(self, direction):
        """Follow the motion over a period; returns whether it is complete. `energy_at` then returns its energy."""
        self.left, self.turned = self.driven.period, []
        return self.run(direction)[0] == "turned"

    def energy_at(self, pieces):
        """Energy of the last `turn` at the points of pieces of the period."""
        found = np.empty(pieces.angle.shape)
        for part, series in self.turned:
            own = (pieces.angle >= part.edges[0]) & (pieces.angle <= part.edges[-1])
            found[own] = part.evaluate(series, pieces.angle[own])
        return found

    def _step(self, machine, reach):
        """Next stretch within a crank angle, with the angle and energy after it, or None; and the angle tried."""
        direction, period = machine.direction, machine.period
        self._count()
        start = 0.0 if direction > 0.0 else period
        turned, gone = divmod(direction * (self.inside - start) + ANGLE_TOLERANCE, period)
        if turned > 0.0:
            self.shift += direction * turned * period
            self.inside = start + direction * (gone if gone > 2.0 * ANGLE_TOLERANCE else 0.0)
        known = self._known(machine)
        begins = self.inside == start
        periods = known.periods_ahead(self.energy, reach) if begins else 1
        edges, kinks = known.edges_ahead(periods)
        ahead = edges[:: int(direction)]
        ahead = ahead[direction * (ahead - self.inside) > ANGLE_TOLERANCE]
        room = abs(ahead[0] - self.inside)
        reach = min(reach, self._within_time(machine), abs(ahead[-1] - self.inside) if self.energy else room)
        reach = min(reach, self.left)
        near = np.abs(ahead - self.inside - direction * reach)
        far = float(ahead[near.argmin()] if near.min() < ANGLE_TOLERANCE else self.inside + direction * reach)
        if self.energy == 0.0:
            found = self._attempt(leave_rest, machine, self.inside, abs(far - self.inside), known.count)
            return found and (found[0], far, found[1]), reach
        if self._stops_within(machine, 0.5 * min(room, reach)):
            found = self._attempt(come_to_rest, machine, self.inside, self.energy, room, known.count)
            if found is not None:
                return (found[0], self.inside + direction * found[1], 0.0), reach
        inner = ahead[direction * (far - ahead) > 0.0]
        part = Pieces(np.sort(np.concatenate([[self.inside], inner, [far]])), known.count)
        whole = begins and part.edges.size == edges.size and far == ahead[-1]
        guess = known.energy_ahead(part, self.energy) if whole else np.full(part.angle.shape, self.energy)
        found = self._attempt(pass_part, machine, part, kinks, self.energy, guess)
        if found is not None:
            stretch, energy, solved = found
            if self.left < math.inf:
                self.turned.append((solved[0], solved[0].series(solved[2])))
            if whole:
                known.keep(*solved, abs(energy - self.energy) / periods)
            return (stretch, far, energy), reach
        stops = reach
        if isinstance(self.problem, StandstillError):
            stops = max(abs(self.problem.angle - self.inside), reach / MAX_REACH_GROWTH)
        before = np.abs(inner - self.inside)
        before = before[before < stops]
        if before.size:  # the next attempt ends at the last edge before the standstill, or at half the angle
            return None, 2.0 * before[-1] if isinstance(self.problem, StandstillError) else reach
        found = self._attempt(come_to_rest, machine, self.inside, self.energy, room + ANGLE_TOLERANCE, known.count)
        return found and (found[0], self.inside + direction * found[1], 0.0), min(reach, stops)

    def _stops_within(self, machine, reach):
        """Whether the torque just ahead, its friction at acceleration 0, absorbs the energy within a crank angle."""
        place, speed = np.array([self.inside + machine.direction * ANGLE_AHEAD]), machine.direction * self.speed
        state = self._attempt(machine.at_acceleration, place, speed, 0.0)
        if state is None:
            return False
        return -machine.direction * float(machine.motor_torque(speed) - state.torque[0]) * reach > self.energy

    def _attempt(self, function, *parts):
        """Result of a function, or None if it fails; `problem` is its error."""
        self.problem = None
        try:
            return function(*parts)
        except (KinetostaticsError, StandstillError) as error:
            self.problem = error
            return None

    def _count(self):
        self.parts += 1
        if self.parts > MAX_PARTS:
            raise DriveError(
                f"{self.driven.scene.mechanism.name}: the motion is too long: {self.time:.6g} s, to crank "
                f"angle {math.degrees(self.inside + self.shift):.6g} deg, needed {MAX_PARTS} parts of the period; give "
                "an earlier time as until",
                crank_angle=self.inside + self.shift,
            )

    def _known(self, machine):
        """`PastPeriods` of a machine."""
        if machine.direction not in self.known:
            speed = machine.direction * self.fastest
            found = self._attempt(resolved, machine, speed) or (plain_pieces(machine, speed), np.empty(0))
            self.known[machine.direction] = PastPeriods(machine, *found)
        return self.known[machine.direction]

    def _within_time(self, machine):
        """Approximate crank angle that the motion covers until its end time."""
        left = self.end - self.time
        if self.energy:
            return max(3.0 * self.speed * left, MIN_PART)
        inertia = machine.inertia(np.array([self.inside]))[0]
        return max(abs(machine.torque_at_rest(self.inside)[0]) / inertia * left * left, MIN_PART)

    def _reached(self, stretch):
        """Piece of the motion and place in it at the target speed, or None."""
        count, target = len(stretch.speed), stretch.direction[0] * self.target
        places = np.concatenate([[-1.0], rule(count).points, [1.0]])

        def spare(value, place, root):
            return value * np.where(root == 0, 1.0, 0.5 * (1.0 + root * place)) - target

        speed = chebyshev.chebvander(places, count - 1) @ stretch.speed
        values = spare(speed.T, places, stretch.root[:, None]).ravel()
        changes = np.flatnonzero(np.signbit(values[:-1]) != np.signbit(values[1:]))
        if not changes.size:
            return None
        piece, place = divmod(int(changes[0]), places.size)
        if place == places.size - 1:
            return self.passed + piece, 1.0
        series, root = stretch.speed[:, piece], stretch.root[piece]
        low, high = places[[place]], places[[place + 1]]
        found = find_roots(lambda place, _: spare(chebyshev.chebval(place, series), place, root), low, high)
        return self.passed + piece, float(found[0])


def pass_part(driven, pieces, kinks, start, guess):
    """Stretch over pieces from an energy at the start, the energy after it, and the solution to keep; or None.

    `guess` is the approximate energy at the points.
    """
    most = 8 * pieces.edges.size + MAX_EDGES

    def again(finer, guess, near=None):
        if finer.edges.size > most:
            return None
        solved = solve_energy(driven, finer, guess(finer), start, near)
        if solved is None or not solved[2].inertia.min() > MIN_INERTIA_RATIO * solved[2].inertia.max():
            return None
        return finer, solved

    found = again(pieces, lambda pieces: guess)
    if found is None:
        return None

    refined = resolve_energy(driven, found[0], found[1], kinks, again)
    if refined is None:
        return None
    pieces, (energy, far, linear), kinks = refined
    way = int(driven.direction)
    half, middle = pieces.half[::way], 0.5 * (pieces.edges[:-1] + pieces.edges[1:])[::way]
    friction = linear.state.torque - driven.without_friction(pieces.angle, linear.speed).torque
    stretch = _stretch(
        driven,
        0.0,
        np.array([middle, driven.direction * half[:, 0], 0.0 * middle]),
        half / np.abs(linear.speed[::way, ::way]),
        np.abs(linear.speed[::way, ::way]),
        driven.direction * half * friction[::way, ::way],
    )
    return stretch, far, (pieces, kinks, energy)


def leave_rest(driven, angle, length, count):
    """Stretch over a crank angle from a standstill, and the energy after it; or None."""
    found = _beside_rest(driven, angle, length, None, count)
    return found and (found[0], found[1] * found[2])


def come_to_rest(driven, angle, energy, room, count):
    """Stretch from a crank angle and energy to a standstill within `room`, and the angle to it; or None."""
    speed = driven.direction * math.sqrt(2.0 * energy / driven.inertia(np.array([angle]))[0])
    net = driven.torque_at(angle + driven.direction * ANGLE_AHEAD, speed)  # loads may jump here
    length = -energy / (driven.direction * net) if driven.direction * net < 0.0 else room
    found = _beside_rest(driven, angle, min(length, room), energy, count)
    return found and (found[0], found[1]) if found and found[1] <= room else None


@lru_cache
def _means(count):
    """Distances u from rest at the points, and a matrix from values there to means from rest to each point."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    share, within = 0.5 * (1.0 + rule(count).points), 0.5 * (1.0 + nodes)
    table = chebyshev.chebvander(2.0 * np.multiply.outer(np.append(share, 1.0), within) - 1.0, count - 1)
    means = np.einsum("q,iqk->ik", weights * within, table) @ rule(count).series
    return share, means[:-1], means[-1]


def _tail(values):
    """Relative size of the last coefficients of a series from values at the points of one piece."""
    return Pieces(np.array([-1.0, 1.0]), values.size).tail(values[None])[0]


def _beside_rest(driven, angle, length, energy, count):
    """Stretch next to a standstill, its length, rad, and the mean torque over it; or None.

    It leaves rest at the angle, or, with an energy there, comes to rest at a length that follows from it. With M the
    mean of the torque from rest, the energy is length u^2 M. The first step solves for friction; in each later step
    friction is linear in the acceleration, from the values of the step before.
    """
    share, means, whole = _means(count)
    direction, root = driven.direction, 1.0 if energy is None else -1.0
    mean, before, noise, near = None, math.inf, 0.0, None
    for _ in range(MAX_STEPS_AT_REST):
        place = share * share if energy is None else (1.0 - share) * (1.0 + share)
        places = angle + direction * length * place
        inertia = driven.inertia(places)
        if mean is None:
            mean = direction * driven.torque_at_rest(angle)[0] if energy is None else energy / length
            mean = np.full(count, mean)
        pace = np.sqrt(2.0 * length * mean / inertia)
        state = driven.at(places, direction * share * pace, near)
        motor = driven.motor_torque(direction * share * pace)
        torque = root * direction * (motor - state.torque)
        last, mean, total = mean, means @ torque, float(whole @ torque)
        if not (mean.min() > 0.0 and total > 0.0):
            return None
        size = float(np.abs(mean - last).max() / mean.max())
        noise = ROUNDING * (abs(angle) / length + np.abs([motor, state.torque]).max() / mean.max())
        if energy is not None:
            resting = float(rule(count).many[0] @ rule(count).series @ torque)
            step = (energy / length - total) / (resting if resting > 0.0 else total)
            length, size = length * (1.0 + max(step, -0.5)), max(size, abs(step))
        if size < 1e-15 or (size < 1e-12 + noise and size >= 0.5 * before):
            break
        if near and _tail(torque) > MAX_TAIL_RATIO * (10.0 * TAIL + noise):
            return None
        before, near = size, driven.motion_with_friction
    else:
        return None
    slowness = np.sqrt(2.0 * length * inertia / mean)
    if max(map(_tail, (torque, pace, slowness))) > 10.0 * TAIL + noise:
        return None
    if not inertia.min() > MIN_INERTIA_RATIO * inertia.max():
        return None
    friction = state.torque - driven.without_friction(places, direction * share * pace).torque
    way, reach = int(root), direction * length
    middle = angle + 0.375 * reach if energy is None else angle + reach - 0.375 * reach
    stretch = _stretch(
        driven,
        root,
        np.array([[middle], [0.5 * reach], [root * 0.125 * reach]]),
        0.5 * slowness[None, ::way],
        pace[None, ::way],
        reach * (share * friction)[None, ::way],
    )
    return stretch, length, total


def _stretch(driven, root, angle, slowness, speed, lost):
    """Stretch of pieces in order of the motion, from values (pieces, points): rates by the place, and speed."""
    pieces = Pieces(2.0 * np.arange(len(speed) + 1.0) - 1.0, speed.shape[1])
    rows = [pieces.series(part) for part in (pieces.integral_in_piece(slowness), speed, pieces.integral_in_piece(lost))]
    return Stretch(np.full(len(speed), driven.direction), np.full(len(speed), root), angle, *rows)
