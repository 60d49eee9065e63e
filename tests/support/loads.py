"""Random loads of every kind on a mechanism."""

import numpy as np

import kinetostatics as ks

KINDS = (
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
