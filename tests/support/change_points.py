"""Four-bars and slotted levers with change points, and their motion and forces by a reference of 80 digits."""

from functools import cache
from itertools import product

import mpmath as mp
import numpy as np

import kinetostatics as ks
from support.every import every

from . import multibody
from .machines import FourBar

DATA = {"crank": (2.0, 0.3, 0.1, 0.2), "coupler": (1.5, 0.7, -0.2, 0.1), "rocker": (3.0, 0.4, 0.25, 0.5)}
OF_LEVER = {"crank": DATA["crank"], "lever": DATA["coupler"], "block": (3.0, 0.04, 0.25, 0.5)}
LINKS, LEVER_LINKS = (
    {name: ks.Link(mass, (along, across), inertia) for name, (mass, along, across, inertia) in data.items()}
    for data in (DATA, OF_LEVER)
)
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
LEVERS = {
    "meeting": (1.0, 0.0),
    "outside left": (2.0, 1.0),
    "outside right": (2.0, -1.0),
    "inside left": (0.5, 0.5),
    "inside right": (0.5, -0.5),
    "grazing": (1.0 + 2.0**-7, 2.0**-7),
}
"""Distance of the pivot and offset of the slot, for a crank of 1 m."""
SIDES = {"open": 1, "crossed": -1}
each, each_lever = (every("name, assembly", list(product(names, SIDES))) for names in (LINKAGES, LEVERS))
SPEED, ACCELERATION, WEIGHT = 2.0, 1.5, 9.81
DIGITS = 80
"""Of the reference, whose equations lose half of them 1e-17 rad from a change point."""
NEAR = [sign * 10.0**-power for power in (1, 4, 8, 14) for sign in (1, -1)]


def four_bar(name, assembly, pivot=None, **links):
    a, b, h, d = map(float, LINKAGES[name])
    return ks.four_bar(a, b, h, rocker_pivot=pivot or (d, 0.0), assembly=assembly, **(links or LINKS))


def lever(name, assembly, start=0.0):
    """A slotted lever whose pivot lies at an angle from O."""
    distance, offset = LEVERS[name]
    pivot = (distance * np.cos(start), distance * np.sin(start)) if start else (distance, 0.0)
    return ks.slotted_lever(1.0, pivot=pivot, offset=offset, assembly=assembly, **LEVER_LINKS)


def turned(name, assembly, start):
    """Either, with its pivot at an angle from O."""
    if name in LEVERS:
        return lever(name, assembly, start)
    ground = LINKAGES[name][3]
    return four_bar(name, assembly, (ground * np.cos(start), ground * np.sin(start)))


def at_zero(name, assembly):
    """Either, with a change point at the crank angle 0, near which angles are as fine as they can be."""
    if name in LEVERS:
        return lever(name, assembly)
    return four_bar(name, assembly, (-float(LINKAGES[name][3]), 0.0) if SINGLE.get(name) == "far" else None)


def solve(made, angles, **options):
    given = {"crank_speed": SPEED, "crank_acceleration": ACCELERATION, "loads": ks.Gravity(WEIGHT)}
    return ks.solve(made, angles, **given | options)


# Quantities: a method of solutions and what it is asked for


BALANCE = ("balancing_torque",)
OF_BARS = [
    *(("reaction", joint) for joint in ("A", "B", "O", "O2")),
    *((order, "B") for order in ("position", "velocity", "acceleration")),
    *(("rate", link) for link in DATA),
    *(("angular_acceleration", link) for link in DATA),
]
OF_LEVERS = [
    *(("reaction", joint) for joint in ("A", "O2", "O")),
    *(("scalar", name) for name in ("slot_force", "slot_moment")),
    *(("rate", "lever"), ("angular_acceleration", "lever"), ("measure", "block_position"), ("direction", "lever")),
]


def quantities(name):
    return [BALANCE, *(OF_LEVERS if name in LEVERS else OF_BARS)]


def read(solution, method, *asked):
    """A quantity over the crank angles; a vector as a complex number."""
    if method == "direction":
        found = solution.placement.links[asked[0]].direction
    else:
        found = getattr(solution, method)(*asked) if asked else getattr(solution, method)
    if method in ("reaction", "position", "velocity", "acceleration", "direction"):
        found = found[0] + 1j * np.asarray(found[1])
    return np.broadcast_to(found, solution.shape)


# Reference: the side of the branch in the equations of all bodies


def side(name, assembly, psi):
    kind = "near" if name in LEVERS else SINGLE.get(name)
    turning = mp.cos(psi / 2) if kind == "far" else mp.sin(psi / 2) if kind else mp.sin(psi)
    return SIDES[assembly] * mp.sign(turning)


@cache
def reference(name, assembly, angle):
    """The quantities of a machine with its change point at 0."""
    start = mp.mpf(0)
    with mp.workdps(3 * DIGITS):
        if SINGLE.get(name) == "far":
            start = mp.pi
        branch = lambda phi: side(name, assembly, phi - start)  # noqa: E731
        data = OF_LEVER if name in LEVERS else DATA
        bodies = {link: multibody.Body(mass, (along, across), i) for link, (mass, along, across, i) in data.items()}
        if name in LEVERS:
            down = mp.mpc(0, -WEIGHT)
            system = multibody.slotted_lever(*LEVERS[name], branch, bodies, SPEED, ACCELERATION, down, DIGITS)
        else:
            a, b, h, d = LINKAGES[name]
            bar = FourBar(a, b, h, -d if start else d, branch, bodies, (WEIGHT, -mp.pi / 2), SPEED, ACCELERATION)
            system = multibody.four_bar(bar, DIGITS)
        solved = system.solve(angle)
        found = {"direction": {}, "measure": {}}
        if name in LEVERS:
            direction = system.poses["lever"][1](mp.mpf(angle))
            found["direction"]["lever"] = direction
            found["measure"]["block_position"] = mp.re(mp.conj(direction) * (mp.expj(angle) - LEVERS[name][0]))
    found |= {order: solved[order] for order in ("position", "velocity", "acceleration")}
    found |= {"reaction": solved, "scalar": solved}
    found["rate"] = {link: solved["velocity"][link, "angle"] for link in bodies}
    found["angular_acceleration"] = {link: solved["acceleration"][link, "angle"] for link in bodies}
    return {key: found[key[0]][key[1]] if key[1:] else solved[key[0]] for key in quantities(name)}


def errors(solution, place, expected):
    """Relative to the value itself, of vectors to the largest component; of positions to 1 m at least."""
    found = {}
    for key, exact in expected.items():
        exact, value = mp.mpc(exact), mp.mpc(complex(read(solution, *key)[place]))
        apart, size = value - exact, max(abs(exact.real), abs(exact.imag))
        size = max(size, 1) if key[0] == "position" else size if size > 1e-40 else 1
        found[key] = float(max(abs(apart.real), abs(apart.imag)) / size)
    return found
