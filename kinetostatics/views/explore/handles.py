"""Points of a drawing that can be dragged, and the numbers of the scene that put them elsewhere.

Parts and loads declare what their numbers measure (`machine.dimensions`). A point at which two numbers meet follows the
pointer freely: coordinates, or the lengths of two bars. A point of one number stays on its line: the end of a crank on
its ray, a slider's pin on its guide. All formulas are exact, so the point follows the pointer at the crank angle shown.
"""

import math
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...machine.dimensions import Angle, Radius, Span, of_point_on_link
from ...machine.group import CRANK
from ...machine.guide import Guide
from ...machine.loads.load import Load
from ...numbers import checks
from ...numbers.lazy import cached_property
from ..strokes import Shape, left

STEPS_OVER_SIZE = 200.0
"""Snapping steps over the largest extent of the joints, before rounding to 1, 2 or 5 times a power of ten."""
ANGLE_STEP, DEGREE = 1.0, math.pi / 180.0
"""Snapping step of angles, degrees; and a degree in rad."""
FINE = 100.0
"""Snapping step over the rounding step without snapping."""
ARM = 0.15
"""Distance from the vertex of a point that turns a line without a slot, over the largest extent of the joints."""
OVERHANG = 0.07
"""Distance of the points of a guide from the travel of its slider, over that extent."""
CLOSE = 0.025
"""Distance of two points in all poses, over that extent, below which they are shown side by side."""
POSES_COMPARED = 12
KINDS = "joint", "point", "turn", "guide"
"""Kinds in the order of their points; mass centres are last."""
DIAGONAL = -math.sqrt(0.5), math.sqrt(0.5)
"""Direction from the centre of a circle to the point that changes its radius."""


class Handle(NamedTuple):
    """A point that can be dragged, named by the first of the `paths` of the numbers that it changes; `label` in words.

    Of the kinds, joints change lengths, points are coordinates, "turn" changes an angle. `position` is (2, N), m, in
    each pose, NaN in a gap. ``measure(place, index)`` gives the numbers that bring the point to a place (x, y) in a
    pose, or as near as its line allows. `row` counts earlier points, and pins of the crank, at nearly the same place.
    """

    name: str
    label: str
    kind: str
    paths: tuple[str, ...]
    position: Any
    measure: Callable[..., Any]
    row: int = 0


def snap_step(size):
    """Snapping step of lengths for a machine of a size: 1, 2 or 5 times a power of ten, m."""
    wanted = size / STEPS_OVER_SIZE
    power = float(f"1e{math.floor(math.log10(wanted))}")
    return power * min((1.0, 2.0, 5.0, 10.0), key=lambda factor: abs(math.log(wanted / power / factor)))


def _rounded(old, new, step, unit=1.0):
    """The multiple of a step, in a unit, nearest to a new value; the old value if it changes by less than half."""
    if not 0.5 * step * unit <= abs(new - old) < math.inf or math.isinf(new / (step * unit)):  # also for NaN
        return old
    return unit * float(f"{round(new / (step * unit)) * step:.12g}")


def _near(angle, old):
    """An angle, by whole turns nearest to an old one, rad."""
    return old + math.remainder(angle - old, 2.0 * math.pi)


def _in_rows(found, pins, close):
    """Handles with the number of earlier ones, and of other pins, at nearly the same place."""
    every = max(1, found[0].position.shape[-1] // POSES_COMPARED) if found else 1
    places = np.array([position[:, ::every] for position in (*pins, *(handle.position for handle in found))])
    rows = [0] * len(pins)
    for number, place in enumerate(places[len(pins) :], len(pins)):
        with np.errstate(invalid="ignore"):
            near = (np.abs(places[:number] - place) < close).all(axis=(1, 2))
        rows.append(max((row for row, is_near in zip(rows, near, strict=True) if is_near), default=-1) + 1)
    return [handle._replace(row=row) for handle, row in zip(found, rows[len(pins) :], strict=True)]


def _words(path):
    """A path as words: "point_spring2.between.1" is "point spring 2 end 1"."""
    text = path.replace(".between.", " end ").removesuffix(".at").replace("_", " ").replace(".", " ")
    return re.sub(r"(?<=[a-z])(?=\d)", " ", text)


class Points:
    """Points of a solution that can be dragged, from the dimensions of its parts and loads.

    The solution is of one design at even crank angles over a whole period; `places` are those of the numbers of its
    scene, if they are known.
    """

    def __init__(self, solution, places=None):
        self.solution, self.mechanism, self.motion = solution, solution.mechanism, solution.dynamics
        self.places = solution.places if places is None else places
        self.shape = Shape(solution)
        self.size = self.shape.size

    def data(self):
        """Handles for a page, their places (N, 2) in single precision, and the snapping step, m."""
        found = [item._asdict() | {"position": item.position.T.astype(np.float32)} for item in self.side_by_side()]
        for item in found:
            del item["measure"]
        return {"handles": found, "snap": snap_step(self.size)}

    def dragged(self, name, x, y, index, snap=True, step=None):
        """Values by path that bring a point to (x, y), m, at the crank angle `index` of the solution, rounded.

        With `snap` to a step, m, by default about 1/200 of the machine's size, and to 1 degree; else to 1/100 of these.
        A number that changes by less than half a step stays, as does one without a value in a gap. `ParameterError` if
        there is no point of that name.
        """
        handle = next((handle for handle in self.all if handle.name == name), None)
        if handle is None:
            raise ParameterError(f"there is no point {checks.shown(name)} to drag")
        old = [float(self.places[path].value(self.solution)) for path in handle.paths]
        new = [float(value) for value in handle.measure(np.array([x, y], dtype=float), index)]
        unit = self.places[name].rule.unit
        share = 1.0 if snap else 1.0 / FINE
        if unit == "m":
            step = snap_step(self.size) if step is None else step
            new = [_rounded(*values, share * step) for values in zip(old, new, strict=True)]
        elif unit == "rad":
            new = [_rounded(old[0], new[0], share * ANGLE_STEP, DEGREE)]
        else:  # a direction
            before = math.atan2(*old[::-1])
            turned = _rounded(before, _near(math.atan2(*new[::-1]), before), share * ANGLE_STEP, DEGREE)
            new = old if turned == before else [math.cos(turned), math.sin(turned)]
        return dict(zip(handle.paths, new, strict=True))

    @cached_property
    def all(self):
        """Handles: joints, other points, guides and angles, mass centres."""
        groups: dict[Any, list[Any]] = {}
        for path, steps, dimension in self.declared():
            groups.setdefault(_target(steps, dimension), []).append((path, dimension))
        found = [self.handle(*zip(*group, strict=True)) for group in groups.values()]
        found.sort(key=lambda handle: KINDS.index(handle.kind))
        return found + [self.mass_centre(link) for link, body in self.mechanism.links.items() if body.mass != 0]

    def side_by_side(self):
        """All handles, the more important first; of points that coincide each has a `row`, to be shown side by side."""
        return _in_rows(self.all, self.crank_pins(), CLOSE * self.size)

    def crank_pins(self):
        """Positions of the joints that turn with the crank; they stay free, because they turn it in the drawing."""
        made = self.mechanism
        names = [name for name, point in made.joints.items() if point.link == CRANK]
        return [self.at(name) for name in (*names, *(slot.joint for slot in made.slots if slot.link == CRANK))]

    def declared(self):
        """Path, steps and dimension of each number that a part or load declares."""
        made, loads = self.mechanism, enumerate(self.solution.loads)
        tables: dict[tuple[str | int, ...], Any] = {("mechanism", "crank"): made.crank.dimensions}
        tables |= {("mechanism", "groups", row): group.dimensions for row, group in enumerate(made.groups)}
        tables |= {("loads", row): load.dimensions(made) for row, load in loads if isinstance(load, Load)}
        known = {(*steps, *inner): item for steps, table in tables.items() for inner, item in table.items()}
        places = self.places.items()
        return [(path, place.steps, known[place.steps]) for path, place in places if place.steps in known]

    def handle(self, paths, dimensions):
        """The handle of numbers that determine one point."""
        first, owners = dimensions[0], self.owners(self.places[paths[0]])
        if guide := next((owner for owner in owners if isinstance(owner, Guide)), None):
            slider = next(name for owner in owners for name, other in getattr(owner, "guides", {}).items())
            turns = isinstance(first, Angle)
            return self.turned_guide(paths, guide, slider) if turns else self.shifted_guide(paths, guide, slider)
        if isinstance(first, Angle):
            return self.turned_line(paths, first)
        if isinstance(first, Radius):
            return self.circle(paths, first)
        if first.along is not None:
            return self.coordinates(paths, dimensions)
        if isinstance(first.start, str):
            return self.joint(paths, dimensions)
        if len(paths) == 2:
            return self.place_on_link(paths, dimensions, _words(paths[0].rpartition(".")[0]), "point")
        return self.slot(paths, first, owners[0])

    def owners(self, place):
        """Parts that own the number at a place, the inner ones first."""
        depths = range(len(place.steps) - 1, 2, -1)
        return [place._replace(steps=place.steps[:depth]).value(self.solution) for depth in depths]

    def at(self, point):
        """Position of a joint, a place on a link or a fixed point, (2, N)."""
        return self.motion.as_vector(self.motion.spot(point).position)

    def joint(self, paths, spans):
        """End of one or two bars, whose lengths follow; of one it stays on a guide or on the bar's line."""
        end, starts = spans[0].end, [self.at(span.start) for span in spans]
        guide, pin = self.mechanism.guides.get(self.mechanism.joints[end].link), self.at(end)

        def measure(place, index):
            if len(starts) == 2:
                return [np.hypot(*(place - start[:, index])) for start in starts]
            start = starts[0][:, index]
            if guide is None:
                bar = pin[:, index] - start
                return [bar @ (place - start) / np.hypot(*bar)]
            along = np.array(guide.direction)
            return [np.hypot(*(along * (along @ place) + left(along) * guide.guide_offset - start))]

        label = _words(paths[0]) if len(paths) == 1 else f"joint {end}: {' and '.join(map(_words, paths))}"
        return Handle(paths[0], label, "joint", paths, pin, measure)

    def coordinates(self, paths, spans):
        """Fixed point with coordinates along unit vectors from a fixed start."""
        axes, start = np.array([span.along for span in spans]), np.array(spans[0].start)
        label = _words(paths[0].rpartition(".")[0] if len(paths) == 2 else paths[0])

        def measure(place, index):
            return axes @ (place - start)

        return Handle(paths[0], label, "point", paths, self.at(spans[0].end), measure)

    def place_on_link(self, paths, spans, label, kind):
        """Point fixed to a link, in the link's axes."""
        link, end = spans[0].start[0], spans[1].end
        start, ahead = self.at((link, 0.0, 0.0)), self.at((link, 1.0, 0.0))

        def measure(place, index):
            along = ahead[:, index] - start[:, index]
            return [axis @ (place - start[:, index]) for axis in (along, left(along))]

        return Handle(paths[0], label, kind, paths, self.at(end), measure)

    def mass_centre(self, name):
        spans = tuple(of_point_on_link("centre", (name, *self.mechanism.links[name].centre)).values())
        paths = f"{name}.centre.along", f"{name}.centre.across"
        return self.place_on_link(paths, spans, f"mass centre of the {_words(name)}", "mass")

    def circle(self, paths, circle):
        """A point of a circle."""
        centre, ray = self.at(circle.centre), np.array(DIAGONAL)
        radius = self.places[paths[0]].value(self.solution)

        def measure(place, index):
            return [ray @ (place - centre[:, index])]

        return Handle(paths[0], _words(paths[0]), "joint", paths, centre + radius * ray[:, None], measure)

    def on_guide(self, guide, slider, choose):
        """Point of a guide before or behind the travel of its slider, the nearest (min) or farthest (max) from O."""
        along = np.array(guide.direction)
        travel, more = along @ self.at(self.mechanism.references[slider]), OVERHANG * self.size
        coordinate = choose(np.fmin.reduce(travel) - more, np.fmax.reduce(travel) + more, key=abs)
        return coordinate, self.at(tuple(map(float, along * coordinate + left(along) * guide.guide_offset)))

    def shifted_guide(self, paths, guide, slider):
        """Point of a guide that shifts it."""
        normal, (_, position) = left(np.array(guide.direction)), self.on_guide(guide, slider, min)

        def measure(place, index):
            return [normal @ place]

        return Handle(paths[0], _words(paths[0]), "guide", paths, position, measure)

    def turned_guide(self, paths, guide, slider):
        """Point of a guide that turns it about O, at its offset."""
        offset, (far, position) = guide.guide_offset, self.on_guide(guide, slider, max)

        def measure(place, index):
            coordinate = math.copysign(math.sqrt(max(place @ place - offset * offset, 0.0)), far)
            turned = math.atan2(place[1], place[0]) - math.atan2(offset, coordinate)
            if len(paths) == 2:
                return [math.cos(turned), math.sin(turned)]
            return [_near(turned, guide.angle)]

        label = _words(paths[0].removesuffix(".x").replace("exact", "guide_angle"))
        return Handle(paths[0], label, "turn", paths, position, measure)

    def turned_line(self, paths, angle):
        """Point of a line that turns about a joint; the line of a slot about the joint that slides in it."""
        carrier = self.mechanism.joints[angle.at].link
        base, value = math.atan2(*angle.start[::-1]), self.places[paths[0]].value(self.solution)
        ray = np.array([math.cos(base + value), math.sin(base + value)])
        vertex = self.at(angle.at)
        position = vertex + ARM * self.size * ray[:, None]
        for slot, ends in self.shape.slots:
            if slot.link == carrier:  # just behind its farther end
                far, along = ends[:, 1], np.array([math.cos(slot.angle), math.sin(slot.angle)])
                far = far + math.copysign(self.shape.half_block, far @ along) * along
                vertex, position = self.at(slot.joint), self.at((carrier, *map(float, far)))
        sides = np.sign(ray @ (position - vertex))

        def measure(place, index):
            x, y = sides[index] * (place - vertex[:, index])
            return [_near(math.atan2(y, x) - base, value)]

        return Handle(paths[0], _words(paths[0]), "turn", paths, position, measure)

    def slot(self, paths, span, group):
        """Foot of a slotted lever's axis, on the circle over pivot and block."""
        (link, *_), foot = span.start, self.at(span.end)
        pivot, ahead = self.at(span.start), self.at((link, 1.0, 0.0))
        block = self.at(next(slot.joint for slot in group.slots if slot.link == link))

        def measure(place, index):
            start, pin = pivot[:, index], block[:, index]
            middle, reach = 0.5 * (start + pin), pin - start
            on_circle = middle + 0.5 * np.hypot(*reach) * (place - middle) / np.hypot(*(place - middle))
            axis = (pin - on_circle) / np.hypot(*(pin - on_circle))
            axis *= np.sign((ahead[:, index] - start) @ reach)
            return [left(axis) @ reach]

        return Handle(paths[0], _words(paths[0]), "guide", paths, foot, measure)


def _target(steps, dimension):
    """Key of the point that a number determines, together with others of the same key."""
    if isinstance(dimension, Span) and isinstance(dimension.start, str):
        return dimension.end
    return steps[:-1] if isinstance(steps[-1], int) else steps
