"""The pages of the documentation: their text, code and links, and the scripts beside them."""

import importlib
import re
import sys
from pathlib import Path

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
    """A module of docs/ or docs/_extensions."""
    for folder in (DOCS, DOCS / "_extensions"):
        if str(folder) not in sys.path:
            sys.path.append(str(folder))
    return importlib.import_module(name)
