"""The shape of a mechanism as strokes: lines and plates of links, counterweights and loads in each pose.

Points are arrays (2, K, N): K corners in each of N poses; places and unit vectors are (2, N). NaN lifts the pen.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from ..machine.group import FRAME
from ..machine.links import Meshing
from ..mechanics.motion import Motion
from ..numbers.lazy import cached_property
from ..numbers.planar import rotate_back
from .canvas import close_curve, grouped

UP = (np.nan, np.nan)
SPRING = (
    (0.0, 0.0),
    (0.15, 0.0),
    *((0.15 + 0.7 * (turn + 0.5) / 10, (-1.0) ** turn) for turn in range(10)),
    (0.85, 0.0),
    (1.0, 0.0),
)
DAMPER = (
    *((0.0, 0.0), (0.5, 0.0), UP, (0.5, -0.7), (0.5, 0.7), UP),
    *((0.35, 1.0), (0.65, 1.0), (0.65, -1.0), (0.35, -1.0), UP, (0.65, 0.0), (1.0, 0.0)),
)
LINE = ((0.0, 0.0), (1.0, 0.0))
ARROW = (*LINE, (0.7, 0.5), (1.0, 0.0), (0.7, -0.5))
_HALF, _BENT, _SPREAD = np.linspace(-2.4, 1.4, 24), np.linspace(0.0, 4.5 * np.pi, 60), np.linspace(-0.9, 0.9, 24)
COUPLE = np.array([*np.transpose([np.cos(_HALF), np.sin(_HALF)]), (0.42, 0.72), (0.17, 0.985), (0.32, 1.3)])
SPIRAL = np.transpose([_BENT * np.cos(_BENT), _BENT * np.sin(_BENT)]) / _BENT[-1]
RING = np.transpose([np.cos(np.linspace(0, 2 * np.pi, 33)), np.sin(np.linspace(0, 2 * np.pi, 33))])
SECTOR = np.array([(0.0, 0.0), *np.transpose([np.cos(_SPREAD), np.sin(_SPREAD)])])
LARGE_RING = np.transpose([np.cos(np.linspace(0, 2 * np.pi, 145)), np.sin(np.linspace(0, 2 * np.pi, 145))])
RECTANGLE = np.array([(-1.0, -0.6), (1.0, -0.6), (1.0, 0.6), (-1.0, 0.6)])


def left(direction):
    """Vectors after a quarter turn counter-clockwise."""
    return np.array([-direction[1], direction[0]])


def place_symbol(shape, origin, direction, size=1.0, sense=1.0):
    """Points (2, K, N) of a shape (K, 2) in axes with origin and direction (2, N); mirrored where the sense is -1."""
    along, across = size * np.asarray(shape, dtype=float).T[..., None]
    return origin[:, None] + direction[:, None] * along + left(direction)[:, None] * (sense * across)


def span_symbol(shape, start, end, width):
    """Points (2, K, N) of a shape (K, 2) stretched from start to end, with a width across."""
    apart = end - start
    length = np.hypot(*apart)
    direction = apart / np.where(length > 0, length, 1.0)
    along, across = np.asarray(shape, dtype=float).T[..., None]
    return start[:, None] + apart[:, None] * along + left(direction)[:, None] * width * across


def hatched_line(start, end, width):
    """A straight line from start to end (2,), hatched on its right."""
    length = np.hypot(*(end - start))
    direction = (end - start) / (length or 1.0)
    ticks = np.arange(0.5 * width, length, width)
    foot = start[:, None] + direction[:, None] * ticks
    tip = foot - width * (left(direction) + 0.6 * direction)[:, None]
    strokes = np.stack([foot, tip, np.full_like(foot, np.nan)], axis=-1).reshape(2, -1)
    return np.column_stack([start, end, UP, strokes])


THIN_RATIO = 1e-3
"""Width of a link, relative to its length, up to which it is a straight bar."""
FAR_RATIO = 3.0
"""A load's line longer than this, relative to the extent of the machine, is drawn only near the machine."""
PRESSED = 1e-9
"""Contact force, relative to the largest, above which a side of a cam carries force."""
SURFACE_POINTS = 360
UNCLIPPED_SHARE = 0.9
"""Fraction of the poses in which the arrow of an unbounded reaction has its full length; it is cut in the rest."""
HALF_SECTOR = np.radians(50.0)
"""Half of the angle of a counterweight."""


class Stroke(NamedTuple):
    """Points (2, K, N) of a line in each of N poses, and its kind."""

    kind: str
    points: Any


class RigidStroke(NamedTuple):
    """A line that moves as a rigid body: points (2, K) in axes with origin and direction (2, N) in each of N poses."""

    kind: str
    own: Any
    origin: Any
    direction: Any

    @property
    def points(self):
        """Points (2, K, N) in each pose."""
        return place_symbol(self.own.T, self.origin, self.direction)


def _placed(kind, shape, origin, direction, size=1.0, sense=1.0):
    """Rigid stroke of a shape (K, 2); mirrored where the sense is -1."""
    return RigidStroke(kind, size * np.asarray(shape, dtype=float).T * [[1.0], [sense]], origin, direction)


@dataclass(frozen=True)
class Shape:
    """Sizes and outlines of a drawing, the same in all poses; `turn` is the motion over whole turns."""

    turn: Any

    @property
    def mechanism(self):
        return self.turn.mechanism

    @cached_property
    def size(self):
        """Largest extent of the joints over the turn, m."""
        joints = np.concatenate([self.turn.position(name) for name in self.turn.placement.joints], axis=-1)
        return float(np.max(np.nanmax(joints, axis=-1) - np.nanmin(joints, axis=-1))) or 1.0

    @cached_property
    def _symbols_over_turn(self):
        return {}

    @property
    def half_block(self):
        """Half the length of a block, m."""
        return 0.03 * self.size

    @cached_property
    def slots(self):
        """Slots with both ends of the joint's travel, (2, 2), in the link's axes, the end nearer the origin first."""
        found = []
        for slot in self.mechanism.slots:
            link = self.turn.placement.links[slot.link]
            pairs = zip(self.turn.position(slot.joint), link.joint.position, strict=True)
            seen = rotate_back([here - there for here, there in pairs], link.direction)
            ends = _ends(np.array(np.broadcast_arrays(*seen)))
            apart = ends[:, 1] - ends[:, 0]
            more = apart * self.half_block / (np.hypot(*apart) or 1.0)
            found.append((slot, ends if slot.rod else ends + np.column_stack([-more, more])))
        return found

    @cached_property
    def travels(self):
        """By slider: both ends of its travel, (2, 2), along its guide."""
        found = {}
        for slider, guide in self.mechanism.guides.items():
            path = self.turn.position(self.mechanism.references[slider])
            along = path.T @ np.asarray(guide.direction, dtype=float)
            found[slider] = path[:, [np.nanargmin(along), np.nanargmax(along)]]
        return found

    @cached_property
    def corners(self):
        """By link: its joints, (2, K), in its own axes, the reference joint first."""
        found = {link: [(0.0, 0.0)] for link in self.mechanism.links}
        for point in self.mechanism.joints.values():
            if point.link != FRAME:
                found[point.link].append((point.along, point.across))
        for bar in self.mechanism.bars:
            found[bar.link].append((bar.length, 0.0))
        for slot, ends in self.slots:
            found[slot.link] += [] if slot.rod else [tuple(end) for end in ends.T]
        apart: dict[str, list[Any]] = {link: [] for link in found}  # without points that coincide with others
        for link, points in found.items():
            for point in (np.asarray(point, dtype=float).ravel() for point in points):
                if all(np.hypot(*(point - other)) > 1e-6 * self.size for other in apart[link]):
                    apart[link].append(point)
        return {link: np.array(points).T for link, points in apart.items()}

    def rails(self):
        """Hatched lines (2, K) along guides, over the travel of their sliders."""
        for slider, guide in self.mechanism.guides.items():
            along = np.asarray(guide.direction, dtype=float)
            below, reach = 0.6 * self.half_block * left(along), 1.5 * self.half_block * along
            start, end = self.travels[slider].T
            yield hatched_line(start - reach - below, end + reach - below, 0.5 * self.half_block)

    def strokes(self, pose, links=None):
        """Lines and plates of all links, or of some, in the poses of a motion, from back to front."""
        links = self.mechanism.links if links is None else links
        for group in self.mechanism.groups:
            for link, points in group.outlines.items():
                if link in links:
                    yield _on_link("outline", pose, link, points)
        for pair in self.mechanism.pairs.values():
            if isinstance(pair, Meshing) and pair.link in links:  # pitch circles of planet and ring
                axis = pose.position(pair.joint)
                size = float(np.max(np.hypot(*axis)))
                yield _unturned("outline", axis, size, LARGE_RING)
                yield _unturned("outline", 0.0 * axis, 2.0 * size, LARGE_RING)
        for link, corners in self.corners.items():
            if corners.shape[1] > 1 and link in links:
                kind, outline = _outline(corners)
                yield _on_link(kind, pose, link, outline)
        for slot, ends in self.slots:
            slotted = (_on_link(kind, pose, slot.link, ends) for kind in ("slotted", "slot"))
            parts = self._piston(pose, slot, ends) if slot.rod else slotted
            yield from (part for part in parts if (slot.rod if part.kind == "bar" else slot.link) in links)
        rods = {slot.rod for slot in self.mechanism.slots}
        for link, corners in self.corners.items():
            if link in links and (link in self.mechanism.guides or (corners.shape[1] == 1 and link not in rods)):
                turn = pose.as_vector(pose.placement.links[link].direction)
                place = pose.position(self.mechanism.references[link])
                size = self.half_block if link in self.mechanism.guides else 0.8 * self.half_block
                yield _placed("block", RECTANGLE, place, turn, size)
        for joint, radius in self.mechanism.rollers.items():
            if self.mechanism.joints[joint].link not in links:
                continue
            size = 0.9 * self.half_block if radius is None else float(np.ravel(radius)[0])
            yield _unturned("roller", pose.position(joint), size)

    def _piston(self, pose, slot, ends):
        """Cylinder from its reference joint to the nearer end of the travel, and a rod in it."""
        near, far = np.hypot(*ends)
        origin, joint = pose.position(self.mechanism.references[slot.link]), pose.position(slot.joint)
        axis = (joint - origin) / np.hypot(*(joint - origin))
        length = max(0.8 * near, far - 0.6 * near)
        yield _placed("bar", [(0.0, 0.0), (-length, 0.0)], joint, axis)
        barrel = [(0.0, -0.5), (0.85 * near / self.half_block, -0.5), (0.85 * near / self.half_block, 0.5), (0.0, 0.5)]
        yield _placed("plate", barrel, origin, axis, self.half_block)
        yield _placed("bar", [(0.0, -0.5), (0.0, 0.5)], joint - axis * length, axis, self.half_block)

    def counterweights(self, pose):
        """Counterweights of turning links whose mass centres lie beyond their joints.

        A mass centre behind the reference joint has a sector about that joint, one beyond the last joint a disk.
        """
        for name, link in self.mechanism.links.items():
            along, across = (float(np.ravel(part)[0]) for part in link.centre)
            arm, reach = np.hypot(along, across), self.corners[name][0].max()
            turns = np.any(link.mass) and name not in self.mechanism.guides and arm > 0.3 * self.half_block
            if turns and reach > 0.0 and along > reach + 0.3 * self.half_block:
                yield _on_link("bar", pose, name, np.array([[reach, along], [0.0, across]]))
                yield _unturned("counterweight", pose.position(name), 2.0 * self.half_block)
            if turns and along < min(self.corners[name][0].min(), -0.3 * arm):
                radius = arm * 1.5 * HALF_SECTOR / np.sin(HALF_SECTOR)
                angle = np.arctan2(across, along) + np.linspace(-HALF_SECTOR, HALF_SECTOR, 24)
                edge = radius * np.array([np.cos(angle), np.sin(angle)])
                yield _on_link("counterweight", pose, name, np.column_stack([(0.0, 0.0), edge]))

    @property
    def heavy(self):
        """Links with mass."""
        return [name for name, link in self.mechanism.links.items() if np.any(link.mass)]

    def symbols(self, loads, pose):
        """Lines of all loads in the poses of a motion."""
        for item in loads:
            for symbol in self._symbols(item, pose):
                yield from self._draw(symbol)

    def _symbols(self, item, pose):
        """Symbols of a load in the poses of a motion; those over the turn are kept. A user's own load may have none."""
        if not hasattr(item, "signs"):
            return ()
        if pose is not self.turn:
            return item.signs(pose)
        if id(item) not in self._symbols_over_turn:
            self._symbols_over_turn[id(item)] = item, tuple(item.signs(pose))  # no other load gets its id
        return self._symbols_over_turn[id(item)][1]

    def _draw(self, symbol):
        half = self.half_block
        if symbol.slider:
            away = symbol.sense * np.asarray(self.mechanism.guides[symbol.slider].direction, dtype=float)
            far = self.travels[symbol.slider][:, np.argmax(away @ self.travels[symbol.slider])]
            end = (far + 6.0 * half * away)[:, None] + 0.0 * symbol.start
            start = symbol.start + half * away[:, None]
            shape = SPRING if symbol.kind == "spring" else DAMPER
            yield Stroke(symbol.kind, span_symbol(shape, start, end, 0.5 * half))
            yield Stroke(symbol.kind, span_symbol([(1.0, -1.0), (1.0, 1.0)], symbol.start, end, half))
        elif symbol.kind == "force":
            yield _placed("force", np.multiply(ARROW, [5.0, 1.0]), symbol.start, symbol.sense * symbol.direction, half)
        elif symbol.kind == "shaft":
            yield _unturned("line", symbol.start, 2.0 * half)
            yield _placed("counterweight", SECTOR, symbol.start, symbol.direction, 2.0 * half)
        elif symbol.end is not None:
            shape = {"spring": SPRING, "damper": DAMPER}.get(symbol.kind, LINE)
            start, end = self._near_part(symbol.start, symbol.end)
            yield Stroke(symbol.kind, span_symbol(shape, start, end, 0.5 * half))
        else:
            shape = {"spiral": SPIRAL, "ring": RING}.get(symbol.kind, COUPLE)
            kind = "force" if symbol.kind == "couple" else "spring"
            size, senses = 1.6 * half, np.unique(symbol.sense)
            if senses.size == 1:
                yield _unturned(kind, symbol.start, size, shape, senses[0])
            else:
                yield Stroke(kind, place_symbol(shape, symbol.start, np.array([[1.0], [0.0]]), size, symbol.sense))

    def _near_part(self, start, end):
        """Ends of a line, in poses; if it leads far away, those of a part beside the machine."""
        if not self._leads_far(start, end):
            return start, end
        near, far = sorted((start, end), key=lambda place: np.nanmax(np.hypot(*place)))
        return near, near + (far - near) * 0.5 * self.size / np.hypot(*(far - near))

    def _leads_far(self, start, end):
        return np.nanmax(np.hypot(*(end - start))) > FAR_RATIO * self.size

    def ties(self, pose, loads=(), links=None):
        """Lines from mass centres and points of loads to their link, if they lie off it."""
        places = [(name, *self.mechanism.links[name].centre) for name in self.heavy]
        for item in loads:
            places += [at for at in (getattr(item, "at", None), *getattr(item, "between", ())) if isinstance(at, tuple)]
        for name, *place in places:
            if name not in self.corners or (links is not None and name not in links):
                continue
            point = np.array([float(np.ravel(part)[0]) for part in place])
            foot = _nearest_on(_outline(self.corners[name])[1], point)
            if np.hypot(*(foot - point)) > 0.5 * self.half_block:
                yield _on_link("tie", pose, name, np.column_stack([point, foot]))

    def grounds(self, loads):
        """Fixed pivots and fixed ends of loads, (2,) each."""
        for name, point in self.mechanism.joints.items():
            if point.link == FRAME:
                yield self.turn.position(name)[:, 0]
        for item in loads:
            for symbol in self._symbols(item, self.turn):
                if symbol.kind == "shaft":
                    yield symbol.start[:, 0]
                elif symbol.kind in ("spring", "damper", "line") and symbol.end is not None:
                    ends = () if self._leads_far(symbol.start, symbol.end) else (symbol.start, symbol.end)
                    yield from (end[:, 0] for end in ends if not np.ptp(end, axis=-1).any())


def _on_link(kind, pose, link, points):
    """Rigid stroke of points (2, K) of a link."""
    return RigidStroke(
        kind, points, pose.position((link, 0.0, 0.0)), pose.as_vector(pose.placement.links[link].direction)
    )


def _unturned(kind, place, radius, points=RING, sense=1.0):
    """A stroke that does not turn, by default a circle."""
    return _placed(kind, points, place, np.broadcast_to([[1.0], [0.0]], place.shape), radius, sense)


def _ends(points):
    """Both ends of a straight row of points, (2, 2), the one nearer to zero first."""
    points = points[:, np.isfinite(points).all(axis=0)]
    middle = points.mean(axis=1, keepdims=True)
    far = points[:, np.argmax(np.hypot(*(points - middle)))]
    other = points[:, np.argmax(np.hypot(*(points - far[:, None])))]
    return np.column_stack(sorted((far, other), key=np.linalg.norm))


def _line_order(points):
    """Order of points on a straight line, the reference joint first if it is an end; None if they are not on one."""
    far = points[:, np.argmax(np.hypot(*points))]
    length = np.hypot(*far)
    if not length:
        return np.arange(1)
    along, across = np.array([far, left(far)]) @ points / length
    if np.ptp(across) > THIN_RATIO * np.ptp(along):
        return None
    order = np.argsort(along)
    return order if order[-1] else order[::-1]


def _outline(corners):
    """Kind of a link's shape, "bar" or "plate", and its ends or its corners in order (2, K)."""
    order = _line_order(corners)
    if order is not None:
        return "bar", corners[:, order[[0, -1]]]
    x, y = corners - corners.mean(axis=1, keepdims=True)
    return "plate", corners[:, np.argsort(np.arctan2(y, x))]


def _nearest_on(outline, point):
    """Point nearest to another one on an outline (2, K); the point itself inside a plate."""
    sides = np.roll(outline, -1, axis=1) - outline
    away = point[:, None] - outline
    if outline.shape[1] > 2 and np.all(left(sides)[0] * away[0] + left(sides)[1] * away[1] >= 0.0):
        return point
    squares = np.sum(sides**2, axis=0)
    feet = outline + sides * np.clip(np.sum(sides * away, axis=0) / np.where(squares > 0.0, squares, 1.0), 0.0, 1.0)
    return feet[:, np.argmin(np.hypot(*(feet - point[:, None])))]


def working_curves(solution):
    """Working curves of cams whose roller has a known radius: the cam's body, and points (2, K) in the body's axes.

    Each side that carries force has a curve: the outside of a disk, the inside of a ring.
    """
    for group in solution.mechanism.groups:
        for led in group.led:
            fixed = led.body == FRAME
            cam: Any = getattr(group, "cam" if fixed else "disk", None)
            outward = -1.0 if fixed else 1.0
            friction = solution.friction.acting.get(led.force.replace("_force", ""))
            radius = group.rollers.get(led.joint) if friction is None else friction.roller_radius
            if led.flat or radius is None or not hasattr(cam, "profile"):
                continue
            force = outward * np.nan_to_num(solution.scalar(led.force))
            for side, sign in (("disk", 1.0), ("ring", -1.0)):
                if np.any(sign * force > PRESSED * np.max(np.abs(force))):
                    try:
                        made = cam.profile(float(np.ravel(radius)[0]), SURFACE_POINTS, side)
                    except ParameterError:  # undercut, or no pitch curve around O
                        continue
                    yield led.body, close_curve(made.surface)


def moving_surfaces(solution, pose):
    """Working curves of cams that turn with a link, in the poses of a motion."""
    for body, points in working_curves(solution):
        if body != FRAME:
            yield _on_link("surface", pose, body, points)


def whole_turn(solution):
    """The mechanism over its whole turns, at steps of half a degree."""
    turns = solution.mechanism.turns
    return at_angles(solution, np.linspace(0, 360 * turns, 720 * turns + 1))


def at_angles(solution, degrees):
    """Motion at other crank angles, degrees, without loads; the speed is the solution's sign, 0 if it has several."""
    senses = np.unique(np.sign(solution.crank_speed))
    return Motion(solution.mechanism, np.radians(degrees), float(senses[0]) if senses.size == 1 else 0.0, 0.0)


def moves_alike(solution, other):
    """Whether two machines look the same in 25 poses of the period, except for counterweights and loads."""
    made, twin = solution.mechanism, other.mechanism
    if (list(made.joints), list(made.links)) != (list(twin.joints), list(twin.links)):
        return False
    both = [Shape(at_angles(item, np.linspace(0.0, 360.0 * made.turns, 25))) for item in (solution, other)]
    here, there = ([stroke.points for stroke in shape.strokes(shape.turn)] for shape in both)
    reach = 1e-6 * both[0].size
    return len(here) == len(there) and all(
        one.shape == two.shape and np.allclose(one, two, rtol=0.0, atol=reach, equal_nan=True)
        for one, two in zip(here, there, strict=True)
    )


def load_strokes(solution, angle):
    """Symbols of the loads of a machine in a pose, as strokes."""
    return list(Shape(whole_turn(solution)).symbols(solution.loads, at_angles(solution, angle)))


def strokes_by_owner(named, angle):
    """Counterweights and symbols of loads in a pose, each with the labels of its machines."""
    found = []
    for name, solution in named.items():
        weights = Shape(whole_turn(solution)).counterweights(at_angles(solution, angle))
        found += [(stroke, name) for stroke in (*weights, *load_strokes(solution, angle))]

    def same(one, two):
        points, others = two[0].points, one[0].points
        alike = two[0].kind == one[0].kind and points.shape == others.shape
        return alike and np.allclose(points, others, rtol=1e-6, equal_nan=True)

    return [(group[0][0], list(dict.fromkeys(name for _, name in group))) for group in grouped(found, same)]
