"""Tables of designs: goal, parameters that vary, limits.

Outputs, limits and bounds stay texts, because the variant decides which names exist; `casefile.designs` checks them.
"""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...numbers.units import quoted
from .tables import Table, must_describe, one_of
from .texts import Angle, Coordinate, Mass, pair_of

Count = Annotated[int, Field(strict=True, ge=1, le=1000)]
Terms = Annotated[int, Field(strict=True, ge=0, le=64)]
Seed = Annotated[int, Field(strict=True, ge=0)]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]


def _bounds(value):
    if not isinstance(value, list) or len(value) != 2 or not all(isinstance(part, str) for part in value):
        raise ValueError(f'must be a pair of texts with units, ["600 kN/m", "900 kN/m"], found {quoted(value)}')
    return tuple(value)


Bounds = Annotated[tuple[str, str], BeforeValidator(_bounds)]
Vary = Annotated[dict[str, Bounds], Field(min_length=1)]


class RobustTable(Table):
    """Goal over a spread of parameters: the quantile of an output; keys are the arguments of `ks.design.Spread`."""

    quantile: Number
    """Quantile of the output, between 0 and 1."""
    spreads: dict[str, str]
    """Spread of each parameter, as in [tolerances], by its path."""
    samples: Count = 256
    """Number of machines sampled in the search; a power of two."""
    trim: Number = 0.0
    """Largest adjustment of the crank speed, relative to it; each sampled machine runs at its best speed within it."""
    seed: Seed = 0
    """Seed of the sampled machines."""

    @property
    def spread(self):
        """The spread described by the table, a `ks.design.Spread`."""
        from ...design.robust import Spread

        return Spread(**dict(self))

    _check = must_describe("spread")


class DesignTable(Table):
    """Keys common to every design."""

    variant: str | None = None
    """Variant whose parameters vary; by default the only one, or the first besides the reference."""
    reference: str | None = None
    """Reference of ratios; by default the reference of the variant."""
    limits: tuple[str, ...] = ()
    """Limits of outputs; the search keeps them at the exact extremes."""
    starts: Count = 1
    """Number of searches; the first begins at the variant itself."""
    seed: Seed = 0
    """Seed of the random starts of the other searches."""


class SearchTable(DesignTable):
    """Keys of searches for any machine."""

    vary: Vary
    """Lowest and highest value, by path."""
    duties: dict[str, Number] | None = None
    """Share of the time by variant: outputs are weighted means; a limit applies to each, or to the one it names."""
    angles: Annotated[int, Field(strict=True, ge=12, le=100_000)] = 720
    """Crank angles over the period."""

    @model_validator(mode="after")
    def _variant_or_duties(self):
        if self.variant is not None and self.duties is not None:
            raise ValueError("has variant and duties: give one of them")
        return self


class OptimumTable(SearchTable):
    """Any machine with its best output within bounds and limits."""

    kind: Literal["optimum"]
    """Any machine with its best output within bounds and limits."""
    minimise: str | None = None
    """Output to minimise."""
    maximise: str | None = None
    """Output to maximise, instead of `minimise`."""
    robust: RobustTable | None = None
    """Goal: the quantile of the output over a spread of parameters."""

    @model_validator(mode="after")
    def _one_aim(self):
        if (self.minimise is None) == (self.maximise is None):
            raise ValueError('needs either minimise or maximise, an output such as "largest O"')
        return self


class TorqueFreeCamTable(DesignTable):
    """A cam-balanced crank-slider; by default with the smallest mean magnitude of its torque."""

    kind: Literal["torque-free-cam"]
    """A cam-balanced crank-slider with the least torque."""
    cosine: Annotated[int, Field(strict=True, ge=1, le=64)] = 8
    """Cosine terms of the cam."""
    sine: Terms = 0
    """Sine terms of the cam."""
    vary: dict[str, Bounds] = Field(default_factory=dict)
    """Bounds (lowest, highest), by path, of further parameters or instead of the default ones."""
    minimise: str | None = None
    """Output to minimise; by default the mean magnitude of the torque."""
    maximise: str | None = None
    """Output to maximise, instead of `minimise`."""
    robust: RobustTable | None = None
    """Goal: the quantile of the output over a spread of parameters."""
    ends: Annotated[tuple[float, float] | None, BeforeValidator(pair_of("m"))] = None
    """Extreme positions of the slider; by default as in the variant."""
    guide_offset: Coordinate | None = None
    """Distance of the guide from O; by default as in the variant."""
    coupler_spring: Angle | None = None
    """Free angle of a torsion spring between coupler and slider that carries the coupler's weight."""
    counterweight: Mass | None = None
    """Mass on the crank; the search finds its place and the offset of the guide."""
    cubic: Annotated[tuple[float, float] | None, BeforeValidator(pair_of("N/m^3"))] = None
    """Bounds of the spring's cubic term; without them the spring is linear."""

    @model_validator(mode="after")
    def _one_aim_at_most(self):
        if self.minimise is not None and self.maximise is not None:
            raise ValueError("has minimise and maximise: give one of them, or none")
        return self


class FrontTable(SearchTable):
    """Designs on the Pareto front of two outputs."""

    kind: Literal["front"]
    """Designs on the Pareto front of two outputs."""
    minimise: Annotated[tuple[str, ...], Field(min_length=2, max_length=2)]
    """The two outputs; a "-" before one maximises it."""
    points: Annotated[int, Field(strict=True, ge=2, le=100)] = 9
    """Number of designs on the front."""


KINDS = {"optimum": OptimumTable, "torque-free-cam": TorqueFreeCamTable, "front": FrontTable}


class OneDesign(Table):
    """One design of the kind in its key `kind`."""

    design: one_of("design", KINDS)  # type: ignore[valid-type]
