"""The gallery shows what its lines draw: few lines, pictures that come out the same, and small."""

import matplotlib as mpl
import numpy as np
import pytest

from support import pages
from support.every import every

pytestmark = pages.needed
gallery, pictures = pages.script("draw_gallery"), pages.script("pictures")
SNIPPETS = gallery.snippets() if gallery else {}


def committed(name):
    return (gallery.FOLDER / f"{name}.svg").read_text(encoding="utf-8")


def test_every_picture_is_drawn_by_lines_on_the_page():
    page = gallery.PAGE.read_text(encoding="utf-8")
    assert page.count(".svg)") == len(SNIPPETS)
    assert {path.stem for path in gallery.FOLDER.glob("*.svg")} == SNIPPETS.keys()
    assert 10 <= len(SNIPPETS) <= 14


@every("name", SNIPPETS)
def test_a_picture_is_small_and_bears_no_date(name):
    assert len([line for line in SNIPPETS[name].splitlines() if line.strip()]) <= 6
    assert max(map(len, SNIPPETS[name].splitlines())) <= 120
    assert len(committed(name).encode()) < 100_000
    assert "<dc:date>" not in committed(name)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Animation was deleted")
@pytest.mark.parametrize("name", SNIPPETS)
def test_a_picture_comes_out_as_it_is_shown(name):
    if name == "stability":
        for library in ("flint", "mpmath"):
            pytest.importorskip(library, reason=f"{library} is not installed (extra: precision)")
    before = dict(mpl.rcParams)
    pages.same_picture(committed(name), gallery.drawn(name), strokes=name not in gallery.ROUNDING)
    assert dict(mpl.rcParams) == before


def test_a_picture_that_differs_is_found():
    svg = committed("torque")
    pages.same_picture(svg, svg)
    with pytest.raises(AssertionError, match="anew"):
        pages.same_picture(svg, svg.replace("<!-- 90 -->", "<!-- 80 -->", 1))
    assert len(pictures.texts(svg)) > 10
    places, between = pictures.strokes(svg)
    assert len(between) == len(places) + 1
    moved = svg.replace("M ", "M 1", 1)
    assert not np.allclose(pictures.strokes(moved)[0], places, rtol=0, atol=pages.MOVED)
