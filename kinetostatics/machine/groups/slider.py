"""Slider group (RRP): coupler from a pin to a slider on a straight guide, in either assembly.

The guide has the direction u, the left normal n and the offset e. A coupler of length l from joint A reaches d = e -
A.n across the guide and +-sqrt((l - d)(l + d)) along it. No angle is formed, so dead centres need no special treatment
at any inclination of the guide.

Where l = r + |e| on a crank r, the coupler becomes perpendicular to the guide. On a chosen side the slider turns back
there, the words "open" and "crossed" let it run on (`change_points`).
"""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import clamped_sqrt, guarded_divisor
from ...numbers.planar import (
    add_vectors,
    minus,
    number_or_zero,
    plus,
    product,
    rotate,
    rotate_back,
    subtract_vectors,
    vector_or_zero,
)
from ..dimensions import Span, within
from ..group import FRAME, Bar, Declaration, Group, GroupLink, Label, Name, Plane, Point, Resolved
from ..guide import Guide, SliderGuide, known_slider, slider_motion
from ..links import Joint, Link, LinkMotion, Slide, Sliding, Turning, link_between
from . import change_points, near_dead_centre
from .branches import Branch, equality
from .change_points import BOTH, FAR, NEAR, divide

MIN_COSINE = 2.0**-27
"""Least cosine of the coupler: its square is a difference with a rounding error of 2^-53."""
TERMS = {
    "position": ("p", "inner joint along the guide (x) and across it (y)"),
    "first": ("p'", "first derivative by phi of that"),
    "second": ("p''", "second derivative by phi of that"),
    "across": ("d", "from the inner joint across to the guide"),
    "along": ("w", "reach of the coupler along the guide"),
    "drawn_in": ("z", "part of the second derivative of that reach from the coupler's rotation"),
    "_from.short": ("f", "coupler's length less its reach along the guide"),
    "resolve.on_slider": ("Q", "force on the slider along its guide (x) and across it (y)"),
    "resolve.along": ("U", "force of the pin on the slider along the guide"),
    "resolve.across": ("V", "force of the pin on the slider across the guide"),
}


class SliderMotion(NamedTuple):
    """A placed slider group; `closure` is cosine squared, `travel` the slider's coordinate along the guide as joint.

    `divisor` is the cosine as a divisor, as `change_points.divide` takes it; `closure` leaves out change points.
    `drawn_in` is the part of the second derivative of the travel from the coupler's rotation; None if unknown.
    """

    coupler: LinkMotion
    slider: LinkMotion
    sine: Any
    cosine: Any
    divisor: tuple[Any, Any]
    closure: Any
    travel: Joint
    drawn_in: Any = None


def place(joint, coupler_length, guide, assembly, swing=None, reached=None):
    """Coupler and slider for a given inner joint (kernel); a guide of None is +x, without offset.

    `reached` comes from a special kernel for a pin of the crank; `swing` is given for a joint on a swinging link.
    """
    position, first, second = (rotate_back(vector_or_zero(part), guide.direction) for part in joint)
    across = minus(guide.offset, position[1]) if swing is None else near_dead_centre.across(swing, guide)
    if reached is None:
        square, unit = (coupler_length - across) * (coupler_length + across), coupler_length * coupler_length
        reach = clamped_sqrt(square, unit)
        divided = assembly * guarded_divisor(reach, MIN_COSINE * coupler_length)
        ratio = -first[1] / divided
        ratio_slope = (ratio * ratio * across - second[1]) / divided
        reached = assembly * reach, ratio, ratio_slope, (divided / coupler_length, None), square / unit
    along, ratio, ratio_slope, divisor, closure = reached

    sine, cosine = across / coupler_length, along / coupler_length
    drawn_in = plus(product(ratio_slope, across), ratio * ratio * along)
    travel = Joint(position[0] + along, first[0] - ratio * across, second[0] - drawn_in)
    coupler = LinkMotion(joint, rotate((cosine, sine), guide.direction), ratio, ratio_slope)
    slider = slider_motion(joint.position, (along, across), travel, guide)
    return SliderMotion(coupler, slider, sine, cosine, divisor, closure, travel, drawn_in)


def resolve(motion, coupler_length, guide, coupler_load, slider_load, push):
    """Forces on the coupler at its inner joint, on the slider at its pin and guide, and the guide's numbers (kernel).

    `push` is the applied force along the guide; loads are all other wrenches about the links' reference joints, with
    the demands of further groups. The slider's balance along the guide gives the pin force along it, moments of the
    coupler about its inner joint the pin force across; the guide carries the rest.
    """
    on_slider = rotate_back(vector_or_zero(slider_load.force), guide.direction)
    along = -plus(on_slider[0], push)
    across = number_or_zero(coupler_load.moment) / coupler_length + motion.sine * along
    if motion.divisor[1] is None:
        (across,) = divide((across,), motion.divisor)
        pin = rotate((along, across), guide.direction)
        carried = rotate((0.0, -(on_slider[1] + across)), guide.direction)
    else:
        aside = divide(rotate((0.0, across), guide.direction), motion.divisor)
        (across,) = divide((across,), motion.divisor)
        pin = add_vectors(rotate((along, 0.0), guide.direction), aside)
        carried = subtract_vectors(rotate((0.0, -on_slider[1]), guide.direction), aside)
    guide_force, guide_moment = -(on_slider[1] + across), number_or_zero(minus(None, slider_load.moment))
    return (subtract_vectors(pin, coupler_load.force), pin, carried), (guide_force, guide_moment)


@dataclass(frozen=True, eq=False)
class SliderGroup(checks.Checked, Branch, Group):
    """Coupler from joint `on` to a slider at joint `pin` on `guide`.

    Parameters
    ----------
    coupler_length : float or array
        m.
    guide : Guide
    assembly : +1, -1, "open" or "crossed"
        +1: slider ahead of the inner joint along the guide. The words are for a group on A or another pin of the
        crank, as for `crank_slider`.
    coupler, slider : Link
    on, pin : str
        Names of the joint it is attached to and of the joint it adds.
    label : str
        Appended to the names of links and forces of a second slider group in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        A value is impossible; the mechanism raises it where the group cannot pass change points that way.

    Notes
    -----
    Reactions, vectors in N:

    - `on`: on the coupler, from the link that carries the joint.
    - `pin`: coupler on slider.
    - "guide": ground on slider; "guide_force" (N): along the guide's left normal; "guide_moment" (N m): about `pin`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> rod = ks.SliderGroup(0.2, ks.Guide.at(0.0, 0.01), slider=ks.Link(mass=1.0))
    >>> pump = ks.Mechanism("pump", ks.Crank(0.05), (rod,))
    >>> round(float(ks.solve(pump, 0.0, crank_speed=10.0).slider_position), 6)
    0.24975
    """

    coupler_length: Annotated[Any, checks.Number("m", "coupler length", low=0.0, strict=True)]
    guide: SliderGuide = Guide()
    assembly: Annotated[int, checks.Sign(tuple(change_points.SIDES))] = 1
    coupler: GroupLink = Link()
    slider: GroupLink = Link()
    on: Name = "A"
    pin: Name = "B"
    label: Label = ""
    plane: Plane = None
    LINKS: ClassVar = {"coupler": "on", "slider": "pin"}
    TRUSTED = True
    PATHS: ClassVar = {"guide": "", "plane": "coupler_plane"}
    KINDS: ClassVar = {"": "none", FAR: "l = a - e", NEAR: "l = a + e", BOTH: "l = a and e = 0"}
    """Crank a, coupler l, offset e of the guide."""
    kernels = change_points.slid, near_dead_centre.slid
    RULES = checks.Rules("slider group")

    @property
    def declaration(self):
        return Declaration(
            joints={self.pin: Point("slider")},
            bars=(Bar(self.on, self.pin, "coupler", self.coupler_length),),
            guides={"slider": self.guide},
            pairs=(
                Turning("coupler", self.on),
                Turning("slider", self.pin, "coupler"),
                Sliding("slider", self.pin, FRAME, "guide_force", "guide_moment"),
            ),
        )

    @property
    def dimensions(self):
        return {("coupler_length",): Span(self.on, self.pin), **within("guide", self.guide.dimensions(self.pin))}

    def sliding(self, name, placement):
        return Slide(self.guide.line.direction, placement.travels[self.called("slider")].first)

    @property
    def start(self):
        """Direction from which the crank angle is halved: the right normal of the guide."""
        x, y = self.guide.direction
        return y, -x

    @property
    def sizes(self):
        return self.coupler_length, self.guide.guide_offset

    @property
    def clearance(self):
        return self.guide.guide_offset, self.coupler_length

    def change_kinds(self, a, d, b, e):
        unit = equality(a, b, abs(e))
        far, near = abs(b + e - a) <= unit, abs(b - e - a) <= unit
        return {BOTH: far & near, FAR: far, NEAR: near}

    def place(self, placement):
        given = self.coupler_length, self.guide.line
        reached, swing = self.by_branch(placement, *given), placement.course(self.on).swing
        motion = place(placement.joints[self.on], *given, self.side, swing, reached)
        self.enter(placement, motion, travels={"slider": motion.travel})

    def follow(self, placement, joints):
        """Place coupler and slider at known joints."""
        slider, travel = known_slider(joints[self.pin], self.guide.direction)
        coupler = link_between(placement.joints[self.on], joints[self.pin], self.coupler_length)
        cosine, sine = rotate_back(coupler.direction, self.guide.direction)
        motion = SliderMotion(coupler, slider, sine, cosine, (cosine, None), None, travel)
        self.enter(placement, motion, travels={"slider": travel})

    def requirement(self, placement):
        distance = abs(self.placed(placement).sine * self.coupler_length)
        low, high = np.min(self.coupler_length), np.max(self.coupler_length)
        span = f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
        return (
            f"the distance from {self.on} to the guide, up to {np.max(distance):.6g} m here, must not exceed the "
            f"{self.called('coupler')} length, {span} m"
        )

    def elongation(self, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m, without the rounding of the coordinate."""
        if self.passage:
            return placement.travels[self.called("slider")].position - free_position
        return near_dead_centre.elongation(placement, *self._from(free_position, placement))

    def departure(self, placement, position):
        """Second derivative of the coordinate plus its elongation from a position, m; None where both are large."""
        drawn_in = self.placed(placement).drawn_in
        if self.passage or drawn_in is None:
            return None
        return near_dead_centre.departure(placement, drawn_in, *self._from(position, placement))

    def outward(self, placement, position):
        """That elongation, or its opposite, as a length of the design and a remainder, m; None if not known so."""
        return near_dead_centre.outward(placement, *self._from(position, placement))

    def _from(self, position, placement):
        """Arguments of `near_dead_centre.elongation` from a position."""
        motion, length, side = self.placed(placement), self.coupler_length, self.side
        short = side * near_dead_centre.shortfall(length, motion.sine, side * motion.cosine)
        return self.on, self.guide.line.direction, side * length - position, short

    def resolve(self, placement, loads, along) -> Resolved:
        (coupler_load, slider_load), (_, push) = self.of_links(loads), self.of_links(along)
        given = self.coupler_length, self.guide.line
        return self.resolved(*resolve(self.placed(placement), *given, coupler_load, slider_load, push))
