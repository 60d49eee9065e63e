"""Random chains of every kind of group and pin, random loads on them, and errors beside two full systems."""

import numpy as np
from mpmath import mp

import kinetostatics as ks
from kinetostatics.machine.group import FRAME
from kinetostatics.mechanics.quantities import components, of_mechanism
from kinetostatics.studies.methods.global_system import constraints
from kinetostatics.studies.methods.global_system.constraints import Model
from kinetostatics.studies.methods.high_precision.independent import Machine, working_digits

KINDS = ("pin", "slider", "rocker", "dyad", "lever", "cylinder", "yoke")
MARGIN = 0.05
"""Closure, at least, of every group of a random chain."""


def body(rng):
    return ks.Link(rng.uniform(0.5, 5.0), tuple(rng.uniform(-0.2, 0.2, 2)), rng.uniform(0.01, 0.2))


def group(kind, mechanism, placement, number, rng):
    """A group or pin on a random joint or link, of a size that it may close with."""
    label, pin = f"_{number}", f"P{number}"
    moving = [name for name, point in mechanism.joints.items() if point.link != FRAME]
    on = str(rng.choice(moving))
    x, y = (float(np.mean(part)) for part in placement.joints[on].position)
    sign, away = int(rng.choice((-1, 1))), (x + rng.uniform(-0.5, 0.5), y + rng.uniform(-0.5, 0.5))
    guide = ks.Guide.at(rng.uniform(-3, 3), rng.uniform(-0.2, 0.2))
    if kind == "pin":
        return ks.Pin(on=str(rng.choice(list(mechanism.links))), at=tuple(rng.uniform(-0.2, 0.2, 2)), name=pin)
    if kind == "slider":
        return ks.SliderGroup(rng.uniform(0.3, 1.5), guide, sign, body(rng), body(rng), on, pin, label)
    if kind == "rocker":
        lengths = rng.uniform(0.2, 0.8, 2)
        return ks.RockerGroup(*lengths, away, sign, body(rng), body(rng), on, pin, f"Q{number}", label)
    if kind == "dyad":
        ends = on, str(rng.choice([name for name in mechanism.joints if name != on]))
        return ks.Dyad(*rng.uniform(0.2, 0.8, 2), ends, pin, sign, body(rng), body(rng), label)
    if kind == "lever":
        offset = float(rng.choice((0.0, rng.uniform(-0.1, 0.1))))
        return ks.LeverGroup(away, on, offset, body(rng), body(rng), f"Q{number}", label)
    if kind == "cylinder":
        return ks.CylinderGroup(away, on, body(rng), body(rng), f"Q{number}", label)
    return ks.YokeGroup(guide, rng.uniform(0.4, 2.7), on, pin, body(rng), body(rng), label)


def chain(seed, count=4):
    """A scene of random groups with mass everywhere and loads on each slider, and crank angles at which it closes."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0.0, 2 * np.pi) + np.array([-0.1, 0.0, 0.15])
    if rng.uniform() < 0.2:
        cam = ks.cams.Circle(rng.uniform(0.2, 0.4), tuple(rng.uniform(-0.08, 0.08, 2)))
        mechanism = ks.Mechanism("chain", ks.Crank(None, body(rng)), (ks.CamRoller(cam, body(rng)),))
    else:
        mechanism = ks.Mechanism("chain", ks.Crank(rng.uniform(0.1, 0.3), body(rng)), ())
    while len(mechanism.groups) < count:
        made = group(rng.choice(KINDS), mechanism, mechanism.place(angles), len(mechanism.groups), rng)
        longer = ks.Mechanism("chain", mechanism.crank, (*mechanism.groups, made))
        placement = longer.place(angles)
        if np.all(made.closure(placement) > MARGIN):
            mechanism = longer
    loads = [ks.Gravity(rng.uniform(1, 20), rng.uniform(-3, 3))]
    for slider in mechanism.guides:
        loads += [
            ks.ProcessForce(rng.uniform(-99, 99), slider),
            ks.Spring(rng.uniform(1, 500), rng.uniform(-1, 1), slider),
        ]
    return ks.Scene(mechanism, rng.uniform(1, 20), rng.uniform(-50, 50), tuple(loads)), angles


def errors_beside_full_systems(solution, index, digits=12):
    """Largest errors of motion and of forces beside the equations of all bodies in mpmath, at one crank angle."""
    with mp.workdps(working_digits(digits)):
        machine = Machine(mp, solution, index, digits)
        forces = {name: complex(value) for name, value in machine.forces().items()}
        tables = {
            "position": machine.position,
            "velocity": machine.velocity,
            "acceleration": machine.acceleration,
        }
        found = {order: motion_error(solution, index, order, table) for order, table in tables.items()}
    outputs = solution.mechanism.outputs
    unit = max(abs(forces[name]) for name in outputs if outputs[name].unit == "N")
    length = max(1.0, max(np.abs(solution.position(name)).max() for name in solution.mechanism.joints))
    of_forces = {}
    for name in forces.keys() & of_mechanism(solution.mechanism).keys():
        value = forces[name]
        own = complex(*(part.flat[index] for part in components(solution, name)))
        size = unit * (length if of_mechanism(solution.mechanism)[name].unit == "N m" else 1.0)
        of_forces[name] = abs(own - value) / size
    assert set(outputs) <= set(of_forces)
    return found | {"forces": max(of_forces.values())}


def motion_error(solution, index, order, table):
    """Largest error of joints, mass centres and directions of links, relative to the largest of a kind."""
    read = {"position": solution.position, "velocity": solution.velocity, "acceleration": solution.acceleration}[order]
    found = {}
    for (kind, name), value in table.items():
        if kind == "direction":
            own = _turning(solution, index, name, order)
            found.setdefault("turning", []).append((own, complex(value)))
        else:
            own = complex(*(part.flat[index] for part in read(name)))
            found.setdefault("points", []).append((own, complex(value)))
    return max(
        max(abs(own - value) for own, value in pairs) / max(*(abs(value) for _, value in pairs), 1e-3)
        for pairs in found.values()
    )


def _turning(solution, index, link, order):
    """Direction of a link, or its derivative by time."""
    direction = complex(
        *(np.broadcast_to(p, solution.shape).flat[index] for p in solution.placement.links[link].direction)
    )
    if order == "position":
        return direction
    rate = solution.rate(link).flat[index]
    if order == "velocity":
        return 1j * rate * direction
    return (1j * solution.angular_acceleration(link).flat[index] - rate * rate) * direction


def error_beside_constraints(solution):
    """Largest error of all forces beside the multipliers of the constraint equations."""
    model = Model(solution.mechanism)
    q = np.array([model.start(angle) for angle in solution.crank_angle])
    outputs = solution.mechanism.outputs
    missing = set(outputs) - set(model.readings)
    assert not missing, missing
    pairs = {
        name: [np.array(constraints.components(model, solution, name, q)), np.array(components(solution, name))]
        for name in outputs
    }
    unit = max(np.abs(own).max() for _, own in pairs.values())
    return max(np.abs(found - own).max() for found, own in pairs.values()) / unit


LOAD_KINDS = (
    "Gravity",
    "Spring",
    "ProcessForce",
    "Force",
    "PointForce",
    "PointSpring",
    "PointDamper",
    "Torque",
    "TorsionSpring",
    "TorsionDamper",
)


def place(random, mechanism, size):
    """A joint, a place on a link or a fixed point."""
    kind = random.integers(3)
    if kind == 0:
        return str(random.choice(list(mechanism.joints)))
    along, across = random.uniform(-size, size, 2).tolist()
    return (along, across) if kind == 1 else (str(random.choice(list(mechanism.links))), along, across)


def between(random, mechanism, size):
    """Two places on different links, off each other's way."""
    one, other = random.choice([*mechanism.links, ""], 2, replace=False).tolist()
    places = [(name, *random.uniform(-size, size, 2).tolist()) for name in (one, other)]
    return tuple(part if part[0] else part[1:] for part in places)


def value(random, size):
    """A number, or a function of the motion."""
    amount = float(random.uniform(-size, size))
    return (amount, lambda motion: amount * motion.rate("crank") * motion.rate("coupler"))[random.integers(2)]


def load(random, kind, mechanism, size=0.3):
    """A random load of a kind; None if the mechanism can have none, as springs along a guide it has not."""
    link, against = random.choice(list(mechanism.links), 2, replace=False).tolist()
    against = (None, against)[random.integers(2)]
    sliders = list(mechanism.guides)
    number = random.uniform(0.1, 1.0, 4).tolist()
    if kind in ("Spring", "ProcessForce") and not sliders:
        return None
    return {
        "Gravity": lambda: ks.Gravity(10 * number[0], 6 * number[1]),
        "Spring": lambda: ks.Spring(100 * number[0], number[1], str(random.choice(sliders)), 200 * number[2]),
        "ProcessForce": lambda: ks.ProcessForce(value(random, 50.0), str(random.choice(sliders))),
        "Force": lambda: ks.Force(
            value(random, 50.0),
            at=place(random, mechanism, size),
            direction=6 * number[0],
            along=(None, link)[random.integers(2)],
        ),
        "PointForce": lambda: ks.PointForce(value(random, 50.0), between=between(random, mechanism, size)),
        "PointSpring": lambda: ks.PointSpring(
            100 * number[0], (0.0, number[1])[random.integers(2)], between=between(random, mechanism, size)
        ),
        "PointDamper": lambda: ks.PointDamper(20 * number[0], between=between(random, mechanism, size)),
        "Torque": lambda: ks.Torque(value(random, 20.0), on=link, against=against),
        "TorsionSpring": lambda: _swinging(random, mechanism, number),
        "TorsionDamper": lambda: ks.TorsionDamper(2 * number[0], on=link, against=against),
    }[kind]()


def _swinging(random, mechanism, number):
    """A torsion spring on a link that does not pass half a turn from its free angle; None if there is none."""
    links = [name for name in mechanism.links if name not in ("crank", "block")]
    on, against = random.permutation(links)[:2].tolist() if len(links) > 1 else (links[0], None)
    for other in (against, None):
        for free in random.uniform(-3.0, 3.0, 4).tolist():
            spring = ks.TorsionSpring(30 * number[0], free, on=on, against=other, moment=5 * number[1] - 2.0)
            if not spring.refusals(ks.solve(mechanism, np.zeros(1), crank_speed=1.0, on_gap="nan")):
                return spring
    return None
