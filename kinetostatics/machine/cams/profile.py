"""Working curve of a cam for a roller, the path of its cutter, and the limits of both: undercutting and collisions.

Let kappa be the curvature of the pitch curve, positive where it is convex seen from outside, and R the radius of the
roller. A disk inside the pitch curve has the curvature kappa / (1 - kappa R), a ring around it -kappa / (1 + kappa R).
Both are positive where the surface is convex to the roller. The roller would cut the disk away where kappa R >= 1, the
ring where -kappa R >= 1 (Norton, *Cam Design and Manufacturing Handbook*, 2009, chapter 7).
"""

import warnings
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ...errors import HintWarning, ParameterError
from ...numbers import checks
from ...numbers.brackets import find_minima
from ...numbers.formatting import with_units
from ...numbers.lazy import cached_property
from ...numbers.planar import polar_curvature
from .. import plausibility
from ..crank import ray as ray_at
from ..laws.law import TURN, turn_angles

PEAK_SAMPLES = 1440
"""Even crank angles a turn between which peaks are bracketed, and whose points are tested for collisions."""
ANGLE_TOLERANCE = 1e-12
"""Error of the crank angle of a peak, rad."""
SIDE_SIGNS = {"disk": -1.0, "ring": 1.0}
"""Sign of the side of the pitch curve on which the cam lies: inside, outside."""
POSITIVE = {"low": 0.0, "strict": True}
CUT_TOLERANCE = 1e-3
"""Depth to which a roller may cut into another part of the cam, relative to its radius: error of the chain."""


@with_units(angle="rad")
class Peak(NamedTuple):
    """Largest or smallest value over the turn, and its crank angle, rad.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.02, slider=ks.Link(600.0))
    >>> found = ks.design.contact(ks.Scene(saw, 10.0).solve(4), 0.05, 0.04, 210e9, 0.3).largest_pressure
    >>> print(f"{found.value / 1e6:.1f} MPa")
    532.4 MPa
    """

    value: float
    angle: float


def sampled_angles(cam):
    """Crank angles over the turn, even ones and some between neighbouring knots of a cam, rising, rad."""
    return turn_angles([knot.angle for knot in cam.knots], PEAK_SAMPLES)


def highest(function, cam):
    """Largest value of a function of crank angles over the turn of a cam, a `Peak`, between samples too."""
    angle = sampled_angles(cam)
    values = np.asarray(function(angle), dtype=float)
    before, after = np.roll(values, 1), np.roll(values, -1)
    tops = np.flatnonzero((values >= before) & (values >= after) & ((values > before) | (values > after)))
    around = np.stack([tops - 1, tops, tops + 1])
    brackets = angle[around % angle.size] + TURN * (around // angle.size)
    found = find_minima(lambda at, place: -np.asarray(function(at)), brackets, 0.0, ANGLE_TOLERANCE)
    angle = np.append(angle, np.where(np.isnan(found), angle[tops], found))
    values = np.append(values, np.asarray(function(angle[values.size :]), dtype=float))
    best = int(np.argmax(values))
    return Peak(float(values[best]), float(angle[best] % TURN))


def lowest(function, cam):
    """Smallest value of a function of crank angles over the turn of a cam, a `Peak`."""
    peak = highest(lambda angle: -np.asarray(function(angle)), cam)
    return Peak(-peak.value, peak.angle)


@dataclass(frozen=True, eq=False)
class Profile:
    """Working curve of a cam for a roller; made by ``cam.profile``.

    Attributes
    ----------
    cam : Cam
    roller_radius : float
        m; 0 for a flat face.
    crank_angle : array (N,)
        rad.
    side : "disk" or "ring"
        Side of the pitch curve on which the cam lies: inside, outside.
    pitch, surface, normal : array (2, N)
        Centre of the roller, m; its contact point with the cam, m; outward unit normal of the pitch curve.
    pressure_angle : array (N,)
        Angle between the normal and the crank ray, rad.
    curvature_radius : array (N,)
        Radius of the working curve, m: positive where it is convex to the roller, negative where it is hollow.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> made = ks.cams.Circle(0.3, (-0.02, 0.0)).profile(0.05, 360)
    >>> made.surface.shape, round(float(made.curvature_radius[0]), 9)  # m: a circle again
    ((2, 360), 0.25)
    """

    cam: Any
    roller_radius: float
    crank_angle: np.ndarray = field(repr=False)
    side: str
    pitch: np.ndarray = field(repr=False)
    surface: np.ndarray = field(repr=False)
    normal: np.ndarray = field(repr=False)
    pressure_angle: np.ndarray = field(repr=False)
    curvature_radius: np.ndarray = field(repr=False)

    def cutter_path(self, cutter_radius):
        """Path of the centre of a cutter that cuts the same working curve, (2, N), m.

        Raises
        ------
        ParameterError
            The cutter does not fit into a hollow of the working curve, or cuts into another part of it.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> made = ks.cams.Circle(0.3).profile(0.05, 4)
        >>> abs(made.cutter_path(0.02)[:, 0]).round(6)  # m: the disk's 0.25 m and the cutter's radius
        array([0.27, 0.  ])
        """
        radius = checks.single_numbers("cutter_path", cutter_radius=(cutter_radius, "m", POSITIVE))["cutter_radius"]
        hollow = self.smallest_hollow
        if hollow is not None and radius >= -hollow.value:
            raise ParameterError(
                f"cutter_path: a cutter of radius {radius:.6g} m does not fit into the hollow of the {self.side} at "
                f"{_place(self.cam, hollow.angle)}, whose radius is {-hollow.value:.6g} m; take a smaller"
            )
        side = SIDE_SIGNS[self.side]
        angle = sampled_angles(self.cam)
        _, normal, made = _curves(self.cam, self.roller_radius, angle, self.side)
        nearest = _nearest(made - side * radius * normal, made, angle)
        if nearest.value < radius * (1.0 - CUT_TOLERANCE):
            raise ParameterError(
                f"cutter_path: a cutter of radius {radius:.6g} m cuts into another part of the {self.side}. Its centre "
                f"comes as near as {nearest.value:.6g} m to the working curve at {_place(self.cam, nearest.angle)}; "
                "take a smaller"
            )
        return self.surface - side * radius * self.normal

    @cached_property
    def largest_pressure_angle(self):
        """Largest size of the pressure angle over the turn, a `Peak`, rad."""
        return highest(lambda angle: np.abs(self.cam.pressure_angle(angle)), self.cam)

    @cached_property
    def smallest_curvature_radius(self):
        """Smallest radius of convex parts of the working curve, a `Peak`, m; None if no part is convex."""
        return self._tightest(1.0)

    @cached_property
    def smallest_hollow(self):
        """Radius of the tightest hollow of the working curve, a `Peak`, m, negative; None if there is no hollow."""
        return self._tightest(-1.0)

    def _tightest(self, sign):
        """Smallest radius of the parts of the working curve with a curvature of this sign, a `Peak`; None without."""
        side = SIDE_SIGNS[self.side]

        def bend(angle):
            return sign * surface_curvature(curvature(self.cam, angle), self.roller_radius, side)

        peak = highest(bend, self.cam)
        return Peak(sign / peak.value, peak.angle) if peak.value > 0 else None

    @cached_property
    def largest_roller_radius(self):
        """Smallest roller radius that undercuts the cam, m; inf if none does."""
        sharpest = highest(lambda angle: _roller_side_curvature(self.cam, angle, self.side), self.cam)
        return 1.0 / sharpest.value if sharpest.value > 0 else np.inf

    def exceeded(self, *, pressure_angle=None, curvature_radius=None):
        """Sentences on exceeded limits of the pressure angle, rad, and of the smallest convex radius, m."""
        limits = {"pressure_angle": (pressure_angle, "rad"), "curvature_radius": (curvature_radius, "m")}
        given = {name: (*limit, POSITIVE) for name, limit in limits.items() if limit[0] is not None}
        steepest, sharpest = map(checks.single_numbers("exceeded", **given).get, limits)
        peak, bend, found = self.largest_pressure_angle, self.smallest_curvature_radius, []
        if steepest is not None and peak.value > steepest:
            found.append(
                f"the pressure angle reaches {np.degrees(peak.value):.6g} deg at {_place(self.cam, peak.angle)}, more "
                f"than {np.degrees(steepest):.6g}"
            )
        if sharpest is not None and bend is not None and bend.value < sharpest:
            found.append(
                f"the working curve is as sharp as {bend.value:.6g} m at {_place(self.cam, bend.angle)}, less than "
                f"{sharpest:.6g}"
            )
        return tuple(found)


def curvature(cam, angle):
    """Curvature of the pitch curve at crank angles, 1/m, positive where it is convex seen from outside."""
    return polar_curvature(*cam.radius(angle))


def surface_curvature(bend, roller_radius, side):
    """Curvature of the working curve on a side of the pitch curve, 1/m, positive where it is convex to the roller."""
    return -side * bend / (1.0 + side * bend * roller_radius)


def _roller_side_curvature(cam, angle, side):
    """Curvature of the pitch curve toward the cam, 1/m; the radius of the roller must be smaller."""
    return -SIDE_SIGNS[side] * curvature(cam, angle)


def flat_face_problem(cam, roller_radius):
    """Sentence if a roller is given for the cam of a flat face."""
    if cam.flat and roller_radius is not None:
        return "its follower has a flat face, which touches the pitch curve itself; leave roller_radius out"
    return None


def profile(cam, roller_radius, angle, side="disk"):
    """Working curve of a cam, a `Profile`; ``cam.profile`` documents the parameters."""
    problems = checks.choice("side", side, tuple(SIDE_SIGNS)), flat_face_problem(cam, roller_radius)
    rules = {} if cam.flat else {"roller_radius": (roller_radius, "m", POSITIVE)}
    radius = checks.single_numbers("cam profile", *problems, **rules).get("roller_radius", 0.0)
    if isinstance(angle, int | np.integer) and not isinstance(angle, bool):
        checks.require("cam profile", checks.count("angle", angle, size=checks.BYTES_PER_ANGLE))
        angle = np.linspace(0.0, TURN, int(angle), endpoint=False)
    else:
        found = checks.check_values("cam profile", {"angle": checks.Number("rad", table=True)}, {"angle": angle})
        angle = np.atleast_1d(np.asarray(found["angle"], dtype=float))
        for text in plausibility.angle_hints(angle):
            warnings.warn(HintWarning("cam profile", text), stacklevel=3)
    checks.require("cam profile", *_undercut_problems(cam, radius, side))
    pitch, normal, made = _curves(cam, radius, angle, side)
    r, slope, _ = cam.radius(angle)
    with np.errstate(divide="ignore"):
        curved = 1.0 / surface_curvature(curvature(cam, angle), radius, SIDE_SIGNS[side])
    return Profile(cam, radius, angle, side, pitch, made, normal, np.arctan2(slope, r), curved)


def _curves(cam, radius, angle, side):
    """Pitch curve, outward normal and working curve at crank angles, each (2, N)."""
    r, slope, _ = cam.radius(angle)
    x, y = ray_at(angle)
    length = np.hypot(r, slope)
    normal = np.stack([r * x + slope * y, r * y - slope * x]) / length
    pitch = np.stack([r * x, r * y])
    return pitch, normal, pitch + SIDE_SIGNS[side] * radius * normal


def crank_degrees(cam, angle):
    """Crank angles at polar angles of a cam, degrees: equal, except for the cam of a follower, which turns."""
    convert = getattr(cam, "crank_angle", None)
    return np.degrees(np.mod(convert(angle), TURN) if convert else angle)


def _place(cam, angle):
    """Words for the crank angle at a polar angle of a cam."""
    return f"crank angle {float(crank_degrees(cam, angle)):.6g} deg"


def _undercut_problems(cam, radius, side):
    """Problems of a roller on this side of the pitch curve, as sentences with the crank angles."""
    least = lowest(lambda angle: cam.radius(angle)[0], cam)
    if not least.value > 0:
        yield (
            f"the pitch curve must go around O, but its radius falls to {least.value:.6g} m at "
            f"{_place(cam, least.angle)}"
        )
        return
    sharpest, angle = highest(lambda angle: _roller_side_curvature(cam, angle, side), cam), sampled_angles(cam)
    if sharpest.value * radius >= 1.0:
        where, sharp = "all over the turn", _roller_side_curvature(cam, angle, side) * radius >= 1.0
        if not sharp.all():
            order = np.roll(np.arange(sharp.size), -int(np.argmin(sharp)))
            edges = np.flatnonzero(np.diff(np.concatenate([[0], sharp[order].astype(int), [0]])))
            spans = crank_degrees(cam, angle[order[[edges[::2], edges[1::2] - 1]]]).T
            spans = spans[:, ::-1] if hasattr(cam, "crank_angle") else spans  # polar angles fall as the crank turns
            where = " and ".join(f"from {start:.4g} to {stop:.4g} deg" for start, stop in spans) or "there alone"
        yield (
            f"a roller of radius {radius:.6g} m undercuts the {side}. The pitch curve bends with a radius of "
            f"{1.0 / sharpest.value:.6g} m at {_place(cam, sharpest.angle)} (too sharp {where}); the roller's must be "
            "less"
        )
        return
    pitch, _, made = _curves(cam, radius, angle, side)
    nearest = _nearest(pitch, made, angle)
    if nearest.value < radius * (1.0 - CUT_TOLERANCE):
        yield (
            f"a roller of radius {radius:.6g} m cuts into another part of the {side}. Where it touches at "
            f"{_place(cam, nearest.angle)}, its centre comes as near as {nearest.value:.6g} m later; take a smaller"
        )
    elif side == "disk" and least.value <= radius:
        yield (
            f"a roller of radius {radius:.6g} m covers O, as its centre comes as near as {least.value:.6g} m at "
            f"{_place(cam, least.angle)}; take a smaller"
        )


def _nearest(centres, made, angle):
    """Smallest distance of the working curve from the path of a roller or cutter centre, a `Peak`, m."""
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(centres.T).query(made.T)
    worst = int(np.argmin(distance))
    return Peak(float(distance[worst]), float(angle[worst]))
