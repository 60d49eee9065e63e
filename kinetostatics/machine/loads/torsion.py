"""Couples on links against the frame or another link: torques, torsion springs and dampers.

Couples are positive counter-clockwise on the link `on`, N m; `against` takes the opposite couple.
"""

from dataclasses import KW_ONLY, dataclass
from typing import Annotated, Any
from weakref import WeakKeyDictionary

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan, sign
from ...numbers.planar import minus, number_or_zero, product, rotate_back
from ..crank import ray
from ..group import FRAME, Name
from ..links import Wrench, present
from ..supports import Support
from .load import Jumps, Load, Symbol, unknown_sense, value_rule
from .table_pieces import TURN, turning_points

ANGLE_SAMPLES = 720
"""Crank angles a turn at which the angle of a torsion spring is tested for half a turn."""
TERMS = {
    "_angle.cosine": ("c", "cosine of the angle from where the spring is free"),
    "_angle.sine": ("s", "sine of that angle"),
}
DRAG = checks.Number("N*m", "an opposing value", low=0.0)
"""Rule of the magnitude of an opposing torque."""
PROBE_ANGLES = np.linspace(0.1, 6.3, 720)
"""Crank angles of a turn, rad, at which the link of an opposing torque must turn somewhere."""
MIN_RATIO = 1e-9
"""Angular velocity of a link that turns, over the crank speed."""
TURNED = checks.PlausibleRange(20.0, "more than three turns; is it in degrees?", np.pi / 180.0)
"""Plausible angles of a torsion spring, rad."""


class Couple(Load):
    """A couple on the link `on` against another, or the frame."""

    on: Name
    against: Annotated[Any, checks.Optional(checks.Name())]

    UNIT, SIGN = "N m", "couple"

    def couple(self, motion) -> Any:
        """Couple on the link, N m."""
        raise NotImplementedError

    def misplaced(self, mechanism):
        """Sentences on unknown links, or if both are the same."""
        owner = type(self).__name__
        yield checks.choice(f"{owner}: on", self.on, tuple(mechanism.links))
        if self.against is not None:
            yield checks.choice(f"{owner}: against", self.against, (*mechanism.links, FRAME))
        if self.against == self.on:
            yield f"{self.title} is against the same link, so it loads nothing; name another, or None for the frame"

    def wrenches(self, motion):
        """Opposite couples on both links."""
        couple = self.couple(motion)
        yield self.on, Wrench(None, couple)
        if self._other is not None:
            yield self._other, Wrench(None, minus(None, couple))

    def rests_on_frame(self, mechanism):
        return self._other is None

    def support(self, motion):
        """The opposite couple on the frame, shown at the reference joint of the link."""
        return Support(None, motion.placement.links[self.on].joint.position, minus(None, self.couple(motion)))

    def signs(self, motion):
        """Symbol at the reference joint of the link."""
        yield Symbol(self.SIGN, motion.position(motion.mechanism.references[self.on]), sense=self.sense(motion))

    @property
    def _other(self):
        """The other link, None for the frame."""
        return None if self.against == FRAME else self.against

    def _ratio(self, placement):
        """Angular velocity of the link relative to the other over the crank speed; None where it is 0."""
        links = placement.links
        return minus(links[self.on].ratio, None if self._other is None else links[self._other].ratio)


@dataclass(frozen=True, eq=False)
class Torque(Couple):
    """Torque on a link, against the frame or another link.

    Parameters
    ----------
    value : float, array, Table or function
        N m, counter-clockwise on the link; an array has one value for each crank angle, a function takes the `Motion`
        and returns values of this shape.
    opposing : bool
        Coulomb drag, as of a brake, a seal or a chain: the torque has the constant magnitude `value`, not negative,
        against the angular velocity of `on` relative to `against`. It jumps where that velocity changes its sign. At
        rest it opposes the motion about to begin (`sense`, or the crank acceleration). A machine at rest sticks if the
        other loads cannot move it (`ks.drive.coast`, `ks.drive.start`).
    on : str
        Link on which it acts: "rocker", "coupler", "crank" ...
    against : str, optional
        Link that takes the opposite torque; by default the frame.

    Raises
    ------
    ParameterError
        A value is not a finite number, or an opposing torque is no number or negative. When a scene is made: a link is
        unknown, both are the same, or an opposing torque acts on links without relative rotation. When it is solved: an
        opposing torque acts at rest, in an unknown sense.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=10.0, loads=ks.Torque(50.0, on="rocker"))
    >>> abs(round(float(s.balancing_torque + 50.0 * s.rate("rocker") / 10.0), 9))
    0.0
    >>> dragged = ks.solve(bar, [0.7, 3.7], crank_speed=10.0, loads=ks.Torque(50.0, on="rocker", opposing=True))
    >>> [round(float(power), 9) for power in dragged.balancing_torque * 10.0 - 50.0 * abs(dragged.rate("rocker"))]
    [0.0, 0.0]
    """

    value: Annotated[Any, value_rule("N*m")]
    _: KW_ONLY
    on: str
    against: Any = None
    opposing: Annotated[bool, checks.Truth()] = False

    PATH, VALUE, OVER_ANGLES = "torque", "value", ("value",)
    REFUSES = DISSIPATES = property(lambda self: self.opposing, doc="Whether it opposes the motion.")
    RULES = checks.Rules("torque")

    def __post_init__(self):
        super().__post_init__()
        if self.opposing:
            _, problem = DRAG.check(self.value)
            checks.require("torque", problem)

    def couple(self, motion):
        """Couple on the link, N m."""
        if not self.opposing:
            return self.value
        return minus(None, self.value * sign(number_or_zero(self._ratio(motion.placement))) * motion.crank_sense)

    def misplaced(self, mechanism):
        """Sentences as for all couples, or if an opposing torque acts on links without relative rotation."""
        problems = [*filter(None, super().misplaced(mechanism))]
        yield from problems
        if self.opposing and not problems and self._ratios(mechanism, PROBE_ANGLES[:1]).dtype == float:  # not recorded
            with np.errstate(invalid="ignore"):
                still = np.abs(self._ratios(mechanism, PROBE_ANGLES * mechanism.turns)) < MIN_RATIO
            if still.all(axis=-1).any():
                yield f"{self.title}: the link does not turn against {self.against or FRAME!r}, so there is no drag"

    def _ratios(self, mechanism, angle):
        return np.asarray(number_or_zero(self._ratio(mechanism.place(angle))))

    def refusals(self, motion):
        """Sentence on rest in an unknown sense."""
        return unknown_sense(self, motion)

    @property
    def jumps(self):
        """Where the relative angular velocity of an opposing torque changes its sense."""
        return Jumps(self._reversals) if self.opposing else None

    def _reversals(self, motion):
        mechanism = motion.mechanism
        with np.errstate(invalid="ignore", divide="ignore"):
            return turning_points(lambda at: number_or_zero(self._ratio(mechanism.place(at))), mechanism.turns).angle


@dataclass(frozen=True, eq=False)
class TorsionSpring(Couple):
    """Linear torsion spring between a link and the frame, or another link.

    Its couple on the link is `moment` less `stiffness` times the angle of the link from `free_angle`, counter-clockwise
    and in (-pi, pi]. The angle would jump for a link that passes half a turn from there.

    Parameters
    ----------
    stiffness : float or array
        N m/rad.
    free_angle : float or array
        Angle at which the spring is free, rad: of the axis of the link from +x, or from the axis of the link `against`.
    on, against : str
        As for `Torque`.
    moment : float or array
        Additional constant couple, N m, as from a long preloaded spring.

    Raises
    ------
    ParameterError
        As for `Torque`; when a scene is solved: the link makes full turns, as the crank does, or passes half a turn
        from `free_angle`; the message names the crank angles.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=1.0, loads=ks.TorsionSpring(40.0, 1.5, on="rocker"))
    >>> bool(s.power_residual < 1e-13)
    True
    """

    stiffness: Annotated[Any, checks.Number("N*m/rad", low=0.0)]
    free_angle: Annotated[Any, checks.Number("rad", usual=TURNED)] = 0.0
    _: KW_ONLY
    on: str
    against: Any = None
    moment: Annotated[Any, checks.Number("N*m")] = 0.0

    PATH, LENGTHS, REFUSES, SIGN = "torsion_spring", ("free_angle",), True, "spiral"
    RULES = checks.Rules("torsion spring")

    def couple(self, motion):
        """Couple on the link, N m."""
        return minus(present(self.moment), self.stiffness * self._angle(motion))

    def potential(self, motion):
        """Strain energy, J; zero where the spring is free."""
        angle = self._angle(motion)
        return minus(0.5 * self.stiffness * angle * angle, product(present(self.moment), angle))

    def _angle(self, motion):
        """Angle of the link from the free angle, rad; accurate near half a turn too."""
        cosine, sine = self._link_direction(motion.placement)
        ahead = 1.0 + cosine
        return 2.0 * atan(2.0 * sine / (ahead * ahead + sine * sine))

    def _link_direction(self, placement):
        """Unit vector of the link in axes at the free angle."""
        axis = placement.links[self.on].direction
        axis = axis if self._other is None else rotate_back(axis, placement.links[self._other].direction)
        return axis if present(self.free_angle) is None else rotate_back(axis, ray(self.free_angle))

    def refusals(self, motion):
        """Sentence on the crank angles at which the link passes half a turn from the free angle."""
        if not checks.has_known_values(self.free_angle):
            return ()
        known = _REFUSALS.setdefault(motion.mechanism, {})
        key = (self.on, self.against, np.asarray(self.free_angle).tobytes())
        if key not in known:
            known[key] = tuple(self._half_turn_problems(motion.mechanism))
        return known[key]

    def _half_turn_problems(self, mechanism):
        grid = np.linspace(0.0, TURN * mechanism.turns, ANGLE_SAMPLES * mechanism.turns + 1)
        parts = self._link_direction(mechanism.place(grid))
        if not all(isinstance(part, float | np.ndarray) and checks.has_known_values(part) for part in parts):
            return
        angle = np.arctan2(*np.broadcast_arrays(*parts, grid)[1::-1])
        step = np.diff(angle, axis=-1)
        with np.errstate(invalid="ignore"):
            passing = np.abs(step) > np.pi
            turns = np.round(np.sum(step - TURN * np.round(step / TURN), axis=-1) / TURN)  # NaN where it cannot close
        turning = np.abs(turns) > 0
        passing[..., -1] |= turning & ~passing.any(axis=-1)  # at the very end of the period
        if not passing.any():
            return
        advice = "it makes full turns"
        if not turning.any():
            design = np.argmax(passing.any(axis=-1).ravel())
            free_angle = np.broadcast_to(self.free_angle, (*angle.shape[:-1], 1)).ravel()[design]
            advice = _free_angle_advice(angle.reshape(-1, angle.shape[-1])[design], free_angle)
        places = np.unique(np.nonzero(passing)[-1])
        many = ", ".join(f"{np.degrees(grid[place] + grid[place + 1]) / 2:.4g}" for place in places[:4])
        yield checks.Problem(
            f"{self.title}: the link passes half a turn from the free angle at crank angle "
            f"{many}{' ...' if places.size > 4 else ''} deg, where the couple would jump; {advice}",
            passing,
        )


def _free_angle_advice(angle, free_angle):
    """Advice on a free angle from which a design stays within half a turn; `angle` is its angle from the given one."""
    shifts = np.radians(np.arange(-180.0, 180.0, 5.0))
    moved = angle - shifts[:, None]
    moved -= TURN * np.round(moved / TURN)
    clear = ~(np.abs(np.diff(moved)) > np.pi).any(axis=-1)
    if not clear.any():
        return "its angles, on all arcs where the mechanism closes, leave no free angle without this jump"
    free = free_angle + shifts[np.argmin(np.where(clear, np.nanmax(np.abs(moved), axis=-1), np.inf))]
    return f"give a free angle nearer to it, such as {free - TURN * np.round(free / TURN):.3g} rad"


_REFUSALS: WeakKeyDictionary[Any, dict] = WeakKeyDictionary()
"""By mechanism: refusals of torsion springs, by link and free angle."""


@dataclass(frozen=True, eq=False)
class TorsionDamper(Couple):
    """Viscous torsional damper: a couple against the angular velocity of a link relative to the frame or another link.

    Parameters
    ----------
    coefficient : float or array
        N m s.
    on, against : str
        As for `Torque`; links may make full turns.

    Raises
    ------
    ParameterError
        As for `Torque`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    >>> s = ks.solve(bar, 0.7, crank_speed=10.0, loads=ks.TorsionDamper(0.5, on="crank"))
    >>> round(float(s.balancing_torque), 9)
    5.0
    """

    coefficient: Annotated[Any, checks.Number("N*m*s", low=0.0)]
    _: KW_ONLY
    on: str
    against: Any = None

    PATH, SIGN, DISSIPATES = "torsion_damper", "ring", True
    RULES = checks.Rules("torsion damper")

    def couple(self, motion):
        """Couple on the link, N m."""
        ratio = self._ratio(motion.placement)
        return number_or_zero(product(product(present(self.coefficient), -motion.crank_speed), ratio))
