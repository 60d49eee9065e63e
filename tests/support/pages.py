"""Pages of the documentation: links, cells of code and pictures."""

import importlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parents[2] / "docs"
MADE = ("_build", "notebooks", "generated")
"""Folders that the build makes."""
RUN_AT_BUILD = re.compile(r"\A---\n(?:.*\n)*?file_format: mystnb\n(?:.*\n)*?---\n")


def pages():
    """Markdown pages by name, without ending."""
    paths = sorted(path for path in DOCS.rglob("*.md") if not set(MADE) & set(path.relative_to(DOCS).parts))
    return {path.relative_to(DOCS).with_suffix("").as_posix(): path for path in paths}


def text_of(path):
    return path.read_text(encoding="utf-8")


def code_cells(text):
    """Code of the cells that the build runs, without their options."""
    cells = re.findall(r"^```\{code-cell\}[^\n]*\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    return ["\n".join(line for line in cell.splitlines() if not line.startswith(":")) for cell in cells]


def shown_code(text):
    """Blocks of Python that are only shown."""
    return re.findall(r"^```python\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)


def links(text):
    """Where the links and pictures of a page lead, without code."""
    prose = re.sub(r"^(`{3,}|:{3,}).*?^\1", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", prose))


def script(name):
    """A module of docs/ or docs/_extensions; None where there are no pages."""
    if not DOCS.is_dir():
        return None
    for folder in (DOCS, DOCS / "_extensions"):
        if str(folder) not in sys.path:
            sys.path.append(str(folder))
    return importlib.import_module(name)


MOVED = 0.1
"""Points of print by which a stroke may lie elsewhere."""
CELL = re.compile(r"^```\{code-cell\}[^\n]*\n((?::[^\n]*\n)*)\n?(.*?)^```", flags=re.DOTALL | re.MULTILINE)
LONG = "at-build"
"""Tag of cells that take seconds: they run when the pages are built."""
needed = pytest.mark.skipif(not DOCS.is_dir(), reason="the pages are not beside the tests")


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
