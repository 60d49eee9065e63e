"""Balance shafts: unbalanced rotors geared to the crank (Lanchester), as loads on crank and frame.

A shaft at the ratio n turns by n phi + phase. U is the unbalance, u the unit vector from the axis to it, J the inertia
about the axis, and left(u) a quarter turn ahead of u. With gravity g, crank speed omega and acceleration alpha

    inertia force on the frame       F = U (n^2 omega^2 u - n alpha left(u))
    moment about its axis        tau = U u x g - J n alpha
    torque on the crank              n tau,    which adds J n^2 to the reduced inertia

Forces of the teeth between shaft and crank are not modelled because they need pitch radii. Their couple on the frame is
known, (1 - n) tau on the bearings of both.
Sources: F. W. Lanchester, *Engine balancing*, 1914; J. P. den Hartog, *Mechanical Vibrations*, 1956, chapter 5.
"""

from dataclasses import KW_ONLY, dataclass, field
from fractions import Fraction
from typing import Annotated, Any

import numpy as np

from ...numbers import checks
from ...numbers.planar import add_vectors, cross, dot, left, minus, plus, product, rotate, scale_vector
from ..crank import ray
from ..dimensions import of_fixed_point
from ..group import CRANK, POSITION
from ..links import Wrench, acceleration_of, present
from ..supports import Support
from .load import Load, Symbol
from .slider import spring_masses
from .table_pieces import TURN

MAX_DENOMINATOR = 24
"""Largest denominator of a ratio: the machine repeats after this number of turns of the crank."""
MAX_RATIO = 100.0
RATIO_TOLERANCE = 1e-12
"""Largest relative difference of a ratio from its fraction."""


def _fraction(ratio):
    """Fraction of small denominator nearest to a ratio."""
    return Fraction(ratio).limit_denominator(MAX_DENOMINATOR)


class RatioRule:
    """Rule of a ratio of gears: a fraction of small denominator, kept as its float."""

    def quick(self, value):
        return checks.UNDECIDED

    def check(self, value, field=""):
        try:
            plain = checks.to_plain(value, "1")
            found = Fraction(plain.item() if isinstance(plain, np.generic) else plain)
        except checks.DimensionError as fault:
            return value, f"{field} {fault}"
        except (TypeError, ValueError, OverflowError, ZeroDivisionError):
            found = None
        if found is None or isinstance(value, bool):
            return value, f'{field} must be a number, such as -1 or 0.5, or text "1/3", got {checks.shown(value)}'
        near, problem = _fraction(found), None
        if not 0 < abs(found) <= MAX_RATIO:
            problem = f"must not be 0, and at most {MAX_RATIO:g} in size"
        elif abs(near - found) > RATIO_TOLERANCE * abs(found):
            problem = f"must be a fraction near {near} with a denominator of at most {MAX_DENOMINATOR}, to repeat soon"
        return (value, f"{field} {problem}, got {checks.shown(value)}") if problem else (float(near), None)


@dataclass(frozen=True, eq=False)
class BalanceShaft(Load):
    """An unbalanced shaft geared to the crank: its inertia force and weight on the frame, its torque on the crank.

    It does not change the motion. Tooth forces are not modelled, because the pitch radii are unknown.

    Parameters
    ----------
    unbalance : float or array
        Mass times the distance of its centre from the axis, kg m.
    ratio : int, float, Fraction or text
        Turns of the shaft for one of the crank; negative turns against it. A fraction whose denominator is at most 24
        (``"1/3"``), which is the number of turns after which the machine repeats.
    phase : float or array
        Angle of the unbalance from +x at crank angle 0, rad.
    at : (x, y)
        Axis of the shaft, m.
    inertia : float or array
        About the axis, of the whole shaft with its unbalance, kg m2.
    mass : float or array
        Of the whole shaft with its unbalance, kg: its weight on the bearing. Without it the bearing carries the inertia
        force alone.
    plane : float or array
        Position along the crankshaft, m; it affects only the rocking moment.

    Raises
    ------
    ParameterError
        A value is not a finite number, or is negative without meaning. The ratio is 0, above 100, or another fraction.

    Examples
    --------
    A shaft that turns against a crank of the same unbalance: the remainder is a force along x.

    >>> import kinetostatics as ks
    >>> crank = ks.crank_slider(0.05, 0.2, crank=ks.Link(2.0, 0.05))  # 0.1 kg m
    >>> s = ks.Scene(crank, 100.0, loads=ks.BalanceShaft(0.1)).solve(4)
    >>> s.shaking_force.round(6) + 0.0  # N
    array([[ 2000.,     0., -2000.,     0.],
           [    0.,     0.,     0.,     0.]])
    """

    unbalance: Annotated[Any, checks.Number("kg*m", low=0.0)]
    ratio: Annotated[Any, RatioRule()] = field(default=-1.0, metadata={"structural": True})
    phase: Annotated[Any, checks.Number("rad")] = 0.0
    at: Annotated[Any, checks.Pair("m")] = (0.0, 0.0)
    inertia: Annotated[Any, checks.Number("kg*m**2", low=0.0)] = 0.0
    _: KW_ONLY
    mass: Annotated[Any, checks.Number("kg", low=0.0)] = 0.0
    plane: Annotated[Any, POSITION] = 0.0

    PATH, LENGTHS = "balance_shaft", ("phase",)
    RULES = checks.Rules("balance shaft")

    @property
    def period(self):
        """Crank angle after which the shaft has the same position again, rad."""
        return TURN * _fraction(self.ratio).denominator

    def dimensions(self, mechanism):
        """Coordinates of its axis."""
        return of_fixed_point("at", self.at)

    @property
    def crank_inertia(self):
        """Its inertia reduced to the crank, kg m2; None if it is zero."""
        return product(self.ratio * self.ratio, present(self.inertia))

    def wrenches(self, motion):
        """Torque of its weight on the crank."""
        torque = product(self.ratio, self._weight_moment(motion))
        if torque is not None:
            yield CRANK, Wrench(None, torque)

    def shaking(self, motion):
        """Inertia force on the frame at the axis, and couple, a `Support`."""
        square, alpha = motion.accelerating
        u, n = self._direction(motion), self.ratio
        turning = product(n, alpha)
        acceleration = acceleration_of(left(u), scale_vector(-n * n, u), square, turning)
        force = scale_vector(product(-1.0, present(self.unbalance)), acceleration)
        return Support(force, self.at, minus(None, product(present(self.inertia), turning)))

    def support(self, motion):
        """Inertia force and weight at the axis, and the couple of the gears."""
        force, at, own = self.shaking(motion)
        weight = scale_vector(present(self.mass), motion.gravity)
        couple = product(1.0 - self.ratio, plus(self._weight_moment(motion), own))
        return Support(add_vectors(force, weight), at, None if self.ratio == 1.0 else couple)

    def potential(self, motion):
        """Potential energy of its weight, J; that of its unbalance is 0 at the height of the axis."""
        if motion.gravity is None:
            return None
        raised = product(present(self.unbalance), minus(None, dot(motion.gravity, self._direction(motion))))
        return minus(raised, product(present(self.mass), dot(motion.gravity, self.at)))

    def signs(self, motion):
        """Symbol of a wheel with a weight at the axis."""
        yield Symbol("shaft", motion.position(self.at), direction=motion.as_vector(self._direction(motion)))

    def _direction(self, motion):
        """Unit vector from the axis to the unbalance."""
        turned = ray(self.ratio * motion.crank_angle)
        return turned if present(self.phase) is None else rotate(turned, ray(self.phase))

    def _weight_moment(self, motion):
        """Moment of the weight of the unbalance about the axis, N m."""
        if motion.gravity is None:
            return None
        return product(present(self.unbalance), cross(self._direction(motion), motion.gravity))


def balance_shafts(loads):
    """Loads whose own masses turn with the crank: see `Load`."""
    return [item for item in loads if hasattr(item, "shaking")]


def loads_with_mass(loads):
    """Springs with mass and balance shafts among loads, a list."""
    return [item for item in loads if spring_masses((item,)) or balance_shafts((item,))]
