"""Tables of designs: what is to be found, what varies, and what must hold.

Outputs, limits and bounds stay texts here: what they name depends on the variant, so `designs` reads them.
"""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...design.spread import Spread
from ...errors import ParameterError
from ...numbers.units import shown
from .tables import Table, one_of
from .texts import Angle, Coordinate, Mass, pair_of

Count = Annotated[int, Field(strict=True, ge=1, le=1000)]
Terms = Annotated[int, Field(strict=True, ge=0, le=64)]
Seed = Annotated[int, Field(strict=True, ge=0)]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]


def _bounds(value):
    if not isinstance(value, list) or len(value) != 2 or not all(isinstance(part, str) for part in value):
        raise ValueError(f'must be a pair of texts with units, ["600 kN/m", "900 kN/m"], found {shown(value)}')
    return tuple(value)


Bounds = Annotated[tuple[str, str], BeforeValidator(_bounds)]
Vary = Annotated[dict[str, Bounds], Field(min_length=1)]


class RobustTable(Table):
    """A quantile over how numbers spread, keys as of `ks.design.Spread`."""

    quantile: Number
    spreads: dict[str, str]
    samples: Count = 256
    trim: Number = 0.0
    seed: Seed = 0

    @property
    def spread(self) -> Spread:
        """The spread that it describes."""
        return Spread(**dict(self))

    @model_validator(mode="after")
    def _a_spread(self):
        try:
            self.spread  # noqa: B018
        except ParameterError as error:
            raise ValueError(f"is no spread: {str(error).partition(': ')[2]}") from None
        return self


class DesignTable(Table):
    """Keys common to every design."""

    variant: str | None = None
    reference: str | None = None
    limits: tuple[str, ...] = ()
    starts: Count = 1
    seed: Seed = 0


class OptimumTable(DesignTable):
    """The best of any machine within bounds and limits."""

    kind: Literal["optimum"]
    vary: Vary
    minimise: str | None = None
    maximise: str | None = None
    robust: RobustTable | None = None
    angles: Annotated[int, Field(strict=True, ge=12, le=100_000)] = 720

    @model_validator(mode="after")
    def _one_aim(self):
        if (self.minimise is None) == (self.maximise is None):
            raise ValueError('needs either minimise or maximise, an output such as "largest O"')
        return self


class TorqueFreeCamTable(DesignTable):
    """A cam-balanced crank-slider; the mean magnitude of its torque is made least unless told."""

    kind: Literal["torque-free-cam"]
    cosine: Annotated[int, Field(strict=True, ge=1, le=64)] = 8
    sine: Terms = 0
    vary: dict[str, Bounds] = Field(default_factory=dict)
    minimise: str | None = None
    maximise: str | None = None
    robust: RobustTable | None = None
    ends: Annotated[tuple[float, float] | None, BeforeValidator(pair_of("m"))] = None
    guide_offset: Coordinate | None = None
    coupler_spring: Angle | None = None
    counterweight: Mass | None = None
    cubic: Annotated[tuple[float, float] | None, BeforeValidator(pair_of("N/m^3"))] = None

    @model_validator(mode="after")
    def _one_aim_at_most(self):
        if self.minimise is not None and self.maximise is not None:
            raise ValueError("has minimise and maximise: give one of them, or none")
        return self


class FrontTable(DesignTable):
    """The best of one output for each value of another."""

    kind: Literal["front"]
    vary: Vary
    minimise: Annotated[tuple[str, ...], Field(min_length=2, max_length=2)]
    points: Annotated[int, Field(strict=True, ge=2, le=100)] = 9
    angles: Annotated[int, Field(strict=True, ge=12, le=100_000)] = 720


KINDS = {"optimum": OptimumTable, "torque-free-cam": TorqueFreeCamTable, "front": FrontTable}


class OneDesign(Table):
    """One design; its key `kind` tells which."""

    design: one_of("design", KINDS)  # type: ignore[valid-type]
