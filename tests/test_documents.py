"""What the README shows is what runs."""

import re
from pathlib import Path

import pytest

import kinetostatics as ks

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def python_blocks():
    return re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)


def test_readme_is_short():
    assert len(README.splitlines()) < 150


def test_readme_example_is_short_and_right(capsys):
    [code] = python_blocks()
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    exec(compile(code, "README", "exec"), {})
    printed = capsys.readouterr().out
    assert "40578.9" in printed
    assert "286772" in printed
    residual = float(printed.rsplit(":", 1)[1])
    assert residual < 1e-14


def of_table(value, unit=""):
    """A number as in the table: three digits, large ones in groups, small forces in N."""
    if unit:
        return f"{value / 1e3:.3g} kN" if value > 1e3 else f"{value:.3g} N"
    return f"{value:,.0f}".replace(",", " ") if value > 1e3 else f"{value:.3g}"


def test_readme_table_of_the_saw_upright_is_what_runs():
    variants = ks.load_case("sawframe_2r63").variants
    plain = variants["upright-plain"].scene
    rows = []
    for name in ("plain", "circle", "cosine", "optimal"):
        found = []
        for share in (1.0, 0.99, 1.01):
            pair = (plain, variants[f"upright-{name}"].scene)
            c = ks.compare(*(scene.varied({"crank_speed": share * plain.crank_speed}).solve() for scene in pair))
            found.append((of_table(c.mean_torque_ratio), of_table(c.peak_reactions("O")[1], "N")))
        (gain, reaction), (slower, less), (faster, more) = found
        rows.append(f"{gain} | {reaction} | {slower} and {faster}; {less.removesuffix(' kN')} and {more}")
    table = README.replace("**", "")
    assert [row for row in rows if f"| {row} |" not in table] == []


def test_readme_links_lead_to_files():
    links = [link for link in re.findall(r"\]\(([^)]+)\)", README) if "://" not in link]
    assert links
    assert all((ROOT / link).exists() for link in links)


def test_version_is_in_changelog_and_citation():
    section = re.search(r"^## (\S+) - (\S+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert section is not None
    assert section[1] == ks.__version__
    assert f"\nversion: {section[1]}\n" in citation
    assert f'\ndate-released: "{section[2]}"\n' in citation


def test_changelog_lists_changes_of_each_version():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        assert set(re.findall(r"^### (.*)$", section, flags=re.MULTILINE)) <= {"Added", "Changed", "Fixed", "Removed"}
    assert max(map(len, text.splitlines())) <= 130
