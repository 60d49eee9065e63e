"""Loads at points of links: forces of given direction, and forces, springs and dampers along the line of two points.

A point is a joint ("B"), a place on a link ("coupler", along, across) or a fixed point (x, y). A force F at a
point with lever r from the reference joint of its link is the wrench (F, r x F). A load between two points acts
oppositely on both.
"""

import math
from dataclasses import KW_ONLY, dataclass
from typing import Annotated, Any

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import guarded_divisor, sqrt
from ...numbers.planar import dot, length, moment, plus, rotate, scale_vector, subtract_vectors, vector_or_zero
from ..crank import ray
from ..dimensions import of_place, within
from ..group import FRAME, Point
from ..links import Wrench, arm, present
from ..supports import Support
from .load import Load, Symbol, angles_text, value_rule

PLACE_FORMS = 'a joint ("B"), a place on a link ("coupler", along, across) or a fixed point (x, y)'
NAME = checks.Name()
ON_LINK, FIXED = checks.Pair("m", parts=("along", "across")), checks.Pair("m")
"""Rules of the two numbers of a place on a link, and of a fixed point."""


class PlaceRule:
    """Rule of a point; the value is a name, (link, along, across) or (x, y), m."""

    def quick(self, value):
        if type(value) is not tuple:
            return NAME.quick(value)
        named = value[:1] if len(value) == 3 and type(value[0]) is str else ()
        numbers = FIXED.quick(value[len(named) :])
        return numbers if numbers is checks.UNDECIDED else named + numbers

    def check(self, value, field=""):
        if isinstance(value, str):
            return NAME.check(value, field)
        wrong = f"{field} must be {PLACE_FORMS}, got {checks.shown(value)}"
        try:
            parts = tuple(value)
        except TypeError:
            return value, wrong
        named = tuple(str(part) for part in parts[:1] if isinstance(part, str))
        numbers = (*parts[1:], 0.0)[:2] if named and len(parts) == 2 else parts[len(named) :]
        if len(numbers) != 2 or any(isinstance(part, str) for part in numbers):
            return value, wrong
        numbers, problem = (ON_LINK if named else FIXED).check(numbers, field)
        return named + numbers, problem

    def numbers(self, value):
        """Name, steps and rule of each number of a point, for parameter paths."""
        if not isinstance(value, str):
            named = isinstance(value[0], str)
            for name, (place,), rule in (ON_LINK if named else FIXED).numbers(value):
                yield name, (place + named,), rule


class PlacePairRule:
    """Rule of a pair of points."""

    def quick(self, value):
        if type(value) is not tuple or len(value) != 2:
            return checks.UNDECIDED
        found = tuple(map(PLACE_RULE.quick, value))
        return checks.UNDECIDED if checks.UNDECIDED in found else found

    def check(self, value, field=""):
        if not isinstance(value, tuple | list) or len(value) != 2:
            return value, f"{field} must be a pair of points, each {PLACE_FORMS}, got {checks.shown(value)}"
        points, problems = zip(
            *(PLACE_RULE.check(part, f"{field} {n}") for n, part in enumerate(value, 1)), strict=True
        )
        return points, "; ".join(filter(None, problems)) or None

    def numbers(self, value):
        """Name, steps and rule of each number of both points, for parameter paths."""
        for number, part in enumerate(value):
            for name, steps, rule in PLACE_RULE.numbers(part):
                yield f"{number + 1}.{name}", (number, *steps), rule


PLACE_RULE = PlaceRule()


def point_on_link(mechanism, place) -> Point:
    """Link that carries a point, and the point's place on it; a fixed pivot belongs to the link that turns about it."""
    if not isinstance(place, str):
        return Point(*place) if isinstance(place[0], str) else Point(FRAME, *place)
    point = mechanism.joints[place]
    turning = (link for link, joint in mechanism.references.items() if joint == place and point.link == FRAME)
    return next(map(Point, turning), point)


def wrench_at(placement, point, force, couple=None):
    """Link that carries a point, and a force there with a couple as a wrench about the link's reference joint."""
    if point.link == FRAME:
        return FRAME, Wrench(force, couple)
    direction = placement.links[point.link].direction
    lever = arm(direction, present(point.along), present(point.across))
    return point.link, Wrench(force, plus(moment(lever, force), couple))


def place_problem(owner, field, place, mechanism) -> Any:
    """Problem of a point on a mechanism, as a sentence, or None."""
    if isinstance(place, str):
        if place in mechanism.links and place not in mechanism.joints:
            return f'{owner}: {field} is {place!r}, a link; name a place on it, ("{place}", along, across)'
        return checks.choice(f"{owner}: {field}", place, tuple(mechanism.joints))
    if isinstance(place[0], str):
        return checks.choice(f"{owner}: link of {field}", place[0], (*mechanism.links, FRAME))
    return None


def place_text(place):
    """Text of a point in messages."""
    if isinstance(place, str):
        return repr(place)
    words = (repr(part) if isinstance(part, str) else f"{part:.6g}" for part in place if not np.ndim(part))
    return f"({', '.join(words)})"


MEETING_DISTANCE = 2.0**-50
"""Largest distance of two coincident points, relative to their coordinates and the lengths: rounding."""
MEETING_SQUARE, MEETING_LOOKAHEAD = (8.0 * MEETING_DISTANCE) ** 2, 2.0**23
"""Square of the relative distance of two points below which a damper follows their motion, and its look-ahead,
as a multiple of this distance."""
MIN_SQUARE = 1e-280
"""Square of a distance, m2, that guards divisors."""
TERMS = {
    "d": ("d", "from the second point to the first"),
    "distance": ("D", "distance of both points"),
    "near": ("N", "square of a distance at which both points would count as meeting"),
    "share": ("h", "share of their motion in their direction, zero unless they meet"),
    "shortening": ("z", "rate of separation of the points over their distance"),
}


class ForceRule(checks.OrFunction):
    """Rule of the value of a force; the message for two components gives the right form."""

    def check(self, value, field=""):
        if isinstance(value, list | tuple) and len(value) == 2 and all(type(part) in (int, float) for part in value):
            x, y = value
            write = f"Force({math.hypot(x, y):.6g}, direction={math.atan2(y, x):.6g}, ...)"
            return value, f"{field} is a number, its direction another; for the components {value!r} write {write}"
        return super().check(value, field)


class PlacedLoad(Load):
    """A load of forces at points."""

    def forces(self, motion) -> Any:
        """Pairs of a point and the force (x, y) on it, N."""
        raise NotImplementedError

    def wrenches(self, motion):
        """Wrench on the link of each point."""
        for place, force in self.forces(motion):
            yield wrench_at(motion.placement, point_on_link(motion.mechanism, place), force)

    def support(self, motion):
        """Its force at its fixed point."""
        for place, force in self.forces(motion):
            if point_on_link(motion.mechanism, place).link == FRAME:
                return Support(force, motion.spot(place).position)
        return Support(None, None)


@dataclass(frozen=True, eq=False)
class Force(PlacedLoad):
    """Force at a point, in a fixed direction or in a direction that turns with a link.

    Parameters
    ----------
    value : float, array, Table or function
        N; an array has one value for each crank angle, a function takes the `Motion` and returns values of this shape.
    at : point
        Joint such as "B"; place on a link, ("coupler", along, across), in m and in the axes of mass centres; or fixed
        point (x, y). At a fixed point the frame takes the force. A joint stands for the link that owns it
        (``mechanism.joints``), a fixed pivot for the link that turns about it.
    direction : float
        Angle of the force, rad, counter-clockwise from +x, or from the axis of the link `along`.
    along : str, optional
        Link with which the direction turns.

    Raises
    ------
    ParameterError
        A value is not a finite number, or `at` is not a point; when a scene is made, a joint or link is unknown.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> press = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(press, 0.7, crank_speed=10.0, loads=ks.Force(200.0, at="B", direction=-0.5))
    >>> bool(s.power_residual < 1e-13)
    True
    """

    value: Annotated[Any, ForceRule(checks.Number("N", table=True))]
    _: KW_ONLY
    at: Annotated[Any, PlaceRule()] = None
    direction: Annotated[Any, checks.Number("rad")] = 0.0
    along: Annotated[Any, checks.Optional(checks.Name())] = None

    PATH, VALUE, OVER_ANGLES, LENGTHS = "force", "value", ("value",), ("at",)
    RULES = checks.Rules("force")

    @property
    def title(self):
        return f"Force at {place_text(self.at)}"

    def misplaced(self, mechanism):
        """Sentences on unknown joints or links."""
        yield place_problem("Force", "at", self.at, mechanism)
        if self.along is not None:
            yield checks.choice("Force: along", self.along, tuple(mechanism.links))

    def forces(self, motion):
        """Its force at its point."""
        axis = self._axis(motion)
        yield self.at, (self.value, 0.0) if axis is None else scale_vector(self.value, axis)

    def dimensions(self, mechanism):
        """Coordinates of its point."""
        return of_place("at", self.at)

    def rests_on_frame(self, mechanism):
        """False: at a fixed point it is an external force on the frame, not a force of the machine."""
        return False

    def _axis(self, motion):
        """Unit vector of a positive force; None means +x."""
        axis = None if self.along is None else motion.placement.links[self.along].direction
        return axis if present(self.direction) is None else rotate(ray(self.direction), axis)

    def signs(self, motion):
        """Symbol of a force."""
        axis = self._axis(motion)
        direction = motion.as_vector((1.0, 0.0) if axis is None else axis)
        yield Symbol("force", motion.position(self.at), direction=direction, sense=self.sense(motion))


class PointLoad(PlacedLoad):
    """A load along the line of two points `between`."""

    between: Annotated[Any, PlacePairRule()]

    REFUSES, SIGN, REMEDY = True, "line", ""

    def pull(self, motion) -> Any:
        """Force on the first point, N."""
        raise NotImplementedError

    @property
    def title(self):
        return f"{type(self).__name__} between {' and '.join(map(place_text, self.between))}"

    def misplaced(self, mechanism):
        """Sentences on unknown points, or if one link carries both."""
        owner = type(self).__name__
        wrong = [place_problem(owner, f"between {n}", place, mechanism) for n, place in enumerate(self.between, 1)]
        yield from wrong
        if not any(wrong):
            link, other = (point_on_link(mechanism, place).link for place in self.between)
            if link == other:
                of = "fixed to the frame" if link == FRAME else f"of the {link}"
                yield f"{self.title}: both points are {of}, so it loads nothing; give a point of another link"

    def forces(self, motion):
        """Opposite forces at both points."""
        force = self.pull(motion)
        return zip(self.between, (force, subtract_vectors(None, force)), strict=True)

    def dimensions(self, mechanism):
        """Coordinates of both points."""
        first, second = self.between
        return within("between", {**of_place(0, first), **of_place(1, second)})

    def rests_on_frame(self, mechanism):
        """Whether one of its points is fixed."""
        return any(point_on_link(mechanism, place).link == FRAME for place in self.between)

    def signs(self, motion):
        """Symbol between both points."""
        yield Symbol(self.SIGN, *map(motion.position, self.between))

    def _distance_vector(self, motion):
        """Vector from the second point to the first."""
        first, second = (motion.spot(place).position for place in self.between)
        return vector_or_zero(subtract_vectors(first, second))

    def refusals(self, motion):
        """Sentence on the crank angles at which the points meet, so that their line has no direction."""
        first, second = (vector_or_zero(motion.spot(place).position) for place in self.between)
        apart = subtract_vectors(first, second)
        if not all(isinstance(part, float | np.ndarray) and np.asarray(part).dtype == float for part in apart):
            return  # recorded or traced
        with np.errstate(invalid="ignore"):
            size = motion.mechanism.extent + np.maximum(np.hypot(*first), np.hypot(*second))
            meet = np.broadcast_to(np.hypot(*apart) <= MEETING_DISTANCE * size, motion.shape)
        if meet.any():
            yield checks.Problem(
                f"{self.title}: the points meet {angles_text(motion, meet)}, so its force has no direction there; "
                f"leave them out, or move a point off the line{self.REMEDY}",
                meet,
            )


@dataclass(frozen=True, eq=False)
class PointForce(PointLoad):
    """Force along the line of two points, on both of them: an actuator, a cylinder, a rope.

    Parameters
    ----------
    value : float, array, Table or function
        N, as for `Force`; positive pushes the points apart.
    between : (point, point)
        As for `Force`; at most one of them fixed.

    Raises
    ------
    ParameterError
        As for `Force`; one link carries both points; when a scene is solved: the points meet at a crank angle.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> crane = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(crane, 0.7, crank_speed=1.0, loads=ks.PointForce(5e3, between=(("rocker", 0.1), (0.0, -0.2))))
    >>> bool(s.power_residual < 1e-13)
    True
    """

    value: Annotated[Any, value_rule("N")]
    _: KW_ONLY
    between: Any

    PATH, VALUE, OVER_ANGLES, LENGTHS = "point_force", "value", ("value",), ("between",)
    RULES = checks.Rules("point force")

    def pull(self, motion):
        """Force on the first point, N."""
        d = self._distance_vector(motion)
        return scale_vector(self.value / length(d), d)

    def signs(self, motion):
        """Symbols of a line between the points and of the force on each."""
        first, second = map(motion.position, self.between)
        apart = first - second
        with np.errstate(invalid="ignore"):
            unit = apart / np.hypot(*apart)
        yield Symbol("line", first, second)
        for place, direction in ((first, unit), (second, -unit)):
            yield Symbol("force", place, direction=direction, sense=self.sense(motion))


@dataclass(frozen=True, eq=False)
class PointSpring(PointLoad):
    """Linear spring between two points, fixed or moving.

    Parameters
    ----------
    stiffness : float or array
        N/m.
    free_length : float or array
        m; with 0 the force is exact also where the points meet.
    between : (point, point)
        As for `PointForce`.

    Raises
    ------
    ParameterError
        As for `PointForce`; points may meet if `free_length` is 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=1.0, loads=ks.PointSpring(2e3, 0.1, between=("B", (0.0, 0.5))))
    >>> bool(s.power_residual < 1e-13)
    True
    """

    stiffness: Annotated[Any, checks.Number("N/m", low=0.0)]
    free_length: Annotated[Any, checks.Number("m", low=0.0)] = 0.0
    _: KW_ONLY
    between: Any

    PATH, LENGTHS, SIGN = "point_spring", ("free_length", "between"), "spring"
    RULES = checks.Rules("point spring")
    REMEDY = ", or give free_length 0"

    def pull(self, motion):
        """Force on the first point, N."""
        d = self._distance_vector(motion)
        if present(self.free_length) is None:
            return scale_vector(-self.stiffness, d)
        distance = length(d)
        return scale_vector(-self.stiffness * ((distance - self.free_length) / distance), d)

    def potential(self, motion):
        """Strain energy, J."""
        d = self._distance_vector(motion)
        square = dot(d, d)
        if present(self.free_length) is not None:
            elongation = length(d) - self.free_length
            square = elongation * elongation
        return 0.5 * self.stiffness * square

    def refusals(self, motion):
        """As for `PointForce`; nothing for a spring without free length."""
        return () if present(self.free_length) is None else super().refusals(motion)


@dataclass(frozen=True, eq=False)
class PointDamper(PointLoad):
    """Viscous damper between two points, fixed or moving; its force opposes the rate of their distance.

    Where the points meet it takes the limit: the force opposes their relative velocity.

    Parameters
    ----------
    coefficient : float or array
        N s/m.
    between : (point, point)
        As for `PointForce`; they may meet.

    Raises
    ------
    ParameterError
        As for `PointForce`, except that points may meet.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=9.0, loads=ks.PointDamper(50.0, between=("B", (0.0, 0.5))))
    >>> bool(s.balancing_torque * 9.0 > 0)  # it takes power whatever the motion
    True
    """

    coefficient: Annotated[Any, checks.Number("N*s/m", low=0.0)]
    _: KW_ONLY
    between: Any

    PATH, LENGTHS, REFUSES, SIGN = "point_damper", ("between",), False, "damper"
    DISSIPATES = True
    RULES = checks.Rules("point damper")

    def pull(self, motion):
        """Force on the first point, N; None if neither point moves or the coefficient is 0."""
        directed = self._directed_distance(motion)
        if directed is None or present(self.coefficient) is None:
            return None
        d, slope = directed
        shortening = dot(d, slope) / guarded_divisor(dot(d, d), MIN_SQUARE)
        return scale_vector(-self.coefficient * motion.crank_speed * shortening, d)

    def _directed_distance(self, motion):
        """Vector between the points, moved along its derivative where they meet, and the derivative; or None."""
        first, second = (motion.spot(place) for place in self.between)
        if first.first is None and second.first is None:
            return None
        positions = [vector_or_zero(spot.position) for spot in (first, second)]
        slope = vector_or_zero(subtract_vectors(first.first, second.first))
        d = vector_or_zero(subtract_vectors(*positions))
        square = dot(slope, slope)
        near = MEETING_SQUARE * (sum(dot(part, part) for part in positions) + square)
        share = near / (near + dot(d, d) + MIN_SQUARE)
        ahead = MEETING_LOOKAHEAD * sqrt(near / (square + MIN_SQUARE)) * share * share
        return (d[0] + ahead * slope[0], d[1] + ahead * slope[1]), slope
