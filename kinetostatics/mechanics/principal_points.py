"""Principal points: the common mass centre as a sum of vectors along the links, and the shaking force from it.

Going from joint to joint along the links, the position of every mass is a sum of vectors of constant length fixed in
the links. Collected link by link and divided by the whole mass m, they are the principal-point vectors h of each link
(Fischer's method; mower study, Kotov 2024): of a crank-slider

    h1 = (m1 L_OS1 + (m2 + m3) L_OA) / m,   h2 = (m2 L_AS2 + m3 L_AB) / m,   h3 = m3 L_BS3 / m

Their sum is the common mass centre, and F = -m a_S the shaking force. A joint that no link keeps at a constant distance
contributes separately. A fixed pivot adds a constant vector, a cam-guided pin A its motion times the mass it carries.
"""

from dataclasses import dataclass
from functools import reduce
from typing import Any

from ..errors import ParameterError
from ..machine.group import FRAME
from ..machine.links import acceleration_of, arm, first_at, present, second_at
from ..machine.loads import Load, spring_masses
from ..numbers import checks
from ..numbers.formatting import with_units
from ..numbers.planar import add_vectors, plus, product, scale_vector


@with_units(mass="kg", static_moments="kg m", carried="kg")
@dataclass(frozen=True, eq=False)
class PrincipalPoints:
    """Principal points of a mechanism; `principal_points` returns them.

    Attributes
    ----------
    mass : float or array
        Mass of all moving links, and half of that of springs, kg.
    static_moments : dict of link to (along, across)
        m h of each link in its own axes, kg m, which a counterweight on the link cancels.
    carried : dict of joint to mass
        Mass, kg, carried by a joint that no link keeps at a constant distance: pin A of a cam-guided block, a fixed
        pivot.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.15), slider=ks.Link(5.0))
    >>> points = ks.principal_points(mower)
    >>> points.mass, {link: round(h, 6) for link, h in points.moduli.items()}
    (8.0, {'crank': 0.035625, 'coupler': 0.225, 'slider': 0.0})
    """

    mass: Any
    static_moments: dict
    carried: dict

    @property
    def moduli(self):
        """Modulus h by link, m, positive along the link; 0 for a link without effect."""
        return {link: along / self._present_mass() for link, (along, _) in self.static_moments.items()}

    @property
    def offsets(self):
        """Component of the principal-point vector across the link, by link, m; 0 if mass centres lie on the links."""
        return {link: across / self._present_mass() for link, (_, across) in self.static_moments.items()}

    def vectors(self, motion):
        """Principal-point vectors by link, and by joint that contributes separately, (2, ..., N), m."""
        mass = self._present_mass()
        links = {
            name: motion.as_vector(scale_vector(1.0 / mass, arm_in))
            for name, (_, arm_in) in self._arms(motion.placement).items()
            if arm_in is not None
        }
        joints = {name: part / mass * motion.position(name) for name, part in self.carried.items()}
        return {**joints, **links}

    def contour(self, motion):
        """Corners of the chain of principal-point vectors from O to the common mass centre, (K + 1, 2, ..., N), m."""
        corners = [motion.position("O")]
        for vector in self.vectors(motion).values():
            corners.append(corners[-1] + vector)
        return corners

    def mass_centre(self, motion):
        """Position of the common mass centre, (2, ..., N), m.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> mower = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.15), slider=ks.Link(5.0))
        >>> ks.principal_points(mower).mass_centre(ks.solve(mower, 0.0, crank_speed=63.0)).round(6)  # m
        array([0.295143, 0.      ])
        """
        return self.contour(motion)[-1]

    def mass_centre_velocity(self, motion):
        """Velocity of the common mass centre, (2, ..., N), m/s."""
        moving = [first_at(link, lever) for link, lever in self._arms(motion.placement).values()]
        moving += [scale_vector(part, motion.placement.joints[name].first) for name, part in self.carried.items()]
        total = scale_vector(motion.crank_speed / self._present_mass(), reduce(add_vectors, moving, None))
        return motion.as_vector(total)

    def mass_centre_acceleration(self, motion):
        """Acceleration of the common mass centre, (2, ..., N), m/s2."""
        return -self.shaking_force(motion) / self._present_mass()

    def shaking_force(self, motion):
        """Force of the inertia of all moving masses on the frame, minus mass times a_S, (2, ..., N), N."""
        arms, moved = self._arms(motion.placement).values(), motion.placement.joints
        parts = [acceleration_of(first_at(*each), second_at(*each), *motion.accelerating) for each in arms]
        for name, mass in self.carried.items():
            joint = moved[name]
            parts.append(scale_vector(mass, acceleration_of(joint.first, joint.second, *motion.accelerating)))
        return motion.as_vector(scale_vector(-1.0, reduce(add_vectors, parts, None)))

    def _arms(self, placement):
        """By link: the link turning about a fixed joint, and its static moment in the frame's axes, kg m."""
        arms = {}
        for name, (along, across) in self.static_moments.items():
            link = placement.links[name]
            in_place = link._replace(joint=link.joint._replace(first=None, second=None))
            arms[name] = in_place, arm(link.direction, present(along), present(across))
        return arms

    def _present_mass(self):
        if isinstance(self.mass, int | float) and self.mass == 0:
            raise ParameterError("the mechanism has no mass and so no mass centre; give at least one link a mass")
        return self.mass


def principal_points(mechanism, loads=()):
    """Principal points of any mechanism, from its link masses and joints.

    Parameters
    ----------
    mechanism : Mechanism
    loads : sequence of loads, or one
        Half of the mass of springs moves with their slider and has their momentum.

    Returns
    -------
    PrincipalPoints
        `.moduli` (h by link, m), `.vectors`, `.contour`, `.mass_centre`, `.mass_centre_velocity`,
        `.mass_centre_acceleration` and `.shaking_force` of a solution.

    Raises
    ------
    ParameterError
        The first argument is not a mechanism, the loads are no loads, or a spring is on an unknown slider.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.15), slider=ks.Link(5.0))
    >>> s = ks.solve(mower, 1.0, crank_speed=63.0)
    >>> points = ks.principal_points(mower)
    >>> bool(np.allclose(points.shaking_force(s), s.shaking_force))
    True
    """
    loads = loads if isinstance(loads, list | tuple) else (loads,)
    strange = (item for item in loads if not isinstance(item, Load) and not hasattr(item, "push"))
    checks.require(
        "principal_points",
        checks.mechanism("mechanism", mechanism),
        *(f"loads must be loads, as of a scene, got {checks.shown(item)}" for item in strange),
    )
    links = mechanism.links.items()
    springs = {name: mass.shaking for name, mass in spring_masses(loads).items()}
    elsewhere = (name for name in springs if name not in mechanism.guides)
    checks.require(
        "principal_points", *(checks.choice("Spring: on", name, tuple(mechanism.guides)) for name in elsewhere)
    )
    masses = [(name, link.mass) for name, link in links] + [*springs.items()]
    static_moments = {name: (link.mass * link.centre[0], link.mass * link.centre[1]) for name, link in links}
    carried: dict[str, Any] = {}
    bars = {bar.end: bar for bar in reversed(mechanism.bars)}
    for name, mass in masses:
        joint = mechanism.references[name]
        while True:
            point = mechanism.joints.get(joint)
            if joint in bars:
                bar = bars[joint]
                on, place, joint = bar.link, (bar.length, 0.0), bar.start
            elif point.link != FRAME and mechanism.references[point.link] != joint:
                on, place, joint = point.link, (point.along, point.across), mechanism.references[point.link]
            else:
                break
            static_moments[on] = tuple(
                plus(moment, product(mass, present(part)))
                for moment, part in zip(static_moments[on], place, strict=True)
            )
        if joint != "O" and present(mass) is not None:
            carried[joint] = carried.get(joint, 0.0) + mass
    return PrincipalPoints(sum(mass for _, mass in masses), static_moments, carried)
