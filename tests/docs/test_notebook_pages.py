"""Pages with code fold their assertions, and their tables have one header row and at most six digits."""

from types import SimpleNamespace

import pytest

from support import pages
from support.every import every

pytestmark = pages.needed
nodes = pytest.importorskip("docutils.nodes", reason="docutils is not installed (extra: docs)")
shown = pages.script("notebook_pages")
INDEXED = """<thead>
    <tr style="text-align: right;">
      <th></th>
      <th>mean [W]</th>
    </tr>
    <tr>
      <th>lost at</th>
      <th></th>
    </tr>
  </thead>"""


@every(
    ("html", "expected"),
    [
        (INDEXED, '<thead><tr style="text-align: right;"><th>lost at</th><th>mean [W]</th></tr></thead>'),
        (INDEXED.replace("<th></th>", "<th>unit</th>", 1), None),
        (
            INDEXED.replace("<th>lost at</th>", "<th></th>").replace(
                "<th></th>\n    </tr>\n  </thead>", "<th>a</th></tr></thead>"
            ),
            None,
        ),
        ("<td>0.123456789</td>", "<td>0.123457</td>"),
        ("<td>286771.123456</td><td>1.25</td>", "<td>286771</td><td>1.25</td>"),
    ],
)
def test_tables_are_tidy(html, expected):
    assert shown.tidy(html) == (html if expected is None else expected)


@every(
    ("code", "kept", "checks"),
    [
        ("a = 1\nassert a == 1", "a = 1", "assert a == 1"),
        ("assert (\n    1\n)\nprint(2)", "print(2)", "assert (\n    1\n)"),
        ("for i in range(3):\n    assert i < 3\nprint(2)", "print(2)", "for i in range(3):\n    assert i < 3"),
        ("for i in range(3):\n    print(i)\n    assert i < 3", "for i in range(3):\n    print(i)", "    assert i < 3"),
        ("assert True", "", "assert True"),
        ("print('assert ')", "print('assert ')", ""),
    ],
)
def test_assertions_are_apart(code, kept, checks):
    assert shown.split_checks(code) == (kept, checks)


def test_only_empty_headers_are_dropped():
    heads = [nodes.thead("", nodes.row("", nodes.entry("", nodes.paragraph(text=text)))) for text in ("", "mass")]
    doctree = nodes.section("", *(nodes.tgroup("", head) for head in heads))
    shown.clean(SimpleNamespace(), doctree)
    assert [head.astext() for head in doctree.findall(nodes.thead)] == ["mass"]


def test_a_code_cell_shows_its_assertions_in_a_fold():
    block = nodes.literal_block("", "a = 1\nassert a == 1")
    doctree = nodes.section("", nodes.container("", block, nb_element="cell_code_source"))
    shown.clean(SimpleNamespace(), doctree)
    assert [part.astext() for part in doctree[0]] == ["a = 1", shown.FOLD[0], "assert a == 1", shown.FOLD[1]]
