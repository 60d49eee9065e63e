"""The straight guide of a slider: a line of any inclination and offset."""

from typing import Any, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.elementary import cos, sin
from .links import present

ANGLE, OFFSET, POINT = checks.Number("rad"), checks.Number("m"), checks.Pair("m")
DIRECTION = checks.Pair("1", "guide direction")


class Guide(NamedTuple):
    """Guide line by its direction (unit vector) and its signed distance from O along its left normal, m.

    Make one with `Guide.at` (angle and offset) or `Guide.through` (two points).
    """

    direction: Any
    guide_offset: Any = 0.0

    @classmethod
    def at(cls, guide_angle=0.0, guide_offset=0.0):
        """Guide at an angle (rad, counter-clockwise from +x) and offset (m)."""
        angle, offset = ANGLE.quick(guide_angle), OFFSET.quick(guide_offset)
        if angle is checks.UNSURE or offset is checks.UNSURE:
            rules = {"guide_angle": ANGLE, "guide_offset": OFFSET}
            given = {"guide_angle": guide_angle, "guide_offset": guide_offset}
            angle, offset = checks.examined("guide", rules, given).values()
        if isinstance(angle, float):
            return cls((float(cos(angle)), float(sin(angle))) if angle else (1.0, 0.0), offset)
        return cls((cos(angle), sin(angle)), offset)

    @classmethod
    def through(cls, W1, W2):
        """Guide through two fixed points (x, y), m, directed from W1 to W2; numbers, not batches.

        Raises
        ------
        ParameterError
            The points coincide or are not finite pairs.
        """
        points = checks.examined("guide", {"W1": POINT, "W2": POINT}, {"W1": W1, "W2": W2})
        batch = [f"{name} must be one point, not a batch" for name, point in points.items() if any(map(np.ndim, point))]
        checks.require("guide", *batch)
        from decimal import Decimal, localcontext

        with localcontext(prec=50):  # direction and offset are rounded once: what they lose, every position loses
            (x1, y1), (x2, y2) = ([Decimal(float(part)) for part in point] for point in points.values())
            x, y = x2 - x1, y2 - y1
            length = (x * x + y * y).sqrt()
            checks.require("guide", None if length else f"W1 and W2 coincide at {points['W1']}")
            return cls((float(x / length), float(y / length)), float((x * y1 - y * x1) / length))

    @property
    def is_level(self):
        """Whether it points along +x, by plain numbers."""
        return present(self.direction[0] - 1.0) is None and present(self.direction[1]) is None

    @property
    def guide_angle(self):
        """Angle of the direction from +x, rad."""
        return np.arctan2(self.direction[1], self.direction[0])[()]


class Line:
    """Rule of a field that is a guide, whose direction must have length 1."""

    words = "made by Guide.at or .through"

    def quick(self, value):
        if type(value) is not Guide or type(value.direction) is not tuple or len(value.direction) != 2:
            return checks.UNSURE
        (x, y), offset = value.direction, value.guide_offset
        plain = type(x) is float and type(y) is float and OFFSET.quick(offset) is offset
        return value if plain and abs(x * x + y * y - 1.0) < 1e-9 else checks.UNSURE

    def taken(self, value, field=""):
        if not isinstance(value, Guide):
            return value, f"{field} must be {self.words}, got {checks.shown(value)}"
        direction, problem = DIRECTION.taken(value.direction)
        offset, other = OFFSET.taken(value.guide_offset, "guide_offset")
        return Guide(direction, offset), problem or other or self._problem(direction)

    def _problem(self, direction):
        length = np.hypot(*direction) if all(map(checks.known, direction)) else 1.0
        right = np.all(np.abs(length - 1.0) < 1e-9)
        return None if right else f"guide direction must have length 1, got {length}; use Guide.at"
