"""Linkages with change points, and their motion and forces by a reference of 60 digits."""

from functools import cache
from itertools import product

import mpmath as mp
import pytest

import kinetostatics as ks

DATA = {"crank": (2.0, 0.3, 0.1, 0.2), "coupler": (1.5, 0.7, -0.2, 0.1), "rocker": (3.0, 0.4, 0.25, 0.5)}
LINKS = {name: ks.Link(mass, (along, across), inertia) for name, (mass, along, across, inertia) in DATA.items()}
LINKAGES = {
    "parallelogram": (1, 2, 1, 2),
    "kite": (2, 2, 1, 1),
    "deltoid": (1, 2, 2, 1),
    "rhombus": (1, 1, 1, 1),
    "4/1/3/2": (1, 3, 2, 4),
    "near": (2, 5, 4, 1),
}
"""Crank, coupler, rocker, ground."""
SINGLE = {"deltoid": "near", "4/1/3/2": "far", "near": "near"}
"""Those with one change point, nearest to O2 or farthest from it."""
SIDES = {"open": 1, "crossed": -1}
each = pytest.mark.parametrize(("name", "assembly"), list(product(LINKAGES, SIDES)))
SPEED, ACCELERATION, WEIGHT = 2.0, 1.5, 9.81
DIGITS = 240
"""Carried; differences over a step of 1e-80 leave more than 60, also 1e-17 rad from a change point."""


def four_bar(name, assembly, pivot=None, **links):
    a, b, h, d = map(float, LINKAGES[name])
    return ks.four_bar(a, b, h, rocker_pivot=pivot or (d, 0.0), assembly=assembly, **(links or LINKS))


def solve(made, angles, **options):
    given = {"crank_speed": SPEED, "crank_acceleration": ACCELERATION, "loads": ks.Gravity(WEIGHT)}
    return ks.solve(made, angles, **given | options)


NEAR = [sign * 10.0**-power for power in (1, 2, 4, 6, 8, 11, 14, 17) for sign in (1, -1)]


# Reference: intersection of circles on the side of the branch, differences of positions, moments of coupler and rocker


def side(name, assembly, psi):
    kind = SINGLE.get(name)
    turning = mp.cos(psi / 2) if kind == "far" else mp.sin(psi / 2) if kind else mp.sin(psi)
    return SIDES[assembly] * mp.sign(turning)


def places(name, assembly, start, angle):
    """A, O2, B, directions and mass centres of the links, as complex numbers."""
    a, b, h, d = LINKAGES[name]
    ray, O2 = mp.expj(angle), d * mp.expj(start)
    A = a * ray
    square = abs(O2 - A) ** 2
    height = mp.sqrt(abs((b + h) ** 2 - square)) * mp.sqrt(abs(square - (b - h) ** 2))
    ratio = (square + b * b - h * h + 1j * side(name, assembly, angle - start) * height) / (2 * square)
    B = A + ratio * (O2 - A)
    ways = (ray, (B - A) / b, (B - O2) / h)
    centres = [
        joint + way * mp.mpc(along, across)
        for joint, way, (_, along, across, _) in zip((0, A, O2), ways, DATA.values(), strict=True)
    ]
    return [A, O2, B, *ways, *centres]


@cache
def reference(name, assembly, behind, angle):
    """By quantity; O2 stands on the negative x-axis if `behind`."""
    with mp.workdps(DIGITS):
        phi, step, start = mp.mpf(angle), mp.mpf(10) ** -80, mp.pi if behind else mp.mpf(0)
        times = (-step, mp.mpf(0), step)
        before, here, after = (places(name, assembly, start, phi + SPEED * t + ACCELERATION * t * t / 2) for t in times)
        first = [(y - x) / (2 * step) for x, y in zip(before, after, strict=True)]
        second = [(x - 2 * m + y) / step**2 for x, m, y in zip(before, here, after, strict=True)]
        rates = [(v / way).imag for v, way in zip(first[3:6], here[3:6], strict=True)]
        slopes = [(v / way).imag for v, way in zip(second[3:6], here[3:6], strict=True)]
        data = list(DATA.values())
        forces = [mass * (-1j * mp.mpf(WEIGHT) - a) for (mass, *_), a in zip(data, second[6:], strict=True)]
        moments = [-inertia * slope for (*_, inertia), slope in zip(data, slopes, strict=True)]
        parts = zip(forces, first[6:], moments, rates, strict=True)
        torque = -sum((mp.conj(v) * f).real + m * rate for f, v, m, rate in parts) / SPEED
        A, O2, B = here[:3]
        of_coupler = (mp.conj(here[7] - A) * forces[1]).imag + moments[1]
        of_rocker = (mp.conj(here[8] - O2) * forces[2]).imag + moments[2]
        q, p = B - A, B - O2
        pin = -(of_rocker * q + of_coupler * p) / (mp.conj(p) * q).imag
        inner = pin - forces[1]
        return {
            "balancing_torque": torque,
            "B": pin,
            "A": inner,
            "O2": -pin - forces[2],
            "O": inner - forces[0],
            "position": B,
            "velocity": first[2],
            "acceleration": second[2],
            **{f"{link}_rate": rate for link, rate in zip(DATA, rates, strict=True)},
            **{f"{link}_angular_acceleration": slope for link, slope in zip(DATA, slopes, strict=True)},
        }


def errors(solution, place, expected):
    """Of motion and torque relative to their values, of reactions to the largest component at the angle."""
    found = {}
    for quantity in ("balancing_torque", *(key for key in expected if key.endswith(("_rate", "acceleration")))):
        if quantity == "acceleration":
            continue
        link = quantity.removesuffix("_angular_acceleration").removesuffix("_rate")
        values = (
            solution.balancing_torque
            if quantity == "balancing_torque"
            else solution.rate(link)
            if quantity.endswith("rate")
            else solution.angular_acceleration(link)
        )
        value, exact = mp.mpf(float(values[place])), expected[quantity]
        found[quantity] = abs(value - exact) / abs(exact) if abs(exact) > 1e-40 else abs(value - exact)
    for quantity in ("position", "velocity", "acceleration"):
        value, exact = getattr(solution, quantity)("B")[:, place], expected[quantity]
        size = 1.0 if quantity == "position" or abs(exact) < 1e-40 else abs(exact)
        found[quantity] = abs(mp.mpc(*map(float, value)) - exact) / size
    for joint in ("A", "B", "O", "O2"):
        value, exact = solution.reaction(joint)[:, place], expected[joint]
        apart = mp.mpc(*map(float, value)) - exact
        found[joint] = max(abs(apart.real), abs(apart.imag)) / max(abs(exact.real), abs(exact.imag))
    return {quantity: float(error) for quantity, error in found.items()}
