"""The straight guide of a slider: a line of any inclination and offset from O, and the motion of a slider on it."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import cos, sin
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import Axis
from ..numbers.planar import add_vectors, dot, number_or_zero, rotate, vector_or_zero
from .dimensions import ORIGIN, Angle, Span
from .links import Joint, LinkMotion, present

POINT = checks.Pair("m")


class Line(NamedTuple):
    """Guide for kernels: None for a direction along +x and for a zero offset."""

    direction: Any
    offset: Any


@dataclass(frozen=True, eq=False)
class Guide(checks.Checked):
    """Guide line by its angle and its signed distance from O along its left normal.

    Make one with `Guide.at` (angle and offset) or `Guide.through` (two points).

    Attributes
    ----------
    angle : float or array or None
        From +x, rad; None for a guide through two points, whose `exact` direction was rounded once.
    guide_offset : float or array
        m.
    exact : (x, y) or None
        Unit vector.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.crank_slider(0.3, 2.0, guide=ks.Guide.at(0.0, 0.05)).guides  # level, 50 mm above O
    {'slider': Guide(angle=0.0, guide_offset=0.05, exact=None)}
    """

    angle: Annotated[Any, checks.Optional(checks.Number("rad", "guide_angle"))] = 0.0
    guide_offset: Annotated[Any, checks.Number("m")] = 0.0
    exact: Annotated[Any, checks.Optional(checks.Pair("1", "direction"))] = None

    PATHS: ClassVar = {"angle": "guide_angle"}

    def _unit_vector(self):
        """Yield problems of the exact direction."""
        if self.exact is None:
            if self.angle is None:
                yield "it needs an angle, or an exact direction; use Guide.at"
        elif all(map(checks.has_known_values, self.exact)):
            length = np.hypot(*self.exact)
            if np.any(np.abs(length - 1.0) > 1e-9):
                yield f"direction must have length 1, got {length}; change x and y together, or use Guide.at"

    RULES = checks.Rules("guide", _unit_vector)

    def __post_init__(self):
        super().__post_init__()
        if self.exact is not None:
            object.__setattr__(self, "exact", Axis.of(self.exact))

    @classmethod
    def at(cls, guide_angle=0.0, guide_offset=0.0) -> "Guide":
        """Guide at an angle and an offset from O.

        Parameters
        ----------
        guide_angle : float or array
            Direction in which the slider's coordinate grows, rad, counter-clockwise from +x.
        guide_offset : float or array
            Distance of the guide from O along its left normal, m; negative where it passes to the right of O.

        Raises
        ------
        ParameterError
            A value is not finite.

        Examples
        --------
        >>> import numpy as np
        >>> import kinetostatics as ks
        >>> upright = ks.crank_slider(0.05, 0.2, guide=ks.Guide.at(np.pi / 2))  # an engine with its cylinder on top
        >>> s = ks.solve(upright, np.pi / 2, crank_speed=300.0)
        >>> s.position("B").round(6), round(float(s.slider_position), 6)
        (array([0.  , 0.25]), 0.25)
        """
        if guide_angle is None:
            checks.require("guide", cls.RULES.rules["angle"].rule.check(guide_angle)[1])
        return cls(guide_angle, guide_offset)

    @classmethod
    def through(cls, W1, W2) -> "Guide":
        """Guide through two fixed points; direction and offset are rounded once.

        Its parameters are `exact` and `guide_offset`; use `Guide.at` to vary the angle.

        Parameters
        ----------
        W1, W2 : (x, y)
            m; the slider's coordinate grows from W1 to W2. Numbers, not batches.

        Raises
        ------
        ParameterError
            The points coincide or are not finite pairs.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> guide = ks.Guide.through((0.0, -0.02), (1.0, -0.02))  # 20 mm below O, as the mower study has it
        >>> guide.direction, guide.guide_offset
        ((1.0, 0.0), -0.02)
        """
        points = checks.check_values("guide", {"W1": POINT, "W2": POINT}, {"W1": W1, "W2": W2})
        batch = [f"{name} must be one point, not a batch" for name, point in points.items() if any(map(np.ndim, point))]
        checks.require("guide", *batch)
        from decimal import Decimal, localcontext

        with localcontext(prec=50):  # direction and offset are rounded once: what they lose, every position loses
            (x1, y1), (x2, y2) = ([Decimal(float(part)) for part in point] for point in points.values())
            x, y = x2 - x1, y2 - y1
            length = (x * x + y * y).sqrt()
            checks.require("guide", None if length else f"W1 and W2 coincide at {points['W1']}")
            return cls(None, float((x * y1 - y * x1) / length), (float(x / length), float(y / length)))

    def dimensions(self, pin):
        """Offset from O, and angle at the pin of a slider."""
        x, y = self.direction
        foot = (-self.guide_offset * y, self.guide_offset * x)
        turned = dict.fromkeys([("angle",), ("exact", 0), ("exact", 1)], Angle(pin))
        return {("guide_offset",): Span(ORIGIN, foot), **turned}

    @property
    def rounded(self):
        """Numbers rounded once: direction and offset of a guide through two points off the axes."""
        return () if self.exact is None or type(self.exact) is Axis else (*self.exact, self.guide_offset)

    @property
    def instead(self):
        """Advice to a user who varies the angle of a guide through two points."""
        angle, offset = (np.asarray(part).tolist() for part in (self.guide_angle, self.guide_offset))
        return f", as the guide runs through two points: make it by Guide.at({angle}, {offset}) to change its angle"

    @property
    def is_level(self):
        """Whether it points along +x."""
        if self.exact is None:
            return present(self.angle) is None
        return present(self.exact[0] - 1.0) is None and present(self.exact[1]) is None

    @cached_property
    def direction(self):
        """Unit vector along the guide."""
        if self.exact is not None:
            return self.exact
        if self.is_level:
            return (1.0, 0.0)
        x, y = cos(self.angle), sin(self.angle)
        return (float(x), float(y)) if isinstance(self.angle, float) else (x, y)

    @property
    def guide_angle(self):
        """Angle of the direction from +x, rad."""
        return np.arctan2(self.direction[1], self.direction[0])[()] if self.angle is None else self.angle

    @cached_property
    def line(self):
        """Guide for kernels."""
        return Line(None if self.is_level else self.direction, present(self.guide_offset))


SliderGuide = Annotated[Guide, checks.InstanceOf(Guide, "made by Guide.at or .through")]
"""Type of a field for a guide, with its rule."""


def known_slider(pin, direction):
    """Motion of a slider at a known pin, and its coordinate along the guide."""
    return LinkMotion(pin, direction, None, None), Joint(*(dot(vector_or_zero(part), direction) for part in pin))


def slider_motion(position, reach, travel, line):
    """Motion of a slider from its coordinate along a level guide, else from its reach from a joint (kernel)."""
    level = line.direction is None
    pin = (
        (travel.position, number_or_zero(line.offset))
        if level
        else add_vectors(position, rotate(reach, line.direction))
    )
    first, second = (rotate((part, 0.0), line.direction) for part in (travel.first, travel.second))
    return LinkMotion(Joint(pin, first, second), rotate((1.0, 0.0), line.direction), None, None)
