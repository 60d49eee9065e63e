"""Work of a slider on its stroke: a saw that cuts on one stroke, a mower's knife that cuts on both.

A log that advances by D for each cutting stroke S leaves n saws, b wide, the volume n b H D at the height H. With the
work K for a volume the force is F = K n b H D / S over the whole stroke, if saw and log move in proportion.

At mid-stroke the sections of a knife stand midway between two fingers. u is the distance of a section from the finger
behind, p the pitch. The edge of a section, half widths w(y), meets the edge of the finger ahead, f(y), at u = p - w -
f. This is from `start` at the foot of the edges to `end` at their tips. It cuts where sin(pi (u - start) / p) sin(pi (u
- end) / p) < 0. Stalks at even distances between straight edges make the force constant.
"""

import math
from dataclasses import KW_ONLY, dataclass, field
from functools import reduce
from typing import Annotated, Any

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.arithmetic import sign, sin
from ...numbers.planar import add_vectors, number_or_zero, product, rotate
from ..links import Wrench, present
from .dead_centres import dead_centres
from .load import Jumps, unknown_sense
from .slider import WorkForce
from .table import Table
from .table_pieces import TURN, stops_and_crossings

CUTS = {"toward crank": -1.0, "away": 1.0}
"""Sense of the cutting stroke by its name: +1 from the near dead centre to the far one."""
MAX_PITCHES = 1000
"""Largest number of fingers that a section passes in a stroke."""
MILLIMETRES, MEGAPASCALS = "is it in mm?", "is it in MPa?"
TERMS = {
    "push.far": ("s_f", "coordinate of the far dead centre"),
    "push.near": ("s_n", "coordinate of the near dead centre"),
    "push.work": ("W", "work of the cutting stroke"),
    "push.way": ("d", "sense of the motion along the guide"),
    "push.first": ("q_1", "sine of the phase of a section after the start of its cut"),
    "push.last": ("q_2", "sine of its phase after the end of the cut"),
    "push.meeting": ("q", "opposite of their product: positive while sections cut"),
    "push.cutting": ("z", "share of the force that acts: 1 while sections cut"),
}


class StrokeForce(WorkForce):
    """A load on the stroke of a slider; `ends`: coordinates of its far and near dead centre, m, if known."""

    ends: Any
    REFUSES = STROKE = True

    def stroke(self, motion):
        """Coordinates of the far and of the near dead centre, m."""
        return dead_centres(motion, self.on)[1] if self.ends is None else self.ends

    def way(self, motion):
        """Sense, +1 or -1 along the guide, in which the slider moves or is about to move."""
        return sign(motion.placement.travels[self.on].first) * motion.crank_sense

    def refusals(self, motion):
        """Sentence on rest in an unknown sense."""
        return unknown_sense(self, motion)

    @property
    def jumps(self):
        """Where the force begins and ends."""
        return Jumps(self.jump_angles)

    def jump_angles(self, motion):
        """Crank angles of the dead centres, (1 or designs, J), rad."""
        return np.mod(np.column_stack(dead_centres(motion, self.on)[0]), TURN * motion.mechanism.turns)


@dataclass(frozen=True, eq=False)
class Sawing(StrokeForce):
    """Cut of the saws on a slider: a constant force against the motion on the cutting stroke, none on the other.

    Parameters
    ----------
    kerf, height : float or array
        Width b and height H of the cut of one saw, m; of a round log the mean height over the saws.
    saws : float or array
        Number n of the saws in the log.
    feed_per_stroke : float or array
        Advance D of the log for each cutting stroke, m.
    resistance : float, array or function
        Specific cutting resistance K, Pa (1 MPa is 1 N/mm2, or 1 J/cm3); a function takes the mean thickness of a chip,
        ``feed_per_stroke * pitch / S``, m, and returns K.
    cuts : "toward crank" or "away"
        Stroke on which it cuts.
    thrust : float or array
        Force of the log across the guide while it is cut, to the left of its direction, as a fraction of F.
    overhang : float or array
        Position of the log along the guide from the slider's pin at mid-stroke, m. The log does not move, so the arm of
        the thrust about the pin is this distance less the travel of the pin.
    pitch : float or array, optional
        Pitch of the teeth, m; only for a resistance by chip thickness.
    on : str
        Slider with the saws, without dwells. The mechanism gives its stroke S.
    reaction : "frame" or "outside"
        Body that takes the opposite force: the frame, whose rollers carry the log, or an external body.

    Raises
    ------
    ParameterError
        A value is no finite number, or negative (except thrust and overhang), or a function has no pitch. When a scene
        is made: the slider is unknown. When it is solved: the slider does not reciprocate once in a turn, dwells, or is
        at rest in an unknown sense.

    Notes
    -----
    F = K n b H D / S: work K for each volume of wood, spread over the stroke. Power F S times the strokes a second.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> frame = ks.crank_slider(0.3, 2.0, slider=ks.Link(mass=600.0))
    >>> cut = ks.Sawing(kerf=3.2e-3, height=0.25, saws=8, feed_per_stroke=0.02, resistance=50e6, cuts="toward crank")
    >>> s = ks.solve(frame, [1.0, 5.0], crank_speed=33.5, loads=cut)
    >>> [round(float(force)) for force in cut.push(s)]  # N: 50e6 * 8 * 3.2e-3 * 0.25 * 0.02 / 0.6 = 10667
    [10667, 0]
    """

    _: KW_ONLY
    kerf: Annotated[Any, checks.Number("m", low=0.0, usual=checks.PlausibleRange(0.1, MILLIMETRES, 1e-3))]
    height: Annotated[Any, checks.Number("m", low=0.0, usual=checks.PlausibleRange(5.0, MILLIMETRES, 1e-3))]
    saws: Annotated[Any, checks.Number("1", low=0.0)]
    feed_per_stroke: Annotated[Any, checks.Number("m", low=0.0, usual=checks.PlausibleRange(1.0, MILLIMETRES, 1e-3))]
    resistance: Annotated[
        Any,
        checks.OrFunction(checks.Number("Pa", low=0.0, usual=checks.PlausibleRange(1e10, MEGAPASCALS, 1e6, least=1e4))),
    ]
    cuts: Annotated[str, checks.Word(tuple(CUTS))] = "toward crank"
    thrust: Annotated[Any, checks.Number("1")] = 0.0
    overhang: Annotated[Any, checks.Number("m")] = 0.0
    pitch: Annotated[Any, checks.Optional(checks.Number("m", low=0.0))] = None
    on: str = "slider"
    reaction: str = "frame"
    ends: Any = field(default=None, init=False, repr=False)

    PATH, VALUE, UNIT = "sawing", "resistance", "Pa"

    def _joint_problems(self):
        """Sentences on an inconsistent resistance and pitch."""
        if isinstance(self.resistance, Table):
            yield "resistance must be a number or a function of the chip thickness, got a Table"
        elif callable(self.resistance) and self.pitch is None:
            yield "a resistance that is a function of the chip thickness needs the pitch of the teeth"
        elif not callable(self.resistance) and self.pitch is not None:
            yield "pitch is for a resistance that is a function of the chip thickness; leave it out"

    RULES = checks.Rules("sawing", _joint_problems)

    @property
    def value_now(self):
        """The specific cutting resistance, or the function of the motion that gives it."""
        return self._resistance_of_chip if callable(self.resistance) else self.resistance

    def _resistance_of_chip(self, motion):
        far, near = self.stroke(motion)
        found = self.resistance(self.feed_per_stroke * self.pitch / abs(far - near))
        if checks.not_a_number(found) is None and np.any(np.less(found, 0.0)):
            raise ParameterError(f"{self.title}: its resistance must not be negative, got {checks.shown(found)}")
        return found

    def push(self, motion):
        """Force on the slider along the guide, N."""
        far, near = self.stroke(motion)
        factors = self.resistance, self.saws, self.kerf, self.height, self.feed_per_stroke
        work = reduce(product, map(present, factors))
        return number_or_zero(product(work, 0.5 * (self.sense(motion) - self.way(motion)) / abs(far - near)))

    def wrenches(self, motion):
        """Thrust of the log across the guide, with its moment about the slider's pin."""
        across = self._across(motion)
        if across is not None:
            arm = self.foot(motion) - motion.placement.travels[self.on].position
            yield self.on, Wrench(rotate((0.0, across), motion.mechanism.guides[self.on].direction), across * arm)

    def _across(self, motion):
        """Thrust of the log, N; None if zero."""
        return None if present(self.thrust) is None else self.thrust * abs(self.push(motion))

    def foot(self, motion):
        """Coordinate of the log along the guide, m."""
        far, near = self.stroke(motion)
        return 0.5 * (far + near) + self.overhang

    def support(self, motion):
        """Force of the log on the frame, at the log."""
        found, across = super().support(motion), self._across(motion)
        if across is None:
            return found
        thrust = rotate((0.0, -across), motion.mechanism.guides[self.on].direction)
        return found._replace(force=add_vectors(found.force, thrust))

    def sense(self, motion):
        """Sign of the cutting force along the guide."""
        far, near = self.stroke(motion)
        return -CUTS[self.cuts] * sign(far - near)


@dataclass(frozen=True, eq=False)
class Mowing(StrokeForce):
    """Cut of a mower's knife on a slider: a constant force against the motion while sections meet fingers.

    At mid-stroke the sections stand midway between two fingers; both strokes cut.

    Parameters
    ----------
    force : float or array
        Force of all sections together while they cut, N.
    pitch : float or array
        Distance of two fingers, m. A knife with a longer stroke passes several.
    start, end : float or array
        Distances of a section from the middle of the finger that it leaves, m; between them it cuts at the next finger.
        They are ``pitch`` less half the widths of section and finger, at the foot of their edges and at their tips.
    on : str
        Slider that carries the knife.
    reaction : "frame" or "outside"
        Body that takes the opposite force: the fingers on the frame, against which the knife presses the stalks, or
        the ground in which the stalks stand.

    Raises
    ------
    ParameterError
        The force is negative, or not ``0 <= start < end <= pitch``. When a scene is made: the slider is unknown. When
        it is solved: the slider does not reciprocate once in a turn, or stands still in an unknown sense.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> knife = ks.crank_slider(0.038, 0.4, slider=ks.Link(mass=4.0))
    >>> crop = ks.Mowing(600.0, pitch=0.0762, start=0.026, end=0.060)
    >>> s = ks.solve(knife, [0.3, 1.5, 4.7], crank_speed=60.0, loads=crop)
    >>> [round(float(force)) for force in crop.push(s)]  # N
    [0, 600, -600]
    """

    force: Annotated[Any, checks.Number("N", low=0.0)]
    _: KW_ONLY
    pitch: Annotated[Any, checks.Number("m", low=0.0, strict=True, usual=checks.PlausibleRange(1.0, MILLIMETRES, 1e-3))]
    start: Annotated[Any, checks.Number("m", low=0.0)]
    end: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    on: str = "slider"
    reaction: str = "frame"
    ends: Any = field(default=None, init=False, repr=False)

    PATH = "mowing"

    def _joint_problems(self):
        """Sentence unless start, end and pitch rise."""
        row = (self.start, self.end, self.pitch)
        if all(map(checks.has_known_values, row)) and np.any((self.start >= self.end) | (self.end > self.pitch)):
            yield "start must be less than end, and end at most the pitch; got " + ", ".join(map(checks.shown, row))

    RULES = checks.Rules("mowing", _joint_problems)

    def push(self, motion):
        """Force on the slider along the guide, N."""
        way = self.way(motion)
        passed = self._passed(motion.placement.travels[self.on].position, self.stroke(motion))
        first = sin(math.pi * (passed - way * self.start) / self.pitch)
        last = sin(math.pi * (passed - way * self.end) / self.pitch)
        meeting = -first * last
        cutting = 0.5 * (1.0 + sign(meeting)) + 0.0 * meeting  # NaN without a stroke
        return number_or_zero(product(present(self.force), -way * cutting))

    def _passed(self, position, ends):
        """Distance along the guide from the position of sections within fingers, half a pitch before mid-stroke, m."""
        return position - 0.5 * (ends[0] + ends[1]) + 0.5 * self.pitch

    def jump_angles(self, motion):
        """Crank angles of the dead centres, and of start and end of the cut, (1 or designs, J), rad."""
        far, near = ends = self.stroke(motion)
        pitches = np.max(np.nan_to_num(abs(far - near) / self.pitch))
        if pitches > MAX_PITCHES:
            words = f"its stroke has {pitches:.4g} times the pitch; at most {MAX_PITCHES} are resolved"
            raise ParameterError(f"{self.title}: {words}")
        most = np.ceil(pitches) + 2.0
        found = [super().jump_angles(motion)]
        for place in (self.start, self.end, -self.start, -self.end):  # each of both senses of motion
            origin = place - self._passed(0.0, ends)
            found.append(stops_and_crossings(motion, self.on, np.arange(-most, most + 1.0), origin, self.pitch)[1])
        rows = max(map(len, found))
        return np.column_stack([np.broadcast_to(part, (rows, part.shape[1])) for part in found])

    def sense(self, motion):
        """Sign of the force along the guide: against the motion."""
        return -self.way(motion)
