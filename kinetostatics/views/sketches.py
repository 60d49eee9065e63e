"""Kinematic sketch of a machine at one crank angle, with its dimensions and their names.

Groups declare what their numbers measure (`machine.dimensions`). Dimension lines keep away from links and from each
other; their texts are placed as all labels. Numbers that no group declares stand below the sketch.
"""

from typing import Any

import numpy as np

from ..machine.dimensions import Angle, Radius, Span
from ..numbers import checks, formatting
from ..numbers.output_units import dimension_name, shown_units
from ..numbers.paths import places_by_path
from ..solution.parameters import is_zero
from ..solution.scene import Scene
from .axis_units import one_panel_each, with_units
from .canvas import NOTE_STYLE, STEEL, axes, single_solution
from .drawings import draw_poses
from .labels import label
from .strokes import Shape, at_angles, left, whole_turn

SKETCH_ANGLES = np.arange(40.0, 400.0, 10.0)
"""Crank angles from which the default is chosen, degrees, the preferred first."""
UNITS = {"m": (1e3, " mm"), "rad": (180.0 / np.pi, "°"), "kg": (1.0, " kg")}
"""Factor and unit of numbers on a sketch, by SI unit."""
DIMENSION: dict[str, Any] = {"color": "tab:blue", "lw": 0.7, "zorder": 4.5}
EXTENSION: dict[str, Any] = {"color": "tab:blue", "lw": 0.4, "zorder": 1.4}
BOX: dict[str, Any] = {"boxstyle": "square,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.8}
TEXT: dict[str, Any] = {"color": "tab:blue", "fontsize": "x-small", "bbox": BOX}
STEP, CLEARANCE, ARROW = 2.0, 1.1, 0.8
"""Distance between dimension lines, from drawn parts, and length of arrows, in half lengths of a block."""
LEVELS = np.array([level * side for level in range(1, 9) for side in (1, -1)])
"""Places of a dimension line beside what it measures, in steps to the left, the nearest first."""
TOO_CLOSE, FARTHER = 1.0, 0.04
"""Costs of a dimension line of which all lies too close to drawn parts, and of each step away."""
MARGINS = 0.28, 0.2
"""Margins for dimensions beside and above the sketch, relative to its size."""
NOTES_PER_LINE = 3
ROUNDING = 1e-9
"""Largest coordinate of a mass centre, relative to the other one, that is shown as zero."""
CLEAR_ENOUGH = 0.85
"""Share of the largest distance between joints and links at which the default crank angle is taken."""
WIDTH, HEIGHTS = 6.4, (2.4, 5.6)
"""Width of a new figure and limits of its height, inches."""


@with_units
@one_panel_each(6.4, 3.6)
def sketch(machine, dimensions=True, angle=None, ax=None):
    """Kinematic sketch of a machine at one crank angle: links, joints, guides, cam, loads, and its dimensions.

    Dimensions have the names of the parameters, as in `scene.parameters` and case files, and values in mm, degrees and
    kg. Zeros are left out. Lengths and angles that a group does not declare stand below the sketch.

    Parameters
    ----------
    machine : Mechanism, Scene, variant of a case, Solution, or mapping of label to one
        Of one design. Several get a panel each.
    dimensions : bool
        Whether to show dimensions.
    angle : float, optional
        Crank angle, degrees, from +x, counter-clockwise; by default one at which joints and links lie well apart.

    Returns
    -------
    Axes
        With equal scales, without frame.

    Raises
    ------
    ParameterError
        The argument is no machine, or a batch of designs, or it does not close at the crank angle.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ax = ks.plots.sketch(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), angle=60)
    >>> sorted(text.get_text() for text in ax.texts if "=" in text.get_text())
    ['coupler_length = 2000 mm', 'crank angle = 60°', 'crank_length = 300 mm', 'slider.mass = 600 kg']
    """
    scene = getattr(machine, "scene", machine)
    if checks.mechanism("machine", scene) is None:
        scene = Scene(scene, 1.0)
    problem = None if hasattr(scene, "loads") else f"machine must be a Mechanism or a Scene, got {machine!r}"
    checks.require("sketch", problem)
    solution = scene if hasattr(scene, "crank_angle") else scene.unsolved(np.zeros(1))
    solution, given = single_solution(solution), ax
    angle = _clearest_angle(solution) if angle is None else angle
    angle, ax = checks.single_numbers("sketch", angle=(angle, "deg", {}))["angle"], axes(given)
    motion = at_angles(solution, np.array([angle]))
    is_open = any(np.isnan(motion.position(name)).any() for name in motion.mechanism.joints)
    title = motion.mechanism.name
    checks.require("sketch", f"{title} does not close at crank angle {angle:.6g} deg" if is_open else None)
    pose = draw_poses(ax, {"": solution}, [angle], [1.0])
    ax.set_axis_off()
    if dimensions:
        _Dimensions(ax, Shape(whole_turn(solution)), pose).draw(angle)
        ax.margins(*MARGINS)
    if given is None:
        size = ax.dataLim.size
        ax.figure.set_size_inches(WIDTH, np.clip(WIDTH * size[1] / size[0], *HEIGHTS))
    return ax


def _clearest_angle(solution):
    """Crank angle, degrees, at which joints lie farthest from each other and from the links between others."""
    motion = at_angles(solution, SKETCH_ANGLES)
    places = {name: motion.position(name) for name in motion.mechanism.joints}
    least = np.full(SKETCH_ANGLES.shape, np.inf)
    for bar in motion.mechanism.bars:
        start, end = places[bar.start], places[bar.end]
        for name in places.keys() - {bar.start, bar.end}:
            share = np.sum((places[name] - start) * (end - start), axis=0) / np.sum((end - start) ** 2, axis=0)
            foot = start + np.clip(share, 0.0, 1.0) * (end - start)
            least = np.minimum(least, np.hypot(*(places[name] - foot)))
    least = np.where(np.isnan([place[0] for place in places.values()]).any(axis=0), -1.0, least)
    return SKETCH_ANGLES[np.argmax(least >= CLEAR_ENOUGH * least.max())] % 360.0


def text_of(path, value, unit):
    """A number as text with its name, "crank_length = 300 mm"."""
    factor, shown = _shown(unit)
    return f"{path} = {formatting.number(factor * value)}{shown}"


def _shown(unit):
    """Factor and unit of numbers on a sketch: those that the user chooses, else the usual ones."""
    factor, shown = shown_units().of(unit)
    return (factor, f" {shown}") if dimension_name(unit) in shown_units().chosen else UNITS[unit]


def _mass_text(name, link):
    """Mass of a link, and its mass centre if it is not at the reference joint."""
    mass = text_of(f"{name}.mass", link.mass, "kg")
    factor, shown = _shown("m")
    noise = ROUNDING * factor * max(map(abs, link.centre))
    along, across = (formatting.number(factor * part, bound=noise) for part in link.centre)
    if along == across == "0":
        return mass
    return f"{mass}\n{name}.centre = {along if across == '0' else f'({along}, {across})'}{shown}"


def _declared(mechanism):
    """Dimension, value and text of each declared number that is not zero; texts of all other lengths and angles."""
    parts = {("crank",): mechanism.crank} | {("groups", row): part for row, part in enumerate(mechanism.groups)}
    known = {(*steps, *inner): item for steps, part in parts.items() for inner, item in part.dimensions.items()}
    masses = tuple(f"{link}." for link in mechanism.links)
    found, rest = [], []
    for path, place in places_by_path(mechanism).items():
        value, unit = place.value(mechanism), place.rule.unit
        if is_zero(value) or unit not in ("m", "rad") or path.startswith(masses):
            continue
        text = text_of(path, value, unit)
        if place.steps in known:
            found.append((known[place.steps], float(value), text))
        else:
            rest.append(text)
    return found, rest


class _Dimensions:
    """Dimensions of a pose, drawn on axes; `occupied` (2, K) are points that dimension lines avoid."""

    def __init__(self, ax, shape, pose):
        self.ax, self.shape, self.pose, self.half_block = ax, shape, pose, shape.half_block
        drawn = [stroke.points[..., 0] for stroke in shape.strokes(pose)] + list(shape.rails())
        self.occupied = np.concatenate([_dense(points, 0.5 * self.half_block) for points in drawn], axis=1)

    def draw(self, angle):
        """Draw the crank angle, degrees, all dimensions, the shortest first, and mass centres."""
        declared, rest = _declared(self.pose.mechanism)
        self.draw_angle(Angle("O"), np.radians(angle % 360.0), f"crank angle = {formatting.angle(angle % 360.0)}°")
        kinds = {Span: self.draw_span, Angle: self.draw_angle, Radius: self.draw_radius}
        for dimension, value, text in sorted(declared, key=lambda item: abs(item[1])):
            kinds[type(dimension)](dimension, value, text)
        for name in self.shape.heavy:
            label(self.ax, _mass_text(name, self.pose.mechanism.links[name]), self.at(name), color=STEEL, bbox=BOX)
        rows = [",   ".join(rest[row : row + NOTES_PER_LINE]) for row in range(0, len(rest), NOTES_PER_LINE)]
        self.ax.text(0.5, -0.02, "\n".join(rows), transform=self.ax.transAxes, ha="center", va="top", **NOTE_STYLE)

    def at(self, point):
        """Place (2,) of a point in the pose."""
        return np.reshape(self.pose.position(point), (2, -1))[:, 0]

    def place(self, lines, costs):
        """The line (2, K) of lowest cost that avoids drawn objects; later lines avoid it."""
        samples, room = [_dense(line, 0.5 * self.half_block) for line in lines], CLEARANCE * self.half_block
        close = [
            np.mean(np.min(np.hypot(*(self.occupied[:, None] - dense[..., None])), axis=1) < room) for dense in samples
        ]
        best = int(np.argmin(TOO_CLOSE * np.array(close) + costs))
        self.occupied = np.concatenate([self.occupied, samples[best]], axis=1)
        return lines[best]

    def draw_span(self, span, _, text):
        """Draw a dimension line beside both points, with extension lines and arrows."""
        start, end = self.at(span.start), self.at(span.end)
        along = (end - start) / np.hypot(*(end - start)) if span.along is None else np.array(span.along)
        across = left(along)
        heights = np.array([start, end]) @ across
        lines = []
        for level in LEVELS:
            height = (heights.max() if level > 0 else heights.min()) + level * STEP * self.half_block
            lines.append(np.stack([start, end], axis=1) + across[:, None] * (height - heights))
        line = self.place(lines, FARTHER * np.abs(LEVELS))
        for point, foot in zip((start, end), line.T, strict=True):
            self.ax.plot(*np.stack([point, foot + 0.5 * self.half_block * _unit(foot - point)], axis=1), **EXTENSION)
        inward, reach = _unit(line[:, 1] - line[:, 0]), ARROW * self.half_block
        if outside := np.hypot(*(line[:, 1] - line[:, 0])) < 3.0 * reach:
            inward = -inward
        self.draw_arrow(line[:, 0], -inward)
        self.draw_arrow(line[:, 1], inward)
        more = 2.5 * reach * outside * inward
        self.ax.plot(*np.stack([line[:, 0] + more, line[:, 1] - more], axis=1), **DIMENSION)
        label(self.ax, text, line.mean(axis=1), **TEXT)

    def draw_angle(self, angle, value, text):
        """Draw an arc from the start of an angle, with its reference line."""
        vertex, base = self.at(angle.at), np.arctan2(*angle.start[::-1])
        turns = base + np.linspace(0.0, value, 40)
        radii = self.half_block * np.array([4.0, 5.5, 7.0, 8.5])
        arcs = [vertex[:, None] + radius * np.array([np.cos(turns), np.sin(turns)]) for radius in radii]
        arc = self.place(arcs, FARTHER * np.arange(len(arcs)))
        radius = np.hypot(*(arc[:, 0] - vertex))
        self.ax.plot(*arc, **DIMENSION)
        self.ax.plot(*np.stack([vertex, vertex + 1.2 * (arc[:, 0] - vertex)], axis=1), **EXTENSION)
        tip = arc[:, -1] - vertex
        self.draw_arrow(arc[:, -1], np.sign(value) * left(tip) / radius)
        label(self.ax, text, arc[:, arc.shape[1] // 2], **TEXT)

    def draw_radius(self, circle, value, text):
        """Draw a line with an arrow from the centre of a circle to it."""
        centre, turns = self.at(circle.centre), np.radians(np.arange(20.0, 380.0, 30.0))
        rays = [np.array([np.cos(turn), np.sin(turn)]) for turn in turns]
        lines = [np.stack([centre, centre + value * ray], axis=1) for ray in rays]
        line = self.place(lines, np.zeros(len(lines)))
        self.ax.plot(*line, **DIMENSION)
        self.draw_arrow(line[:, 1], _unit(line[:, 1] - line[:, 0]))
        label(self.ax, text, line @ [0.4, 0.6], **TEXT)

    def draw_arrow(self, tip, along):
        """Draw the head of an arrow along a unit vector."""
        foot, side = tip - ARROW * self.half_block * along, 0.2 * ARROW * self.half_block * left(along)
        self.ax.fill(*np.stack([tip, foot + side, foot - side], axis=1), color=DIMENSION["color"], lw=0, zorder=4.5)


def _unit(vector):
    """The unit vector along a vector; zero for none."""
    return vector / (np.hypot(*vector) or 1.0)


def _dense(points, step):
    """Points (2, K) along a line, at most a step apart; NaN lifts the pen."""
    legs = np.hypot(*np.diff(points))
    parts = [points[:, np.isfinite(points[0])]]
    for start, end, leg in zip(points.T[:-1], points.T[1:], legs, strict=True):
        if leg > step:  # never for NaN
            parts.append(start[:, None] + (end - start)[:, None] * np.arange(0.0, 1.0, step / leg))
    return np.concatenate(parts, axis=1)
