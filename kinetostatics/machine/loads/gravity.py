"""Weight of the links: a field of constant acceleration."""

import math
from dataclasses import dataclass
from functools import reduce
from typing import Annotated, Any

from ...numbers import checks
from ...numbers.lazy import cached_property
from ...numbers.planar import add_vectors, dot, plus, product
from ..crank import ray
from ..links import arm
from .load import Load
from .slider import spring_masses


@dataclass(frozen=True, eq=False)
class Gravity(Load):
    """Weight of every link, and of springs with mass, half of which acts on their slider.

    Parameters
    ----------
    acceleration : float
        m/s2. The default 9.81 is the rounded value of studies and textbooks; standard gravity is 9.80665, 0.03 % less
        (ISO 80000-3).
    direction : float
        Direction of the pull, counter-clockwise from +x, rad; by default straight down (-pi/2).

    Raises
    ------
    ParameterError
        The acceleration is negative, or a value is no number or not finite.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
    >>> round(float(ks.solve(pump, 0.0, crank_speed=0.0, loads=ks.Gravity()).guide_force), 12)
    9.81
    """

    acceleration: Annotated[
        Any, checks.Number("m/s**2", low=0.0, usual=checks.PlausibleRange(100.0, "is it in mm/s2?", 1e-3))
    ] = 9.81
    direction: Annotated[Any, checks.Number("rad")] = -math.pi / 2

    PATH = "gravity"
    RULES = checks.Rules("gravity")

    @cached_property
    def vector(self):
        """Acceleration (x, y), m/s2."""
        x, y = ray(self.direction)
        return self.acceleration * x, self.acceleration * y

    def potential(self, motion):
        """Potential energy of all links and of half the mass of springs, J; zero at O."""
        links = motion.placement.links
        parts = [self._link_potential(links[name], link.body) for name, link in motion.mechanism.links.items()]
        for name, mass in spring_masses(motion.loads).items():
            parts.append(product(mass.shaking, -dot(self.vector, links[name].joint.position)))
        return reduce(plus, parts)

    def _link_potential(self, motion, body):
        centre = add_vectors(motion.joint.position, arm(motion.direction, body.along, body.across))
        return product(body.mass, -dot(self.vector, centre))
