"""Writes tests/data/driven_sawframe.json: periodic running of the plain sawframe under a 55 kW motor, 30 digits.

    python tests/references/make_driven_sawframe.py

Shares no formula with the package. The unknown is the crank speed omega as a function of the crank angle,

    (Jf + J) omega omega' + J' omega^2 / 2 = motor torque - load torque,

with J, J' and the torque of the weights by the angle of the coupler. Way one: Fourier collocation with Newton's
iteration. Way two: shooting with mpmath's Taylor series (odefun) and the secant rule. Both must agree to 28 digits.
"""

import json
from pathlib import Path

import mpmath as mp

mp.mp.dps = 40
L, MASS, SLIDER = mp.mpf(2), mp.mpf(150), mp.mpf(600)
R, INERTIA, G = mp.mpf(0.3), mp.mpf(20.5), mp.mpf(9.81)  # as double precision has them
FLYWHEEL, POWER, SPEED, FIELD, OVERLOAD, RATIO = 1000, 55000, mp.mpf(153.9), 157, mp.mpf(2.5), mp.mpf(4.6875)
POINTS = 129


def machine(phi):
    """J, its slope, and the torque of the weights."""
    s, c = mp.sin(phi), mp.cos(phi)
    sine = -R * s / L
    cosine = mp.sqrt(1 - sine * sine)
    w = -R * c / (L * cosine)
    e = (R * s / L + sine * w * w) / cosine
    x1, x2 = -R * s - L * sine * w, -R * c - L * (cosine * w * w + sine * e)
    u1, u2 = -R * s - L / 2 * sine * w, -R * c - L / 2 * (cosine * w * w + sine * e)
    v1, v2 = R * c / 2, -R * s / 2
    J = SLIDER * x1 * x1 + MASS * (u1 * u1 + v1 * v1) + INERTIA * w * w
    slope = 2 * (SLIDER * x1 * x2 + MASS * (u1 * u2 + v1 * v2) + INERTIA * w * e)
    return J, slope, MASS * G * v1


def motor(omega):
    """Torque at the motor's shaft, and its derivative by the crank speed."""
    rated = (FIELD - SPEED) / FIELD
    most = rated * (OVERLOAD + mp.sqrt(OVERLOAD**2 - 1))
    slip = (FIELD - RATIO * omega) / FIELD
    top = 2 * OVERLOAD * POWER / SPEED
    square = slip**2 + most**2
    return top * most * slip / square, -RATIO / FIELD * top * most * (most**2 - slip**2) / square**2


def rate(phi, omega):
    """Derivative of omega by the crank angle."""
    J, slope, load = machine(phi)
    return ((RATIO * motor(omega)[0] - load) / omega - slope * omega / 2) / (FLYWHEEL + J)


def by_collocation():
    """Omega at even crank angles."""
    nodes = [2 * mp.pi * k / POINTS for k in range(POINTS)]
    states = [machine(phi) for phi in nodes]
    slopes = mp.matrix(POINTS, POINTS)
    for i in range(POINTS):
        for j in range(POINTS):
            if i != j:
                slopes[i, j] = mp.mpf(-1) ** (i - j) / (2 * mp.sin((nodes[i] - nodes[j]) / 2))
    omega = mp.matrix([FIELD / RATIO] * POINTS)
    for _ in range(12):
        residual, jacobian = slopes * omega, slopes.copy()
        for i, (J, slope, load) in enumerate(states):
            torque, by_speed = motor(omega[i])
            spare = RATIO * torque - load
            residual[i] -= (spare / omega[i] - slope * omega[i] / 2) / (FLYWHEEL + J)
            jacobian[i, i] -= (RATIO * by_speed / omega[i] - spare / omega[i] ** 2 - slope / 2) / (FLYWHEEL + J)
        change = mp.lu_solve(jacobian, residual)
        omega -= change
        if mp.norm(change, mp.inf) < mp.mpf(10) ** -36:
            break
    return nodes, list(omega)


def between(nodes, values, phi):
    """Trigonometric interpolation at odd many even angles."""
    total = mp.mpf(0)
    for node, value in zip(nodes, values, strict=True):
        half = (phi - node) / 2
        if mp.sin(half) == 0:
            return value
        total += value * mp.sin(POINTS * half) / (POINTS * mp.sin(half))
    return total


def by_shooting(start):
    """Omega at crank angle 0, by Taylor series over the turn."""

    def gap(omega):
        return mp.odefun(rate, 0, omega, tol=mp.mpf(10) ** -32)(2 * mp.pi) - omega

    one, two = start, start + mp.mpf(10) ** -8
    first, second = gap(one), gap(two)
    for _ in range(6):
        new = two - second * (two - one) / (second - first)
        one, first, two, second = two, second, new, gap(new)
        if abs(two - one) < mp.mpf(10) ** -30:
            break
    return two


def main():
    nodes, omega = by_collocation()
    guess = omega[0] * (1 + mp.mpf(10) ** -5)
    other = by_shooting(guess)
    print("collocation", mp.nstr(omega[0], 34))
    print("shooting   ", mp.nstr(other, 34))
    assert abs(omega[0] - other) < mp.mpf(10) ** -28
    duration = 2 * mp.pi * sum(1 / one for one in omega) / POINTS

    def rising(phi):
        return rate(phi, between(nodes, omega, phi))

    sizes = [between(nodes, omega, mp.findroot(rising, start)) for start in _turning(nodes, omega)]
    mean = 2 * mp.pi / duration
    angles = [2 * mp.pi * k / 24 for k in range(24)]
    speeds = [between(nodes, omega, phi) for phi in angles]
    data = {
        "made by": "python tests/references/make_driven_sawframe.py",
        "flywheel": FLYWHEEL,
        "motor": {"power": POWER, "speed": 153.9, "synchronous_speed": FIELD, "overload": 2.5, "transmission": 4.6875},
        "mean_speed": mp.nstr(mean, 30),
        "fluctuation": mp.nstr((max(sizes) - min(sizes)) / mean, 30),
        "fluctuation_arithmetic": mp.nstr(2 * (max(sizes) - min(sizes)) / (max(sizes) + min(sizes)), 30),
        "angle [deg]": [15 * k for k in range(24)],
        "speed": [mp.nstr(one, 30) for one in speeds],
        "acceleration": [mp.nstr(one * rate(phi, one), 30) for phi, one in zip(angles, speeds, strict=True)],
        "motor_torque": [mp.nstr(motor(one)[0], 30) for one in speeds],
    }
    path = Path(__file__).parents[1] / "data" / "driven_sawframe.json"
    path.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def _turning(nodes, omega):
    """Crank angles near which omega has an extremum."""
    for k, phi in enumerate(nodes):
        if (omega[k] - omega[k - 1]) * (omega[(k + 1) % POINTS] - omega[k]) < 0:
            yield phi


if __name__ == "__main__":
    main()
