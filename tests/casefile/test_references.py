"""Variants with a reference of their own: compared, swept, searched, drawn and written with it."""

import json

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.casefile.designs import write_found
from kinetostatics.cli import main
from kinetostatics.views import figures
from kinetostatics.views.report import tables
from kinetostatics.views.report.report import subject_of
from support.case_files import PLAIN, case_file, problems
from support.every import every

UPRIGHT = """
[variants.short]
mechanism = "crank-slider"
crank_length = "200 mm"
coupler_length = "2 m"
[variants.standing]
reference = "standing"
mechanism = "crank-slider"
crank_length = "300 mm"
coupler_length = "2 m"
gravity = { direction = "180 deg" }
[variants.standing-short]
reference = "standing"
mechanism = "crank-slider"
crank_length = "200 mm"
coupler_length = "2 m"
gravity = { direction = "180 deg" }
"""
RATIO = "ratio mean_absolute balancing_torque"
VARY = {"coupler_length": ("1.9 m", "2.1 m")}


@pytest.fixture
def path(tmp_path):
    return case_file(tmp_path, PLAIN + UPRIGHT)


@pytest.fixture
def case(path):
    return ks.load_case(path)


def gain(case):
    return case.compare("standing", "standing-short").mean_torque_ratio


def test_each_variant_is_compared_with_its_own_reference(case):
    assert case.comparisons == {"plain": ["short"], "standing": ["standing-short"]}
    assert list(case.comparison_table("standing-short"))[1:3] == ["standing", "standing-short"]
    assert case.names_of() == ("short", "plain")
    assert case.names_of("standing-short") == ("standing-short", "standing")
    assert case.names_of("standing-short", "plain") == ("standing-short", "plain")


@every(
    ("change", "message"),
    [
        (('reference = "standing"\nmech', 'reference = "standin"\nmech'), "variants.standing.reference is 'standin'"),
        (("[common]\n", '[common]\nreference = "plane"\n'), "common.reference is 'plane'"),
    ],
)
def test_a_reference_must_be_a_variant(change, message, tmp_path):
    found = problems(tmp_path, (PLAIN + UPRIGHT).replace(*change, 1))
    assert found[0].startswith(message)
    assert "did you mean" in found[0]


def test_a_reference_must_be_a_name(tmp_path):
    (found,) = problems(tmp_path, (PLAIN + UPRIGHT).replace('reference = "standing"', "reference = 3", 1))
    assert found.startswith("variants.standing.reference must be a name")


@pytest.mark.slow
def test_ratios_of_sweeps_and_searches_refer_to_it(case):
    designs = pd.DataFrame({"slider.mass [kg]": [600.0]})
    own, told = (
        ks.sweep(case, designs, [RATIO], variant="standing-short", reference=reference, progress=False)
        for reference in (None, "standing")
    )
    assert own.equals(told)
    assert own[f"{RATIO} [1]"][0] == pytest.approx(gain(case), rel=1e-6)
    found = ks.design.optimise(case, VARY, RATIO, variant="standing-short", angles=72)
    assert found.reference is case.variants["standing"].scene


@pytest.mark.slow
def test_a_search_of_a_file_is_written_with_it(tmp_path):
    text = '[design.longer]\nkind = "optimum"\nvariant = "standing-short"\nminimise = "largest O"\nangles = 72\n'
    text += '[design.longer.vary]\ncoupler_length = ["1.9 m", "2.1 m"]\n'
    case = ks.load_case(case_file(tmp_path, PLAIN + UPRIGHT + text))
    assert case.designs["longer"].reference == "standing"
    found = {"longer": case.designs["longer"].find()}
    again = ks.load_case(write_found(tmp_path / "again.toml", case, found))
    assert again.comparisons == {"plain": [], "standing": ["standing-short", "longer"]}


@pytest.mark.slow
def test_compare_prints_a_table_for_each_reference(case, path, capsys):
    assert main(["compare", str(path)]) == 0
    printed = capsys.readouterr().out
    assert "\nplain / short: a ratio above 1" in printed
    lower = printed.partition("\nstanding / standing-short: a ratio above 1")[2]
    (row,) = (line for line in lower.splitlines() if line.startswith("mean |balancing torque|"))
    assert row.split()[-1] == f"{gain(case):.6g}"
    assert printed.count("power balance") == 1


@pytest.mark.slow
def test_compare_tells_programs_the_reference(path, capsys):
    assert main(["compare", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["references"] == {"short": "plain", "standing-short": "standing"}
    assert main(["compare", str(path), "--variant", "standing-short", "--csv"]) == 0
    _, *rows = capsys.readouterr().out.splitlines()
    assert {row.split(",")[2] for row in rows} == {"standing"}


def test_a_sweep_names_the_reference_of_the_case_and_that_of_ratios(tmp_path, capsys):
    own = UPRIGHT.replace("[variants.short]", '[variants.short]\nreference = "standing"')
    path = case_file(tmp_path, PLAIN + own)
    assert main(["sweep", str(path), "--vary", "crank_length=200..201 mm:2", "--angles", "12", "--output", RATIO]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "variant short, the first besides the reference plain" in told
    assert "ratios refer to standing" in told


@pytest.mark.slow
def test_published_figures_are_of_the_reference_of_the_case(tmp_path, capsys):
    printed = '[published.ratio]\n"mean |balancing torque|" = "6.77"\n'
    path = case_file(tmp_path, PLAIN + UPRIGHT + printed)
    assert "published" in ks.load_case(path).comparison_table("short")
    assert "published" not in ks.load_case(path).comparison_table("standing-short")
    assert "published" not in ks.load_case(path).comparison_table("short", "standing")
    assert main(["compare", str(path)]) == 0
    assert capsys.readouterr().out.count("published") == 1


@pytest.mark.slow
def test_a_report_has_a_table_for_each_reference(case):
    subject = subject_of(case)
    assert [table.columns[2:] for table in tables.comparisons(subject)] == [
        ["plain", "short"],
        ["standing", "standing-short"],
    ]
    glance = {row[0]: row for row in tables.glance(subject).rows}
    assert glance["standing"][3] == ""
    assert glance["standing-short"][3] == f"{gain(case):.4g} ×"
    assert list(subject_of(case, "standing-short").machines) == ["standing", "standing-short"]


@pytest.mark.slow
def test_figures_show_what_is_compared(case, tmp_path, monkeypatch):
    seen = []
    monkeypatch.setattr(figures, "save_figure", lambda figure, path, *_: seen.append(figure) or path)
    drawn = figures.draw_case(case, tmp_path, only="torque")
    assert [path.name for path in drawn] == ["case_torque.png", "case_standing_torque.png"]
    legends = [[text.get_text() for text in figure.axes[0].get_legend().get_texts()] for figure in seen]
    assert [set(legend) for legend in legends] == [{"plain", "short"}, {"standing", "standing-short"}]


def test_the_reference_is_no_part_of_a_design(case):
    assert case.variants["short"].content == ks.load_case(case.path).variants["short"].content
    alone = PLAIN + UPRIGHT.replace('reference = "standing"\n', "")
    other = ks.load_case(case_file(case.path.parent, alone)).variants["standing"]
    assert case.variants["standing"].content == other.content
    np.testing.assert_array_equal(case.solve("standing", 8).balancing_torque, other.solve(8).balancing_torque)
