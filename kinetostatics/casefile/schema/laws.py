"""Laws of followers in a case file: those of `ks.laws`, with positions in m, of a swinging follower in rad."""

from functools import partial
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from ...errors import KinetostaticsError
from ...machine.laws import laws
from ...numbers.units import to_si
from .tables import Table, list_of, one_of
from .texts import Angle


def _position(text):
    """A text that is a length or an angle, depending on the group."""
    try:
        to_si(text, "rad")
    except ValueError:
        to_si(text, "m")
    return text


Position = Annotated[str, BeforeValidator(_position)]
POSITIONS = ("amplitude", "mean", "start", "end", "position", "noise")
"""Keys of positions."""


class LawTable(Table):
    kind: str

    def law(self, unit) -> Any:
        """Law or segment with positions in this unit; for a file, the function of its columns that returns the law."""
        return getattr(laws, self.kind.replace(" ", "_"))(**self.values(unit))

    def values(self, unit):
        """Values by key, without the kind, with positions in the SI unit."""
        try:
            return {
                name: to_si(value, unit) if name in POSITIONS and value is not None else value
                for name, value in self
                if name != "kind"
            }
        except ValueError as error:
            raise KinetostaticsError(f"cam: {self.kind}: a position {error}") from None


class SegmentCurveTable(LawTable):
    kind: Literal["harmonic", "cycloidal", "modified sine", "modified trapezoid"]
    """Standard curve."""
    start: Position
    """Position at its start; a length, or for a swinging follower an angle."""
    end: Position
    """Position at its end."""
    angle: Angle
    """Crank angle of the segment."""


class SegmentPolynomialTable(SegmentCurveTable):
    kind: Literal["polynomial"]  # type: ignore[assignment]
    """Polynomial between the same positions."""
    powers: Literal["3-4-5", "4-5-6-7"] | tuple[int, ...] = "3-4-5"
    """Powers of the polynomial."""


class SegmentDwellTable(LawTable):
    kind: Literal["dwell"]
    """Rest."""
    position: Position
    """Where it rests."""
    angle: Angle
    """Crank angle of the segment."""


CURVES = dict.fromkeys(("harmonic", "cycloidal", "modified sine", "modified trapezoid"), SegmentCurveTable)
Segment = one_of("segment", CURVES | {"polynomial": SegmentPolynomialTable, "dwell": SegmentDwellTable})


class LawCosineTable(LawTable):
    kind: Literal["cosine"]
    """A cosine of the crank angle."""
    amplitude: Position
    """Half the stroke; a length, or for a swinging follower an angle."""
    mean: Position
    """Position at mid-stroke."""
    phase: Angle = 0.0
    """Crank angle of the farthest position."""


class LawJoinedTable(LawTable):
    kind: Literal["joined"]
    """Segments in sequence that together fill one turn."""
    segments: list_of(Segment, "segments", 1)  # type: ignore[valid-type]
    """A table for each segment, in their order."""
    smooth: Literal["acceleration", "velocity"] = "acceleration"
    """Highest derivative that must not jump between segments."""

    def law(self, unit):
        return laws.joined(*(segment.law(unit) for segment in self.segments), smooth=self.smooth)


class LawFileTable(LawTable):
    kind: Literal["table"]
    """A smooth curve through points."""
    table: str
    """CSV file of crank angle and position."""
    noise: Position | None = None
    """Standard deviation of the positions, for smoothing; without it the curve passes through all of them."""

    def law(self, unit):
        return partial(laws.table, noise=self.values(unit)["noise"])


Law = one_of("law", {"cosine": LawCosineTable, "joined": LawJoinedTable, "table": LawFileTable})
