"""Means over the period for users: torque, power and energy of the drive, losses, efficiency."""

from typing import Any

import numpy as np

from ..cycle.limit_positions import require_single
from ..errors import JammingError
from ..numbers.arithmetic import read_only
from ..numbers.lazy import cached_property
from .parameters import of_design


class PeriodMeans:
    """Exact means of a solution over its period, whatever its crank angles.

    They are integrals between the kinks and jumps of loads and friction. A mean of samples, as
    ``s.balancing_torque.mean()``, is off by about a percent where a force jumps.
    """

    @property
    def mean_torque(self):
        """Mean of the balancing torque over the crank angle of the period, its sign kept, N m; float or (designs,).

        Times the angle of the period it is the work of the drive. A torque that turns back what it gave has the mean 0;
        the mean of its magnitude is ``ks.compare(...).mean_torques``, of which `mean_torque_ratio` is the ratio.

        Raises
        ------
        ParameterError
            The mechanism does not close all round. Of several designs, those that do not close or jam are NaN.
        JammingError
            Friction jams somewhere in the period.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
        >>> s = pump.solve(360)  # 200 N over a stroke of 0.1 m, once a turn
        >>> print(f"{s.mean_torque:.4f} N m, {s.mean_power:.2f} W, {s.energy_per_turn:.3f} J a turn")
        3.1831 N m, 318.31 W, 20.000 J a turn
        """
        return self._drive_means[0]

    @property
    def mean_power(self):
        """Mean over time of the power of the drive, balancing torque times crank speed, W; float or (designs,).

        Positive where the drive gives it, 0 at rest. Errors as for `mean_torque`.
        """
        return self._drive_means[1]

    @property
    def energy_per_turn(self):
        """Work of the balancing torque in a turn of the crank, J, negative if the drive takes it; float or (designs,).

        Over the period, divided by its turns. Errors as for `mean_torque`.
        """
        return self._drive_means[2]

    @cached_property
    def _drive_means(self: Any):
        """The `DriveMeans`: floats, or arrays of the designs."""
        from ..cycle.means import drive_means

        batch = self.shape[:-1]
        if not batch:
            return drive_means(self)
        found = np.full((3, *batch), np.nan)
        for place in np.ndindex(batch):
            one = of_design(self, place)
            require_single(one, "mean torque", "balancing_torque")
            if not one.sampled.gaps:
                try:
                    found[:, *place] = drive_means(one)
                except JammingError:
                    continue
        return read_only(found)

    @cached_property
    def losses(self):
        """Mean powers over the period, lost by joint and taken by loads, a `cycle.losses.Losses`; of one design."""
        from ..cycle.losses import losses

        return losses(self)

    @property
    def efficiency(self):
        """Mechanical efficiency over the period: work taken by loads over work taken by loads and lost at joints."""
        return self.losses.efficiency
