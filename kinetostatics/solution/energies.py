"""Inertia as the crank feels it, energies of the whole mechanism, and what friction takes, as a solution gives them."""

from typing import Any

import numpy as np

from ..mechanics import jamming
from ..mechanics.quantities import of_scene
from ..numbers.lazy import cached_property


class Energies:
    """Inertia, energies and friction; each is found by the engine of the solution."""

    mechanism: Any
    friction: Any
    shape: Any
    closed: Any
    _found: Any
    _scalar: Any
    _look_up: Any

    @property
    def reduced_inertia(self):
        """Inertia of all links as the crank feels it, (..., N), kg m2: twice the energy over the speed squared."""
        return self._found("reduced_inertia")

    @property
    def reduced_inertia_slope(self):
        """Derivative of the reduced inertia by the crank angle, (..., N), kg m2."""
        return self._found("reduced_inertia_slope")

    @property
    def kinetic_energy(self):
        """Kinetic energy of all links, (..., N), J."""
        return self._found("kinetic_energy")

    @property
    def potential_energy(self):
        """Potential energy of weight and springs, (..., N), J; weight has none at the height of O.

        Loads without potential, as process forces and dampers, count nothing.
        """
        return self._found("potential_energy")

    @cached_property
    def energy_per_turn(self):
        """Work of the balancing torque in a turn of the crank, J: what the loads take of the drive; of one design."""
        from ..results.means import energy_per_turn

        return energy_per_turn(self)

    @property
    def load_torque(self):
        """Torque on the crank that holds weight and loads at their speed, without any inertia, (..., N), N m.

        With reduced inertia J the balancing torque is J alpha + J' omega^2 / 2 + load torque.
        """
        return self._found("load_torque")

    # What friction takes

    @property
    def guide_friction(self):
        """Friction of the guide on the slider along the guide, N; 0 without friction."""
        return self._of_friction("guide_friction")

    @property
    def friction_loss(self):
        """Power lost by friction at all joints, (..., N), W, not negative."""
        return self._of_friction("friction_loss")

    @property
    def friction_torque(self):
        """Torque on the crank that friction takes, its loss over the crank speed, (..., N), N m."""
        return self._of_friction("friction_torque")

    def friction_loss_at(self, joint):
        """Power lost by friction at a joint, named as in `friction`, (..., N), W; 0 where nothing rubs."""
        self._look_up("joint that rubs", joint, self.mechanism.pairs)
        return self._of_friction(f"{joint}_friction_loss")

    @cached_property
    def losses(self):
        """Mean powers over the period, lost by joint and taken by loads, a `results.losses.Losses`; of one design."""
        from ..results.losses import losses

        return losses(self)

    @property
    def efficiency(self):
        """Mechanical efficiency over the period: of what loads take and joints lose, the part that loads take."""
        return self.losses.efficiency

    def friction_at(self, joint):
        """Friction at a joint on the link that moves there: moment of a pin, N m, else the force along the pair, N."""
        self._look_up("joint that rubs", joint, self.mechanism.pairs)
        return self._of_friction(f"{joint}_friction")

    @property
    def friction_margin(self):
        """How far friction is from jamming: 1 without friction; where it is positive there is one state of forces.

        Of a guide or pin that rubs alone it is ``1 - |kappa|``, exactly: where it is 0 or less there is no state, or
        there are two. Of several joints of a group it is a bound, whatever their loads and senses of motion: where it
        is 0 or less there may still be one state; none is looked for, and friction is NaN.
        """
        return self._of_friction("friction_margin") if self.friction else self._scalar(1.0)

    @property
    def friction_residual(self):
        """How much forces would change by one more pass over friction, relative to the largest of a group."""
        return self._of_friction("friction_residual")

    def _of_friction(self, name):
        return self._found(name) if name in of_scene(self) else self._scalar(None)

    @property
    def converged(self):
        """Whether friction and reactions were found together to rounding, (..., N) of bool; so they are without."""
        if not self.friction.acting:
            return np.broadcast_to(self.closed, self.shape)
        return jamming.converged(*jamming.checks_of(self))
