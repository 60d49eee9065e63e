"""The gallery shows what its lines draw: few lines, pictures that come out the same, and small."""

import importlib.util
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

DOCS = Path(__file__).parent.parent.parent / "docs"
MOVED = 0.1
"""Points of the page by which a stroke may lie elsewhere."""
pytestmark = pytest.mark.skipif(not DOCS.is_dir(), reason="the pages are not beside the tests")


def loaded(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


gallery = loaded(DOCS / "gallery" / "draw.py") if DOCS.is_dir() else None
SNIPPETS = gallery.snippets() if gallery else {}


def committed(name):
    return (gallery.FOLDER / f"{name}.svg").read_text(encoding="utf-8")


def test_every_picture_is_drawn_by_lines_on_the_page():
    page = gallery.PAGE.read_text(encoding="utf-8")
    assert page.count(".svg)") == len(SNIPPETS)
    assert {path.stem for path in gallery.FOLDER.glob("*.svg")} == SNIPPETS.keys()
    assert 10 <= len(SNIPPETS) <= 14


@pytest.mark.parametrize("name", SNIPPETS)
def test_a_picture_takes_six_lines_and_less_than_100_kb_and_bears_no_date(name):
    assert len([line for line in SNIPPETS[name].splitlines() if line.strip()]) <= 6
    assert max(map(len, SNIPPETS[name].splitlines())) <= 120
    assert len(committed(name).encode()) < 100_000
    assert "<dc:date>" not in committed(name)


@pytest.mark.filterwarnings("ignore:Animation was deleted")
@pytest.mark.parametrize("name", SNIPPETS)
def test_a_picture_comes_out_as_it_is_shown(name):
    """Its texts with any matplotlib, so the numbers on its axes too; each stroke with the one that drew it."""
    if name == "stability":
        pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
        pytest.importorskip("mpmath", reason="mpmath is not installed (extra: precision)")
        pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    shown, now = committed(name), gallery.drawn(name)
    assert gallery.texts(now) == gallery.texts(shown), "redraw it: python docs/gallery/draw.py"
    if name not in gallery.ROUNDING and gallery.version(shown) == gallery.version(now):
        (places, between), (were, beside) = gallery.strokes(now), gallery.strokes(shown)
        assert between == beside, "redraw it: python docs/gallery/draw.py"
        np.testing.assert_allclose(places, were, rtol=0, atol=MOVED, err_msg="redraw it: python docs/gallery/draw.py")


def test_a_picture_that_differs_is_found():
    svg = committed("torque")
    places, between = gallery.strokes(svg)
    other, _ = gallery.strokes(svg.replace("M ", "M 1", 1))
    assert not np.allclose(places, other, rtol=0, atol=MOVED)
    assert gallery.texts(svg)[0] == "0"
    assert len(gallery.texts(svg)) > 10
    assert len(between) == len(places) + 1


def test_drawing_leaves_settings_as_they_were():
    before = dict(mpl.rcParams)
    gallery.drawn("losses")
    assert dict(mpl.rcParams) == before
