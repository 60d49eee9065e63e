"""The pages of the documentation: their scripts, and their code."""

import re
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parent.parent.parent / "docs"
MOVED = 0.1
"""Points of print by which a stroke may lie elsewhere."""
CELL = re.compile(r"^```\{code-cell\}[^\n]*\n((?::[^\n]*\n)*)\n?(.*?)^```", flags=re.DOTALL | re.MULTILINE)
LONG = "at-build"
"""Tag of cells that take seconds: they run when the pages are built."""
needed = pytest.mark.skipif(not DOCS.is_dir(), reason="the pages are not beside the tests")


def script(name):
    """A script of the pages as a module; None where there are no pages."""
    if not DOCS.is_dir():
        return None
    if str(DOCS) not in sys.path:
        sys.path.insert(0, str(DOCS))
    return import_module(name)


def cells(path):
    """Code of a page, cell by cell, without that of long cells."""
    return [code for tags, code in CELL.findall((DOCS / path).read_text(encoding="utf-8")) if LONG not in tags]


def same_picture(shown, now, strokes=True):
    """A picture comes out as it is shown: its texts with any matplotlib, each stroke with the one that drew it."""
    pictures = script("pictures")
    assert pictures.texts(now) == pictures.texts(shown), "draw it anew"
    if strokes and pictures.version(shown) == pictures.version(now):
        (places, between), (were, beside) = pictures.strokes(now), pictures.strokes(shown)
        assert between == beside, "draw it anew"
        np.testing.assert_allclose(places, were, rtol=0, atol=MOVED, err_msg="draw it anew")
