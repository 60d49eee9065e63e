"""The crankshaft as users hold it: rocking moment, torque between throws, reactions of the main bearings."""

from typing import Any

from ..machine.group import ROCKING, SHAFT_TORQUE
from ..mechanics.quantities import of_scene
from ..mechanics.shaft import require_bearings, require_planes


class CrankshaftResults:
    """Results of a machine whose groups have positions along the crankshaft (`machine.planes`)."""

    mechanism: Any
    dynamics: Any
    _found: Any
    _warn_of_growth: Any

    @property
    def rocking_moment(self):
        """Moment of the inertia of all moving masses on the frame about x and y, (2, ..., N), N m.

        The sum of z_i k x F_i over the planes z_i, with the shaking force F_i of each: (-sum z_i F_iy, sum z_i F_ix),
        right-handed, k along the shaft to the viewer. About the axes through O in the plane z = 0; about z0 it is
        smaller by z0 k x F.

        Raises
        ------
        QuantityError
            No part of the mechanism has a plane.

        Examples
        --------
        Two saws that move against each other, 0.3 m apart: the shaking forces cancel, a couple remains.

        >>> import math
        >>> import kinetostatics as ks
        >>> saws = [ks.SliderGroup(2.0, slider=ks.Link(600.0), plane=-0.15)]
        >>> saws.append(ks.SliderGroup(2.0, ks.Guide.at(math.pi), slider=ks.Link(600.0), on="C", pin="D", label="2"))
        >>> opposite = ks.Pin(on="crank", at=(-0.3, 0.0), name="C", plane=0.15)
        >>> twin = ks.Mechanism("twin saw", ks.Crank(0.3), (saws[0], opposite, saws[1]))
        >>> s = ks.Scene(twin, 33.5).solve(360)
        >>> f"{abs(s.shaking_force).max():.0f} N, {abs(s.rocking_moment[1]).max():.0f} N m about y"
        '0 N, 69692 N m about y'
        """
        require_planes(self.mechanism, ROCKING.replace("_", " "))
        return self._found(ROCKING)

    def shaft_torque(self, group, drive="right"):
        """Torque in the crankshaft beside the throw of a group, on the side of the drive, (..., N), N m.

        Counter-clockwise positive, from the part toward the drive on the part toward the free end. Beside the throw
        nearest to the drive it is the balancing torque, less what friction in the main bearings takes. The quantities
        "shaft_torque coupler2" ... of extremes and sweeps have the drive on the right.

        Parameters
        ----------
        group : str
            First link of a group on the crank or a pin of it, such as "coupler2".
        drive : "right" or "left"
            Where the drive takes hold of the shaft, beyond all throws; "right" is the end of large positions.

        Raises
        ------
        QuantityError
            No part has a plane, or there is no such group on the crank.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> rods = [ks.SliderGroup(0.2, slider=ks.Link(2.0), on="A", plane=-0.1)]
        >>> rods.append(ks.SliderGroup(0.2, slider=ks.Link(2.0), on="C", pin="D", label="2"))
        >>> second = ks.Pin(on="crank", at=(-0.05, 0.0), name="C", plane=0.1)
        >>> pump = ks.Mechanism("pump", ks.Crank(0.05, bearings=(-0.2, 0.2)), (rods[0], second, rods[1]))
        >>> s = ks.Scene(pump, 100.0).solve(360)
        >>> bool(abs(s.shaft_torque("coupler2") - s.balancing_torque).max() < 1e-9)
        True
        >>> bool(abs(s.reaction("O", at="left") + s.reaction("O", at="right") - s.reaction("O")).max() < 1e-9)
        True
        """
        name = f"{SHAFT_TORQUE} {group}"
        known = drive == "right" and name in of_scene(self)
        return self._found(name) if known else self.dynamics.shaft_torque(group, drive)

    def _at_bearing(self, joint, at):
        """Reaction of a main bearing."""
        require_bearings(self.mechanism, joint, at)
        found = self._found(f"{joint} {at}")
        self._warn_of_growth(f"{joint} {at}", found)
        return found
