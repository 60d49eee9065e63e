"""Line contact with a cam by Hertz: a roller, or the flat face of a follower, with its size and materials.

Two cylinders are under a force F over a width w (Johnson, *Contact Mechanics*, 1985, section 4.2). With 1/E* = (1 -
nu1^2)/E1 + (1 - nu2^2)/E2 and 1/Re the sum of both curvatures,

    p0 = sqrt(F E* / (pi w Re)),   half width b = sqrt(4 F Re / (pi w E*))
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import sqrt
from ...numbers.lazy import cached_property


def contact_modulus(one, other):
    """Contact modulus E* of two materials, Pa, from (Young's modulus, Poisson's ratio) of each."""
    (young, ratio), (other_young, other_ratio) = one, other
    return 1.0 / ((1.0 - ratio * ratio) / young + (1.0 - other_ratio * other_ratio) / other_young)


def pressure(force, width, modulus, radius):
    """Largest Hertz pressure, Pa; NaN where the relative radius is negative."""
    return sqrt(abs(force) * modulus / (math.pi * width * radius))


def half_width(force, width, modulus, radius):
    """Half width of the contact, m."""
    return sqrt(4.0 * abs(force) * radius / (math.pi * width * modulus))


def relative_radius(bend, roller_radius, side):
    """Relative radius Re of a roller on its cam, m, from the curvature kappa of the pitch curve, 1/m.

    The working curve is offset from the pitch curve by the radius R of the roller. So Re = R (1 - kappa R) on a disk,
    side -1, and R (1 + kappa R) on a ring, side +1.
    """
    return roller_radius * (1.0 + side * bend * roller_radius)


SIZE_RULE = checks.Number("m", low=0.0, strict=True)
MODULUS_RULE = checks.Number(
    "Pa", low=0.0, strict=True, usual=checks.PlausibleRange(1e13, "is it in GPa, or in N/mm2?", least=1e6)
)
POISSON_RULE = checks.Number("1", low=0.0)
MAX_POISSONS_RATIO = 0.5


class LineContact(NamedTuple):
    """Line contact of a group: `body`, a `Roller` or `Face`, and the name of its contact force."""

    body: Any
    force: str


class PressedBody(checks.Checked):
    """Base of `Roller` and `Face`: width of the contact, and materials of the body and the cam."""

    width: Annotated[Any, SIZE_RULE]
    youngs_modulus: Annotated[Any, MODULUS_RULE]
    poissons_ratio: Annotated[Any, POISSON_RULE]
    cam_youngs_modulus: Annotated[Any, checks.Optional(MODULUS_RULE)]
    cam_poissons_ratio: Annotated[Any, checks.Optional(POISSON_RULE)]

    def _poisson_problems(self):
        """Problem of designs with a Poisson's ratio above 0.5: the volume would grow under pressure."""
        for name in ("poissons_ratio", "cam_poissons_ratio"):
            ratio = getattr(self, name)
            over = ratio is not None and checks.has_known_values(ratio) and np.asarray(ratio) > MAX_POISSONS_RATIO
            if np.any(over):
                yield checks.Problem(f"{name} must be at most {MAX_POISSONS_RATIO:g}, got {np.max(ratio):.6g}", over)

    @cached_property
    def modulus(self):
        """Contact modulus E*, Pa; a missing constant of the cam is that of the body."""
        own = self.youngs_modulus, self.poissons_ratio
        of_cam = self.cam_youngs_modulus, self.cam_poissons_ratio
        return contact_modulus(own, [mine if other is None else other for mine, other in zip(own, of_cam, strict=True)])


@dataclass(frozen=True, eq=False)
class Roller(PressedBody):
    """Size and materials of a roller on a cam; a cam with a `Roller` has the output "contact_pressure".

    Parameters
    ----------
    radius, width : float or array
        m; `width` is the width of the contact.
    youngs_modulus : float or array
        Pa.
    poissons_ratio : float or array
        At most 0.5.
    cam_youngs_modulus, cam_poissons_ratio : float or array, optional
        Constants of the cam; by default those of the roller.

    Raises
    ------
    ParameterError
        A value is impossible. When a scene is solved: the roller undercuts the side of the cam that carries it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.CosineLaw(0.3, 2.0)
    >>> roller = ks.Roller(0.05, 0.04, 210e9, 0.3)
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600.0), roller=roller)
    >>> solution = ks.solve(saw, 0.5, crank_speed=10.0, loads=ks.Spring.balancing(600.0, 11.0, 2.0))
    >>> print(f"{float(solution.contact_pressure) / 1e6:.1f} MPa")
    249.0 MPa
    """

    radius: Annotated[Any, SIZE_RULE]
    width: Any
    youngs_modulus: Any
    poissons_ratio: Any
    cam_youngs_modulus: Any = None
    cam_poissons_ratio: Any = None

    RULES = checks.Rules("roller", PressedBody._poisson_problems)


OptionalRoller = Annotated[Roller | None, checks.Optional(checks.InstanceOf(Roller, "a Roller"))]
"""Type of a field for a roller, with its rule."""


@dataclass(frozen=True, eq=False)
class Face(PressedBody):
    """Width and materials of a flat face on a cam, as `Roller` without a radius.

    Parameters
    ----------
    width : float or array
        Width of the contact, m.
    youngs_modulus, poissons_ratio, cam_youngs_modulus, cam_poissons_ratio
        As for `Roller`.

    Raises
    ------
    ParameterError
        A value is impossible.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> steel_on_cast_iron = ks.Face(0.02, 210e9, 0.3, cam_youngs_modulus=110e9, cam_poissons_ratio=0.25)
    >>> print(f"{steel_on_cast_iron.modulus / 1e9:.2f} GPa")
    77.78 GPa
    """

    width: Any
    youngs_modulus: Any
    poissons_ratio: Any
    cam_youngs_modulus: Any = None
    cam_poissons_ratio: Any = None

    RULES = checks.Rules("face", PressedBody._poisson_problems)
