"""The pictures of gallery.md, each by the lines that stand below it there: python docs/draw_gallery.py [NAME ...].

Without names all are drawn, into docs/gallery.
"""

import re
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from pictures import as_svg, look

import kinetostatics as ks

PAGE = Path(__file__).parent / "gallery.md"
FOLDER = PAGE.with_suffix("")
SIZES = {
    "mechanism": (3.2, 6.0),
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


def snippets():
    """Lines of code by picture, in the order of the page."""
    text = PAGE.read_text(encoding="utf-8")
    return dict(re.findall(r"\(gallery/(\w+)\.svg\)\n\n```python\n(.*?)```", text, flags=re.DOTALL))


def drawn(name):
    """A picture as SVG, by the lines of the page."""
    with look(name, SIZES.get(name, (6.4, 4.0))):
        names = {"ks": ks, "np": np, "plt": plt}
        exec(compile(snippets()[name], f"{PAGE.name}, {name}", "exec"), names)
        if "film" in names:
            plt.gcf().canvas.draw()  # starts a film
        svg = as_svg(plt.gcf())
        plt.close("all")
    return svg


if __name__ == "__main__":
    for name in sys.argv[1:] or snippets():
        (FOLDER / f"{name}.svg").write_text(drawn(name), encoding="utf-8")
