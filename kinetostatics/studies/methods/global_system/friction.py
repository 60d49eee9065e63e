"""Friction as forces at points and couples, for equations that hold all reactions, by formulas of complex numbers.

Reactions hang on the friction that they cause: the equations are solved anew, with the friction of the forces found
last, until nothing changes. What is left of an error each time is about the coefficient of friction.
"""

from typing import ClassVar

from ....errors import NotGivenError
from ....machine.group import FRAME
from ....machine.links import Rolling, Sliding, Turning
from ..structures import structure

TIMES = 2000
"""How often forces are found anew, at most."""


class Rubbing:
    """What friction does in one posture, from reactions.

    Parameters
    ----------
    acting : Acting
        The posture.
    solution : Solution
    """

    def __init__(self, acting, solution):
        if solution.friction.senses:
            raise NotGivenError("friction of a sense that is given, not of the motion, has no independent formula")
        self._acting, self._friction = acting, solution.friction.acting
        self._number, self._speed = acting.number, acting.number(solution.crank_speed)
        self._numbers = structure(acting.mechanism)[1] if self._friction else {}

    def settled(self, solve, named, largest, limit):
        """Unknowns of equations that are solved with the very friction that their forces cause.

        Parameters
        ----------
        solve : function
            ``solve(effects)`` with forces, the links and points they act at, and couples added.
        named : function
            Forces by name of what `solve` returns.
        largest : function
            Size of the largest of such unknowns.
        limit : number
            How much the last ones may still change, relative to the largest.
        """
        found = solve(())
        for _ in range(TIMES if self._friction else 0):
            before, found = found, solve(self._effects(named(found)))
            if largest(found - before) <= limit * largest(found):
                return found
        if self._friction:
            raise NotGivenError(f"forces and friction still change after being found {TIMES} times")
        return found

    def along(self, forces):
        """Force of friction on what slides, which is part of the reaction, by pair."""
        pairs = self._acting.mechanism.pairs
        slides = {name: item for name, item in self._friction.items() if isinstance(pairs[name], Sliding)}
        return {name: self._sliding(name, pairs[name], item, forces)[0][1] for name, item in slides.items()}

    def _effects(self, forces):
        pairs = self._acting.mechanism.pairs
        return [
            effect
            for name, friction in self._friction.items()
            for effect in self._KINDS[type(pairs[name])](self, name, pairs[name], friction, forces)
        ]

    def _turning(self, name, pair, friction, forces):
        other = pair.against or self._acting.mechanism.joints[pair.joint].link
        turning = self._at(pair.link)[-1] - self._at(other)[-1]
        size = self._number(friction.mu) * self._number(friction.radius) * abs(forces[name])
        couple = -size * self._sign(turning)
        return [(pair.link, 0.0, 0.0, couple), (other, 0.0, 0.0, -couple)]

    def _sliding(self, name, pair, friction, forces):
        place = self._acting.point(pair.joint)[1]
        if pair.against == FRAME:
            way = self._at(pair.link)[1]
        else:
            angle = self._number(self._numbers[f"{pair.against}_{pair.joint}_angle"])
            way = self._at(pair.against)[1] * self._acting.expj(angle)
        press = abs(forces[pair.force])
        if friction.half_length is not None:
            edges = abs(forces[pair.couple]) / self._number(friction.half_length)
            press = self._acting.where(edges > press, edges, press)
        sliding = (way.conjugate() * (self._moving(pair.link, place) - self._moving(pair.against, place))).real
        force = -self._number(friction.mu) * press * self._sign(sliding) * way
        return [(pair.link, force, place, 0.0), (pair.against, -force, place, 0.0)]

    def _rolling(self, name, pair, friction, forces):
        """On the pin of the roller, whose contact pulls along the curve as much as its pin holds it back."""
        _, place, moving = self._acting.point(pair.joint)
        way = moving / abs(moving) * self._sign(self._speed)
        radius, mu = self._number(friction.roller_radius), self._number(friction.mu)
        reach = mu * self._number(friction.pin_radius)
        pressed = forces[pair.force]
        side = self._sign(pressed)
        turning = -side * (way.conjugate() * moving).real / radius - self._at(pair.link)[-1]
        couple = reach * abs(pressed) / (1 - (reach / radius) ** 2) ** 0.5 * self._sign(turning)
        return [(pair.link, couple / (side * radius) * way, place, couple)]

    _KINDS: ClassVar = {Turning: _turning, Sliding: _sliding, Rolling: _rolling}

    def _at(self, link):
        return (0.0, 1.0, 0.0, 0.0) if link == FRAME else self._acting.at(link)

    def _moving(self, link, place):
        """Velocity of what is at a place of a link."""
        joint, _, shift, spin = self._at(link)
        return shift + 1j * spin * (place - joint)

    def _sign(self, part):
        return self._acting.where(part < 0, -1.0, 1.0)
