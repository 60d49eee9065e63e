"""Powers and energies of a machine in periodic running, by integrals over its period."""

import math
from typing import Any

import numpy as np

from ..errors import DriveError
from ..numbers.lazy import cached_property
from .energy_flow import energy_flow, without_noise


class Powers:
    """What the motor gives, and what takes it; each is found once."""

    scene: Any
    motor: Any
    turns: Any
    duration: Any
    _driven: Any
    _pieces: Any
    _speed: Any
    _state: Any
    _powers: Any
    _at_points: Any
    _forward: Any
    _transmission: Any
    _motor_torque: Any

    @cached_property
    def energy_per_turn(self):
        """Energy that the motor gives at its shaft in a turn, J."""
        torque = self._transmission * self._motor_torque(self._speed)
        energy = self._pieces.total(self._driven.direction * torque)
        flowing = self._pieces.total(np.abs(torque) + np.abs(self._state.torque))
        return without_noise(energy, flowing) / self.turns

    @cached_property
    def energy_flow(self):
        """Where the energy of a turn goes: an `EnergyFlow`, with a table by `.frame()`."""
        return energy_flow(self)

    @cached_property
    def air_gap_energy_per_turn(self):
        """Energy through the air gap of an induction motor in a turn, J: torque times speed of the field."""
        if not self.has_air_gap:
            raise DriveError(
                "air_gap_energy_per_turn: only an induction motor, Motor.kloss, has an air gap that it knows"
            )
        power = self._motor_torque(self._speed) * (self.motor.field_speed if self.motor else 0.0)
        return self._pieces.total(power / np.abs(self._speed)) / self.turns

    @property
    def has_air_gap(self):
        """Whether the motor is an induction motor, whose losses by slip are known."""
        return self.motor is not None and self.motor.field_speed is not None

    @property
    def rotor_loss_per_turn(self):
        """Energy that an induction motor loses in its rotor by slip in a turn, J."""
        return self.air_gap_energy_per_turn - self.energy_per_turn

    @property
    def mean_power(self):
        """Mean over time of the motor's power at its shaft, W."""
        return self.energy_per_turn * self.turns / self.duration

    @cached_property
    def rms_motor_torque(self):
        """Root of the mean over time of the square of the motor's torque at its shaft, N m: what heats it."""
        square = self._motor_torque(self._speed) ** 2
        return math.sqrt(self._pieces.total(square / np.abs(self._speed)) / self.duration)

    @cached_property
    def rms_power(self):
        """Root of the mean over time of the square of the motor's power, W."""
        return math.sqrt(self._pieces.total(self._powers**2 / np.abs(self._speed)) / self.duration)

    @cached_property
    def peak_power(self):
        """Largest power of the motor, with its sign, W."""
        return self._pieces.peak(self._powers)

    @cached_property
    def peak_motor_torque(self):
        """Largest torque of the motor at its shaft, with its sign, N m."""
        return self._pieces.peak(self._motor_torque(self._speed))

    @cached_property
    def load_energy_per_turn(self):
        """Energy that weight and loads take of the crank in a turn, friction left out, J."""
        return self._pieces.total(self._driven.unrubbed(self._pieces.angle, self._speed).torque) * self._forward

    @property
    def friction_energy_per_turn(self):
        """Energy that friction takes at all joints in a turn, J."""
        return sum(self.friction_energy_per_turn_at(joint) for joint in self.scene.friction)

    def friction_energy_per_turn_at(self, joint):
        """Energy that friction takes at a joint, named as in `friction`, in a turn, J; 0 where nothing rubs."""
        lost = self._at_points.friction_loss_at(joint).reshape(self._speed.shape)
        return self._pieces.total(lost / self._speed) * self._forward

    @property
    def mean_friction_loss(self):
        """Mean over time of the power lost by friction at all joints, W."""
        return self.friction_energy_per_turn * self.turns / self.duration

    def mean_friction_loss_at(self, joint):
        """Mean over time of the power lost by friction at a joint, W."""
        return self.friction_energy_per_turn_at(joint) * self.turns / self.duration
