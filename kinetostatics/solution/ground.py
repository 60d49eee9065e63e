"""Forces on the frame: `Solution.ground`."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..machine.group import GROUND
from ..machine.supports import Support, places
from ..mechanics.ground import support, undeclared
from ..numbers import checks
from ..numbers.planar import cross

POINT = checks.Pair("m")
MAX_UNDECLARED = 1e-9
"""Largest difference of frame forces from those of declared pairs, relative to the largest load: rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class Ground(Mapping):
    """Forces of the machine on the frame by the place of contact; `Solution.ground` returns them.

    Each is a `Support` with `force` (2, ..., N), N, the `point` where it acts, (2, ..., N), m, and `couple` (..., N),
    N m, counter-clockwise. The places:

    - fixed pivots, "O", "O2" ...: the opposite of the reaction, plus a couple from pin friction.
    - guides, "guide", "guide2" ...: the opposite of the reaction, friction included, and of the guide moment, at the
      slider pin.
    - "cam": along the common normal. The point is the contact if the roller has a radius (`Roller`, `RollerFriction`),
      on the flank according to the sign of the force; else the roller's centre A, through which the normal passes.
    - loads, named as in parameter paths, "spring", "spring2", "point_damper", "torsion_spring" ...: the foot of a
      spring along a guide, at the coordinate where it is free; the fixed point of a load between two points; the
      opposite couple of a torque against the frame; a `ProcessForce` with ``reaction="frame"``, at the slider pin.
    - "motor": the opposite of the balancing torque, a couple.

    By d'Alembert's principle `resultant` is the sum of shaking force, weights and outside forces on the links (`Force`,
    and `ProcessForce` with ``reaction="outside"``). A `Force` at a fixed point acts on the frame from outside and is
    excluded. A load without the base class `Load` counts as an external load.

    Attributes
    ----------
    solution : Solution

    Warns
    -----
    UserWarning
        A user's group loads the frame by more than its declared pairs with the frame.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ground = ks.load_case("sawframe_2r63").solve("cam-circle", 360).ground
    >>> list(ground)
    ['O', 'cam', 'guide', 'spring', 'motor']
    >>> print(f"{abs(ground['spring'].force[0]).max():.0f} N at the feet of the springs")
    202129 N at the feet of the springs
    """

    solution: Any

    def __post_init__(self):
        if not self.solution.mechanism.trusted:
            self._warn_of_undeclared()

    def _warn_of_undeclared(self):
        """Warn if a user's group loads the frame without a declared pair."""
        dynamics = self.solution.dynamics
        force, moment = undeclared(dynamics)
        if np.any(force > MAX_UNDECLARED * dynamics.largest_force_term) or np.any(
            moment > MAX_UNDECLARED * dynamics.largest_force_term * self.solution.mechanism.extent
        ):
            warnings.warn(
                f"{self.solution.mechanism.name}: the forces on the frame lack up to {np.nanmax(force):.3g} N and "
                f"{np.nanmax(moment):.3g} N m about O, because a group of your own loads the frame by more than its "
                "declared pairs with the frame (kinetostatics.machine.group)",
                stacklevel=2,
            )

    def __repr__(self):
        return f"<Ground: {self.solution.mechanism.name}, {', '.join(self)}>"

    def __iter__(self):
        return iter(places(self.solution))

    def __len__(self):
        return len(places(self.solution))

    def __contains__(self, name):
        return name in places(self.solution)

    def __getitem__(self, name):
        """Force and couple at a place.

        Raises
        ------
        QuantityError
            The place is unknown; the message lists the known places.
        """
        solution = self.solution
        point = solution.as_vector(support(solution, name).point)
        return Support(solution.ground_force(name), point, _couple(solution, name))

    @property
    def resultant(self):
        """Sum of the forces, (2, ..., N), N; the quantity "ground"."""
        return self.solution.ground_force()

    def moment(self, about=(0.0, 0.0)):
        """Moment of all forces and couples about a fixed point, (..., N), N m, counter-clockwise.

        Parameters
        ----------
        about : (x, y)
            m; by default O.

        Raises
        ------
        ParameterError
            The point is not a pair of finite numbers.

        Examples
        --------
        Without weight and outside forces it is the shaking moment:

        >>> import kinetostatics as ks
        >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5).solve(360)
        >>> bool(abs(s.ground.moment() - s.shaking_moment).max() < 1e-9)
        True
        """
        about, problem = POINT.check(about, "about")
        checks.require("moment", problem)
        total = np.zeros(self.solution.shape)
        for item in self.values():
            lever = [part - own for part, own in zip(item.point, about, strict=True)]
            total = total + cross(lever, item.force) + item.couple
        return total

    def table(self):
        """Largest force and couple at each place over the period, with their crank angles, a pandas DataFrame.

        Extremes are exact; the first row is the sum of all forces. NaN where a place has no force or no couple, and
        for the crank angle of a constant.

        Raises
        ------
        ParameterError
            The solution has several designs.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> table = ks.load_case("sawframe_2r63").solve("cam-circle", 90).ground.table()
        >>> table["force [N]"].round(0)
        place
        all       252161.0
        O          22285.0
        cam        49930.0
        guide      17876.0
        spring    202129.0
        motor          NaN
        Name: force [N], dtype: float64
        """
        import pandas as pd

        known = places(self.solution)
        rows = [("all", *_largest(self.solution, GROUND), np.nan, np.nan)]
        for name, place in known.items():
            force = _largest(self.solution, f"{GROUND} {name}") if place.pushes else (np.nan, np.nan)
            turns = support(self.solution, name).couple is not None
            couple = _largest(self.solution, lambda at, name=name: _couple(at, name)) if turns else (np.nan, np.nan)
            rows.append((name, *force, *couple))
        columns = ["place", "force [N]", "at [deg]", "couple [N m]", "couple at [deg]"]
        return pd.DataFrame(rows, columns=columns).set_index("place")


def _couple(solution, name):
    """Couple on the frame at a place, (..., N), N m."""
    return solution._scalar(support(solution, name).couple)


def _largest(solution, quantity):
    """Value of largest magnitude over the period, and its crank angle, degrees."""
    from ..cycle.extremes import extrema
    from ..cycle.rounding import PLACED, zeroed

    found = extrema(solution, quantity)
    if not len(found):
        return found.constant + 0.0, np.nan  # 0.0 in place of -0.0
    place = int(np.argmax(np.abs(found.value)))
    return float(found.value[place]), float(np.degrees(zeroed(found.angle, PLACED)[place]))
