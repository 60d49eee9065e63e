"""Pages with code fold their assertions, and their tables have one header row and at most six digits."""

from support import pages
from support.every import every

pytestmark = pages.needed
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
