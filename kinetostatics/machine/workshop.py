"""A cam for the workshop: table (.csv), drawing 1:1 (.svg) and .dxf of its curves, each written whole or not at all."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import FileError, MissingLibraryError
from ..numbers import checks
from ..numbers.files import unwritable, written_whole
from ..numbers.lazy import cached_property
from .profile import POSITIVE, SIDES, Profile, profile

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
"""Metres in each unit of what is written."""
DXF_UNITS = {"mm": 4, "cm": 5, "m": 6, "in": 1}
MOST_POINTS = 100_000


@dataclass(frozen=True, eq=False)
class Sheet:
    """What is written of a cam: its profile, the cutter, the unit and the sense of rotation."""

    made: Profile
    cutter_radius: float | None
    units: str
    clockwise: bool

    @cached_property
    def paths(self):
        """Points (2, N) by the name of each curve, m, the cutter's where there is one."""
        found = {"pitch": self.made.pitch, "surface": self.made.surface}
        if self.cutter_radius is not None:
            found["cutter"] = self.made.cutter_path(self.cutter_radius)
        return found

    @cached_property
    def curves(self):
        """The same in the unit."""
        return {name: self.measured(points) for name, points in self.paths.items()}

    def measured(self, length):
        """A length in m in the unit."""
        return length / UNITS[self.units]

    def written(self, length):
        """A length in m as text with the unit."""
        return f"{self.measured(length):.6g} {self.units}"

    @property
    def radius(self):
        """Radius of the pitch curve at each point, m."""
        return np.hypot(*self.made.pitch)

    @property
    def sense(self):
        return "clockwise" if self.clockwise else "counter-clockwise"

    @property
    def notes(self):
        """What the workshop must know, as lines."""
        made, sharpest, hollow = self.made, self.made.smallest_curvature_radius, self.made.smallest_hollow
        cutter = "" if self.cutter_radius is None else f", cutter radius {self.written(self.cutter_radius)}"
        lines = [
            f"cam for the workshop: {made.side}, roller radius {self.written(made.roller_radius)}{cutter}, "
            f"{made.crank_angle.size} points",
            f"crank angles counter-clockwise from the zero mark, the +x axis; the roller goes around {self.sense}",
            f"largest pressure angle {np.degrees(made.largest_pressure_angle.value):.4g} deg at "
            f"{np.degrees(made.largest_pressure_angle.angle):.4g} deg",
            "sharpest part of the working curve: "
            + ("none convex" if sharpest is None else f"radius {self.written(sharpest.value)}")
            + ("" if hollow is None else f"; tightest hollow: radius {self.written(-hollow.value)}"),
        ]
        error = getattr(made.cam, "force_error", None)
        if error is not None:
            lines.append(f"from a measured table: forces are uncertain by {error:.2g} of the largest")
        return lines


def export(cam, path, roller_radius, cutter_radius, points, units, side, clockwise):
    """Write a cam; what ``cam.export`` does, where it is told."""
    radii = {"roller_radius": roller_radius} | ({} if cutter_radius is None else {"cutter_radius": cutter_radius})
    found = checks.singles(
        "cam export",
        _points_problem(points),
        checks.choice("units", units, tuple(UNITS)),
        checks.choice("side", side, tuple(SIDES)),
        checks.truth("clockwise", clockwise),
        None if isinstance(path, str | Path) else f"path must be the name of a file, got {checks.shown(path)}",
        **{name: (radius, "m", POSITIVE) for name, radius in radii.items()},
    )
    problem = unwritable(path, endings=tuple(WRITERS))
    if problem or Path(path).suffix.lower() not in WRITERS:
        raise FileError(problem or checks.choice(f"{path}: the ending", Path(path).suffix, tuple(WRITERS)))
    made = profile(cam, found["roller_radius"], int(points), side)
    sheet = Sheet(made, found.get("cutter_radius"), units, clockwise)
    with written_whole(path) as temporary:
        WRITERS[Path(path).suffix.lower()](sheet, temporary)


def _points_problem(points):
    wrong = checks.count("points", points)
    if wrong or 8 <= points <= MOST_POINTS:
        return wrong
    return f"points must be from 8 to {MOST_POINTS}, got {points}"


def _to_csv(sheet, path):
    """Roller centres, working curve and cutter; the first two columns are what ``Sampled.from_csv`` reads."""
    unit = sheet.units
    columns = {"angle [deg]": np.degrees(sheet.made.crank_angle), f"radius [{unit}]": sheet.measured(sheet.radius)}
    names = {"pitch": "roller", "surface": "surface", "cutter": "cutter"}
    for name, points in sheet.curves.items():
        columns |= {f"{names[name]}_{axis} [{unit}]": part for axis, part in zip("xy", points, strict=True)}
    columns["pressure_angle [deg]"] = np.degrees(sheet.made.pressure_angle)
    columns[f"curvature_radius [{unit}]"] = sheet.measured(sheet.made.curvature_radius)
    rows = zip(*(part.tolist() for part in columns.values()), strict=True)
    lines = [*(f"# {note}" for note in sheet.notes), ", ".join(columns), *(", ".join(map(repr, row)) for row in rows)]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


LAYERS = {"surface": ("SURFACE", 7), "pitch": ("PITCH", 1), "cutter": ("CUTTER", 3)}
"""Layer and colour of each curve."""


def _to_dxf(sheet, path):
    """Closed polylines of the curves, the roller at the zero mark, O, and notes, each on a layer of its own."""
    try:
        import ezdxf
    except ImportError:
        raise MissingLibraryError(
            'a .dxf needs ezdxf, which is not installed: pip install "kinetostatics[workshop]"; .csv and .svg work '
            "without"
        ) from None
    drawing = ezdxf.new("R2010", units=DXF_UNITS[sheet.units])
    space = drawing.modelspace()
    for name, points in sheet.curves.items():
        layer, colour = LAYERS[name]
        drawing.layers.add(layer, color=colour)
        space.add_lwpolyline(points.T.tolist(), close=True, dxfattribs={"layer": layer})
    drawing.layers.add("NOTES", color=5)
    notes = {"layer": "NOTES"}
    x, y = sheet.measured(np.array(sheet.made.pitch[:, 0])).tolist()
    reach, roller = float(np.hypot(x, y)), sheet.measured(sheet.made.roller_radius)
    space.add_circle((x, y), roller, dxfattribs=notes)
    space.add_line((0.0, 0.0), (1.2 * x, 1.2 * y), dxfattribs=notes)
    space.add_point((0.0, 0.0), dxfattribs=notes)
    size = reach / 25
    turn = np.radians(np.linspace(10.0, 60.0, 26) * (-1.0 if sheet.clockwise else 1.0))
    arc = 0.4 * reach * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    ahead = (arc[-1] - arc[-2]) / np.hypot(*(arc[-1] - arc[-2])) * size
    beside = np.array([-ahead[1], ahead[0]]) / 3
    space.add_lwpolyline(arc.tolist(), dxfattribs=notes)
    space.add_lwpolyline(
        [arc[-1] - ahead + beside, arc[-1], arc[-1] - ahead - beside],
        dxfattribs=notes,
    )
    space.add_text("0", height=size, dxfattribs=notes).set_placement((1.22 * x, 1.22 * y))
    low = float(min(points.min() for points in sheet.curves.values()))
    for number, note in enumerate(sheet.notes):
        space.add_text(note, height=0.6 * size, dxfattribs=notes).set_placement((low, low - (3 + number) * size))
    drawing.saveas(path)


def _to_svg(sheet, path):
    from .drawing import drawn

    Path(path).write_text(drawn(sheet), encoding="utf-8")


WRITERS = {".csv": _to_csv, ".dxf": _to_dxf, ".svg": _to_svg}
