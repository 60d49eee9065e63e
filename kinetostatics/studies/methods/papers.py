"""Methods under study: the papers' own ways to a result, kept to be measured against the library's.

Nothing in the library calls them; where they fail is counted by the tests. `printed` holds the formulas as the studies
print them, groups put these in place of the library's, for every guide, pivot and assembly. One printed sign
is wrong, that of the sawframe study's slot force: `by_the_papers` has it mended, `as_printed` keeps it.
"""

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from ...engines.engines import KERNELS
from ...machine.cams.cam_roller import CamRoller
from ...machine.cams.cams import Circle, CosineLaw
from ...machine.group import Resolved
from ...machine.groups.rocker import RockerGroup, RockerMotion
from ...machine.groups.slider import SliderGroup, SliderMotion
from ...machine.links import Joint, LinkMotion, Wrench
from ...machine.loads import ProcessForce, Spring
from ...mechanics.quantities import components
from ...numbers.planar import added, cross, dot, left, minus, stretched, subtracted, vector
from .method import Method, NotGivenError, on_a_side, require_frictionless, require_one_design
from .printed import (
    CircleAsPrinted,
    CosineLawAsPrinted,
    chain_unit_by_atan_acos,
    four_bar_by_atan_acos,
    slider_by_double_cross,
    turned_to_length,
)

__all__ = [
    "AS_PRINTED",
    "METHODS",
    "as_printed",
    "by_the_papers",
    "chain_unit_by_atan_acos",
    "exactly_cancelled",
    "four_bar_by_atan_acos",
    "slider_by_double_cross",
    "turned_to_length",
]

EQUILIBRIUM, PRINTED = 1.0, -1.0
"""Sign of R40 sin(nu) in the slot force: that of the block's equilibrium, and that of the sawframe study."""


@dataclass(frozen=True, eq=False)
class RollerByAngles(CamRoller):
    """Cam roller by the sawframe study: cam and slot force from size and direction of the load R42 on the block.

    R40 = -R42 cos(phi - alpha42) / cos(nu) acts along the cam's outward normal, at phi - nu, and
    R41 = R42 sin(phi - alpha42) + R40 sin(nu) across the ray, at phi + 90 deg. The study prints R41 with a minus, with
    which the three forces on the block do not sum to zero.

    Parameters
    ----------
    sign : float
        Of R40 sin(nu): `EQUILIBRIUM` or `PRINTED`.
    """

    sign: float = EQUILIBRIUM

    TRUSTED = True

    def resolve(self, placement, loads, along) -> Resolved:
        radius, slope, _ = placement.details["cam"]
        x, y = vector(loads["block"].force)
        R42, behind, nu = np.hypot(x, y), placement.angle - np.arctan2(y, x), np.arctan(slope / radius)
        R40 = -R42 * np.cos(behind) / np.cos(nu)
        R41 = R42 * np.sin(behind) + self.sign * R40 * np.sin(nu)
        torque = minus(R41 * radius, loads["block"].moment)
        on_crank = Wrench(stretched(R41, left(placement.ray)), torque)
        return Resolved({}, {"cam_force": -R40, "slot_force": R41}, {"crank": on_crank})


class SliderByVectors(SliderGroup):
    """Slider by the mower study: `slider_by_double_cross`, then the loop equation, differentiated, with its vectors."""

    TRUSTED = True

    def found(self, A):
        u, offset, length = self.guide.direction, self.guide.guide_offset, self.coupler_length
        foot = stretched(offset, left(u))
        W1, W2 = subtracted(foot, stretched(length, u)), added(foot, stretched(length, u))
        return slider_by_double_cross(np.array(A), length, W1, W2, W2 if self.assembly > 0 else W1)

    def place(self, placement):
        A, u, length = placement.joints[self.on], self.guide.direction, self.coupler_length
        B = tuple(self.found(A.position))
        AB = subtracted(B, A.position)
        n, along = left(u), dot(u, AB)
        ratio, speed = -dot(n, A.first) / along, dot(AB, A.first) / along
        ratio_slope = (ratio * ratio * dot(n, AB) - dot(n, A.second)) / along
        gain = (dot(AB, A.second) - ratio * ratio * dot(AB, AB)) / along
        pin = Joint(B, stretched(speed, u), stretched(gain, u))
        q = stretched(1 / length, AB)
        coupler, slider = LinkMotion(A, q, ratio, ratio_slope), LinkMotion(pin, u, None, None)
        sine, cosine, travel = dot(n, q), dot(u, q), Joint(dot(u, B), speed, gain)
        self._set(placement, SliderMotion(coupler, slider, sine, cosine, cosine, cosine * cosine, travel))


class SliderByAsin(SliderByVectors):
    """Slider by the sawframe study: the coupler's angle from the guide by asin."""

    TRUSTED = True

    def found(self, A):
        u, n = self.guide.direction, left(self.guide.direction)
        angle = np.arcsin((self.guide.guide_offset - dot(n, A)) / self.coupler_length)
        along, across = self.assembly * np.cos(angle), np.sin(angle)
        return added(A, stretched(self.coupler_length, added(stretched(along, u), stretched(across, n))))


@dataclass(frozen=True, eq=False)
class RockerByAtanAcos(RockerGroup):
    """Rocker by the chain unit study, `four_bar_by_atan_acos`."""

    crank_length: Any = None

    TRUSTED = True

    def place(self, placement):
        lengths = self.crank_length, self.coupler_length, self.rocker_length
        (theta, ratio, ratio_slope), (psi, swing, swing_slope) = four_bar_by_atan_acos(
            *lengths, self.pivot, self.assembly, placement.angle
        )
        q, p = ((np.cos(angle), np.sin(angle)) for angle in (theta, psi))
        arm, pivot = stretched(self.rocker_length, p), Joint(tuple(self.pivot), None, None)
        second = subtracted(stretched(swing_slope, left(arm)), stretched(swing * swing, arm))
        pin = Joint(added(self.pivot, arm), stretched(swing, left(arm)), second)
        coupler = LinkMotion(placement.joints[self.on], q, ratio, ratio_slope)
        rocker, sine = LinkMotion(pivot, p, swing, swing_slope), cross(q, p)
        self._set(placement, RockerMotion(coupler, rocker, pin, sine, dot(q, p), sine, sine * sine))


def _as(kind, original, **more):
    """A group or cam with the same data but formulas of another kind."""
    return kind(*(getattr(original, field.name) for field in fields(original) if field.init), **more)


def _groups(mechanism, sign):
    """Groups of a mechanism as its study calculates them."""
    groups = on_a_side(mechanism).groups
    kinds = [type(group) for group in groups]
    if kinds == [SliderGroup]:
        return (_as(SliderByVectors, groups[0]),)
    if kinds == [RockerGroup]:
        return (_as(RockerByAtanAcos, groups[0], crank_length=mechanism.crank.length),)
    cams = {Circle: CircleAsPrinted, CosineLaw: CosineLawAsPrinted}
    if kinds == [CamRoller, SliderGroup] and type(cam := groups[0].cam) in cams:
        return RollerByAngles(_as(cams[type(cam)], cam), groups[0].block, groups[0].roller, sign), _as(
            SliderByAsin, groups[1]
        )
    raise NotGivenError(f"no study has formulas for the groups, or this cam, of {mechanism.name}")


def by_the_papers(solution, sign=EQUILIBRIUM):
    """The solution by the formulas of the study of such a mechanism, its wrong sign mended unless told.

    Parameters
    ----------
    solution : Solution
        Of a mechanism built as one of the cases.
    sign : float
        Of R40 sin(nu) in the slot force of a cam roller: `EQUILIBRIUM` or `PRINTED`.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        No study has formulas for it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> plain, circle = (saw.solve(name, 8) for name in ("plain", "cam-circle"))
    >>> theirs = ks.papers.by_the_papers(plain)
    >>> bool(abs(theirs.balancing_torque - plain.balancing_torque).max() < 1e-9)  # N m
    True
    """
    mechanism = replace(solution.mechanism, groups=_groups(solution.mechanism, sign))
    return replace(solution, mechanism=mechanism, engine=KERNELS)


def exactly_cancelled(solution):
    """The solution with a force that cancels the slider's inertia exactly, at every position, in place of the springs.

    So the sawframe study calculates, as if the circular cam gave the cosine law of motion that springs need for it.

    Parameters
    ----------
    solution : Solution
        With springs.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        It has no spring.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> plain, circle = (saw.solve(name, 8) for name in ("plain", "cam-circle"))
    >>> cancelled = ks.papers.exactly_cancelled(circle)
    >>> for solution in circle, cancelled:  # along the guide nothing is left for the slider's pin
    ...     print(f"{abs(solution.reaction('B')[0]).max():.0f} N")
    3941 N
    0 N
    """
    others = tuple(load for load in solution.loads if not isinstance(load, Spring))
    if len(others) == len(solution.loads):
        raise NotGivenError(f"{solution.mechanism.name} has no spring that could cancel the slider's inertia")
    mass = solution.mechanism.links["slider"].mass
    return replace(solution, loads=(*others, ProcessForce(lambda motion: mass * motion.slider_acceleration)))


def as_printed(solution):
    """The solution by the sawframe study's equations to the letter: exact cancellation, and its sign in the slot force.

    Not right mechanics: it gives the study's dynamic coefficients, and fails the balance of powers.

    Parameters
    ----------
    solution : Solution
        Of the saw with its circular cam and springs.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        The solution is of another machine.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> plain, circle = (saw.solve(name, 8) for name in ("plain", "cam-circle"))
    >>> bool(ks.papers.as_printed(circle).power_residual > 0.01 > 1e-12 > circle.power_residual)
    True
    """
    mechanism = solution.mechanism
    cams = [type(group.cam).__name__ for group in mechanism.groups if isinstance(group, CamRoller)]
    if cams != [Circle.__name__]:
        has = f"the cam {cams[0]}" if cams else "none"
        raise NotGivenError(f"the sawframe study's equations are for a circular cam; {mechanism.name} has {has}")
    return by_the_papers(exactly_cancelled(solution), PRINTED)


def _prepared(formulas):
    """Method that computes a solution by other formulas."""

    def prepare(solution, quantity, setting=None):
        require_one_design(solution)
        require_frictionless(solution)
        formulated = formulas(solution)

        def run():
            with np.errstate(divide="ignore", invalid="ignore"):
                return components(replace(formulated), quantity)

        return run

    return prepare


METHODS = (Method("papers' formulas", _prepared(by_the_papers)),)
AS_PRINTED = Method("sawframe study as printed, wrong sign", _prepared(as_printed))
"""Apart from the others, which are right but for rounding: its error, a fifth, is that of one sign."""


def __dir__():
    return __all__
