"""What the README shows is what runs."""

import re
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def python_blocks():
    return re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)


def test_readme_example_is_short_and_right(capsys):
    code = python_blocks()[0]
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    exec(compile(code, "README", "exec"), {})
    printed = capsys.readouterr().out
    assert "40578.9" in printed
    assert "286772" in printed
    residual = float(printed.rsplit(":", 1)[1])
    assert residual < 1e-14


def test_readme_shaper_runs_and_balances_its_powers(capsys):
    names: dict = {"np": np, "ks": ks, "turn": np.linspace(0, 2 * np.pi, 720, endpoint=False)}
    exec(compile(python_blocks()[1], "README", "exec"), names)
    assert float(capsys.readouterr().out.rsplit(":", 1)[1]) > 800.0
    assert names["s"].power_residual < 1e-14


def test_readme_shows_what_needs_says():
    code, shown = python_blocks()[2].removeprefix(">>> ").split("\n", 1)
    said = str(eval(code, {"ks": ks}))
    number = r"error [-+.e\d]+"
    assert re.sub(number, "", said) == re.sub(number, "", shown.strip())


def test_readme_sweep_runs():
    names: dict = {"ks": ks}
    code = python_blocks()[3].replace(":40", ":3").replace(":30", ":2")
    exec(compile(code.replace('"cam-circle")', '"cam-circle", progress=False)'), "README", "exec"), names)
    assert len(names["table"]) == 6
    assert (names["table"]["failed"] == "").all()


def test_readme_program_gives_torque_and_slope():
    turn = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    names: dict = {"ks": ks, "turn": turn}
    exec(compile(python_blocks()[4], "README", "exec"), names)
    before = names["scene"].solve(turn).balancing_torque
    assert np.abs(names["slope"]).max() > 0.1
    np.testing.assert_allclose(names["torque"] - before, 0.5 * names["slope"], rtol=1e-9, atol=1e-12)


def test_readme_saw_needs_as_little_torque_as_it_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names: dict = {"ks": ks}
    exec(compile(python_blocks()[5], "README", "exec"), names)
    exact, faster = map(float, capsys.readouterr().out.rstrip().rsplit("\n", 2)[1:])
    assert round(exact) == 52_862
    assert round(faster, 1) == 52.1
    assert (tmp_path / "cam.svg").stat().st_size > 10_000


def test_readme_saws_in_the_study_layout_gain_what_it_says():
    case = ks.load_case("sawframe_2r63_optimal")
    plain, found = (case.variants[name].scene for name in ("plain", "cam-optimal"))
    gains, reactions = [], []
    for share in (1.0, 0.99, 1.01):
        c = ks.compare(*(scene.varied({"crank_speed": share * plain.crank_speed}).solve() for scene in (plain, found)))
        gains.append(round(c.mean_torque_ratio))
        reactions.append(round(c.peak_reactions("O")[1] / 1e3, 1))
    assert gains == [411, 48, 52]
    assert reactions == [0.8, 2.5, 2.7]


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
    table = README.partition("## From nothing")[0].replace("**", "")
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
