"""Loads on a slider along its guide: spring and process force; positive in the direction of the guide.

Between its foot on the frame and its end on the slider a uniform spring of mass m stretches evenly. Its point at a
share h of its length moves at h times the slider's speed v. Hence, as integrals over h from 0 to 1,

    kinetic energy  m v^2 / 6        momentum  m v / 2        potential energy of its weight  -m g . B / 2

A third of m is in the slider's equation of motion, half of m in the shaking force and in the weight on the slider. The
foot carries the other half of the weight. With c e the elastic force, a the slider's acceleration and g_u the component
of gravity along the guide, the spring pushes along the guide

    the slider by  -c e - m a / 3 + m g_u / 2        the frame by  c e - m a / 6 + m g_u / 2

The sum is minus the change of its momentum, m a / 2, plus its weight. At harmonic n of a crank speed w the end of a
spring with waves has the stiffness c z cot z, z = n w sqrt(m / c) (`surge`). Here c - m (n w)^2 / 3 is the start of its
series.
"""

from collections.abc import Iterable
from dataclasses import KW_ONLY, dataclass, field
from typing import Annotated, Any, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.planar import add_vectors, minus, number_or_zero, plus, product, rotate, scale_vector, subtract_vectors
from ..dimensions import ORIGIN, Span
from ..links import acceleration_of, present
from ..supports import Support
from . import surge
from .load import Load, Symbol, value_rule
from .table import Table
from .table_pieces import TURN, WholeTurns

REACTIONS = ("outside", "frame")
"""Bodies that may take the force opposite to a process force."""


class SliderLoad(Load):
    """A load on the slider `on` along its guide; the frame takes the opposite force on the same line."""

    on: Annotated[str, checks.Name()]

    def push(self, motion) -> Any:
        """Force on the slider along the guide, N."""
        raise NotImplementedError

    def foot(self, motion) -> Any:
        """Coordinate along the guide at which the frame takes the force, m: by default that of the pin."""
        return motion.placement.travels[self.on].position

    def dimensions(self, mechanism):
        """Coordinates along the guide."""
        guide = mechanism.guides[self.on]
        places = {name: rotate((getattr(self, name), guide.guide_offset), guide.direction) for name in self.LENGTHS}
        return {(name,): Span(ORIGIN, place, guide.direction) for name, place in places.items()}

    def rests_on_frame(self, mechanism):
        return True

    def support(self, motion):
        """The opposite force on the frame, on the line along the guide through the pin."""
        line = motion.mechanism.guides[self.on].line
        point = rotate((self.foot(motion), number_or_zero(line.offset)), line.direction)
        return Support(rotate((minus(None, self.push(motion)), 0.0), line.direction), point)

    def misplaced(self, mechanism):
        """Yield the problem of an unknown slider, or None."""
        problem = checks.choice(f"{type(self).__name__}: on", self.on, tuple(mechanism.guides))
        if problem and not mechanism.guides:
            problem += f"; {mechanism.name} has no slider, a Force or PointSpring acts at any point"
        yield problem


@dataclass(frozen=True, eq=False)
class Spring(SliderLoad):
    """Spring along the guide, acting at the slider pin.

    Parameters
    ----------
    stiffness : float or array
        N/m, all springs together.
    free_position : float or array
        Coordinate of B along the guide (B . guide direction) at which the spring is unloaded, m.
    on : str
        Slider on which it acts.
    cubic : float or array
        N/m3, factor of the cube of the elongation in the force; negative for a softening spring.
    mass : float or array
        kg, of all springs together. Each is uniform, has its foot on the frame, and stretches evenly, also with a
        cubic term. Waves in the coils are neglected; a `HintWarning` names the scenes in which they matter
        (`ks.design.spring_surge`). A third of the mass moves with the slider in energies, reduced inertia, reactions
        and torque; half of it counts in the shaking force. Half of its weight acts on the slider, half on the foot.

    Raises
    ------
    ParameterError
        The stiffness or mass is negative, or a value is not a finite number; when a scene is made, the
        slider is unknown.

    Notes
    -----
    Kinetic energy m v^2 / 6 and momentum m v / 2 at the slider's speed v: Rayleigh, *The Theory of Sound*, 1894,
    section 156. The force at the foot less that at the slider's end is m a / 2.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2)
    >>> pushed = ks.solve(pump, 1.5, crank_speed=0.0, loads=ks.Spring(1e3, 0.25))  # B is nearer to O: outwards
    >>> bool(pushed.balancing_torque > 0)
    True
    >>> heavy = ks.solve(pump, 0.0, crank_speed=10.0, loads=ks.Spring(1e3, 0.25, mass=0.6))
    >>> print(f"{heavy.shaking_force[0]:.3f} N")  # of half the mass at -6.25 m/s2
    1.875 N
    """

    stiffness: Annotated[Any, checks.Number("N/m", low=0.0)]
    free_position: Annotated[Any, checks.Number("m")]
    on: str = "slider"
    cubic: Annotated[Any, checks.Number("N/m**3")] = 0.0
    mass: Annotated[Any, checks.Number("kg", low=0.0)] = 0.0

    PATH, LENGTHS = "spring", ("free_position",)
    RULES = checks.Rules("spring")

    @classmethod
    def balancing(cls, mass, crank_speed, free_position, on="slider", *, spring_mass=0.0) -> "Spring":
        """Spring that balances the inertia force of a slider with a cosine law.

        Its stiffness c is mass M times crank speed w squared, so spring and inertia force are opposite at every angle.
        A spring of mass m needs the stiffness c z cot z = M w^2 at its end, z = w sqrt(m / c), waves included. That is
        z tan z = m / M, with one root below pi / 2 for every m and M. A scene neglects the waves, so the end of its
        spring is stiffer by at least c z^4 / 45.

        Parameters
        ----------
        mass : float
            Mass that moves with the slider, kg.
        crank_speed : float
            rad/s.
        free_position : float
            Slider position at which the spring is free, mid-stroke of the law, m.
        on : str
            The slider.
        spring_mass : float
            Mass of all springs together, kg.

        Raises
        ------
        ParameterError
            The mass is negative, a value not finite, or mass or speed 0: a spring without stiffness has no effect.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> spring = ks.Spring.balancing(600.0, 33.5, free_position=2.0)
        >>> spring.stiffness  # N/m
        673350.0
        >>> round(ks.Spring.balancing(600.0, 33.5, free_position=2.0, spring_mass=300.0).stiffness)
        788903
        """
        weighs = checks.Number("kg", low=0.0)
        rules = {"mass": weighs, "crank_speed": checks.Number("rad/s"), "spring_mass": weighs}
        given = {"mass": mass, "crank_speed": crank_speed, "spring_mass": spring_mass}
        found = checks.check_values("balancing spring", rules, given)
        own = found.pop("spring_mass")
        mass, crank_speed = found.values()
        zero = (name for name, value in found.items() if checks.has_known_values(value) and np.any(value == 0.0))
        if problem := " and ".join(f"the {name.replace('_', ' ')} is 0" for name in zero):
            raise ParameterError(
                f"balancing spring: {problem}, so there is no inertia force to balance and the stiffness would be 0; "
                "give the mass and speed to balance, or the stiffness itself"
            )
        stiffness = mass * crank_speed * crank_speed
        if present(own) is not None:
            stiffness = surge.balancing_stiffness(stiffness, own * crank_speed * crank_speed)
        return cls(stiffness, free_position, on, mass=own)

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return -self.spring_rate(motion) * motion.elongation(self.free_position, self.on)

    def spring_rate(self, motion):
        """Secant stiffness, force over elongation, N/m."""
        if present(self.cubic) is None:
            return self.stiffness
        elongation = motion.elongation(self.free_position, self.on)
        return self.stiffness + self.cubic * elongation * elongation

    def mean_rate(self, position, weights=None):
        """Mean tangent stiffness over the slider's positions in a period, N/m, by design."""
        rate = self.stiffness + 3.0 * self.cubic * (position - self.free_position) ** 2
        return np.mean(rate, axis=-1, keepdims=np.ndim(rate) > 1) if weights is None else rate @ weights

    def parted_rate(self, motion):
        """Secant stiffness as a part that does not depend on the crank angle, and a rest; None for an absent one."""
        if present(self.cubic) is None:
            return self.stiffness, None
        found = motion.outward(self)
        if found is None:
            return self.spring_rate(motion), None
        length, more = found
        return self.stiffness + self.cubic * length * length, self.cubic * (more * (2.0 * length + more))

    def foot(self, motion):
        """Free position, m: there the frame takes the force."""
        return self.free_position

    def potential(self, motion):
        """Strain energy, J."""
        elongation = motion.elongation(self.free_position, self.on)
        square = elongation * elongation
        if present(self.cubic) is None:
            return 0.5 * self.stiffness * square
        return (0.5 * self.stiffness + 0.25 * self.cubic * square) * square

    def support(self, motion):
        """Force at the foot: the opposite of the elastic force, plus half of its weight, less m a / 6 of its mass m."""
        force, point, _ = super().support(motion)
        mass = present(self.mass)
        if mass is not None:
            joint, (square, alpha) = motion.placement.joints[motion.mechanism.references[self.on]], motion.accelerating
            inertia = acceleration_of(joint.first, joint.second, mass / 6.0 * square, product(mass / 6.0, alpha))
            force = subtract_vectors(add_vectors(force, scale_vector(0.5 * mass, motion.gravity)), inertia)
        return Support(force, point)

    def signs(self, motion):
        """Symbol of a spring along the guide."""
        yield Symbol("spring", motion.position(motion.mechanism.references[self.on]), slider=self.on)


class SpringMass(NamedTuple):
    """Mass of the springs on a slider, kg: a third moves with it, half shakes the frame and weighs on the slider."""

    whole: Any
    moving: Any
    shaking: Any


def spring_masses(loads: Iterable[Any]) -> dict[str, SpringMass]:
    """Mass of all springs by slider, for sliders whose springs have mass."""
    found: dict[str, Any] = {}
    for item in loads:
        mass = present(item.mass) if isinstance(item, Spring) else None
        if mass is not None:
            found[item.on] = plus(found.get(item.on), mass)
    return {slider: SpringMass(mass, mass / 3.0, 0.5 * mass) for slider, mass in found.items()}


class WorkForce(SliderLoad):
    """Process force on a slider; the frame or an external body takes the opposite force."""

    reaction: Annotated[str, checks.Word(REACTIONS)]

    def rests_on_frame(self, mechanism):
        return self.reaction == "frame"

    def signs(self, motion):
        """Symbol of a force along the guide."""
        mechanism = motion.mechanism
        along = motion.as_vector(mechanism.guides[self.on].direction)
        yield Symbol("force", motion.position(mechanism.references[self.on]), direction=along, sense=self.sense(motion))


@dataclass(frozen=True, eq=False)
class ProcessForce(WorkForce):
    """Cutting, gas or other force on the slider along the guide, positive in the guide direction.

    Parameters
    ----------
    force : float, array, Table or function
        N. An array has one value for each crank angle; a `Table` is read by crank angle or travel. A function takes the
        `Motion` and returns values that depend, angle by angle, on crank angle, position or velocity. The function must
        be pure, without counters, random numbers or clocks, because engines call it any number of times. The compiled
        engine treats its constants as fixed; a function with other constants is compiled again.
    on : str
        Slider on which it acts.
    period : float, optional
        Period of the force, rad: 4 pi for a four-stroke engine. By default the period of its `Table`, else 2 pi.
    reaction : "outside" or "frame"
        Body that takes the opposite force. It is "outside" for an external body, such as the ground of a mower's crop.
        It is "frame" for the machine's frame: of a saw, whose rollers carry the log, or of an engine, whose cylinder
        takes the gas pressure. It affects only the forces on the frame (`Solution.ground`).

    Raises
    ------
    ParameterError
        A value is not a finite number, or the period not a whole number of turns, or the reaction is neither of these.
        When a scene is made, the slider is unknown.

    Examples
    --------
    >>> import math
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.05, 0.2)
    >>> s = ks.solve(pump, math.pi / 2, crank_speed=10.0, loads=ks.ProcessForce(-200.0))
    >>> round(float(s.balancing_torque), 12)  # B moves by -0.05 m/rad: the force drives
    -10.0
    """

    force: Annotated[Any, value_rule("N")]
    on: str = "slider"
    _: KW_ONLY
    period: Annotated[Any, WholeTurns()] = field(default=None, metadata={"structural": True})
    reaction: str = "outside"

    PATH, VALUE, OVER_ANGLES = "process_force", "force", ("force",)

    def __post_init__(self):
        if self.period is None:
            vars(self).update(period=getattr(self.force, "period", TURN))
        super().__post_init__()

    def _period_problems(self):
        """Sentence if the period differs from that of the force."""
        known = getattr(self.force, "period", self.period)
        if known != self.period:
            yield f"the period is {self.period!r}, but that of its force {known!r}; leave it out"

    RULES = checks.Rules("process force", _period_problems)

    @property
    def value_now(self):
        """The force; a table over travel that names no slider is read by the slider `on`."""
        return self.force.of(self.on) if isinstance(self.force, Table) else self.force

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return self.force
