"""Random scenes with friction and narrow pulses, and their true numbers by dense evaluation.

The dense evaluation takes neither series nor kinks from the package. Largest and smallest values are those of many
crank angles, around the edges of pulses above all, closed in on around the highest; integrals are sums of Gauss points
on intervals that are split until they stay.
"""

from functools import cached_property

import numpy as np

import kinetostatics as ks

TURN = 2 * np.pi
KINDS = ("slider", "yoke", "four-bar", "cam")
CANDIDATES = 12
"""Highest angles that are closed in on."""
ROUNDS, PLACES = 9, np.linspace(0.0, 1.0, 41)[:, None]
"""Rounds of closing in, each to a twentieth, and the places at which a round looks."""
GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(10)
SPLIT = 0.45
"""Share at which an interval is split; halves would agree with the whole at a jump just beside the middle."""


class Pulse:
    """A force that is a wave and a pulse, rectangular or half a sine; `declared` if it says where."""

    def __init__(self, rng, height, width, declared):
        self.start, self.width, self.height = rng.uniform(0.1, TURN - 0.5), width, height
        self.amplitude, self.order, self.lag = rng.uniform(0.0, 0.3) * height, rng.integers(1, 4), rng.uniform(0, TURN)
        self.arched = rng.random() < 0.5
        self.edges = np.array([self.start, self.start + self.width])
        if declared:
            self.kinks = lambda motion: (self.edges, ()) if self.arched else ((), self.edges)

    def __call__(self, motion):
        """Value at a motion."""
        place = (np.mod(motion.crank_angle, TURN) - self.start) / self.width
        inside = np.where((place > 0.0) & (place < 1.0), 1.0, 0.0)
        shape = np.sin(np.pi * np.clip(place, 0.0, 1.0)) if self.arched else inside
        return self.amplitude * np.sin(self.order * motion.crank_angle + self.lag) + self.height * shape


class PulsedScene:
    """A random scene: `scene`, its `kind`, and the crank angles `edges` at which it was given pulses."""

    def __init__(self, seed):
        self.rng = rng = np.random.default_rng([28, seed])
        self.kind, self.edges = KINDS[seed % len(KINDS)], np.empty(0)
        mechanism = getattr(self, "_" + self.kind.replace("-", "_"))()
        speed = rng.choice([-1.0, 1.0]) * np.exp(rng.uniform(np.log(2.0), np.log(40.0)))
        weight = [ks.Gravity(direction=rng.uniform(0.0, TURN))] if rng.random() < 0.5 else []
        loads = [*weight, *self._loads(mechanism, 9.0 * speed * speed * 0.15 + 100.0)]
        friction = {name: self._friction(kind) for name, kind in mechanism.friction_kinds.items() if rng.random() < 0.7}
        self.scene = ks.Scene(mechanism, speed, 0.0, loads, friction)

    @cached_property
    def mass(self):
        """Parameter of a mass, its column in a table of designs, and its value, kg."""
        path = "rocker.mass" if self.kind == "four-bar" else "slider.mass"
        return path, f"{path} [kg]", self.scene.parameters[path]

    def _real(self, low, high):
        return float(self.rng.uniform(low, high))

    def _link(self, scale=1.0):
        centre = self._real(0.0, 0.2) * scale, self._real(-0.05, 0.05) * scale
        return ks.Link(self._real(1.0, 9.0), centre, self._real(0.01, 0.2))

    def _links(self, *names):
        return {name: self._link() for name in names}

    def _slider(self):
        r = self._real(0.08, 0.15)
        place = {"guide_angle": self._real(-3.0, 3.0), "guide_offset": self._real(-0.5, 0.5) * r}
        side = int(self.rng.choice([-1, 1]))
        length = self._real(2.6, 5.0) * r
        return ks.crank_slider(r, length, assembly=side, **place, **self._links("crank", "coupler", "slider"))

    def _yoke(self):
        r = self._real(0.08, 0.15)
        place = {"guide_angle": self._real(-3.0, 3.0), "slot_angle": self._real(1.2, 1.9)}
        return ks.scotch_yoke(r, **place, **self._links("crank", "slider"), block=self._link(0.2))

    def _four_bar(self):
        r = self._real(0.08, 0.12)
        coupler, rocker, away = (self._real(2.2, 2.8) * r for _ in range(3))
        side = int(self.rng.choice([-1, 1]))
        links = self._links("crank", "coupler", "rocker")
        return ks.four_bar(r, coupler, rocker, rocker_pivot=(away, 0.2 * r), assembly=side, **links)

    def _cam(self):
        r = self._real(0.15, 0.3)
        cam = (
            ks.cams.Circle(r, (-0.07 * r, 0.02 * r)),
            ks.cams.CosineLaw(r, 6.5 * r),
            ks.cams.Harmonic((r, 0.0, 0.02 * r, 0.002 * r), (0.01 * r,)),
        )[self.rng.integers(3)]
        length = getattr(cam, "coupler_length", 6.5 * r)
        roller = ks.Roller(0.05, 0.04, 210e9, 0.3)
        links = self._links("crank", "coupler", "slider")
        return ks.cam_crank_slider(cam, length, roller=roller, block=self._link(0.2), **links)

    def _friction(self, kind):
        mu = self._real(0.01, 0.12)
        if kind is ks.PinFriction:
            return kind(mu, self._real(0.005, 0.02))
        if kind is ks.RollerFriction:
            return kind(0.3 * mu, 0.02, 0.05)
        return kind(mu, self.rng.choice([None, 0.1]))

    def _loads(self, mechanism, size):
        """One to three loads: tables over angle or travel, and functions with and without declared kinks."""
        kinds = ["angle", "declared", "undeclared", "travel"][: 4 if mechanism.guides else 3]
        for kind in self.rng.choice(kinds, size=self.rng.integers(1, 4), replace=False):
            height = self.rng.choice([-1.0, 1.0]) * self._real(0.2, 30.0) * size
            value = self._travel_table(mechanism, height) if kind == "travel" else self._over_angle(kind, height)
            yield ks.ProcessForce(value) if mechanism.guides else ks.Torque(value, on="rocker")

    def _over_angle(self, kind, height):
        least = 0.2 if kind == "undeclared" else 0.05
        width = np.radians(np.exp(self._real(np.log(least), np.log(20.0))))
        if kind != "angle":
            value = Pulse(self.rng, height, width, kind == "declared")
            self.edges = np.append(self.edges, value.edges)
            return value
        x, y = self._rows(0.0, TURN, width, height)
        self.edges = np.append(self.edges, x)
        return ks.Table(x, [*y[:-1], y[0]], zero=0.0)

    def _travel_table(self, mechanism, height):
        low, high = ks.extremes(ks.Scene(mechanism, 1.0).solve(1), "slider_position").range
        stroke = high - low
        x, y = self._rows(low - 1e-3 * stroke, high + 1e-3 * stroke, stroke * 10.0 ** self._real(-3.0, -1.0), height)
        return ks.Table(x, y, over="travel", back=self.rng.permutation(y) if self.rng.random() < 0.5 else None)

    def _rows(self, low, high, width, height):
        """Rows of a table with a pulse, its flanks as steep as may be."""
        count = int(self.rng.integers(4, 12))
        x, y = np.linspace(low, high, count), self.rng.uniform(-0.3, 0.3, count) * height
        x[1:-1] += self.rng.uniform(-0.3, 0.3, count - 2) * (x[1] - x[0])
        start = low + self._real(0.02, 0.98) * (high - low - 1.1 * width)
        flank, level = width * self.rng.choice([0.01, 0.1, 0.4]), self._real(-0.1, 0.1) * height
        around = (x < start - flank) | (x > start + width + flank)
        around[[0, -1]] = True
        x = np.append(x[around], start + np.array([0.0, flank, width - flank, width]))
        y = np.append(y[around], level + height * np.array([0.0, 1.0, 1.0, 0.0]))
        return x[x.argsort()], y[x.argsort()]


class Dense:
    """True numbers of a solution by dense evaluation, at so many crank angles first."""

    def __init__(self, solution, edges, count=400_000):
        period, half = solution.period, count // 2
        edges = np.unique(np.mod(np.concatenate([edges, _passages(solution)]), period))
        near = np.geomspace(1e-13, 0.02, half // max(1, 3 * edges.size))
        between = edges[:-1] + np.linspace(0.0, 1.0, near.size)[:, None] * np.diff(edges)
        parts = [np.linspace(0.0, period, half, endpoint=False), between, edges[:, None] - near, edges[:, None] + near]
        self.angle = np.unique(np.mod(np.concatenate([part.ravel() for part in parts]), period))
        self.at = self.solution = solution.at(self.angle).check()  # with as many passes over friction as these need
        self.edges, self.period = edges, period

    def largest(self, function):
        """Largest value of a function of a solution, closed in on."""
        value = np.asarray(function(self.at))
        angle = np.concatenate([self.angle[-1:] - self.period, self.angle, self.angle[:1] + self.period])
        tops = np.flatnonzero((value >= np.roll(value, 1)) & (value >= np.roll(value, -1)))
        tops = tops[np.argsort(-value[tops])][:CANDIDATES] + 1
        best, low, high, column = value.max(), angle[tops - 1], angle[tops + 1], np.arange(tops.size)
        for _ in range(ROUNDS):
            places = low + (high - low) * PLACES
            found = self._values(function, places)
            best, top = max(best, found.max()), found.argmax(axis=0)
            low, high = places[np.maximum(top - 1, 0), column], places[np.minimum(top + 1, 40), column]
        return float(best)

    def ends(self, function):
        """Smallest and largest value."""
        return -self.largest(lambda at: -np.asarray(function(at))), self.largest(function)

    def means(self, function):
        """Mean, mean of the size, and range of the integral of function less mean."""
        low, high, sums = self._intervals(function)
        mean = sums.sum() / self.period
        size = sum(np.abs(part).sum() for part in self._parted(function, 0.0, low, high, sums)) / self.period
        first, rest = self._parted(function, mean, low, high, sums)
        gained = np.append(0.0, np.cumsum(first + rest))
        return mean, size, np.ptp(np.append(gained, gained[:-1] + first))

    def _parted(self, function, level, low, high, sums):
        """Integrals of function less level up to where its sign changes in an interval, and from there."""

        def beyond(at):
            return np.asarray(function(at)) - level

        above = np.signbit(self._values(beyond, np.append(low, high[-1])))
        inner = np.flatnonzero(above[:-1] != above[1:])
        first = sums - level * (high - low)
        rest = np.zeros(low.size)
        zero = _crossing(lambda angle: self._values(beyond, angle), low[inner], high[inner])
        before = self._sums(beyond, low[inner], zero)[0]
        rest[inner] = first[inner] - before
        first[inner] = before
        return first, rest

    def _intervals(self, function):
        """Starts and ends of intervals that Gauss points resolve, rising, and the integrals over them."""
        edges = np.unique(np.concatenate([np.linspace(0.0, self.period, 1441), self.edges]))
        low, high, parts = edges[:-1], edges[1:], []
        whole, values = self._sums(function, low, high)
        size = np.abs(values).max()
        while low.size:
            assert low.size < 20_000
            middle = low + SPLIT * (high - low)
            (first, left), (second, right) = self._sums(function, low, middle), self._sums(function, middle, high)
            steep = 4e-15 * np.maximum(np.ptp(left, axis=1), np.ptp(right, axis=1))  # rounding of crank angles
            done = np.abs(first + second - whole) <= 1e-12 * size * (high - low) + steep
            done |= high - low < 1e-13
            parts += [(low[done], middle[done], first[done]), (middle[done], high[done], second[done])]
            whole = np.concatenate([first[~done], second[~done]])
            low, high = (np.concatenate([one[~done], other[~done]]) for one, other in ((low, middle), (middle, high)))
        found = np.concatenate(parts, axis=1)
        return found[:, found[0].argsort()]

    def _sums(self, function, low, high):
        """Integrals between crank angles, and values at their Gauss points."""
        half = 0.5 * (high - low)
        values = self._values(function, 0.5 * (low + high)[:, None] + half[:, None] * GAUSS)
        return half * (values @ WEIGHTS), values

    def _values(self, function, angle):
        at = self.solution.at(np.mod(angle.ravel(), self.period))
        return np.broadcast_to(function(at), at.shape).reshape(angle.shape)


def _crossing(function, low, high):
    """Crank angle between low and high, (K,), at which a function of angles (N, K) changes its sign."""
    column = np.arange(low.size)
    for _ in range(10 if low.size else 0):
        places = low + (high - low) * PLACES
        sign = np.signbit(function(places))
        first = np.argmax(sign[1:] != sign[:-1], axis=0)
        low, high = places[first, column], places[first + 1, column]
    return low


def _passages(solution):
    """Crank angles at which the slider passes each row of tables over travel."""
    tables = [load.value_now for load in solution.loads if isinstance(getattr(load, "value_now", None), ks.Table)]
    rows = np.concatenate([np.empty(0), *(table.x for table in tables if table.over == "travel")])
    even = np.linspace(1e-3, TURN + 1e-3, 4001 if rows.size else 1)
    beyond = solution.at(even).slider_position > rows[:, None] if rows.size else np.zeros((0, 1), dtype=bool)
    row, place = np.nonzero(beyond[:, 1:] != beyond[:, :-1])

    def distance(angle):
        return solution.at(angle.ravel()).slider_position.reshape(angle.shape) - rows[row]

    return _crossing(distance, even[place], even[place + 1])
