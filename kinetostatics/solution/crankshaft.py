"""Results of the crankshaft: rocking moment, torque between throws, reactions of the main bearings."""

from typing import Any

from ..machine.group import ROCKING, SHAFT_TORQUE
from ..mechanics.quantities import of_scene


class CrankshaftResults:
    """Results of a machine whose groups have planes along the crankshaft; `QuantityError` if they have none."""

    @property
    def rocking_moment(self: Any):
        """Moment of the inertia of all moving masses on the frame about the axes x and y through O, (2, ..., N), N m.

        The sum of (-z_i F_iy, z_i F_ix) over the shaking force F_i in each plane z_i, z toward the viewer. About the
        plane z0 it is M - z0 k x F.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=0.1),))
        >>> ks.Scene(pump, 100.0).solve([0.0]).rocking_moment.T.round(6) + 0.0  # 1250 N at 0.1 m
        array([[  0., 125.]])
        """
        return self._found(ROCKING)

    def shaft_torque(self: Any, group, drive="right"):
        """Torque in the crankshaft next to the throw of a group, on the side of the drive, (..., N), N m.

        Positive counter-clockwise on the part toward the free end. Next to the throw nearest to the drive it is the
        balancing torque less friction in the main bearings. The quantity "shaft_torque coupler2" of extremes and
        sweeps assumes the drive on the right.

        Parameters
        ----------
        group : str
            First link of a group on the crank or a pin of it, such as "coupler2".
        drive : "right" or "left"
            Driven end, beyond all throws; "right" is the end at large positions.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.Mechanism("pump", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(2.0), plane=0.1),))
        >>> s = ks.Scene(pump, 100.0).solve(90)
        >>> bool(abs(s.shaft_torque("coupler") - s.balancing_torque).max() < 1e-9)  # behind the only throw
        True
        """
        name = f"{SHAFT_TORQUE} {group}"
        known = isinstance(drive, str) and drive == "right" and name in of_scene(self)
        return self._found(name) if known else self.dynamics.shaft_torque(group, drive)

    def _at_bearing(self: Any, joint, at):
        """Reaction of a main bearing."""
        name = f"{joint} {at}"
        found = self._found(name) if name in of_scene(self) else self.dynamics.reaction(joint, at)
        self._warn_of_growth(name, found)
        return found
