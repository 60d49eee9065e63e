"""Writes tests/data/driven_rubbing_sawframe.json: the plain sawframe with friction, under a motor and coasting.

    python tests/references/make_driven_rubbing_sawframe.py

Shares no formula with the package: forces of all bodies by Newton's equations, friction from them by plain iteration,
the energy U of machine and flywheel over the crank angle by collocation at many digits between the angles at which
friction has kinks or jumps, these found with it. Two sets of pieces and points tell how many digits are right.
"""

import itertools
import json
from pathlib import Path

import mpmath as mp
import numpy as np

mp.mp.dps = 38
L, MASS, SLIDER = mp.mpf(2), mp.mpf(150), mp.mpf(600)
R, INERTIA, G = mp.mpf(0.3), mp.mpf(20.5), mp.mpf(9.81)  # as double precision has them
POWER, SPEED, FIELD, OVERLOAD, RATIO = 55000, mp.mpf(153.9), 157, mp.mpf(2.5), mp.mpf(4.6875)
RHO, MU = mp.mpf(0.05) * mp.mpf(0.06), mp.mpf(0.1)
SMALL = mp.mpf(10) ** -36


def place(phi):
    """Coefficients of motion: of the slider, of the coupler's centre (x, y), of the coupler's angle."""
    s, c = mp.sin(phi), mp.cos(phi)
    sine = -R * s / L
    cosine = mp.sqrt(1 - sine * sine)
    w = -R * c / (L * cosine)
    e = (R * s / L + sine * w * w) / cosine
    slider = -R * s - L * sine * w, -R * c - L * (cosine * w * w + sine * e)
    x = -R * s - L / 2 * sine * w, -R * c - L / 2 * (cosine * w * w + sine * e)
    y = R * c / 2, -R * s / 2
    return s, c, sine, cosine, (w, e), slider, x, y


class Point:
    """The machine at a crank angle, the crank turning forward, on one side of the jumps of friction."""

    def __init__(self, phi, beside):
        self.s, self.c, self.sine, self.cosine, self.turn, self.slide, self.x, self.y = place(phi)
        _, _, _, _, turn, slide, _, _ = place(beside)
        self.at_a, self.at_b, self.way = mp.sign(1 - turn[0]), mp.sign(turn[0]), mp.sign(slide[0])
        self.inertia = SLIDER * self.slide[0] ** 2 + MASS * (self.x[0] ** 2 + self.y[0] ** 2)
        self.inertia += INERTIA * self.turn[0] ** 2
        self.slope = SLIDER * self.slide[0] * self.slide[1] + INERTIA * self.turn[0] * self.turn[1]
        self.slope = 2 * (self.slope + MASS * (self.x[0] * self.x[1] + self.y[0] * self.y[1]))

    def forces(self, square, alpha, friction):
        """Torque of the crank, sizes of A and B, and N; friction: moments at O, A, B and force of the guide."""
        on_crank, on_a, on_b, along = friction
        bx = SLIDER * (self.slide[1] * square + self.slide[0] * alpha) - along
        cx, cy = (part[1] * square + part[0] * alpha for part in (self.x, self.y))
        arm = L / 2 * self.cosine, L / 2 * self.sine
        turning = INERTIA * (self.turn[1] * square + self.turn[0] * alpha)
        turning += MASS * (arm[0] * (cy + G) - arm[1] * cx) - on_a + on_b
        by = (L * self.sine * bx - turning) / (L * self.cosine)
        ax, ay = MASS * cx + bx, MASS * (cy + G) + by
        torque = R * (self.c * ay - self.s * ax) + on_a + on_crank
        return torque, mp.sqrt(ax * ax + ay * ay), mp.sqrt(bx * bx + by * by), SLIDER * G - by

    def moved(self, square, drive, flywheel):
        """Crank acceleration, torque of friction on the crank, and N."""
        friction, last = (mp.mpf(0),) * 4, None
        for _ in range(200):
            none, one = self.forces(square, 0, friction)[0], self.forces(square, 1, friction)[0]
            alpha = (drive - none) / (one - none + flywheel)
            _, a, b, normal = self.forces(square, alpha, friction)
            friction = RHO * a, RHO * a * self.at_a, RHO * b * self.at_b, -MU * self.way * abs(normal)
            if last is not None and abs(alpha - last) <= SMALL * (1 + abs(alpha)):
                break
            last = alpha
        taken = friction[0] + friction[1] * (1 - self.turn[0]) + friction[2] * self.turn[0]
        return alpha, taken - friction[3] * self.slide[0], normal


def motor(omega):
    """Torque at the motor's shaft."""
    rated = (FIELD - SPEED) / FIELD
    most = rated * (OVERLOAD + mp.sqrt(OVERLOAD**2 - 1))
    slip = (FIELD - RATIO * omega) / FIELD
    return 2 * OVERLOAD * POWER / SPEED * most * slip / (slip**2 + most**2)


class Collocation:
    """Polynomials at Chebyshev points: integrals from the left end, values between."""

    def __init__(self, count):
        self.count = count
        self.points = [-mp.cos((2 * k + 1) * mp.pi / (2 * count)) for k in range(count)]
        values = mp.matrix(count, count)
        whole = mp.matrix(count + 1, count)
        for i, x in enumerate([*self.points, mp.mpf(1)]):
            for k in range(count):
                if i < count:
                    values[i, k] = mp.chebyt(k, x)
                whole[i, k] = self._integral(k, x)
        self.series = values**-1
        self.integral = whole * self.series  # last row: over all

    def _integral(self, k, x):
        def primitive(x):
            if k == 0:
                return x
            if k == 1:
                return x * x / 2
            return mp.chebyt(k + 1, x) / (2 * (k + 1)) - mp.chebyt(k - 1, x) / (2 * (k - 1))

        return primitive(x) - primitive(mp.mpf(-1))

    def total(self, halves, rows):
        """Integral over all pieces."""
        last = [self.integral[self.count, i] for i in range(self.count)]
        return mp.fsum(h * mp.fdot(last, row) for h, row in zip(halves, rows, strict=True))

    def between(self, values, x):
        """Value of the polynomial through values at the points."""
        found = self.series * mp.matrix(values)
        return mp.fsum(found[k] * mp.chebyt(k, x) for k in range(self.count))


def widths(edges, most):
    """Edges, with more where they are far apart or close to the narrow places of the pin force at B."""
    found = []
    for low, high in itertools.pairwise(edges):
        parts = int(mp.ceil((high - low) / most))
        found += [low + (high - low) * k / parts for k in range(parts)]
    return [*found, edges[-1]]


def running(count, most, flywheel=1000):
    """Pieces and speeds of periodic running: edges, angles, speeds, accelerations, and torque of friction."""
    rule = Collocation(count)
    fixed = [mp.mpf(0), mp.pi / 2, mp.pi, 3 * mp.pi / 2, 2 * mp.pi]
    bends = [mp.mpf(one) for one in ("0.11621538542346", "1.55026993661079", "3.55758451694309", "4.18378086941523")]
    guess = lambda phi: mp.mpf(flywheel) * 33**2 / 2  # noqa: E731
    for _ in range(7):
        narrow = [bends[1] + way * mp.mpf(d) for way in (-1, 1) for d in ("0.005", "0.02", "0.06", "0.2")]
        narrow += [3 * mp.pi / 2 + way * mp.mpf(d) for way in (-1, 1) for d in ("0.02", "0.06", "0.2")]
        held = fixed + bends
        narrow = [one for one in narrow if min(abs(one - other) for other in held) > mp.mpf("0.003")]
        edges = widths(sorted(held + narrow), most)
        halves = [(b - a) / 2 for a, b in itertools.pairwise(edges)]
        middles = [(b + a) / 2 for a, b in itertools.pairwise(edges)]
        angles = [[m + h * x for x in rule.points] for m, h in zip(middles, halves, strict=True)]
        points = [[Point(phi, middles[k]) for phi in row] for k, row in enumerate(angles)]
        energy = [[guess(phi) for phi in row] for row in angles]
        for _ in range(12):
            speeds, rates, growth, normals, accelerations, taken = [], [], [], [], [], []
            for row, own in zip(energy, points, strict=True):
                for lists in (speeds, rates, growth, normals, accelerations, taken):
                    lists.append([])
                for U, at in zip(row, own, strict=True):
                    square = 2 * U / (flywheel + at.inertia)
                    omega = mp.sqrt(square)
                    alpha, rubbing, normal = at.moved(square, RATIO * motor(omega), flywheel)
                    more = omega * (1 + mp.mpf(10) ** -12)
                    after = at.moved(more * more, RATIO * motor(more), flywheel)[0]
                    both = (alpha, omega), (after, more)
                    slopes = [(flywheel + at.inertia) * a + at.slope * w * w / 2 for a, w in both]
                    speeds[-1].append(omega)
                    rates[-1].append(slopes[0])
                    by_speed = (slopes[1] - slopes[0]) / (more - omega)
                    growth[-1].append(by_speed / ((flywheel + at.inertia) * omega))
                    normals[-1].append(normal)
                    accelerations[-1].append(alpha)
                    taken[-1].append(rubbing)
            change = _step(rule, halves, energy, rates, growth)
            energy = [[U + d for U, d in zip(*pair, strict=True)] for pair in zip(energy, change, strict=True)]
            size = max(abs(d) for row in change for d in row) / energy[0][0]
            print(len(halves), count, mp.nstr(size, 3), flush=True)
            if size < mp.mpf(10) ** -30:
                break
        found = []
        for k, row in enumerate(normals):
            wide = [rule.between(row, mp.mpf(-1)), *row, rule.between(row, mp.mpf(1))]
            x = [mp.mpf(-1), *rule.points, mp.mpf(1)]
            for i in range(len(wide) - 1):
                if wide[i] * wide[i + 1] < 0:
                    ends = x[i], x[i + 1]
                    root = mp.findroot(lambda x, row=row: rule.between(row, x), ends, "anderson", verify=False)
                    found.append(middles[k] + halves[k] * root)
        near = [min(found, key=lambda one, old=old: abs(one - old), default=old) for old in bends]
        near = [one if abs(one - old) < mp.mpf("0.001") else old for one, old in zip(near, bends, strict=True)]
        moved = max(abs(one - old) for one, old in zip(near, bends, strict=True))
        bends = near
        table = [(a, b, row) for a, b, row in zip(edges[:-1], edges[1:], energy, strict=True)]

        def guess(phi, table=table):
            a, b, row = next(one for one in table if one[0] <= phi <= one[1])
            return rule.between(row, (2 * phi - a - b) / (b - a))

        if moved < mp.mpf(10) ** -12:
            break
    mean = 2 * mp.pi / rule.total(halves, [[1 / w for w in row] for row in speeds])
    lost = rule.total(halves, taken)

    def read(phi):
        U = guess(phi)
        k = next(k for k in range(len(halves)) if edges[k] <= phi <= edges[k + 1])
        at = Point(phi, middles[k])
        square = 2 * U / (flywheel + at.inertia)
        omega = mp.sqrt(square)
        return omega, at.moved(square, RATIO * motor(omega), flywheel)[0], motor(omega)

    return mean, lost, bends, read


def _step(rule, halves, energy, rates, growth):
    """Newton's step of the collocation equations, its matrix in double precision."""
    count, pieces = rule.count, len(halves)
    integral = np.array(rule.integral.tolist(), dtype=float)
    size = pieces * (count + 1)
    matrix, right = np.zeros((size, size)), []
    ends = []
    for k, h in enumerate(halves):
        own = rule.integral * mp.matrix(rates[k]) * h
        ends.append(own)
    starts = [mp.mpf(0)]
    for k in range(pieces):
        starts.append(starts[-1] + ends[k][count])
    base = energy[0][0] - ends[0][0]
    for k in range(pieces):
        place = k * (count + 1)
        slope = float(halves[k]) * integral * np.array(growth[k], dtype=float)
        for i in range(count):
            matrix[place + i, place + i] += 1.0
            matrix[place + i, place : place + count] -= slope[i]
            matrix[place + i, place + count] -= 1.0
            right.append(base + starts[k] + ends[k][i] - energy[k][i])
        after = ((k + 1) % pieces) * (count + 1) + count  # start of the next piece
        matrix[place + count, after] += 1.0
        matrix[place + count, place + count] -= 1.0
        matrix[place + count, place : place + count] -= slope[count]
        right.append(starts[pieces] if k == pieces - 1 else mp.mpf(0))
    most = max(abs(one) for one in right)
    if not most:
        return [[mp.mpf(0)] * count for _ in halves]
    found = np.linalg.solve(matrix, np.array([one / most for one in right], dtype=float))
    return [[mp.mpf(found[k * (count + 1) + i]) * most for i in range(count)] for k in range(pieces)]


def coasting(count, start, speed, flywheel, reach):
    """Crank angle and time of the standstill of a machine without motor; no friction turns or bends on the way."""
    rule = Collocation(count)
    half, middle = (reach - start) / 2, (reach + start) / 2
    points = [Point(middle + half * x, middle) for x in rule.points]
    first = (flywheel + Point(start, middle).inertia) * speed**2 / 2
    energy = [first] * count
    for _ in range(80):
        rates = []
        for U, at in zip(energy, points, strict=True):
            square = 2 * U / (flywheel + at.inertia)
            alpha, _, normal = at.moved(square, mp.mpf(0), flywheel)
            assert normal > 0
            rates.append((flywheel + at.inertia) * alpha + at.slope * square / 2)
        whole = rule.integral * mp.matrix(rates) * half
        change = max(abs(first + whole[k] - energy[k]) for k in range(count))
        energy = [first + whole[k] for k in range(count)]
        if change < first * mp.mpf(10) ** -33:
            break
    stop = middle + half * mp.findroot(lambda x: rule.between(energy, x), (-0.5, 0.5), "anderson", tol=1e-50)
    length = mp.sqrt(stop - start)
    slow = []
    for x in rule.points:  # phi = stop - s^2, so that the speed has no root
        s = length * (x + 1) / 2
        phi = stop - s * s
        square = 2 * rule.between(energy, (phi - middle) / half) / (flywheel + place_inertia(phi))
        slow.append(2 * s / mp.sqrt(square))
    return stop, length / 2 * mp.fsum(rule.integral[count, k] * one for k, one in enumerate(slow))


def place_inertia(phi):
    return Point(phi, phi).inertia


def main():
    coarse, fine = (running(*size) for size in ((22, mp.mpf("0.5")), (28, mp.mpf("0.4"))))
    print("running", [mp.nstr(one[0], 34) for one in (coarse, fine)], mp.nstr(coarse[1] - fine[1], 3))
    assert abs(coarse[0] - fine[0]) < mp.mpf(10) ** -14  # the fine one gains three digits and more
    start, speed, wheel, reach = mp.mpf(0.25), mp.mpf(1.5), mp.mpf(30), mp.mpf(0.45)
    stops = [coasting(count, start, speed, wheel, reach) for count in (40, 56)]
    print("coasting", [mp.nstr(one, 34) for pair in stops for one in pair])
    assert max(abs(a - b) for a, b in zip(*stops, strict=True)) < mp.mpf(10) ** -20
    mean, lost, bends, read = fine
    rows = [read(mp.mpf(2 * k + 1) * mp.pi / 24) for k in range(24)]
    data = {
        "made by": "python tests/references/make_driven_rubbing_sawframe.py",
        "flywheel": 1000,
        "mean_speed": mp.nstr(mean, 30),
        "friction_energy": mp.nstr(lost, 30),
        "bends": [mp.nstr(one, 25) for one in bends],
        "angle [deg]": [15 * k + 7.5 for k in range(24)],
        "speed": [mp.nstr(row[0], 30) for row in rows],
        "acceleration": [mp.nstr(row[1], 30) for row in rows],
        "motor_torque": [mp.nstr(row[2], 30) for row in rows],
        "coasting": {
            "from_angle": 0.25,
            "from_speed": 1.5,
            "flywheel": 30,
            "angle": mp.nstr(stops[1][0], 30),
            "time": mp.nstr(stops[1][1], 30),
        },
    }
    path = Path(__file__).parents[1] / "data" / "driven_rubbing_sawframe.json"
    path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
