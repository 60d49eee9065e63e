"""Linkages with change points, and their motion and forces by a reference of 60 digits."""

from functools import cache
from itertools import product

import mpmath as mp
import pytest

import kinetostatics as ks

from . import multibody
from .machines import FourBar

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
DIGITS = 80
"""Of the reference, whose equations lose half of them 1e-17 rad from a change point."""


def four_bar(name, assembly, pivot=None, **links):
    a, b, h, d = map(float, LINKAGES[name])
    return ks.four_bar(a, b, h, rocker_pivot=pivot or (d, 0.0), assembly=assembly, **(links or LINKS))


def solve(made, angles, **options):
    given = {"crank_speed": SPEED, "crank_acceleration": ACCELERATION, "loads": ks.Gravity(WEIGHT)}
    return ks.solve(made, angles, **given | options)


NEAR = [sign * 10.0**-power for power in (1, 4, 8, 14) for sign in (1, -1)]


# Reference: the side of the branch in the equations of all bodies


def side(name, assembly, psi):
    kind = SINGLE.get(name)
    turning = mp.cos(psi / 2) if kind == "far" else mp.sin(psi / 2) if kind else mp.sin(psi)
    return SIDES[assembly] * mp.sign(turning)


@cache
def reference(name, assembly, behind, angle):
    """By quantity; O2 stands on the negative x-axis if `behind`."""
    a, b, h, d = LINKAGES[name]
    with mp.workdps(3 * DIGITS):
        start, down = mp.pi if behind else mp.mpf(0), (WEIGHT, -mp.pi / 2)
    bodies = {name: multibody.Body(mass, (along, across), i) for name, (mass, along, across, i) in DATA.items()}
    branch = lambda phi: side(name, assembly, phi - start)  # noqa: E731
    bar = FourBar(a, b, h, -d if behind else d, branch, bodies, down, SPEED, ACCELERATION)
    with mp.workdps(3 * DIGITS):
        found = multibody.four_bar(bar, DIGITS).solve(angle)
    return {
        **{name: found[name] for name in ("balancing_torque", "B", "A", "O2", "O")},
        **{order: found[order]["B"] for order in ("position", "velocity", "acceleration")},
        **{f"{link}_rate": found["velocity"][link, "angle"] for link in DATA},
        **{f"{link}_angular_acceleration": found["acceleration"][link, "angle"] for link in DATA},
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
