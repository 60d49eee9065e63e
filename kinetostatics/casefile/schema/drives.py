"""Tables of drives: motors by kind, and flywheels; keys are the arguments of `Motor`.

Their types have no SI unit, so designs do not vary them: a variant is solved at constant speed.
"""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from ...drive.motor import Motor
from .tables import Table, must_describe, one_of
from .texts import reader, series_of

Factor = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Power = Annotated[float, BeforeValidator(reader("W", low=0.0, strict=True))]
MotorSpeed = Annotated[float, BeforeValidator(reader("rad/s", low=0.0, strict=True))]
StandstillTorque = Annotated[float, BeforeValidator(reader("N m", low=0.0, strict=True))]
Torque = Annotated[float, BeforeValidator(reader("N m"))]
MomentOfInertia = Annotated[float, BeforeValidator(reader("kg m^2", low=0.0))]


def _row_type(unit):
    """Type of a list of texts with units."""
    return Annotated[tuple[float, ...] | None, BeforeValidator(series_of(unit, "0", "1", 1))]


class MotorTable(Table):
    """Keys common to every motor."""

    transmission: Factor = 1.0
    """Motor speed over crank speed; negative if they turn in opposite directions."""
    inertia: MomentOfInertia = 0.0
    """Moment of inertia of the rotor, at its own shaft."""

    @property
    def motor(self) -> Motor:
        """The motor described by the table."""
        arguments = dict(self)
        return getattr(Motor, arguments.pop("kind"))(**arguments)

    _check = must_describe("motor")


class KlossTable(MotorTable):
    kind: Literal["kloss"]
    """An induction motor by Kloss's formula."""
    power: Power
    """Rated power at the shaft."""
    speed: MotorSpeed
    """Rated speed of the motor's shaft."""
    synchronous_speed: MotorSpeed
    """Without load."""
    overload: Factor
    """Breakdown torque over rated torque."""


class LinearTable(MotorTable):
    kind: Literal["linear"]
    """A torque that falls linearly with speed."""
    torque: StandstillTorque
    """At rest."""
    speed: MotorSpeed
    """Without torque."""


class ConstantTable(MotorTable):
    kind: Literal["constant"]
    """The same torque at every speed."""
    torque: Torque
    """Torque at the motor's shaft."""


class TorqueTable(MotorTable):
    """Torque over speed, in rows here or in columns of a CSV file."""

    kind: Literal["table"]
    """Torque over speed, by rows."""
    speed: _row_type("rad/s") = None  # type: ignore[valid-type]
    """Speeds of the motor's shaft, a list of texts."""
    torque: _row_type("N m") = None  # type: ignore[valid-type]
    """Torques at the motor's shaft, a list of texts."""
    file: str | None = None
    """CSV file with columns speed and torque, instead of the rows."""

    @property
    def motor(self):
        return None if self.file is not None else self.of(self.speed, self.torque)

    def of(self, speed, torque):
        """The motor with rows of speed, rad/s, and torque, N m."""
        return Motor.table(speed, torque, transmission=self.transmission, inertia=self.inertia)

    @model_validator(mode="before")
    @classmethod
    def _rows_or_a_file(cls, raw):
        rows = [key for key in ("speed", "torque") if key in raw]
        if "file" in raw and rows:
            raise ValueError(f"has a file and {' and '.join(rows)}: give either rows here or a CSV file")
        if "file" not in raw and len(rows) < 2:
            raise ValueError("needs speed and torque, lists of texts, or file, a CSV with columns speed and torque")
        return raw


MotorOfKind: Any = one_of(
    "motor", {"kloss": KlossTable, "linear": LinearTable, "constant": ConstantTable, "table": TorqueTable}
)


class DriveTable(Table):
    """A motor, and a flywheel on the crank."""

    motor: MotorOfKind
    """The motor."""
    flywheel: MomentOfInertia = 0.0
    """Moment of inertia on the crank, in addition to its link."""
    _raw: dict = PrivateAttr(default_factory=dict)

    @property
    def raw(self):
        """The table as the file has it."""
        return self._raw

    @model_validator(mode="wrap")
    @classmethod
    def _keep_raw(cls, raw, validated):
        found = validated(raw)
        if isinstance(raw, dict):
            found._raw = raw
        return found
