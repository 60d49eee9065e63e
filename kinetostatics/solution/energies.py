"""Inertia as the crank feels it, and energies of the whole mechanism, as a solution gives them."""

from typing import Any

from ..numbers.lazy import cached_property


class Energies:
    """Inertia and energies; each is found by the engine of the solution."""

    _found: Any

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
