"""The command ``compare``: one table of values, one of ratios, what is published beside them."""

import json
import re

import pytest

from kinetostatics.casefile.case import shipped_cases
from kinetostatics.cli import main
from support.case_files import shipped
from support.commands import printed_by

pytestmark = pytest.mark.slow


def test_variants_stand_beside_published_figures(capsys):
    assert main(["compare", "sawframe_2r63"]) == 0
    values, ratios = capsys.readouterr().out.split("\nratios, plain / each: above 1 is in favour of the variant")
    value, ratio = (re.search(r"mean \|balancing torque\|.*", part)[0].split()[1:] for part in (values, ratios))
    assert value == ["|balancing", "torque|", "N", "m", "23223.7", "3819.22", "3426.19"]
    assert ratio == ["|balancing", "torque|", "6.08075", "6.77829", "6.77"]
    assert re.search(r"cam force +N +13102.4 +12832.3\n", values)
    assert re.search(r"largest cam force .*almost 5 tf = *\n? *49 kN", values)
    assert ratios.count("power balance") == 1


def test_what_is_rounding_is_0_and_its_ratio_infinite(capsys):
    """Full balancing leaves a shaking force of 2e-13 N of parts of 6 kN."""
    assert main(["compare", "mower_drive", "--variant", "full"]) == 0
    row = re.search(r"largest shaking force.*", capsys.readouterr().out)
    assert row[0].split()[-3:] == ["1234.51", "0", "inf"]


def test_json_holds_the_tables_of_the_library_in_full(capsys):
    assert main(["compare", "sawframe_2r63", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    case = shipped("sawframe_2r63")
    table = case.comparison_table("cam-cosine")
    rows = found["variants"]["cam-cosine"]
    assert list(rows) == list(table.index)
    for name, row in rows.items():
        for key, column in {"reference": "plain", "variant": "cam-cosine", "ratio": "ratio"}.items():
            value = table.loc[name, column]
            assert row[key] == value or (row[key] is None and value != value)
    assert rows["largest cam force"]["reference"] is None


def test_csv_has_a_row_for_each_variant_and_quantity(tmp_path, capsys):
    path = tmp_path / "saw.csv"
    printed = printed_by(["compare", "sawframe_2r63", "--csv"], capsys)
    assert printed.startswith("quantity,unit,reference_name,variant_name,reference,variant,ratio,published\n")
    assert printed.count("power residual,1,plain,") == 2
    assert main(["compare", "sawframe_2r63", "--csv", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == printed
    assert f"wrote {path}: " in capsys.readouterr().out


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('"modulus"', "published: row is 'modulus', allowed: 'modulus h [mm]'"),
        (
            '"modulus h [mm]"',
            "published: column of 'modulus h [mm]' is 'ful crank', allowed: .* did you mean 'full crank'",
        ),
    ],
)
def test_published_figure_needs_a_place_in_the_table(tmp_path, capsys, table, message):
    text = shipped_cases()["mower_drive"].read_text(encoding="utf-8").partition("[published]")[0]
    path = tmp_path / "mower.toml"
    path.write_text(f'{text}[published.balancing.{table}]\n"ful crank" = "1"\n', encoding="utf-8")
    assert main(["compare", str(path), "--variant", "full"]) == 2
    assert re.search(message.replace("[mm]", ".mm."), capsys.readouterr().err)


def test_double_cranks_have_no_table_of_swings(tmp_path, capsys):
    text = 'title = "double crank"\nreference = "a"\n[common]\nmechanism = "four-bar"\ncrank_speed = "60 rpm"\n'
    text += 'crank_length = "0.35 m"\ncoupler_length = "0.4 m"\nrocker_length = "0.3 m"\n'
    text += 'rocker_pivot = ["0.1 m", "0 m"]\ncoupler = { mass = "2 kg" }\n'
    text += (
        '[[common.loads]]\nkind = "torque"\nvalue = "9 N m"\non = "rocker"\n[variants.a]\n[variants.b]\nassembly = -1\n'
    )
    path = tmp_path / "drag.toml"
    path.write_text(text, encoding="utf-8")
    printed = printed_by(["compare", str(path)], capsys)
    assert "a / b" in printed
    assert "swing" not in printed


def test_compare_prints_saved_friction(capsys):
    assert main(["compare", "sawframe_2r63_friction", "--variant", "cam-cosine-rolling"]) == 0
    (row,) = (line for line in capsys.readouterr().out.splitlines() if re.match(r"mean power lost +W", line))
    assert row.split()[-3:] == ["42948.7", "7325.54", "5.86287"]
