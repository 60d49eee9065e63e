"""The straight guide of a slider: a line of any inclination and offset."""

from typing import Any, NamedTuple

import numpy as np

from . import checks
from .elementary import cos, sin
from .links import present


class Guide(NamedTuple):
    """Guide line by its direction (unit vector) and its signed distance from O along its left normal, m.

    Make one with `Guide.at` (angle and offset) or `Guide.through` (two points).
    """

    direction: Any
    guide_offset: Any = 0.0

    @classmethod
    def at(cls, guide_angle=0.0, guide_offset=0.0):
        """Guide at an angle (rad, counter-clockwise from +x) and offset (m)."""
        checks.require("guide", checks.finite("guide_angle", guide_angle), checks.finite("guide_offset", guide_offset))
        if isinstance(guide_angle, int | float) and guide_angle == 0:
            return cls((1.0, 0.0), guide_offset)
        return cls((cos(guide_angle), sin(guide_angle)), guide_offset)

    @classmethod
    def through(cls, W1, W2):
        """Guide through two fixed points (x, y), m, directed from W1 to W2; numbers, not batches.

        Raises
        ------
        ParameterError
            The points coincide or are not finite pairs.
        """
        checks.require("guide", checks.pair("W1", W1), checks.pair("W2", W2))
        from decimal import Decimal, localcontext

        with localcontext(prec=50):  # direction and offset are rounded once: what they lose, every position loses
            (x1, y1), (x2, y2) = ([Decimal(float(part)) for part in point] for point in (W1, W2))
            x, y = x2 - x1, y2 - y1
            length = (x * x + y * y).sqrt()
            checks.require("guide", None if length else f"W1 and W2 coincide at {tuple(W1)}")
            return cls((float(x / length), float(y / length)), float((x * y1 - y * x1) / length))

    @property
    def is_level(self):
        """Whether it points along +x, by plain numbers."""
        return present(self.direction[0] - 1.0) is None and present(self.direction[1]) is None

    @property
    def guide_angle(self):
        """Angle of the direction from +x, rad."""
        return np.arctan2(self.direction[1], self.direction[0])[()]
