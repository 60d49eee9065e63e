"""Drawing of a cam as SVG, one to one: curves, roller, zero mark, sense of rotation, dimensions."""

from xml.sax.saxutils import escape

import numpy as np

MM = 1000.0
"""Millimetres in a metre: what the drawing is measured in, so that it prints one to one."""
CLASSES = {"surface": "cam", "pitch": "pitch", "cutter": "cutter"}
"""How each curve is drawn."""
INK = (
    "path,line,circle{fill:none;stroke:#222;stroke-width:.25}"
    ".cam{stroke-width:.6;fill:#e8edf2}.hole{stroke-width:.6;fill:#fff}"
    ".pitch{stroke:#c22;stroke-width:.3;stroke-dasharray:8 1.5 1 1.5}"
    ".cutter{stroke:#282;stroke-width:.3;stroke-dasharray:3 1.5}"
    ".axis{stroke-dasharray:10 1.5 1 1.5;stroke-width:.18}.thin{stroke-width:.18}"
    "text{font-family:sans-serif;fill:#222}.tip{fill:#222;stroke:none}"
)


def drawn(sheet):
    """Text of the drawing."""
    return _Drawing(sheet).text()


class _Drawing:
    """Collects what is drawn, in mm with y upward; the file has y downward."""

    def __init__(self, sheet):
        self.sheet, self.items = sheet, []
        self.radius = MM * sheet.radius
        self.curves = {name: MM * points for name, points in sheet.paths.items()}
        self.roller = MM * sheet.made.roller_radius
        every = np.concatenate(list(self.curves.values()), axis=1)
        self.low, self.high = every.min(axis=1) - self.roller, every.max(axis=1) + self.roller
        self.size = max(2.5, float(np.max(self.high - self.low)) / 110.0)

    def text(self):
        size = self.size
        self._curves()
        self._axes()
        self._roller()
        self._sense()
        self._dimensions()
        notes = [*self.sheet.notes, "scale 1:1, print without scaling; the bar is 100 mm"]
        top = self.low[1] - 10 * size
        for number, note in enumerate(notes):
            self._words((self.low[0] - 4 * size, top - 1.6 * size * number), note)
        bottom = top - 1.6 * size * len(notes)
        x = self.low[0] - 4 * size
        self._line((x, bottom), (x + 100.0, bottom))
        for end in (x, x + 100.0):
            self._line((end, bottom - size / 2), (end, bottom + size / 2))
        wide = max(self.high[0] + 14 * size, x + 0.55 * size * max(map(len, notes)))
        left, up, width = x - 2 * size, self.high[1] + 8 * size, wide - x + 4 * size
        height = up - bottom + 3 * size
        box = f"{left:.6g} {-up:.6g} {width:.6g} {height:.6g}"
        return "\n".join(
            [
                '<?xml version="1.0" encoding="UTF-8"?>',
                f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.6g}mm" height="{height:.6g}mm" '
                f'viewBox="{box}">',
                f"<title>{escape(self.sheet.notes[0])}</title>",
                f"<style>{INK}</style>",
                *self.items,
                "</svg>",
                "",
            ]
        )

    # what is drawn

    def _curves(self):
        """The material of a disk inside its curve, of a ring outside."""
        if self.sheet.made.side == "ring":
            reach = 1.05 * np.max(np.hypot(*self.curves["surface"]))
            self.items.append(f'<circle class="cam" cx="0" cy="0" r="{reach:.6g}"/>')
        for name in ("surface", "pitch", "cutter"):
            if name in self.curves:
                kind = "hole" if name == "surface" and self.sheet.made.side == "ring" else CLASSES[name]
                self.items.append(f'<path class="{kind}" id="{name}" d="{_path(self.curves[name])}"/>')

    def _axes(self):
        size, (left, below), (right, above) = self.size, self.low, self.high
        self._line((left - 2 * size, 0.0), (right + 2 * size, 0.0), "axis")
        self._line((0.0, below - 2 * size), (0.0, above + 2 * size), "axis")
        self._words((0.5 * size, -1.5 * size), "O")

    def _roller(self):
        """The roller where it stands at the zero mark, and the mark."""
        x, y = self.curves["pitch"][:, 0]
        self.items.append(f'<circle class="thin" cx="{x:.6g}" cy="{-y:.6g}" r="{self.roller:.6g}"/>')
        along = np.array([x, y]) / np.hypot(x, y)
        outer = np.hypot(x, y) + self.roller
        self._line(outer * along, (outer + 5 * self.size) * along)
        self._words(outer * along + [0.2 * self.size, -1.3 * self.size], "0° zero mark")

    def _sense(self):
        """An arc with an arrow, the way the roller goes around."""
        sign, reach = (-1.0 if self.sheet.clockwise else 1.0), 0.45 * float(self.radius.min())
        turn = np.radians(sign * np.linspace(20.0, 100.0, 41))
        arc = reach * np.stack([np.cos(turn), np.sin(turn)])
        self.items.append(f'<path id="sense" d="{_path(arc, closed=False)}"/>')
        self._tip(arc[:, -1], arc[:, -1] - arc[:, -2])
        self._words(arc[:, 20] + [self.size, 0.0], f"roller goes {self.sheet.sense}")

    def _dimensions(self):
        size, surface, sheet = self.size, self.curves["surface"], self.sheet
        (left, below), (right, above) = surface.min(axis=1), surface.max(axis=1)
        base, side = self.low[1] - 5 * size, self.high[0] + 7 * size
        for x in (left, right):
            self._line((x, 0.0), (x, base - size), "thin")
        self._measure((left, base), (right, base), sheet.written((right - left) / MM))
        for y in (below, above):
            self._line((0.0, y), (side + size, y), "thin")
        self._measure((side, below), (side, above), sheet.written((above - below) / MM))
        for place, name in ((int(np.argmax(self.radius)), "largest"), (int(np.argmin(self.radius)), "smallest")):
            self._ray(place, name)
        x, y = self.curves["pitch"][:, 0]
        self._words((x + 0.75 * self.roller, y + 0.8 * self.roller), f"roller ⌀ {sheet.written(2 * self.roller / MM)}")

    def _ray(self, place, name):
        """A radius of the pitch curve, from O to where it is largest or smallest."""
        end = self.curves["pitch"][:, place]
        self._line((0.0, 0.0), end, "thin")
        self._tip(end, end)
        degrees = np.degrees(self.sheet.made.crank_angle[place])
        text = f"{name} R {self.sheet.written(self.radius[place] / MM)} at {degrees:.4g}°"
        share = 0.3 if name == "largest" else 0.45
        self._words(share * end + [0.0, (0.6 if name == "largest" else 2.2) * self.size], text)

    # strokes

    def _measure(self, start, stop, text):
        """A dimension line with two tips and its text."""
        start, stop = np.array(start), np.array(stop)
        self._line(start, stop, "thin")
        self._tip(stop, stop - start)
        self._tip(start, start - stop)
        upright = abs(stop[1] - start[1]) > abs(stop[0] - start[0])
        x, y = start + (0.8 if upright else 0.5) * (stop - start)  # clear of the zero mark
        self._words((x + (0.6 * self.size if upright else 0.0), y + (0.0 if upright else 0.5 * self.size)), text)

    def _line(self, start, stop, kind="thin"):
        (x1, y1), (x2, y2) = start, stop
        self.items.append(f'<line class="{kind}" x1="{x1:.6g}" y1="{-y1:.6g}" x2="{x2:.6g}" y2="{-y2:.6g}"/>')

    def _tip(self, point, direction):
        ahead = np.asarray(direction) / np.hypot(*direction) * self.size
        beside = np.array([-ahead[1], ahead[0]]) / 5
        corners = np.stack([point, point - ahead + beside, point - ahead - beside], axis=1)
        self.items.append(f'<path class="tip" d="{_path(corners)}"/>')

    def _words(self, place, text):
        x, y = place
        self.items.append(f'<text x="{x:.6g}" y="{-y:.6g}" font-size="{self.size:.3g}">{escape(text)}</text>')


def _path(points, closed=True):
    """Path through points (2, N) in mm, to a nanometre."""
    steps = " L ".join(f"{x:.6f} {-y:.6f}" for x, y in points.T)
    return f"M {steps}{' Z' if closed else ''}"
