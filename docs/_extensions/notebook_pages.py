"""Pages with code: checks of their numbers are folded away; tables have one header row, none if it would be empty."""

import ast
import re

from docutils import nodes

from kinetostatics.numbers.formatting import number

LONG_NUMBER = re.compile(r"(<td[^>]*>)(-?\d+\.\d{6,}(?:e[-+]\d+)?)(</td>)")
"""Cell of a table with at least six decimals."""
HEAD = re.compile(r"<thead>\s*<tr([^>]*)>(.*?)</tr>\s*<tr[^>]*>(.*?)</tr>\s*</thead>", re.DOTALL)
"""Header of two rows: the names of the columns, and those of the index."""
CELL = re.compile(r"<th[^>]*>(.*?)</th>", re.DOTALL)
FOLD = "<details class='checks'><summary>checks of these numbers</summary>", "</details>"


def tidy(html):
    """HTML of a table with one header row, where its second one only names the index, and at most six digits."""
    html = LONG_NUMBER.sub(lambda found: f"{found[1]}{number(float(found[2]))}{found[3]}", html)
    return HEAD.sub(_one_row, html)


def _one_row(found):
    """The names of the index before those of the columns; two rows as they are if the names would collide."""
    columns, index = (CELL.findall(row) for row in (found[2], found[3]))
    named = [text for text in index if text.strip()]
    if len(columns) != len(index) or index[: len(named)] != named or any(map(str.strip, columns[: len(named)])):
        return found[0]
    cells = "".join(f"<th>{text}</th>" for text in [*named, *columns[len(named) :]])
    return f"<thead><tr{found[1]}>{cells}</tr></thead>"


def split_checks(code):
    """Code without its assertions, and the assertions with the loops that hold nothing else."""
    lines = code.splitlines()
    checks = sorted({row for item in _checks(ast.parse(code).body) for row in range(item.lineno - 1, item.end_lineno)})
    shown = "\n".join(line for row, line in enumerate(lines) if row not in checks)
    return re.sub(r"\n{3,}", "\n\n", shown).strip("\n"), "\n".join(lines[row] for row in checks)


def _checks(body):
    """Assertions among statements, and loops of assertions alone."""
    for item in body:
        inner = item.body if isinstance(item, ast.For | ast.With) else []
        if isinstance(item, ast.Assert) or (inner and all(isinstance(part, ast.Assert) for part in inner)):
            yield item
        else:
            yield from _checks(inner)


def clean(app, doctree):
    """Fold the assertions of code cells, tidy the tables that they show, and drop empty headers of others."""
    for head in list(doctree.findall(nodes.thead)):
        if not head.astext().strip():
            head.parent.remove(head)
    for cell in doctree.findall(lambda node: node.get("nb_element") if isinstance(node, nodes.Element) else None):
        kind = cell["nb_element"]
        if kind == "cell_code_source":
            _fold(cell)
        elif kind == "cell_code_output":
            for raw in cell.findall(nodes.raw):
                if "html" in raw.get("format", ""):
                    raw.children = [nodes.Text(tidy(raw.astext()))]


def _fold(cell):
    for block in list(cell.findall(nodes.literal_block)):
        if "assert " not in block.astext():
            continue
        try:
            shown, checks = split_checks(block.astext())
        except SyntaxError:  # commands of the shell or of IPython
            continue
        if not checks:
            continue
        folded = [nodes.raw("", FOLD[0], format="html"), _like(block, checks), nodes.raw("", FOLD[1], format="html")]
        block.replace_self(([_like(block, shown)] if shown else []) + folded)


def _like(block, text):
    made = nodes.literal_block(text, text, **block.attributes)
    made.source, made.line = block.source, block.line
    return made


def setup(app):
    """Clean each page when it has been read."""
    app.connect("doctree-read", clean)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
