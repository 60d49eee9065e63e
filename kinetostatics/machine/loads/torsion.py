"""Couples on links: torques, torsion springs and dampers, against the frame or another link."""

from dataclasses import dataclass, field
from typing import Any

from ...numbers import checks
from ...numbers.planar import minus
from ..group import FRAME
from ..links import Wrench
from .load import Load, Sign, valued


class Couple(Load):
    """A couple on the link `on` against another, or the frame."""

    on: str
    against: Any

    UNIT, SIGN = "N m", "couple"

    @property
    def title(self):
        return f"{type(self).__name__} on {self.on!r}"

    def problems(self, mechanism):
        """Say if there are no such links, or if both are one."""
        owner = type(self).__name__
        yield checks.choice(f"{owner}: on", self.on, tuple(mechanism.links))
        if self.against is not None:
            yield checks.choice(f"{owner}: against", self.against, (*mechanism.links, FRAME))
        if self.against == self.on:
            yield f"{self.title} is against the same link, so it loads nothing; give another link, or None for the frame"

    def wrenches(self, motion):
        """Opposite couples on both links."""
        couple = self.couple(motion)
        yield self.on, Wrench(None, couple)
        if self._other is not None:
            yield self._other, Wrench(None, minus(None, couple))

    def signs(self, motion):
        """A sign at the link's reference joint."""
        yield Sign(self.SIGN, motion.position(motion.mechanism.references[self.on]))

    @property
    def _other(self):
        """The other link, None for the frame."""
        return None if self.against == FRAME else self.against


@dataclass(frozen=True, eq=False)
class Torque(Couple):
    """Torque on a link, against the frame or another link.

    Parameters
    ----------
    value : float, array, Table or function
        N m, counter-clockwise on the link; an array has one value for each crank angle, a function takes the `Motion`
        and returns such values.
    on : str
        The link it acts on: "rocker", "coupler", "crank" ...
    against : str, optional
        The link that takes the opposite torque; the frame unless told.

    Raises
    ------
    ParameterError
        A value is no number or not finite; when a scene is made: there is no such link, or both are one.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=10.0, loads=ks.Torque(50.0, on="rocker"))
    >>> round(float(s.balancing_torque + 50.0 * s.rate("rocker") / 10.0), 9)
    0.0
    """

    value: Any
    on: str = field(kw_only=True)
    against: Any = field(default=None, kw_only=True)

    PATH, VALUE, OVER_ANGLES = "torque", "value", ("value",)
    RULES = checks.Rules("torque", value=valued("N*m"), on=checks.Name(), against=checks.Optional(checks.Name()))

    def couple(self, motion):
        """Couple on the link, N m."""
        return self.value
