"""Laws of followers in a case file: those of `ks.laws`, with positions in m, of a swinging follower in rad."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from ...errors import KinetostaticsError
from ...machine.laws import laws
from ...numbers.units import to_si
from .tables import Table, list_of, one_of
from .texts import Angle


def _position(text):
    """A text that is a length or an angle; which of them tells the group."""
    try:
        to_si(text, "rad")
    except ValueError:
        to_si(text, "m")
    return text


Position = Annotated[str, BeforeValidator(_position)]


class LawTable(Table):
    def law(self, unit) -> Any:
        """Law with positions in this unit; of one in a file, its function of angles and positions."""

    def si(self, name, unit):
        """Position of a key in the SI unit."""
        try:
            return to_si(getattr(self, name), unit)
        except ValueError as error:
            raise KinetostaticsError(f"cam: {name} {error}") from None


class SegmentCurveTable(LawTable):
    kind: Literal["harmonic", "cycloidal", "modified sine", "modified trapezoid"]
    """Standard curve."""
    start: Position
    """Position at its start; a length, of a swinging follower an angle."""
    end: Position
    """Position at its end."""
    angle: Angle
    """Crank angle that it takes."""

    def law(self, unit):
        make = getattr(laws, self.kind.replace(" ", "_"))
        return make(self.si("start", unit), self.si("end", unit), self.angle)


class SegmentPolynomialTable(LawTable):
    kind: Literal["polynomial"]
    """Polynomial."""
    start: Position
    """Position at its start."""
    end: Position
    """Position at its end."""
    angle: Angle
    """Crank angle that it takes."""
    powers: Literal["3-4-5", "4-5-6-7"] | tuple[int, ...] = "3-4-5"
    """Of the polynomial."""

    def law(self, unit):
        return laws.polynomial(self.si("start", unit), self.si("end", unit), self.angle, self.powers)


class SegmentDwellTable(LawTable):
    kind: Literal["dwell"]
    """Rest."""
    position: Position
    """Where it rests."""
    angle: Angle
    """Crank angle that it takes."""

    def law(self, unit):
        return laws.dwell(self.si("position", unit), self.angle)


CURVES = dict.fromkeys(("harmonic", "cycloidal", "modified sine", "modified trapezoid"), SegmentCurveTable)
Segment = one_of("segment", CURVES | {"polynomial": SegmentPolynomialTable, "dwell": SegmentDwellTable})


class LawCosineTable(LawTable):
    kind: Literal["cosine"]
    """A cosine of the crank angle."""
    amplitude: Position
    """Half the stroke; a length, of a swinging follower an angle."""
    mean: Position
    """Position at mid-stroke."""
    phase: Angle = 0.0
    """Crank angle of the farthest position."""

    def law(self, unit):
        return laws.cosine(self.si("amplitude", unit), self.si("mean", unit), self.phase)


class LawJoinedTable(LawTable):
    kind: Literal["joined"]
    """Segments one after the other, which together take a turn."""
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
    """Standard deviation of the positions, which smooths them; without, the curve runs through all of them."""

    def law(self, unit):
        noise = None if self.noise is None else self.si("noise", unit)
        return lambda angle, position: laws.table(angle, position, noise)


Law = one_of("law", {"cosine": LawCosineTable, "joined": LawJoinedTable, "table": LawFileTable})
