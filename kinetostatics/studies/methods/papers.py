"""Formulas and cams as published studies print them, to compare with the methods of the library.

`by_the_papers` replaces the groups of a solution by groups with these formulas, for any guide, pivot and assembly mode.
The sawframe study prints a wrong sign in the slot force: `by_the_papers` corrects it, `as_printed` keeps it.
"""

from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np

from ...engines.engines import KERNELS
from ...errors import NotGivenError
from ...machine.cams.cam_roller import CamRoller
from ...machine.cams.cams import Circle, CosineLaw
from ...machine.group import Resolved
from ...machine.groups.rocker import RockerGroup, RockerMotion
from ...machine.groups.slider import SliderGroup, SliderMotion
from ...machine.links import Joint, LinkMotion, Wrench
from ...machine.loads import ProcessForce, Spring
from ...mechanics.quantities import components
from ...numbers.planar import add_vectors, cross, dot, left, minus, scale_vector, subtract_vectors, vector_or_zero
from .method import Method, require_frictionless, require_one_design, with_numeric_side


def turned_to_length(vector, angle, length):
    """TurnV: a vector turned by an angle and given a length (Kotov 2024, equation 1).

    Parameters
    ----------
    vector : array (2, N)
    angle : float or array
        Counter-clockwise, rad.
    length : float
        m.

    Returns
    -------
    array (2, N)

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> ks.papers.turned_to_length(np.array([3.0, 4.0]), np.pi / 2, 10.0).round(12)
    array([-8.,  6.])
    """
    quarter = np.pi / 2
    x, y = vector
    scale = length / np.hypot(x, y)
    turned_x = (np.cos(angle) * x + np.cos(quarter + angle) * y) * scale
    return np.array([turned_x, (np.cos(quarter - angle) * x + np.cos(angle) * y) * scale])


def slider_by_double_cross(A, coupler_length, W1, W2, W):
    """Position of the slider pin by double cross product, acos and the sign of a mixed product (Kotov 2024, figure 3).

    Steps: perpendicular AC from A to the guide W1-W2, angle CAB by acos, its side by the sign of a mixed product, a
    special case for A on the guide. Near it, for an inclined guide, rounding may make sign and special case disagree.

    Parameters
    ----------
    A : array (2, N)
        Crank pin, m.
    coupler_length : float
        m.
    W1, W2 : (x, y)
        Points of the guide, m.
    W : (x, y)
        W1 or W2, whichever is on the side of the slider as seen from A.

    Returns
    -------
    array (2, N)
        Slider pin B, m; NaN where the coupler does not reach the guide.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> ends = (0.0, -0.02), (0.3, -0.02)
    >>> s = ks.solve(ks.crank_slider(0.038, 0.3, guide=ks.Guide.through(*ends)), [0.5, 1.0], crank_speed=1.0)
    >>> pin = ks.papers.slider_by_double_cross(s.position("A"), 0.3, *ends, ends[1])
    >>> bool(np.allclose(pin, s.position("B")))
    True
    """
    guide = np.subtract(W2, W1)[:, None]
    unit = guide / np.hypot(*guide)
    to_W1 = np.asarray(W1)[:, None] - A
    normal = unit[0] * to_W1[1] - unit[1] * to_W1[0]
    AC = np.array([-normal * unit[1], normal * unit[0]])
    distance = np.hypot(*AC)
    side = np.sign(to_W1[0] * guide[1] - to_W1[1] * guide[0])
    toward = 1.0 if tuple(W) == tuple(W2) else -1.0
    with np.errstate(invalid="ignore", divide="ignore"):
        turned = turned_to_length(AC, toward * side * np.arccos(distance / coupler_length), coupler_length)
    return A + np.where(distance == 0, toward * coupler_length * unit, turned)


def chain_unit_by_atan_acos(crank_length, coupler_length, rocker_length, pivot_x, angle):
    """Coupler and rocker angle of the chain unit by atan and acos, and their rates by the two-component formulas.

    As in the Belarusian study of the chain unit: phi = angle - phi_0 is clockwise from the frame line O-O2, and B is to
    the left of A -> O2. The coupler angle is correct while x of A is less than x of O2, the rocker angle while b - r
    cos(phi) > 0. Elsewhere atan is wrong by half a turn.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length, pivot_x : float
        m; O2 = (pivot_x, -rocker_length).
    angle : array (N,)
        Crank angle clockwise from +y, rad.

    Returns
    -------
    gamma, psi, coupler_rate, rocker_rate : arrays (N,)
        Coupler angle below +x and rocker angle clockwise from vertical, rad; rates at crank speed 1, clockwise.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> gamma, psi, *_ = ks.papers.chain_unit_by_atan_acos(0.1, 1.0, 0.5, 0.994987, np.array([0.0, 0.5]))
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), ks.linkage.chain_unit_angle([0.0, 0.5]), crank_speed=1.0)
    >>> bool(np.allclose(psi - psi[0], ks.linkage.rocker_angle(s), atol=1e-6))
    True
    """
    r, c, h = crank_length, coupler_length, rocker_length
    b = np.hypot(pivot_x, h)
    phi = angle - (np.pi / 2 + np.arctan(h / pivot_x))
    square = r * r + b * b - 2 * r * b * np.cos(phi)
    a = np.sqrt(square)
    to_pivot = np.arctan((r * np.cos(angle) + h) / (pivot_x - r * np.sin(angle)))
    gamma = to_pivot - np.arccos((square + c * c - h * h) / (2 * a * c))
    f5 = r * np.sin(phi) / (b - r * np.cos(phi))
    psi = -np.arctan(f5) + np.arccos((square + h * h - c * c) / (2 * a * h)) - np.arctan(pivot_x / h)

    turning = -(b * np.cos(phi) - r) / square
    p, q = square + c * c - h * h, square + h * h - c * c
    closing = b * np.sin(phi) / square
    coupler_rate = r * (turning + closing * (2 * square - p) / np.sqrt(4 * square * c * c - p * p))
    rocker_rate = r * (turning + closing * (q - 2 * square) / np.sqrt(4 * square * h * h - q * q))
    return gamma, psi, coupler_rate, rocker_rate


def chain_unit_accelerations(crank_length, coupler_length, rocker_length, pivot_x, angle):
    """Angular accelerations of coupler and rocker of the chain unit by the study's equations (11)-(14), (19)-(22).

    Each is a sum of two derivatives. Those are of p / k and (u / v)(s / w) for the coupler, of (b cos(phi) - r) / a^2
    and (u1 / v1)(s1 / w1) for the rocker. Our copy of the study has lost its plus and minus signs; they follow from its
    derivation. For the study's dimensionless forms give the lengths rho, 1, lambda and sqrt(1 - rho^2).

    Parameters
    ----------
    crank_length, coupler_length, rocker_length, pivot_x, angle
        As for `chain_unit_by_atan_acos`.

    Returns
    -------
    coupler, rocker : arrays (N,)
        Clockwise, rad/s2 at a crank speed of 1 rad/s; in proportion to the square of a constant crank speed.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> _, rocker = ks.papers.chain_unit_accelerations(0.1, 1.0, 0.5, np.sqrt(0.99), np.array([0.0, 0.5]))
    >>> s = ks.solve(ks.linkage.chain_unit(0.1, 1.0, 0.5), ks.linkage.chain_unit_angle([0.0, 0.5]), crank_speed=-1.0)
    >>> bool(np.allclose(rocker, -s.angular_acceleration("rocker")))
    True
    """
    r, h, b = crank_length, rocker_length, np.hypot(pivot_x, rocker_length)
    phi = angle - (np.pi / 2 + np.arctan(h / pivot_x))
    square = r * r + b * b - 2 * r * b * np.cos(phi)
    growth = 2 * r * b * np.sin(phi)
    p = -(pivot_x * np.sin(angle) - h * np.cos(angle) - r)
    p_slope = -(pivot_x * np.cos(angle) + h * np.sin(angle))
    coupler_turning = r * (square * p_slope - p * growth) / square**2
    rocker_turning = b * r * np.sin(phi) * (square + 2 * r * (b * np.cos(phi) - r)) / square**2

    def opening(near, far):
        """Equations (13) and (21): u = sin(phi), v = a^2, s = q^2 - 2 a^2, w = sqrt(4 a^2 near^2 - q^4)."""
        q2 = square + near * near - far * far
        u, v, s, w = np.sin(phi), square, q2 - 2 * square, np.sqrt(4 * square * near * near - q2 * q2)
        u1, v1, s1, w1 = np.cos(phi), growth, -growth, growth * (2 * near * near - q2) / w
        return b * r * (u * (w * s1 - w1 * s) / (v * w * w) + s * (v * u1 - u * v1) / (w * v * v))

    return coupler_turning - opening(coupler_length, h), rocker_turning + opening(h, coupler_length)


def four_bar_by_atan_acos(crank_length, coupler_length, rocker_length, pivot, assembly, angle):
    """Coupler and rocker of any four-bar by the formulas of `chain_unit_by_atan_acos`, and their accelerations.

    Angles count from the frame line O-O2, so that f2 and f5 of the study are equal. The angular accelerations are
    derivatives of its formulas for the rates. The formulas hold while b - r cos(phi) > 0.

    Parameters
    ----------
    crank_length, coupler_length, rocker_length : float
        m.
    pivot : (x, y)
        O2, m.
    assembly : +1 or -1
        +1, as in the study: B to the left of A-O2.
    angle : array (N,)
        Crank angle, rad.

    Returns
    -------
    coupler, rocker : tuple of arrays (N,)
        Direction (rad, counter-clockwise from +x), angular velocity ratio to the crank and its slope.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> coupler, rocker = ks.papers.four_bar_by_atan_acos(0.1, 1.0, 0.5, (1.0, -0.5), 1, np.array([0.5]))
    >>> s = ks.solve(ks.four_bar(0.1, 1.0, 0.5, rocker_pivot=(1.0, -0.5)), [0.5], crank_speed=1.0)
    >>> bool(np.allclose(rocker[1], s.rate("rocker")))
    True
    """
    r, b = crank_length, np.hypot(*pivot)
    frame = np.arctan2(pivot[1], pivot[0])
    phi = frame - angle
    s, c = b * np.sin(phi), b * np.cos(phi)
    square = r * r + b * b - 2 * r * c
    growth = 2 * r * s
    to_pivot = frame + np.arctan(r * np.sin(phi) / (b - r * np.cos(phi)))
    turning, closing = -(c - r) / square, s / square
    turning_slope, closing_slope = (s - turning * growth) / square, (c - closing * growth) / square

    def link(start, near, far, sense):
        p = square + near * near - far * far
        root = np.sqrt(4 * square * near * near - p * p)
        opening = (2 * square - p) / root
        opening_slope = growth * (1 - opening * (2 * near * near - p) / root) / root
        return (
            start + sense * np.arccos(p / (2 * np.sqrt(square) * near)),
            r * (turning + sense * closing * opening),
            -r * (turning_slope + sense * (closing_slope * opening + closing * opening_slope)),
        )

    return (
        link(to_pivot, coupler_length, rocker_length, assembly),
        link(to_pivot + np.pi, rocker_length, coupler_length, -assembly),
    )


class CircleAsPrinted(Circle):
    """Circle by the sawframe study's r = -a cos(phi) + sqrt(R^2 - a^2 sin^2(phi)), with its centre at phi = 180 deg."""

    def polar(self, angle, ray):
        x, y = self.centre
        R, a, phi = self.pitch_radius, np.hypot(x, y), angle - np.arctan2(-y, -x)
        s, c = a * np.sin(phi), a * np.cos(phi)
        square = R * R - s * s
        root = np.sqrt(square)
        return root - c, s - s * c / root, c - (R * R * (c * c - s * s) + s * s * s * s) / (square * root)


class CosineLawAsPrinted(CosineLaw):
    """Cosine law by the sawframe study's r = x_B cos(phi) - w, w = +-sqrt(l^2 - x_B^2 sin^2(phi)).

    w has the sign of cos(phi) - cos(phi*). At the singular angle phi* the radicand has a double zero. Near it w loses
    up to half its digits, and the derivatives divide by w.
    """

    def polar(self, angle, ray):
        a, b, phi = self.amplitude, self.mean, angle - self.guide_angle
        singular = (np.sqrt(b * b + 8 * a * a) - b) / (4 * a)
        length = (b + a * singular) * np.sqrt(1 - singular * singular)
        s, c = np.sin(phi), np.cos(phi)
        x, x1, x2 = b + a * c, -a * s, -a * c
        z, z1, z2 = x * s, x1 * s + x * c, x2 * s + 2 * x1 * c - x * s
        w = np.sign(c - singular) * np.sqrt(length * length - z * z)
        w1 = -z * z1 / w
        w2 = -(z1 * z1 + z * z2 + w1 * w1) / w
        return x * c - w, x1 * c - x * s - w1, x2 * c - 2 * x1 * s - x * c - w2


__all__ = [
    "AS_PRINTED",
    "METHODS",
    "as_printed",
    "by_the_papers",
    "chain_unit_accelerations",
    "chain_unit_by_atan_acos",
    "exactly_cancelled",
    "four_bar_by_atan_acos",
    "slider_by_double_cross",
    "turned_to_length",
]

EQUILIBRIUM, PRINTED = 1.0, -1.0
"""Sign of R40 sin(nu) in the slot force, as the block's equilibrium requires, and as the sawframe study prints it."""


@dataclass(frozen=True, eq=False)
class RollerByAngles(CamRoller):
    """Cam roller by the sawframe study: cam and slot force from size and direction of the load R42 on the block.

    R40 = -R42 cos(phi - alpha42) / cos(nu) acts along the cam's outward normal, at phi - nu. R41 = R42 sin(phi -
    alpha42) + R40 sin(nu) acts across the ray, at phi + 90 deg. The study prints a minus before R40 sin(nu), with which
    the three forces on the block do not balance. `sign` is `EQUILIBRIUM` or `PRINTED`.
    """

    sign: float = EQUILIBRIUM

    TRUSTED = True

    def resolve(self, placement, loads, along) -> Resolved:
        radius, slope, _ = placement.details["cam"]
        x, y = vector_or_zero(loads["block"].force)
        R42, behind, nu = np.hypot(x, y), placement.angle - np.arctan2(y, x), np.arctan(slope / radius)
        R40 = -R42 * np.cos(behind) / np.cos(nu)
        R41 = R42 * np.sin(behind) + self.sign * R40 * np.sin(nu)
        torque = minus(R41 * radius, loads["block"].moment)
        on_crank = Wrench(scale_vector(R41, left(placement.ray)), torque)
        return Resolved({}, {"cam_force": -R40, "slot_force": R41}, {"crank": on_crank})


class SliderByVectors(SliderGroup):
    """Slider by the mower study: `slider_by_double_cross`; both derivatives from the loop equation of the vectors."""

    TRUSTED = True

    def pin_position(self, A):
        u, offset, length = self.guide.direction, self.guide.guide_offset, self.coupler_length
        foot = scale_vector(offset, left(u))
        W1, W2 = subtract_vectors(foot, scale_vector(length, u)), add_vectors(foot, scale_vector(length, u))
        return slider_by_double_cross(np.array(A), length, W1, W2, W2 if self.assembly > 0 else W1)

    def place(self, placement):
        A, u, length = placement.joints[self.on], self.guide.direction, self.coupler_length
        B = tuple(self.pin_position(A.position))
        AB = subtract_vectors(B, A.position)
        n, along = left(u), dot(u, AB)
        ratio, speed = -dot(n, A.first) / along, dot(AB, A.first) / along
        ratio_slope = (ratio * ratio * dot(n, AB) - dot(n, A.second)) / along
        gain = (dot(AB, A.second) - ratio * ratio * dot(AB, AB)) / along
        pin = Joint(B, scale_vector(speed, u), scale_vector(gain, u))
        q = scale_vector(1 / length, AB)
        coupler, slider = LinkMotion(A, q, ratio, ratio_slope), LinkMotion(pin, u, None, None)
        sine, cosine, travel = dot(n, q), dot(u, q), Joint(dot(u, B), speed, gain)
        motion = SliderMotion(coupler, slider, sine, cosine, (cosine, None), cosine * cosine, travel)
        self.enter(placement, motion, travels={"slider": travel})


class SliderByAsin(SliderByVectors):
    """Slider by the sawframe study: the coupler's angle from the guide by asin."""

    TRUSTED = True

    def pin_position(self, A):
        u, n = self.guide.direction, left(self.guide.direction)
        angle = np.arcsin((self.guide.guide_offset - dot(n, A)) / self.coupler_length)
        along, across = self.assembly * np.cos(angle), np.sin(angle)
        direction = add_vectors(scale_vector(along, u), scale_vector(across, n))
        return add_vectors(A, scale_vector(self.coupler_length, direction))


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
        arm, pivot = scale_vector(self.rocker_length, p), Joint(tuple(self.pivot), None, None)
        second = subtract_vectors(scale_vector(swing_slope, left(arm)), scale_vector(swing * swing, arm))
        pin = Joint(add_vectors(self.pivot, arm), scale_vector(swing, left(arm)), second)
        coupler = LinkMotion(placement.joints[self.on], q, ratio, ratio_slope)
        rocker, sine = LinkMotion(pivot, p, swing, swing_slope), cross(q, p)
        self._enter(placement, RockerMotion(coupler, rocker, pin, (sine, None), sine * sine))


def _convert(kind, original, **more):
    """A group or cam of the class `kind` with the fields of another."""
    return kind(*(getattr(original, field.name) for field in fields(original) if field.init), **more)


def by_the_papers(solution, sign=EQUILIBRIUM):
    """The solution by the formulas of the study that treats its mechanism, by default with the wrong sign corrected.

    Parameters
    ----------
    solution : Solution
        Of a crank-slider, a four-bar, or a cam-balanced crank-slider with a circle or cosine law as its cam.
    sign : float
        Sign of R40 sin(nu) in the slot force of a cam roller: `EQUILIBRIUM` or `PRINTED`.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        No study has formulas for the mechanism.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> plain, circle = (saw.solve(name, 8) for name in ("plain", "cam-circle"))
    >>> theirs = ks.papers.by_the_papers(plain)
    >>> bool(abs(theirs.balancing_torque - plain.balancing_torque).max() < 1e-9)  # N m
    True
    """
    mechanism = solution.mechanism
    groups = with_numeric_side(mechanism).groups
    kinds = [type(group) for group in groups]
    cams = {Circle: CircleAsPrinted, CosineLaw: CosineLawAsPrinted}
    if kinds == [SliderGroup]:
        made = [_convert(SliderByVectors, groups[0])]
    elif kinds == [RockerGroup]:
        made = [_convert(RockerByAtanAcos, groups[0], crank_length=mechanism.crank.length)]
    elif kinds == [CamRoller, SliderGroup] and type(groups[0].cam) in cams:
        first, second = groups
        cam = _convert(cams[type(first.cam)], first.cam)
        made = [RollerByAngles(cam, first.block, first.roller, first.plane, sign), _convert(SliderByAsin, second)]
    else:
        raise NotGivenError(f"no study has formulas for the groups, or this cam, of {mechanism.name}")
    return replace(solution, mechanism=replace(mechanism, groups=tuple(made)), engine=KERNELS)


def exactly_cancelled(solution):
    """The solution with its springs replaced by a force that cancels the slider's inertia at every crank angle.

    The sawframe study assumes this. It is true for a cosine law of motion, but not for the circular cam.

    Parameters
    ----------
    solution : Solution
        Solution with springs.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        The solution has no spring.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> plain, circle = (saw.solve(name, 8) for name in ("plain", "cam-circle"))
    >>> cancelled = ks.papers.exactly_cancelled(circle)
    >>> for solution in circle, cancelled:  # cancelled: no force along the guide is left at B
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
    """The solution by the sawframe study's equations as printed: `exactly_cancelled`, and the wrong sign of a force.

    This is not correct mechanics: it gives the study's dynamic coefficients but violates the balance of powers.

    Parameters
    ----------
    solution : Solution
        Solution of the saw with its circular cam and springs.

    Returns
    -------
    Solution

    Raises
    ------
    NotGivenError
        The mechanism is not a crank-slider with a circular cam, or the solution has no spring.

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


def _method(formulas, solution, quantity, setting=None):
    """Function that computes the components of a quantity by other formulas, for a `Method`."""
    require_one_design(solution)
    require_frictionless(solution)
    formulated = formulas(solution)

    def run():
        with np.errstate(divide="ignore", invalid="ignore"):
            return components(replace(formulated), quantity)

    return run


METHODS = (Method("papers' formulas", partial(_method, by_the_papers)),)
AS_PRINTED = Method("sawframe study as printed, wrong sign", partial(_method, as_printed))
"""A method with a known error: the wrong sign changes torque and support reaction by 0.3 of their largest values."""


def __dir__():
    return __all__
