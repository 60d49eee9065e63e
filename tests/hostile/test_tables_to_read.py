"""Tables of text that are wrong: each ends in one clear error with its line, or the right numbers."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers.files import read_columns
from kinetostatics.sweeps import designs
from support.every import every


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    designs.distributions({"a": "0..1 m"})
    ks.load_case("sawframe_2r63")


ANGLES = range(0, 360, 10)
ROWS = [f"{angle}, {1000 + angle % 70}" for angle in ANGLES]
HEADING = "crank_angle [deg], force [N]"
GOOD = "\n".join([HEADING, *ROWS])


def forces(path):
    return read_columns(path, {"crank_angle": "rad", "force": "N"})


def table(folder, content):
    path = folder / "table.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


BAD_TABLES = {
    "empty": ("", "is empty"),
    "blank": ("\n\n \n", "is empty"),
    "header only": (HEADING, "no rows"),
    "header and blanks": (HEADING + "\n\n\n", "no rows"),
    "semicolons": (GOOD.replace(",", ";"), "semicolons between its columns"),
    "decimal commas": (GOOD.replace(",", ";").replace("1000", "1000,5"), "semicolons between its columns"),
    "decimal commas between commas": (
        GOOD.replace("1000", "1000,5"),
        "line 2 has 3 fields, but the heading 2; if a comma",
    ),
    "tabs": (GOOD.replace(", ", "\t"), "tabs between its columns"),
    "binary": (bytes(range(256)) * 4, "is not text: it has a zero byte at 0"),
    "zero bytes": (GOOD.replace("1000", "10\x000"), "zero byte"),
    "UTF-16": (GOOD.encode("utf-16"), "UTF-16; save it as UTF-8"),
    "UTF-16 without mark": (GOOD.encode("utf-16-le"), "zero byte"),
    "Latin-1": (GOOD.replace("deg", "°").encode("latin-1"), "is not UTF-8 text"),
    "longer row": (GOOD.replace("10, 1010", "10, 1010, 7"), "line 3 has 3 fields, but the heading 2"),
    "rows longer than the heading": (
        GOOD.replace("\n", ", 1\n").replace(", 1\n", "\n", 1),
        "3 fields, but the heading 2",
    ),
    "shorter row": (GOOD.replace("10, 1010", "10"), "line 3 has 1 fields, but the heading 2"),
    "two units": (
        GOOD.replace("force [N]", "force [N], force [kN]").replace("1000", "100, 0.1"),
        "fields|2 columns are",
    ),
    "the same twice": ("\n".join(f"{row}, {row}" for row in GOOD.split("\n")), "2 columns are 'force'"),
    "no unit": (GOOD.replace(" [N]", ""), r"has no unit; head it for example \"force \[N\]\""),
    "open bracket": (GOOD.replace("[N]", "[N"), "no column 'force'"),
    "other unit": (GOOD.replace("[N]", "[kg]"), "does not measure the same"),
    "unit of a hang": (GOOD.replace("[N]", "[N*10**10**10]"), "is not known"),
    "other name": (GOOD.replace("force", "forces"), "no column 'force'; .* head it 'force \\[N\\]'"),
    "words": (GOOD.replace("1060", "high"), "line 8: not a number: 'high'"),
    "nan": (GOOD.replace("1030", "nan"), "line 5: not a number: 'nan'"),
    "infinite": (GOOD.replace("1030", "1e999"), "line 5: not a number: '1e999'"),
    "missing": (GOOD.replace(", 1030", ","), "line 5: not a number: ''"),
    "underscores": (GOOD.replace("1030", "1_030"), "line 5: not a number: '1_030'"),
    "wide digits": (GOOD.replace("1030", "１０３０"), "line 5: not a number"),
    "hexadecimal": (GOOD.replace("1030", "0x82"), "line 5: not a number"),
    "with a unit": (GOOD.replace("1030", "1030 N"), "line 5: not a number: '1030 N'"),
    "after blank lines": (GOOD.replace("\n10,", "\n\n\n\n10,").replace("1030", "x"), "line 8: not a number: 'x'"),
    "after blank Windows lines": (GOOD.replace("\n", "\r\n\r\n").replace("1030", "x"), "line 9: not a number: 'x'"),
    "a comment after the heading": (
        GOOD.replace("\n10,", "\n# measured\n10,"),
        "line 3 begins with '#'; comments stand",
    ),
    "a comment at the end": (GOOD + "\n# a, b\n", f"line {len(ROWS) + 2} begins with '#'"),
    "comments only": ("# measured\n# on Monday\n", "is empty"),
    "a heading as a comment": ("# " + GOOD, "has no heading after its comments; take the '#' off the line"),
    "words after comments": ("# one\n\n" + GOOD.replace("1060", "high"), "line 10: not a number: 'high'"),
    "open quote": (GOOD.replace("1030", '"1030'), "cannot be read as CSV: line|not a number"),
    "a field without end": (HEADING + "\n" + "1" * 200_000, "cannot be read as CSV: line 2"),
}


@every("name", BAD_TABLES)
def test_a_table_that_is_none_is_refused_with_its_line(tmp_path, name):
    content, message = BAD_TABLES[name]
    with pytest.raises(ks.CaseError, match=message) as caught:
        forces(table(tmp_path, content))
    assert str(caught.value).startswith(f"{tmp_path / 'table.csv'}: ")


@every(
    "content",
    [
        "\ufeff" + GOOD,
        "\ufeff# measured on Monday, in the open\n" + GOOD,
        '# an "open quote, and ; a semicolon\n\n  # and more\u2028\n' + GOOD,
        "# after Windows\r\n" + GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\n\n"),
        GOOD + "\n\n \n",
        GOOD.replace(", ", ","),
        GOOD.replace(HEADING, "crank_angle[deg],force[N]"),
        GOOD.replace(HEADING, '"crank_angle [deg]","force [N]"'),
        "\n".join(f"word, {row}" for row in GOOD.split("\n")),
    ],
)
def test_a_table_written_otherwise_is_read_alike(tmp_path, content):
    angle, force = forces(table(tmp_path, content))
    np.testing.assert_allclose(np.degrees(angle), ANGLES, rtol=1e-15)
    assert force.tolist() == [float(row.split(",")[1]) for row in ROWS]
