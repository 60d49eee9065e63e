"""What the pictures of these pages have in common: SVG that comes out the same whenever it is drawn."""

import re
from io import StringIO

import matplotlib as mpl
import numpy as np

mpl.use("agg")

PLACE = re.compile(r' (?:d|x|y|width|height)="[^"]*"')
"""Places in a picture, in points: a hundredth of one is enough."""
DECIMALS = re.compile(r"-?\d+\.\d{3,}(?:e-?\d+)?")
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


def look(name, size):
    """Settings for a picture of a name and a size in inches."""
    return mpl.rc_context(
        {"svg.hashsalt": name, "font.size": 9, "figure.figsize": size, "figure.constrained_layout.use": True}
    )


def as_svg(figure):
    """A figure as the text of an SVG file, without a date."""
    text = StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    lines = (line.rstrip() for line in text.getvalue().splitlines())
    return PLACE.sub(lambda found: DECIMALS.sub(_rounded, found[0]), "\n".join(lines)) + "\n"


def _rounded(number):
    return f"{float(number[0]):.2f}"


def version(svg):
    """Version of matplotlib that a picture was drawn by, as (major, minor)."""
    return re.search(r"Matplotlib v(\d+)\.(\d+)", svg).groups()


def texts(svg):
    """All that is written in a picture: titles, labels, the numbers of its axes."""
    return re.findall(r"<!-- (.*?) -->", svg)


def strokes(svg):
    """Coordinates in a picture, and what stands between them; names of clip paths depend on the last bits of these."""
    body = re.sub(r"\bp[0-9a-f]{10}\b", "clip", svg.partition("</metadata>")[2])
    return np.array(NUMBER.findall(body), dtype=float), NUMBER.split(body)
