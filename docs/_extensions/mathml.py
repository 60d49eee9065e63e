"""Formulas as MathML, by the converter of docutils: the pages need no script and no font from elsewhere."""

import re

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util import logging

logger = logging.getLogger(__name__)
UNBRACED = re.compile(r"\\[dt]?frac\s*(?!\{)\S|\\[dt]?frac\s*\{[^{}]*\}\s*(?!\{)\S")
"""Fractions without braces: the converter reads ``\\frac12`` as one number over the next letter."""

UNKNOWN = {"\\dots": "\\ldots", "°": r"^\circ "}
"""What the converter does not know, and what it does."""
ACCENTED = re.compile(
    r"(\\(?:dot|ddot|hat|widehat|bar|overline|vec|tilde)\s*(?:\{(?:[^{}]|\{[^{}]*\})*\}|\\[a-zA-Z]+|\w))\s*_"
)
"""An accented letter with an index, which the converter would set below the letter."""


def formula(node, as_block):
    """The MathML of a formula; a formula that cannot be read is warned of, and shown as it was written."""
    latex = node.astext()
    for unknown, known in UNKNOWN.items():
        latex = latex.replace(unknown, known)
    latex = ACCENTED.sub(r"\1{}_", latex)
    if UNBRACED.search(latex):
        logger.warning("write braces around both parts of a fraction: %s", node.astext(), location=node)
    try:
        return tex2mathml(latex, as_block=as_block)
    except MathError as error:
        logger.warning("formula %s: %s", latex, error, location=node)
        return f"<code>{nodes.unescape(latex)}</code>"


def inline(self, node):
    """A formula within a line."""
    self.body.append(formula(node, as_block=False))
    raise nodes.SkipNode


def display(self, node):
    """A formula on a line of its own, with its number and the place that links lead to."""
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    identity = f' id="{node["ids"][0]}"' if node["ids"] else ""
    self.body.append(f'<div class="math-display"{identity}>{number}{formula(node, as_block=True)}</div>\n')
    raise nodes.SkipNode


def setup(app):
    """Make it the renderer of formulas called `mathml`."""
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(display, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
