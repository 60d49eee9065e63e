"""What loads put on links besides their weight, as arguments of equations that were made without them.

Plain numbers, of springs too, are known once; tables and functions, which read the library's motion as a user's own
would read theirs, and loads at points are computed each time.
"""

from typing import Any

import numpy as np

from ...machine.loads import Gravity, ProcessForce, Spring
from ...mechanics.load_values import pushed, settled
from .acting import Acting

PARTS = "x", "y", "moment"


class Applied(Acting):
    """Loads of a solution. Called, it gives by name what depends on the motion; ``numbers`` are the others.

    Under a link's name with "_load_x", "_load_y", "_load_moment" are force and moment about its reference joint, under
    a slider's with "_push" the force along its guide, with "_stiffness", "_free" and "_cubic" the numbers of a spring.

    Parameters
    ----------
    solution : Solution
    result : function
        ``result(name)`` is a function that computes a result of the equations' own motion.
    """

    expj, arg, where = (staticmethod(function) for function in (lambda angle: np.exp(1j * angle), np.angle, np.where))

    def __init__(self, solution, result):
        self.solution, self.mechanism = solution, solution.mechanism
        links, sliders, loads = self.mechanism.links, self.mechanism.guides, solution.loads
        self.numbers: dict[str, Any] = {f"{link}_load_{part}": 0 for link in links for part in PARTS}
        self.numbers |= {f"{slider}_{part}": 0 for slider in sliders for part in ("push", "stiffness", "free", "cubic")}
        pushes = [item for item in loads if hasattr(item, "push")]
        self.springs, self.pushes = [], []
        for item in pushes:
            if isinstance(item, Spring):
                self.springs.append(item)
            elif isinstance(item, ProcessForce) and isinstance(item.force, int | float):
                self.numbers[f"{item.on}_push"] += item.force
            else:
                self.pushes.append(item)
        for item in {item.on: item for item in reversed(self.springs)}.values():
            parts = {"stiffness": item.stiffness, "free": item.free_position, "cubic": item.cubic}
            self.numbers |= {f"{item.on}_{part}": value for part, value in parts.items()}
            self.springs.remove(item)
        self.others = [item for item in loads if not hasattr(item, "push") and not isinstance(item, Gravity)]
        self.travels = {item.on: result(f"{item.on}_position") for item in self.springs}
        self.motions = {link: result(f"{link} in motion") for link in links} if self.others else {}
        self.fixed = self.numbers
        moving = self()
        self.numbers = {name: value for name, value in self.fixed.items() if name not in moving}

    def __call__(self):
        found: dict[str, Any] = {}

        def add(name, amount):
            found[name] = found.get(name, self.fixed[name]) + amount

        for item in self.springs:
            (travel,) = self.travels[item.on]()
            away = travel - item.free_position
            add(f"{item.on}_push", -item.stiffness * away - item.cubic * away**3)
        for item in self.pushes:
            add(f"{item.on}_push", pushed(item, self.solution))
        self.places = {link: run() for link, run in self.motions.items()}
        for item in self.others:
            for link, force, at, couple in self.of(settled(item, self.solution)):
                if link in self.places:
                    turning = couple + np.imag(np.conj(at - self.at(link)[0]) * force)
                    for part, amount in zip(PARTS, (np.real(force), np.imag(force), turning), strict=True):
                        add(f"{link}_load_{part}", amount)
        return found

    def number(self, value):
        return value

    def value(self, item):
        return item.value_now

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        x, y, cosine, sine, to_x, to_y, spin = self.places[link]
        return x + 1j * y, cosine + 1j * sine, to_x + 1j * to_y, spin
