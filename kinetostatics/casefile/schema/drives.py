"""Tables of drives: motors by their kinds, and flywheels; keys are the arguments of `Motor`.

Their numbers carry no unit by which `parameters` would find them: what designs vary is looked at at constant speed.
"""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...drive.motor import Motor
from ...errors import ParameterError
from ...numbers.units import shown, to_si
from .tables import Table, one_of
from .texts import reader

Factor = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Power = Annotated[float, BeforeValidator(reader("W", low=0.0, strict=True))]
MotorSpeed = Annotated[float, BeforeValidator(reader("rad/s", low=0.0, strict=True))]
StandstillTorque = Annotated[float, BeforeValidator(reader("N m", low=0.0, strict=True))]
Torque = Annotated[float, BeforeValidator(reader("N m"))]
Turning = Annotated[float, BeforeValidator(reader("kg m^2", low=0.0))]


def _row(unit):
    """Type of a list of texts with units."""

    def read(value):
        if not isinstance(value, list) or not value:
            raise ValueError(f'must be a list such as ["0 {unit}", "1 {unit}"], found {shown(value)}')
        return tuple(to_si(part, unit) for part in value)

    return Annotated[tuple[float, ...] | None, BeforeValidator(read)]


class MotorTable(Table):
    """Keys common to every motor."""

    transmission: Factor = 1.0
    inertia: Turning = 0.0

    @property
    def motor(self) -> Motor:
        """The motor that it describes."""
        arguments = dict(self)
        return getattr(Motor, arguments.pop("kind"))(**arguments)

    @model_validator(mode="after")
    def _a_motor(self):
        try:
            self.motor  # noqa: B018
        except ParameterError as error:
            raise ValueError(f"is no motor: {str(error).partition(': ')[2]}") from None
        return self


class KlossTable(MotorTable):
    kind: Literal["kloss"]
    power: Power
    speed: MotorSpeed
    synchronous_speed: MotorSpeed
    overload: Factor


class LinearTable(MotorTable):
    kind: Literal["linear"]
    torque: StandstillTorque
    speed: MotorSpeed


class ConstantTable(MotorTable):
    kind: Literal["constant"]
    torque: Torque


class TorqueTable(MotorTable):
    """Torque over speed, in rows here or in columns of a CSV file."""

    kind: Literal["table"]
    speed: _row("rad/s") = None  # type: ignore[valid-type]
    torque: _row("N m") = None  # type: ignore[valid-type]
    file: str | None = None

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
    flywheel: Turning = 0.0
