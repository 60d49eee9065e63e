"""Planetary crank: a planet on the crank pin rolls in a fixed ring of twice its size (Cardan circles).

The crank is the arm, of length a; the pitch circles of planet and ring have the radii a and 2 a. At the arm's angle phi
from the line the planet has the angle -phi. In the axes of the line its pin, at the radius b, has the coordinates

    a (cos phi, sin phi) + b (cos phi, -sin phi) = ((a + b) cos phi, (a - b) sin phi)

on an ellipse, and with b = a on the line itself, 2 a cos phi from O (Artobolevsky, *Mechanisms in Modern Engineering
Design*, 1976). The teeth touch on the arm's ray, 2 a from O, where the planet's own velocity is zero: their force does
no work.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import cos, sin
from ...numbers.planar import left, number_or_zero, rotate, rotate_back, scale_vector, subtract_vectors, vector_or_zero
from ..crank import ray
from ..dimensions import Angle, Span
from ..group import Declaration, Group, GroupLink, Label, Name, Plane, Point, Resolved
from ..links import Joint, Link, LinkMotion, Meshing, Turning

TERMS = {
    "tangential": ("T", "tangential tooth force of the ring on the planet"),
    "separating": ("S", "tooth force that presses the planet off the ring"),
}


class PlanetMotion(NamedTuple):
    """A placed planet; `arm` is the vector from O to its axis, `length` the arm's length, m."""

    planet: LinkMotion
    arm: Any
    length: Any


def place(joint, length, radius, line):
    """Planet and its pin for the joint at the end of the arm (kernel); `line` is the unit vector of the pin's line."""
    along = [rotate_back(vector_or_zero(part), line) for part in joint]
    direction = rotate((along[0][0] / length, -along[0][1] / length), line)
    share = radius / length
    pin = Joint(*(rotate(((1.0 + share) * x, (1.0 - share) * y), line) for x, y in along))
    return PlanetMotion(LinkMotion(joint, direction, -1.0, None), joint.position, length), pin


def resolve(motion, load, pressure_angle):
    """Reactions of arm and ring on the planet, and the tangential tooth force (kernel).

    `load` is the wrench of all other loads about the planet's axis; its moment gives the tangential force. Either flank
    presses the planet off the ring.
    """
    arm, length = motion.arm, motion.length
    radial = (arm[0] / length, arm[1] / length)
    tangential = -number_or_zero(load.moment) / length
    separating = abs(tangential) * sin(pressure_angle) / cos(pressure_angle)
    teeth = subtract_vectors(scale_vector(tangential, left(radial)), scale_vector(separating, radial))
    inner = subtract_vectors(subtract_vectors(None, vector_or_zero(load.force)), teeth)
    return (inner, teeth), (tangential,)


@dataclass(frozen=True, eq=False)
class PlanetaryCrank(checks.Checked, Group):
    """Planet on the crank pin `on` that rolls in a fixed ring of twice its size.

    If `radius` equals the length of the arm, its pin runs on a line through O, with a stroke of four arms. Attach a
    slider to the pin by a `YokeGroup` with its slot across the line; then the guide carries only transverse loads.

    Parameters
    ----------
    radius : float or array
        Distance of the pin from the planet's axis, m: equal to the crank length, it is the radius of the pitch circle.
    line_angle : float or array
        Direction of the pin's line, or of the long axis of its ellipse, from +x, rad.
    pressure_angle : float or array
        Pressure angle of the teeth, rad, below pi/2; 20 degrees by default.
    on, pin : str
        Names of the crank pin, and of the pin that it adds.
    planet : Link
        Reference joint `on`, along its direction to the pin; a counterweight has a negative distance.
    label : str
        Appended to the names of links and forces of a second planet in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        The planet is not on a pin of the crank, or a value is impossible.

    Notes
    -----
    Reactions:

    - `on` (N): on the planet, from the arm.
    - "mesh" (N): ring on planet, at the pitch point.
    - "tooth_force" (N): its tangential part, positive counter-clockwise about O. The other part, its size times the
      tangent of the pressure angle, presses the planet off the ring.

    The teeth have no friction and no play.

    Examples
    --------
    >>> import math
    >>> import kinetostatics as ks
    >>> knife = ks.YokeGroup(on="P", slider=ks.Link(mass=4.6))
    >>> drive = ks.Mechanism("mower", ks.Crank(0.019), (ks.PlanetaryCrank(0.019), knife))
    >>> round(float(ks.solve(drive, math.pi / 3, crank_speed=60.0).slider_position), 12)  # 2 a cos phi
    0.019
    """

    radius: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    line_angle: Annotated[Any, checks.Number("rad")] = 0.0
    pressure_angle: Annotated[Any, checks.Number("rad", low=0.0)] = math.radians(20.0)
    on: Name = "A"
    pin: Name = "P"
    planet: GroupLink = Link()
    label: Label = ""
    plane: Plane = None

    def _steep_teeth_problem(self):
        """Yield the problem of designs whose teeth would push along the arm."""
        if not checks.has_known_values(self.pressure_angle):
            return
        steep, angle = np.asarray(self.pressure_angle) >= np.pi / 2, np.max(self.pressure_angle)
        if np.any(steep):
            yield checks.Problem(f"pressure_angle must be less than pi/2, as 20 degrees, got {angle:.6g} rad", steep)

    LINKS: ClassVar = {"planet": "on"}
    TRUSTED = True
    PATHS: ClassVar = {"radius": "planet_radius", "plane": "planet_plane"}
    RULES = checks.Rules("planetary crank", _steep_teeth_problem)

    @property
    def declaration(self):
        return Declaration(
            joints={self.pin: Point("planet", self.radius)},
            pairs=(Turning("planet", self.on), Meshing("planet", self.on, "mesh", "tooth_force")),
            lengths=(self.radius,),
        )

    @property
    def dimensions(self):
        return {("radius",): Span(self.on, self.pin), ("line_angle",): Angle("O")}

    @property
    def sign_forces(self):
        return (self.called("tooth_force"),)

    def on_crank(self, throws):
        self._require_arm(throws.get(self.on))
        return self

    def _require_arm(self, throw):
        where = f"it is attached to {self.on!r}, but a planet needs a pin of the crank, its arm"
        checks.require(self.RULES.owner, where if throw is None else None)

    def place(self, placement):
        throw = placement.course(self.on).throw
        self._require_arm(throw)
        length, _ = throw.polar
        motion, pin = place(placement.joints[self.on], length, self.radius, ray(self.line_angle))
        self.enter(placement, motion, {self.pin: pin})

    def follow(self, placement, joints):
        self.place(placement)

    def closure(self, placement):
        return 1.0

    def requirement(self, placement):
        return "a planet closes at all crank angles"

    def resolve(self, placement, loads, along) -> Resolved:
        (load,) = self.of_links(loads)
        return self.resolved(*resolve(self.placed(placement), load, self.pressure_angle))
