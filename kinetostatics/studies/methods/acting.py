"""Loads as forces at points and couples, by formulas of complex numbers that share nothing with the kernels."""

from typing import Any

from ...errors import NotGivenError
from ...machine.group import FRAME
from ...machine.loads import Force, PointDamper, PointForce, PointSpring, Torque, TorsionDamper, TorsionSpring
from ...machine.loads.points import carrier


class Acting:
    """What loads do on links in one posture; derived classes say where links are, in their own numbers.

    They give ``at(link)``: reference joint, axis, velocity of the joint and angular velocity of a link; ``number`` and
    ``value`` (of a load) of what loads hold; and ``expj``, ``arg`` and ``where`` of their numbers.
    """

    mechanism: Any
    at: Any
    number: Any
    value: Any
    expj: Any
    arg: Any
    where: Any

    def point(self, place):
        """Link, position and velocity of a place."""
        link, along, across = carrier(self.mechanism, place)
        offset = self.number(along) + 1j * self.number(across)
        if link == FRAME:
            return link, offset, 0.0
        joint, axis, shift, spin = self.at(link)
        return link, joint + offset * axis, shift + 1j * spin * offset * axis

    def of(self, item):
        """Force, the link and point it acts at, and the couple on that link, of each effect of a load."""
        if isinstance(item, Force):
            link, position, _ = self.point(item.at)
            axis = 1.0 if item.along is None else self.at(item.along)[1]
            return [(link, self.value(item) * self.expj(self.number(item.direction)) * axis, position, 0.0)]
        if isinstance(item, Torque | TorsionSpring | TorsionDamper):
            couple = self.couple(item)
            other = [] if item.against in (None, FRAME) else [(item.against, 0.0, 0.0, -couple)]
            return [(item.on, 0.0, 0.0, couple), *other]
        if isinstance(item, PointForce | PointSpring | PointDamper):
            (link, start, shift), (other, end, swing) = map(self.point, item.between)
            force = self.pull(item, start - end, shift - swing)
            return [(link, force, start, 0.0), (other, -force, end, 0.0)]
        raise NotGivenError(f"there is no independent formula for a {type(item).__name__}")

    def couple(self, item):
        """Couple of a load on its link."""
        if isinstance(item, Torque):
            return self.value(item)
        fixed = item.against in (None, FRAME)
        _, axis, _, spin = self.at(item.on)
        _, base, _, turning = (0.0, 1.0, 0.0, 0.0) if fixed else self.at(item.against)
        if isinstance(item, TorsionDamper):
            return -self.number(item.coefficient) * (spin - turning)
        angle = self.arg(axis / base * self.expj(-self.number(item.free_angle)))
        return self.number(item.moment) - self.number(item.stiffness) * angle

    def pull(self, item, apart, opening):
        """Force of a load between points on the first, by the vector between them and its rate."""
        distance = abs(apart)
        if isinstance(item, PointDamper):
            unit = self.where(distance > 0, apart, opening)
            size = abs(unit)
            unit = unit / self.where(size > 0, size, 1.0)
            return -self.number(item.coefficient) * (unit.conjugate() * opening).real * unit
        unit = apart / self.where(distance > 0, distance, 1.0)
        if isinstance(item, PointForce):
            return self.value(item) * unit
        return -self.number(item.stiffness) * (distance - self.number(item.free_length)) * unit
