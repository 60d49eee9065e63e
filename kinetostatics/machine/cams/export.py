"""Files of a cam for the workshop: table (.csv), drawing 1:1 (.svg) and .dxf, each written whole or not at all.

All three hold the pitch curve, the working curve, the path of a cutter and the notes of a `Sheet`.
"""

from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np

from ...errors import FileError, MissingLibraryError
from ...numbers import checks
from ...numbers.files import write_atomically, write_problem
from ...numbers.lazy import cached_property
from .profile import POSITIVE, SIDE_SIGNS, Profile, flat_face_problem, profile

MM_PER_M = 1000.0
"""Millimetres in a metre; the drawing is in mm, so that it prints one to one."""
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
"""Metres in each unit of a file."""
DECIMALS = {"mm": 6, "cm": 7, "m": 9, "in": 8, "deg": 6}
"""Decimals of a table in each unit: a length to a nanometre."""
MORE_DECIMALS = 6
"""Further decimals of the angle and the radius, which `Sampled.from_csv` reads: their second differences are forces."""
DXF_UNITS = {"mm": 4, "cm": 5, "m": 6, "in": 1}
MAX_POINTS = 100_000
STYLES = {
    "surface": ("cam", "surface", "SURFACE", 7),
    "pitch": ("pitch", "roller", "PITCH", 1),
    "cutter": ("cutter", "cutter", "CUTTER", 3),
}
"""CSS class, heading of columns, layer and colour of each curve, in the order of drawing."""
RIM_RATIO = 1.12
"""Radius of a ring's material, relative to the largest distance of its working curve from the middle."""
ANCHORS = ("end", "middle", "start")
"""Anchor of a text: the text is left of its place, centred, or right of it."""
SVG_STYLE = (
    "path,line,circle{fill:none;stroke:#222;stroke-width:.25}"
    ".cam{stroke-width:.6;fill:#e8edf2}.hole{stroke-width:.6;fill:#fff}"
    ".pitch{stroke:#c22;stroke-width:.3;stroke-dasharray:8 1.5 1 1.5}"
    ".cutter{stroke:#282;stroke-width:.3;stroke-dasharray:3 1.5}"
    ".axis{stroke-dasharray:10 1.5 1 1.5;stroke-width:.18}.thin{stroke-width:.18}"
    "text{font-family:sans-serif;fill:#222;paint-order:stroke;stroke:#fff;stroke-width:.6}.tip{fill:#222;stroke:none}"
)


@dataclass(frozen=True, eq=False)
class Sheet:
    """Content of a file: profile of the cam, cutter radius (m), unit and sense of rotation."""

    profile: Profile
    cutter_radius: float | None
    units: str
    clockwise: bool

    @cached_property
    def paths(self):
        """Points of each curve by name, (2, N), m."""
        found = {"pitch": self.profile.pitch, "surface": self.profile.surface}
        if self.cutter_radius is not None:
            found["cutter"] = self.profile.cutter_path(self.cutter_radius)
        return found

    def in_unit(self, length):
        """A length, m, in the unit of the file."""
        return length / UNITS[self.units]

    def length_text(self, length):
        """A length, m, as text with the unit of the file."""
        return f"{self.in_unit(length):.6g} {self.units}"

    @property
    def radius(self):
        """Radius of the pitch curve at each point, m."""
        return np.hypot(*self.profile.pitch)

    @property
    def sense(self):
        return "clockwise" if self.clockwise else "counter-clockwise"

    @property
    def follower(self):
        """Part that goes around the cam."""
        return "face" if self.profile.cam.flat else "roller"

    def sense_arc(self, degrees, radius):
        """Points (2, N) of an arc about O in the sense in which the follower goes around."""
        turn = np.radians((-1.0 if self.clockwise else 1.0) * degrees)
        return radius * np.stack([np.cos(turn), np.sin(turn)])

    @property
    def notes(self):
        """Lines of notes for the workshop."""
        profile, sharpest, hollow = self.profile, self.profile.smallest_curvature_radius, self.profile.smallest_hollow
        cutter = "" if self.cutter_radius is None else f", cutter radius {self.length_text(self.cutter_radius)}"
        touch = "flat face" if profile.cam.flat else f"roller radius {self.length_text(profile.roller_radius)}"
        lines = [
            f"cam for the workshop: {profile.side}, {touch}{cutter}, {profile.crank_angle.size} points",
            "crank angles counter-clockwise from the zero mark, the +x axis; "
            f"the {self.follower} goes around {self.sense}",
            "sharpest part of the working curve: "
            + ("none convex" if sharpest is None else f"radius {self.length_text(sharpest.value)}")
            + ("" if hollow is None else f"; tightest hollow: radius {self.length_text(-hollow.value)}"),
        ]
        if not profile.cam.flat:
            steepest, angle = map(np.degrees, profile.largest_pressure_angle)
            lines.insert(2, f"largest pressure angle {steepest:.4g} deg at {angle:.4g} deg")
        error = getattr(profile.cam, "force_error", None)
        if error is not None:
            lines.append(f"from a measured table: forces are uncertain by {error:.2g} of the largest")
        return lines


def arrow_head(point, direction, size, slenderness):
    """Points of an arrow's head: one corner, the tip, the other corner."""
    ahead = np.asarray(direction) / np.hypot(*direction) * size
    beside = np.array([-ahead[1], ahead[0]]) / slenderness
    return point - ahead + beside, point, point - ahead - beside


class SvgDrawing:
    """SVG drawing of a sheet, in mm with y upward; the file has y downward."""

    def __init__(self, sheet):
        self.sheet, self.items = sheet, []
        self.radius = MM_PER_M * sheet.radius
        self.curves = {name: MM_PER_M * points for name, points in sheet.paths.items()}
        self.roller = MM_PER_M * sheet.profile.roller_radius
        every = np.concatenate(list(self.curves.values()), axis=1)
        self.low, self.high = every.min(axis=1) - self.roller, every.max(axis=1) + self.roller
        self.rim = None  # centre and radius of the material of a ring
        if sheet.profile.side == "ring":
            middle = 0.5 * (every.min(axis=1) + every.max(axis=1))
            self.rim = middle, RIM_RATIO * float(np.max(np.hypot(*(self.curves["surface"].T - middle).T)))
            self.low, self.high = (
                np.minimum(self.low, middle - self.rim[1]),
                np.maximum(self.high, middle + self.rim[1]),
            )
        self.size = max(2.5, float(np.max(self.high - self.low)) / 110.0)

    def text(self):
        """Text of the SVG file."""
        size = self.size
        self._draw_cam()
        self._draw_dimensions()
        notes = [*self.sheet.notes, "scale 1:1, print without scaling; the bar is 100 mm"]
        x, top = self.low - [4 * size, 10 * size]
        bottom = top - 1.6 * size * len(notes)
        for number, note in enumerate(notes):
            self._words((x, top - 1.6 * size * number), note)
        self._line((x, bottom), (x + 100.0, bottom))
        for end in (x, x + 100.0):
            self._line((end, bottom - size / 2), (end, bottom + size / 2))
        right = max(self.high[0] + 20 * size, x + 0.55 * size * max(map(len, notes)))
        left, up = x - 2 * size, self.high[1] + 8 * size
        width, height = right - x + 4 * size, up - bottom + 3 * size
        header = [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.6g}mm" height="{height:.6g}mm" '
            f'viewBox="{left:.6g} {-up:.6g} {width:.6g} {height:.6g}">',
            f"<title>{escape(self.sheet.notes[0])}</title>",
            f"<style>{SVG_STYLE}</style>",
        ]
        return "\n".join([*header, *self.items, "</svg>", ""])

    def _draw_cam(self):
        """The curves, with the material of a disk inside its working curve, of a ring outside; axes, roller, sense."""
        size = self.size
        if self.rim:
            self._circle("cam", *self.rim)
        for name, (kind, *_) in STYLES.items():
            if name in self.curves:
                kind = "hole" if name == "surface" and self.rim else kind
                self.items.append(f'<path class="{kind}" id="{name}" d="{_path(self.curves[name])}"/>')

        for axis in (0, 1):
            low, high = self.low[axis] - 2 * size, self.high[axis] + 2 * size
            self._line(np.roll((low, 0.0), axis), np.roll((high, 0.0), axis), "axis")
        self._words((0.5 * size, -1.5 * size), "O")
        start = self.curves["pitch"][:, 0]
        self._circle("thin", start, self.roller)
        reach = np.hypot(*start)
        along, outer = start / reach, reach + self.roller
        self._line(outer * along, (outer + 5 * size) * along)
        self._words(outer * along + [0.2 * size, -1.3 * size], "0° zero mark")
        self._draw_sense()

    def _draw_sense(self):
        """The sense in which the roller goes around, in the middle between the radii with dimensions."""
        size, angle = self.size, self.sheet.profile.crank_angle
        ways = np.sort(np.mod([0.0, angle[np.argmin(self.radius)], angle[np.argmax(self.radius)]], 2 * np.pi))
        gaps = np.diff(np.append(ways, ways[0] + 2 * np.pi))
        middle = ways[np.argmax(gaps)] + 0.5 * gaps.max()
        along = np.array([np.cos(middle), np.sin(middle)])
        x, y = self.sheet.sense_arc(np.linspace(-40.0, 40.0, 41), 0.45 * float(self.radius.min()))
        arc = np.stack([along[0] * x - along[1] * y, along[1] * x + along[0] * y])
        self.items.append(f'<path id="sense" d="{_path(arc, closed=False)}"/>')
        self._tip(arc[:, -1], arc[:, -1] - arc[:, -2])
        place = arc[:, 20] + size * (along + [0.0, min(along[1], 0.0)])
        self._words(place, f"{self.sheet.follower} goes {self.sheet.sense}", ANCHORS[int(np.rint(along[0])) + 1])

    def _draw_dimensions(self):
        """Width and height of the working curve, largest and smallest radius, diameter of the roller."""
        size, sheet, pitch = self.size, self.sheet, self.curves["pitch"]
        base, side = self.low[1] - 5 * size, self.high[0] + 12 * size
        for axis, level, beyond in ((0, base, base - size), (1, side, side + size)):
            edges = self.curves["surface"][axis].min(), self.curves["surface"][axis].max()
            for edge in edges:
                self._line(np.roll((edge, 0.0), axis), np.roll((edge, beyond), axis))
            start, stop = (np.roll((edge, level), axis) for edge in edges)
            self._line(start, stop)
            self._tip(stop, stop - start)
            self._tip(start, start - stop)
            place = start + (0.8 if axis else 0.5) * (stop - start)  # clear of the zero mark
            place[1 - axis] += (0.6 if axis else 0.5) * size
            self._words(place, sheet.length_text((edges[1] - edges[0]) / MM_PER_M))
        for place, name, above in (
            (np.argmax(self.radius), "largest", 0.5),
            (np.argmin(self.radius), "smallest", -1.4),
        ):
            end = pitch[:, place]
            self._line((0.0, 0.0), end)
            self._tip(end, end)
            degrees = np.degrees(sheet.profile.crank_angle[place])
            text = f"{name} R {sheet.length_text(self.radius[place] / MM_PER_M)} at {degrees:.4g}°"
            along = end / np.hypot(*end) * (1.0 if end[0] >= 0.0 else -1.0)  # read from the left
            place = 0.55 * end + above * size * np.array([-along[1], along[0]])
            self._words(place, text, "middle", np.degrees(np.arctan2(along[1], along[0])))
        text = f"roller ⌀ {sheet.length_text(2 * self.roller / MM_PER_M)}" if self.roller else "flat face"
        self._words(pitch[:, 0] + np.array([0.75, 0.8]) * self.roller, text)

    def _line(self, start, stop, kind="thin"):
        (x1, y1), (x2, y2) = start, stop
        self.items.append(f'<line class="{kind}" x1="{x1:.6g}" y1="{-y1:.6g}" x2="{x2:.6g}" y2="{-y2:.6g}"/>')

    def _circle(self, kind, centre, radius):
        x, y = centre
        self.items.append(f'<circle class="{kind}" cx="{x:.6g}" cy="{-y:.6g}" r="{radius:.6g}"/>')

    def _tip(self, point, direction):
        left, tip, right = arrow_head(point, direction, self.size, 5)
        self.items.append(f'<path class="tip" d="{_path(np.stack([tip, left, right], axis=1))}"/>')

    def _words(self, place, text, anchor="start", turned=0.0):
        """A text from, about or up to a place, turned counter-clockwise by an angle in degrees."""
        x, y = place
        at = f'x="{x:.6g}" y="{-y:.6g}" font-size="{self.size:.3g}"'
        at += "" if anchor == "start" else f' text-anchor="{anchor}"'
        at += f' transform="rotate({-turned:.6g} {x:.6g} {-y:.6g})"' if turned else ""
        self.items.append(f"<text {at}>{escape(text)}</text>")


def _path(points, closed=True):
    """Path through points (2, N) in mm, to a nanometre."""
    steps = " L ".join(f"{x:.6f} {-y:.6f}" for x, y in points.T)
    return f"M {steps}{' Z' if closed else ''}"


def _to_svg(sheet, path):
    Path(path).write_text(SvgDrawing(sheet).text(), encoding="utf-8")


def _to_csv(sheet, path):
    """Table of roller centres, working curve and cutter; ``Sampled.from_csv`` reads its first two columns."""
    columns = {}

    def add(name, values, unit=sheet.units, more=0):
        places = DECIMALS[unit] + more
        rounded = np.round(values, places) + 0.0  # no minus before 0
        columns[f"{name} [{unit}]"] = [f"{value:.{places}f}".rstrip("0").rstrip(".") for value in rounded]

    add("angle", np.degrees(sheet.profile.crank_angle), "deg", MORE_DECIMALS)
    add("radius", sheet.in_unit(sheet.radius), more=MORE_DECIMALS)
    for name, points in sheet.paths.items():
        if name != "pitch" or not sheet.profile.cam.flat:  # a flat face touches it
            for axis, part in zip("xy", sheet.in_unit(points), strict=True):
                add(f"{STYLES[name][1]}_{axis}", part)
    if not sheet.profile.cam.flat:
        add("pressure_angle", np.degrees(sheet.profile.pressure_angle), "deg")
    add("curvature_radius", sheet.in_unit(sheet.profile.curvature_radius))
    rows = zip(*columns.values(), strict=True)
    lines = [*(f"# {note}" for note in sheet.notes), ", ".join(columns), *map(", ".join, rows)]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _to_dxf(sheet, path):
    """Closed polylines of the curves, each on its own layer, and a layer of notes with the roller, the mark and O."""
    try:
        import ezdxf
    except ImportError:
        raise MissingLibraryError(
            'a .dxf needs ezdxf, which is not installed: pip install "kinetostatics[workshop]"; .csv and .svg work '
            "without"
        ) from None
    drawing = ezdxf.new("R2010", units=DXF_UNITS[sheet.units])
    space = drawing.modelspace()
    curves = {name: sheet.in_unit(points) for name, points in sheet.paths.items()}
    for name, points in curves.items():
        _, _, layer, colour = STYLES[name]
        drawing.layers.add(layer, color=colour)
        space.add_lwpolyline(points.T.tolist(), close=True, dxfattribs={"layer": layer})
    drawing.layers.add("NOTES", color=5)
    notes = {"layer": "NOTES"}
    x, y = curves["pitch"][:, 0].tolist()
    reach = float(np.hypot(x, y))
    size = reach / 25
    space.add_circle((x, y), sheet.in_unit(sheet.profile.roller_radius), dxfattribs=notes)
    space.add_line((0.0, 0.0), (1.2 * x, 1.2 * y), dxfattribs=notes)
    space.add_point((0.0, 0.0), dxfattribs=notes)
    arc = sheet.sense_arc(np.linspace(10.0, 60.0, 26), 0.4 * reach).T
    space.add_lwpolyline(arc.tolist(), dxfattribs=notes)
    space.add_lwpolyline(arrow_head(arc[-1], arc[-1] - arc[-2], size, 3), dxfattribs=notes)
    space.add_text("0", height=size, dxfattribs=notes).set_placement((1.22 * x, 1.22 * y))
    low = float(min(points.min() for points in curves.values()))
    for number, note in enumerate(sheet.notes):
        space.add_text(note, height=0.6 * size, dxfattribs=notes).set_placement((low, low - (3 + number) * size))
    drawing.saveas(path)


WRITERS = {".csv": _to_csv, ".dxf": _to_dxf, ".svg": _to_svg}


def export(cam, path, roller_radius, cutter_radius, points, units, side, clockwise):
    """Write a cam to a file; ``cam.export`` documents the parameters."""
    radii = {} if cam.flat else {"roller_radius": roller_radius}
    radii |= {} if cutter_radius is None else {"cutter_radius": cutter_radius}
    problem = checks.count("points", points)
    found = checks.single_numbers(
        "cam export",
        problem or (None if 8 <= points <= MAX_POINTS else f"points must be from 8 to {MAX_POINTS}, got {points}"),
        checks.choice("units", units, tuple(UNITS)),
        checks.choice("side", side, tuple(SIDE_SIGNS)),
        checks.truth("clockwise", clockwise),
        flat_face_problem(cam, roller_radius),
        None if isinstance(path, str | Path) else f"path must be the name of a file, got {checks.shown(path)}",
        **{name: (radius, "m", POSITIVE) for name, radius in radii.items()},
    )
    problem, ending = write_problem(path, endings=tuple(WRITERS)), Path(path).suffix.lower()
    if problem or ending not in WRITERS:
        raise FileError(problem or checks.choice(f"{path}: the ending", Path(path).suffix, tuple(WRITERS)))
    working = profile(cam, found.get("roller_radius"), int(points), side)
    sheet = Sheet(working, found.get("cutter_radius"), units, clockwise)
    with write_atomically(path) as temporary:
        WRITERS[ending](sheet, temporary)
