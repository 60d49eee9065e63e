"""The pictures of gallery.md, each drawn by the lines that stand below it there: python docs/gallery/draw.py [NAME ...].

Without names all are drawn, into this folder.
"""

import re
import sys
from io import StringIO
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np

import kinetostatics as ks

FOLDER = Path(__file__).parent
PAGE = FOLDER.parent / "gallery.md"
SIZES = {
    "mechanism": (8.0, 2.6),
    "film": (8.0, 2.6),
    "mass_centres": (8.0, 3.0),
    "hodograph": (6.4, 4.6),
    "cam": (6.4, 5.4),
    "change_points": (6.4, 3.2),
    "stability": (8.0, 4.6),
}
"""Inches; others are 6.4 by 4."""
ROUNDING = {"stability"}
"""Pictures that show rounding errors, which differ from machine to machine."""
PLACE = re.compile(r' (?:d|x|y|width|height)="[^"]*"')
"""Places in a picture, in points: a hundredth of one is enough."""
DECIMALS = re.compile(r"-?\d+\.\d{3,}(?:e-?\d+)?")
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


def snippets():
    """Lines of code by picture, in the order of the page."""
    text = PAGE.read_text(encoding="utf-8")
    return dict(re.findall(r"\(gallery/(\w+)\.svg\)\n\n```python\n(.*?)```", text, flags=re.DOTALL))


def drawn(name):
    """A picture as SVG, by the lines of the page."""
    look = {
        "svg.hashsalt": name,
        "font.size": 9,
        "figure.figsize": SIZES.get(name, (6.4, 4.0)),
        "figure.constrained_layout.use": True,
    }
    with mpl.rc_context(look):
        names = {"ks": ks, "np": np, "plt": plt}
        exec(compile(snippets()[name], f"{PAGE.name}, {name}", "exec"), names)
        if "film" in names:
            plt.gcf().canvas.draw()  # starts a film
        text = StringIO()
        plt.gcf().savefig(text, format="svg", metadata={"Date": None})
        plt.close("all")
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
    """Coordinates in a picture, and what stands between them."""
    body = svg.partition("</metadata>")[2]
    return np.array(NUMBER.findall(body), dtype=float), NUMBER.split(body)


if __name__ == "__main__":
    for name in sys.argv[1:] or snippets():
        (FOLDER / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
