"""Tables as they are printed: readable numbers, rounding as 0, no wider than the line."""

import math
import re

import pandas as pd
import pytest

from kinetostatics.cli import main
from kinetostatics.cli.output import print_folded, print_table
from support.every import every

NUMBERS = {
    -0.0: "0",
    -1e-20: "-1e-20",
    -2.5: "-2.5",
    1e-9: "1e-09",
    40578.94111: "40578.9",
    1234567.8: "1234568",
    -2.5e8: "-250000000",
    1e9: "1e+09",
    math.inf: "inf",
    math.nan: "",
}


def test_numbers_have_six_digits_without_exponent(capsys):
    print_table(pd.DataFrame({"smallest": list(NUMBERS)}, index=list("abcdefghij")))
    assert [line[1:].strip() for line in capsys.readouterr().out.splitlines()[2:]] == list(NUMBERS.values())


def test_angles_have_digits_of_a_whole_turn(capsys):
    print_table(pd.DataFrame({"at [deg]": [0.00940839, 359.97081, 1e-5, -1e-5, 90.0]}))
    cells = [line.split()[1] for line in capsys.readouterr().out.splitlines()[2:]]
    assert cells == ["0.009", "359.971", "0", "0", "90"]


WIDE = pd.DataFrame(
    {"unit": ["N m", "N"], **{f"variant-{number} of many": [1.25 * number, -1e5] for number in range(7)}},
    index=pd.Index(["largest coupler inertia force of all that there are", "cam force"], name="quantity"),
)


@pytest.mark.parametrize("columns", [40, 60, 80, 120, 200])
def test_a_table_fits_the_line_and_loses_nothing(columns, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", str(columns))
    print_table(WIDE)
    printed = capsys.readouterr().out
    assert max(map(len, printed.splitlines())) <= columns
    assert all(len(re.findall(rf"(?<![\d.]){number}(?![\d.])", printed)) >= 1 for number in ("1.25", "7.5", "0"))
    assert printed.count("-100000") == 7
    assert printed.count("variant-") == 7


def test_a_long_name_stays_whole(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "40")
    print_table(pd.DataFrame({"value": [1.0]}, index=["x" * 90]))
    print_folded("y" * 90)
    printed = capsys.readouterr().out
    assert "x" * 90 in printed
    assert "y" * 90 in printed


@pytest.mark.parametrize("width", ["", "0", "-5", "many", "1"])
def test_a_width_that_makes_no_sense_is_none(width, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", width)
    print_table(WIDE)
    assert 30 < max(map(len, capsys.readouterr().out.splitlines())) <= 80


def test_tables_without_rows_are_their_headings(capsys):
    print_table(pd.DataFrame({"a": [], "b": []}))
    assert capsys.readouterr().out.split() == ["index", "a", "b", "-----", "-", "-"]


@pytest.mark.slow
@every("name", ["sawframe_2r63", "mower_drive", "in_line_twin", "yoke_pump", "chain_unit"])
def test_shipped_tables_fit_80_columns(name, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    assert main(["run", name, "--angles", "24"]) == 0
    assert main(["compare", name]) == 0
    printed = capsys.readouterr().out
    assert max(map(len, printed.splitlines())) <= 80
    assert not re.search(r"\x1b|[\u2500-\u257f]", printed)
    assert not re.search(r"\de-1[2-9]", re.sub(r"differ by\s+\S+", "", printed))


def test_digits_that_are_not_known_are_not_printed(capsys):
    table = pd.DataFrame({"unit": ["N"] * 4, "largest": [40578.93, 40578.93, 1.5e-10, 40578.93]}, index=list("abcd"))
    bounds = pd.DataFrame({"unit": ["N"] * 4, "largest": [3.0, math.nan, 2e-10, math.inf]}, index=list("abcd"))
    print_table(table, bounds)
    cells = [line.split()[-1] for line in capsys.readouterr().out.splitlines()[2:]]
    assert cells == ["40579", "40578.9", "0", "40578.9"]
