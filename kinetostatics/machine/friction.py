"""Friction by joint: coefficients and sizes of the surfaces, by the name of the pair (`links.Turning` ...)."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np

from ..numbers import checks
from ..numbers.paths import Batched
from .links import Rolling, Sliding, Turning, present

COEFFICIENT = checks.Number(
    "1", low=0.0, usual=checks.PlausibleRange(2.0, "no surface has this much friction; is it a size, or in percent?")
)
SIZE = checks.Number("m", low=0.0, strict=True)
ROLLING_ARM = checks.Number("m", low=0.0, usual=checks.PlausibleRange(0.02, "is it in mm?", 1e-3))
PIN_RADIUS = replace(SIZE, usual=checks.PlausibleRange(1.0, "is it in mm?", 1e-3, in_links=True))
PASSES_BY_SOLVER = (3, 6, 12)
"""Numbers of iterations of friction, tried in this order; each iteration doubles the number of correct digits."""


@dataclass(frozen=True, eq=False)
class PinFriction(checks.Checked, Batched):
    """Friction in a pin: a moment of `mu` times `radius` times the reaction, against the relative rotation.

    Parameters
    ----------
    mu : float or array
    radius : float or array
        Radius of the pin, m.

    Raises
    ------
    ParameterError
        The coefficient is negative, or a size not greater than 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, slider=ks.Link(600))
    >>> s = ks.Scene(saw, 33.5, friction={"O": ks.PinFriction(mu=0.02, radius=0.05)}).solve(360)
    >>> round(s.losses.friction["O"])  # W, mean over the turn
    4373
    """

    mu: Annotated[Any, COEFFICIENT]
    radius: Annotated[Any, PIN_RADIUS]

    COEFFICIENTS = ("mu",)
    RULES = checks.Rules("pin friction")


@dataclass(frozen=True, eq=False)
class SlidingFriction(checks.Checked, Batched):
    """Friction of a sliding pair, against its velocity."""

    mu: Annotated[Any, COEFFICIENT]
    half_length: Annotated[Any, checks.Optional(SIZE)] = None

    COEFFICIENTS = ("mu",)


class GuideFriction(SlidingFriction):
    """Friction of a slider on its guide, against its velocity.

    Parameters
    ----------
    mu : float or array
    half_length : float or array, optional
        Half the length of the shoe, m. The edges of the shoe carry the couple too, and their friction counts once the
        load leaves the middle half. Without `half_length` only the force causes friction.

    Raises
    ------
    ParameterError
        The coefficient is negative, or a size not greater than 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, slider=ks.Link(600))
    >>> s = ks.solve(saw, 1.0, crank_speed=33.5, loads=[ks.Gravity()], friction={"guide": ks.GuideFriction(0.1)})
    >>> round(float(abs(s.guide_friction / s.guide_force)), 9), bool(s.guide_friction * s.slider_velocity < 0)
    (0.1, True)
    """

    RULES = checks.Rules("guide friction")


class SlotFriction(SlidingFriction):
    """Friction of a block or rod in the slot or cylinder of another link, as `GuideFriction` on a guide.

    Parameters
    ----------
    mu : float or array
    half_length : float or array, optional
        Half the length of the block or bush, m.

    Raises
    ------
    ParameterError
        The coefficient is negative, or a size not greater than 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> shaper = ks.slotted_lever(0.15, pivot=(0.0, -0.3), lever=ks.Link(40.0, 0.3, 2.0))
    >>> sorted(name for name, kind in shaper.friction_kinds.items() if kind is ks.SlotFriction)
    ['slot']
    >>> s = ks.Scene(shaper, 6.0, loads=[ks.Gravity()], friction={"slot": ks.SlotFriction(0.1)}).solve(360)
    >>> round(s.losses.friction["slot"], 2)  # W
    36.7
    """

    RULES = checks.Rules("slot friction")


@dataclass(frozen=True, eq=False)
class RollerFriction(checks.Checked, Batched):
    """Friction of a cam roller in its pin, and rolling friction; both together are a force along the cam profile.

    Parameters
    ----------
    mu : float or array
        Coefficient in the pin or its bearing.
    pin_radius, roller_radius : float or array
        m.
    rolling_arm : float or array, optional
        Arm of rolling friction, m: distance by which the cam's force acts ahead of the contact point.

    Raises
    ------
    ParameterError
        The coefficient or the arm is negative, a size not greater than 0, or mu times pin_radius plus the arm not less
        than roller_radius.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.CosineLaw(0.3, 2.0)
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600.0))
    >>> roller = ks.RollerFriction(mu=0.02, pin_radius=0.03, roller_radius=0.06)
    >>> s = ks.Scene(saw, 33.5, friction={"cam": roller}).solve(360)
    >>> round(s.losses.friction["cam"])  # W
    12237
    >>> rolling = ks.RollerFriction(mu=0.02, pin_radius=0.03, roller_radius=0.06, rolling_arm=0.5e-3)
    >>> s = ks.Scene(saw, 33.5, friction={"cam": rolling}).solve(360)
    >>> round(s.losses.friction["cam"])  # W
    20739
    """

    mu: Annotated[Any, COEFFICIENT]
    pin_radius: Annotated[Any, PIN_RADIUS]
    roller_radius: Annotated[Any, SIZE]
    rolling_arm: Annotated[Any, ROLLING_ARM] = 0.0

    COEFFICIENTS = ("mu", "rolling_arm")

    def _rolls(self):
        """Yield the problem of a roller that would slide."""
        if all(map(checks.has_known_values, (self.mu, self.pin_radius, self.roller_radius, self.rolling_arm))):
            arm = np.asarray(self.mu) * self.pin_radius + self.rolling_arm
            plus = " plus rolling_arm" if np.any(self.rolling_arm) else ""
            text = f"mu times pin_radius{plus}, {np.max(arm):.6g} m, must be less than roller_radius, "
            text += f"{np.min(self.roller_radius):.6g} m: the roller would not turn"
            if np.any(stuck := arm >= self.roller_radius):
                yield checks.Problem(text, stuck)

    RULES = checks.Rules("roller friction", _rolls)


KINDS = (PinFriction, GuideFriction, SlotFriction, RollerFriction)
MOTIONS = {Turning: "turns on a pin", Sliding: "slides", Rolling: "rolls on a pin of its own"}


def friction_kind(pair):
    """Class of friction for a pair."""
    if isinstance(pair, Sliding):
        return GuideFriction if pair.against == "frame" else SlotFriction
    return PinFriction if isinstance(pair, Turning) else RollerFriction


def _acts(friction):
    """Whether a coefficient of friction is not zero."""
    return any(present(getattr(friction, name)) is not None for name in friction.COEFFICIENTS)


@dataclass(frozen=True, eq=False)
class JointFriction(Batched):
    """Friction at one joint; `sense` is the sign of its motion, for a roller of the crank's, if known beforehand."""

    joint: str
    friction: Any
    sense: Any = None

    PATHS: ClassVar = {"friction": ""}
    RULES = checks.Rules(
        "friction", friction=checks.HasMembers(("mu",), "friction"), sense=checks.Optional(checks.Number("1"))
    )

    def __post_init__(self):
        """Check nothing: `friction_problems` checks the values together with the mechanism."""

    @property
    def PATH(self):  # noqa: N802 - as loads call it
        return f"friction.{self.joint}"


@dataclass(frozen=True, eq=False)
class Frictions(Mapping, Batched):
    """Friction by joint, a mapping; `passes` is the number of iterations of the directions of reactions."""

    by_joint: tuple[JointFriction, ...] = ()
    passes: int = PASSES_BY_SOLVER[0]

    __eq__, __hash__ = object.__eq__, object.__hash__
    PATHS: ClassVar = {"by_joint": ""}
    RULES = checks.Rules("friction", by_joint=checks.HasMembers((), "friction by joint"))

    def __post_init__(self):
        """Check nothing: `friction_problems` checks the values together with the mechanism."""

    def __getitem__(self, name):
        return {item.joint: item.friction for item in self.by_joint}[name]

    def __iter__(self):
        return (item.joint for item in self.by_joint)

    def __len__(self):
        return len(self.by_joint)

    def __repr__(self):
        return repr(dict(self))

    @property
    def acting(self):
        """Friction by joint, without zero coefficients."""
        return {item.joint: item.friction for item in self.by_joint if _acts(item.friction)}

    @property
    def senses(self):
        """Sign of the motion by joint, if it is known beforehand."""
        return {item.joint: item.sense for item in self.by_joint if item.sense is not None}


NO_FRICTION = Frictions()


def frictions_by_joint(given):
    """`Frictions` from a dict by joint."""
    if isinstance(given, Frictions):
        return given
    return Frictions(tuple(JointFriction(name, friction) for name, friction in given.items())) if given else NO_FRICTION


def friction_problems(mechanism, given):
    """Yield the problems of friction given for a mechanism, as sentences."""
    if not isinstance(given, Mapping):
        text = 'must be a dict of joint to friction, as {"O": ks.PinFriction(mu, radius)}'
        yield f"friction {text}, got {checks.shown(given)}"
        return
    pairs, kinds = mechanism.pairs, mechanism.friction_kinds
    for name, friction in given.items():
        if not isinstance(name, str) or name not in kinds:
            yield checks.choice("friction: joint", name, tuple(kinds))
        elif not isinstance(friction, wanted := kinds[name]):
            what = MOTIONS[type(pairs[name])]
            yield f"friction: {name!r} {what} and takes a {wanted.__name__}, got {checks.shown(friction)}"
        elif isinstance(pairs[name], Rolling):
            group = next(group for group in mechanism.groups if name in group.pairs)
            own = getattr(getattr(group, "roller", None), "radius", None)
            yield from _roller_problems(name, friction.roller_radius, getattr(group, "tightest", None), own)


def _roller_problems(name, given, tightest, own):
    """Yield problems of a roller's radius: too large for its path, or different from the roller of its group."""
    if not checks.has_known_values(given):
        return
    words = f"friction: roller_radius of {name!r}, {np.max(given):.6g} m, must be"
    if tightest is not None and checks.has_known_values(tightest) and np.any(np.asarray(given) >= tightest):
        yield (
            f"{words} less than the smallest radius of curvature of its path, {np.min(tightest):.6g} m: no cam has "
            "this profile; give a smaller roller or a larger cam"
        )
    if own is not None and checks.has_known_values(own) and np.any(other := np.asarray(given) != own):
        yield checks.Problem(f"{words} that of the roller of its group, {np.max(own):.6g} m", other)
